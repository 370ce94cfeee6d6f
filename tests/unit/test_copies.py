"""Copies and pickles: equal to the bit, and independent; errors and inputs keep what they carry."""

import copy
import pickle  # noqa: S403
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from frames import Frame, GroundMotion, MotionError, Section
from lir_element import AnalysisError, CoulombFriction, Element, RunStatus, VelocityFriction
from tests.refusals import refused
from tests.scenes import rimmed_bearing

DEVICE = rimmed_bearing(friction=(VelocityFriction(0.07, 0.03, 12.0), CoulombFriction(0.08)))
COPIES: dict[str, Callable[[Any], Any]] = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),  # noqa: S301
}
each_copy = pytest.mark.parametrize("duplicate", COPIES.values(), ids=COPIES)


def path(first: int, count: int) -> np.ndarray:
    """Displacements (count, 12) of a push into the rims and back, the plates tilting."""
    t = 0.01 * np.arange(first, first + count)
    u = np.zeros((count, 12))
    u[:, 6], u[:, 7] = 0.16 * np.sin(2.0 * t), 0.04 * np.sin(3.1 * t)
    u[:, 8] = -1.5e-4 + 0.5 * u[:, 6] ** 2 / DEVICE.effective_radius
    u[:, 10] = 2e-3 * np.sin(2.5 * t)
    return u


def walk(element: Element, first: int, count: int) -> list[np.ndarray]:
    """Forces and tangents along the path."""
    found = []
    for k, u in enumerate(path(first, count), start=first):
        element.set_trial(u, np.zeros(12), 0.01 * (k + 1))
        found += [element.resisting_force(), element.tangent_stiffness()]
        element.commit()
    return found


@each_copy
@pytest.mark.parametrize("level", ["pendulum", "contact"])
def test_an_element_in_use(level: Any, duplicate: Callable[[Any], Any]) -> None:
    """The copy goes on as the original would have, whichever of the two goes first."""
    lone, element = Element(DEVICE, level), Element(DEVICE, level)
    before = 80 if level == "pendulum" else 25
    expected = walk(lone, 0, before + 12)[2 * before :]
    walk(element, 0, before)
    other = duplicate(element)
    for ahead in (element, other):
        for ours, theirs in zip(walk(ahead, before, 12), expected, strict=True):
            np.testing.assert_array_equal(ours, theirs)
    other.revert_to_start()
    assert float(other.response("axial_force")) == 0.0
    assert float(element.response("axial_force")) > 0.0


@each_copy
def test_an_element_in_mid_trial(duplicate: Callable[[Any], Any]) -> None:
    element = Element(DEVICE)
    walk(element, 0, 40)
    element.set_trial(path(40, 1)[0], np.zeros(12), 0.41)
    other = duplicate(element)
    np.testing.assert_array_equal(other.tangent_stiffness(), element.tangent_stiffness())
    element.revert_to_last_commit()
    other.commit()
    assert float(other.response("time")) == 0.41
    assert float(element.response("time")) == 0.40


def failing(_: int) -> None:
    """Fail as an analysis does in a process of a pool."""
    data = xr.Dataset({"u": ("time", [0.0, 1.0])})
    raise AnalysisError(RunStatus.RIM_OVERRUN, 1.5, 'bearing "b"', "12 mm", data)


@each_copy
def test_an_analysis_error(duplicate: Callable[[Any], Any]) -> None:
    with pytest.raises(AnalysisError) as caught:
        failing(0)
    caught.value.add_note("of run 7")
    other = duplicate(caught.value)
    assert str(other) == str(caught.value)
    assert (other.status, other.time, other.where) == (RunStatus.RIM_OVERRUN, 1.5, 'bearing "b"')
    assert other.__notes__ == ["of run 7"]
    xr.testing.assert_identical(other.data, caught.value.data)


@each_copy
def test_a_motion_stays_read_only(duplicate: Callable[[Any], Any]) -> None:
    motion = GroundMotion(x=[0.0, 1.0, -1.0], z=[0.1, 0.2, 0.3], dt=0.01, name="m")
    other = duplicate(motion)
    assert repr(other) == repr(motion)
    assert other.y is None
    for axis in ("x", "z"):
        values = getattr(other, axis)
        np.testing.assert_array_equal(values, getattr(motion, axis))
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 5.0


@each_copy
def test_other_inputs(duplicate: Callable[[Any], Any]) -> None:
    for thing in (DEVICE, DEVICE.friction, Section.box(0.3, 0.3, 0.01)):
        assert duplicate(thing) == thing
    refused(MotionError, "dt", GroundMotion, x=[0.0, 1.0], dt=0.0)


def test_what_a_frame_holds_is_read_only() -> None:
    frame = Frame("small")
    frame.add_node("a", 0.0, 0.0, 0.0)
    frame.add_node("b", 1.0, 0.0, 0.0)
    frame.add_member("m", "a", "b", Section.box(0.3, 0.3, 0.01))
    frame.add_mass("a", 5.0)
    frame.add_load("a", [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    frame.add_uniform_load("m", [1.0, 0.0, 0.0])
    again = pickle.loads(pickle.dumps(copy.deepcopy(frame)))  # noqa: S301
    for held in (frame, copy.copy(frame), again):
        for values in (held.masses["a"], held.loads["a"], held.uniform_loads["m"]):
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 7.0
    again.add_mass("a", 5.0)
    assert frame.masses["a"][0] == 5.0
    assert again.masses["a"][0] == 10.0
