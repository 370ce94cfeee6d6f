"""Rigid end zones of members: against nodes of their own with stiff members, and OpenSees."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from frames import Frame, ModelError, Section
from frames.assembly.assemble import (
    assemble,
    geometric_stiffness,
    member_axial_forces,
    member_end_forces,
    node_geometric_stiffness,
)
from frames.assembly.members import arms_geometric_stiffness
from frames.plots.model_geometry import member_lines
from tests.refusals import refused
from tests.scenes import SECTION as PLAIN
from tests.scenes import solve_linear

SHEAR = replace(PLAIN, shear_area_y=5e-3, shear_area_z=4e-3)
STIFF = replace(PLAIN, area=1e2, inertia_y=1e2, inertia_z=1e2, torsion_constant=1e2)
AT_I, AT_J = (0.3, 0.1, -0.2), (-0.25, 0.15, -0.4)
RELEASES = [None, {"j": ("My", "Mz")}, {"i": ("My",), "j": ("T", "Mz")}]


def build(section, releases=None, load=None, *, zones):
    """Return an oblique member on a clamp; its end zones are offsets, or nodes of their own."""
    frame = Frame("member")
    ends = {"a": np.array([0.0, 0.0, 0.0]), "b": np.array([3.0, 1.0, 2.0])}
    for name, place in ends.items():
        frame.add_node(name, *place)
    frame.fix("a", "all")
    frame.add_node("ground", 3.0, 1.0, 0.0)
    frame.fix("ground", "all")
    frame.add_spring("soft", "ground", "b", (1e7, 1e7, 1e7, 1e6, 1e6, 1e6))
    frame.add_mass("b", 100.0, (10.0, 10.0, 10.0))
    up = (0.1, 0.2, 1.0)
    if zones:
        offsets = {"i": AT_I, "j": AT_J}
        frame.add_member("m", "a", "b", section, up, releases=releases, offsets=offsets)
    else:
        frame.add_node("ea", *(ends["a"] + AT_I))
        frame.add_node("eb", *(ends["b"] + AT_J))
        frame.add_member("m", "ea", "eb", section, up, releases=releases)
        frame.add_member("za", "a", "ea", STIFF)
        frame.add_member("zb", "eb", "b", STIFF)
    if load is not None:
        frame.add_tapered_load("m", *load, 0.4, 2.2)
        frame.add_uniform_load("m", (1e3, 2e3, -3e3))
    return frame


def condensed(matrix, system):
    """Return a stiffness over the free displacements of node b alone."""
    mine = np.array([label.startswith("b ") for label in system.dof_labels])
    k = matrix.toarray()
    return k[np.ix_(mine, mine)] - k[np.ix_(mine, ~mine)] @ np.linalg.solve(
        k[np.ix_(~mine, ~mine)], k[np.ix_(~mine, mine)]
    )


@pytest.mark.parametrize("section", [PLAIN, SHEAR])
@pytest.mark.parametrize("releases", RELEASES)
def test_stiffness_is_that_of_stiff_members(section, releases):
    ours, theirs = (assemble(build(section, releases, zones=zones)) for zones in (True, False))
    k, ref = ours.stiffness.toarray(), condensed(theirs.stiffness, theirs)
    assert k.shape == (6, 6)
    assert_allclose(k, ref, rtol=0.0, atol=3e-5 * np.abs(ref).max())


def test_geometric_stiffness_is_that_of_stiff_members():
    """The arms lean with their nodes: they are part of what the axial force destabilises."""
    frame, other = (Frame("column") for _ in range(2))
    for each in (frame, other):
        each.add_node("a", 0.0, 0.0, 0.0)
        each.add_node("b", 0.0, 0.0, 4.0)
        each.fix("a", "all")
        each.add_mass("b", 100.0, (10.0, 10.0, 10.0))
    other.add_node("ea", 0.0, 0.0, 0.5)
    other.add_node("eb", 0.0, 0.0, 3.2)
    other.add_member("m", "ea", "eb", SHEAR)
    other.add_member("za", "a", "ea", STIFF)
    other.add_member("zb", "eb", "b", STIFF)
    frame.add_member("m", "a", "b", SHEAR, offsets={"i": (0, 0, 0.5), "j": (0, 0, -0.8)})
    force = -2e6
    ours, theirs = assemble(frame), assemble(other)
    ours_g, theirs_g = (
        geometric_stiffness(each, node_geometric_stiffness(each, np.full(count, force)))
        for each, count in ((ours, 1), (theirs, 3))
    )
    k = (ours.stiffness + ours_g).toarray()
    ref = condensed(theirs.stiffness + theirs_g, theirs)
    sway = [0, 1, 3, 4]
    change = k - ours.stiffness.toarray()
    assert np.abs(change[np.ix_(sway, sway)]).max() > 1e6
    assert_allclose(
        k[np.ix_(sway, sway)], ref[np.ix_(sway, sway)], rtol=0.0, atol=2e-5 * np.abs(ref).max()
    )
    assert_allclose(change[4, 4], geometric_block(2.7, 0.8, force, SHEAR), rtol=1e-7)


def geometric_block(length, arm, force, section):
    """Return the stiffness against a unit turn of node b: by integration of w'^2, and the arm."""
    phi = 12.0 * section.elastic_modulus * section.inertia_y
    phi /= section.shear_modulus * section.shear_area_z * length**2
    x = np.linspace(0.0, 1.0, 2001)
    turn = (x**3 - x**2 - 0.5 * phi * (x - x**2)) * length / (1.0 + phi)
    move = (3.0 * x**2 - 2.0 * x**3 + phi * x) / (1.0 + phi)
    slope = np.gradient(-arm * move + turn, x * length, edge_order=2)
    return force * (np.trapezoid(slope**2, x * length) + arm)


def test_arms_lean_as_finite_rotations_do():
    """Second differences of what the axial force does on the ends of arms that turn."""
    arms, force, h = np.array([[[0.3, 0.2, -0.1], [-0.4, 0.1, 0.25]]]), 7e5, 1e-3
    found = arms_geometric_stiffness(arms, np.array([force]))[0]

    def work(end, turn):
        return (-1.0, 1.0)[end] * force * (Rotation.from_rotvec(turn).as_matrix() @ arms[0, end])[0]

    for end in (0, 1):
        steps = h * np.eye(3)
        hessian = [
            [
                (work(end, a + b) - work(end, a - b) - work(end, b - a) + work(end, -a - b))
                / (4.0 * h * h)
                for b in steps
            ]
            for a in steps
        ]
        places = slice(6 * end + 3, 6 * end + 6)
        assert_allclose(found[places, places], hessian, rtol=0.0, atol=1e-5 * force)


@pytest.mark.parametrize("section", [PLAIN, SHEAR])
@pytest.mark.parametrize("releases", RELEASES)
def test_loads_and_end_forces_are_those_of_stiff_members(section, releases):
    load = ((1e3, -2e3, -4e3), (0.0, 5e3, -9e3))
    found = []
    for zones in (True, False):
        system = assemble(build(section, releases, load, zones=zones))
        q = np.linalg.solve(system.stiffness.toarray(), system.load)
        u = np.asarray(system.transform @ q)
        place = system.node_names.index("b")
        axial = member_axial_forces(system, q)[0]
        found.append((u[6 * place : 6 * place + 6], member_end_forces(system, u)[0], axial))
    (u, forces, axial), (u_ref, ref, axial_ref) = found
    assert axial == pytest.approx(axial_ref, rel=1e-3)
    assert_allclose(u, u_ref, rtol=0.0, atol=1e-4 * np.abs(u_ref).max())
    assert_allclose(forces, ref, rtol=0.0, atol=1e-4 * np.abs(ref).max())


def test_as_opensees_joint_offsets():
    """The stiffness of geomTransf -jntOffset, from unit forces (Timoshenko's has none)."""
    pytest.importorskip("openseespy")
    from validation.opensees.frames import build as write  # needs openseespy
    from validation.opensees.model import empty_model

    frame = build(PLAIN, zones=True)
    frame.remove("spring", "soft")
    ours = assemble(frame).stiffness.toarray()
    flexibility = np.zeros((6, 6))
    for dof in range(6):
        with empty_model() as ops:
            built = write(ops, frame, transformation="Linear")
            ops.timeSeries("Linear", 1)
            ops.pattern("Plain", 1, 1)
            ops.load(built.nodes["b"], *(1.0 if k == dof else 0.0 for k in range(6)))
            solve_linear(ops, system="FullGeneral")
            flexibility[:, dof] = ops.nodeDisp(built.nodes["b"])
    assert_allclose(np.linalg.inv(flexibility), ours, rtol=0.0, atol=1e-9 * np.abs(ours).max())


def test_mass_is_of_the_length_between_the_ends():
    heavy = Section.box(0.3, 0.3, 0.02)
    frame = build(heavy, zones=True)
    length = np.linalg.norm(np.array([3.0, 1.0, 2.0]) + AT_J - np.array(AT_I))
    half = 0.5 * heavy.density * heavy.area * length
    assert_allclose(assemble(frame).node_mass[:2, 0], [half, 100.0 + half], rtol=1e-12)


def test_rigid_turns_of_the_nodes_bend_nothing():
    system = assemble(build(SHEAR, zones=True))
    turn = np.array([0.1, -0.2, 0.3])
    u = np.zeros((3, 6))
    u[:, :3], u[:, 3:] = np.cross(turn, system.coordinates), turn
    forces = member_end_forces(system, u.ravel())[0]
    assert np.abs(forces).max() < 1e-6 * np.abs(system.stiffness).max()
    lines = member_lines(system.members, system.coordinates, np.zeros((3, 6)))[0]
    assert_allclose(lines[[0, -1]], [AT_I, np.array([3.0, 1.0, 2.0]) + AT_J], atol=1e-12)


@pytest.mark.parametrize(
    ("offsets", "words"),
    [
        ({"k": (0, 0, 1)}, "'k' is not an end"),
        ({"i": (1.0, 0.0)}, "shape"),
        ({"i": (2.5, 0, 0), "j": (-2.5, 0, 0)}, "offsets that overlap"),
        ({"i": (2, 0, 0), "j": (-2, 0, 0)}, "less its offsets is 0 m long"),
        ({"i": (250.0, 0, 0)}, r"250 m long, at most 20 m.*mm"),
    ],
)
def test_offsets_that_cannot_be(offsets, words):
    frame = Frame("beam")
    frame.add_node("a", 0.0, 0.0, 0.0)
    frame.add_node("b", 4.0, 0.0, 0.0)
    refused(ModelError, words, frame.add_member, "m", "a", "b", PLAIN, offsets=offsets)
    with pytest.raises(TypeError, match="vectors by end"):
        frame.add_member("m", "a", "b", PLAIN, offsets=(0.0, 0.0, 0.2))
    assert not frame.members
