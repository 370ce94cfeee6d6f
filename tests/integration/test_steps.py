"""Steps of time: order of convergence, halving, impacts that make no energy, chosen steps."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import linalg

from frames import GroundMotion, RayleighDamping, gravity, lumped_mass, moment_frame, shear_building
from lir_element import Element
from tests.scenes import plain_pendulum
from validation.measurements.performance import near_fault

# Such bearings are meant here.
pytestmark = [pytest.mark.meant("friction of 0.5", "the bearings hardly slide")]

MASS = 204e3
TERMS = ["kinetic", "elastic", "gravity", "rims", "contact", "friction_elastic"]


def sticking_building():
    """Two storeys on a bearing that small motions find elastic."""
    bearing = plain_pendulum(friction=0.5, yield_displacement=0.002)
    return shear_building(
        bearing, [4e4, 3e4], [5e7, 4e7], base_mass=3e4, damping=RayleighDamping(0.2, (0.4, 0.1))
    )


def exact(waves: np.ndarray, base: float) -> np.ndarray:
    """Return ux of base and floors at the samples, by the matrix exponential."""
    frame = sticking_building()
    state = gravity(frame)
    system = state.system
    element = Element(system.bearings[0][3])
    element.set_trial(np.r_[np.zeros(8), state.displacement[2], np.zeros(3)], np.zeros(12), 0.0)
    held = element.tangent_stiffness()[6, 6]
    places = [system.dof_labels.index(f"{n} ux") for n in ("base", "floor-1", "floor-2")]
    inner = np.ix_(places, places)
    m, k = system.mass.toarray()[inner], system.stiffness.toarray()[inner]
    w_1, w_2 = 2 * math.pi / 0.4, 2 * math.pi / 0.1
    beta = 2 * 0.2 / (w_1 + w_2)
    alpha = beta * w_1 * w_2
    relative = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])  # to the base
    c = relative.T @ (alpha * m[1:, 1:] + beta * k[1:, 1:]) @ relative
    k[0, 0] += held
    inverse = np.linalg.inv(m)
    rates = np.zeros((8, 8))  # displacements, velocities, ground acceleration and its slope
    rates[:3, 3:6] = np.eye(3)
    rates[3:6, :3], rates[3:6, 3:6] = -inverse @ k, -inverse @ c
    rates[3:6, 6] = -1.0
    rates[6, 7] = 1.0
    step = linalg.expm(rates * base)
    y, out = np.zeros(6), [np.zeros(3)]
    for first, second in pairwise(waves):
        y = (step @ np.r_[y, first, (second - first) / base])[:6]
        out.append(y[:3])
    return np.array(out)


@pytest.mark.parametrize(
    ("integrator", "radius"),
    [("newmark", 1.0), ("generalised-alpha", 0.8), ("generalised-alpha", 0.0)],
)
def test_second_order_for_a_linear_building(run, integrator, radius):
    base, count = 0.02, 101
    t = np.arange(count) * base
    waves = 0.1 * np.sin(2 * np.pi * t / 0.7) * np.sin(np.pi * t / t[-1]) ** 2
    expected = exact(waves, base)
    errors, steps = [], [0.005, 0.0025, 0.00125]
    for dt in steps:
        data = run(
            sticking_building(),
            GroundMotion(x=waves, dt=base),
            dt=dt,
            integrator=integrator,
            spectral_radius=radius,
            record_every=round(base / dt),
        )
        u = data["node_displacement"].sel(node=["base", "floor-1", "floor-2"], dof="ux")
        errors.append(np.abs(u - expected).max() / np.abs(expected).max())
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 1.85 < order < 2.15, errors
    assert errors[-1] < (2e-3 if radius else 1e-2)


@pytest.mark.parametrize("radius", [1.0, 0.8, 0.3])
def test_spectral_radius_at_infinite_frequency(run, radius):
    """Kick a mass on a stiff vertical contact, a thousand periods a step; all roots are -radius."""
    bearing = plain_pendulum(friction=0.5, axial_stiffness=1e13, axial_damping=0.0)
    wave = np.zeros(40)
    wave[1] = 1.0
    names = ["generalised-alpha"] + (["newmark"] if radius == 1.0 else [])
    for name in names:
        data = run(
            lumped_mass(bearing, MASS),
            GroundMotion(z=wave, dt=0.1),
            dt=0.1,
            integrator=name,
            spectral_radius=radius,
        )
        a = data["bearing_velocity"].sel(bearing="bearing", axis="z").to_numpy()[4:14]
        left = a[3:] + 3.0 * radius * a[2:-1] + 3.0 * radius**2 * a[1:-2] + radius**3 * a[:-3]
        assert np.abs(a).min() > 0.0
        # finite frequency, 1 / (omega dt)^2 = 2e-6, over differences of three steps
        assert_allclose(left / np.abs(a[:-3]), 0.0, rtol=0.0, atol=5e-4)


def strong(pulse, dt: float, peak: float = 2.5) -> GroundMotion:
    first = pulse(peak, 2.4, dt)
    return GroundMotion(x=first, y=0.5 * np.roll(first, round(0.5 / dt)), dt=dt)


def peak(data) -> float:
    return float(np.hypot(*data["bearing_displacement"][:, 0, :2].to_numpy().T).max())


@pytest.mark.parametrize("kind", ["lir", "dcfp"])
def test_chosen_steps_are_within_one_per_cent(run, pulse, newhall_bearing, kind):
    bearing = newhall_bearing if kind == "lir" else newhall_bearing.as_dcfp()
    motion = strong(pulse, 0.01, 1.5 if kind == "lir" else 2.5)
    chosen = run(lumped_mass(bearing, MASS), motion)
    fine = run(lumped_mass(bearing, MASS), motion, dt=1e-4, record_every=50)
    assert chosen.attrs["step_control"] == "error"
    assert chosen.attrs["dt"] == 0.005
    assert float(fine["rim_force"].max()) > 0.0
    if kind == "lir":
        assert float(fine["interface_slip_size"].max()) > 0.01
    assert_allclose(peak(chosen), peak(fine), rtol=1e-2)  # the promise
    gap = chosen["bearing_displacement"] - fine["bearing_displacement"]
    assert float(np.abs(gap).max()) < 1e-2 * peak(fine)


def test_chosen_step_is_at_most_that_of_the_motion(run, pulse, newhall_bearing):
    for step, expected in ((0.002, 0.002), (0.02, 0.005)):
        data = run(lumped_mass(newhall_bearing, MASS), GroundMotion(x=pulse(1, 1, step), dt=step))
        assert data.attrs["dt"] == expected


def history(data) -> np.ndarray:
    """Return the bearings' horizontal displacements every 10 ms."""
    every = round(0.01 / float(data["time"][1]))
    return data["bearing_displacement"].to_numpy()[::every, :, :2]


@pytest.mark.parametrize("kind", ["mass on rims", "plain mass", "building"])
def test_achieved_error_is_within_a_factor_of_three(run, newhall_bearing, kind):
    bearing = newhall_bearing.as_dcfp() if kind == "plain mass" else newhall_bearing
    if kind == "building":
        model = moment_frame(bays=(1, 1), storeys=2, bearing=bearing)
    else:
        model = lumped_mass(bearing, MASS)
    motion = near_fault(1.0 if kind == "mass on rims" else 0.5)
    fine = run(model, motion, dt=1e-4, record_every=100)
    assert (float(fine["rim_force"].max()) > 0.0) == (kind == "mass on rims")
    largest = np.hypot(*np.moveaxis(history(fine), -1, 0)).max()
    for tolerance in (5e-4, 2e-4, 1e-4, 5e-5):
        data = run(model, motion, tolerance=tolerance)
        gap = np.hypot(*np.moveaxis(history(data) - history(fine), -1, 0)).max() / largest
        assert tolerance / 3.0 < gap < 3.0 * tolerance, (tolerance, gap)


@pytest.mark.parametrize("oblique", [0.0, 0.7])
@pytest.mark.parametrize(
    ("kind", "strengths"),
    [("dcfp", (2.8, 4.0)), ("lir", (2.3, 2.6)), ("building", (2.3,))],
)
def test_impacts_are_located(run, pulse, newhall_bearing, kind, strengths, oblique):
    """Compare forces at impacts with those of steps 50 times finer, at the same instants."""
    bearing = replace(newhall_bearing, slip_capacity=1.0)
    if kind == "building":
        model = moment_frame(bays=(1, 1), storeys=2, bearing=bearing)
    else:
        model = lumped_mass(bearing if kind == "lir" else newhall_bearing.as_dcfp(), MASS)
    for strength in strengths:
        x = pulse(strength, 2.0, 0.01, cycles=1.0, rest=0.5)
        motion = GroundMotion(x=x, y=oblique * np.roll(x, 20), dt=0.01)
        chosen = run(model, motion)
        fine = run(model, motion, dt=1e-4, record_every=50)
        assert float(fine["rim_force"].max()) > 0.0
        for name in ("rim_force", "bearing_force"):
            biggest = [float(np.abs(data[name]).max()) for data in (chosen, fine)]
            assert_allclose(*biggest, rtol=2e-2, err_msg=f"{name} {strength}")


@pytest.mark.parametrize("kind", ["lir", "dcfp"])
def test_huge_steps_go_through_an_impact_by_halving(run, pulse, newhall_bearing, kind):
    bearing = newhall_bearing if kind == "lir" else newhall_bearing.as_dcfp()
    motion = strong(pulse, 0.01, 1.5 if kind == "lir" else 2.5)
    huge = run(lumped_mass(bearing, MASS), motion, dt=0.05)
    fine = run(lumped_mass(bearing, MASS), motion, dt=5e-4)
    assert huge.attrs["status"] == "ok"
    assert huge.attrs["halvings"] > 0
    assert huge.attrs["steps"] > huge.sizes["time"]
    assert huge.attrs["steps"] < 0.3 * fine.attrs["steps"]
    assert_allclose(peak(huge), peak(fine), rtol=0.05)  # T / dt = 60, friction within a step


def test_tiny_steps(run, pulse, newhall_bearing):
    motion = GroundMotion(x=pulse(4.0, 0.4, 0.005), dt=0.005)
    model = lumped_mass(newhall_bearing, MASS)
    tiny = run(model, motion, dt=1e-5, duration=0.2, record_every=100)
    plain = run(model, motion, dt=1e-3, duration=0.2)
    assert tiny.attrs["steps"] == 20000
    assert tiny.attrs["halvings"] == 0
    assert tiny.sizes["time"] == plain.sizes["time"] == 201
    size = float(np.abs(tiny["bearing_displacement"]).max())
    assert size > 0.01
    assert_allclose(
        plain["bearing_displacement"], tiny["bearing_displacement"], rtol=0.0, atol=2e-3 * size
    )  # second order in 1 ms


def test_peak_of_an_impact_converges(run, pulse, newhall_bearing):
    motion = strong(pulse, 0.01)
    model = lumped_mass(newhall_bearing.as_dcfp(), MASS)

    def rim(dt: float) -> float:
        return float(run(model, motion, dt=dt)["rim_force"].max())

    finest = rim(2.5e-5)
    errors = [abs(rim(dt) / finest - 1.0) for dt in (2e-3, 1e-3, 5e-4, 2e-4)]
    assert errors[-1] < 5e-3, errors
    assert errors[-1] < errors[0], errors
    assert max(errors) < 0.05, errors


@pytest.mark.parametrize("dt", [0.02, 0.005])
@pytest.mark.parametrize("oblique", [0.0, 0.6])
def test_undamped_rims_never_make_energy(run, pulse, dt, oblique):
    """Bounce without friction and damping: what is stored afterwards stays what it is."""
    undamped = {"friction": 0.0, "rim_damping": 0.0, "axial_damping": 0.0, "rim_overrun": 1.0}
    bearing = plain_pendulum(radius=(1.0, 0.8), capacity=0.1, **undamped)
    x = pulse(2.0, 1.5, 0.01, cycles=1.0, rest=0.0)
    motion = GroundMotion(x=x, y=oblique * np.roll(x, 30), dt=0.01)
    data = run(lumped_mass(bearing, 1e5), motion, dt=dt, duration=15.0)
    energy = data["energy"]
    supplied = float(energy.sel(term="input")[-1])
    stored = energy.sel(term=TERMS).sum("term")
    after = slice(round(1.6 / dt), None)
    hits = np.diff((data["rim_force"][after, 0, 0].to_numpy() > 0.0).astype(int))
    assert (hits == 1).sum() >= 5
    # 2e-4 of the energy moved, an impact that opens and closes twice
    assert_allclose(stored[after], supplied, rtol=1e-2)
    moving = energy.sel(term=["kinetic", "gravity"]).sum("term")
    assert float(moving[after].max()) < 1.005 * supplied
    assert float(energy.sel(term="rims").min()) > -5e-3 * supplied
    open_ = (data["rim_closure"][:, 0].max("surface") == 0.0).to_numpy()
    # what the step control lets through over all contacts: it may take, not give
    assert float(energy.sel(term="rims")[open_].max()) < 2e-2 * supplied
    assert float(energy.sel(term="rims")[open_].min()) > -5e-3 * supplied


def test_damped_rims_only_take_energy(run, pulse, newhall_bearing):
    data = run(lumped_mass(newhall_bearing.as_dcfp(), MASS), strong(pulse, 0.01), dt=0.02)
    rims = data["energy"].sel(term="rims")
    largest = float(np.abs(data["energy"].sel(term="input")).max())
    assert float(rims[-1]) > 0.0
    assert float(rims.min()) > -1e-3 * largest


def test_newmark_takes_nothing_and_generalised_alpha_little(run, pulse, newhall_bearing):
    motion = strong(pulse, 0.01, 1.5)
    for name, bound in (("newmark", 1e-5), ("generalised-alpha", 1e-2)):
        data = run(lumped_mass(newhall_bearing, MASS), motion, dt=0.005, integrator=name)
        largest = float(np.abs(data["energy"].sel(term="input")).max())
        # Newmark: Newton's tolerance, 1e-7 of the weight, at each step
        assert float(np.abs(data["energy"].sel(term="numerical")).max()) < bound * largest
