"""Areas over several bays: what they enclose is in their diaphragm, and met by their mesh."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError
from frames.exchange.building import AreaObject
from frames.exchange.mesh import joints_within
from lir_element.opensees import opensees
from tests import etabs_models, sap2000_models
from tests.unit.test_exchange_writing import same as alike

PARTS = etabs_models.building(bays=(2, 2), storeys=1)


def whole(text: str = PARTS) -> str:
    """Return the text with one floor over all bays, whose corners are points 1, 3, 9 and 7."""
    text = re.sub(r'  (AREA|AREAASSIGN|AREALOAD) +"F[245]".*\n?', "", text)
    floor = '  AREA "F1"  FLOOR  4  "1"  "3"  "9"  "7"  0  0  0  0'
    return re.sub(r'  AREA "F1"  FLOOR.*', floor, text, count=1)


def frame_of(tmp_path: Path, text: str, mesh: float = 2.6, **more: object) -> Frame:
    path = tmp_path / "model.e2k"
    path.write_text(text, encoding="utf-8")
    opensees().wipe()
    return Frame.from_etabs(path, mesh=mesh, **more)  # type: ignore[arg-type]


def same(one: Frame, two: Frame) -> None:
    # nodes by their places: those of a mesh have other names
    places = {tuple(np.round(n.position, 6)): name for name, n in two.nodes.items()}
    names = {name: places[tuple(np.round(n.position, 6))] for name, n in one.nodes.items()}
    assert len(set(names.values())) == len(two.nodes)
    alike(one, two, names, within=1e-9)


def test_a_floor_over_all_bays_is_that_of_its_parts(tmp_path: Path) -> None:
    frame = frame_of(tmp_path, whole())
    assert set(frame.diaphragms["D1-Story1"].nodes) == {f"{k}-Story1" for k in range(1, 10)}
    same(frame, frame_of(tmp_path, PARTS))


@pytest.mark.parametrize("below", [0.0004, 0.0008, 0.001])
def test_a_floor_has_the_joints_at_its_elevation(tmp_path: Path, below: float) -> None:
    text = re.sub(r'(POINT "5" .*)', rf"\1 {below}", whole(), count=1)
    frame = frame_of(tmp_path, text)
    assert "5-Story1" in frame.diaphragms["D1-Story1"].nodes


def test_a_semirigid_floor_meets_the_columns_within_it(tmp_path: Path) -> None:
    soft = whole().replace("TYPE RIGID", "TYPE SEMIRIGID")
    frame = frame_of(tmp_path, soft)
    assert "joints within shells, met by their mesh: 5-Story1" in str(frame.imported)
    assert "5-Story1" in frame.superelements["shells"].nodes
    same(frame, frame_of(tmp_path, PARTS.replace("TYPE RIGID", "TYPE SEMIRIGID")))


def test_meshes_that_cross_are_joined(tmp_path: Path) -> None:
    # a floor over all bays, and another one from its middle on: their nodes are the same
    floor = '  AREA "F2"  FLOOR  4  "5"  "6"  "9"  "8"  0  0  0  0'
    text = whole().replace("TYPE RIGID", "TYPE SEMIRIGID")
    text = text.replace("$ POINT ASSIGNS", f"{floor}\n\n$ POINT ASSIGNS")
    assign = '  AREAASSIGN  "F2"  "Story1"  SECTION "SLAB"\n\n$ LOAD PATTERNS'
    frame = frame_of(tmp_path, text.replace("$ LOAD PATTERNS", assign))
    places = [tuple(np.round(node.position, 6)) for node in frame.nodes.values()]
    assert len(set(places)) == len(places)


def test_a_mesh_of_too_many_elements_is_refused(tmp_path: Path) -> None:
    soft = whole().replace("TYPE RIGID", "TYPE SEMIRIGID")
    with pytest.raises(ModelError, match=r"have \d+ elements with mesh=0.01 \(at most 20000\)"):
        frame_of(tmp_path, soft, mesh=0.01)


def test_disconnected_joints_are_in_no_diaphragm(tmp_path: Path) -> None:
    lines = [f'  POINTASSIGN  "{k}"  "Story1"  DIAPH "DISCONNECTED"' for k in (5, 8)]
    text = whole().replace("$ POINT ASSIGNS", "\n".join(["$ POINT ASSIGNS", *lines]), 1)
    text = text.replace("$ POINT ASSIGNS", '$ POINT ASSIGNS\n  POINTASSIGN "2" "Story1" DIAPH "D2"')
    text = text.replace('DIAPHRAGM "D1"', 'DIAPHRAGM "D2"  TYPE RIGID\n  DIAPHRAGM "D1"', 1)
    frame = frame_of(tmp_path, text)
    inside = {f"{k}-Story1" for k in (1, 3, 4, 6, 7, 9)}
    assert set(frame.diaphragms["D1-Story1"].nodes) == inside


def test_decks_in_no_diaphragm_are_refused_or_rigid(tmp_path: Path) -> None:
    deck = 'SHELLPROP  "SLAB"  PROPTYPE  "Slab"  MATERIAL "C30"  MODELINGTYPE "ShellThin"'
    assert deck in PARTS
    one_way = deck.replace("ShellThin", "Membrane") + '  ONEWAYLOADDIST "Yes"'
    tied = whole().replace(deck, one_way, 1)
    loose = tied.replace('DIAPH "D1"', "", 1)
    with pytest.raises(ModelError, match=r'one-way decks.*F1-Story1.*allow=\["loose decks"\]'):
        frame_of(tmp_path, loose)
    frame = frame_of(tmp_path, loose, allow=["loose decks"])
    nodes = set(frame_of(tmp_path, tied).diaphragms["D1-Story1"].nodes)
    assert set(frame.diaphragms["decks-1"].nodes) == nodes
    assert "taken as rigid in their plane; accepted by allow" in str(frame.imported)


def test_shares_of_a_joint_are_those_of_the_bilinear_surface() -> None:
    plan = {"a": (0.0, 0.0), "b": (6.0, 0.0), "c": (5.0, 4.0), "d": (1.0, 3.0)}
    corners = {name: (*at, 1.0) for name, at in plan.items()}
    u, v = 0.3, 0.7
    weights = ((1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v)
    place = sum(w * np.array(p) for w, p in zip(weights, corners.values(), strict=True))
    x, y, z = place.tolist()
    area = AreaObject("F", tuple("abcd"), "", "here")
    points = {**corners, "in": (x, y, z), "above": (x, y, z + 0.1), "out": (9.0, 1.0, 1.0)}
    points |= {"edge": (3.0, 0.0, 1.0), "beside": (3.0, 5e-4, 1.0)}
    found = joints_within([area], points)["F"]
    assert list(found) == ["in"]
    assert_allclose(found["in"], (u, v), rtol=1e-9)


FLOOR = 'FLOOR  4  "1"  "3"  "9"  "7"  0  0  0  0'
POLYGONS = {
    # corners beyond those of the frame, and the floor over all bays
    "triangle": ('  POINT "10"  5.0 20.0', 'FLOOR  3  "1"  "3"  "10"  0  0  0', 0.5 * 12.0 * 20.0),
    "pentagon": (
        '  POINT "10"  6.0 12.0',
        'FLOOR  5  "1"  "3"  "9"  "10"  "7"  0  0  0  0  0',
        12.0 * 10.0 + 0.5 * 12.0 * 2.0,
    ),
}


@pytest.mark.parametrize(("point", "floor", "size"), POLYGONS.values(), ids=list(POLYGONS))
def test_polygons_are_shells_that_meet_the_joints_within(tmp_path, point, floor, size):
    soft = whole().replace("TYPE RIGID", "TYPE SEMIRIGID")
    text = soft.replace(FLOOR, floor).replace("\n\n$ LINE CONN", f"\n{point}\n\n$ LINE CONN", 1)
    frame = frame_of(tmp_path, text)
    shells = frame.superelements["shells"]
    assert {len(shell.nodes) for shell in shells.elements.shells} == {4}
    assert "5-Story1" in shells.nodes
    bare = frame_of(tmp_path, re.sub(r"  AREA(LOAD|ASSIGN)? +\"F1\".*\n", "", text))
    own = (25e3 * 0.15 + 0.3 * 3e3) * size  # by hand: 15 cm, and the share of the live load
    assert_allclose(frame.check().weight - bare.check().weight, own, rtol=1e-9)


def test_polygons_whose_centre_does_not_see_all_edges_are_refused(tmp_path: Path) -> None:
    soft = whole().replace("TYPE RIGID", "TYPE SEMIRIGID")
    points = '  POINT "10"  11.0 1.0\n  POINT "11"  1.0 1.0'
    floor = 'FLOOR  6  "1"  "3"  "9"  "10"  "11"  "7"  0  0  0  0  0  0'
    text = soft.replace(FLOOR, floor).replace("\n\n$ LINE CONN", f"\n{points}\n\n$ LINE CONN", 1)
    with pytest.raises(ModelError, match=r'"F1-Story1" is a shell of 6 corners with a reentrant'):
        frame_of(tmp_path, text)


@pytest.mark.parametrize("word", ['"SPRINGK3"  10000', 'SPRINGPROP "AS1"'])
def test_springs_under_areas_are_refused(tmp_path: Path, word: str) -> None:
    text = whole().replace('SECTION "SLAB"', f'SECTION "SLAB"  {word}', 1)
    with pytest.raises(ModelError, match=r'springs under areas.*allow=\["line and area springs"\]'):
        frame_of(tmp_path, text)


def test_areas_of_sap2000_touch_joints_at_corners_and_edges_alone(tmp_path: Path) -> None:
    tables = sap2000_models.building(bays=(2, 2), storeys=1)
    del tables["CONSTRAINT DEFINITIONS - DIAPHRAGM"], tables["JOINT CONSTRAINT ASSIGNMENTS"]
    joints = {k: 9 + k for k in (1, 3, 9, 7)}
    area = {"Area": "S10", "NumJoints": 4}
    area |= {f"Joint{k}": j for k, j in enumerate(joints.values(), start=1)}
    tables["CONNECTIVITY - AREA"] = [area]
    for table in ("AREA SECTION ASSIGNMENTS", "AREA LOADS - UNIFORM"):
        tables[table] = [row | {"Area": "S10"} for row in tables[table][:1]]
    path = tmp_path / "model.s2k"
    path.write_text(sap2000_models.text(tables), encoding="utf-8")
    opensees().wipe()
    frame = Frame.from_sap2000(path, mesh=2.6)
    said = "joints within shells that do not touch them, as in the program: 14"
    assert said in str(frame.imported)
    assert "14" not in frame.superelements["shells"].nodes
