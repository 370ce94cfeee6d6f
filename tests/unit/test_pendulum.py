"""Design formulas of friction pendulums: published numbers, two surfaces in series, the element."""

import math

import numpy as np
import pytest

from frames.design import CheckError, FrictionPendulum
from lir_element import CoulombFriction, cyclic_test
from tests.scenes import wide_bearing

KIP, INCH = 4448.2216152605, 0.0254


def test_numbers_of_a_single_pendulum() -> None:
    """W = 1500 kN, R = 2.5 m, mu = 0.06, D = 0.30 m: k_p = 600 kN/m, Q = 90 kN, F = 270 kN."""
    p = FrictionPendulum((2.5,), (0.06,))
    force = p.force(0.30, 1500e3)
    assert force == pytest.approx(270e3, rel=1e-12)
    assert p.force(0.0, 1500e3) == pytest.approx(90e3, rel=1e-12)
    assert (force - p.force(0.2, 1500e3)) / 0.1 == pytest.approx(600e3, rel=1e-9)
    assert force / 0.30 == pytest.approx(900e3, rel=1e-12)
    beta = p.loop_energy(0.30, 1500e3) / (2.0 * math.pi * force * 0.30)
    assert beta == pytest.approx(0.21221, abs=5e-6)
    assert beta == pytest.approx(2.0 / math.pi * 0.06 / (0.06 + 0.30 / 2.5), rel=1e-12)


def test_restoring_force_of_a_bridge_bearing() -> None:
    """W = 450 kip, R = 152 in, D = 7.13 in: the second half of D adds 10.55 kip."""
    p = FrictionPendulum((152.0 * INCH,), (0.06,))
    gain = p.force(7.13 * INCH, 450.0 * KIP) - p.force(0.5 * 7.13 * INCH, 450.0 * KIP)
    assert gain / KIP == pytest.approx(10.55, abs=0.01)
    assert gain / KIP > 450.0 / 80.0


def series_loop(radii: list[float], frictions: list[float], peak: float) -> tuple[float, float]:
    """Return displacement at a peak force over load, and area of the loop, of surfaces in series.

    Each surface slides where the force is off its restoring force by more than its friction: a
    play operator of the force.
    """
    force = np.concatenate(
        [np.linspace(0, peak, 4000)]
        + 2
        * [
            peak * np.interp(np.arange(12000), [0, 4000, 12000], [1.0, 0.0, -1.0]),
            peak * np.interp(np.arange(12000), [0, 4000, 12000], [-1.0, 0.0, 1.0]),
        ]
    )
    u = np.zeros(len(force))
    for radius, mu in zip(radii, frictions, strict=True):
        x = 0.0
        for k, f in enumerate(force):
            x = min(max(x, f - mu), f + mu)
            u[k] += radius * x
    last = slice(len(force) - 24000, None)
    return float(u[last].max()), abs(float(np.trapezoid(force[last], u[last])))


def test_a_slider_with_a_joint_slides_on_one_surface_after_the_other() -> None:
    """R_eff = 0.95 + 0.95 m, mu = 0.05 / 0.09, W = 1000, D = 0.3 m."""
    p = FrictionPendulum((0.95, 0.95), (0.05, 0.09))
    assert p.effective_friction == pytest.approx(0.07, rel=1e-12)
    assert p.corner == pytest.approx(0.038, rel=1e-12)
    force = p.force(0.3, 1000.0)
    assert force == pytest.approx(227.89, abs=0.005)
    assert (force - p.force(0.2, 1000.0)) / 0.1 == pytest.approx(526.32, abs=0.005)
    period = 2.0 * math.pi * math.sqrt(1000.0 / (force / 0.3 * 9.81))
    assert 2.0 * math.pi * math.sqrt(1.9 / 9.81) == pytest.approx(2.7652, abs=5e-5)
    assert period < 2.7652
    # The bilinear loop's damping is a little high; the corners take their part off it.
    bilinear = 4.0 * 0.07 * 1000.0 * 0.3 / (2.0 * math.pi * force * 0.3)
    assert bilinear == pytest.approx(0.19554, abs=5e-6)
    exact = p.loop_energy(0.3, 1000.0) / (2.0 * math.pi * force * 0.3)
    assert exact < bilinear
    reached, area = series_loop([0.95, 0.95], [0.05, 0.09], force / 1000.0)
    assert reached == pytest.approx(0.3, rel=1e-6)
    assert p.loop_energy(0.3, 1000.0) == pytest.approx(1000.0 * area, rel=1e-3)


def test_unlike_radii_and_frictions() -> None:
    p = FrictionPendulum((0.6, 1.4), (0.08, 0.03))
    assert p.corner == pytest.approx(1.4 * 0.05)  # the surface of less friction slides alone
    reached, area = series_loop([0.6, 1.4], [0.08, 0.03], p.force(0.35, 1.0))
    assert reached == pytest.approx(0.35, rel=1e-6)
    assert p.loop_energy(0.35, 1.0) == pytest.approx(area, rel=1e-3)


def test_the_bearing_of_the_element_is_a_pendulum_below_its_rims() -> None:
    """Its rigid slider slides on both surfaces at once, whatever their frictions: no corner."""
    friction = (CoulombFriction(0.04), CoulombFriction(0.08))
    bearing = wide_bearing(radius=(1.0, 1.5), capacity=0.4, friction=friction)
    p = FrictionPendulum.of(bearing)
    assert p.effective_radius == pytest.approx(2.3)
    assert p.effective_friction == pytest.approx((0.04 * 1.0 + 0.08 * 1.5) / 2.3)
    assert (p.corner, p.capacity) == (0.0, pytest.approx(0.4))
    path = 0.2 * np.concatenate(
        [np.linspace(0, 1, 50), np.linspace(1, -1, 100)[1:], np.linspace(-1, 1, 100)[1:]]
    )
    data = cyclic_test(bearing, path, axial_load=1e6)
    force = np.asarray(data.bearing_force.sel(axis="x")).ravel()
    # Small angles in the formula: (U/L)^2 / 2 = 0.4 %, and mu U/L = 0.6 % of the axial force.
    assert force.max() == pytest.approx(p.force(0.2, 1e6), rel=1e-2)
    cycle = slice(49, None)
    area = np.trapezoid(force[cycle], path[cycle])
    assert area == pytest.approx(p.loop_energy(0.2, 1e6), rel=1e-2)


def test_what_is_no_pendulum_is_refused() -> None:
    with pytest.raises(CheckError, match="one or two surfaces"):
        FrictionPendulum((1.0, 1.0), (0.05,))
    with pytest.raises(CheckError, match=r"radii\[0\] = -1"):
        FrictionPendulum((-1.0,), (0.05,))
    with pytest.raises(CheckError, match=r"frictions\[0\] = nan"):
        FrictionPendulum((1.0,), (math.nan,))
    with pytest.raises(CheckError, match="below the corner"):
        FrictionPendulum((1.0, 1.0), (0.05, 0.09)).force(0.03, 1e3)
