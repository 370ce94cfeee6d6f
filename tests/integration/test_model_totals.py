"""Totals of a model: what the bearings carry, what passes them by, and numbers in other units."""

import math
import warnings
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    ModelWarning,
    Section,
    gravity,
    lumped_mass,
    moment_frame,
    shear_building,
    time_history,
)
from frames.demo import bearing_for, pacoima
from lir_element import AnalysisError
from tests.refusals import refused
from tests.scenes import small_bearing

G = 9.80665
PAPER = small_bearing()
LOAD = 30e6 * math.pi * 0.08**2


def storey(*, held, base_mass=4000.0, floor=800000.0, support=("uz",)):
    """One storey on four bearings, its mass at the held master of its diaphragm, or at columns."""
    frame = Frame("storey")
    section = Section.box(0.4, 0.4, 0.02, density=0.0)
    device = bearing_for(2e6)
    places = [(i, j) for i in (0, 1) for j in (0, 1)]
    for i, j in places:
        x, y, h = 12.0 * i, 12.0 * j, device.height
        for name, z in (("ground", 0.0), ("base", h), ("floor", h + 3.0)):
            frame.add_node(f"{name}-{i}{j}", x, y, z)
        frame.fix(f"ground-{i}{j}", "all")
        frame.add_bearing(f"bearing-{i}{j}", f"ground-{i}{j}", f"base-{i}{j}", device)
        frame.add_member(f"column-{i}{j}", f"base-{i}{j}", f"floor-{i}{j}", section)
        if base_mass:
            frame.add_mass(f"base-{i}{j}", base_mass / 4)
    for level in ("base", "floor"):
        for a, b in (("00", "01"), ("01", "11"), ("11", "10"), ("10", "00")):
            frame.add_member(f"{level}-{a}-{b}", f"{level}-{a}", f"{level}-{b}", section)
        frame.add_diaphragm(
            level,
            [f"{level}-{i}{j}" for i, j in places]
            + ["master"]
            * (level == "floor" and not frame.add_node("master", 6.0, 6.0, device.height + 3.0)),
        )
    frame.fix("master", "rx", "ry", *support)
    if held:
        frame.add_mass("master", floor, (0.0, 0.0, 5e6))
    for i, j in places if not held else ():
        frame.add_mass(f"floor-{i}{j}", floor / 4)
    return frame


def said(action: Any, *words: str) -> None:
    """Check that an action warns with all `words` in one sentence."""
    with pytest.warns(ModelWarning) as caught:
        action()
    texts = [str(entry.message) for entry in caught]
    assert any(all(word in text for word in words) for text in texts), texts


def test_mass_at_the_master_of_a_diaphragm() -> None:
    """Its vertical support carries the floor: the bearings' 39 kN are named beside 7885 kN."""
    frame = storey(held=True)
    said(lambda: gravity(frame), "39.23 of 7885 kN", '"master" (7845 kN)', '"uz"')
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        path = gravity(frame).load_path
    assert_allclose(path.weight, 804e3 * G, rtol=1e-9)
    assert_allclose(path.bearings, 4e3 * G, rtol=1e-6)
    assert_allclose(path.lost, 800e3 * G, rtol=1e-6)
    said(lambda: time_history(frame, ripple(), duration=0.05), '"master" (7845 kN)')


def test_nothing_left_for_the_bearings() -> None:
    """No mass can move vertically: refused, and the node that holds it is named."""
    with pytest.raises(ModelError, match=r'no mass along z.*"master".*fixed along z'):
        gravity(storey(held=True, base_mass=0.0))


def test_a_master_that_nothing_carries() -> None:
    """The remedy is not to hold it: that would take its weight past the bearings."""
    with pytest.raises(ModelError, match=r'"master" translation uz.*has no vertical stiffness'):
        gravity(storey(held=True, support=()))


def test_bearings_without_load_of_their_own() -> None:
    """Uplift under permanent loads says where the weight went."""
    frame = storey(held=True, base_mass=1.0)
    for i, j in ((0, 0), (1, 1)):
        frame.add_load(f"base-{i}{j}", [0.0, 0.0, 50.0, 0.0, 0.0, 0.0])
    refused(AnalysisError, r'no compression.*7845 kN.*"master"', gravity, frame)


def ripple(peak: float = 2.0) -> GroundMotion:
    return GroundMotion(x=peak * np.sin(np.linspace(0.0, 20.0, 201)), dt=0.01, name="ripple")


def test_supports_that_are_meant_pass() -> None:
    """Piers under bearings, and springs to the ground that carry next to nothing."""
    frame = Frame("pier")
    frame.add_node("foot", 0.0, 0.0, -4.0)
    frame.fix("foot", "all")
    frame.add_node("head", 0.0, 0.0, 0.0)
    frame.add_member("pier", "foot", "head", Section.box(0.5, 0.5, 0.03))
    frame.add_mass("head", 10e3)
    frame.add_node("deck", 0.0, 0.0, PAPER.height)
    frame.fix("deck", "rx", "ry", "rz")
    frame.add_mass("deck", LOAD / G)
    frame.add_bearing("bearing", "head", "deck", PAPER)
    frame.add_node("stair", 0.0, 0.0, PAPER.height)
    frame.fix("stair", "all")
    frame.add_spring("stair", "deck", "stair", [0.0, 0.0, 1e6, 0.0, 0.0, 0.0])
    path = gravity(frame).load_path
    assert_allclose(path.bearings + path.lost, LOAD, rtol=1e-6)
    assert 0.0 < path.lost < 1e-3 * LOAD


def test_a_roller_besides_bearings_is_named() -> None:
    """A support with its share of the weight: said; over a bearing it leaves that one none."""
    frame = storey(held=False, base_mass=200e3)
    frame.fix("floor-00", "uz")
    said(lambda: gravity(frame), '"floor-00"', "unless this is intended")
    frame = storey(held=False)
    frame.add_node("soil", 0.0, 0.0, 0.0)
    frame.fix("soil", "all")
    frame.add_spring("soil", "soil", "base-00", [3e7, 0.0, 0.0, 0.0, 0.0, 0.0])
    radius = bearing_for(2e6).effective_radius
    pendulums = gravity(storey(held=False)).axial_forces.sum() / radius
    said(lambda: gravity(frame), "along x", f"{3e7 / pendulums:.3g} times", 'at "soil"')
    frame = storey(held=False)
    frame.fix("base-00", "uz")
    refused(AnalysisError, r'"bearing-00": a bearing carries no.*at "base-00"', gravity, frame)


USUAL = {
    "the paper's bearing": lambda: lumped_mass(PAPER, LOAD / G),
    "a twentieth of the mass": lambda: lumped_mass(PAPER, 0.05 * LOAD / G),
    "the demo's frame": lambda: moment_frame(bearing=bearing_for(1000e3)),
    "a shear building": lambda: shear_building(PAPER, 15e3, 40e6, storeys=3),
    "a soft tower": lambda: shear_building(PAPER, 6e3, 5e6, storeys=8),
    "a model of a twentieth": lambda: lumped_mass(
        small_bearing(radius=0.0375, slider_height=0.00425, slider_radius=0.004, capacity=0.00875),
        0.05**3 * LOAD / G,
    ),
}


@pytest.mark.parametrize("build", USUAL.values(), ids=USUAL)
def test_usual_models_pass(build: Any) -> None:
    """No word (a warning is an error here), and a table."""
    checked = build().check()
    assert checked.ok, str(checked)
    assert_allclose(checked.carried, checked.weight, rtol=1e-5)


WRONG = {
    "mass in t": (lambda: lumped_mass(PAPER, 1e-3 * LOAD / G), "0.03 MPa", "t for kg"),
    "weight for mass": (lambda: lumped_mass(PAPER, LOAD), "294 MPa", "N for kg"),
    "light pressure": (lambda: lumped_mass(bearing_for(2e6), 2e6), "9.81 times their", "N for kg"),
    "slender load": (lambda: lumped_mass(bearing_for(2e6), 204.0), "0.001 times their", "t or N"),
    "floors in t": (
        lambda: storey(held=False, base_mass=4.0, floor=800.0),
        "kg/m3 (buildings have 100 to 600)",
        "t for kg",
    ),
    "floors' weight for mass": (
        lambda: storey(held=False, base_mass=4e3 * G, floor=800e3 * G),
        "kg/m3 (buildings have 100 to 600)",
        "a weight in N for a mass in kg?",
    ),
    "kN/mm": (
        lambda: shear_building(PAPER, 15e3, 40.0, storeys=3),
        "fixed-base period is",
        "kN/mm for N/m",
    ),
    "kN/m": (lambda: shear_building(PAPER, 15e3, 40e3, storeys=3), "fixed-base period is", "kN/m"),
    "t, kN/m": (lambda: shear_building(PAPER, 15.0, 40e3, storeys=3), "MPa under", "t for kg"),
    "soft seat": (
        lambda: lumped_mass(small_bearing(design_load=1e5, axial_stiffness=6e6), LOAD / G),
        "% of its slider's height",
        "axial_stiffness",
    ),
}


@pytest.mark.parametrize(("build", "value", "unit"), WRONG.values(), ids=WRONG)
def test_numbers_in_other_units(build: Any, value: str, unit: str) -> None:
    frame = build()
    found = frame.check()
    assert not found.ok
    assert any(value in text and unit in text for text in found.doubts), str(found)
    assert all(text in str(found) for text in found.doubts)
    said(lambda: gravity(frame), value, unit)


def test_a_frame_in_mm_is_refused() -> None:
    frame = Frame("mm")
    frame.add_node("a", 0.0, 0.0, 0.0)
    frame.add_node("b", 0.0, 0.0, 3000.0)
    for action in (frame.check, lambda: gravity(frame)):
        refused(ModelError, r"3000 m high.*3000 mm are 3 m", action)


def test_a_crushed_slider_is_refused() -> None:
    with pytest.raises(ModelError, match=r"more than any material.*N for kg"):
        gravity(lumped_mass(PAPER, 10.0 * G * LOAD))
    failed = lumped_mass(PAPER, 10.0 * G * LOAD).check()
    assert "more than any material" in failed.failure
    assert "more than any material" in str(failed)


@pytest.mark.parametrize(
    ("peak", "words"),
    [
        (0.3, ("0.3 m/s2 = 0.031 g", "0.3 g is 2.94 m/s2")),
        (300.0, ("300 m/s2 = 30.6 g", "300 cm/s2 are 3 m/s2")),
    ],
)
def test_a_motion_in_other_units(peak: float, words: tuple[str, ...]) -> None:
    model = lumped_mass(PAPER, LOAD / G)
    said(lambda: time_history(model, ripple(peak), duration=0.02), *words)
    assert not model.check(ripple(peak)).ok
    assert model.check(ripple(3.0)).ok


def test_a_step_in_ms_is_refused() -> None:
    with pytest.raises(ValueError, match=r"dt = 5 s is longer.*5 ms are 0.005 s"):
        time_history(lumped_mass(PAPER, LOAD / G), ripple(), duration=20.0, dt=5.0)


def test_swapped_and_wrong_arguments() -> None:
    model, motion = lumped_mass(PAPER, LOAD / G), ripple()
    swapped: Any = (motion, model)
    refused(TypeError, r"swapped: time_history\(model, motion\)", time_history, *swapped)
    wrong: Any = (model, [0.0, 1.0])
    refused(TypeError, "must be a GroundMotion", time_history, *wrong)
    wrong = (PAPER, motion)
    refused(TypeError, "must be a Frame", time_history, *wrong)


def test_totals_of_the_demos_frame() -> None:
    """The table's numbers against sums by hand."""
    frame = moment_frame(bearing=bearing_for(1000e3))
    frame.add_load(next(iter(frame.masses)), [0.0, 5e3, -20e3, 0.0, 0.0, 0.0])
    found = frame.check(pacoima())
    members = sum(
        m.section.density
        * m.section.area
        * math.dist(frame.nodes[m.i].position, frame.nodes[m.j].position)
        for m in frame.members.values()
    )
    mass = members + sum(float(values[0]) for values in frame.masses.values())
    assert_allclose(found.mass, mass, rtol=1e-12)
    own = sum(
        float(q[2]) * math.dist(*(frame.nodes[n].position for n in ends))
        for name, q in frame.uniform_loads.items()
        for ends in [(frame.members[name].i, frame.members[name].j)]
    )
    assert_allclose(found.loads, (0.0, 5e3, own - 20e3), rtol=1e-9, atol=1e-6)
    assert_allclose(found.weight, mass * G + 20e3 - own, rtol=1e-9)
    assert_allclose(sum(load.axial_force for load in found.bearings), found.weight, rtol=1e-5)
    state = gravity(frame)
    for load, force in zip(found.bearings, state.axial_forces, strict=True):
        device = frame.bearings[load.name].bearing
        assert_allclose(load.axial_force, force, rtol=1e-12)
        assert_allclose(load.pressure * math.pi * device.slider_radius**2, force, rtol=1e-12)
    text = str(found)
    for part in ("mass", "t\n", "permanent loads along x and y", "bearing-2-2", "peak 11.9"):
        assert part in text
    assert text in repr(found)
    assert "<table>" in found._repr_html_()
    assert len(text) < 4000


def test_periods_of_the_totals() -> None:
    """Three storeys by hand, and the pendulum."""
    found = shear_building(PAPER, 15e3, 40e6, storeys=3).check()
    k = 40e6 * np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    periods = 2.0 * math.pi / np.sqrt(np.linalg.eigvalsh(k / 15e3))
    assert_allclose(found.periods[::2], periods[:2], rtol=2e-3)
    assert_allclose(found.isolated_period, PAPER.period, rtol=1e-9)


def test_representations_are_short() -> None:
    frame = moment_frame(bearing=bearing_for(1000e3))
    state = gravity(frame)
    things = (
        PAPER,
        frame,
        state,
        state.system,
        state.basis,
        pacoima(),
        Section.box(0.3, 0.3, 0.01),
    )
    for thing in things:
        assert len(repr(thing)) < 500, type(thing)
    for thing in (PAPER, frame, state, pacoima(), Section.box(0.3, 0.3, 0.01)):
        assert thing._repr_html_().startswith("<div>")
    assert "None" not in PAPER._repr_html_()
    assert "axial_stiffness" in PAPER._repr_html_()
    assert "4.731e+09" in PAPER.describe()
