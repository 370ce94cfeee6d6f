"""Hinges at the ends of members, against closed forms and against a node of their own."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, Section
from frames.assembly.assemble import assemble, member_end_forces
from frames.model.axes import to_global
from frames.plots.model_geometry import member_lines
from tests.scenes import SECTION, simple_bearing

LONG, E = 4.0, 200e9
HINGE = ("My", "Mz")


def table_of(releases, section=SECTION, load=(0.0, 0.0, 0.0)):
    """Return the assembled system of a beam along x between clamps; its member is the first."""
    frame = Frame("beam")
    for name, x in (("a", 0.0), ("b", LONG)):
        frame.add_node(name, x, 0.0, 0.0)
    frame.add_member("beam", "a", "b", section, releases=releases)
    frame.add_uniform_load("beam", load)
    frame.fix("a", "all")
    frame.fix("b", "ux", "uy", "rx", "ry", "rz")
    frame.add_mass("b", 1.0)
    return assemble(frame)


def test_a_strut_between_hinges_leans_as_a_string():
    """Its geometric stiffness is P / L, whatever its bending."""
    table = table_of({"i": HINGE, "j": HINGE}).members
    geometric = table.geometric(np.array([-5e5]))[0]
    expected = -5e5 / LONG * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for axis in (1, 2):
        assert_allclose(geometric[np.ix_([axis, axis + 6], [axis, axis + 6])], expected, rtol=1e-9)


def portal(hinged):
    """Return a portal with a hinged beam: by releases, or by nodes of its own at the hinges."""
    frame = Frame("portal")
    device = simple_bearing(capacity=0.2)
    shear = Section.box(0.3, 0.3, 0.012, density=0.0)
    for x, name in ((0.0, "left"), (6.0, "right")):
        frame.add_node(f"ground-{name}", x, 0.0, 0.0)
        frame.fix(f"ground-{name}", "all")
        frame.add_node(f"foot-{name}", x, 0.0, device.height)
        frame.fix(f"foot-{name}", "rx", "ry", "rz")
        frame.add_node(f"head-{name}", x, 0.0, 4.0)
        frame.add_bearing(name, f"ground-{name}", f"foot-{name}", device)
        frame.add_member(f"column-{name}", f"foot-{name}", f"head-{name}", shear)
        frame.add_mass(f"head-{name}", 2e4)
        frame.add_mass(f"foot-{name}", 1e4)
    ends = ("head-left", "head-right")
    if hinged == "releases":
        frame.add_member("beam", *ends, shear, releases={"i": HINGE, "j": HINGE})
    else:
        for name in ("left", "right"):
            head = frame.nodes[f"head-{name}"]
            frame.add_node(f"pin-{name}", head.x, head.y, head.z)
            stiff = (1e12, 1e12, 1e12, 1e12, 0.0, 0.0)
            frame.add_spring(f"pin-{name}", f"head-{name}", f"pin-{name}", stiff)
        frame.add_member("beam", "pin-left", "pin-right", shear)
    frame.add_uniform_load("beam", (0.0, 0.0, -2e4))
    return frame


def test_hinges_are_those_of_nodes_of_their_own():
    rng = np.random.default_rng(4)
    found = []
    push = rng.normal(size=6) * 1e4
    for kind in ("releases", "nodes"):
        system = assemble(portal(kind))
        load = system.load.copy()
        for k, value in enumerate(push):
            label = ("ux", "uy", "uz")[k % 3]
            node = f"head-{'left' if k < 3 else 'right'} {label}"
            load[system.dof_labels.index(node)] += value
        stiffness = system.stiffness.toarray()
        feet = [k for k, name in enumerate(system.dof_labels) if name.startswith("foot")]
        stiffness[feet, feet] += 1e9
        q = np.linalg.solve(stiffness, load)
        u = np.asarray(system.transform @ q)
        ends = member_end_forces(system, u)
        heads = [system.node_names.index(f"head-{name}") for name in ("left", "right")]
        beam = system.members.names.index("beam")
        found.append((u.reshape(-1, 6)[heads], ends[beam]))
    for ours, theirs in zip(*found, strict=True):  # springs of 1e12 in place of rigid pins
        assert_allclose(ours, theirs, rtol=0.0, atol=5e-6 * np.abs(theirs).max())
    assert_allclose(found[0][1][[4, 5, 10, 11]], 0.0, atol=1e-6)


def test_a_hinged_line_is_drawn_straight():
    system = table_of({"i": HINGE, "j": HINGE})
    u = np.zeros((2, 6))
    u[1, 2], u[0, 4], u[1, 4] = 0.1, 0.3, -0.2
    line = member_lines(system.members, system.coordinates, u)[0]
    assert_allclose(line[:, 2], np.linspace(0.0, 0.1, len(line)), atol=1e-12)


def test_end_forces_go_with_the_nodes():
    """Of a released member in space: in equilibrium, and free of the moments released."""
    frame = portal("releases")
    frame.add_member(
        "tie",
        "foot-left",
        "head-right",
        Section.circle(0.1),
        releases={"i": ("T", "My", "Mz"), "j": HINGE},
    )
    system = assemble(frame)
    u = np.random.default_rng(1).normal(size=6 * len(system.node_names)) * 1e-3
    place = system.members.names.index("tie")
    ends = member_end_forces(system, u)[place]
    assert_allclose(ends[[3, 4, 5, 9, 10, 11]], 0.0, atol=1e-6 * np.abs(ends).max())
    total = to_global(ends[None], system.members.arrays.axes[[place]])[0]
    assert_allclose(total[:3], -total[6:9], rtol=1e-9)
    axis = system.members.arrays.axes[place][0]
    assert math.isclose(
        abs(float(total[6:9] @ axis)), float(np.linalg.norm(total[6:9])), rel_tol=1e-9
    )


@pytest.mark.parametrize(
    ("releases", "words"),
    [
        ({"k": HINGE}, "'k' is not supported: use ends"),
        ({"i": ("M",)}, "'M' is not supported: use ends"),
        ({"i": ("T",), "j": ("T",)}, '"T" at both ends leaves the rotation'),
    ],
)
def test_refusals(releases, words):
    with pytest.raises(ModelError, match=words):
        table_of(releases)


def test_a_node_that_nothing_keeps_from_turning_is_named():
    frame = Frame("loose")
    for name, z in (("foot", 0.0), ("top", 3.0)):
        frame.add_node(name, 0.0, 0.0, z)
    frame.fix("foot", "all")
    frame.add_member("mast", "foot", "top", SECTION, releases={"j": HINGE})
    frame.add_mass("top", 1e3)
    with pytest.raises(ModelError, match=r"mechanism.*top r"):
        assemble(frame)
