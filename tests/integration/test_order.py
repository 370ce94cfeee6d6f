"""Order of the time integration with friction that turns and depends on speed."""

import math

import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, time_history
from lir_element import CoulombFriction, VelocityFriction
from lir_element.device.features import Level
from tests.scenes import small_bearing

COULOMB = CoulombFriction(0.066)
FAST = VelocityFriction(f_max=0.08, f_min=0.02, rate=15.0)


def orbit(friction: CoulombFriction | VelocityFriction, dt: float, level: Level) -> np.ndarray:
    """Return the path (n, 2) every 10 ms under a motion whose direction turns."""
    t = np.arange(0.0, 3.0, 0.01)
    motion = GroundMotion(x=1.5 * np.sin(4.0 * t), y=0.6 * np.sin(5.0 * t), dt=0.01)
    bearing = small_bearing(capacity=math.inf, friction=friction)
    data = time_history(
        lumped_mass(bearing, mass=6e4), motion, dt=dt, record_every=round(0.01 / dt), level=level
    )
    return data["bearing_displacement"].sel(axis=["x", "y"]).to_numpy()[:, 0]


@pytest.mark.parametrize("level", ["pendulum", "contact"])
@pytest.mark.parametrize("friction", [COULOMB, FAST], ids=["coulomb", "velocity"])
def test_second_order(friction: CoulombFriction | VelocityFriction, level: Level) -> None:
    """Friction acts at the end of the step, not half a step late: that would be first order."""
    fine = orbit(friction, 2e-4, level)
    peak = np.hypot(*fine.T).max()
    errors = [np.abs(orbit(friction, dt, level) - fine).max() / peak for dt in (5e-3, 2.5e-3)]
    assert errors[0] < 2e-3  # first order: 9e-3
    assert errors[1] < 1e-3
