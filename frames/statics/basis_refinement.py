"""The method "reduced": few Ritz vectors, and more of them until the omitted part is small."""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.assembly.basis import build_basis
from frames.assembly.ritz import RitzSpace
from frames.statics.gravity import at_rest, prepare
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from frames._types import FloatArray
    from frames.model.frame_data import FrameData
    from frames.results.peak_response import Extreme
    from frames.statics.gravity_state import GravityState
    from lir_element.device.features import Features

    Reached = Mapping[str, Extreme]

ROUNDS = 5
"""Runs at most."""

ALL = 0.8
"""Share of all modes above which all are used."""

BEARINGS, FLOORS, VERTICAL = 1.0, 10.0, 100.0
"""Factors on the tolerance: floors, storeys and axial forces follow impacts, and the vertical
accelerations of nodes follow their own columns.
"""

PARTS = {
    "bearing_displacement": (("displacement",), ("displacement",), BEARINGS),
    "base_shear": (("base_shear",), ("base_shear",), BEARINGS),
    "axial_force": (("axial_force",), ("axial_force",), FLOORS),
    "floor_acceleration": (("node_plan",), ("node_plan",), FLOORS),
    "vertical_acceleration": (("node_vertical",), ("node_plan", "node_vertical"), VERTICAL),
    "storey_drift": (("drift", "line_drift"), ("drift", "line_drift"), FLOORS),
    "yielding": (
        ("link_deformation", "hinge_rotation"),
        ("link_deformation", "hinge_rotation"),
        FLOORS,
    ),
}
"""By name of the error: quantities whose largest values are compared, those over whose largest,
and the share of the tolerance."""


class Refined(NamedTuple):
    """Additions of the method to a run."""

    attrs: dict[str, float]
    doubt: str
    """Quantities beyond the tolerance, or an empty string."""


def refined(
    model: FrameData,
    features: Features,
    level: str | Mapping[str, str],
    tolerance: float,
    run: Callable[[GravityState], tuple[Reached, bool]],
) -> Refined:
    """Run a structure with few vectors, then with more of them, until two runs agree.

    If most of the modes would be needed, all are used, as by the method "direct".
    """
    prepared = prepare(model, features, level)
    whole = prepared.system, prepared.geometric, model.damping
    began = perf_counter()
    space = RitzSpace(*whole)
    before: Reached | None = None
    errors = dict.fromkeys(PARTS, math.nan)
    for runs in range(1, ROUNDS + 1):
        is_part = space.grow() < ALL * space.most
        basis = space.basis() if is_part else build_basis(*whole)
        now, is_last = run(at_rest(prepared, basis, perf_counter() - began, silent=runs > 1))
        if not is_part:
            errors = dict.fromkeys(PARTS, 0.0)
        elif before is not None:
            errors = differences(before, now)
        before, began = now, perf_counter()
        if not is_part or is_last or not exceeding(errors, tolerance):
            break
    attrs = {"reduction_runs": runs, "reduction_tolerance": tolerance}
    attrs |= {f"reduction_error_{name}": error for name, error in errors.items()}
    return Refined(attrs, exceeding(errors, tolerance))


def differences(coarse: Reached, fine: Reached) -> dict[str, float]:
    """Compare the largest values of two runs; return the differences over the largest, by part."""
    found = {}
    for part, (names, over, _) in PARTS.items():
        scale = max((_most(fine[name].values) for name in over if name in fine), default=0.0)
        gaps = [_most(fine[name].values - coarse[name].values) for name in names if name in fine]
        found[part] = max(gaps, default=0.0) / scale if scale > 0.0 else 0.0
    return found


def exceeding(errors: dict[str, float], tolerance: float) -> str:
    """Return the errors above the tolerance, in words; an empty string if none."""
    too_large = [
        worded(
            "{quantity} {error:.2g} % (asked for: {allowed:g} %)",
            quantity=name.replace("_", " "),
            error=100.0 * error,
            allowed=100.0 * allowed,
        )
        for name, error in errors.items()
        if not error <= (allowed := PARTS[name][2] * tolerance)
    ]
    return joined(*too_large, by=", ")


def _most(values: FloatArray) -> float:
    return float(np.abs(values).max())
