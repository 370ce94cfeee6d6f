"""The assembled system against closed forms, explicit constraints and global balances."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt
import pytest
import scipy.linalg
from numpy.testing import assert_allclose
from scipy.sparse.linalg import spsolve

from frames._errors import ModelWarning
from frames.assembly.assemble import (
    System,
    assemble,
    geometric_stiffness,
    member_axial_forces,
    member_end_forces,
    node_geometric_stiffness,
)
from frames.assembly.solvers import solve_positive
from frames.demo import bearing_for
from frames.io import Frame
from frames.library.models import moment_frame
from frames.model.sections import Section
from frames.statics.gravity import gravity

if TYPE_CHECKING:
    from lir_element import LIRBearing


def mast_on_portal(modulus: float) -> Frame:
    """Return a portal whose top beam is rigid by its modulus, with a soft mast without inertia."""
    device = bearing_for(400e3)
    frame, section = Frame("mast"), Section.rectangle(0.4, 0.4, elastic_modulus=30e9)
    for k, x in enumerate((0.0, 6.0)):
        for name, z in (("g", 0.0), ("a", device.height), ("t", 3.0)):
            frame.add_node(f"{name}{k}", x, 0.0, z)
        frame.fix(f"g{k}", "all")
        frame.fix(f"a{k}", "rx")
        frame.add_bearing(f"b{k}", f"g{k}", f"a{k}", device)
        frame.add_member(f"c{k}", f"a{k}", f"t{k}", section)
        frame.add_mass(f"t{k}", 20e3)
        frame.add_mass(f"a{k}", 20e3)
    frame.add_member("base", "a0", "a1", section)
    frame.add_member("top", "t0", "t1", replace(section, elastic_modulus=modulus))
    frame.add_node("m", 0.0, 0.0, 5.0)
    frame.add_member("mast", "t0", "m", replace(section, torsion_constant=1e-6))
    frame.add_mass("m", 100.0)
    return frame


def test_round_off_of_stiff_and_soft_parts_is_scaled_away(recwarn: pytest.WarningsRecorder) -> None:
    rigid, stiff = (gravity(mast_on_portal(modulus)).axial_forces for modulus in (1e21, 1e15))
    assert_allclose(rigid, stiff, rtol=1e-7)
    assert not recwarn.list  # none of the libraries'


def test_round_off_that_cannot_be_scaled_away_is_a_doubt_by_name() -> None:
    labels = [f"n{k} ux" for k in range(12)]
    with pytest.warns(ModelWarning, match=r'the stiffness near "n\d+ ux" is lost to round-off'):
        solve_positive(scipy.linalg.hilbert(12), np.eye(12), "stiffness", labels)


Array = npt.NDArray[np.float64]

BEARING = cast("LIRBearing", SimpleNamespace(axial_stiffness=2e9, height=0.12))
BOX = Section.box(0.3, 0.3, 0.01)
SLENDER = replace(BOX, shear_area_y=math.inf, shear_area_z=math.inf)
# Axially rigid and without shear, as slope-deflection assumes; E A h^2 / (E I) about 1e8.
RIGID_AXIS = replace(SLENDER, area=1e3, density=0.0)
SOLVE = 1e-8  # round-off of a solution whose matrix has a condition number of about 1e7


def solve(system: System) -> tuple[Array, Array]:
    """Return free and nodal displacements under the permanent loads, no bearings."""
    q = np.atleast_1d(spsolve(system.stiffness.tocsc(), system.load))
    return q, nodal(system, q)


def nodal(system: System, q: Array) -> Array:
    """Return the displacements of all nodes."""
    return np.asarray(system.transform @ q)


def portal(column: Section, beam: Section, height: float, span: float) -> Frame:
    """Return a plane portal frame in the x-z plane with clamped feet."""
    frame = Frame("portal", gravity=0.0)
    for name, x, z in (("A", 0, 0), ("B", 0, height), ("C", span, height), ("D", span, 0)):
        frame.add_node(name, x, 0.0, z)
    frame.fix("A", "all")
    frame.fix("D", "all")
    for corner in "BC":
        frame.fix(corner, "uy", "rx", "rz")
        frame.add_mass(corner, 1000.0)
    frame.add_member("left", "A", "B", column)
    frame.add_member("beam", "B", "C", beam)
    frame.add_member("right", "D", "C", column)
    return frame


@pytest.mark.parametrize("ratio", [0.3, 2.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_portal_sways_as_slope_deflection(ratio: float, sign: float) -> None:
    height, span, force = 3.5, 6.0, sign * 50e3
    beam = replace(RIGID_AXIS, inertia_y=ratio * RIGID_AXIS.inertia_y)
    frame = portal(RIGID_AXIS, beam, height, span)
    for corner in "BC":
        frame.add_load(corner, (force / 2.0, 0, 0, 0, 0, 0))
    system = assemble(frame)
    _, u = solve(system)
    # Slope-deflection: k = (I_b / L) / (I_c / h); the columns' inertia bends them in x-z.
    k = ratio * height / span
    flexural = RIGID_AXIS.elastic_modulus * RIGID_AXIS.inertia_y
    sway = force * height**3 / (24.0 * flexural) * (6.0 * k + 4.0) / (6.0 * k + 1.0)
    foot = force * height / 2.0 * (3.0 * k + 1.0) / (6.0 * k + 1.0)
    head = force * height / 2.0 * 3.0 * k / (6.0 * k + 1.0)
    axial = 1e-5  # the columns are not quite rigid along their axes
    assert_allclose(u.reshape(-1, 6)[1:3, 0], sway, rtol=axial, atol=0.0)
    ends = member_end_forces(system, u)
    assert_allclose(np.abs(ends[0, [4, 10]]), np.abs([foot, head]), rtol=axial, atol=0.0)
    # Local z of the columns is global x: the feet take the whole load.
    assert_allclose(ends[[0, 2], 2].sum(), -force, rtol=axial, atol=0.0)


def space_frame(diaphragm: bool = True) -> Frame:
    """Return a one-storey frame of unequal columns on a rectangle, with twist."""
    frame = Frame("space", gravity=9.81)
    points = {"a": (0.0, 0.0), "b": (6.0, 0.0), "c": (6.0, 4.0), "d": (0.0, 4.0)}
    for k, (name, (x, y)) in enumerate(points.items(), start=1):
        frame.add_node(f"foot-{name}", x, y, 0.0)
        frame.add_node(name, x, y, 3.0)
        frame.fix(f"foot-{name}", "all")
        column = Section.box(0.2 + 0.05 * k, 0.3, 0.01)
        frame.add_member(f"column-{name}", f"foot-{name}", name, column)
        frame.add_mass(name, 1000.0 * k, (10.0, 20.0, 30.0))
        frame.add_load(name, (1e3 * k, -2e3, 500.0, 100.0, 50.0 * k, 700.0))
    for i, j in ("ab", "bc", "cd", "da"):
        frame.add_member(f"beam-{i}{j}", i, j, BOX)
        frame.add_uniform_load(f"beam-{i}{j}", (100.0, 200.0, -5e3))
    if diaphragm:
        frame.add_diaphragm("deck", list(points))
    return frame


def with_constraints(frame: Frame, equations: Array) -> Array:
    """Solve the static problem with Lagrange multipliers instead of elimination."""
    system = assemble(frame)
    t, k = system.transform.toarray(), system.stiffness.toarray()
    rows = equations @ t
    zero = np.zeros((rows.shape[0], rows.shape[0]))
    saddle = np.block([[k, rows.T], [rows, zero]])
    # Scaled so that stiffness and constraints compare.
    scale = np.concatenate([1.0 / np.sqrt(np.diag(k)), np.full(rows.shape[0], 1e4)])
    right = np.concatenate([system.load, np.zeros(rows.shape[0])])
    solution = scale * np.linalg.solve(scale[:, None] * saddle * scale, scale * right)
    return np.asarray(t @ solution[: k.shape[0]])


def diaphragm_equations(system: System, nodes: Sequence[str]) -> Array:
    """Return in-plane rigidity of `nodes` as equations on all nodal displacements."""
    places = [system.node_names.index(node) for node in nodes]
    first = places[0]
    rows = []
    for other in places[1:]:
        dx, dy = (system.coordinates[other] - system.coordinates[first])[:2]
        row = np.zeros((3, 6 * len(system.node_names)))
        row[0, 6 * other], row[0, 6 * first], row[0, 6 * first + 5] = 1.0, -1.0, dy
        row[1, 6 * other + 1], row[1, 6 * first + 1], row[1, 6 * first + 5] = 1.0, -1.0, -dx
        row[2, 6 * other + 5], row[2, 6 * first + 5] = 1.0, -1.0
        rows.append(row)
    return np.concatenate(rows)


@pytest.mark.parametrize("support", [(), ("ux",), ("uy",), ("ux", "uy"), ("rz",)])
def test_diaphragm_equals_explicit_constraints(support: tuple[str, ...]) -> None:
    tied, loose = space_frame(), space_frame(diaphragm=False)
    if support:
        tied.fix("b", *support)
        loose.fix("b", *support)
    system = assemble(tied)
    _, u = solve(system)
    reference = with_constraints(loose, diaphragm_equations(system, "abcd"))
    assert_allclose(u, reference, rtol=0.0, atol=SOLVE * np.abs(reference).max())
    masters = [label for label in system.dof_labels if "(diaphragm)" in label]
    assert len(masters) == 3 - len(support)
    assert all(label.startswith("deck (diaphragm) ") for label in masters)


def test_diaphragm_held_at_two_nodes_does_not_turn() -> None:
    frame = space_frame()
    frame.fix("a", "ux")
    frame.fix("c", "ux")
    system = assemble(frame)
    assert [label for label in system.dof_labels if "deck" in label] == ["deck (diaphragm) uy"]
    u = solve(system)[1].reshape(-1, 6)
    deck = u[[system.node_names.index(node) for node in "abcd"]]
    assert not deck[:, [0, 5]].any()
    assert np.ptp(deck[:, 1]) < 1e-15 < np.abs(deck[:, 1]).min()


def test_master_sits_at_the_mass_centroid() -> None:
    system = assemble(space_frame())
    mass = system.mass.toarray()
    masters = [k for k, label in enumerate(system.dof_labels) if "deck" in label]
    block = mass[np.ix_(masters, masters)]
    # No coupling of translation and rotation: round-off of the sums only.
    assert_allclose(block[:2, 2], 0.0, rtol=0.0, atol=1e-9 * block[2, 2])
    total = system.node_mass[[system.node_names.index(node) for node in "abcd"], 0].sum()
    assert_allclose(block[:2, :2], total * np.eye(2), rtol=1e-13, atol=1e-9)


def test_kinetic_energy_and_strain_energy_are_those_of_the_nodes() -> None:
    system = assemble(space_frame())
    q = np.random.default_rng(1).normal(size=len(system.dof_labels))
    u = nodal(system, q)
    kinetic = q @ np.asarray(system.mass @ q)
    assert_allclose(kinetic, u**2 @ system.node_mass.ravel(), rtol=1e-12, atol=0.0)
    strain = u @ np.asarray(system.node_stiffness @ u)
    assert_allclose(q @ np.asarray(system.stiffness @ q), strain, rtol=1e-12, atol=0.0)


def test_total_mass_weight_and_reactions() -> None:
    frame = space_frame()
    system = assemble(frame)
    lumped = 1000.0 * (1 + 2 + 3 + 4)
    members = sum(
        m.section.density * m.section.area * length
        for m, length in zip(frame.members.values(), system.members.arrays.length, strict=True)
    )
    assert_allclose(system.node_mass[:, 0].sum(), lumped + members, rtol=1e-14, atol=0.0)
    _, u = solve(system)
    reactions = (system.node_stiffness @ u - system.node_load).reshape(-1, 6)
    nodal_loads, lines = np.array([1e3 * 10, -2e3 * 4, 500.0 * 4]), np.array([100.0, 200.0, -5e3])
    weight = np.array([0.0, 0.0, -9.81 * (lumped + members)])
    applied = nodal_loads + 20.0 * lines + weight  # beams of 20 m
    feet = [k for k, name in enumerate(system.node_names) if name.startswith("foot")]
    tolerance = SOLVE * np.abs(applied).max()
    assert_allclose(reactions[feet, :3].sum(axis=0), -applied, rtol=0.0, atol=tolerance)


def test_inertia_load_is_the_mass_times_a_rigid_translation() -> None:
    system = assemble(space_frame())
    free = [k for k, name in enumerate(system.node_names) if len(name) == 1]
    for axis, word in enumerate(("ux", "uy", "uz")):
        # Every free DOF label ends in its direction; a rigid translation moves these alone.
        unit = np.array([float(label.endswith(word)) for label in system.dof_labels])
        load = system.inertia_load[:, axis]
        assert_allclose(load, system.mass @ unit, rtol=1e-12, atol=1e-9)
        assert_allclose(unit @ load, system.node_mass[free, axis].sum(), rtol=1e-13, atol=0.0)


def test_unsupported_stiffness_leaves_rigid_motions_free_of_force() -> None:
    frame = space_frame(diaphragm=False)
    frame.add_node("far", 1.0, -2.0, 5.0)
    frame.add_spring("oblique", "a", "far", (1e6, 2e6, 3e6, 1e5, 2e5, 3e5))
    system = assemble(frame)
    points = system.coordinates
    scale = np.abs(system.node_stiffness.toarray()).max()
    for axis in range(3):
        unit = np.eye(3)[axis]
        shift = np.concatenate([np.tile(unit, (len(points), 1)), np.zeros_like(points)], axis=1)
        turn = np.concatenate([np.cross(unit, points), np.tile(unit, (len(points), 1))], axis=1)
        for motion in (shift, turn):
            forces = system.node_stiffness @ motion.ravel()
            assert_allclose(forces, 0.0, rtol=0.0, atol=1e-12 * scale)


def mast(count: int, up: tuple[float, float, float] | None = None) -> Frame:
    """Return a slender cantilever mast along an oblique line, in `count` members."""
    frame = Frame("mast", gravity=0.0)
    for k in range(count + 1):
        frame.add_node(f"n{k}", 1.0 * k / count, 2.0 * k / count, 6.0 * k / count)
    frame.fix("n0", "all")
    for k in range(count):
        frame.add_member(f"m{k}", f"n{k}", f"n{k + 1}", SLENDER, up)
    return frame


def test_cantilever_mast_buckles_at_the_euler_load() -> None:
    count = 8
    system = assemble(mast(count))
    length = math.sqrt(41.0)
    euler = math.pi**2 * SLENDER.elastic_modulus * SLENDER.inertia_y / (4.0 * length**2)
    of_nodes = node_geometric_stiffness(system, np.full(count, -1.0))
    geometric = geometric_stiffness(system, of_nodes).toarray()
    factors = scipy.linalg.eigh(-geometric, system.stiffness.toarray(), eigvals_only=True)
    # Half a wave over 8 members, error (pi/16)^4 / 720 = 2e-6; both planes of a square box.
    assert_allclose(1.0 / factors[-2:], euler, rtol=5e-6, atol=0.0)


def test_end_forces_balance_the_loads_with_and_without_second_order() -> None:
    frame = mast(5, up=(1.0, 0.3, 0.0))
    frame.add_load("n5", (2e3, -1e3, -5e4, 10.0, 20.0, 30.0))
    frame.add_uniform_load("m2", (300.0, 100.0, -200.0))
    system = assemble(frame)
    axial = np.full(5, -5e4)
    for forces in (None, axial):
        stiffness = system.stiffness
        if forces is not None:
            of_nodes = node_geometric_stiffness(system, forces)
            stiffness = stiffness + geometric_stiffness(system, of_nodes)
        u = nodal(system, np.asarray(spsolve(stiffness.tocsc(), system.load)))
        local = member_end_forces(system, u, forces)
        ends = local.reshape(5, 4, 3) @ system.members.arrays.axes
        at_nodes = np.zeros((6, 6))
        for k in range(5):
            at_nodes[k] += ends[k, :2].ravel()
            at_nodes[k + 1] += ends[k, 2:].ravel()
        # At the free nodes the members carry the external loads; fixed-end parts included.
        external = np.zeros((6, 6))
        external[5] = (2e3, -1e3, -5e4, 10.0, 20.0, 30.0)
        assert_allclose(at_nodes[1:], external[1:], rtol=0.0, atol=SOLVE * 5e4 * 6.0)


def test_axial_and_end_forces_take_histories() -> None:
    system = assemble(space_frame())
    history = np.random.default_rng(2).normal(size=(4, len(system.dof_labels)))
    axial = member_axial_forces(system, history)
    ends = member_end_forces(system, nodal(system, history.T).T)
    for k in range(4):
        assert_allclose(axial[k], member_axial_forces(system, history[k]), rtol=1e-12, atol=1e-3)
        one = member_end_forces(system, nodal(system, history[k]))
        assert_allclose(ends[k], one, rtol=1e-12, atol=1e-3)  # forces of order 1e8 N


def test_axial_force_of_a_hanging_bar_is_its_mean() -> None:
    frame = Frame("bar", gravity=0.0)
    frame.add_node("top", 0.0, 0.0, 0.0)
    frame.add_node("end", 0.0, 0.0, -4.0)
    frame.fix("top", "all")
    frame.add_member("bar", "top", "end", BOX)
    frame.add_uniform_load("bar", (0.0, 0.0, -1e3))
    system = assemble(frame)
    q, u = solve(system)
    assert_allclose(member_axial_forces(system, q), [2e3], rtol=SOLVE, atol=0.0)
    ends = member_end_forces(system, u)[0]
    assert_allclose(ends[[0, 6]], [-4e3, 0.0], rtol=SOLVE, atol=1e-5)


def test_system_lists_bearings_by_node_index() -> None:
    frame = moment_frame((1, 1), 1, bearing=BEARING)
    system = assemble(frame)
    name, i, j, bearing = system.bearings[3]
    nodes = system.node_names[i], system.node_names[j]
    assert (name, nodes) == ("bearing-1-1", ("ground-1-1", "base-1-1"))
    assert bearing is BEARING
    assert len(system.bearings) == 4
    # The bearings are not in the stiffness: the base can slide freely.
    slide = np.array([float(label.endswith("ux")) for label in system.dof_labels])
    forces = system.stiffness @ slide
    assert_allclose(forces, 0.0, rtol=0.0, atol=1e-12 * system.stiffness.diagonal().max())
