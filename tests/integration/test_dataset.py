"""The Dataset: complete, labelled, and in equilibrium with itself."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModalDamping,
    Section,
    gravity,
    load,
    lumped_mass,
    moment_frame,
    save,
    storey_drift,
    time_history,
)
from lir_element import CoulombFriction, VelocityFriction
from lir_element.kernels.rotation import rotate
from tests.scenes import plain_pendulum, uneven_bearing

DT = 0.005
EACH = ("time", "bearing")
CONTRACT = {
    "bearing_displacement": ((*EACH, "axis"), "m"),
    "bearing_velocity": ((*EACH, "axis"), "m/s"),
    "bearing_force": ((*EACH, "axis"), "N"),
    "bearing_moment": ((*EACH, "end", "axis"), "N m"),
    "axial_force": (EACH, "N"),
    "slider_displacement": ((*EACH, "surface", "axis"), "m"),
    "interface_slip": ((*EACH, "axis"), "m"),
    "interface_force": (EACH, "N"),
    "interface_eccentricity": (EACH, "m"),
    "rim_force": ((*EACH, "surface"), "N"),
    "rim_displacement": (("bearing", "surface"), "m"),
    "slider_radius": (("bearing",), "m"),
    "bearing_node": (("bearing", "end"), "1"),
    "peak_ground_velocity": (("axis",), "m/s"),
    "node_displacement": (("time", "node", "dof"), "m, rad"),
    "node_acceleration": (("time", "node", "dof"), "m/s2, rad/s2"),
    "ground_acceleration": (("time", "axis"), "m/s2"),
    "base_shear": (("time", "axis"), "N"),
    "energy": (("time", "term"), "J"),
}
ATTRIBUTES = {
    "status": str,
    "message": str,
    "lir_dcfp_version": str,
    "level": str,
    "method": str,
    "integrator": str,
    "spectral_radius": float,
    "dt": float,
    "step_control": str,
    "steps": int,
    "newton_iterations": int,
    "halvings": int,
    "state_determinations": int,
    "tangents": int,
    "degrees_of_freedom": int,
    "seconds_gravity": float,
    "seconds_loop": float,
    "title": str,
    "motion": str,
    "audit": str,
    "features_left_out": str,
    "plane_coupling": float,
}


DEVICE = uneven_bearing(
    slider_radius=0.09,
    friction=(VelocityFriction(0.06, 0.03, 20.0), CoulombFriction(0.05)),
    axial_damping=0.0,
)


@pytest.fixture(scope="module")
def frame() -> Frame:
    frame = moment_frame(bays=(1, 1), storeys=2, bearing=DEVICE, bay_width=(5.0, 4.0))
    frame.set_damping(ModalDamping(0.03))
    return frame


@pytest.fixture(scope="module")
def motion(pulse) -> GroundMotion:
    x, y = pulse(1.9, 1.2, DT), np.roll(pulse(1.4, 1.2, DT), 60)
    return GroundMotion(x=x, y=y, z=0.5 * np.roll(x, 30), dt=DT, name="oblique")


@pytest.fixture(scope="module")
def history(run, frame, motion) -> xr.Dataset:
    data = run(frame, motion, dt=DT)
    assert float(data["interface_slip_size"].max()) > 1e-3  # impact and slip take part
    return data


def test_every_variable_is_there_and_labelled(history):
    for name, (dims, unit) in CONTRACT.items():
        assert history[name].dims == dims, name
        assert history[name].attrs["units"] == unit, name
    for name in [*history.data_vars, "time"]:
        assert set(history[name].attrs) >= {"units", "long_name"}, name
        assert history[name].attrs["long_name"], name
        assert history[name].dtype.kind in "fi", name
    labels = {
        "axis": ["x", "y", "z"],
        "surface": ["bottom", "top"],
        "dof": ["ux", "uy", "uz", "rx", "ry", "rz"],
        "level": ["base", "floor-1", "floor-2"],
        "bearing": ["bearing-0-0", "bearing-0-1", "bearing-1-0", "bearing-1-1"],
    }
    for name, expected in labels.items():
        assert history[name].to_numpy().tolist() == expected


def test_attributes(history, motion):
    for name, kind in ATTRIBUTES.items():
        assert isinstance(history.attrs[name], kind), name
    assert history.attrs["status"] == "ok"
    assert history.attrs["message"] == "completed"
    assert history.attrs["motion"] == motion.name
    assert history.attrs["step_control"] == "fixed"
    assert history.attrs["dt"] == DT
    assert history.attrs["steps"] >= history.sizes["time"] - 1
    assert history.attrs["newton_iterations"] > history.attrs["steps"] // 10
    assert history.attrs["seconds_loop"] > 0.0


def test_time_is_that_of_the_motion(history, motion):
    # round-off: both are whole multiples of the step
    assert_allclose(history["time"], np.arange(len(motion.components)) * DT, rtol=1e-14)
    assert_allclose(history["ground_acceleration"], motion.components, rtol=0.0, atol=1e-12)


def test_the_first_row_is_gravity(history, frame):
    state = gravity(frame)
    nodes = (state.system.transform @ state.displacement).reshape(-1, 6)
    first = history.isel(time=0)
    assert_allclose(first["node_displacement"], nodes, rtol=0.0, atol=1e-15)  # the same numbers
    assert_allclose(first["axial_force"], state.axial_forces, rtol=1e-12)
    assert_allclose(history["static_axial_force"], state.axial_forces, rtol=1e-12)
    assert_allclose(first["energy"], 0.0, rtol=0.0, atol=1e-9)
    weight = 9.80665 * state.system.node_mass[:, 2].sum()
    assert_allclose(history["weight"], weight, rtol=1e-12)


def test_supports_feel_the_ground(history):
    ground = history["node_acceleration"].sel(node="ground-0-0")
    assert_allclose(ground[:, :3], history["ground_acceleration"], rtol=0.0, atol=0.0)  # the same
    assert_allclose(ground[:, 3:], 0.0, rtol=0.0, atol=0.0)


def test_total_acceleration_is_relative_plus_ground(run, pulse):
    smooth = plain_pendulum(friction=0.0)
    dt = 0.002
    motion = GroundMotion(x=pulse(2.0, 1.5, dt), y=pulse(1.0, 1.0, dt, cycles=3.0), dt=dt)
    data = run(lumped_mass(smooth, 1e5), motion, dt=dt)
    dofs = ["ux", "uy"]
    u = data["node_displacement"].sel(node="mass", dof=dofs).to_numpy()
    relative = (u[2:] - 2.0 * u[1:-1] + u[:-2]) / dt**2
    total = data["node_acceleration"].sel(node="mass", dof=dofs).to_numpy()[1:-1]
    expected = relative + data["ground_acceleration"].to_numpy()[1:-1, :2]
    # average acceleration: the difference is the mean of three accelerations, dt^2/4 a''
    assert_allclose(total, expected, rtol=0.0, atol=2e-4 * np.abs(total).max())
    velocity = data["bearing_velocity"][:, 0, :2].to_numpy()
    mean = 0.5 * (velocity[1:] + velocity[:-1])
    # exact for average acceleration, but for round-off over the step
    assert_allclose(np.diff(u, axis=0) / dt, mean, rtol=0.0, atol=1e-9)


def test_whole_structure_is_in_equilibrium(history, frame):
    mass = gravity(frame).system.node_mass[:, :3]
    inertia = (mass * history["node_acceleration"].to_numpy()[..., :3]).sum(axis=1)
    weight = float(history["weight"])
    expected = -inertia - [0.0, 0.0, weight]
    # Newton's tolerance, 1e-7 of the weight, on each of some ten equations
    assert_allclose(history["base_shear"], expected, rtol=0.0, atol=2e-6 * weight)


def test_base_shear_is_the_sum_of_the_bearings(history):
    total = history["bearing_force"].sum("bearing")
    assert_allclose(history["base_shear"], total, rtol=0.0, atol=1e-9 * float(history["weight"]))


def test_a_spring_to_the_ground_counts_in_the_base_shear(run, motion):
    frame = lumped_mass(DEVICE, 1e5)
    frame.add_node("wall", 2.0, 0.0, DEVICE.height)
    frame.fix("wall", "all")
    stiffness = 8e5
    frame.add_spring("tie", "wall", "mass", (stiffness, 0.0, 0.0, 0.0, 0.0, 0.0))
    data = run(frame, motion, dt=DT)
    u = data["node_displacement"].sel(node="mass", dof="ux")
    force = data["bearing_force"].sel(axis="x")[:, 0]
    weight = float(data["weight"])
    # round-off of the sum
    assert_allclose(
        data["base_shear"].sel(axis="x"), force + stiffness * u, rtol=0.0, atol=1e-9 * weight
    )
    inertia = 1e5 * data["node_acceleration"].sel(node="mass", dof="ux")
    # Newton's tolerance
    assert_allclose(data["base_shear"].sel(axis="x"), -inertia, rtol=0.0, atol=1e-6 * weight)


def axes_of_plates(data: xr.Dataset, names: list[str]) -> np.ndarray:
    turns = data["node_displacement"].sel(node=names).to_numpy()[..., 3:]
    out, spin = np.zeros((3, 3)), np.zeros((3, 3))
    axes = np.zeros_like(turns)
    for place in np.ndindex(turns.shape[:2]):
        rotate(*turns[place], out, spin)
        axes[place] = out[:, 2]
    return axes


def test_kinematics_of_the_sliders(history):
    """Close d1 + d2 + s + (h - N / k) n = U + h e_z and d2 = -R2 (n - e_j)."""
    bearing = DEVICE
    r_1, r_2 = bearing.radii
    stiffness = bearing.resolved()["axial_stiffness"]
    d_1, d_2 = (history["slider_displacement"].sel(surface=s).to_numpy() for s in ("bottom", "top"))
    slip = history["interface_slip"].to_numpy()
    up = np.array([0.0, 0.0, 1.0])
    n = up - d_1 / r_1
    assert_allclose(np.linalg.norm(n, axis=-1), 1.0, rtol=1e-13)  # round-off, as all below
    assert_allclose((slip * n).sum(axis=-1), 0.0, rtol=0.0, atol=1e-14)
    names = [str(name).replace("bearing", "base") for name in history["bearing"].to_numpy()]
    top = axes_of_plates(history, names)
    assert np.abs(top[..., :2]).max() > 1e-4
    assert_allclose(d_2, -r_2 * (n - top), rtol=0.0, atol=1e-14)
    pressed = history["axial_force"].to_numpy()[..., None] > 0.0
    height = bearing.slider_height - history["axial_force"].to_numpy()[..., None] / stiffness
    # from node to node: the levers turn with their plates, of which only the top one tilts
    left = d_1 + d_2 + slip + height * n
    right = history["bearing_displacement"].to_numpy() + bearing.slider_height * up
    assert pressed.mean() > 0.9
    assert_allclose((left - right) * pressed, 0.0, rtol=0.0, atol=1e-13)


def test_forces_and_moments_of_a_bearing_balance(history):
    force = history["bearing_force"].to_numpy()
    m_i, m_j = (history["bearing_moment"].sel(end=e).to_numpy() for e in ("i", "j"))
    arm = history["bearing_displacement"].to_numpy() + np.array([0.0, 0.0, DEVICE.height])
    gap = m_i + m_j + np.cross(arm, force)
    assert_allclose(gap, 0.0, rtol=0.0, atol=1e-12 * np.abs(force).max())  # round-off


def test_axial_force_is_the_force_along_the_slider(history):
    # the axis leans by some degrees; friction lies across it (round-off)
    n = np.array([0.0, 0.0, 1.0]) - history["slider_displacement"].sel(surface="bottom") / 1.0
    along = -(history["bearing_force"] * n).sum("axis")
    assert_allclose(along, history["axial_force"], rtol=0.0, atol=1e-9 * float(history["weight"]))


def test_energy_terms_equal_the_works_of_the_bearings(history):
    energy = history["energy"]
    low = history["work_low_friction"].sum("bearing")
    stored = history["work_friction_elastic"].sum("bearing")
    parts = {
        "low_friction_bottom": low.sel(surface="bottom"),
        "low_friction_top": low.sel(surface="top"),
        "high_friction": history["work_high_friction"].sum("bearing"),
        "friction_elastic": stored - stored.isel(time=0),  # against the state at rest
        "rims": history["work_rims"].sum("bearing"),
        "contact": history["work_contact"].sum("bearing"),
    }
    for term, expected in parts.items():
        assert float(np.abs(expected).max()) > 0.0, term
        assert_allclose(energy.sel(term=term), expected, rtol=1e-12, atol=1e-9)  # order of sums


def test_energies_against_their_definitions(history, frame):
    state = gravity(frame)
    system, energy = state.system, history["energy"]
    u = history["node_displacement"].to_numpy().reshape(history.sizes["time"], -1)
    rise = u - u[0]
    gained = -rise @ system.node_load
    largest = float(np.abs(energy.sel(term="input")).max())
    # both are sums of forces times displacements: round-off
    assert_allclose(energy.sel(term="gravity"), gained, rtol=0.0, atol=1e-9 * largest + 1e-6)
    q = np.linalg.lstsq(system.transform.toarray(), u.T, rcond=None)[0].T
    stiffness = system.stiffness + state.geometric
    strain = 0.5 * np.einsum("ti,ti->t", q, (stiffness @ q.T).T)
    assert_allclose(energy.sel(term="elastic"), strain - strain[0], rtol=0.0, atol=1e-8 * largest)
    ground = history["ground_acceleration"].to_numpy()
    moved = np.diff(u, axis=0).reshape(len(u) - 1, -1, 6)[..., :3]
    load = system.node_mass[None, :, :3] * (0.5 * (ground[1:] + ground[:-1]))[:, None, :]
    supplied = -np.cumsum((load * moved).sum(axis=(1, 2)))
    # within a base step that was halved the ground is taken at more points
    assert_allclose(energy.sel(term="input")[1:], supplied, rtol=0.0, atol=2e-3 * largest)


def test_save_and_load_hand_back_the_same(history, tmp_path, run, motion):
    for number, data in enumerate((history, run(lumped_mass(DEVICE, 1e5), motion, dt=DT))):
        path = tmp_path / f"run-{number}.nc"
        save(data, path)
        xr.testing.assert_identical(load(path), data)


def test_record_every_may_be_a_whole_float(run, frame, motion):
    assert run(frame, motion, dt=DT, record_every=50.0).sizes["time"] == 1 + 679 // 50


def test_progress_does_not_change_the_run(run, frame, motion, history):
    seen: list[float] = []
    data = run(frame, motion, dt=DT, progress=seen.append)
    assert_allclose(data["node_displacement"], history["node_displacement"], rtol=0.0, atol=0.0)
    assert_allclose(data["energy"], history["energy"], rtol=0.0, atol=0.0)
    assert 40 <= len(seen) <= 51
    assert seen[-1] == 1.0
    assert (np.diff(seen) > 0.0).all()


def test_shorter_than_the_motion(run, frame, motion, history):
    data = run(frame, motion, dt=DT, duration=1.2)
    assert_allclose(data["time"][-1], 1.2, rtol=1e-14)
    part = history["node_displacement"][: data.sizes["time"]]
    assert_allclose(data["node_displacement"], part, rtol=0.0, atol=1e-15)  # the same steps


def test_longer_than_the_motion_the_ground_rests(run, frame, motion, history):
    data = run(frame, motion, dt=DT, duration=motion.duration + 0.5)
    count = history.sizes["time"]
    assert data.sizes["time"] == count + 100
    assert_allclose(
        data["bearing_force"][:count], history["bearing_force"], rtol=0.0, atol=0.0
    )  # the same steps
    assert float(np.abs(data["ground_acceleration"][count:]).max()) == 0.0
    still = data["energy"].sel(term="input")[count:]
    assert_allclose(still, still[0], rtol=0.0, atol=0.0)  # no ground, no input


@pytest.mark.parametrize(("dt", "count"), [(0.24, 2), (0.08, 4), (0.04, 7)])
def test_the_last_sample_counts_to_its_end(run, dt, count):
    motion = GroundMotion(x=np.ones(2), dt=0.24)
    data = run(lumped_mass(DEVICE, 1e5), motion, dt=dt)
    assert data.sizes["time"] == count
    inertia = 1e5 * data["node_acceleration"].sel(node="mass", dof="ux")
    # Newton's tolerance
    assert_allclose(data["base_shear"].sel(axis="x"), -inertia, rtol=0.0, atol=1.0)


def test_drift_of_a_model_without_levels_is_refused(run, motion):
    data = run(lumped_mass(DEVICE, 1e5), motion, dt=DT)
    with pytest.raises(ValueError, match="0 levels: drifts need at least two"):
        storey_drift(data)


def on_column(section: Section) -> Frame:
    """Put a bearing on a column, and a second one on the ground under the same deck."""
    frame, bearing = Frame("pier"), DEVICE
    frame.add_node("foot", 0.0, 0.0, -4.0)
    frame.fix("foot", "all")
    frame.add_node("head", 0.0, 0.0, 0.0)
    frame.add_member("column", "foot", "head", section)
    frame.add_mass("head", 4e3, (2e3, 2e3, 2e3))
    frame.add_node("abutment", 12.0, 0.0, 0.0)
    frame.fix("abutment", "all")
    for k, (below, x) in enumerate((("head", 0.0), ("abutment", 12.0))):
        frame.add_node(f"deck-{k}", x, 0.0, bearing.height)
        frame.fix(f"deck-{k}", "rx", "ry")
        frame.add_mass(f"deck-{k}", 6e4)
        frame.add_bearing(f"bearing-{k}", below, f"deck-{k}", bearing)
    frame.add_member("deck", "deck-0", "deck-1", Section.box(2.0, 1.0, 0.03))
    return frame


def residual_of_equilibrium(run, frame: Frame, motion: GroundMotion) -> tuple[np.ndarray, float]:
    data = run(frame, motion, dt=DT)
    mass = gravity(frame).system.node_mass[:, :2]
    moving = mass.copy()
    moving[data["node"].to_numpy().tolist().index("foot")] = 0.0  # straight on the ground
    inertia = (moving * data["node_acceleration"].to_numpy()[..., :2]).sum(axis=1)
    return data["base_shear"].to_numpy()[:, :2] + inertia, float(np.abs(inertia).max())


def test_a_bearing_on_a_column_is_not_counted_twice(run, motion):
    gap, largest = residual_of_equilibrium(run, on_column(Section.box(1.0, 1.0, 0.2)), motion)
    # without the P-Delta of this stout column, N / L against 12 EI / L^3
    assert_allclose(gap, 0.0, rtol=0.0, atol=1e-3 * largest)


def test_base_shear_under_a_slender_column_is_in_equilibrium(run, motion):
    section = Section.box(0.4, 0.4, 0.016, density=0.0)
    gap, largest = residual_of_equilibrium(run, on_column(section), motion)
    assert_allclose(gap, 0.0, rtol=0.0, atol=1e-5 * largest)  # Newton's tolerance


def test_base_shear_holds_a_permanent_lateral_load_on_a_column(motion):
    frame = on_column(Section.box(1.0, 1.0, 0.2))
    frame.add_uniform_load("column", (0.0, 2.5e3, 0.0))
    data = time_history(
        frame, motion, dt=DT, duration=DT
    )  # no input yet to measure a energy balance by
    assert_allclose(data["base_shear"].sel(axis="y")[0], 4.0 * 2.5e3, rtol=1e-3)  # P-Delta
