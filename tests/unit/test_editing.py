"""Copies of frames, other bearings under the same structure, and parts that go."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    Section,
    moment_frame,
    shear_building,
    time_history,
)
from tests.refusals import refused
from tests.scenes import simple_bearing

bearing = partial(simple_bearing, plate_thickness=0.05)


def test_a_copy_is_apart():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    other = frame.copy("other")
    assert (other.name, frame.name) == ("other", "moment frame")
    assert isinstance(other, Frame)
    other.add_node("new", 1.0, 2.0, 9.0)
    other.add_mass("floor-1-0-0", 1e3)
    other.remove("level", "floor-1")
    assert "new" not in frame.nodes
    assert frame.masses["floor-1-0-0"][0] + 1e3 == other.masses["floor-1-0-0"][0]
    assert len(frame.levels) == len(other.levels) + 1
    assert frame.copy().name == frame.name


def test_other_bearings_under_the_same_structure():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    plain = frame.with_bearings(bearing().as_dcfp(), "plain")
    assert all(link.bearing.is_dcfp for link in plain.bearings.values())
    assert not any(link.bearing.is_dcfp for link in frame.bearings.values())
    assert dict(plain.nodes) == dict(frame.nodes)
    one = frame.with_bearings({"bearing-0-1": bearing(capacity=0.2)})
    assert [link.bearing.capacity for link in one.bearings.values()] == [0.12, 0.2, 0.12, 0.12]
    time = np.arange(0.0, 0.5, 0.01)
    motion = GroundMotion(x=2.0 * np.sin(9.0 * time), dt=0.01)
    built = moment_frame((1, 1), 1, bearing=bearing().as_dcfp())
    ours, theirs = (time_history(model, motion, dt=0.01) for model in (plain, built))
    np.testing.assert_array_equal(ours["node_displacement"], theirs["node_displacement"])


def test_the_ground_goes_up_and_down_with_the_height():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    high = frame.with_bearings({"bearing-0-0": bearing(slider_height=0.16)})
    base, ground = high.nodes["base-0-0"], high.nodes["ground-0-0"]
    assert base == frame.nodes["base-0-0"]
    assert base.z - ground.z == pytest.approx(0.26)
    assert high.nodes["ground-0-1"] == frame.nodes["ground-0-1"]


def test_a_node_of_the_structure_stays_where_it_is():
    frame = Frame("pier")
    device = bearing()
    for name, z in (("ground", 0.0), ("pier", 4.0), ("deck", 4.0 + device.height)):
        frame.add_node(name, 0.0, 0.0, z)
    frame.fix("ground", "all")
    frame.add_member("pier", "ground", "pier", Section.box(0.5, 0.5, 0.05))
    frame.add_bearing("one", "pier", "deck", device)
    frame.add_mass("deck", 3e4, (1e3, 1e3, 1e3))
    words = r'bearing "one".*place node j at z of node i'
    refused(ModelError, words, frame.with_bearings, replace(device, slider_height=0.16))
    wide = frame.with_bearings(replace(device, capacity=0.3))
    assert wide.bearings["one"].bearing.capacity == 0.3


def test_unknown_names():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    refused(ModelError, "nothing", frame.with_bearings, {"nothing": bearing()})
    refused(ModelError, "nothing", frame.remove, "member", "nothing")
    words = "kind = 'beam': choose one of member, spring"
    refused(ModelError, words, frame.remove, "beam", "beam-x-base-0-0")


def test_parts_go():
    frame = moment_frame((1, 1), 1, bearing=bearing())
    frame.add_uniform_load("beam-x-floor-1-0-0", (0.0, 0.0, -1e3))
    frame.remove("member", "beam-x-floor-1-0-0")
    frame.remove("mass", "floor-1-0-0")
    assert "beam-x-floor-1-0-0" not in frame.members
    assert "beam-x-floor-1-0-0" not in frame.uniform_loads
    assert "floor-1-0-0" not in frame.masses
    frame.add_member(
        "beam-x-floor-1-0-0", "floor-1-0-0", "floor-1-1-0", Section.box(0.2, 0.2, 0.01)
    )
    stick = shear_building(bearing(), 1e5, 1e7, storeys=2)
    stick.remove("level", next(level.name for level in stick.levels))
    assert len(stick.levels) == 2
