"""A frame written for SAP2000 or ETABS and read again is alike; links stand for bearings."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import csr_matrix

from frames import Frame, ModelError, gravity, lumped_mass, moment_frame
from frames.assembly.assemble import assemble
from frames.demo import bearing_for
from frames.exchange.pendulum_link import pendulum_link
from frames.exchange.sap2000 import read_sap2000
from frames.model.sections import Section
from lir_element import VelocityFriction
from tests.refusals import refused
from tests.scenes import paper_bearing, wide_bearing


def detailed() -> Frame:
    """Return a frame with all that the tables hold, floor panels and springs among it."""
    frame = Frame("detailed")
    column = Section.rectangle(0.4, 0.5, elastic_modulus=31e9, poisson_ratio=0.2, density=2500.0)
    beam = Section.box(0.2, 0.4, 0.012)
    corners = {"a": (0.0, 0.0), "b": (6.0, 0.0), "c": (6.0, 5.0), "d": (0.0, 5.0)}
    for name, (x, y) in corners.items():
        frame.add_node(f"foot {name}", x, y, 0.0)
        frame.add_node(name, x, y, 3.2)
        frame.fix(f"foot {name}", "all")
        up = (0.3, 1.0, 0.0) if name == "b" else None
        frame.add_member(f"column {name}", f"foot {name}", name, column, up)
    offsets = {"i": (0.2, 0.0, -0.1), "j": (-0.25, 0.0, -0.1)}
    frame.add_member("ab", "a", "b", beam, offsets=offsets)
    frame.add_member("bc", "b", "c", beam, releases={"i": ("My", "Mz"), "j": ("T", "My")})
    frame.add_member("cd", "c", "d", beam)
    frame.add_member("da", "d", "a", beam, (0.2, 0.0, 1.0))
    frame.add_node("pit", 0.0, 0.0, 3.2)
    frame.fix("pit", "all")
    frame.add_spring("ground", "pit", "a", (1e6, 2e6, 3e6, 4e5, 5e5, 6e5))
    frame.add_diaphragm("roof", ["a", "b", "c", "d"])
    frame.add_mass("c", 900.0, (10.0, 20.0, 30.0))
    frame.add_mass("d", 400.0, weighs=False)
    frame.add_load("b", (1e3, -2e3, -3e3, 40.0, 50.0, 60.0))
    frame.add_uniform_load("ab", (100.0, 200.0, -3e3), case="L")
    frame.add_tapered_load("cd", (0.0, 0.0, -1e3), (0.0, 50.0, -4e3), 1.0, 4.5, case="L")
    frame.add_floor_load("roof", ["a", "b", "c", "d"], 2.5e3, case="L")
    frame.set_mass_source({"L": 0.3})
    return frame


def braced() -> Frame:
    """Return a frame with members up, down and along, turned, released, offset and loaded."""
    frame = Frame("braced")
    section = Section.box(0.2, 0.4, 0.012)
    for k, (x, y) in enumerate(((0.0, 0.0), (5.0, 0.0), (0.0, 4.0))):
        for z in (-1.5, 0.0, 3.0, 6.5):
            frame.add_node(f"{k}@{z:g}", x, y, z)
        frame.fix(f"{k}@-1.5", "all")
        frame.add_member(f"pile {k}", f"{k}@0", f"{k}@-1.5", section)
        frame.add_member(f"column {k}", f"{k}@3", f"{k}@0", section, (0.4, 1.0, 0.0))
        frame.add_member(f"upper {k}", f"{k}@3", f"{k}@6.5", section)
    frame.add_node("mid", 2.5, 0.0, 1.7)
    frame.add_member("down", "1@3", "mid", section, releases={"i": ("My",), "j": ("T", "Mz")})
    frame.add_member("on", "mid", "0@0", section, (0.2, 1.0, 0.5))
    offsets = {"i": (-0.2, 0.16, 0.0), "j": (0.25, -0.2, 0.0)}
    frame.add_member("level", "1@6.5", "2@6.5", section, offsets=offsets)
    frame.add_member("lift", "2@6.5", "0@3", section, (1.0, 0.3, 0.2))
    frame.add_tapered_load("down", (0.0, 10.0, -1e3), (20.0, 0.0, -3e3), 0.3, 1.9)
    frame.add_tapered_load("column 1", (50.0, 10.0, 0.0), (80.0, 0.0, -3e1), 0.5, 2.5, case="S")
    frame.add_node("pit", 5.0, 0.0, 0.0)
    frame.fix("pit", "all")
    frame.add_spring("soil", "1@0", "pit", (1e6, 2e6, 3e6, 4e5, 5e5, 6e5))
    frame.add_node("well", 5.0, 0.0, 0.0)
    frame.fix("well", "all")
    frame.add_spring("more soil", "well", "1@0", (1e5, 2e5, 3e5, 4e4, 5e4, 6e4))
    frame.add_spring("tie", "0@6.5", "1@6.5", (1e6, 2e6, 3e6, 4e5, 5e5, 6e5))
    frame.add_mass("2@6.5", 900.0, (10.0, 20.0, 30.0))
    return frame


def same(
    one: Frame, two: Frame, names: dict[str, str] | None = None, within: float = 1e-12
) -> None:
    """Require two frames alike, the second one with other names of nodes."""
    first, second = assemble(one), assemble(two)
    # ETABS' text calls a diaphragm by its story as well
    labels = [re.sub(r"(-Story1)+ \(diaphragm\)", " (diaphragm)", x) for x in second.dof_labels]
    order = []
    for label in first.dof_labels:
        node, dof = re.sub(r"(-Story1)+ \(diaphragm\)", " (diaphragm)", label).rsplit(" ", 1)
        order.append(labels.index(f"{(names or {}).get(node, node)} {dof}"))
    assert sorted(order) == list(range(len(labels)))
    for word in ("stiffness", "mass"):
        left, right = csr_matrix(getattr(first, word)), csr_matrix(getattr(second, word))
        assert abs(left - right[order][:, order]).max() <= within * abs(left).max()
    assert_allclose(second.load[order], first.load, atol=within * np.abs(first.load).max())


@pytest.mark.parametrize("program", ["sap2000", "etabs"])
@pytest.mark.parametrize("make", [detailed, braced])
@pytest.mark.parametrize("units", ["KN, m, C", "Kip, in, F", "N, mm, C"])
def test_a_frame_comes_back_as_it_was(tmp_path, make, program, units):
    frame, path = make(), tmp_path / "model.txt"
    for _ in range(2):
        names = getattr(frame, f"to_{program}")(path, units=units) or {}
        whole = dict.fromkeys(("D", *frame.load_cases), 1.0)
        back = getattr(Frame, f"from_{program}")(path, loads=whole)
        same(frame, back, names)
        assert {names.get(name, name) for name in frame.members} == set(back.members)
        if program == "etabs":  # by whose stories the names of nodes grow again
            break
        frame = back


def test_bearings_are_friction_isolator_links(tmp_path: Path) -> None:
    laws = (VelocityFriction(0.06, 0.03, 40.0), VelocityFriction(0.05, 0.03, 40.0))
    bearing = wide_bearing(radius=(1.5, 1.8), slider_radius=0.15, capacity=0.25, friction=laws)
    frame = moment_frame((1, 1), 1, bearing=bearing, floor_load=800.0)
    path = tmp_path / "model.s2k"
    frame.to_sap2000(path, displacement=0.2)
    building = read_sap2000(path)
    loads = gravity(frame).axial_forces
    assert len(building.links) == 4
    for load, (name, link) in zip(loads, building.links.items(), strict=True):
        dof = building.link_properties[link.property].dofs["U2"]
        # by hand: W / L + Q / D, and the energy of a cycle 4 Q D
        strength = load * (0.06 * 1.5 + 0.05 * 1.8) / 3.1
        effective = load / 3.1 + strength / 0.2
        assert_allclose(dof.stiffness, effective, rtol=1e-9)
        omega = np.sqrt(effective * frame.gravity / load)
        assert_allclose(np.pi * dof.damping * omega * 0.2**2, 4 * strength * 0.2, rtol=1e-9)
        assert_allclose([dof.values["radius"], dof.values["fast"]], [3.1, strength / load])
        assert {link.i, link.j} == {frame.bearings[name].i, frame.bearings[name].j}
    back = Frame.from_sap2000(path)
    for name, part in back.bearings.items():
        assert_allclose(part.bearing.effective_radius, 3.1)
        assert_allclose(part.bearing.effective_friction, bearing.effective_friction)
        assert frame.bearings[name].i == part.i or part.i.startswith("ground-")


def test_the_link_has_the_friction_of_the_bearing_at_every_speed() -> None:
    law = VelocityFriction(0.06, 0.02, 30.0)
    bearing = paper_bearing(radius=1.6, slider_height=0.2, friction=law, interface_friction=0.2)
    link = pendulum_link(bearing, 1e6, 0.2)
    for speed in (0.0, 0.02, 0.1, 1.0):
        own = 2 * law.at_speed(speed * 1.6 / 3.0) * 1.6 / 3.0
        assert_allclose(link.fast - (link.fast - link.slow) * np.exp(-link.rate * speed), own)


def test_bearings_are_links_that_become_bearings_again(tmp_path: Path) -> None:
    frame = moment_frame((1, 1), 2, bearing=bearing_for(400e3), floor_load=800.0)
    path = tmp_path / "model.e2k"
    names = frame.to_etabs(path, displacement=0.2)
    text = path.read_text(encoding="utf-8")
    assert text.startswith("$ File written by lir-dcfp. Not confirmed by any file of ETABS itself")
    assert text.count('TYPE "FRICTION ISOLATOR"') == 4
    back = Frame.from_etabs(path)
    for name, part in frame.bearings.items():
        found = back.bearings[name]
        assert found.j == names[part.j]
        for word in ("effective_radius", "effective_friction"):
            assert_allclose(getattr(found.bearing, word), getattr(part.bearing, word), rtol=1e-9)
    assert_allclose(back.check().weight, frame.check().weight, rtol=1e-9)
    floors = [level.z for level in frame.levels if level.z > 0.0]
    assert_allclose([level.z for level in back.levels][-len(floors) :], floors)


def with_a_part(frame: Frame, node: str) -> Frame:
    frame.add_superelement("part", [node], np.eye(6), np.zeros((6, 6)))
    return frame


def with_a_twin(frame: Frame) -> Frame:
    frame.add_node("twin", 0.0, 0.0, 3.0)
    frame.add_spring("joint", "0@3", "twin", (1e6, 2e6, 3e6, 4e5, 5e5, 6e5))
    return frame


def on_a_bearing() -> Frame:
    return lumped_mass(bearing_for(400e3), mass=40e3)


WITH_PARTS = r'has superelements \("part"\), which cannot be written for {}'


@pytest.mark.parametrize(
    ("program", "make", "more", "message"),
    [
        ("sap2000", on_a_bearing, {}, r"set it, displacement=0.25 \[m\]"),
        ("etabs", on_a_bearing, {}, r"set it, displacement=0.25 \[m\]"),
        ("sap2000", lambda: with_a_part(braced(), "mid"), {}, WITH_PARTS.format("SAP2000")),
        ("etabs", lambda: with_a_part(braced(), "mid"), {}, WITH_PARTS.format("ETABS")),
        ("sap2000", detailed, {"units": "stone"}, r'units = "stone"'),
        ("etabs", lambda: with_a_twin(braced()), {}, r'"0@3" and "twin" coincide, and'),
    ],
)
def test_what_a_file_cannot_hold_is_refused(tmp_path, program, make, more, message):
    write = getattr(make(), f"to_{program}")
    refused(ModelError, message, write, tmp_path / "model.txt", **more)
