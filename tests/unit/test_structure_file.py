"""The building in a project's file: sections by storey and direction."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("typer")

from frames import Frame, ModalDamping, moment_frame
from frames.demo import bearing_for
from frames.design import ProjectError
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.sanity_checks import file_doubts
from frames.design.project.structure_statement import structure_rows
from frames.risk.campaign.ductility import yield_rotations
from tests.scenes import BOUNDS, DEVICE, MOTIONS, project_head

SPECTRUM = "[spectrum]\ns_ms = 1.0\ns_m1 = 0.5\n"
REST = project_head("A building", "ASCE 7-22") + DEVICE + SPECTRUM + MOTIONS + BOUNDS
GRID = """
[structure]
kind = "moment frame"
bays = [2, 1]
bay_width = ["6 m", "5 m"]
storeys = 3
storey_height = "3.5 m"
floor_load = "1000 kg/m2"
"""
MEMBERS = """
columns = { rectangle = ["400 mm", "600 mm"], material = "C30/37" }
beams = { rectangle = ["300 mm", "500 mm"], material = "C30/37" }
base_beams = { rectangle = ["500 mm", "800 mm"], material = "C30/37" }
"""
C30 = 22e9 * 3.8**0.3  # Pa, EN 1992-1-1 table 3.1


def parts_of(folder: Path, structure: str) -> ProjectInputs:
    """Return a project with a structure."""
    (folder / "project.toml").write_text(REST + structure)
    return ProjectInputs(read_project(folder / "project.toml"), folder)


def frame_of(folder: Path, structure: str) -> Frame:
    """Return the frame of a structure."""
    return parts_of(folder, structure).frame()


def test_without_sections_it_is_the_ready_made_frame(tmp_path: Path) -> None:
    """Node for node and member for member, by another way of building it."""
    parts = parts_of(tmp_path, GRID + "eccentricity = [0.05, 0.02]\n")
    ours = parts.frame()
    theirs = moment_frame(
        (2, 1),
        3,
        bearing=parts.bearing(),
        bay_width=(6.0, 5.0),
        floor_load=1000.0,
        eccentricity=(0.05, 0.02),
    )
    for kind in ("nodes", "members", "bearings", "diaphragms"):
        assert list(getattr(ours, kind).items()) == list(getattr(theirs, kind).items())
    assert ours.levels == theirs.levels
    assert all((ours.masses[n] == mass).all() for n, mass in theirs.masses.items())
    (doubt,) = file_doubts(parts.file)
    assert "columns and beams and base_beams: example sections" in doubt


def test_sections_are_those_of_the_file(tmp_path: Path) -> None:
    """Sides of columns along x and y, width and depth of beams; constants by hand."""
    frame = frame_of(tmp_path, GRID + MEMBERS)
    column, beam = (frame.members[name].section for name in ("column-2-1-0", "beam-y-floor-2-1-0"))
    # local z of a column is global x: bending in x has the side along x as its depth
    assert column.inertia_y == pytest.approx(0.6 * 0.4**3 / 12.0)
    assert column.inertia_z == pytest.approx(0.4 * 0.6**3 / 12.0)
    assert beam.inertia_y == pytest.approx(0.3 * 0.5**3 / 12.0)
    assert column.elastic_modulus == pytest.approx(C30)
    assert column.shear_modulus == pytest.approx(C30 / 2.4)
    assert frame.members["beam-x-base-0-0"].section.area == pytest.approx(0.4)


def test_mass_is_that_of_floors_and_members(tmp_path: Path) -> None:
    """In all, by hand: plan times floor load, and volumes of the members times density."""
    frame = frame_of(tmp_path, GRID + MEMBERS)
    floors = 4 * 12.0 * 5.0 * 1000.0
    columns = 6 * 3 * 3.5 * 0.4 * 0.6
    each = 2 * 12.0 + 3 * 5.0  # m of beams on a level
    members = 2500.0 * (columns + each * (3 * 0.3 * 0.5 + 0.5 * 0.8))
    assert frame.check().mass == pytest.approx(floors + members)


def test_sections_by_storey_and_direction(tmp_path: Path) -> None:
    """Lists of tables; `lir check` says which storeys have which."""
    text = """
[[structure.columns]]
storeys = [1, 1]
box = ["500 mm", "400 mm", "20 mm"]
material = "S355"
depth_along = "y"
[[structure.columns]]
storeys = [2, 3]
box = ["400 mm", "20 mm"]
material = "S355"
[[structure.beams]]
direction = "x"
i_shape = ["500 mm", "200 mm", "16 mm", "10 mm"]
[[structure.beams]]
direction = "y"
i_shape = ["400 mm", "180 mm", "14 mm", "9 mm"]
[structure.base_beams.properties]
area = "250 cm2"
inertia_y = "400000 cm4"
inertia_z = "20000 cm4"
torsion_constant = "900 cm4"
[structure.base_beams.material]
E = "205 GPa"
G = "80 GPa"
density = "7850 kg/m3"
"""
    parts = parts_of(tmp_path, GRID + text)
    frame = parts.frame()
    sections = {name: member.section for name, member in frame.members.items()}
    low, high = sections["column-1-0-0"], sections["column-3-0-0"]
    assert low.area == pytest.approx(0.5 * 0.4 - 0.46 * 0.36)
    assert high.area == pytest.approx(0.4**2 - 0.36**2)
    assert frame.members["column-1-0-0"].up == (0.0, 1.0, 0.0)
    assert low.elastic_modulus == 210e9
    along_x, along_y = sections["beam-x-floor-1-0-0"], sections["beam-y-floor-1-0-0"]
    assert along_x.area == pytest.approx(2 * 0.2 * 0.016 + 0.468 * 0.01)
    assert along_y.area == pytest.approx(2 * 0.18 * 0.014 + 0.372 * 0.009)
    base = sections["beam-x-base-0-0"]
    assert (base.inertia_y, base.shear_modulus) == (pytest.approx(4e-3), 80e9)
    assert math.isinf(base.shear_area_y)
    rows = dict(structure_rows(parts.file, frame))
    assert rows["columns, storey 1"] == "box 500 x 400 x 20 mm, S355 (E 210 GPa)"
    assert rows["columns, storeys 2 to 3"] == "box 400 x 400 x 20 mm, S355 (E 210 GPa)"
    assert rows["beams along y"] == "I 400 x 180 x 14 x 9 mm, A992 (E 200 GPa)"
    assert rows["base beams"] == "given constants, own material (E 205 GPa)"
    assert not file_doubts(parts.file)


def test_a_column_of_the_catalogue_turned(tmp_path: Path) -> None:
    """HEB 300: 149.1 cm2, 25 170 cm4 and 8563 cm4 as in its tables; depth along y."""
    pytest.importorskip("steel_sections")
    text = MEMBERS.replace(
        'columns = { rectangle = ["400 mm", "600 mm"], material = "C30/37" }',
        'columns = { section = "HEB 300", material = "S355", depth_along = "y" }',
    )
    member = frame_of(tmp_path, GRID + text).members["column-1-0-0"]
    constants = [member.section.area, member.section.inertia_y, member.section.inertia_z]
    assert constants == pytest.approx([149.1e-4, 25170e-8, 8563e-8], rel=1e-3)
    assert member.up == (0.0, 1.0, 0.0)  # local z, along which the depth is


HINGED = """
[[structure.columns]]
box = ["300 mm", "500 mm", "16 mm"]
hinges = { yield_stress = "345 MPa", hardening = 0.02 }
[[structure.columns]]
at = ["1-0"]
storeys = [1, 1]
rectangle = ["3 m", "300 mm"]
material = "C30/37"
faces = true
hinges = { moment_y = "5 MN m", ends = "foot", yield_rotation = "0.0025 rad" }
[[structure.columns]]
at = ["1-0"]
storeys = [2, 3]
rectangle = ["3 m", "300 mm"]
material = "C30/37"
faces = true
[structure.beams]
i_shape = ["400 mm", "180 mm", "13.5 mm", "8.6 mm"]
hinges = { yield_stress = "345 MPa" }
"""


def numeric_modulus(inside: Callable[..., Any], width: float, depth: float) -> float:
    """Return the plastic modulus about y by adding up |z| over a fine grid."""
    y, z = (side * ((np.arange(2000) + 0.5) / 2000 - 0.5) for side in (width, depth))
    over = inside(np.abs(y)[:, None], np.abs(z)[None, :])
    return float((over * np.abs(z)[None, :]).sum() * width * depth / 2000**2)


def test_plastic_hinges_of_shapes_and_columns_on_their_lines(tmp_path: Path) -> None:
    """Plastic moments by a sum over the section; a wall of 3 m with a hinge at its foot."""
    frame = frame_of(tmp_path, GRID + HINGED)
    foot, head = frame.hinges["column-2-0-0"]
    assert foot == head
    assert foot is not None
    # of columns the first side is along x, which is local z
    hollow = lambda y, z: (y > 0.234) | (z > 0.134)  # noqa: E731
    strength = 345e6 * numeric_modulus(hollow, 0.5, 0.3)
    assert foot.moment_y == pytest.approx(strength, rel=5e-3)
    turned = 345e6 * numeric_modulus(lambda y, z: (y > 0.134) | (z > 0.234), 0.3, 0.5)
    assert foot.moment_z == pytest.approx(turned, rel=5e-3)
    assert foot.axial == pytest.approx(345e6 * (0.3 * 0.5 - 0.268 * 0.468))
    (beam, _) = frame.hinges["beam-x-floor-1-0-0"]
    assert beam is not None
    shape = lambda y, z: (z > 0.1865) | (y < 0.0043)  # noqa: E731
    assert beam.moment_y == pytest.approx(345e6 * numeric_modulus(shape, 0.18, 0.4), rel=5e-3)
    assert beam.axial == math.inf
    assert not [name for name in frame.hinges if "base" in name]
    wall, above = frame.hinges["column-1-1-0"]
    assert (wall.moment_y, wall.moment_z, above) == (5e6, math.inf, None)  # type: ignore[union-attr]
    assert "column-2-1-0" not in frame.hinges
    assert frame.members["column-3-1-0"].section.inertia_y == pytest.approx(0.3 * 3.0**3 / 12.0)
    first, second, across = (
        frame.members[f"beam-{n}"].offsets for n in ("x-base-0-0", "x-base-1-0", "y-floor-3-1-0")
    )
    assert (first[1], second[0]) == ((-1.5, 0.0, 0.0), (1.5, 0.0, 0.0))
    assert not any(map(any, (first[0], second[1], *across)))
    yields = yield_rotations(frame)
    assert yields["column-1-1-0:i"] == 0.0025
    inertia = (0.18 * 0.4**3 - (0.18 - 0.0086) * 0.373**3) / 12.0
    at_yield = beam.moment_y * 4.5 / (6.0 * 200e9 * inertia)  # between the axis and the face
    assert yields["beam-x-floor-1-0-0:j"] == pytest.approx(at_yield)
    said = dict(structure_rows(parts_of(tmp_path, GRID + HINGED).file, frame))
    assert "with plastic hinges" in str(said["columns"])


def test_cracked_sections(tmp_path: Path) -> None:
    """One factor on bending, torsion and shear, or one for each; area and mass stay."""
    one = MEMBERS.replace('"C30/37" }', '"C30/37", cracked = 0.5 }', 1)
    each = MEMBERS.replace(
        '"C30/37" }', '"C30/37", cracked = { bending = 0.35, torsion = 0.1, shear = 1.0 } }', 1
    )
    whole, half, parts = (
        frame_of(tmp_path, GRID + text).members["column-1-0-0"].section
        for text in (MEMBERS, one, each)
    )
    assert half == whole.cracked(0.5)
    ratios = [
        getattr(parts, key) / getattr(whole, key)
        for key in ("inertia_y", "inertia_z", "torsion_constant", "shear_area_y", "area")
    ]
    assert np.allclose(ratios, [0.35, 0.35, 0.1, 1.0, 1.0])


def test_damping_of_the_structure(tmp_path: Path) -> None:
    """Two per cent in each mode if nothing is said; none at 0."""
    found = [
        frame_of(tmp_path, GRID + MEMBERS + text).damping
        for text in ("", "damping = 0.05\n", 'damping = "3 %"\n', "damping = 0\n")
    ]
    assert found == [ModalDamping(0.02), ModalDamping(0.05), ModalDamping(0.03), None]
    with pytest.raises(ProjectError, match=r"structure\.damping = 5"):
        frame_of(tmp_path, GRID + MEMBERS + "damping = 5\n")


COLUMNS = 'columns = { rectangle = ["400 mm", "600 mm"], material = "C30/37" }'
REFUSED = {
    'columns = { rectangle = ["400 mm", "600 mm"] }': "rectangle needs its material",
    'columns = { box = ["400 mm", "25 mm"], circle = "300 mm" }': "box and circle: write one",
    'columns = { material = "S355" }': 'has no section: section = "HEB 300"',
    'columns = { section = "HEB 305" }': 'no rolled shape "HEB 305"',
    'columns = { box = ["400 mm", "25 mm"], material = "S356" }': 'is "S355" meant?',
    'columns = { circle = "300 mm", material = { E = "30 GPa", nu = 0.2 } }': "density is missing",
    'columns = { circle = "300 mm", material = { E = "30 GPa", density = "2500 kg/m3" } }': (
        "needs one of nu and G"
    ),
    'columns = { circle = "1 m", material = { E = "9 GPa", G = "9 GPa", density = "0 t/m3" } }': (
        "Poisson's ratio -0.5"
    ),
    'columns = { circle = "300 mm", material = "C30/37", cracked = 1.5 }': "must lie in (0, 1]",
    'columns = { circle = "300 mm", material = "C30/37", depth_along = "y" }': (
        "depth_along has no effect on circle"
    ),
    'columns = { box = ["400 mm", "250 mm"] }': "walls overlap",
    'columns = { box = ["400 mm", 25] }': "has no unit",
    "columns = [3, 2]": "write [[structure.columns]] and its keys below for each",
    'columns = { boxes = ["400 mm", "25 mm"] }': 'boxes is not known; is "box" meant?',
    'columns = [{ box = ["400 mm", "25 mm"], storeys = [1, 2] }]': "storey 3 has no section",
    'columns = [{ box = ["400 mm", "25 mm"] }, { circle = "1 m", material = "S355" }]': (
        "storey 1 has two sections"
    ),
    'columns = { box = ["400 mm", "25 mm"], hinges = { hardening = 0.1 } }': "yield_stress =",
    'columns = { box = ["400 mm", "25 mm"], faces = true }': "faces = true, beams end at the faces",
    'columns = [{ box = ["400 mm", "25 mm"], at = ["3-0"] }]': 'at = "3-0" is no column',
    'columns = [{ box = ["400 mm", "25 mm"], at = ["0-0", "0-0"] }]': 'of column "0-0" has two',
    'columns = { box = ["400 mm", "25 mm"], storeys = [2, 4] }': "within 1 to 3: write",
    'columns = { box = ["400 mm", "25 mm"], storeys = [0, 3] }': "storeys",
}


@pytest.mark.parametrize(("text", "said"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_refused(tmp_path: Path, text: str, said: str) -> None:
    """Each with what is wrong and what to write."""
    if "HEB" in text:
        pytest.importorskip("steel_sections")
    with pytest.raises(ProjectError) as told:
        frame_of(tmp_path, GRID + MEMBERS.replace(COLUMNS, text))
    assert said in str(told.value)
    assert "structure" in str(told.value)


def test_sections_of_beams_that_are_refused(tmp_path: Path) -> None:
    """A direction without a section, base beams of a storey, beams that are turned."""
    beams = 'beams = { rectangle = ["300 mm", "500 mm"], material = "C30/37" }'
    for new, said in (
        (beams.replace(" }", ', direction = "x" }'), "storey 1, beams along y, has no section"),
        ('beams = { box = ["1 m", "9 mm"], depth_along = "x" }', "the depth of beams is vertical"),
        (f"{beams}\n" + "bay = 3", "bay is not known"),
    ):
        with pytest.raises(ProjectError) as told:
            frame_of(tmp_path, GRID + MEMBERS.replace(beams, new))
        assert said in str(told.value)
    base = MEMBERS.replace(
        '"800 mm"], material = "C30/37"', '"800 mm"], material = "C30/37", storeys = [1, 1]'
    )
    with pytest.raises(ProjectError, match="which are at the base: leave it out"):
        frame_of(tmp_path, GRID + base)


PAGE = Path(__file__).parents[2] / "docs/structure.md"
BLOCKS = re.findall(r"```toml\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)
TABLES = re.findall(
    r"`(\w+\.csv)`:\n\n```text\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL
)


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_examples_of_the_page(tmp_path: Path, block: str) -> None:
    """Each is a building whose mass the bearings carry."""
    pytest.importorskip("steel_sections")
    for name, table in TABLES:
        (tmp_path / name).write_text(table)
    parts = parts_of(tmp_path, block)
    checked = parts.frame().check()
    assert checked.carried == pytest.approx(checked.weight)
    assert not checked.failure
    assert not file_doubts(parts.file)


def test_bearings_may_differ_afterwards(tmp_path: Path) -> None:
    """Names of bearings are those of the columns' lines."""
    frame = frame_of(tmp_path, GRID + MEMBERS)
    other = bearing_for(500e3)
    changed = frame.with_bearings({"bearing-1-0": other})
    assert changed.bearings["bearing-1-0"].bearing is other
