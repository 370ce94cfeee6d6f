"""Runs with features left out: exact where the feature is neutral; energy balances close."""

from functools import partial

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModalDamping,
    gravity,
    lumped_mass,
    moment_frame,
    shear_building,
)
from frames.statics.springs import exact_features, plane_coupling
from lir_element import CoulombFriction, Features, LIRBearing
from tests.scenes import uneven_bearing

DT = 0.004
G = 9.80665


device = partial(uneven_bearing, design_load=3e5)


def building(bearing: LIRBearing) -> Frame:
    frame = moment_frame(bays=(1, 1), storeys=2, bearing=bearing, bay_width=(5.0, 4.0))
    frame.set_damping(ModalDamping(0.03))
    return frame


@pytest.fixture(scope="module")
def motion(pulse) -> GroundMotion:
    x, y = pulse(1.9, 1.2, DT), np.roll(pulse(1.4, 1.2, DT), 60)
    return GroundMotion(x=x, y=y, z=0.5 * np.roll(x, 30), dt=DT)


@pytest.fixture(scope="module")
def plain(run, motion) -> xr.Dataset:
    data = run(building(device()), motion, dt=DT)
    assert float(data["interface_slip_size"].max()) > 1e-3
    return data


@pytest.mark.parametrize("name", Features.names())
def test_ledger_closes_with_each_left_out(run, motion, plain, name):
    """`run` checks the energy balance; what is left out must show, and shake the same mass."""
    bearing = device().as_dcfp(rims=False) if name == "interface" else device()
    data = run(building(bearing), motion, dt=DT, features=Features().without(name))
    assert name in data.attrs["features_left_out"]
    assert data.attrs["status"] == "ok"
    assert_allclose(data["static_axial_force"], plain["static_axial_force"], rtol=0.02)
    inertia = data["node_acceleration"].sel(dof=["ux", "uz"]).to_numpy()
    mass = gravity(building(bearing)).system.node_mass[:, [0, 2]]
    expected = -(mass * inertia).sum(axis=1) - [0.0, float(data["weight"])]
    shear = data["base_shear"].sel(axis=["x", "z"])
    assert_allclose(shear, expected, rtol=0.0, atol=2e-6 * float(data["weight"]))  # as Newton's


def test_ledger_closes_with_everything_left_out(run, motion):
    data = run(building(device()), motion, dt=DT, features=Features().without(*Features.names()))
    assert data.attrs["features_left_out"].count(",") == len(Features.names()) - 1
    assert float(np.abs(data["bearing_displacement"].sel(axis="y")).max()) == 0.0


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("rims", device(capacity=np.inf)),
        ("interface", device().as_dcfp()),
        ("velocity_dependence", device(friction=CoulombFriction(0.06))),
    ],
)
def test_left_out_is_the_device_without(run, motion, name, other):
    weak = motion.scaled(0.6)  # a rigid slider would overrun its rims
    a = run(building(device()), weak, dt=DT, features=Features().without(name))
    b = run(building(other), weak, dt=DT)
    for variable in ("node_displacement", "bearing_force", "energy"):
        # the slow friction of the start differs without speed: none of it moves
        assert_allclose(a[variable], b[variable], rtol=0.0, atol=1e-9 * float(b["weight"]))


def test_pressed_bearings_do_not_miss_uplift(run, pulse):
    motion = GroundMotion(x=pulse(1.9, 1.2, DT), dt=DT)
    a, b = (
        run(lumped_mass(device(), 3e4), motion, dt=DT, features=f)
        for f in (Features(), Features(uplift=False))
    )
    assert float(a["axial_force"].min()) > 0.0
    # the same law, compiled into other operations
    assert_allclose(a["node_displacement"], b["node_displacement"], rtol=0.0, atol=1e-9)


def test_parallel_plates_do_not_miss_their_rotation(run, motion):
    a, b = (
        run(lumped_mass(device(), 3e4), motion, dt=DT, features=f)
        for f in (Features(), Features(plate_rotation=False))
    )
    assert_allclose(a["node_displacement"], b["node_displacement"], rtol=0.0, atol=1e-15)


def test_without_plate_rotation_the_base_has_fewer_unknowns(motion, run, plain):
    frame = building(device())
    full, less = (len(gravity(frame, f).run.b) for f in (None, Features(plate_rotation=False)))
    assert (full, less) == (15, 7)  # X, Y, RZ of the base, and uz, rx, ry of four nodes
    data = run(frame, motion, dt=DT, features=Features(plate_rotation=False))
    u, v = (d["bearing_displacement"].sel(axis=["x", "y"]).to_numpy() for d in (plain, data))
    assert_allclose(v, u, rtol=0.0, atol=0.05 * np.abs(u).max())


@pytest.mark.parametrize("kind", ["mass", "stick"])
def test_plane_motion_of_a_plane_model_is_exact(run, pulse, kind):
    x = pulse(1.9, 1.2, DT)
    motion = GroundMotion(x=x, z=0.3 * np.roll(x, 30), dt=DT)
    if kind == "mass":
        frame = lumped_mass(device(), 3e4)
    else:
        frame = shear_building(device(), 1e4, 5e6, storeys=3)
    assert exact_features(frame, motion).left_out == ("second_direction",)
    assert plane_coupling(frame) == 0.0
    full = run(frame, motion, dt=DT)
    plane = run(frame, motion, dt=DT, features=exact_features(frame, motion))
    assert float(full["interface_slip_size"].max()) > 1e-3
    for name in ("node_displacement", "bearing_force", "interface_slip", "energy"):
        size = float(np.abs(full[name]).max())
        # the same numbers but for the order of sums, on which iterations depend
        assert_allclose(plane[name], full[name], rtol=0.0, atol=1e-7 * size)


def test_the_plane_is_left_only_where_that_is_exact(pulse):
    x = pulse(1.0, 1.0, DT)
    along, oblique = GroundMotion(x=x, dt=DT), GroundMotion(x=x, y=1e-3 * x, dt=DT)
    frame = lumped_mass(device(), 3e4)
    assert exact_features(frame, oblique) == Features.all()
    assert exact_features(building(device()), along) == Features.all()  # floor beams turn joints
    frame.add_load("mass", (0.0, 10.0, 0.0, 0.0, 0.0, 0.0))
    assert exact_features(frame, along) == Features.all()


def test_what_no_bearing_has_is_left_out(pulse):
    motion = GroundMotion(x=pulse(1.0, 1.0, DT), y=pulse(1.0, 1.0, DT), dt=DT)
    bearing = device(friction=CoulombFriction(0.05)).as_dcfp(rims=False)
    out = exact_features(lumped_mass(bearing, 3e4), motion).left_out
    assert out == ("rims", "interface", "velocity_dependence")


def test_eccentric_mass_couples_the_directions():
    frame = shear_building(device(), 1e4, 5e6, storeys=1, plan=((1, 1), (5.0, 4.0)))
    assert plane_coupling(frame) < 1e-12  # symmetric: round-off
    frame.add_mass("base-1-1", 1e4)
    assert plane_coupling(frame) > 0.01


def test_without_vertical_coupling_lateral_motion_does_not_lift(run, pulse):
    motion = GroundMotion(x=pulse(1.9, 1.2, DT), dt=DT)
    features = Features(vertical_coupling=False)
    data = run(lumped_mass(device(), 3e4), motion, dt=DT, features=features)
    weight = 3e4 * G
    assert float(np.abs(data["bearing_displacement"].sel(axis="x")).max()) > 0.08
    vertical = data["bearing_force"].sel(axis="z")
    assert_allclose(vertical, -weight, rtol=1e-6)  # Newton's tolerance
    lift = data["node_displacement"].sel(node="mass", dof="uz")
    assert_allclose(lift, lift[0], rtol=0.0, atol=1e-8)


def test_gravity_is_kept_without_vertical_coupling():
    frame = building(device())
    full, less = gravity(frame), gravity(frame, Features(vertical_coupling=False))
    assert_allclose(less.axial_forces, full.axial_forces, rtol=0.0, atol=0.0)  # the same
    assert_allclose(less.run.old["vertical_force"], full.axial_forces, rtol=1e-3)
    assert_allclose(less.model.props["fixed_load"], full.axial_forces, rtol=1e-3)
