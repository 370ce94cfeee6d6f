"""What is left of a motion at its end, and the smallest baseline that takes it out."""

import copy
import pickle  # noqa: S403
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from frames import GroundMotion, MotionError, MotionWarning
from frames.motion.transforms import corrected, drift_of, integrated
from tests.refusals import refused

DT = 0.01


def noise(seed: int, count: int = 2001) -> np.ndarray:
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 1.0, count)
    return np.convolve(rng.normal(size=count + 20), np.hanning(21), "valid") * np.sin(np.pi * t)


def faded(seed: int, offset: float) -> np.ndarray:
    """A record as they are: strong in the middle, and quiet at its end but for an offset."""
    wave = noise(seed)
    wave *= np.exp(-((np.linspace(-3.0, 3.0, len(wave))) ** 2))
    return corrected(wave, DT, displacement=True) + offset


def test_integration_is_exact_between_samples() -> None:
    """Against quadrature of the same polygon."""
    a = np.array([0.3, -1.0, 2.0, 0.5, 0.0])
    velocity, displacement = integrated(a, 0.2)
    time = 0.2 * np.arange(5)
    for k in range(1, 5):
        breaks = list(time[1:k]) or None
        v = quad(lambda t: np.interp(t, time, a), 0.0, time[k], points=breaks)[0]
        d = quad(
            lambda t, end=time[k]: (end - t) * np.interp(t, time, a), 0.0, time[k], points=breaks
        )[0]
        assert_allclose((velocity[k], displacement[k]), (v, d), atol=1e-13)


@pytest.mark.parametrize("seed", range(5))
def test_the_correction_is_the_least_that_does_it(seed: int) -> None:
    """Rest at the end to round-off, and no other correction that does so is smaller."""
    a = noise(seed) + 0.02
    still = corrected(a, DT, displacement=True)
    left = drift_of(still, DT)
    assert abs(left.velocity) < 1e-12
    assert abs(left.displacement) < 1e-10
    taken = a - still
    rng = np.random.default_rng(seed)
    other = rng.normal(size=len(a))
    free = corrected(other, DT, displacement=True)  # ends at rest: may be added to any correction
    assert abs(np.trapezoid(taken * free, dx=DT)) < 2e-3 * np.sqrt(
        np.trapezoid(taken**2, dx=DT) * np.trapezoid(free**2, dx=DT)
    )


def test_the_displacement_may_stay() -> None:
    """A step of the ground by 1.5 m with a drift of 0.01 m/s2: the step is what is left."""
    t = DT * np.arange(3001)
    fling = 1.5 * np.pi / 8.0 * np.gradient(np.sin(np.pi * t / 4.0) * (t < 4.0), DT)
    motion = GroundMotion(x=fling + 1e-3 * np.sin(2.0 * np.pi * t / 30.0) + 2e-3, dt=DT, name="f")
    kept = motion.corrected(displacement=False).drift["x"]
    assert abs(kept.velocity) < 1e-12
    assert_allclose(kept.displacement, 1.5, atol=0.2)
    assert abs(motion.corrected().drift["x"].displacement) < 1e-10


def test_the_name_tells_the_change() -> None:
    x, y = (corrected(noise(k), DT, displacement=True) + 0.01 for k in (1, 2))
    motion = GroundMotion(x=x, y=y, dt=DT, name="rec")
    still = motion.corrected()
    largest = max(abs(still.peak[axis] / motion.peak[axis] - 1.0) for axis in "xy")
    assert still.name == f"rec (baseline corrected, peaks within {100 * largest:.2g} %)"
    assert 0.0 < largest < 0.05


def test_what_is_no_baseline_is_refused() -> None:
    pulse = GroundMotion(x=np.sin(np.linspace(0.0, np.pi, 101)), dt=DT)
    refused(MotionError, r"would change the peak of x by .* too large", pulse.corrected)


@pytest.mark.parametrize("offset", [0.0, 0.05])
def test_reading_a_record_that_still_moves(tmp_path: Path, offset: float) -> None:
    path = tmp_path / "rec.txt"
    wave = faded(4, offset)
    np.savetxt(path, np.column_stack([DT * np.arange(len(wave)), wave]))
    if offset:
        with pytest.warns(
            MotionWarning, match=r"rec: the ground still moves .*x: velocity 1 m/s.*corr"
        ):
            motion = GroundMotion.from_columns(path, x=1, time=0, unit="m/s2")
    else:
        motion = GroundMotion.from_columns(path, x=1, time=0, unit="m/s2")
    assert_allclose(motion.drift["x"].velocity, offset * 20.0, atol=1e-9)
    assert f"{offset * 20.0:.3f} m/s" in motion.summary()


@pytest.mark.parametrize("offset", [0.05, -0.1])
def test_arrays_of_a_record_that_still_moves(offset: float) -> None:
    with pytest.warns(
        MotionWarning, match=r"rec: the ground still moves .*x: velocity .* corr"
    ) as said:
        motion = GroundMotion(x=faded(4, offset), dt=DT, name="rec")
    assert said[0].filename == __file__
    # said once: not again by what is made of it
    copies = [copy.deepcopy(motion), pickle.loads(pickle.dumps(motion)), motion.scaled(2.0)]  # noqa: S301
    assert all(other.drift["x"].share > 0.15 for other in copies)
    GroundMotion(x=faded(4, 0.0), dt=DT)
    GroundMotion(x=motion.corrected().x, dt=DT)


@pytest.mark.parametrize(
    "wave",
    [
        lambda t: np.ones(len(t)),
        lambda t: t,
        *(lambda t, period=period: np.sin(2.0 * np.pi / period * t) for period in (0.5, 3.0, 7.0)),
        *(lambda t, period=period: np.cos(2.0 * np.pi / period * t) for period in (0.3, 5.0)),
    ],
)
@pytest.mark.parametrize("duration", [8.0, 9.1, 11.3, 20.0])
def test_what_ends_at_full_strength_is_meant(wave, duration):
    motion = GroundMotion(x=wave(np.arange(0.0, duration, DT)), dt=DT)
    assert motion.n_steps > 2


def test_a_pulse_is_meant() -> None:
    pulse = np.pad(np.sin(np.linspace(0.0, np.pi, 101)), (0, 400))
    assert GroundMotion(x=pulse, dt=DT).drift["x"].share == 1.0


def test_a_motion_of_rest() -> None:
    motion = GroundMotion(x=np.zeros(50), dt=DT)
    assert motion.drift["x"].share == 0.0
    assert motion.corrected().peak["x"] == 0.0
