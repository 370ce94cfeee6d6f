"""Rims that are met obliquely spin the sliders, and the slip of the interface turns with them."""

import numpy as np
import pytest

from frames import GroundMotion, energy_error, lumped_mass, time_history
from validation.scenes import EXAMPLE_MASS, example_bearing

TIME = np.arange(0.0, 8.0, 0.005)
BELL = np.exp(-(((TIME - 2.5) / 1.5) ** 2))


def motion(along: float, across: float, phase: float) -> GroundMotion:
    """Push along x with 1.6 s and along y with 2.3 s [m/s2]: the slider runs along its rims."""
    x = along * BELL * np.sin(2 * np.pi * TIME / 1.6)
    y = across * along * BELL * np.sin(2 * np.pi * TIME / 2.3 + phase)
    return GroundMotion(x=x, y=y, dt=0.005)


def slips(data):
    sizes = data["interface_slip_size"].to_numpy()[:, 0]
    return 1e3 * float(sizes.max()), 1e3 * float(sizes[-1])


@pytest.fixture(scope="module")
def model():
    return lumped_mass(example_bearing(), EXAMPLE_MASS)


# Without spin the final slips are 87.4, 7.8 and 19.5 mm, where the bodies have 83.6, 11.2 and 16.5.
@pytest.mark.parametrize(
    "moves", [motion(1.6, 0.9, 2.4), motion(1.6, 0.9, 1.0), motion(2.0, 0.6, 1.0)]
)
def test_slip_is_that_of_sliders_as_bodies(model, moves):
    string, bodies = (time_history(model, moves, level=level) for level in ("pendulum", "contact"))
    for ours, theirs in zip(slips(string), slips(bodies), strict=True):
        assert ours == pytest.approx(theirs, abs=1.0)
    spin, true = (float(data["slider_spin"][-1, 0]) for data in (string, bodies))
    assert abs(true) > 0.05
    assert spin * true > 0.0
    assert energy_error(string) < 1e-3


def test_two_failures_apart(model):
    """Without spin the slip reaches 150 mm, and the bearing fails."""
    string = time_history(model, motion(1.8, 0.9, 2.4))
    assert string.attrs["status"] == "ok"
    assert slips(string)[1] == pytest.approx(105.5, abs=2.0)  # of the level 'contact'


def test_a_slider_that_meets_its_rims_head_on_does_not_spin(model):
    along = time_history(model, GroundMotion(x=motion(2.6, 0.0, 0.0).x, dt=0.005))
    assert slips(along)[0] > 20.0
    assert not along["slider_spin"].to_numpy().any()


def test_in_a_mirror_it_spins_the_other_way(model):
    moves = motion(1.6, 0.9, 2.4)
    seen = GroundMotion(x=moves.x, y=-moves.y, dt=0.005)
    one, other = (time_history(model, m)["slider_spin"].to_numpy() for m in (moves, seen))
    assert np.abs(one).max() > 0.1
    np.testing.assert_allclose(other, -one, rtol=0.0, atol=1e-9)


def test_spin_does_not_depend_on_the_step(model):
    moves = motion(2.0, 0.6, 1.0)
    chosen, fine = time_history(model, moves), time_history(model, moves, dt=5e-4)
    assert slips(chosen)[1] == pytest.approx(slips(fine)[1], abs=0.5)
    spin = [float(data["slider_spin"][-1, 0]) for data in (chosen, fine)]
    assert spin[0] == pytest.approx(spin[1], abs=0.01)
