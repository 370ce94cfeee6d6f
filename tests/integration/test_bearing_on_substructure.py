"""Bearings on elastic columns: the lower plate moves and turns with the column's head."""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, GroundMotion, Section, gravity, lumped_mass
from frames.model.components import DOFS
from lir_element import CoulombFriction
from lir_element.kernels.rotation import rotate
from tests.scenes import uneven_bearing

DT, MASS, HEIGHT, G = 0.005, 1e5, 4.0, 9.80665
E, I_COLUMN = 2e11, 6e-4


def column(factor: float = 1.0, area: float = 0.04) -> Section:
    return Section(
        area=area,
        inertia_y=I_COLUMN * factor,
        inertia_z=I_COLUMN * factor,
        torsion_constant=1e-3 * factor,
        elastic_modulus=E,
        shear_modulus=8e10,
    )


device = partial(uneven_bearing, friction=0.05)


def pier(bearing, factor=1.0, area=0.04, head_mass=2e3):
    """Build a deck that stays level on one bearing on one column."""
    frame = Frame("pier")
    frame.add_node("foot", 0.0, 0.0, -HEIGHT)
    frame.fix("foot", "all")
    frame.add_node("head", 0.0, 0.0, 0.0)
    frame.add_member("column", "foot", "head", column(factor, area))
    frame.add_mass("head", head_mass)
    frame.add_node("deck", 0.0, 0.0, bearing.height)
    frame.fix("deck", "rx", "ry", "rz")
    frame.add_mass("deck", MASS)
    frame.add_bearing("bearing", "head", "deck", bearing)
    return frame


@pytest.fixture(scope="module")
def motion(pulse) -> GroundMotion:
    x, y = pulse(2.0, 1.2, DT), np.roll(pulse(1.4, 1.2, DT), 60)
    return GroundMotion(x=x, y=y, z=0.3 * np.roll(x, 30), dt=DT)


@pytest.fixture(scope="module")
def history(run, motion):
    data = run(pier(device()), motion, dt=DT)
    assert float(data["rim_force"].max()) > 0.0
    return data


def test_gravity_goes_through_the_bearing_into_the_column():
    state = gravity(pier(device()))
    assert_allclose(state.axial_forces, MASS * G, rtol=1e-8)  # Newton's tolerance
    place = dict(zip(state.system.dof_labels, state.displacement, strict=True))
    shortening = (MASS + 2e3) * G * HEIGHT / (E * 0.04)
    assert_allclose(place["head uz"], -shortening, rtol=1e-8)
    closure = MASS * G / device().resolved()["axial_stiffness"]
    assert_allclose(place["deck uz"], -shortening - closure, rtol=1e-8)


def test_moments_at_the_joint_are_in_equilibrium(history):
    state = gravity(pier(device()))
    system = state.system
    names = history["node"].to_numpy().tolist()
    flat = [
        6 * names.index(label.split()[0]) + DOFS.index(label.split()[1])
        for label in system.dof_labels
    ]
    q = history["node_displacement"].to_numpy().reshape(history.sizes["time"], -1)[:, flat]
    forces = ((system.stiffness + state.geometric) @ q.T).T
    moment = history["bearing_moment"].sel(end="i")[:, 0].to_numpy()
    assert np.abs(moment).max() > 1e4
    weight = MASS * G
    for k, dof in enumerate(("rx", "ry", "rz")):
        held = forces[:, system.dof_labels.index(f"head {dof}")]
        # a head without rotary inertia, at every step; Newton's tolerance 1e-7 of the weight
        assert_allclose(held + moment[:, k], 0.0, rtol=0.0, atol=1e-6 * weight)


def test_lower_plate_turns_with_the_head(history):
    turns = history["node_displacement"].sel(node="head").to_numpy()[:, 3:]
    assert np.abs(turns).max() > 2e-3
    out, spin = np.zeros((3, 3)), np.zeros((3, 3))
    e_i = np.zeros_like(turns)
    for k, turn in enumerate(turns):
        rotate(*turn, out, spin)
        e_i[k] = out[:, 2]
    up = np.array([0.0, 0.0, 1.0])
    r_1, r_2 = device().radii
    d_1, d_2 = (
        history["slider_displacement"].sel(surface=s)[:, 0].to_numpy() for s in ("bottom", "top")
    )
    n = up - d_2 / r_2  # the top plate stays level
    assert_allclose(d_1, -r_1 * (n - e_i), rtol=0.0, atol=1e-14)  # round-off
    # sphere centres: bottom one R1 along e_i above the head, top one R2 below the deck
    moved = history["bearing_displacement"][:, 0].to_numpy() + device().height * up
    centres = moved - r_2 * up - r_1 * e_i
    slip = history["interface_slip"][:, 0].to_numpy()
    string = -((centres - slip) * n).sum(axis=1)
    assert_allclose(centres, slip - string[:, None] * n, rtol=0.0, atol=1e-13)  # round-off


def test_tilt_of_the_head_moves_the_deck():
    """A lateral load on frictionless bearings: column, tilt times R1, and the pendulum's swing."""
    bearing = device(friction=CoulombFriction(0.0), capacity=math.inf, interface_friction=math.inf)
    push = 0.03 * MASS * G
    frame = pier(bearing, 4.0)
    frame.add_load("deck", (push, 0.0, 0.0, 0.0, 0.0, 0.0))
    state = gravity(frame)
    place = dict(zip(state.system.dof_labels, state.displacement, strict=True))
    swing = bearing.effective_radius * push / (MASS * G)
    tilt = place["head ry"]
    assert 1.0 * tilt > 0.01 * swing
    # small angles: their squares, (push / W)^2 / 2 and the closure of the contact
    assert_allclose(place["deck ux"], place["head ux"] + 1.0 * tilt + swing, rtol=1e-3)
    # the string passes the bottom sphere's centre, R1 above the head and R1 tilt beside it
    moment = push * 1.0 + MASS * G * 1.0 * tilt
    bending = E * 4.0 * I_COLUMN
    expected = push * HEIGHT**2 / (2 * bending) + moment * HEIGHT / bending
    # the column's own P-Delta: W H^2 / (3 EI), some per cent
    assert_allclose(tilt, expected, rtol=4e-2)


def test_stiff_columns_are_rigid_ground(run, motion):
    rigid = run(lumped_mass(device(), MASS), motion, dt=DT)
    gaps = []
    for factor in (1e2, 1e4):
        frame = pier(device(), factor, 0.04 * factor, head_mass=0.0)
        data = run(frame, motion, dt=DT)
        gap = data["bearing_displacement"] - rigid["bearing_displacement"]
        size = float(np.abs(rigid["bearing_displacement"]).max())
        gaps.append(float(np.abs(gap).max()) / size)
    assert gaps[0] < 0.05
    assert gaps[1] < 2e-3
    assert gaps[1] < 0.1 * gaps[0]  # in proportion to the flexibility
