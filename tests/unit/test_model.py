"""What the frame accepts, keeps and refuses at the door."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames._errors import ModelError
from frames.io import Frame
from frames.model.components import bearing_axial_stiffness
from frames.model.damping import ModalDamping, RayleighDamping
from frames.model.sections import Section
from tests.refusals import refused

COLUMN = Section.box(0.3, 0.3, 0.01)
BEARING = SimpleNamespace(axial_stiffness=2e9, height=0.12)


def small_frame() -> Frame:
    """Return a frame with a few nodes and a member."""
    frame = Frame("small")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("base", 0.0, 0.0, 0.12)
    frame.add_node("floor-1", 0.0, 0.0, 3.12)
    frame.add_node("floor-2", 0.0, 0.0, 6.12)
    frame.add_node("twin", 0.0, 0.0, 3.12)
    frame.add_node("beside", 4.0, 0.0, 3.12)
    frame.add_member("column", "base", "floor-1", COLUMN)
    frame.add_diaphragm("deck", ["twin", "beside"])
    return frame


def test_masses_supports_and_loads_accumulate() -> None:
    frame = small_frame()
    frame.add_mass("floor-1", 1000.0)
    frame.add_mass("floor-1", 500.0, (1.0, 2.0, 3.0))
    frame.add_load("floor-1", (1.0, 0, 0, 0, 0, 0))
    frame.add_load("floor-1", (2.0, 0, 0, 0, 0, 5.0))
    frame.add_uniform_load("column", (0.0, 0.0, -5.0))
    frame.add_uniform_load("column", (1.0, 0.0, -5.0))
    frame.fix("ground", "ux")
    frame.fix("ground", "uy", "rz")
    assert_allclose(frame.masses["floor-1"], [1500, 1500, 1500, 1, 2, 3], rtol=0.0, atol=0.0)
    assert_allclose(frame.loads["floor-1"], [3, 0, 0, 0, 0, 5], rtol=0.0, atol=0.0)
    assert_allclose(frame.uniform_loads["column"], [1, 0, -10], rtol=0.0, atol=0.0)
    assert frame.fixed_dofs["ground"] == {"ux", "uy", "rz"}


def test_contents_cannot_be_changed_from_outside() -> None:
    frame = small_frame()
    with pytest.raises(TypeError):
        frame.nodes["new"] = frame.nodes["base"]  # type: ignore[index]
    with pytest.raises(AttributeError):
        frame.damping = None  # type: ignore[misc]


def test_levels_keep_order_and_elevation() -> None:
    frame = small_frame()
    frame.add_level("first", ["floor-1", "beside"])
    frame.add_level("second", ["floor-2"])
    assert [(level.name, level.z) for level in frame.levels] == [("first", 3.12), ("second", 6.12)]


def test_bearing_ends_may_coincide_or_be_its_height_apart() -> None:
    frame = small_frame()
    frame.add_bearing("tall", "ground", "base", BEARING)
    frame.add_bearing("flat", "floor-1", "twin", BEARING)
    assert frame.bearings["tall"].j == "base"


def test_a_refused_call_leaves_the_frame_as_it_was() -> None:
    frame = small_frame()
    before = repr(frame)
    with pytest.raises(ModelError):
        frame.add_bearing("far", "ground", "floor-1", BEARING)
    with pytest.raises(ModelError):
        frame.add_member("bad", "base", "floor-2", COLUMN, up=(0.0, 0.0, 1.0))
    with pytest.raises(ModelError):
        frame.fix("base", "ux", "up")
    assert repr(frame) == before
    assert "base" not in frame.fixed_dofs


REFUSED = {
    ModelError: [
        (r'no node "flor-1".*did you mean "floor-1"', lambda f: f.add_mass("flor-1", 1.0)),
        (r"6 exist", lambda f: f.fix("xyz", "all")),
        (r'node "base" exists already', lambda f: f.add_node("base", 0, 0, 0)),
        (r"name of a node is empty", lambda f: f.add_node(" ", 0, 0, 0)),
        (r'of node "n" = \[0.0, nan, 0.0\] must be fin', lambda f: f.add_node("n", 0, math.nan, 0)),
        (r"'vx'.*\"all\" or one of", lambda f: f.fix("base", "vx")),
        (r"names no degree of freedom", lambda f: f.fix("base")),
        (r'mass \[kg\] at node "base" = -2 must be at least', lambda f: f.add_mass("base", -2.0)),
        (r"inertia .* must be at least 0", lambda f: f.add_mass("base", 1.0, (0.0, -1.0, 0.0))),
        (r'"m" from "floor-1" to "twin" is 0 m', lambda f: f.add_member("m", *TWINS, COLUMN)),
        (r'starts and ends at node "base"', lambda f: f.add_member("m", "base", "base", COLUMN)),
        (r'"m" has no local axes', lambda f: f.add_member("m", *FAR, COLUMN, up=(0, 0, 2))),
        (r"shape \(5,\), it must be \(6,\)", lambda f: f.add_spring("s", *FAR, (1.0,) * 5)),
        (r"not all 0", lambda f: f.add_spring("s", "base", "floor-1", (0.0,) * 6)),
        (r"has 1 nodes: name at least 2", lambda f: f.add_diaphragm("d", ["floor-1"])),
        (
            r'not horizontal: node "floor-1" is at z = 3.12 m, node "floor-2" at z = 6.12',
            lambda f: f.add_diaphragm("d", ["floor-1", "floor-2"]),
        ),
        (
            r'"beside" of diaphragm "d" is already in diaphragm "deck"',
            lambda f: f.add_diaphragm("d", ["floor-1", "beside"]),
        ),
        (r'lists node "base" more than once', lambda f: f.add_level("l", ["base", "base"])),
        (r'did you mean "column"', lambda f: f.add_uniform_load("colum", (0, 0, 1))),
        (
            r'"floor-1" is 3.12 m above node "ground".*height 0.12 m',
            lambda f: f.add_bearing("b", "ground", "floor-1", BEARING),
        ),
        (r'"ground" is -0.12 m', lambda f: f.add_bearing("b", "base", "ground", BEARING)),
        (r'"beside" is 4 m', lambda f: f.add_bearing("b", "floor-1", "beside", BEARING)),
    ],
    TypeError: [
        (r"name of a node = 7 must be a string", lambda f: f.add_node(7, 0, 0, 0)),
        (r"= '7' is not a number", lambda f: f.add_mass("base", "7")),
        (r'section of member "m" = 5.0', lambda f: f.add_member("m", *FAR, 5.0)),
        (r'write \["base"\]', lambda f: f.add_level("l", "base")),
        (
            r"is the class SimpleNamespace: pass an instance",
            lambda f: f.add_bearing("b", "ground", "base", SimpleNamespace),
        ),
        (r"no axial_stiffness and no", lambda f: f.add_bearing("b", "ground", "base", 3.0)),
        (r"write ModalDamping\(0.02\)", lambda f: f.set_damping(0.02)),
    ],
}
TWINS, FAR = ("floor-1", "twin"), ("base", "floor-2")


@pytest.mark.parametrize(
    ("kind", "words", "call"), [(kind, *row) for kind, rows in REFUSED.items() for row in rows]
)
def test_frame_refuses(kind, words, call):
    refused(kind, words, call, small_frame())


def test_frame_refuses_negative_gravity() -> None:
    refused(ModelError, r"gravity \[m/s2\] = -9.8", Frame, gravity=-9.8)


def test_damping_is_data() -> None:
    frame = small_frame()
    for damping in (None, RayleighDamping(0.02, periods=(0.5, 0.1)), ModalDamping((0.01, 0.03))):
        frame.set_damping(damping)
        assert frame.damping == damping
    assert ModalDamping(0.05).ratios == (0.05,)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: RayleighDamping(2.0, (0.5, 0.1)), r"ratio = 2 must be at least 0 and below 1"),
        (lambda: RayleighDamping(0.02, (0.5, 0.5)), r"\(0.5, 0.5\) s must differ"),
        (lambda: RayleighDamping(0.02, (0.5, -0.1)), r"= -0.1 must be positive and finite"),
        (lambda: RayleighDamping(0.02, (1.0,)), r"two periods"),
        (lambda: ModalDamping(()), r"ratio is empty"),
        (lambda: ModalDamping((0.02, np.nan)), r"= nan must be at least 0 and below 1"),
    ],
)
def test_damping_refuses(make, words):
    refused(ModelError, words, make)


def test_bearing_may_leave_its_axial_stiffness_to_its_default() -> None:
    bearing = SimpleNamespace(
        axial_stiffness=None, height=0.12, resolved=lambda: {"axial_stiffness": 3e9}
    )
    frame = small_frame()
    frame.add_bearing("bearing", "ground", "base", bearing)
    assert_allclose(bearing_axial_stiffness(bearing), 3e9, rtol=0.0, atol=0.0)
    assert_allclose(bearing_axial_stiffness(BEARING), 2e9, rtol=0.0, atol=0.0)
