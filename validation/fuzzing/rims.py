"""Random test cases whose rims yield and break."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from validation.fuzzing.bearings import log_uniform

if TYPE_CHECKING:
    from frames import Frame
    from validation.fuzzing.scenes import Scene


def with_yielding_rims(scene: Scene) -> Scene:
    """Return a test case with rims of a drawn strength, in half of the cases with a flange."""
    rng = np.random.default_rng((scene.seed, scene.number, 77))
    flange = 0.05 if rng.random() < 0.5 else None
    share, hardening, overrun = (
        log_uniform(rng, *bounds) for bounds in ((0.02, 1.0), (1e-3, 0.2), (0.003, 0.05))
    )

    def build(in_mirror: bool) -> Frame:
        frame = scene.build(in_mirror)
        changed = {
            name: replace(
                link.bearing,
                rim_yield_force=share * link.bearing.resolved()["design_load"],
                rim_hardening=hardening,
                rim_overrun=overrun,
                flange=flange,
            )
            for name, link in frame.bearings.items()
        }
        return frame.with_bearings(changed)

    return replace(scene, build=build)
