"""Synthetic near-fault motions: the pulse against its closed forms, the background's statistics."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from frames import MotionError
from frames.design import MotionSet, NearFaultPulse, pulse_motions, synthetic_near_fault
from frames.design.hazard.stochastic_motion import (
    PointSource,
    envelope,
    pulse_period,
    stochastic_acceleration,
)
from frames.design.hazard.synthetic_motions import PulseScatter, with_pulse
from frames.motion.spectra import response_spectrum
from frames.motion.transforms import integrated
from tests.refusals import refused

PULSE = NearFaultPulse(velocity=1.2, period=3.0, gamma=1.7, phase=0.8, time=4.0)


@pytest.mark.parametrize("gamma", [1.2, 2.0, 2.7])
@pytest.mark.parametrize("phase", [0.0, 1.0, math.pi / 2.0])
def test_velocity_is_the_derivative_and_the_integral(gamma: float, phase: float) -> None:
    pulse = NearFaultPulse(velocity=0.9, period=2.0, gamma=gamma, phase=phase)
    times, step = np.linspace(0.01, pulse.duration - 0.01, 50), 1e-6
    slope = (pulse.velocities(times + step) - pulse.velocities(times - step)) / (2.0 * step)
    np.testing.assert_allclose(pulse.accelerations(times), slope, atol=1e-8)
    for time in times[::10]:
        moved = quad(lambda t: float(pulse.velocities(t)), 0.0, time, epsabs=1e-12)[0]
        assert float(pulse.displacements(time)) == pytest.approx(moved, abs=1e-11)
    assert float(pulse.displacements(2.0 * pulse.duration)) == pytest.approx(pulse.left, abs=1e-12)


def test_what_the_pulse_is_known_for() -> None:
    """Peak of a symmetric one is A, its ends rest; an antisymmetric one leaves nothing."""
    symmetric = NearFaultPulse(velocity=1.0, period=2.0, gamma=1.5, phase=0.0)
    times = np.linspace(-1.0, 4.0, 5001)
    speeds = symmetric.velocities(times)
    assert speeds.max() == 1.0
    assert times[speeds.argmax()] == pytest.approx(1.5)
    assert np.abs(speeds[(times < 0.0) | (times > 3.0)]).max() < 1e-15
    # A / (4 pi f_p (1 - gamma^2)) (sin(nu + pi gamma) - sin(nu - pi gamma)), gamma = 1.5, nu = 0
    assert symmetric.left == pytest.approx(2.0 / (4.0 * math.pi * -1.25) * -2.0)
    odd = NearFaultPulse(velocity=1.0, period=2.0, gamma=1.5, phase=math.pi / 2.0)
    assert odd.left == 0.0
    # largest acceleration of the odd one, at its middle: A omega
    assert np.abs(odd.accelerations(times)).max() == pytest.approx(math.pi, rel=1e-6)


def test_response_of_an_oscillator_to_the_pulse() -> None:
    """The spectrum by time steps against Duhamel's integral of the closed form."""
    dt, ratio = 0.005, 0.05
    values = PULSE.accelerations(dt * np.arange(2400))
    for period in (1.0, 3.0, 6.0):
        w = 2.0 * math.pi / period
        damped, fine = w * math.sqrt(1.0 - ratio**2), 0.002 * np.arange(6001)
        impulse = np.exp(-ratio * w * fine) * np.sin(damped * fine) / damped
        path = 0.002 * np.convolve(PULSE.accelerations(fine), impulse)[:6001]
        found = response_spectrum(values, dt, [period], ratio)["displacement"].to_numpy()[0]
        assert found == pytest.approx(np.abs(path).max(), rel=2e-3)


def test_pulses_of_a_grid_have_their_peak_velocities() -> None:
    """By integration of what is sampled; two cycles leave no displacement of either shape."""
    found = pulse_motions([1.2, 3.0], [0.5, 2.0], shapes=["symmetric", "antisymmetric"])
    assert len(found) == 8
    for name, motion in found.items():
        known = found.facts[name]
        velocity, moved = integrated(motion.x, motion.dt)
        peak, period = known["pulse velocity"], known["pulse period"]
        assert np.abs(velocity).max() == pytest.approx(peak, rel=1e-3)
        assert motion.duration == pytest.approx(2.0 * period)
        assert abs(moved[-1]) < 2e-3 * np.abs(moved).max()
        mirrored = velocity[::-1] * (1.0 if known["pulse shape"] == "symmetric" else -1.0)
        np.testing.assert_allclose(velocity, mirrored, atol=2e-3 * peak)


def test_period_of_the_magnitude() -> None:
    assert pulse_period(5.8) == pytest.approx(1.0)
    assert pulse_period(7.8) == pytest.approx(10.0)


def test_corner_frequency_in_boores_units() -> None:
    """4.9e6 beta (stress / M0)^(1/3) in km/s, bar, dyne cm; log10 M0 = 1.5 M + 16.05."""
    source = PointSource(magnitude=6.0, distance=10.0)
    hand = 4.9e6 * 3.5 * (100.0 / 10.0 ** (1.5 * 6.0 + 16.05)) ** (1.0 / 3.0)
    assert source.corner_frequency == pytest.approx(hand)


def test_envelope_is_one_at_its_peak_and_falls_to_what_rests() -> None:
    assert envelope(4.0, 10.0) == pytest.approx(1.0)
    assert envelope(20.0, 10.0) == pytest.approx(0.05)
    assert envelope([-1.0, 0.0], 10.0).tolist() == [0.0, 0.0]


def test_mean_spectrum_of_the_background_is_the_target() -> None:
    """Of 400 samples, averaged over 40 frequencies each: within 4 % (2 % expected)."""
    source = PointSource(magnitude=6.0, distance=10.0)
    dt, steps, rng = 0.01, 2400, np.random.default_rng(5)
    samples = np.array([stochastic_acceleration(source, dt, steps, rng) for _ in range(400)])
    power = (dt * np.abs(np.fft.rfft(samples)) ** 2 * dt).mean(axis=0)
    target = source.fourier_amplitudes(np.fft.rfftfreq(steps, dt)) ** 2
    ratio = (power[1:1201] / target[1:1201]).reshape(-1, 40).mean(axis=1)
    assert np.abs(np.sqrt(ratio) - 1.0).max() < 0.04


def test_the_pulse_rules_near_its_frequency() -> None:
    dt, n = 0.01, 3000
    source = PointSource(magnitude=6.0, distance=10.0)
    noise = stochastic_acceleration(source, dt, n - 300, np.random.default_rng(2))
    noise = np.concatenate([np.zeros(300), noise])  # the ends are tapered
    wave = PULSE.accelerations(dt * np.arange(n))
    both = with_pulse(noise, wave, dt)
    f = np.fft.rfftfreq(n, dt)
    made, pulse, before = (np.abs(np.fft.rfft(a)) for a in (both, wave, noise))
    near, far = np.abs(f - 1.0 / 3.0) < 0.05, f > 5.0
    assert np.abs(made[near] / pulse[near] - 1.0).max() < 0.05
    assert (made[far] ** 2).sum() == pytest.approx((before[far] ** 2).sum(), rel=0.02)
    np.testing.assert_allclose(with_pulse(noise, np.zeros(n), dt)[300:-300], noise[300:-300])


def test_a_set_can_be_made_again_and_comes_to_rest() -> None:
    motions, again = (synthetic_near_fault(3, 6.8, 5.0, seed=4) for _ in range(2))
    assert isinstance(motions, MotionSet)
    other = synthetic_near_fault(3, 6.8, 5.0, seed=5)
    for name, motion in motions.items():
        known = motions.facts[name]
        for axis in "xyz":
            values = getattr(motion, axis)
            assert (values == getattr(again[name], axis)).all()
            assert values[0] == pytest.approx(0.0, abs=0.02)
            velocity, displacement = integrated(values, motion.dt)
            assert abs(velocity[-1]) < 1e-10
            assert abs(displacement[-1]) < 1e-10
        assert not np.array_equal(motion.x[:2000], other[name].x[:2000])
        speed = np.abs(integrated(motion.x, motion.dt)[0]).max()
        assert speed == pytest.approx(known["pulse velocity"], rel=0.35)
        assert np.abs(integrated(motion.y, motion.dt)[0]).max() < speed
    # the first of three is the first of one: motions can be added to a set
    assert (
        synthetic_near_fault(1, 6.8, 5.0, seed=4)["near-fault 1"].x == motions["near-fault 1"].x
    ).all()
    assert synthetic_near_fault(1, 6.8, 5.0, seed=4, vertical_ratio=0.0)["near-fault 1"].z is None


def test_scatter_of_pulses() -> None:
    """Of 2000 pulses: medians and dispersions as stated, within 3 standard errors."""
    scatter, rng = PulseScatter(velocity=0.8), np.random.default_rng(1)
    pulses = [scatter.pulse(7.0, rng) for _ in range(2000)]
    for values, median in (
        ([p.velocity for p in pulses], 0.8),
        ([p.period for p in pulses], pulse_period(7.0)),
    ):
        logs = np.log(values)
        assert logs.mean() == pytest.approx(math.log(median), abs=3 * 0.3 / math.sqrt(2000))
        assert logs.std() == pytest.approx(0.3, abs=3 * 0.3 / math.sqrt(4000))
    gammas = np.array([p.gamma for p in pulses])
    assert gammas.min() > 1.1
    assert gammas.max() < 3.0


def test_what_makes_no_sense_is_refused() -> None:
    for wrong, words in (
        ({"gamma": 1.0}, "above 1"),
        ({"period": 0.0}, "period"),
        ({"phase": math.nan}, "phase"),
    ):
        given = {"velocity": 1.0, "period": 2.0, "gamma": 2.0, "phase": 0.0} | wrong
        refused(MotionError, words, NearFaultPulse, **given)
    refused(MotionError, r"10\.5|magnitude", synthetic_near_fault, 1, 10.5, 5.0, seed=1)
    refused(MotionError, "farther away", synthetic_near_fault, 1, 6.5, 50.0, seed=1)
    source = PointSource(magnitude=6.5, distance=8.0)
    with pytest.raises(MotionError, match=r"source\.distance"):
        synthetic_near_fault(1, 6.5, 5.0, seed=1, source=source)
    refused(TypeError, "seed", synthetic_near_fault, 1, 6.5, 5.0, seed=None)  # type: ignore[arg-type]
    refused(MotionError, "count", synthetic_near_fault, 0, 6.5, 5.0, seed=1)
    with pytest.raises(MotionError, match="use more samples"):
        stochastic_acceleration(source, 0.01, 100, np.random.default_rng(1))
    with pytest.raises(MotionError, match="must rise"):
        PointSource(magnitude=6.0, distance=1.0, amplification=((2.0, 1.0), (1.0, 1.0)))
    refused(MotionError, "gamma", PulseScatter, gamma=(0.5, 2.0))
