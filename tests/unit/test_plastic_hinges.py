"""Plastic hinges of a member: closest point, surface, tangent and hardening by other routes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from frames import ModelError
from frames.assembly.members import local_stiffness, member_arrays
from frames.assembly.nonlinear import BASIC, _hinges
from frames.assembly.system import HINGE, STATE_SIZE, STRIDE
from frames.kernels.hinges import hinged_member, place, surface, turn_hinges
from frames.laws import PlasticHinge
from frames.library.models import DEFAULT_BEAM, DEFAULT_COLUMN

LENGTH = 3.5
YIELD = 3.45e8  # Pa


def constants(hinges, section=DEFAULT_COLUMN):
    """Return the constants of a member of 3.5 m with hinges at its ends."""
    start, end, up = (np.array([v]) for v in ((0.0, 0, 0), (0.0, 0, LENGTH), (1.0, 0, 0)))
    stiffness = local_stiffness(member_arrays([section], start, end, up))[0]
    return _hinges(stiffness, np.zeros(12), hinges), stiffness[np.ix_(BASIC, BASIC)]


def trial(par, old, d):
    """Return forces (5,), their derivatives (5, 5), the new state, and whether it yields."""
    new, g, slope = np.zeros(STATE_SIZE), np.zeros(5), np.zeros((5, 5))
    code = hinged_member(par, old, new, d, g, slope, np.zeros((18, 16)))
    assert code >= 0
    k = par[:25].reshape(5, 5)
    return k @ d + g, k + slope, new, code


def interacting(exponent=1.5, hardening=0.02):
    return PlasticHinge(
        moment_y=9e5, moment_z=7e5, axial=1.2e7, axial_exponent=exponent, hardening=hardening
    )


def value(par, hinge, s, p):
    """Return the yield function of a hinge at member forces and its plastic parts."""
    at = HINGE + STRIDE * hinge
    sigma = np.array([s[place(hinge, i)] - par[at + 5 + i] * p[3 * hinge + i] for i in range(3)])
    return surface(par, at, sigma, np.zeros(3), np.zeros((3, 3)))


def random_path(rng, scale=1.0):
    """Return deformations (n, 5) that walk far beyond yield."""
    steps = rng.normal(size=(60, 5)) * np.array([4e-4, 3e-3, 3e-3, 3e-3, 3e-3]) * scale
    return np.cumsum(steps, axis=0)


@pytest.mark.parametrize("seed", range(12))
def test_states_lie_on_or_inside_the_surface_and_dissipate(seed):
    rng = np.random.default_rng(seed)
    hinge = interacting(rng.uniform(1.0, 2.5), float(rng.choice([0.0, 0.01, 0.1])))
    par, _ = constants((hinge, hinge))
    old, yielded = np.zeros(STATE_SIZE), 0
    for d in random_path(rng):
        s, _, new, code = trial(par, old, d)
        for h in (0, 1):
            at, part = HINGE + STRIDE * h, slice(3 * h, 3 * h + 3)
            assert value(par, h, s, new) < 1e-8
            moved = new[part] - old[part]
            back = [
                s[place(h, i)] - par[at + 5 + i] * new[3 * h + i] - (par[at + 3] if i == 0 else 0.0)
                for i in range(3)
            ]
            assert float(np.dot(back, moved)) >= -1e-9
            if moved.any():
                assert value(par, h, s, new) > -1e-8
        yielded += code
        old = new
    assert yielded > 10


@pytest.mark.parametrize("seed", range(6))
def test_the_step_is_the_closest_point_of_the_elastic_trial(seed):
    """The plastic parts minimise elastic energy, hardening and dissipation, a convex problem."""
    rng = np.random.default_rng(100 + seed)
    hinge = interacting(2.0, 0.05)
    par, k = constants((hinge, hinge))
    old = np.zeros(STATE_SIZE)
    d = random_path(rng)[-1]
    s, _, new, _ = trial(par, old, d)
    flex = np.linalg.inv(k)
    hard = np.array([par[HINGE + STRIDE * h + 5 + i] for h in (0, 1) for i in range(3)])
    to_six = np.array(
        [[float(place(h, i) == c) for c in range(5)] for h in (0, 1) for i in range(3)]
    )
    scale = np.array([1e7, 1e6, 1e6, 1e6, 1e6, *[1e7, 1e6, 1e6] * 2])

    def energy(x):  # complementary: member forces and back stresses
        force, back = (x * scale)[:5], (x * scale)[5:]
        gap = force - k @ d
        return 1e-4 * (0.5 * gap @ flex @ gap + 0.5 * np.sum(back**2 / hard))

    def inside(x):
        force, back = (x * scale)[:5], (x * scale)[5:]
        sigma = to_six @ force - back
        one = [np.zeros(3), np.zeros((3, 3))]
        return [-surface(par, HINGE + STRIDE * h, sigma[3 * h : 3 * h + 3], *one) for h in (0, 1)]

    begin = np.concatenate([0.5 * s, np.zeros(6)]) / scale
    done = minimize(
        energy,
        begin,
        constraints={"type": "ineq", "fun": inside},
        method="SLSQP",
        options={"maxiter": 500, "ftol": 1e-14},
    )
    ours = np.concatenate([s, hard * new[:6]]) / scale
    assert min(inside(ours)) > -1e-8
    assert energy(ours) <= energy(done.x) * (1.0 + 1e-5) + 1e-9
    assert_allclose(ours[:5], done.x[:5], rtol=0.0, atol=5e-3 * np.abs(ours[:5]).max())


@pytest.mark.parametrize("seed", range(4))
def test_the_step_is_the_same_from_a_state_near_by_and_from_one_that_is_none(seed):
    """What the last trial left is only where the search begins."""
    rng = np.random.default_rng(300 + seed)
    par, _ = constants((interacting(), interacting(1.0, 0.0)))
    old, turned = np.zeros(STATE_SIZE), 0
    path = random_path(rng, 0.3)

    def run(d, new, warm):
        flow, give = np.zeros(5), np.zeros((5, 5))
        code = turn_hinges(par, old, new, d, flow, give, np.zeros((18, 16)), warm)
        assert code >= 0
        return code, new, give

    for d in path:
        code, cold, give = run(d, old.copy(), False)
        for start in (
            run(d + 0.05 * rng.normal() * (d - path[0]), old.copy(), False)[1],
            old + np.r_[rng.normal(size=6) * 1e-2, np.zeros(4)],
            old + np.r_[np.full(6, math.nan), np.zeros(4)],
        ):
            found, new, by = run(d, start.copy(), True)
            assert found == code
            assert_allclose(new, cold, rtol=0.0, atol=1e-9 * np.abs(cold).max() + 1e-15)
            if code:
                assert_allclose(by, give, rtol=0.0, atol=1e-6 * np.abs(give).max())
        turned += code
        old = cold
    assert turned > 10


@pytest.mark.parametrize("seed", range(6))
def test_the_tangent_is_that_of_differences(seed):
    rng = np.random.default_rng(200 + seed)
    hinge = interacting(rng.uniform(1.0, 2.0), float(rng.choice([0.0, 0.03])))
    par, k = constants((hinge, hinge if seed % 2 else None))
    old, checked = np.zeros(STATE_SIZE), 0
    for d in random_path(rng, 0.5):
        _, tangent, new, code = trial(par, old, d)
        h = 1e-8
        if code:
            sides = [
                [trial(par, old, d + side * h * np.eye(5)[c]) for c in range(5)] for side in (-1, 1)
            ]
            same = all(one[3] == code for group in sides for one in group)
            differences = np.array(
                [(high[0] - low[0]) / (2 * h) for low, high in zip(*sides, strict=True)]
            ).T
            if same:
                off = np.abs(tangent - differences).max() / np.abs(k[1:, 1:]).max()
                checked += off < 1e-4
                assert off < 0.05 or np.median(np.abs(tangent - differences)) < 1e-4 * k[1, 1]
            assert_allclose(tangent, tangent.T, atol=1e-6 * np.abs(k).max())
        old = new
    assert checked > 15


def test_one_moment_alone_is_bilinear_in_double_curvature():
    hardening, moment = 0.04, 8e5
    par, k = constants((PlasticHinge(moment_y=moment, hardening=hardening),) * 2, DEFAULT_BEAM)
    stiff = k[3, 3] + k[3, 4]  # 6 E I / L
    first = moment / stiff
    old = np.zeros(STATE_SIZE)
    for factor in (0.5, 1.0, 2.0, 5.0, 3.5, -1.0, -6.0):
        d = np.zeros(5)
        d[3:] = factor * first
        s, _, old, _ = trial(par, old, d)
        if factor == 5.0:
            assert_allclose(s[3:], moment + hardening * stiff * 4.0 * first, rtol=1e-9)
        if factor == 3.5:  # unloads elastically
            assert_allclose(s[3:], moment * (1.0 + 4.0 * hardening - 1.5), rtol=1e-9)
        if factor == -6.0:  # 2 M below where it turned, then along the other line
            assert_allclose(s[3:], -moment * (1.0 - hardening) - hardening * stiff * 6.0 * first)
        assert not s[:3].any()


def test_moments_about_both_axes_lie_on_an_ellipse():
    hinge = PlasticHinge(moment_y=8e5, moment_z=5e5, hardening=0.0)
    par, _ = constants((hinge, None))
    for angle in np.linspace(0.1, 1.5, 8):
        d = np.zeros(5)
        d[1], d[3] = 0.05 * math.sin(angle), 0.05 * math.cos(angle)
        s, _, _, _ = trial(par, np.zeros(STATE_SIZE), d)
        assert_allclose(math.hypot(s[3] / 8e5, s[1] / 5e5), 1.0, rtol=1e-9)


@pytest.mark.parametrize("exponent", [1.0, 1.3, 2.0])
def test_axial_force_takes_moment(exponent):
    """Within 2 % of ``m + |n|^a = 1``, whose corners are rounded."""
    hinge = PlasticHinge(moment_y=9e5, axial=1.2e7, axial_exponent=exponent, hardening=0.0)
    par, k = constants((hinge, hinge))
    for share in (0.0, 0.2, 0.5, 0.8):
        moments = []
        for sign in (-1.0, 1.0):
            low, high = 0.0, 2.0
            for _ in range(60):
                m = 0.5 * (low + high)
                s = np.array([sign * share * 1.2e7, 0.0, 0.0, m * 9e5, m * 9e5])
                low, high = (low, m) if value(par, 0, s, np.zeros(6)) > 0.0 else (m, high)
            moments.append(low)
        assert_allclose(moments, 1.0 - share**exponent, atol=0.02)
        assert moments[0] == pytest.approx(moments[1], rel=1e-9)
    assert k[0, 0] > 0.0


def test_concrete_has_its_largest_moment_at_balance():
    balance = -2e6
    hinge = PlasticHinge(moment_y=6e5, axial=5e6, axial_centre=balance, hardening=0.0)
    par, _ = constants((hinge, None))
    at_zero = value(par, 0, np.array([0.0, 0, 0, 5.9e5, 0]), np.zeros(6))
    at_balance = value(par, 0, np.array([balance, 0, 0, 5.9e5, 0]), np.zeros(6))
    assert at_balance < 0.0 < at_zero


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "both infinite"),
        ({"moment_y": -1.0}, r"PlasticHinge: moment_y = -1 \[N m\]"),
        ({"moment_y": 1.0, "axial_centre": 1.0}, "axial_centre needs axial"),
        ({"moment_y": 1.0, "axial": 1.0, "axial_centre": 2.0}, "smaller than axial"),
        ({"moment_y": 1.0, "axial": 1.0, "axial_exponent": 0.5}, "axial_exponent"),
        ({"moment_y": 1.0, "hardening": 1.0}, "hardening"),
    ],
)
def test_numbers_out_of_bounds_are_refused(given, message):
    with pytest.raises(ModelError, match=message):
        PlasticHinge(**given)
