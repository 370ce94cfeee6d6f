"""The LIR-DCFPs and the DCFPs of their plan that several parts of the study compare."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from validation.measurements.yielding_runs import LIR, RIMS, model_of, structures
from validation.study.device_runs import LIR as BEST
from validation.study.device_runs import best_devices, frame_of
from validation.study.records_runs import STRUCTURE
from validation.study.rims_runs import Kind, bearing_of

if TYPE_CHECKING:
    from frames import Frame

OURS = "LIR-DCFP, equal sliders"
"""The best of its plan that the study found: no slider is smaller than the largest needs to be."""

BY_LOAD = "LIR-DCFP"
"""One whose sliders are as large as their loads ask, and all by the same more."""

UNBREAKABLE = "DCFP, rims that never break"
KINDS = {
    BY_LOAD: Kind(False, True, 0.5, 0.16, None),
    UNBREAKABLE: Kind(True, True, 0.0, 0.0, None),
    "DCFP, rims of 1 W": Kind(True, True, 0.0, 0.0, 1.0),
    "DCFP, rims of 0.5 W": Kind(True, True, 0.0, 0.0, 0.5),
}
"""By name: devices whose dish under the centre bearing has a diameter of 689 mm."""

NAMES = (OURS, *KINDS)
OTHERS = tuple(KINDS)
"""What the best is compared with."""


@cache
def device(name: str) -> Frame:
    """Return the building on a device of `NAMES`."""
    if name == OURS:
        return frame_of(best_devices()[BEST])
    kind = KINDS[name]
    frame = model_of(structures()[STRUCTURE], RIMS if kind.plain else LIR)
    return frame.with_bearings(
        {each: bearing_of(link.bearing, kind) for each, link in frame.bearings.items()}, name
    )


def devices() -> dict[str, Frame]:
    """Return the building on each device of `KINDS`, by name."""
    return {name: device(name) for name in KINDS}
