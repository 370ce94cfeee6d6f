"""The level 'rigid_body' against closed forms, its own explicit mode, and its tolerance."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from frames import Frame, GroundMotion, energy_error, gravity, lumped_mass, time_history
from lir_element.bundles.rigid_data import rigid_input, rigid_run, rigid_setup
from lir_element.device.sliders import slider_record
from lir_element.kernels.rigid_body.integrate import integrate_bodies, start
from tests.scenes import plain_pendulum, small_bearing

# Such bearings are meant here.
pytestmark = pytest.mark.meant("slider_density")

MASS, G = 15e3, 9.80665


bearing = partial(small_bearing, yield_displacement=1e-3, interface_yield_displacement=5e-5)


def rigid(model: Frame, motion: GroundMotion, **options: Any) -> xr.Dataset:
    """Run at the level 'rigid_body'; the energy balance must close."""
    data = time_history(model, motion, level="rigid_body", **options)
    assert data.attrs["status"] == "ok"
    assert energy_error(data) < 3e-9
    return data


@pytest.mark.parametrize("masses", [None, (40.0, 70.0)])
def test_gravity_carries_the_sliders(masses: tuple[float, float] | None) -> None:
    """On the top plate the weight W of the mass; under the bottom one W and both sliders."""
    device = bearing(slider_mass=masses)
    state = gravity(lumped_mass(device, MASS), level="contact")
    force = state.run.old["force"][0]
    own = slider_record(device)["mass"][0].sum() * G
    assert_allclose(force[8], -MASS * G, rtol=1e-8)
    assert_allclose(force[2], MASS * G + own, rtol=1e-8)
    data = rigid(lumped_mass(device, MASS), GroundMotion(x=np.zeros(20), dt=0.005))
    assert_allclose(data["axial_force"], MASS * G, rtol=5e-3)
    # it starts in equilibrium and stays: nothing moves but by Newton's tolerance
    assert float(np.abs(data["node_displacement"] - data["node_displacement"][0]).max()) < 1e-9
    assert float(np.abs(data["energy"]).max()) < 1e-4


@pytest.mark.parametrize("level", ["contact", "rigid_body"])
def test_flight_follows_the_parabola(level: str) -> None:
    """The ground drops with 2 g: the mass flies, lands and comes to rest under its weight."""
    ground = np.zeros(600)
    ground[:16] = -2.0 * G
    device = bearing(axial_stiffness=2e8)
    data = time_history(
        lumped_mass(device, MASS), GroundMotion(z=ground, dt=0.005), level=level, duration=3.0
    )
    assert energy_error(data) < 1e-9
    time = data["time"].to_numpy()
    rise = data["bearing_displacement"][:, 0, 2].to_numpy()
    axial = data["axial_force"][:, 0].to_numpy()
    free = axial == 0.0
    first = int(np.argmax(free))
    last = first + int(np.argmin(free[first:]))
    assert first <= 2
    assert last - first > 40
    total = data["node_acceleration"].sel(node="mass", dof="uz").to_numpy()
    steady = np.r_[first + 2 : 14, 20:last]  # not where the ground's acceleration jumps
    assert_allclose(total[steady], -G, rtol=0.0, atol=1e-3)
    # relative to the ground it is accelerated by +g until 0.075 s, by -g from 0.080 s on
    for begin, end, curvature in ((first + 2, 16, G), (18, last, -G)):
        t, y = time[begin:end] - time[begin], rise[begin:end]
        a, _, _ = np.polyfit(t, y, 2)
        assert_allclose(2.0 * a, curvature, rtol=1e-5)
        assert_allclose(np.polyval(np.polyfit(t, y, 2), t), y, rtol=0.0, atol=1e-8)
    bodies = data["body_position"].sel(axis="z")[first + 2 : 16, 0, :2].to_numpy()
    bends = np.diff(bodies, n=2, axis=0) / 0.005**2  # the sliders fly as well, but for rebounds
    assert_allclose(np.median(bends, axis=0), G, rtol=1e-3)
    landed = axial[last : last + 20].max()
    assert landed > 5.0 * MASS * G
    assert (axial >= 0.0).all()
    assert_allclose(axial[-100:].mean(), MASS * G, rtol=0.02)
    assert np.abs(rise[-1] - rise[0]) < 1e-3


def test_difference_falls_with_the_tolerance(pulse: Callable[..., np.ndarray]) -> None:
    motion = GroundMotion(x=pulse(2.6, 1.5, cycles=1.0, rest=0.2), dt=0.005)
    model = lumped_mass(bearing(), MASS)
    runs = [
        rigid(model, motion, tolerance=tolerance)["bearing_displacement"][:, 0, 0].to_numpy()
        for tolerance in (1e-5, 1e-7, 1e-9, 1e-10)
    ]
    peaks = [np.abs(run).max() for run in runs]
    assert peaks[-1] > 0.18  # on the rim
    errors = [np.abs(run - runs[-1]).max() for run in runs[:-1]]
    # at the rim points open for an instant, in finer steps more often, and friction forgets there
    assert errors[0] > 2.0 * errors[1] > 2.0 * errors[2], errors
    assert errors[1] < 2e-3 * peaks[-1]
    assert errors[2] < 5e-4 * peaks[-1]


@pytest.mark.parametrize("law", ["elastic-plastic", "bouc-wen"])
def test_implicit_is_explicit(law: str, pulse: Callable[..., np.ndarray]) -> None:
    """A short hard pulse into the rim, 0.25 s: both modes within 0.1 % of the peak.

    Softer contacts and heavier sliders than by default, for the explicit mode's step.
    """
    device = bearing(
        capacity=0.02, axial_stiffness=4e8, rim_stiffness=5e7, slider_mass=20.0, friction_law=law
    )
    motion = GroundMotion(x=pulse(9.0, 0.2, cycles=1.0, rest=0.05), dt=0.005)
    model = lumped_mass(device, MASS)
    one = rigid(model, motion, tolerance=1e-9, duration=0.25)
    two = time_history(model, motion, level="rigid_body", integrator="explicit", duration=0.25)
    assert two.attrs["integrator"] == "explicit"
    assert two.attrs["step_control"] == "fixed"
    assert two.attrs["dt"] < 2e-5
    assert float(one["rim_force"].max()) > 5e3
    assert float(one["interface_slip_size"].max()) > 1e-3
    for name in ("bearing_displacement", "interface_slip", "body_position"):
        scale = float(np.abs(one[name]).max())
        assert float(np.abs(one[name] - two[name]).max()) < 1e-3 * scale, name
    for name in ("bearing_force", "work_low_friction", "work_high_friction"):
        scale = float(np.abs(one[name]).max())
        assert float(np.abs(one[name] - two[name]).max()) < 5e-3 * scale, name


def test_accelerations_belong_to_the_forces_of_their_instant(pulse):
    """They balance these and integrate to the velocities; no assumption is violated."""
    motion = GroundMotion(x=pulse(2.6, 1.5, cycles=1.0, rest=0.2), dt=0.005)
    data = rigid(lumped_mass(bearing(), MASS), motion)
    assert float(data["rim_force"].max()) > 0.0
    assert float(np.abs(data["imbalance"]).max()) < 1e-9
    own = data["node_acceleration"].isel(node=-1, dof=0) - data["ground_acceleration"].sel(axis="x")
    steps = np.diff(data["time"].to_numpy())
    speed = np.cumsum(0.5 * (own.to_numpy()[1:] + own.to_numpy()[:-1]) * steps)
    given = data["bearing_velocity"].isel(bearing=0).sel(axis="x").to_numpy()
    assert_allclose(speed, given[1:], atol=5e-3 * float(np.abs(given).max()))
    assert "! equilibrium" not in data.attrs["audit"]


def test_numerical_share_of_the_ledger(pulse: Callable[..., np.ndarray]) -> None:
    motion = GroundMotion(x=pulse(2.6, 1.5, cycles=1.0, rest=0.2), dt=0.005)
    shares = []
    for tolerance in (1e-6, 1e-8):
        data = rigid(lumped_mass(bearing(), MASS), motion, tolerance=tolerance)
        energy = data["energy"]
        scale = float(np.abs(energy.sel(term="input")).max())
        shares.append(float(np.abs(energy.sel(term="numerical")).max()) / scale)
        assert data.attrs["tolerance"] == tolerance
        assert data.attrs["step_control"] == "error"
        assert data.attrs["integrator"] == "bossak"
    assert shares[1] < 1e-3
    assert shares[1] < shares[0]
    # input: minus ground acceleration times mass times the way, summed from the records
    u = data["bearing_displacement"][:, 0, 0].to_numpy()
    a = data["ground_acceleration"][:, 0].to_numpy()
    expected = -MASS * np.sum(0.5 * (a[1:] + a[:-1]) * np.diff(u))
    assert_allclose(energy.sel(term="input")[-1], expected, rtol=2e-3)
    lifted = (
        MASS * G * (data["bearing_displacement"][:, 0, 2] - data["bearing_displacement"][0, 0, 2])
    )
    scale = float(np.abs(lifted).max())
    assert_allclose(energy.sel(term="gravity"), lifted, rtol=0.0, atol=1e-6 * scale)
    v = np.gradient(data["bearing_displacement"][:, 0].to_numpy(), 0.005, axis=0)
    kinetic = 0.5 * MASS * np.sum(v**2, axis=1)
    error = np.abs(energy.sel(term="kinetic").to_numpy() - kinetic)[2:-2]
    assert np.median(error) < 0.01 * kinetic.max()


pendulum = partial(
    plain_pendulum,
    radius=(0.9, 0.7),
    slider_radius=0.05,
    friction=0.0,
    axial_stiffness=1e10,
    axial_damping=1e5,
    slider_density=1.0,
)


def exact(ground: np.ndarray, dt: float, times: np.ndarray) -> np.ndarray:
    """Return (ux, uy) of a point mass on a rigid sphere of radius L; scipy, to 1e-10."""
    length = pendulum().effective_radius
    samples = np.arange(len(ground)) * dt

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        x, v = y[:2], y[2:]
        z = math.sqrt(length**2 - x @ x)
        a_g = np.array([np.interp(t, samples, ground[:, k]) for k in range(2)])
        # constraint: c . c = L^2; acceleration = free one + multiplier c
        c = np.array([*x, -z])
        w = np.array([*v, (x @ v) / z])
        free = np.array([*-a_g, -G])
        multiplier = -(w @ w + free @ c) / length**2
        acceleration = free + multiplier * c
        return np.concatenate([v, acceleration[:2]])

    solution = solve_ivp(
        rates, (0.0, times[-1]), np.zeros(4), t_eval=times, rtol=1e-10, atol=1e-13, max_step=dt
    )
    return solution.y[:2].T


def test_converges_to_the_exact_pendulum(pulse: Callable[..., np.ndarray]) -> None:
    """Without friction, both directions: error by tolerance; string's stretch 1e-5 of L."""
    dt = 0.005
    x = pulse(2.0, 2.0, dt, cycles=1.0, rest=0.5)
    ground = np.column_stack([x, np.roll(0.6 * x, 40)])
    motion = GroundMotion(x=ground[:, 0], y=ground[:, 1], dt=dt)
    times = np.arange(len(ground)) * dt
    expected = exact(ground, dt, times)
    assert np.abs(expected).max() > 0.2
    errors = []
    for tolerance in (1e-5, 1e-8):
        data = rigid(lumped_mass(pendulum(), MASS), motion, tolerance=tolerance, duration=times[-1])
        moves = data["bearing_displacement"][:, 0, :2].to_numpy()
        errors.append(np.abs(moves - expected).max() / np.abs(expected).max())
        assert float(np.abs(data["work_low_friction"]).max()) == 0.0
    assert errors[1] < 5e-5
    assert errors[1] < 0.5 * errors[0]


def tilting(inertia: float, push: np.ndarray, dt: float) -> tuple[Any, Any, Any, int]:
    """Return states, bodies, energy and status of a plate that may tilt, under a lateral load.

    `push` (n,) acts on its node along x [N], a sample every `dt`.
    """
    state = gravity(lumped_mass(bearing(), MASS), level="contact")
    assert state.contacts is not None
    free = np.array([1, 1, 1, 1, 1, 0])
    run = rigid_run(
        state.model.props,
        state.contacts,
        state.run.old.copy(),
        np.full(3, MASS),
        np.full(3, inertia),
        free,
        driven=False,
    )
    count = len(push)
    load = np.zeros((count, 6))
    load[:, 0], load[:, 2] = push, -MASS * G
    given, out = rigid_input(
        (np.zeros((2, 3)), 1.0), dt * np.arange(count), np.zeros((count, 2)), load
    )
    run.clock["step"] = 1e-4
    start(run, given)
    code = integrate_bodies(run, given, rigid_setup(bearing().effective_radius, dt), count, 10**9)
    return out.states, out.bodies, out.energy, code


def test_plate_that_may_tilt() -> None:
    """The bearing's moment turns the plate: angular momentum, energy, and no turn about x."""
    inertia, dt = 2e4, 0.002
    t = dt * np.arange(150)
    push = 3e3 * np.sin(math.pi * np.minimum(t / 0.1, 1.0)) ** 2
    states, bodies, energy, code = tilting(inertia, push, dt)
    assert code == 0
    spin, turn = bodies["spin"][:, 2], states["displacement"][:, 9:]
    assert 1e-6 < np.abs(turn[:, 1]).max() < 0.02
    assert np.abs(turn[:, 0]).max() < 1e-6 * np.abs(turn[:, 1]).max()
    assert np.abs(spin[:, 2]).max() < 1e-12  # fixed
    moment = -states["force"][:, 10]
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * dt)])
    scale = inertia * np.abs(spin[:, 1]).max()
    assert np.median(np.abs(inertia * spin[:, 1] - impulse)) < 0.03 * scale
    kinetic = 0.5 * MASS * np.sum(bodies["velocity"][:, 2] ** 2, axis=1)
    kinetic += 0.5 * inertia * np.sum(spin**2, axis=1)
    assert_allclose(energy["kinetic"], kinetic, rtol=1e-9, atol=1e-12)
    assert np.abs(energy["numerical"]).max() < 0.02 * kinetic.max()


def test_spinning_plate_in_flight() -> None:
    """Lifted off by a push from below it turns freely: momentum and spin stay what they are."""
    state = gravity(lumped_mass(bearing(), MASS), level="contact")
    assert state.contacts is not None
    inertia = np.array([10.0, 20.0, 26.0])
    run = rigid_run(
        state.model.props,
        state.contacts,
        state.run.old.copy(),
        np.full(3, MASS),
        inertia,
        np.ones(6, np.int64),
        driven=False,
    )
    run.bodies["displacement"][:, 2, 2] += 0.5
    run.bodies["spin"][:, 2] = (0.8, 1.5, 0.6)
    run.bodies["velocity"][:, 2] = (0.2, -0.1, 0.3)
    count, dt = 41, 0.005
    load = np.zeros((count, 6))
    load[:, 2] = -MASS * G
    given, out = rigid_input(
        (np.zeros((2, 3)), 1.0), dt * np.arange(count), np.zeros((count, 2)), load
    )
    bodies = out.bodies
    run.clock["step"] = 1e-4
    start(run, given)
    assert (
        integrate_bodies(run, given, rigid_setup(bearing().effective_radius, dt), count, 10**9) == 0
    )
    t = given.times
    expected = np.array([0.2, -0.1, 0.3]) * t[:, None]
    expected[:, 2] -= 0.5 * G * t**2
    moved = bodies["displacement"][:, 2] - bodies["displacement"][0, 2]
    assert_allclose(moved, expected, rtol=0.0, atol=1e-7)
    q = Rotation.from_quat(bodies["turn"][:, 2], scalar_first=True).as_matrix()
    momentum = np.einsum("tij,j,tkj,tk->ti", q, inertia, q, bodies["spin"][:, 2])
    scale = np.linalg.norm(momentum[0])
    assert_allclose(
        momentum / scale, np.broadcast_to(momentum[0] / scale, momentum.shape), rtol=0.0, atol=1e-3
    )
    energy = 0.5 * np.einsum("ti,ti->t", momentum, bodies["spin"][:, 2])
    assert_allclose(energy, energy[0], rtol=5e-4)

    # Euler's equations, integrated apart
    def rates(_: float, y: np.ndarray) -> np.ndarray:
        w, r = y[:3], y[3:].reshape(3, 3)
        return np.concatenate([np.cross(inertia * w, w) / inertia, (r @ skew(w)).ravel()])

    y = solve_ivp(
        rates,
        (0.0, t[-1]),
        np.concatenate([[0.8, 1.5, 0.6], np.eye(3).ravel()]),
        rtol=1e-10,
        atol=1e-12,
    ).y[:, -1]
    assert_allclose(q[-1] @ q[0].T, y[3:].reshape(3, 3), rtol=0.0, atol=1e-4)


def skew(w: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def test_outputs_and_chunks(pulse: Callable[..., np.ndarray]) -> None:
    motion = GroundMotion(x=pulse(1.5, 0.6, cycles=1.0, rest=0.1), dt=0.01)
    model = lumped_mass(bearing(), MASS)
    one = rigid(model, motion)
    assert_allclose(np.diff(one["time"]), 0.005, rtol=1e-9)  # at most 5 ms
    seen: list[float] = []
    two = rigid(model, motion, record_every=4, progress=seen.append)
    assert_allclose(two["time"], one["time"][::4], rtol=0.0, atol=1e-12)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    # steps end at the outputs: other outputs, other steps, within the tolerance
    scale = float(np.abs(one["bearing_displacement"]).max())
    error = np.abs(two["bearing_displacement"] - one["bearing_displacement"][::4])
    assert float(error.max()) < 1e-3 * scale
    three = rigid(model, motion, dt=0.002)
    assert_allclose(np.diff(three["time"]), 0.002, rtol=1e-9)
