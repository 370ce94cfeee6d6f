"""A vertical motion does not drive a bearing sideways by way of its friction."""

import numpy as np
import pytest

from frames import GroundMotion, energy_error, lumped_mass

WEIGHT = 286.73e3


@pytest.mark.parametrize("frequency", [8.0, 8.25, 8.5])
def test_vertical_shaking_at_twice_the_sticking_frequency(frequency, newhall_bearing, run):
    """0.5 g vertically and 1 mm/s2 sideways: it sticks, and moves by micrometres as a spring does.

    The static a / omega^2 with omega^2 = g f_min (R_1^2 + R_2^2) / (L^2 u_y) + g / L, 27 rad/s, is
    1.4 um. With a store that follows the axial force the motion grew to 0.7 mm and 0.48
    m/s2, and friction gave 120 J of nothing.
    """
    t = np.arange(0.0, 10.0, 0.001)
    motion = GroundMotion(
        x=1e-3 * np.sin(np.pi * t), z=0.5 * 9.80665 * np.sin(2.0 * np.pi * frequency * t), dt=0.001
    )
    data = run(lumped_mass(newhall_bearing, WEIGHT / 9.80665), motion, dt=0.001)
    b = newhall_bearing
    square = b.radii[0] ** 2 + b.radii[1] ** 2
    stiff = 0.0325 * square / (b.effective_radius**2 * b.yield_displacement)
    still = 1e-3 / (9.80665 * (stiff + 1.0 / b.effective_radius))
    assert float(np.abs(data["bearing_displacement"].sel(axis="x")).max()) < 10.0 * still
    stored = data["energy"].sel(term="friction_elastic")
    assert float(stored.min()) > -1e-9
    # two surfaces: W f_min u_y z^2 / 2 each, z = R u / (L u_y)
    most = 0.5 * WEIGHT * 0.0325 * square / b.yield_displacement
    assert float(stored.max()) < most * (10.0 * still / b.effective_radius) ** 2


@pytest.mark.meant("the bearings hardly slide")
@pytest.mark.parametrize("level", ["pendulum", "contact", "rigid_body"])
def test_what_a_permanent_load_stored_may_be_given_back(level, newhall_bearing, run):
    """A lateral load leaves friction half used; ground that pushes against it takes it away."""
    share, t = 0.5, np.arange(0.0, 0.3, 0.001)
    model = lumped_mass(newhall_bearing, WEIGHT / 9.80665)
    held = 0.0325 * sum(newhall_bearing.radii) / newhall_bearing.effective_radius
    model.add_load("mass", [share * held * WEIGHT, 0.0, 0.0, 0.0, 0.0, 0.0])
    push = share * held * 9.80665 * np.sin(2.0 * np.pi * t / 0.3) ** 2
    data = run(model, GroundMotion(x=push, dt=0.001), dt=0.001, level=level)
    stored = data["work_friction_elastic"].isel(bearing=0).to_numpy()
    # two surfaces: W f_min u_y z^2 / 2 each, z the share but for what the pendulum takes
    full = WEIGHT * 0.0325 * newhall_bearing.yield_displacement
    assert stored[0] == pytest.approx(share**2 * full, rel=0.05)
    assert stored.min() > -1e-9 * stored.max()
    assert stored.min() < 0.1 * stored[0]
    term = data["energy"].sel(term="friction_elastic").to_numpy()
    np.testing.assert_allclose(term, stored - stored[0], rtol=0.0, atol=1e-12 * full)
    assert energy_error(data) < 1e-3
