"""The ground motion as steps see it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import GroundMotion
from frames.motion.ground_motion import seen_by_steps


def motion() -> GroundMotion:
    t = np.arange(0.0, 2.0005, 0.001)
    shock = np.where(np.abs(t - 0.525) < 0.02, 8.0 * np.cos(np.pi * (t - 0.525) / 0.04), 0.0)
    return GroundMotion(x=shock, y=np.sin(7.0 * t) * t, z=0.1 * t, dt=0.001)


def test_small_steps_see_the_samples() -> None:
    accelerations, step = seen_by_steps(motion(), 0.001)
    assert step == 0.001
    assert_allclose(accelerations, motion().components, rtol=0.0, atol=0.0)


@pytest.mark.parametrize("dt", [0.0035, 0.02, 0.05])
def test_velocity_and_displacement_of_the_ground_are_kept(dt: float) -> None:
    """Sums over the steps are the integrals of the motion; a shock between two steps counts."""
    accelerations, step = seen_by_steps(motion(), dt)
    assert step == dt
    given = motion().components
    velocity = np.sum(0.5e-3 * (given[1:] + given[:-1]), axis=0)
    assert_allclose(dt * accelerations.sum(axis=0), velocity, rtol=2e-3, atol=1e-3)
    times = dt * np.arange(len(accelerations))
    centre = (accelerations[:, 0] * times).sum() / accelerations[:, 0].sum()
    assert centre == pytest.approx(0.525, abs=1e-9)


def test_smooth_motion_is_seen_as_it_is() -> None:
    accelerations, step = seen_by_steps(motion(), 0.01)
    times = step * np.arange(1, 199)
    assert_allclose(accelerations[1:199, 1], np.sin(7.0 * times) * times, rtol=0.0, atol=2e-3)
    assert_allclose(accelerations[1:199, 2], 0.1 * times, rtol=0.0, atol=1e-9)
