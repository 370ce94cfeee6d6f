"""A frame written as ETABS' text and read again is alike; bearings are friction isolator links."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse import csr_matrix

from frames import Frame, ModelError, moment_frame
from frames.assembly.assemble import assemble
from frames.demo import bearing_for
from frames.model.sections import Section
from tests.unit.test_exchange_writing import detailed


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


def aligned(system: object, names: dict[str, str] | None = None) -> list[str]:
    """Return the labels of the degrees of freedom, by the names of the file."""
    labels = [str(label).rsplit(" ", 1) for label in system.dof_labels]  # type: ignore[attr-defined]
    found = [f"{(names or {}).get(node, node)} {dof}" for node, dof in labels]
    return [label.replace("-Story1 (diaphragm)", " (diaphragm)") for label in found]


@pytest.mark.parametrize("make", [detailed, braced])
@pytest.mark.parametrize("units", ["KN, m, C", "Kip, in, F"])
def test_a_frame_comes_back_as_it_was(tmp_path: Path, make: object, units: str) -> None:
    frame: Frame = make()  # type: ignore[operator]
    path = tmp_path / "model.e2k"
    names = frame.to_etabs(path, units=units)
    whole = dict.fromkeys(("D", *frame.load_cases), 1.0)
    back = Frame.from_etabs(path, loads=whole)
    one, two = assemble(frame), assemble(back)
    labels = aligned(two)
    order = [labels.index(label) for label in aligned(one, names)]
    assert sorted(order) == list(range(len(labels)))
    for word in ("stiffness", "mass"):
        first, second = csr_matrix(getattr(one, word)), csr_matrix(getattr(two, word))
        assert abs(first - second[order][:, order]).max() <= 1e-12 * abs(first).max()
    assert_allclose(two.load[order], one.load, atol=1e-12 * np.abs(one.load).max())
    assert {names[name] for name in frame.members} == set(back.members)


def test_bearings_are_links_that_become_bearings_again(tmp_path: Path) -> None:
    frame = moment_frame((1, 1), 2, bearing=bearing_for(400e3), floor_load=800.0)
    path = tmp_path / "model.e2k"
    with pytest.raises(ModelError, match=r"give displacement=0.25, in metres"):
        frame.to_etabs(path)
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


def test_what_the_text_cannot_hold_is_refused(tmp_path: Path) -> None:
    frame = braced()
    frame.add_node("twin", 0.0, 0.0, 3.0)
    frame.add_spring("joint", "0@3", "twin", (1e6, 2e6, 3e6, 4e5, 5e5, 6e5))
    with pytest.raises(ModelError, match=r'nodes "0@3" and "twin" stand at one place, which ETABS'):
        frame.to_etabs(tmp_path / "model.e2k")
    frame = braced()
    frame.add_superelement("part", ["mid"], np.eye(6), np.zeros((6, 6)))
    with pytest.raises(
        ModelError, match=r'has superelements \("part"\), which are not written for ETABS'
    ):
        frame.to_etabs(tmp_path / "model.e2k")
