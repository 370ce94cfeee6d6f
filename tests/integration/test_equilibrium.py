"""Recorded forces, accelerations and steps belong together; what has no mass has no say."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    AuditWarning,
    Frame,
    GroundMotion,
    ModalDamping,
    Section,
    audit,
    floor_acceleration,
    lumped_mass,
    moment_frame,
    shear_building,
    step_sensitivity,
)
from frames.results.findings import doubts_of
from frames.solve import run as run_module
from lir_element import LIRBearing, VelocityFriction
from lir_element.units import STANDARD_GRAVITY

T = np.arange(0.0, 6.0, 0.01)
PULSES = np.sin(2 * np.pi * T / 1.5) * np.exp(-((T - 2.5) ** 2) / 1.5)
ACROSS = np.cos(2 * np.pi * T / 1.1) * np.exp(-((T - 2.5) ** 2) / 1.5)
MOTION = GroundMotion(x=1.8 * PULSES, y=1.2 * ACROSS, z=1.5 * np.sin(20.0 * T) * PULSES, dt=0.01)


def device(scale: float = 1.0, **changes: object) -> LIRBearing:
    """A bearing with everything declared; `scale` times as long at eight times the force."""
    s, t, force = scale, scale**0.5, scale**1.5
    options: dict[str, object] = {
        "radius": 1.185 * s,
        "slider_height": 0.12 * s,
        "slider_radius": 0.15 * s,
        "friction": VelocityFriction(0.065, 0.03, 20.0 * t / s),
        "interface_friction": 0.13,
        "capacity": 0.2 * s,
        "axial_stiffness": 5e9 * force / s,
        "axial_damping": 2e6 * force * t / s,
        "rim_stiffness": 5e8 * force / s,
        "rim_damping": 1e6 * force * t / s,
        "rim_overrun": 0.05 * s,
        "slip_capacity": 0.15 * s,
        "design_load": 5e5 * force,
        "yield_displacement": 0.25e-3 * s,
        "interface_yield_displacement": 0.01e-3 * s,
    }
    return LIRBearing(**(options | changes))  # type: ignore[arg-type]


def with_middles(mass: float = 0.0, inertia: float = 0.0) -> Frame:
    """A storey on four bearings; nodes in the middle of its base beams, which weigh nothing."""
    frame = Frame("with middles")
    beam = replace(Section.i_shape(0.8, 0.3, 0.03, 0.016), density=0.0)
    places, bearing = ((0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)), device()
    for k, (x, y) in enumerate(places):
        frame.add_node(f"g{k}", x, y, 0.0)
        frame.fix(f"g{k}", "all")
        frame.add_node(f"b{k}", x, y, bearing.height)
        frame.add_node(f"t{k}", x, y, bearing.height + 3.5)
        frame.add_mass(f"b{k}", 15e3, (inertia, inertia, 0.0))
        frame.add_mass(f"t{k}", 15e3)
        frame.add_bearing(f"bearing-{k}", f"g{k}", f"b{k}", bearing)
        frame.add_member(f"column-{k}", f"b{k}", f"t{k}", beam)
    for k, (x, y) in enumerate(places):
        j = (k + 1) % 4
        u, v = places[j]
        frame.add_node(f"m{k}", 0.5 * (x + u), 0.5 * (y + v), bearing.height)
        frame.add_mass(f"m{k}", mass)
        frame.add_member(f"base-{k}", f"b{k}", f"m{k}", beam)
        frame.add_member(f"base-{k}-", f"m{k}", f"b{j}", beam)
        frame.add_member(f"roof-{k}", f"t{k}", f"t{j}", beam)
    for level, kinds in (("base", "bm"), ("roof", "t")):
        nodes = [f"{kind}{k}" for kind in kinds for k in range(4)]
        frame.add_diaphragm(level, nodes)
        frame.add_level(level, nodes)
    frame.set_damping(ModalDamping(0.02))
    return frame


LIGHT = {
    "none": {},
    "tiny mass": {"mass": 1e-3},
    "a kilogram": {"mass": 1.0},
    "tiny inertia": {"inertia": 1e-3},
    "a kg m2": {"inertia": 1.0},
}


@pytest.mark.meant(".")
@pytest.mark.parametrize("method", ["direct", "reduced"])
@pytest.mark.parametrize("given", LIGHT.values(), ids=LIGHT)
def test_what_has_no_mass_moves_as_what_has(run, given, method):
    data = run(with_middles(**given), MOTION, method=method)
    moves = np.abs(data["node_acceleration"].sel(dof=["ux", "uy", "uz"])).max("time")
    heavy = moves.sel(node=[f"b{k}" for k in range(4)]).max("node")
    middle = moves.sel(node=[f"m{k}" for k in range(4)]).max("node")
    assert (middle < 1.5 * heavy).all()  # it was up to some 1e5 times as much
    assert float(np.abs(data["node_acceleration"].sel(dof=["rx", "ry"])).max()) < 20.0


def test_massless_nodes_between_follow_the_beams_line(run):
    """Statically: half of each end, and an eighth of the length of what the ends turn."""
    data = run(with_middles(), MOTION)
    a = data["node_acceleration"]
    ends = 0.5 * (a.sel(node="b0", dof="uz") + a.sel(node="b1", dof="uz"))
    turns = a.sel(node="b0", dof="ry") - a.sel(node="b1", dof="ry")
    size = float(np.abs(ends).max())
    assert_allclose(a.sel(node="m0", dof="uz"), ends - 6.0 / 8.0 * turns, atol=1e-3 * size)


def test_a_floors_mean_is_that_of_its_masses(run):
    data = run(with_middles(mass=2e3), MOTION)
    mass = data["node_mass"].sel(axis="z")
    at_base = data["level_node"] == 0
    a = data["node_acceleration"].sel(dof="uz")
    expected = (a * mass).where(at_base, 0.0).sum("node") / mass.where(at_base, 0.0).sum()
    found = floor_acceleration(data).sel(level="base", axis="z")
    assert_allclose(found, expected, rtol=0.0, atol=1e-9)
    assert float(data["node_mass"].sel(node=["g0", "g1"]).max()) == 0.0


SCENES = {
    "mass": lambda: lumped_mass(device(), 2e5),
    "impacts": lambda: lumped_mass(device(capacity=0.05), 2e5),
    "stick": lambda: shear_building(device(), 5e4, 4e7, storeys=3, plan=(1, 6.0)),
    "frame": lambda: moment_frame((1, 1), 2, bearing=device()),
}


@pytest.mark.meant(".")
@pytest.mark.parametrize("integrator", ["newmark", "generalised-alpha"])
@pytest.mark.parametrize("scene", SCENES)
def test_forces_and_accelerations_of_one_instant_balance(run, scene, integrator):
    """By hand, from bearing forces, masses and accelerations: base shear and vertical force."""
    data = run(SCENES[scene](), MOTION, integrator=integrator)
    weight = float(data["weight"])
    inertia = np.einsum(
        "tna,na->ta", data["node_acceleration"].to_numpy()[..., :3], data["node_mass"].to_numpy()
    )
    left = data["base_shear"].to_numpy() + inertia
    left[:, 2] += weight
    assert np.abs(left).max() < 1e-6 * weight  # it was up to 1.5 times the weight
    gaps = np.abs(data["imbalance"].to_numpy()).max(axis=0)
    assert_allclose(np.abs(left).max(axis=0) / weight, gaps[:3], atol=1e-9)
    assert gaps[np.isfinite(gaps)].max() < 2e-4  # moments too


def test_the_audit_names_forces_that_do_not_balance(run):
    data = run(SCENES["stick"](), MOTION)
    assert not doubts_of(data)
    assert [f.doubtful for f in audit(data) if f.feature == "equilibrium"] == [False]
    wrong = data.copy(deep=True)
    wrong["imbalance"][50, 2] = 0.03
    (found,) = [f for f in audit(wrong) if f.feature == "equilibrium"]
    assert found.doubtful
    assert f"t = {float(data['time'][50]):.4g} s" in found.sentence
    assert "3 %" in found.sentence
    assert "Fz" in found.sentence


def test_the_audit_names_a_node_that_is_thrown(run):
    frame = with_middles(mass=30.0)  # not light enough to be said to have none: it rings
    beam = replace(Section.i_shape(0.1, 0.05, 0.005, 0.005), density=0.0)
    frame.add_node("post", 3.0, 0.0, device().height + 0.5)
    frame.add_member("post", "m0", "post", beam)
    frame.add_mass("post", 2.0)
    strong = GroundMotion(x=MOTION.components[:, 0], z=300.0 * np.sin(80.0 * T) * PULSES, dt=0.01)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = run(frame, strong, dt=0.0025)
    (found,) = [f for f in audit(data) if f.feature == "accelerations"]
    size = np.linalg.norm(data["node_acceleration"].to_numpy()[..., :3], axis=-1)
    heavy = (data["node_mass"] > 0.0).any("axis").to_numpy()
    worst = np.where(heavy, size, 0.0).max()
    assert found.doubtful
    assert found.number == pytest.approx(worst / STANDARD_GRAVITY, rel=1e-9)
    assert found.number > 50.0
    assert any("reached" in doubt and " g at t" in doubt for doubt in doubts_of(data))


def test_a_given_step_tells_its_error(run):
    frame = SCENES["stick"]()
    fine = run(frame, MOTION, dt=0.000625, record_every=16)
    u, v = (each["bearing_displacement"] for each in (fine, run(frame, MOTION, dt=0.01)))
    error = float(np.abs(u.to_numpy() - v.to_numpy()).max() / np.abs(u).max())
    stated = [run(frame, MOTION, dt=dt).attrs["estimated_error"] for dt in (0.01, 0.005, 0.0025)]
    assert 0.1 * error < stated[0] < 10.0 * error
    assert stated[0] > 2.0 * stated[1] > 4.0 * stated[2]


def test_half_a_step_and_noise_are_compared():
    frame = SCENES["mass"]()
    table = step_sensitivity(frame, MOTION, dt=0.005)
    assert (table["noise"].dropna() < 1e-6).all()
    assert 0.0 < table.loc["bearing displacement", "halved"] < 0.01
    rough = GroundMotion(x=MOTION.components[::5, 0], dt=0.05)
    with pytest.warns(AuditWarning, match="half the step changes displacements by"):
        step_sensitivity(frame, rough, dt=0.05)
    with pytest.raises(TypeError, match="step_sensitivity does not support"):
        step_sensitivity(frame, MOTION, record_every=2)


@pytest.mark.meant(".")
@pytest.mark.parametrize("steps", ["given", "chosen"])
@pytest.mark.parametrize("scene", ["impacts", "both ways"])
def test_similar_scenes_move_alike(run, scene, steps, monkeypatch):
    """Lengths times four, masses times eight, times twice: to the last digit, powers of two.

    Chosen steps know one time without a scale, beside the largest step.
    """
    capacity, found = (0.08 if scene == "impacts" else 0.15), []
    impulse = run_module._ERROR_EVENT
    for s in (1.0, 4.0):
        monkeypatch.setattr(run_module, "_ERROR_EVENT", impulse * s**0.5)
        c = 1.2 * MOTION.components
        motion = GroundMotion(x=c[:, 0], y=c[:, 1], dt=0.01 * s**0.5)
        motion = motion.resampled(0.0025 * s**0.5)  # below the largest step
        frame = lumped_mass(device(s, capacity=capacity * s), 2e5 * s**1.5)
        found.append(run(frame, motion, dt=0.005 * s**0.5 if steps == "given" else None))
    assert float(np.abs(found[0]["slider_spin"]).max()) > 0.01  # rims turn the sliders
    assert float(found[0]["rim_force"].max()) > 0.0
    pair: list[xr.DataArray] = [each["bearing_displacement"] for each in found]
    count = min(len(each["time"]) for each in pair)
    assert_allclose(pair[1][:count] / 4.0, pair[0][:count], rtol=0.0, atol=1e-9)
