"""What a comparison of two devices says, in sentences: where each is better, and at which price."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.design.calculation.rendering import quantity, usual_unit
from frames.design.project.comparison import OURS, PLAIN
from frames.results.quantities import DEMANDS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

    from frames.design.project.comparison import Comparison, RunCounts

ALIKE = 0.02
"""Difference of two numbers over the larger up to which they are called alike [-]."""

PRICE = tuple(DEMANDS[name].demand for name in ("slip", "slip_left"))
"""Demands that a rigid slider cannot have: the price of the slider in two pieces."""

MAIN = [
    "displacement",
    "displacement_left",
    "rim_force",
    "gap",
    "base_shear",
    "drift",
    "floor_plan",
]
"""Demands that decide which device is called better: tables have the others as well."""


_LEAST_SLIP = 1e-4  # m: what an interface that holds gives way elastically is less


class Verdict(NamedTuple):
    """What the numbers of one level of the seismic action say."""

    level: str  # level of the seismic action
    head: str  # the verdict in a sentence
    # whether the LIR-DCFP is the better device; None where neither is, or none can be named
    is_ours: bool | None
    details: tuple[str, ...]  # sentences with the numbers


def verdicts(found: Comparison) -> list[Verdict]:
    """Return what the numbers say at each level of the seismic action."""
    return [_verdict(found, level) for level in found.levels]


def _verdict(found: Comparison, level: str) -> Verdict:
    ours, plain = (_at(found.demands[device], level) for device in (OURS, PLAIN))
    counts = {device: found.counts(device, level) for device in (OURS, PLAIN)}
    void = {device: why for device in (OURS, PLAIN) if (why := found.void(device, level))}
    details = _of_runs(counts)
    if void:
        details += [f"{device}, no values for design: {why}." for device, why in void.items()]
        details.append("The numbers of such runs are what they reached until they stopped.")
        better = None if len(void) == 2 else PLAIN in void
        return Verdict(level, _head_of_failures(counts, void), better, tuple(details))
    lower, higher, alike = _sorted(ours, plain)
    for words, names in (("lower", lower), ("higher", higher)):
        if names:
            listed = "; ".join(_numbers(name, ours, plain) for name in names)
            details.append(f"With the {OURS} {words}: {listed}.")
    if alike:
        details.append(f"Alike within {100.0 * ALIKE:g} %: {', '.join(alike)}.")
    if price := _price(ours):
        details.append(price)
    if not any(each.met for each in counts.values()):
        text = (
            f"No run meets a restraining rim. There the two devices move alike, and the {OURS} "
            f"gains nothing under these motions: a plain {PLAIN} does the same with fewer parts."
        )
        return Verdict(level, text, False, tuple(details))
    head, is_ours = _head(lower, higher)
    return Verdict(level, head, is_ours, tuple(details))


def _head(lower: list[str], higher: list[str]) -> tuple[str, bool | None]:
    under = "Under these motions"
    if lower and not higher:
        return f"{under} the {OURS} asks for less, or as much, in all that decides.", True
    if higher and not lower:
        text = f"{under} the plain {PLAIN} is the better device: it asks for less, or as much"
        return f"{text}, in all that decides, and its slider is whole.", False
    if not lower:
        return f"{under} the two devices ask for the same; the plain {PLAIN} is simpler.", False
    text = (
        f"Neither is better in all: with the {OURS} {_joined(lower)} {_are(lower)} lower, "
        f"{_joined(higher)} {_are(higher)} higher. Which counts more is for the designer to say."
    )
    return text, None


def _head_of_failures(counts: Mapping[str, RunCounts], void: Mapping[str, str]) -> str:
    if len(void) == 2:
        return "No verdict: the runs of neither device give values for design."
    device = next(iter(void))
    runs, _, stopped, _ = counts[device]
    why = f"{stopped} of its {runs} runs stopped" if stopped else "its runs may not count"
    other = PLAIN if device == OURS else OURS
    return (
        f"Only the {other} has values for design: of the {device} {why}. As it stands the {device} "
        "is not shown to bear these motions."
    )


def _sorted(ours: pd.DataFrame, plain: pd.DataFrame) -> tuple[list[str], list[str], list[str]]:
    # Names of the demands that are better with ours, worse, and alike.
    lower: list[str] = []
    higher: list[str] = []
    alike: list[str] = []
    for name in (DEMANDS[key].demand for key in MAIN if DEMANDS[key].demand in ours.index):
        one, two = float(ours.loc[name, "envelope"]), float(plain.loc[name, "envelope"])
        if math.isnan(one) or math.isnan(two):
            continue
        if abs(one - two) <= ALIKE * max(abs(one), abs(two)):
            if max(abs(one), abs(two)) > 0.0:
                alike.append(name)
        else:
            (lower if one < two else higher).append(name)
    return lower, higher, alike


def _numbers(name: str, ours: pd.DataFrame, plain: pd.DataFrame) -> str:
    unit = str(ours.loc[name, "unit"])
    one, two = float(ours.loc[name, "envelope"]), float(plain.loc[name, "envelope"])
    change = f", {100.0 * (one / two - 1.0):+.0f} %" if two else ""
    return f"{name} {_shown(name, one, unit)} against {_shown(name, two, unit)}{change}"


def _price(ours: pd.DataFrame) -> str:
    slip, stays = (
        float(ours.loc[name, "envelope"]) if name in ours.index else math.nan for name in PRICE
    )
    if not slip > _LEAST_SLIP:
        return ""
    rest = "" if math.isnan(stays) else f", of which {_shown(PRICE[1], stays, 'm')} stay"
    return (
        f"Its price: the interface slips by {_shown(PRICE[0], slip, 'm')}{rest}; the sliders are "
        "to be inspected and re-centred after the earthquake."
    )


def _of_runs(counts: Mapping[str, RunCounts]) -> list[str]:
    met = (f"with the {name} in {each.met} of {each.runs}" for name, each in counts.items())
    found = [f"Restraining rims are met {', '.join(met)} runs."]
    for name, each in counts.items():
        if each.stopped:
            found.append(
                f"Of the {name} {each.stopped} of {each.runs} runs stopped before their end."
            )
        if each.doubtful:
            found.append(
                f"Of the {name} {each.doubtful} of {each.runs} runs have a warning of the check of "
                "modelling assumptions: their numbers may be wrong, and lir run says in what."
            )
    return found


def _at(demands: pd.DataFrame, level: str) -> pd.DataFrame:
    return demands[demands["level"] == level]


def _shown(name: str, value: float, unit: str) -> str:
    if "drift" in name:
        return f"{100.0 * value:.3g} %"
    return quantity(value, unit, "mm" if unit == "m" else usual_unit(unit))


def _joined(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _are(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"
