"""Walls and slabs of shells written for SAP2000 and ETABS and read again are alike."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.testing import assert_allclose

from frames import Frame, ModelError
from frames.assembly.assemble import assemble
from frames.demo import bearing_for
from frames.model.superelement import no_elements
from frames.plots import model_view
from frames.viewer.structure import structure_of
from lir_element.opensees import opensees
from tests import etabs_models
from tests.fixed_base import periods, reactions
from tests.refusals import refused
from tests.unit.test_exchange_writing import same

MESH = 2.5
CASES = {"D": 1.0, "L": 1.0}


def walls(tmp_path: Path, **more: object) -> Frame:
    """Return a building with walls, a wall softer in bending and one stiffer, from ETABS' text."""
    text = etabs_models.building(bays=(2, 1), storeys=1, walls=True)
    for wall, word, factor in (("W1", "M", 0.25), ("W4", "F", 0.35)):
        line = f'AREAASSIGN  "{wall}"  "Story1"  SECTION "WALL"'
        assert line in text
        factors = "  ".join(f"PROPMOD{word}{d} {factor}" for d in ("11", "22", "12"))
        text = text.replace(line, f"{line}  {factors}", 1)
    path = tmp_path / "walls.e2k"
    path.write_text(text, encoding="utf-8")
    opensees().wipe()
    return Frame.from_etabs(path, mesh=MESH, **more)  # type: ignore[arg-type]


def test_walls_come_back_as_they_were(tmp_path: Path) -> None:
    frame = walls(tmp_path)
    shells = frame.superelements["shells"].elements.shells
    assert_allclose(sorted({shell.bending for shell in shells}), [0.25, 1.0 / 0.35])
    figure = model_view(frame)
    assert any(isinstance(c, Poly3DCollection) for c in figure.axes[0].collections)
    assert "shells" in [text.get_text() for text in figure.legends[0].get_texts()]
    system = assemble(frame)
    corners = structure_of(frame, system)["shells"]
    assert [tuple(system.node_names[k] for k in each) for each in corners] == [
        shell.nodes for shell in shells
    ]
    tables, text = tmp_path / "again.s2k", tmp_path / "again.e2k"
    frame.to_sap2000(tables, units="Kip, in, F")
    names = frame.to_etabs(text, units="Kip, in, F")
    back = Frame.from_sap2000(tables, mesh=MESH, loads=CASES)
    same(frame, back)
    assert_allclose(periods(back, 6), periods(frame, 6), rtol=1e-9)
    expected = reactions(frame)
    for node, forces in reactions(back).items():
        assert_allclose(forces, expected[node], atol=1e-9 * np.abs(frame.check().weight))
    other = Frame.from_etabs(text, mesh=MESH, loads=CASES)
    same(frame, other, names)
    assert "PANEL  4" in text.read_text(encoding="utf-8")
    assert 'OBJMESHTYPE "NOAUTOMESH"' in text.read_text(encoding="utf-8")
    assert tables.read_text(encoding="utf-8").count("NumJoints=4") == len(shells)


def test_a_semirigid_floor_on_bearings_comes_back(tmp_path: Path) -> None:
    opensees().wipe()
    text = etabs_models.building(bays=(1, 1), storeys=1).replace("TYPE RIGID", "TYPE SEMIRIGID")
    path = tmp_path / "floor.e2k"
    path.write_text(text, encoding="utf-8")
    frame = Frame.from_etabs(path, bearing_for(400e3), mesh=MESH)
    again = tmp_path / "again.s2k"
    frame.to_sap2000(again, displacement=0.2)
    back = Frame.from_sap2000(again, mesh=MESH, loads=CASES)
    assert list(back.bearings) == list(frame.bearings)
    one, two = (part.superelements["shells"].stiffness for part in (frame, back))
    assert frame.superelements["shells"].nodes == back.superelements["shells"].nodes
    assert abs(one - two).max() <= 1e-12 * abs(one).max()
    names = frame.to_etabs(tmp_path / "again.e2k", displacement=0.2)
    assert "FLOOR  4" in (tmp_path / "again.e2k").read_text(encoding="utf-8")
    assert set(names) >= set(frame.nodes)


def test_shells_that_would_be_read_otherwise_are_refused(tmp_path: Path) -> None:
    frame = walls(tmp_path)
    shell = frame.superelements["shells"].elements.shells[0]
    frame.add_diaphragm("odd", list(shell.nodes[:2]))
    frame.to_sap2000(tmp_path / "fine.s2k")
    own = shell._replace(nodes=tuple("0123"))

    def plate(mass: np.ndarray) -> Frame:
        floor = Frame("floor")
        for k, (x, y) in enumerate(((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))):
            floor.add_node(str(k), x, y, 0.0)
        parts = no_elements(shells=[own])
        floor.add_superelement("plate", list("0123"), np.eye(24), mass, elements=parts)
        return floor

    floor = plate(np.zeros((24, 24)))
    floor.add_diaphragm("deck", list("0123"))
    words = r'lies within the rigid diaphragm "deck", and SAP2000'
    refused(ModelError, words, floor.to_sap2000, tmp_path / "model.s2k")
    words = r'has superelements \("plate"\), which cannot be written'
    refused(ModelError, words, plate(np.eye(24)).to_etabs, tmp_path / "model.e2k")
