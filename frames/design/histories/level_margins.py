"""Checks whose margin is less than what the level 'pendulum' may have wrong."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames.design.histories.suite import peaks_of_runs
from frames.results.level_doubts import (
    DOUBTED,
    errors_of,
    levels_of_bearings,
    rims_are_unequal,
    travels,
)

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.design.calculation.check import Check
    from lir_element import LIRBearing


def doubted(checks: list[Check], errors: Mapping[str, float], quantity: str) -> list[Check]:
    r"""Return checks with a note at those that pass by less than what their level may have wrong.

    Errors :math:`e` are over the right value, so that a demand :math:`x` may stand for
    :math:`x / (1 - e)`, and from :math:`e = 1` on for any value. A demand that a least value
    governs is taken in the same way, on the safe side.
    """
    found = []
    for check in checks:
        error = errors[check.subject] if check.subject else 0.0
        most = check.demand / (1.0 - error) if error < 1.0 else math.inf
        if check.passed and error > 0.0 and most > check.limit:
            said = (
                f'at the level "pendulum" the {quantity} may be off by {100.0 * error:.0f} %, '
                'more than its margin: run at level = "contact"'
            )
            check = replace(check, note="; ".join(part for part in (check.note, said) if part))
        found.append(check)
    return found


def level_errors(data: xr.Dataset, bearings: Sequence[LIRBearing], quantity: str) -> FloatArray:
    """Return what the level 'pendulum' may have wrong of each bearing, of all runs the most.

    Shapes: result (n_bearings,).
    """
    rims, lifted, share, moved = (
        np.nan_to_num(peaks_of_runs(data, name))
        for name in ("rim_force", "lifted", "eccentricity", "displacement")
    )
    unequal = rims_are_unequal(
        np.array([bearing.rim_displacement for bearing in bearings]),
        np.array([bearing.radii for bearing in bearings]),
    )
    friction = np.array([[law.f_max for law in bearing.frictions] for bearing in bearings])
    length = np.array([bearing.effective_radius for bearing in bearings])
    travel = travels(moved, friction, length)
    errors, _ = errors_of(rims > 0.0, lifted > 0.0, share, unequal, travel)
    at = np.array([level == "pendulum" for level in levels_of_bearings(data)])
    return np.asarray((errors.max(axis=0) * at[:, None])[:, DOUBTED.index(quantity)])
