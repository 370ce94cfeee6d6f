"""Comparisons: what was reported beside what was found, by category, each with its tolerance."""

import math
import re

import numpy as np

NUMBER = re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$")

_POWERS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


class Tally:
    """Counts comparisons and keeps what disagrees."""

    def __init__(self):
        self.counts, self.worst, self.bad, self.missing, self.why = {}, {}, [], [], {}

    def category(self, name, tolerance, why):
        """Say how closely a category must agree, and why so."""
        self.why[name] = (tolerance, why)

    def same(self, category, label, reported, found, floor=0.0):
        """Compare numbers or arrays within the category's tolerance, over at least a floor."""
        tolerance = self.why[category][0]
        left, right = np.broadcast_arrays(np.asarray(reported, float), np.asarray(found, float))
        for a, b in zip(left.ravel(), right.ravel(), strict=True):
            if (math.isnan(a) and math.isnan(b)) or a == b:
                off = 0.0
            elif not (math.isfinite(a) and math.isfinite(b)):
                off = math.inf
            else:
                off = abs(a - b) / max(abs(a), abs(b), floor, 1e-300)
            self._count(category, label, a, b, off, off <= tolerance)

    def words(self, category, label, reported, found):
        """Compare words."""
        alike = str(reported) == str(found)
        self._count(category, label, reported, found, 0.0 if alike else math.inf, alike)

    def printed(self, category, label, text, found, factor=1.0):
        """Compare a printed number with what it is of, to its last digit."""
        text = plain(str(text).replace(",", "").strip())
        number = text.partition(" ")[0].removesuffix("%")
        if not NUMBER.match(number):
            alike = number in {"-", "", "nan", "inf"} and not math.isfinite(found)
            self._count(category, label, text, found, 0.0 if alike else math.inf, alike)
            return
        value = float(number) / factor
        half = 0.5000001 * digit(number) / factor
        off = abs(value - found) / max(abs(found), 1e-300) if value != found else 0.0
        self._count(category, label, value, found, off, abs(value - found) <= half)

    def unknown(self, category, label):
        """Note a number that was reported and not recomputed."""
        self.missing.append((category, label))

    def _count(self, category, label, reported, found, off, alike):
        self.counts[category] = self.counts.get(category, 0) + 1
        if alike:
            self.worst[category] = max(self.worst.get(category, 0.0), off)
        else:
            self.bad.append((category, label, reported, found, off))


def plain(text):
    """Return a number as "1.102·10⁸" and "−3" as "1.102e8" and "-3"."""
    return text.replace("−", "-").replace("·10", "e").translate(_POWERS)


def digit(number):
    """Return the unit of the last printed digit: of "12.30" 0.01, of "1.2e+03" 100, of "580" 1."""
    mantissa, _, power = number.lower().partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
