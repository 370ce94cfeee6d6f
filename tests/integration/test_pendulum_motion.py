"""Time histories against the exact equations of motion of a frictionless spherical pendulum.

A mass on a bearing without friction is a point mass held off the bottom sphere's centre by a
compression spring of length L (the 'string'): c = (ux, uy, uz - L) from centre to centre,
N = k (|c| - L), force on the mass -N c / |c| ... pointing back to the centre. scipy integrates it.
"""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from frames import GroundMotion, lumped_mass
from lir_element import CoulombFriction, LIRBearing

# Such bearings are meant here.
pytestmark = [pytest.mark.meant("axial_stiffness", "settles by")]

MASS, STIFFNESS, GRAVITY = 50e3, 2e7, 9.80665


frictionless = partial(
    LIRBearing,
    radius=(0.9, 0.7),
    slider_height=0.1,
    slider_radius=0.08,
    capacity=math.inf,
    friction=CoulombFriction(0.0),
    interface_friction=math.inf,
    axial_stiffness=STIFFNESS,
    axial_damping=0.0,
)


def exact(ground: np.ndarray, dt: float, times: np.ndarray) -> np.ndarray:
    """Return (ux, uy, uz) at `times`, integrated to 1e-10."""
    length = frictionless().effective_radius
    samples = np.arange(len(ground)) * dt

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        c = np.array([y[0], y[1], y[2] - length])
        size = np.linalg.norm(c)
        push = max(STIFFNESS * (size - length), 0.0)
        a_g = np.array([np.interp(t, samples, ground[:, k]) for k in range(3)])
        acceleration = -push * c / size / MASS - a_g - np.array([0.0, 0.0, GRAVITY])
        return np.concatenate([y[3:], acceleration])

    start = np.array([0.0, 0.0, -MASS * GRAVITY / STIFFNESS, 0.0, 0.0, 0.0])
    solution = solve_ivp(
        rates, (0.0, times[-1]), start, t_eval=times, rtol=1e-10, atol=1e-12, max_step=dt
    )
    return solution.y[:3].T


def circling_ground(pulse, dt: float) -> np.ndarray:
    first = pulse(2.5, 2.2, dt, cycles=1.5)
    second = np.roll(pulse(2.0, 1.7, dt, cycles=1.5), round(0.4 / dt))[: len(first)]
    second = np.pad(second, (0, len(first) - len(second)))
    return np.column_stack([first, second, np.zeros(len(first))])


@pytest.mark.parametrize("integrator", ["newmark", "generalised-alpha"])
def test_converges_to_the_exact_pendulum_with_second_order(run, pulse, integrator):
    base = 0.01
    ground = circling_ground(pulse, base)
    motion = GroundMotion(*ground.T, dt=base)
    times = np.arange(len(ground)) * base
    expected = exact(ground, base, times)
    assert np.abs(expected[:, 0]).max() > 0.15  # a large displacement: 12 degrees of tilt
    errors, steps = [], [1e-3, 5e-4, 2.5e-4]
    for dt in steps:
        data = run(
            lumped_mass(frictionless(), MASS),
            motion,
            dt=dt,
            integrator=integrator,
            record_every=round(base / dt),
            duration=times[-1],
        )
        moves = data["bearing_displacement"][:, 0].to_numpy()
        errors.append(np.abs(moves[:, :2] - expected[:, :2]).max())
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 1.85 < order < 2.15, errors
    assert errors[-1] < 1e-5


def test_lifts_with_the_lateral_displacement(run, pulse):
    ground = circling_ground(pulse, 0.005)
    data = run(lumped_mass(frictionless(), MASS), GroundMotion(*ground.T, dt=0.005), dt=0.0005)
    u = data["bearing_displacement"][:, 0].to_numpy()
    length = frictionless().effective_radius
    closure = data["axial_force"][:, 0].to_numpy() / STIFFNESS
    lift = length - np.sqrt((length + closure) ** 2 - u[:, 0] ** 2 - u[:, 1] ** 2)
    # sphere of radius L + closure about the bottom centre: exact kinematics, round-off only
    assert_allclose(u[:, 2], lift, rtol=0.0, atol=1e-12)
