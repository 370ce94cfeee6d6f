"""How runs of one test case ended, and whether two ends are the same but for the error of the step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from lir_element import RunStatus

if TYPE_CHECKING:
    import xarray as xr

    from frames import Frame

INACCURATE = "inaccurate"
"""Status of a run that went to its end, with a energy balance that is open."""
FAILED_BEARINGS = {status.name.lower() for status in RunStatus if status.is_bearing_failure}
LATE = 0.1
"""Largest difference of the times at which a bearing fails, over the earlier one [-]."""
_STEEPEST = math.radians(72.0)


def end_of(data: xr.Dataset) -> str:
    """Return how a run ended; one whose energy balance is open went to its end, too."""
    status = str(data.attrs["status"])
    return "ok" if status == INACCURATE else status


def same_end(model: Frame, data: xr.Dataset, finer: xr.Dataset, error: float) -> bool:
    """Return whether two runs at different steps end alike.

    A bearing that fails must fail in both, at about the same time; which of its limits it passes
    first is a matter of the step once a slider rocks on an edge. Where one run completes, it must
    about then have come as near to the limit that the other passed as `error`.
    """
    ends = end_of(data), end_of(finer)
    if ends[0] == ends[1]:
        return True
    if set(ends) <= FAILED_BEARINGS:
        times = sorted(float(result.attrs["failed_at"]) for result in (data, finer))
        return times[1] <= (1.0 + LATE) * times[0]
    if "ok" in ends and set(ends) & FAILED_BEARINGS:
        completed, failed = (data, finer) if ends[0] == "ok" else (finer, data)
        until = (1.0 + LATE) * float(failed.attrs["failed_at"])
        return left_over(model, completed.sel(time=slice(0.0, until)), end_of(failed)) <= error
    return False


def left_over(model: Frame, data: xr.Dataset, status: str) -> float:
    """Return how far a run stayed away from the limit that a status names."""
    least = math.inf
    for name, link in model.bearings.items():
        limits, own = link.bearing.resolved(), data.sel(bearing=name)
        slip = own["interface_slip_size"].where(own["axial_force"] > 0.0, 0.0)
        if status == "slip_exceeded":
            left = limits["slip_capacity"] - slip
        elif status == "rim_overrun":
            left = limits["rim_overrun"] - own["rim_closure"]
        elif status == "slip_unstable":  # beyond L mu_h + mu_1 R_1 + mu_2 R_2, docs/theory.md, 2
            held = (own["friction_coefficient"] * own["radius"]).sum("surface")
            left = link.bearing.effective_radius * own["interface_friction"] + held - slip
        else:
            moved = np.linalg.norm(own["bearing_displacement"].sel(axis=["x", "y"]), axis=-1)
            left = link.bearing.effective_radius * math.sin(_STEEPEST) - moved
        least = min(least, float(np.min(left)))
    return least
