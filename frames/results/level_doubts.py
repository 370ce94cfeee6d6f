"""Possible error of the level 'pendulum' in a run, by quantity and bearing.

Sliders in full contact press on both rims at once, land on their whole face and slide on both
surfaces at once. Real ones rock: one rim after the other, one edge before the other, first on the
surface of the lower friction. How much that changes was measured on random buildings
(docs/validation/level_doubts.md); a bearing belongs to the first of `CLASSES` that fits.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.results.peak_response import largest
from frames.results.recorded import names_of
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray, FloatArray

DOUBTED = {
    "displacement": "displacement",
    "force": "force",
    "axial_force": "axial force",
    "slip": "interface slip",
    "rim_force": "rim force",
}
"""Quantities of a bearing, with their words."""

MARKED = {name: 0.10 for name in DOUBTED if name != "rim_force"}
"""Error of nine bearings in ten above which a run is marked with "!": it affects all checks. Rim
forces are doubtful after any rim contact: the checks of rims account for that themselves.
"""


LEAST = 0.05
"""Error that is not worth a word."""


class Class(NamedTuple):
    """Bearings of a kind, and the errors that nine in ten of them stay below."""

    name: str
    errors: tuple[float, ...]
    """Error over the value, as `DOUBTED`; inf: no bound."""


SHORT_TRAVEL, LONG_TRAVEL = 1.5, 3.0
"""Travels of bearings whose surfaces differ in friction [-]: `travels`."""
STILL = 0.003
"""Displacement over the effective radius below which a bearing has no finding [-]."""

UNEQUAL = Class("unequal rims that were met", (0.02, 0.27, 0.19, 2.2, 1.3))
LIFTED = Class("uplift and rims that were met", (0.01, 0.16, 0.18, 0.20, 1.2))
ROCKED = Class("rims met, e/a above 0.75", (0.0, 0.16, 0.09, 0.04, 1.1))
TIPPED = Class("rims met, e/a from 0.33 to 0.75", (0.0, 0.07, 0.04, 0.04, 0.72))
MET = Class("rims met, e/a below 0.33", (0.0, 0.05, 0.02, 0.03, 0.36))
LANDED = Class("uplift, rims not met", (0.0, 0.07, 0.09, 0.07, 0.0))
UNLIKE = Class(
    "unlike friction: uplift, or e/a above 0.3 on a short travel", (0.29, 0.48, 0.58, 0.21, 0.0)
)
SHORT = Class("unlike friction, other short travels", (0.14, 0.04, 0.02, 0.0, 0.0))
MIDDLE = Class("unlike friction, middle travels", (0.05, 0.04, 0.02, 0.0, 0.0))
CLASSES = (UNEQUAL, LIFTED, ROCKED, TIPPED, MET, UNLIKE, SHORT, LANDED, MIDDLE)


class LevelDoubts(NamedTuple):
    """Bearings whose sliders rocked at the level 'pendulum', and the possible errors."""

    bearings: tuple[str, ...]
    """Names of the bearings that need the level 'contact'."""
    errors: FloatArray
    """(n_bearings, 5) [-]: bound for nine bearings in ten of the class, as `DOUBTED`."""
    names: tuple[str, ...]
    """Names of all bearings."""

    @property
    def marked(self) -> bool:
        """True if more than rim forces is doubtful."""
        limits = [MARKED.get(name, np.inf) for name in DOUBTED]
        return bool((self.errors > np.array(limits)).any())

    @property
    def sentence(self) -> str:
        """The possible errors and their sizes."""
        worst = self.errors.max(axis=0)
        parts = [
            worded("{quantity} up to {error:.0f} %", quantity=name, error=100.0 * error)
            for name, error in zip(DOUBTED.values(), worst, strict=True)
            if error > LEAST
        ]
        who = worded("{count} of {all} bearings", count=len(self.bearings), all=len(self.names))
        if not parts:
            return worded(
                'forces of {whom} within {error:.0f} % at the level "pendulum"',
                whom=who,
                error=100.0 * LEAST,
            )
        return worded(
            'level "pendulum" may be wrong for {whom}: {errors}',
            whom=who,
            errors=joined(*parts, by=", "),
        )


def levels_of_bearings(data: xr.Dataset) -> tuple[str, ...]:
    """Return the level of each bearing of a result, from its attribute `level`."""
    text, names = str(data.attrs["level"]), [str(n) for n in names_of(data, "bearing")]
    if not text.startswith("{"):
        return (text,) * len(names)
    given = ast.literal_eval(text)
    return tuple(given.get(name, "pendulum") for name in names)


def level_doubts(data: xr.Dataset) -> LevelDoubts:
    """Return the possible errors of bearings at the level 'pendulum' in a run."""
    names = tuple(str(name) for name in names_of(data, "bearing"))
    met, lifted, share = (
        largest(data, name).values for name in ("rims_met", "lifted", "eccentricity")
    )
    friction, length = (_of_bearings(data, name) for name in ("friction_max", "length"))
    travel = travels(largest(data, "displacement").values, friction, length)
    errors, doubtful = errors_of(met > 0.0, lifted > 0.0, share, _are_unequal(data), travel)
    at_pendulum = np.array(levels_of_bearings(data)) == "pendulum"
    errors[~at_pendulum] = 0.0
    asking = zip(names, doubtful & at_pendulum, strict=True)
    return LevelDoubts(tuple(name for name, asks in asking if asks), errors, names)


def errors_of(
    met: BoolArray, lifted: BoolArray, share: FloatArray, unequal: BoolArray, travel: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the error bounds of nine bearings in ten of a class [-], and the bearings in a class.

    Shapes: met, lifted (..., n_bearings), share (..., n_bearings), unequal (n_bearings,), travel
    (..., n_bearings).
    """
    members = (
        met & unequal,
        met & lifted,
        met & (share > 0.75),
        met & (share > 0.33),
        met,
        (travel < SHORT_TRAVEL) & (share > 0.3) | (travel < LONG_TRAVEL) & lifted,
        travel < SHORT_TRAVEL,
        lifted,
        travel < LONG_TRAVEL,
    )
    errors = np.zeros((*met.shape, len(DOUBTED)))
    taken = np.zeros(met.shape, dtype=bool)
    for kind, those in zip(CLASSES, members, strict=True):
        errors[those & ~taken] = kind.errors
        taken |= those
    return errors, taken


def travels(displacement: FloatArray, friction: FloatArray, length: FloatArray) -> FloatArray:
    """Return travel of bearings over the displacement at which both surfaces slide [-].

    The surface of the higher friction slides from about the difference of both coefficients times
    the effective radius on.

    Shapes: displacement (..., n_bearings), friction (n_bearings, 2), length (n_bearings,), result
    (..., n_bearings).
    """
    way = np.abs(friction[:, 0] - friction[:, 1]) * length
    counts = (way > 0.0) & (displacement > STILL * length)
    found = np.full(counts.shape, np.inf)
    np.divide(displacement, way, out=found, where=counts)
    return found


def _are_unequal(data: xr.Dataset) -> BoolArray:
    return rims_are_unequal(_of_bearings(data, "rim_displacement"), _of_bearings(data, "radius"))


def _of_bearings(data: xr.Dataset, name: str) -> FloatArray:
    return np.asarray(data.variables[name].transpose("bearing", ...).values)


def rims_are_unequal(reach: FloatArray, radius: FloatArray) -> BoolArray:
    """Return True for bearings (n_bearings,) whose rims differ in reach (n_bearings, 2)."""
    with np.errstate(invalid="ignore"):  # no rims: both infinite
        slopes = reach / radius
        return np.asarray(np.abs(slopes[:, 0] - slopes[:, 1]) > 1e-6 * np.abs(slopes[:, 0]))
