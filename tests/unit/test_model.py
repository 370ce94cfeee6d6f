"""What the frame accepts, keeps and refuses at the door."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, cast

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames._errors import ModelError
from frames.frame import Frame
from frames.model.components import bearing_axial_stiffness
from frames.model.damping import ModalDamping, RayleighDamping
from frames.model.sections import Section

if TYPE_CHECKING:
    from lir_element import LIRBearing

COLUMN = Section.box(0.3, 0.3, 0.01)
BEARING = cast("LIRBearing", SimpleNamespace(axial_stiffness=2e9, height=0.12))


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


Refusal = tuple[Callable[[Frame], None], type[Exception], str]

REFUSALS: dict[str, Refusal] = {
    "unknown node": (
        lambda f: f.add_mass("flor-1", 1.0),
        ModelError,
        r'no node "flor-1".*did you mean "floor-1"',
    ),
    "no such node at all": (lambda f: f.fix("xyz", "all"), ModelError, r"6 exist"),
    "duplicate node": (
        lambda f: f.add_node("base", 0, 0, 0),
        ModelError,
        r'node "base" exists already',
    ),
    "empty name": (lambda f: f.add_node(" ", 0, 0, 0), ModelError, r"name of a node is empty"),
    "number as name": (
        lambda f: f.add_node(cast("str", 7), 0, 0, 0),
        TypeError,
        r"name of a node = 7 must be a string",
    ),
    "nan coordinate": (
        lambda f: f.add_node("n", 0.0, math.nan, 0.0),
        ModelError,
        r'coordinates \[m\] of node "n" = \[0.0, nan, 0.0\] must be finite',
    ),
    "unknown dof": (lambda f: f.fix("base", "vx"), ModelError, r"'vx'.*\"all\" or one of"),
    "no dof": (lambda f: f.fix("base"), ModelError, r"names no degree of freedom"),
    "negative mass": (
        lambda f: f.add_mass("base", -2.0),
        ModelError,
        r'mass \[kg\] at node "base" = -2 must be at least 0 and finite',
    ),
    "negative inertia": (
        lambda f: f.add_mass("base", 1.0, (0.0, -1.0, 0.0)),
        ModelError,
        r"inertia .* must be 0 or greater",
    ),
    "text as mass": (
        lambda f: f.add_mass("base", cast("float", "7")),
        TypeError,
        r"= '7' is not a number",
    ),
    "zero-length member": (
        lambda f: f.add_member("m", "floor-1", "twin", COLUMN),
        ModelError,
        r'member "m" from "floor-1" to "twin" is 0 m long',
    ),
    "member to itself": (
        lambda f: f.add_member("m", "base", "base", COLUMN),
        ModelError,
        r'starts and ends at node "base"',
    ),
    "member without section": (
        lambda f: f.add_member("m", "base", "floor-2", cast("Section", 5.0)),
        TypeError,
        r'section of member "m" = 5.0',
    ),
    "parallel up": (
        lambda f: f.add_member("m", "base", "floor-2", COLUMN, up=(0, 0, 2)),
        ModelError,
        r'member "m" has no local axes',
    ),
    "five spring numbers": (
        lambda f: f.add_spring("s", "base", "floor-1", (1.0,) * 5),
        ModelError,
        r"shape \(5,\), it must be \(6,\)",
    ),
    "spring without stiffness": (
        lambda f: f.add_spring("s", "base", "floor-1", (0.0,) * 6),
        ModelError,
        r"not all 0",
    ),
    "diaphragm of one": (
        lambda f: f.add_diaphragm("d", ["floor-1"]),
        ModelError,
        r"has 1 nodes, it needs 2",
    ),
    "inclined diaphragm": (
        lambda f: f.add_diaphragm("d", ["floor-1", "floor-2"]),
        ModelError,
        r'not horizontal: node "floor-1" is at z = 3.12 m, node "floor-2" at z = 6.12',
    ),
    "node in two diaphragms": (
        lambda f: f.add_diaphragm("d", ["floor-1", "beside"]),
        ModelError,
        r'"beside" of diaphragm "d" belongs to diaphragm "deck"',
    ),
    "repeated node": (
        lambda f: f.add_level("l", ["base", "base"]),
        ModelError,
        r'lists node "base" more than once',
    ),
    "text as node list": (lambda f: f.add_level("l", "base"), TypeError, r'write \["base"\]'),
    "load on unknown member": (
        lambda f: f.add_uniform_load("colum", (0, 0, 1)),
        ModelError,
        r'did you mean "column"',
    ),
    "bearing too far": (
        lambda f: f.add_bearing("b", "ground", "floor-1", BEARING),
        ModelError,
        r'"floor-1" is 3.12 m above node "ground".*height 0.12 m',
    ),
    "bearing upside down": (
        lambda f: f.add_bearing("b", "base", "ground", BEARING),
        ModelError,
        r'"ground" is -0.12 m above',
    ),
    "bearing aslant": (
        lambda f: f.add_bearing("b", "floor-1", "beside", BEARING),
        ModelError,
        r'"beside" stands 4 m beside the vertical',
    ),
    "bearing class": (
        lambda f: f.add_bearing("b", "ground", "base", cast("LIRBearing", SimpleNamespace)),
        TypeError,
        r"is the class SimpleNamespace: pass an instance",
    ),
    "no bearing": (
        lambda f: f.add_bearing("b", "ground", "base", cast("LIRBearing", 3.0)),
        TypeError,
        r"has no axial_stiffness and no height",
    ),
    "bare damping ratio": (
        lambda f: f.set_damping(cast("ModalDamping", 0.02)),
        TypeError,
        r"write ModalDamping\(0.02\)",
    ),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_frame_refuses(case: str) -> None:
    call, error, words = REFUSALS[case]
    with pytest.raises(error, match=words):
        call(small_frame())


def test_frame_refuses_negative_gravity() -> None:
    with pytest.raises(ModelError, match=r"gravity \[m/s2\] = -9.8"):
        Frame(gravity=-9.8)


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
        (lambda: RayleighDamping(0.02, cast("tuple[float, float]", (1.0,))), r"two periods"),
        (lambda: ModalDamping(()), r"ratio is empty"),
        (lambda: ModalDamping((0.02, np.nan)), r"= nan must be at least 0 and below 1"),
    ],
)
def test_damping_refuses(make: Callable[[], object], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        make()


def test_bearing_may_leave_its_axial_stiffness_to_its_default() -> None:
    made = SimpleNamespace(
        axial_stiffness=None, height=0.12, resolved=lambda: {"axial_stiffness": 3e9}
    )
    bearing = cast("LIRBearing", made)
    frame = small_frame()
    frame.add_bearing("bearing", "ground", "base", bearing)
    assert_allclose(bearing_axial_stiffness(bearing), 3e9, rtol=0.0, atol=0.0)
    assert_allclose(bearing_axial_stiffness(BEARING), 2e9, rtol=0.0, atol=0.0)
