"""The LIR-DCFP and the DCFPs of its plan that several parts of the study compare."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from validation.measurements.yielding_runs import LIR, RIMS, model_of, structures
from validation.study.records_runs import STRUCTURE
from validation.study.rims_runs import Kind, bearing_of

if TYPE_CHECKING:
    from frames import Frame

OURS = "LIR-DCFP"
UNBREAKABLE = "DCFP, rims that never break"
KINDS = {
    OURS: Kind(False, True, 0.5, 0.16, None),
    UNBREAKABLE: Kind(True, True, 0.0, 0.0, None),
    "DCFP, rims of 1 W": Kind(True, True, 0.0, 0.0, 1.0),
    "DCFP, rims of 0.5 W": Kind(True, True, 0.0, 0.0, 0.5),
}
"""By name: devices whose dish under the centre bearing has a diameter of 689 mm."""

PLAINS = tuple(name for name in KINDS if name != OURS)


@cache
def device(name: str) -> Frame:
    """Return the building on a device of `KINDS`."""
    kind = KINDS[name]
    frame = model_of(structures()[STRUCTURE], RIMS if kind.plain else LIR)
    return frame.with_bearings(
        {each: bearing_of(link.bearing, kind) for each, link in frame.bearings.items()}, name
    )


def devices() -> dict[str, Frame]:
    """Return the building on each device, by name."""
    return {name: device(name) for name in KINDS}
