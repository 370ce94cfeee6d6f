"""Laws of one deformation against closed forms, solutions of their equations, and differences."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from frames import ModelError
from frames.assembly.nonlinear import _law
from frames.assembly.system import STATE_SIZE
from frames.kernels.laws import uniaxial
from frames.laws import Bilinear, BoucWen, Gap, HertzGap, Pinching, PlasticHinge, Tie, ViscousDamper

LAWS = {
    "bilinear": Bilinear(stiffness=2e6, yield_force=1e4, hardening=0.05),
    "plastic": Bilinear(stiffness=2e6, yield_force=1e4),
    "bouc-wen": BoucWen(stiffness=2e6, yield_force=1e4, hardening=0.02, exponent=1.5, shape=0.7),
    "degrading": BoucWen(
        stiffness=2e6, yield_force=1e4, hardening=0.02, strength_loss=0.02, stiffness_loss=0.05
    ),
    "pinching": BoucWen(
        stiffness=2e6, yield_force=1e4, hardening=0.02, exponent=1.0, pinching=Pinching(rate=0.1)
    ),
    "tie": Tie(stiffness=2e6, yield_force=1e4, hardening=0.02, slack=0.002),
    "cable": Tie(stiffness=2e6),
    "linear damper": ViscousDamper(coefficient=3e4),
    "damper": ViscousDamper(coefficient=3e4, exponent=0.3),
    "maxwell": ViscousDamper(coefficient=3e4, exponent=0.4, stiffness=5e6),
    "stop": Gap(gap=0.01, stiffness=5e6, damping=2e4),
    "hertz": HertzGap(gap=0.01, stiffness=5e7, restitution=0.6),
}
AMPLITUDE, DT = 0.03, 0.002


def drive(law, d, dt=DT):
    """Take a law along deformations (n,); speeds by the trapezoidal rule, as a step has them."""
    kind, par = _law(law)
    old, new = np.zeros(STATE_SIZE), np.zeros(STATE_SIZE)
    force, slope = np.zeros(len(d)), np.zeros(len(d))
    v_old = 0.0
    for k in range(1, len(d)):
        v = 2.0 * (d[k] - d[k - 1]) / dt - v_old
        args = (d[k - 1], d[k], v_old, v, 2.0 / dt, dt)
        force[k], slope[k] = uniaxial(kind, par, old, new, *args)
        old[:], v_old = new, v
    return force, slope


def cycles(n=4000, growing=True):
    """Smooth cycles of deformation (n + 1,)."""
    t = np.linspace(0.0, 4.0, n + 1)
    size = t / 4.0 if growing else 1.0
    return AMPLITUDE * size * np.sin(2.0 * math.pi * t) * np.sin(0.5 * math.pi * np.minimum(t, 1.0))


@pytest.mark.parametrize("name", LAWS)
def test_the_derivative_is_that_of_differences(name):
    kind, par = _law(LAWS[name])
    d = cycles(400)
    old, new, other = (np.zeros(STATE_SIZE) for _ in range(3))
    v_old, worst = 0.0, []
    h = 1e-9
    for k in range(1, len(d)):
        rate = 2.0 / DT

        def at(x, state, k=k, v_old=v_old, rate=rate):
            v = rate * (x - d[k - 1]) - v_old
            return uniaxial(kind, par, old, state, d[k - 1], x, v_old, v, rate, DT)

        slope = at(d[k], new)[1]
        sides = [at(d[k] + side * h, other)[0] for side in (-1.0, 1.0)]
        middle = at(d[k], other)[0]
        one_sided = (middle - sides[0]) / h, (sides[1] - middle) / h
        scale = max(abs(slope), 2e6)
        worst.append(min(abs(slope - found) for found in one_sided) / scale)
        v_old = rate * (d[k] - d[k - 1]) - v_old
        old[:] = new
    assert max(worst) < 5e-3  # where pinching is deepest, and where a dashpot turns over
    assert np.median(worst) < 2e-5


def test_bilinear_is_an_elastic_plastic_spring_beside_an_elastic_one():
    law = LAWS["bilinear"]
    d = cycles()
    force, _ = drive(law, d)
    k, r, f = law.stiffness, law.hardening, law.yield_force
    plastic, sliding = 0.0, np.zeros(len(d))
    for i, each in enumerate(d):
        trial = (1.0 - r) * k * (each - plastic)
        limit = (1.0 - r) * f
        if abs(trial) > limit:
            plastic = each - math.copysign(limit, trial) / ((1.0 - r) * k)
        sliding[i] = (1.0 - r) * k * (each - plastic)
    assert_allclose(force, sliding + r * k * d, rtol=0.0, atol=1e-9 * f)


@pytest.mark.parametrize("name", ["bouc-wen", "degrading", "pinching"])
def test_bouc_wen_solves_its_equation(name):
    law = LAWS[name]
    steps = cycles(240)
    force, _ = drive(law, steps)
    u_y, p = law.yield_deformation, law.pinching

    def rate(s, y, sense):
        z, energy = y
        nu, eta = 1.0 + law.strength_loss * energy, 1.0 + law.stiffness_loss * energy
        bent = law.shape * np.sign(z * sense) + 1.0 - law.shape
        slope = (1.0 - nu * abs(z) ** law.exponent * bent) / eta
        if p is not None:
            depth = p.slip * (1.0 - math.exp(-p.rate * energy))
            spread = (p.width + p.spreading * energy) * (p.severity + depth)
            place = z * sense - p.place * (1.0 / nu) ** (1.0 / law.exponent)
            slope *= 1.0 - depth * math.exp(-((place / spread) ** 2))
        return [sense * slope, sense * z]

    y, found = np.zeros(2), [0.0]
    for before, after in itertools.pairwise(steps):
        way = (after - before) / u_y
        if way:
            done = solve_ivp(
                rate, (0.0, abs(way)), y, args=(np.sign(way),), rtol=1e-9, atol=1e-12, max_step=0.2
            )
            y = done.y[:, -1]
        r, k = law.hardening, law.stiffness
        found.append(k * (r * after + (1.0 - r) * u_y * y[0]))
    assert_allclose(force, found, rtol=0.0, atol=1e-4 * law.yield_force)


def test_a_tie_pulls_only_and_is_slack_by_what_it_yielded():
    law = LAWS["tie"]
    d = cycles()
    force, _ = drive(law, d)
    assert force.min() == 0.0
    first = np.flatnonzero(d > law.slack)[0]
    assert not force[:first].any()
    longest, longer = d.max(), law.slack + law.yield_deformation
    assert longest > longer
    top = law.yield_force + law.hardening * law.stiffness * (longest - longer)
    assert_allclose(force.max(), top, rtol=1e-3)
    last = int(d.argmax())
    yielded = longest - law.slack - top / law.stiffness
    back = d[last:] < law.slack + yielded
    assert not force[last:][back].any()


def test_a_cable_stays_elastic():
    d = cycles()
    force, _ = drive(LAWS["cable"], d)
    assert_allclose(force, 2e6 * d.clip(0.0), atol=1e-6)


def test_a_linear_maxwell_damper_relaxes_as_the_exponential():
    law = ViscousDamper(coefficient=3e4, stiffness=5e6)
    errors = []
    for n in (50, 100):
        t = np.linspace(0.0, 0.05, n + 1)
        force, _ = drive(law, 0.2 * t, t[1])
        exact = 0.2 * 3e4 * (1.0 - np.exp(-t * 5e6 / 3e4))
        errors.append(np.abs(force - exact).max() / exact.max())
    assert errors[1] < 2e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.2)  # second order


def test_a_maxwell_damper_with_an_exponent_solves_its_equation():
    law = LAWS["maxwell"]
    t = np.linspace(0.0, 1.0, 1001)
    d = 0.02 * np.sin(2.0 * math.pi * t)
    force, _ = drive(law, d, t[1])

    def rate(s, f):
        v = 0.02 * 2.0 * math.pi * np.cos(2.0 * math.pi * s)
        return law.stiffness * (v - np.sign(f) * (abs(f) / law.coefficient) ** (1.0 / law.exponent))

    done = solve_ivp(rate, (0.0, 1.0), [0.0], t_eval=t, rtol=1e-9, atol=1e-3, max_step=1e-3)
    assert_allclose(force, done.y[0], rtol=0.0, atol=2e-3 * np.abs(force).max())


@pytest.mark.parametrize("name", ["stop", "hertz"])
def test_a_wall_pushes_only_and_behind_its_gap(name):
    d = cycles()
    force, _ = drive(LAWS[name], d)
    assert force.min() == 0.0
    assert not force[d <= 0.01].any()
    assert force[d > 0.011].max() > 0.0


def bounce(law, mass, speed, dt=1e-5):
    """Throw a mass at a wall; return the speed it leaves with."""
    kind, par = _law(law)
    old, new = np.zeros(STATE_SIZE), np.zeros(STATE_SIZE)
    x, v, force = law.gap - 1e-9, speed, 0.0
    for _ in range(200_000):
        v -= 0.5 * dt * force / mass
        x_new = x + dt * v
        force, _ = uniaxial(kind, par, old, new, x, x_new, v, v, 0.0, dt)
        v -= 0.5 * dt * force / mass
        x, old[:] = x_new, new
        if v < 0.0 and x < law.gap:
            return -v
    raise AssertionError


@pytest.mark.parametrize("restitution", [0.4, 0.6, 0.9])
def test_walls_give_back_the_speed_that_was_asked_for(restitution):
    mass, k = 1e5, 2e8
    damping = Gap.damping_for(restitution, k, mass)
    left = bounce(Gap(gap=0.01, stiffness=k, damping=damping), mass, 0.5) / 0.5
    assert left == pytest.approx(restitution, abs=3e-3)
    for n in (1.0, 1.5, 2.0):
        law = HertzGap(gap=0.01, stiffness=1e9, restitution=restitution, exponent=n)
        assert bounce(law, mass, 0.5) / 0.5 == pytest.approx(restitution, abs=1e-3)
    near = HertzGap(gap=0.0, stiffness=1.0, restitution=0.99).damping
    assert near == pytest.approx(0.75 * (1.0 - 0.99**2), rel=0.02)
    assert bounce(Gap(gap=0.01, stiffness=k), mass, 0.5) == pytest.approx(0.5, rel=1e-4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: Bilinear(stiffness=0.0, yield_force=1.0),
            r"Bilinear: stiffness = 0 \[N/m\] must be positive",
        ),
        (lambda: Bilinear(stiffness=1.0, yield_force=-1.0), "Bilinear: yield_force"),
        (lambda: Bilinear(stiffness=1.0, yield_force=1.0, hardening=1.0), "Bilinear: hardening"),
        (lambda: BoucWen(stiffness=1.0, yield_force=1.0, exponent=0.5), "BoucWen: exponent"),
        (lambda: BoucWen(stiffness=1.0, yield_force=1.0, shape=0.0), "BoucWen: shape"),
        (lambda: BoucWen(stiffness=1.0, yield_force=1.0, strength_loss=-1.0), "strength_loss"),
        (lambda: Pinching(slip=1.0), "Pinching: slip"),
        (lambda: Pinching(width=0.0), "Pinching: width"),
        (lambda: Tie(stiffness=1.0, slack=-0.1), "Tie: slack"),
        (lambda: ViscousDamper(coefficient=1.0, exponent=3.0), "ViscousDamper: exponent"),
        (lambda: ViscousDamper(coefficient=math.nan), "ViscousDamper: coefficient"),
        (lambda: Gap(gap=-1.0, stiffness=1.0), "Gap: gap"),
        (lambda: Gap.damping_for(0.0, 1.0, 1.0), "Gap.damping_for: restitution"),
        (lambda: HertzGap(gap=0.1, stiffness=1.0, restitution=0.0), "HertzGap: restitution"),
    ],
)
def test_numbers_out_of_bounds_are_refused(make, message):
    with pytest.raises(ModelError, match=message):
        make()


@pytest.mark.parametrize(
    "make",
    [
        lambda: BoucWen(stiffness=1.0, yield_force=1.0, shape=1.0),
        lambda: ViscousDamper(coefficient=1.0, exponent=2.0),
        lambda: HertzGap(gap=0.1, stiffness=1.0, restitution=1.0, exponent=3.0),
        lambda: PlasticHinge(moment_y=1.0, axial_exponent=4.0),
    ],
)
def test_ends_of_documented_intervals_are_taken(make):
    make()


def test_a_stop_that_gives_all_speed_back_does_not_damp():
    assert Gap.damping_for(1.0, 1.0, 1.0) == 0.0
    assert HertzGap(gap=0.0, stiffness=1.0, restitution=1.0).damping == 0.0
