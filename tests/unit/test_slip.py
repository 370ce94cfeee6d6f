"""Return map, friction law and contact law, one by one."""

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from lir_element import CoulombFriction, FrictionLaw, VelocityFriction
from lir_element.kernels.friction_law import coefficient
from lir_element.kernels.slip import (
    friction_map,
    kelvin_voigt,
    kept_share,
    return_map,
    speed_at_end,
    stored,
)
from lir_element.layout import Props
from tests.scenes import simple_bearing

U_Y = 0.25e-3
KEPT = (1.0, 0.0)  # share of z that a constant axial force leaves, and its derivative
STEP = st.floats(-5e-3, 5e-3)
ANGLE = st.floats(-math.pi, math.pi)
LAWS = [(0, 2.0), (1, 1.0), (1, 2.0), (1, 5.5), (1, 40.0)]


def turned(x: float, y: float, angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


@pytest.mark.quick
@pytest.mark.parametrize(("bouc_wen", "eta"), LAWS)
@given(size=st.floats(0.0, 1.0), angle=ANGLE, d_1=STEP, d_2=STEP, turn=ANGLE)
def test_isotropy(bouc_wen, eta, size, angle, d_1, d_2, turn):
    """Turning state and step by an angle turns z and its derivative, and keeps the slip."""
    z = turned(size, 0.0, angle)
    one = return_map(bouc_wen, eta, *z, d_1, d_2, U_Y)
    two = return_map(bouc_wen, eta, *turned(*z, turn), *turned(d_1, d_2, turn), U_Y)
    c, s = math.cos(turn), math.sin(turn)
    r = np.array([[c, -s], [s, c]])
    # round-off of size 1e-16 times |b| <= 30
    assert_allclose(two[:2], r @ one[:2], rtol=0.0, atol=2e-14)
    assert_allclose(two[6], one[6], rtol=0.0, atol=1e-16)
    if abs(math.hypot(z[0] + d_1 / U_Y, z[1] + d_2 / U_Y) - 1.0) < 1e-9:
        return  # at the corner the derivative jumps
    if abs((z[0] + d_1 / U_Y) * d_1 + (z[1] + d_2 / U_Y) * d_2) < 1e-12:
        return
    k_1, k_2 = (np.reshape(out[2:6], (2, 2)) * U_Y for out in (one, two))
    # |b| divides in the hoop direction; close to b = 0 its direction rounds
    limit = 1e-12 / max(math.hypot(z[0] + d_1 / U_Y, z[1] + d_2 / U_Y), 1e-3)
    assert_allclose(k_2, r @ k_1 @ r.T, rtol=0.0, atol=limit)


@pytest.mark.quick
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_elastic_plastic_by_hand(sign: float) -> None:
    """Elastic up to u_y, then z on the circle in the direction of the trial value."""
    out = return_map(0, 2.0, 0.0, 0.0, sign * 0.4 * U_Y, 0.0, U_Y)
    assert_allclose(out, [sign * 0.4, 0, 1 / U_Y, 0, 0, 1 / U_Y, 0, 0, 0], rtol=1e-15)
    out = return_map(0, 2.0, sign * 0.6, 0.0, sign * 2.4 * U_Y, sign * 4.0 * U_Y, U_Y)
    z_1, z_2, k_11, k_12, k_21, k_22, slip, _, _ = out
    # b = (3, 4): |b| = 5, slip 4 u_y; derivative (1 - e e') / 5 u_y
    assert_allclose([z_1, z_2, slip], [sign * 0.6, sign * 0.8, 4.0 * U_Y], rtol=1e-14)
    expected = np.array([0.64, -0.48, -0.48, 0.36]) / (5.0 * U_Y)
    assert_allclose([k_11, k_12, k_21, k_22], expected, rtol=1e-13)


@pytest.mark.quick
@given(size=st.floats(0.0, 1.0), angle=ANGLE, d_1=STEP, d_2=STEP)
def test_large_exponent_is_elastic_plastic(size, angle, d_1, d_2):
    """The two radii differ by at most ln(2 + kappa) / eta or so: 1e-4 at eta = 1e5."""
    z = turned(size, 0.0, angle)
    plastic = return_map(0, 2.0, *z, d_1, d_2, U_Y)
    smooth = return_map(1, 1e5, *z, d_1, d_2, U_Y)
    assert_allclose(smooth[:2], plastic[:2], rtol=0.0, atol=1e-4)
    assert_allclose(smooth[6], plastic[6], rtol=0.0, atol=1e-4 * U_Y)


@pytest.mark.quick
@pytest.mark.parametrize(("bouc_wen", "eta"), LAWS)
@given(size=st.floats(0.0, 0.999), angle=ANGLE, d_1=STEP, d_2=STEP)
def test_derivative(bouc_wen, eta, size, angle, d_1, d_2):
    """Against central differences of fourth order, away from the corners (start of slip)."""
    z = np.array(turned(size, 0.0, angle))
    b = z + np.array([d_1, d_2]) / U_Y
    far = math.hypot(*b)
    kappa = (b @ [d_1, d_2]) / U_Y / max(far, 1e-9)
    if abs(far - 1.0) < 2e-2 or abs(kappa) < 2e-2 or far < 5e-2:
        return
    h = 1e-3 * U_Y * min(far, 1.0)

    def at(x: float, y: float) -> np.ndarray:
        return np.array(return_map(bouc_wen, eta, *z, d_1 + x, d_2 + y, U_Y))

    columns = []
    for x, y in ((h, 0.0), (0.0, h)):
        near, wide = (at(m * x, m * y) - at(-m * x, -m * y) for m in (1, 2))
        columns.append((8.0 * near - wide) / (12.0 * h))
    out = at(0.0, 0.0)
    by_1, by_2 = columns
    # fourth order in 1e-3: eta^4 1e-12 at the worst, and round-off of 1e-15 / 1e-3
    limit = max(1e-9, 1e-11 * eta**4)
    expected = [by_1[0], by_2[0], by_1[1], by_2[1]]
    assert_allclose(np.array(out[2:6]) * U_Y, np.array(expected) * U_Y, rtol=0.0, atol=limit)
    assert_allclose(out[7:9], [by_1[6], by_2[6]], rtol=0.0, atol=limit)


Path = Callable[[float], np.ndarray]


def path_of(seed: int) -> tuple[Path, Path]:
    """Return a smooth random plane path w(t), 0 <= t <= 1, of some ten u_y, and its rate."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(4, 2)) * 4.0 * U_Y
    k = np.arange(1, 5)[:, None] * math.pi

    def path(t: float) -> np.ndarray:
        return np.sum(a * np.sin(k * t), axis=0)

    def rate(t: float) -> np.ndarray:
        return np.sum(a * k * np.cos(k * t), axis=0)

    return path, rate


def integrated(bouc_wen: int, eta: float, path: Path, steps: int) -> np.ndarray:
    z, old = np.zeros(2), path(0.0)
    for t in np.linspace(0.0, 1.0, steps + 1)[1:]:
        new = path(t)
        z = np.array(return_map(bouc_wen, eta, *z, *(new - old), U_Y)[:2])
        old = new
    return z


@pytest.mark.parametrize(("eta", "seed", "sign"), [(1.0, 1, 1.0), (2.0, 2, -1.0), (4.5, 3, 1.0)])
def test_bouc_wen_is_its_rate_law(eta: float, seed: int, sign: float) -> None:
    """Against an ODE solver, on random plane paths: first order in the step.

    Park, Wen and Ang (1986), isotropic, A = 1, beta = gamma = 1/2, general exponent:
    u_y dz/dt = v - z |z|^(eta - 2) (|z . v| + z . v) / 2.
    """
    path, rate = path_of(seed)

    def law(t: float, z: np.ndarray) -> np.ndarray:
        v = sign * rate(t)
        power = z @ v
        size = max(math.hypot(*z), 1e-30)
        return (v - z * size ** (eta - 2.0) * 0.5 * (abs(power) + power)) / U_Y

    exact = solve_ivp(law, (0.0, 1.0), [0.0, 0.0], rtol=1e-9, atol=1e-10, max_step=2e-3).y[:, -1]
    errors = [
        np.linalg.norm(integrated(1, eta, lambda t: sign * path(t), n) - exact)
        for n in (2000, 8000)
    ]
    # Steps of some 1e-2 u_y; backward Euler: four times the steps, a quarter of the error.
    assert errors[0] < 2e-2
    assert errors[1] < 0.3 * errors[0] + 1e-6
    extrapolated = (
        4.0 * integrated(1, eta, lambda t: sign * path(t), 8000)
        - integrated(1, eta, lambda t: sign * path(t), 2000)
    ) / 3.0
    assert_allclose(extrapolated, exact, rtol=0.0, atol=1e-4)  # second order is left


def rubbed(law: FrictionLaw) -> Props:
    """Return the properties of a bearing whose surfaces have a law."""
    bearing = simple_bearing(capacity=0.2, friction=law, interface_friction=0.2)
    return bearing.to_record()[0]


@pytest.mark.quick
@pytest.mark.parametrize("speed", [0.0, 1e-4, 0.02, 0.1, 0.5, 3.0])
def test_friction_is_equation_one(speed: float) -> None:
    """mu = f_max - (f_max - f_min) exp(-alpha v), the numerical example's parameters."""
    p = rubbed(VelocityFriction(0.065, 0.0325, 15.0))
    mu, slope = coefficient(p, 1, speed)
    assert_allclose(mu, 0.065 - 0.0325 * math.exp(-15.0 * speed), rtol=1e-15)
    h = 1e-5
    at = [coefficient(p, 1, speed + k * h)[0] for k in (-1, 1)]
    # second order in 15 h = 1.5e-4
    assert_allclose(slope, (at[1] - at[0]) / (2.0 * h), rtol=1e-7, atol=1e-11)


@pytest.mark.quick
def test_friction_of_coulomb() -> None:
    coulomb, level = rubbed(CoulombFriction(0.066)), rubbed(VelocityFriction(0.066, 0.046, 0.0))
    assert_allclose(coefficient(coulomb, 0, 0.3), (0.066, 0.0), rtol=0.0, atol=0.0)
    assert_allclose(coefficient(level, 0, 0.3)[1], 0.0, rtol=0.0, atol=0.0)


@pytest.mark.quick
def test_contact_by_hand() -> None:
    """k pen + c (pen - pen_old) / dt; static without the damper; open: nothing."""
    assert_allclose(kelvin_voigt(2e-3, 1.5e-3, 1e8, 4e5, 0.01), (2.2e5, 1.4e8, 2e-3), rtol=1e-14)
    assert_allclose(kelvin_voigt(2e-3, 2.5e-3, 1e8, 4e5, 0.01), (1.8e5, 1.4e8, 2e-3), rtol=1e-14)
    assert_allclose(kelvin_voigt(2e-3, 1.5e-3, 1e8, 4e5, 0.0), (2e5, 1e8, 2e-3), rtol=1e-14)
    for gap in (0.0, -1e-9, -1.0, -math.inf):
        assert kelvin_voigt(gap, 1e-3, 1e8, 4e5, 0.01) == (0.0, 0.0, 0.0)


@pytest.mark.quick
@given(
    gap=st.floats(-1e-2, 1e-2),
    old=st.floats(0.0, 1e-2),
    k=st.floats(1e3, 1e10),
    c=st.floats(0.0, 1e8),
    dt=st.floats(0.0, 1.0),
)
def test_contact_never_pulls(gap: float, old: float, k: float, c: float, dt: float) -> None:
    force, slope, closure = kelvin_voigt(gap, old, k, c, dt)
    assert force >= 0.0
    assert slope >= 0.0
    assert closure == max(gap, 0.0)
    assert (force > 0.0) == (slope > 0.0) or force == 0.0


@pytest.mark.quick
@pytest.mark.parametrize(("bouc_wen", "eta"), LAWS)
@given(
    size=st.floats(0.0, 1.0),
    angle=ANGLE,
    d_1=STEP,
    d_2=STEP,
    bend=st.floats(-0.8, 0.8),
    before=st.floats(0.1, 3.0),
    share=st.floats(0.1, 0.9),
)
def test_derivative_half_a_step_ahead(bouc_wen, eta, size, angle, d_1, d_2, bend, before, share):
    """Against differences of fourth order, on paths that bend by `bend` from step to step."""
    z = np.array(turned(size, 0.0, angle))
    b = z + np.array([d_1, d_2]) / U_Y
    far, step = math.hypot(*b), math.hypot(d_1, d_2)
    kappa = (b @ [d_1, d_2]) / U_Y / max(far, 1e-9)
    if abs(far - 1.0) < 2e-2 or abs(kappa) < 2e-2 or far < 5e-2 or step < 0.2 * U_Y:
        return
    last = before * np.array(turned(d_1, d_2, -bend))
    h = 1e-3 * min(U_Y * min(far, 1.0), step)

    def at(x: float, y: float) -> np.ndarray:
        return np.array(friction_map(bouc_wen, eta, *z, d_1 + x, d_2 + y, U_Y, *KEPT, *last, share))

    columns = []
    for x, y in ((h, 0.0), (0.0, h)):
        near, wide = (at(m * x, m * y) - at(-m * x, -m * y) for m in (1, 2))
        columns.append((8.0 * near - wide) / (12.0 * h))
    out = at(0.0, 0.0)
    assert_allclose(np.hypot(*out[:2]), np.hypot(*return_map(bouc_wen, eta, *z, d_1, d_2, U_Y)[:2]))
    limit = max(1e-8, 1e-10 * eta**4)
    found = out[2:6] * U_Y
    expected = np.array([columns[0][0], columns[1][0], columns[0][1], columns[1][1]]) * U_Y
    assert_allclose(found, expected, rtol=0.0, atol=limit)


@pytest.mark.quick
@pytest.mark.parametrize("steps", [32, 128])  # a step of 16 and of 4 yield displacements
def test_direction_on_a_circle(steps: int) -> None:
    """At the end of a step z has the direction that the rate law has then, on a circle too."""
    radius, turns = 0.02, 1.5
    count = int(steps * turns)
    phase = np.linspace(0.0, 2.0 * np.pi * turns, count + 1)
    path = radius * np.column_stack([np.sin(phase), 1.0 - np.cos(phase)])
    increments = np.diff(path, axis=0)
    lags = {}
    for name in ("ahead", "plain"):
        z, last = np.zeros(2), np.zeros(2)
        for dw in increments:
            last_share = 0.5 if name == "ahead" and last.any() else 0.0
            z = np.array(friction_map(0, 2.0, *z, *dw, U_Y, *KEPT, *last, last_share)[:2])
            last = dw
        direction = math.atan2(z[1], z[0])
        lags[name] = (phase[-1] - direction + np.pi) % (2.0 * np.pi) - np.pi
    exact = math.asin(U_Y / radius)  # z' = (v - z (z . v)) / u_y on a circle, steady
    half = np.pi / steps
    assert lags["plain"] - exact == pytest.approx(half, rel=0.1)
    assert abs(lags["ahead"] - exact) < 0.12 * half


@pytest.mark.quick
def test_speed_at_the_end() -> None:
    """Exact for speeds that change linearly; never negative; plain without a step before."""
    assert speed_at_end(0.0, 0.01, 1e-3, 0.01, 0.5)[0] == 0.0
    assert speed_at_end(2e-3, 0.01, 0.0, 0.02, 0.3) == (0.2, 100.0)
    speeds, times = (0.1, 0.4), (0.02, 0.01)  # means of two steps of a uniform acceleration
    share = times[1] / sum(times)
    rate = (speeds[1] - speeds[0]) / (0.5 * sum(times))
    slips = [v * t for v, t in zip(speeds, times, strict=True)]
    ahead, by_slip = speed_at_end(slips[1], times[1], slips[0], times[0], share)
    assert ahead == pytest.approx(speeds[1] + 0.5 * times[1] * rate)
    assert by_slip == pytest.approx((1.0 + share) / times[1])
    assert speed_at_end(1e-5, 0.01, 5e-3, 0.01, 0.5) == (0.0, 0.0)


@pytest.mark.quick
@pytest.mark.parametrize(("bouc_wen", "eta"), LAWS)
@given(
    size=st.floats(0.0, 1.0),
    angle=ANGLE,
    d_1=STEP,
    d_2=STEP,
    before=st.floats(0.0, 1e7),
    push=st.floats(-1e5, 1e7),
    floor=st.floats(0.0, 1e3),
)
def test_never_beyond_the_cone_under_a_changing_force(
    bouc_wen, eta, size, angle, d_1, d_2, before, push, floor
):
    """Whatever the axial force does, lift-off and landing among it; numbers stay finite."""
    kept = kept_share(before, push, floor)
    out = np.array(
        friction_map(bouc_wen, eta, *turned(size, 0.0, angle), d_1, d_2, U_Y, *kept, 0.0, 0.0, 0.0)
    )
    assert np.isfinite(out).all()
    assert math.hypot(out[0], out[1]) <= 1.0 + 1e-15
    assert out[6] >= 0.0
    if before == 0.0 and floor == 0.0 < push:
        assert kept == (0.0, 0.0)  # it lands with nothing stored
    if max(before, push) <= floor:
        assert kept == (1.0, 0.0)


@pytest.mark.quick
@pytest.mark.parametrize("share", [0.0, 0.5])
@pytest.mark.parametrize(("bouc_wen", "eta"), LAWS)
@pytest.mark.parametrize("seed", range(12))
def test_derivative_by_the_axial_force(seed: int, bouc_wen: int, eta: float, share: float) -> None:
    """Against differences of fourth order, away from the corners."""
    rng = np.random.default_rng(seed)
    z = np.array(turned(rng.uniform(0.0, 0.95), 0.0, rng.uniform(-math.pi, math.pi)))
    d = np.array(turned(rng.choice([0.1, 0.6, 4.0]) * U_Y, 0.0, rng.uniform(-math.pi, math.pi)))
    last = np.array(turned(*d, rng.uniform(-0.5, 0.5)))
    old, push = 1e5, 1e5 * rng.uniform(0.3, 3.0)

    def at(force: float) -> np.ndarray:
        kept = kept_share(old, force, 1e2)
        return np.array(friction_map(bouc_wen, eta, *z, *d, U_Y, *kept, *last, share))

    kept = kept_share(old, push, 1e2)[0]
    b = kept * z + 0.5 * (1.0 + kept) * d / U_Y
    kappa = float(b @ d) / math.hypot(*b) / U_Y
    corner = min(abs(math.hypot(*b) - 1.0), abs(kappa), abs(math.hypot(*b) - 1.0 - kappa))
    if corner < 2e-2 or math.hypot(*b) < 5e-2:
        pytest.skip("at a corner")
    h = 1e-3 * push
    near, wide = (at(push + m * h) - at(push - m * h) for m in (1, 2))
    by_push = (8.0 * near - wide) / (12.0 * h)
    limit = max(1e-8, 1e-10 * eta**4)
    assert_allclose(push * at(push)[9:11], push * by_push[:2], rtol=0.0, atol=limit)
    assert by_push[6] == 0.0  # an axial force gives sliding no speed


@pytest.mark.quick
def test_store_takes_up_the_work() -> None:
    """Stuck under any axial force: what friction takes is stored, whatever the axial force does.

    z follows dz = du / u_y - z dN / (2 N); with steps halved the errors fall by four.
    """
    mu = 0.07

    def force(t: float) -> float:
        return 1e5 * (1.0 + 0.6 * math.sin(9.0 * t) + 0.2 * math.sin(23.0 * t))

    def place(t: float) -> np.ndarray:
        return 0.2 * U_Y * np.array([math.sin(3.0 * t), math.sin(4.0 * t + 0.3) - math.sin(0.3)])

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        h = 1e-5
        du = (place(t + h) - place(t - h)) / (2.0 * h)
        fall = (force(t + h) - force(t - h)) / (4.0 * h * force(t))
        return np.array([*(du / U_Y - y[:2] * fall), mu * force(t) * y[:2] @ du])

    exact = solve_ivp(rate, (0.0, 4.0), np.zeros(3), rtol=1e-10, atol=1e-12).y[:, -1]
    assert exact[2] == pytest.approx(stored(mu, force(4.0), U_Y, exact[0], exact[1]), rel=1e-6)
    errors = []
    for count in (800, 1600):
        z, work = np.zeros(2), 0.0
        times = np.linspace(0.0, 4.0, count + 1)
        for before, after in itertools.pairwise(times):
            old, new, du = force(before), force(after), place(after) - place(before)
            share = kept_share(old, new, 0.0)
            last, z = z, np.array(friction_map(0, 2.0, *z, *du, U_Y, *share, 0.0, 0.0, 0.0)[:2])
            work += 0.5 * mu * float((old * last + new * z) @ du)
        errors.append([*(z - exact[:2]), work / exact[2] - 1.0])
    assert np.abs(errors[1]).max() < 1e-3
    assert (np.array(errors[0]) / errors[1] > 3.8).all()
