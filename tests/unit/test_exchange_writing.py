"""A frame written as SAP2000's tables and read again is alike; links stand for bearings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, gravity, lumped_mass, moment_frame
from frames.assembly.assemble import assemble
from frames.demo import bearing_for
from frames.exchange.pendulum_link import pendulum_link
from frames.exchange.sap2000 import read_sap2000
from frames.model.sections import Section
from lir_element import LIRBearing, VelocityFriction


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


@pytest.mark.parametrize("units", ["KN, m, C", "Kip, in, F", "N, mm, C"])
def test_a_frame_comes_back_as_it_was(tmp_path: Path, units: str) -> None:
    frame = detailed()
    frame.to_sap2000(tmp_path / "model.s2k", units=units)
    back = Frame.from_sap2000(tmp_path / "model.s2k", loads={"D": 1.0, "L": 1.0})
    one, two = assemble(frame), assemble(back)
    assert one.dof_labels == two.dof_labels
    for word in ("stiffness", "mass"):
        first, second = getattr(one, word), getattr(two, word)
        assert abs(first - second).max() <= 1e-12 * abs(first).max()
    assert_allclose(two.load, one.load, atol=1e-12 * np.abs(one.load).max())
    again = tmp_path / "again.s2k"
    back.to_sap2000(again, units=units)
    third = assemble(Frame.from_sap2000(again, loads={"D": 1.0, "L": 1.0}))
    assert abs(third.stiffness - one.stiffness).max() <= 1e-12 * abs(one.stiffness).max()


def test_bearings_are_friction_isolator_links(tmp_path: Path) -> None:
    bearing = LIRBearing(
        radius=(1.5, 1.8),
        slider_height=0.2,
        slider_radius=0.15,
        capacity=0.25,
        friction=(VelocityFriction(0.06, 0.03, 40.0), VelocityFriction(0.05, 0.03, 40.0)),
        interface_friction=0.2,
    )
    frame = moment_frame((1, 1), 1, bearing=bearing, floor_load=800.0)
    path = tmp_path / "model.s2k"
    with pytest.raises(ModelError, match=r"give displacement=0.25, in metres"):
        frame.to_sap2000(path)
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
    bearing = LIRBearing(
        radius=1.6,
        slider_height=0.2,
        slider_radius=0.15,
        capacity=0.25,
        friction=law,
        interface_friction=0.2,
    )
    link = pendulum_link(bearing, 1e6, 0.2)
    for speed in (0.0, 0.02, 0.1, 1.0):
        own = 2 * law.at_speed(speed * 1.6 / 3.0) * 1.6 / 3.0
        assert_allclose(link.fast - (link.fast - link.slow) * np.exp(-link.rate * speed), own)


def test_what_the_tables_cannot_hold_is_refused(tmp_path: Path) -> None:
    frame = lumped_mass(bearing_for(400e3), mass=40e3)
    frame.add_superelement("part", ["mass"], np.eye(6), np.zeros((6, 6)))
    with pytest.raises(ModelError, match=r'has superelements \("part"\)'):
        frame.to_sap2000(tmp_path / "model.s2k", displacement=0.1)
    with pytest.raises(ModelError, match=r'units = "stone"'):
        detailed().to_sap2000(tmp_path / "model.s2k", units="stone")
