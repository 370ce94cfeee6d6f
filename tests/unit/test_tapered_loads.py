"""Loads of linear size along members: closed forms, many point loads, OpenSees."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError
from frames.assembly.assemble import assemble, member_axial_forces, member_end_forces
from tests.scenes import SECTION, solve_linear

LONG = 4.0
SHEAR = replace(SECTION, inertia_y=8e-4, inertia_z=3e-4, shear_area_y=3e-3, shear_area_z=2e-3)


def beam(section=SECTION, end=(LONG, 0.0, 0.0), releases=None, pieces=1):
    """Return a beam from the origin between clamps, in equal pieces."""
    frame = Frame("beam")
    for k in range(pieces + 1):
        frame.add_node(f"n{k}", *(k / pieces * x for x in end))
    for k in range(pieces):
        frame.add_member(f"m{k}", f"n{k}", f"n{k + 1}", section, releases=releases)
    frame.fix("n0", "all")
    frame.fix(f"n{pieces}", "uy", "uz", "rx", "ry", "rz")
    frame.add_mass(f"n{pieces}", 1e-9)
    if pieces > 1:
        frame.add_mass("n1", 1e-9)
    return frame


def fixed_end(frame):
    return assemble(frame).members.fixed_end[0]


@pytest.mark.parametrize("section", [SECTION, SHEAR])
def test_the_whole_length_is_a_uniform_load(section):
    end, q = (3.0, 1.0, 2.0), (3e3, -2e3, -7e3)
    tapered, uniform = beam(section, end), beam(section, end)
    tapered.add_tapered_load("m0", q, q)
    uniform.add_uniform_load("m0", q)
    assert_allclose(fixed_end(tapered), fixed_end(uniform), rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize(("section", "releases"), [(SECTION, None), (SHEAR, {"j": ("My", "Mz")})])
def test_against_many_point_loads(section, releases):
    """A linear load over a part, as point loads on 200 pieces without any load formula."""
    pieces, a, b = 200, 0.3, 3.1
    near, far = np.array([2e3, 1e3, -4e3]), np.array([-1e3, 5e3, -9e3])
    one = beam(section, releases=releases)
    one.fix("n1", "ux")
    one.add_tapered_load("m0", near, far, a, b)
    one.remove("mass", "n1")
    fine = beam(section, pieces=pieces)
    fine.fix(f"n{pieces}", "ux")
    if releases:
        last = fine.members[f"m{pieces - 1}"]
        fine.remove("member", last.name)
        fine.add_member(last.name, last.i, last.j, section, releases=releases)
    step = LONG / pieces
    for k in range(4 * pieces):  # four point loads a piece, each by the lever to its nodes
        x = (k + 0.5) * step / 4.0
        if a < x < b:
            force = (near + (far - near) * (x - a) / (b - a)) * step / 4.0
            left, share = int(x / step), x / step % 1.0
            fine.add_load(f"n{left}", [*((1.0 - share) * force), 0.0, 0.0, 0.0])
            fine.add_load(f"n{left + 1}", [*(share * force), 0.0, 0.0, 0.0])
    system = assemble(fine)
    q = np.linalg.solve(system.stiffness.toarray(), system.load)
    ends = member_end_forces(system, system.transform @ q)
    found = table_forces(one)
    scale = np.abs(found).max()
    assert_allclose(found[:6] / scale, ends[0, :6] / scale, rtol=0.0, atol=2e-4)
    assert_allclose(found[6:] / scale, ends[-1, 6:] / scale, rtol=0.0, atol=2e-4)


def table_forces(frame):
    """Return the fixed-end forces of a beam that is fixed all over, which no system can be."""
    frame.add_node("other", 0.0, 5.0, 0.0)
    frame.add_spring("other", "n0", "other", (1.0,) * 6)
    frame.add_mass("other", 1.0)
    return fixed_end(frame)


def test_end_forces_are_in_equilibrium_with_the_load():
    frame = beam(SHEAR, (3.0, 1.0, 2.0))
    near, far, a, b = np.array([1e3, 0.0, -4e3]), np.array([0.0, 2e3, -1e3]), 0.5, 3.0
    frame.add_tapered_load("m0", near, far, a, b)
    system = assemble(frame)
    q = np.linalg.solve(system.stiffness.toarray(), system.load)
    ends = member_end_forces(system, system.transform @ q)[0].reshape(4, 3)
    total = 0.5 * (near + far) * (b - a)
    axes = system.members.arrays.axes[0]
    assert_allclose((ends[0] + ends[2]) @ axes, -total, rtol=1e-12, atol=1e-9)
    middle = np.array([1.0, 0.0, 0.0])  # along local x
    moment = np.zeros(3)
    for x, w in zip(*np.polynomial.legendre.leggauss(4), strict=True):
        at = 0.5 * (a + b) + 0.5 * (b - a) * x
        force = axes @ (near + (far - near) * (at - a) / (b - a))
        moment += 0.5 * (b - a) * w * np.cross(at * middle, force)
    long = system.members.arrays.length[0]
    about = ends[1] + ends[3] + np.cross(long * middle, ends[2])
    assert_allclose(about, -moment, rtol=1e-12, atol=1e-9)
    assert_allclose(
        member_axial_forces(system, q)[0],
        mean_axial_force(axes, near, far, a, b, ends, long),
        rtol=1e-4,
    )


def mean_axial_force(axes, near, far, a, b, ends, long):
    """Integrate N(x) = -N_i - load up to x, tension positive."""
    x = np.linspace(0.0, long, 200_001)
    size = np.where(
        (x >= a) & (x <= b),
        (axes @ near)[0] + ((axes @ far)[0] - (axes @ near)[0]) * (x - a) / (b - a),
        0.0,
    )
    up_to = np.concatenate([[0.0], np.cumsum(0.5 * (size[1:] + size[:-1]) * np.diff(x))])
    normal = -ends[0, 0] - up_to
    return float(np.trapezoid(normal, x) / long)


def test_a_part_as_opensees_has_it():
    """A propped beam in the plane, -beamUniform over a part with unlike ends."""
    pytest.importorskip("openseespy")
    from validation.opensees.model import empty_model  # needs openseespy

    with empty_model() as ops:
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        ops.node(1, 0.0, 0.0)
        ops.node(2, LONG, 0.0)
        ops.fix(1, 1, 1, 1)
        ops.fix(2, 1, 1, 0)
        ops.geomTransf("Linear", 1)
        ops.element("elasticBeamColumn", 1, 1, 2, 0.01, 200e9, 8e-5, 1)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        parts = (-1e3, 0.0, 0.25, 0.75, -3e3, 0.0)
        ops.eleLoad("-ele", 1, "-type", "-beamUniform", *parts)
        solve_linear(ops)
        theirs = ops.eleResponse(1, "localForce")
    frame = beam(releases={"j": ("My", "Mz")})
    frame.add_tapered_load("m0", (0.0, 0.0, -1e3), (0.0, 0.0, -3e3), 1.0, 3.0)
    ours = fixed_end(frame)
    # moments about y here, about z there: up is z here, y there
    assert_allclose(ours[[2, 4, 8]], [theirs[1], -theirs[2], theirs[4]], rtol=1e-9)


@pytest.mark.parametrize(
    ("a", "b", "words"),
    [
        (-0.5, None, "a = -0.5 m"),
        (3.0, 2.0, "begin before it ends"),
        (0.0, 4000.0, "within the member's 4 m"),
        (float("nan"), None, "must be finite"),
    ],
)
def test_a_part_that_is_not_on_the_member(a, b, words):
    frame = beam()
    with pytest.raises(ModelError, match=words):
        frame.add_tapered_load("m0", (0.0, 0.0, -1.0), (0.0, 0.0, -1.0), a, b)
    assert not frame.tapered_loads
    with pytest.raises(ModelError, match='there is no member "m"'):
        frame.add_tapered_load("m", (0.0, 0.0, -1.0), (0.0, 0.0, -1.0))
