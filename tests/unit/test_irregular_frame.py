"""Buildings from tables of columns and beams: plans like an L, setbacks, towers; refusals."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from frames import gravity
from frames.command.app import app
from frames.design import ProjectError
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import inputs_of, preliminary
from frames.design.project.sanity_checks import file_doubts
from frames.design.project.structure_statement import structure_rows
from tests.refusals import refused
from tests.unit.test_structure_file import GRID, MEMBERS, parts_of

STRUCTURE = """
[structure]
kind = "irregular frame"
storey_height = ["4 m", "3.5 m", "3.5 m"]
columns_table = "columns.csv"
beams_table = "beams.csv"
[structure.sections.C]
rectangle = ["400 mm", "600 mm"]
material = "C30/37"
[structure.sections.B]
rectangle = ["300 mm", "500 mm"]
material = { E = "30 GPa", nu = 0.2, density = "0 kg/m3" }
"""
COLUMNS = """name,x [m],y [m],storeys,section,depth_along
A1,0,0,,C,
A2,6,0,,C,
A3,12,0,,C,
B1,0,5,,C,
B2,6,5,,C,
B3,12,5,,C,
C1,0,10,1-2,C,
C2,6,10,1 to 2,C,
"""
BEAMS = """from,to,floors,section
A1,A2,,B
A2,A3,,B
B1,B2,,B
B2,B3,,B
C1,C2,0-2,B
A1,B1,,B
A2,B2,,B
A3,B3,,B
B1,C1,0-2,B
B2,C2,0-2,B
"""
NAMES = "Members.csv", "bearings.csv", "bench.csv"
LOADS = '[loads]\ndead = "5 kN/m2"\n'


def project(
    folder: Path, columns=COLUMNS, beams=BEAMS, rest=LOADS, structure=STRUCTURE
) -> ProjectInputs:
    """Return a project with its tables."""
    (folder / "columns.csv").write_text(columns)
    (folder / "beams.csv").write_text(beams)
    return parts_of(folder, structure + rest)


def test_an_l_with_a_setback_by_hand(tmp_path: Path) -> None:
    """Mass, weight and centre of mass: fields of 30 m2, the one at the back a storey lower."""
    parts = project(tmp_path)
    frame = parts.frame()
    checked = frame.check()
    floors = 5e3 * (3 * 90.0 + 60.0)
    columns = 2500.0 * 9.80665 * 0.4 * 0.6 * (6 * 11.0 + 2 * 7.5)
    assert checked.weight == pytest.approx(floors + columns)
    assert checked.carried == pytest.approx(checked.weight)
    system = gravity(frame).system
    mass, places = system.node_mass[:, 0], system.coordinates
    fields = [(3.0, 2.5, 4), (9.0, 2.5, 4), (3.0, 7.5, 3)]  # middle, and how many levels
    moment = sum(np.array([x, y]) * n * 30.0 * 5e3 for x, y, n in fields)
    tall = [(x, y) for y in (0.0, 5.0) for x in (0.0, 6.0, 12.0)]
    weight = 2500.0 * 9.80665 * 0.24
    moment = moment + weight * (11.0 * np.sum(tall, axis=0) + 7.5 * np.array([6.0, 20.0]))
    centre = mass @ places[:, :2] / mass.sum()
    assert centre == pytest.approx(moment / (floors + columns))
    assert list(frame.bearings) == [
        f"bearing-{n}" for n in ["A1", "A2", "A3", "B1", "B2", "B3", "C1", "C2"]
    ]
    assert "column-3-C1" not in frame.members
    assert frame.levels[3].z - frame.levels[0].z == pytest.approx(11.0)
    assert dict(structure_rows(parts.file, frame))["structure"] == (
        "irregular frame, 3 storeys on 8 bearings"
    )


def test_the_wing_has_a_roof_of_its_own(tmp_path: Path) -> None:
    """Snow and roof loads lie where no floor is above, also a storey lower."""
    rest = LOADS + 'live = "2 kN/m2"\nsnow = "1.5 kN/m2"\n'
    rest += 'roof = { dead = "3 kN/m2", live = "0 kN/m2" }\n'
    parts = project(tmp_path, rest=rest)
    loads = parts.loaded_frame().floor_loads
    snow = {name for name, load in loads.items() if load.case == "S"}
    assert {name.rpartition("-")[0] for name in snow} == {"S-floor-3", "S-floor-2"}
    assert len(snow) == 3
    total = {case: sum(30.0 * x.q for x in loads.values() if x.case == case) for case in "DLS"}
    assert total == pytest.approx(
        {"D": 30.0 * (8 * 5e3 + 3 * 3e3), "L": 30.0 * 8 * 2e3, "S": 30.0 * 3 * 1.5e3}
    )
    rows = dict(structure_rows(parts.file, parts.frame()))
    assert rows["loaded area"] == "base to floor-2 90 m², floor-3 60 m²"
    assert rows["members"] == "37 beams, 22 columns"


def test_a_grid_from_tables_is_the_regular_frame(tmp_path: Path) -> None:
    """The same axial forces to the last but few digits."""
    columns, beams = "name,x,y,section\n", "from,to,floors,section\n"
    for ix in range(3):
        for iy in range(2):
            columns += f"{ix}-{iy},{6 * ix} m,{500 * iy} cm,C\n"
            for jx, jy in ((ix + 1, iy), (ix, iy + 1)):
                if jx < 3 and jy < 2:
                    beams += f"{ix}-{iy},{jx}-{jy},0,base\n{ix}-{iy},{jx}-{jy},1-3,B\n"
    sections = """
[structure.sections]
C = { rectangle = ["400 mm", "600 mm"], material = "C30/37" }
B = { rectangle = ["300 mm", "500 mm"], material = "C30/37" }
base = { rectangle = ["500 mm", "800 mm"], material = "C30/37" }
"""
    head = STRUCTURE.partition("[structure.sections.C]")[0].replace('"4 m"', '"3.5 m"')
    load = '[loads]\ndead = "4 kN/m2"\nlive = "2 kN/m2"\n'
    ours = project(tmp_path, columns, beams, sections + load, head).frame()
    regular = GRID.replace('floor_load = "1000 kg/m2"\n', "") + MEMBERS + load
    theirs = parts_of(tmp_path, regular).frame()
    one, two = gravity(ours), gravity(theirs)
    assert list(ours.bearings) == list(theirs.bearings)
    assert one.axial_forces == pytest.approx(two.axial_forces)
    assert one.held_periods[0] == pytest.approx(two.held_periods[0])


def test_floor_load_is_dead_load_that_is_mass(tmp_path: Path) -> None:
    """The short way, on any plan."""
    short = STRUCTURE.replace(
        'beams_table = "beams.csv"', 'beams_table = "beams.csv"\nfloor_load = "500 kg/m2"'
    )
    checked = project(tmp_path, rest="", structure=short).frame().check()
    columns = 2500.0 * 0.4 * 0.6 * (6 * 11.0 + 2 * 7.5)
    assert checked.mass == pytest.approx(500.0 * (3 * 90.0 + 60.0) + columns)


def test_two_towers_are_two_diaphragms(tmp_path: Path) -> None:
    """Above a common base what no beam joins moves apart."""
    columns = "name,x,y,section\n"
    beams = "from,to,floors,section\n"
    for k, x in enumerate((0, 6, 16, 22)):
        columns += f"P{k},{x} m,0 m,C\nQ{k},{x} m,5 m,C\n"
        beams += f"P{k},Q{k},,B\n"
    for k, floors in enumerate(("", "0", "")):
        beams += f"P{k},P{k + 1},{floors},B\nQ{k},Q{k + 1},{floors},B\n"
    frame = project(tmp_path, columns, beams).frame()
    assert set(frame.diaphragms) == {"base"} | {
        name for k in (1, 2, 3) for name in (f"floor-{k}", f"floor-{k}-P2")
    }
    assert len(frame.diaphragms["floor-2-P2"].nodes) == 4


def test_a_column_may_begin_on_beams(tmp_path: Path) -> None:
    """A planted column on a storey that its beams reach; in the air it is refused."""
    planted = COLUMNS.replace("B2,6,5,,C,", "B2,6,5,2-3,C,")
    beams = BEAMS.replace("B1,B2,,B\nB2,B3,,B", "B1,B2,1-3,B\nB2,B3,1-3,B\nB1,B3,0,B")
    beams = beams.replace("A2,B2,,B", "A2,B2,1-3,B").replace("B2,C2,0-2,B", "B2,C2,1-2,B")
    frame = project(tmp_path, planted, beams).frame()
    assert "bearing-B2" not in frame.bearings
    assert frame.check().carried == pytest.approx(frame.check().weight)
    loose = project(tmp_path, planted, BEAMS)
    refused(ProjectError, 'no column on line "B2" starts or ends there', loose.frame)


def test_sections_of_rows_may_be_turned_or_of_the_catalogue(tmp_path: Path) -> None:
    pytest.importorskip("steel_sections")
    turned = COLUMNS.replace("A1,0,0,,C,", "A1,0,0,,HEB 300,y").replace(
        "A2,6,0,,C,", "A2,6,0,,HEB 300,x"
    )
    frame = project(tmp_path, turned).frame()
    assert frame.members["column-1-A1"].up == (0.0, 1.0, 0.0)
    assert frame.members["column-1-A2"].up is None
    assert frame.members["column-1-A1"].section.area == pytest.approx(149.1e-4, rel=1e-3)


def test_a_changed_table_is_another_input(tmp_path, put_example):
    """Results of other tables are not taken for those of these."""
    put_example(tmp_path)
    rest = LOADS
    first = project(tmp_path, rest=rest)
    known = preliminary(first)
    found = inputs_of(first, known)
    other = project(tmp_path, beams=BEAMS.replace("A1,A2,,B", "A2,A1,,B"), rest=rest)
    changed = inputs_of(other, known)
    assert {key for key in found if found[key] != changed[key]} == {"tables of members"}


FIRST, LAST = "A1,A2,,B", "C1,0,10,1-2,C,"
HEAD = "name,x [m],y [m],storeys,section,depth_along\n"
REFUSED_BEAMS = [
    (FIRST, "A1,Aa3,,B", 'no column "Aa3": is "A3" meant?'),
    (FIRST, "A1,A1,,B", "begins and ends at"),
    (FIRST, "A1,A2,,B\nA2,A1,1,B", "two beams join"),
    (FIRST, "A1,A2,,B\nA1,A3,1,B", "overlap or cross"),
    (FIRST, "A1,A2,,B\nA1,B2,1,B\nA2,B1,1,B", "overlap or cross"),
    (FIRST, "A1,A2,,D", 'section "D": there is no rolled shape'),
    (FIRST, "A1,A2,2-4,B", 'floors = "2-4" must be a storey'),
    (FIRST, "A1,A2,,", "section is empty"),
    (FIRST, "A1,A2,,B,3", "has 5 cells, its head 4"),
    ("from,to", "from,too", 'column "too" is not known'),
    ("C1,C2,0-2,B", "C1,C2,0-3,B", 'no column on line "C1"'),
]
REFUSED_COLUMNS = [
    (LAST, f"{LAST}\nD1,0,20,1,C,", "has no base beam"),
    ("C1,0,10,1-2", "C1,0,10,2-1", 'storeys = "2-1" must be a storey or a range'),
    (LAST, "C1,0,10,1,C,\nC1,0,10,3,C,", "is missing in storey 2"),
    (LAST, f"{LAST}\nC1,0,10,2,C,", "two sections in storey 2"),
    (LAST, "C1,0,10,1,C,\nC1,0,11,2,C,", "write one place for each name"),
    ("C1,0,10,", "C1,6.01,10,", 'columns "C1" and "C2" are both at'),
    ("C1,0,10,", "C1,left,10,", 'x = "left m" is not a number with a unit'),
    ("C1,0,10,", "C1,,10,", "x is empty"),
    (LAST, f"{LAST}z", 'choose one of "x", "y"'),
    ("x [m]", "x", 'x = "0" has no unit'),
    ("x [m]", "y [m]", 'column "y" occurs twice'),
    (HEAD, "", "is not known"),
    (HEAD, "name,y [m]\n", 'column "x" is missing'),
    (COLUMNS, "name,x [m],y [m],section\n\n", "has no rows"),
]


@pytest.mark.parametrize(("old", "new", "said"), REFUSED_BEAMS + REFUSED_COLUMNS)
def test_tables_that_are_refused(tmp_path, old, new, said):
    """Each with file, line and what to write."""
    pytest.importorskip("steel_sections")
    table, text = ("beams", BEAMS) if (old, new, said) in REFUSED_BEAMS else ("columns", COLUMNS)
    assert old in text
    changed = {table: text.replace(old, new, 1)}
    refused(ProjectError, re.escape(said), lambda: project(tmp_path, **changed).frame())


def test_files_that_are_not_there_or_are_no_text(tmp_path: Path) -> None:
    parts = project(tmp_path)
    (tmp_path / "beams.csv").unlink()
    refused(ProjectError, "give a CSV file with from, to, section", parts.frame)
    (tmp_path / "columns.csv").write_bytes(b"\xff\xfe\x00")
    refused(ProjectError, "save it as UTF-8", parts.frame)


def test_heights_of_storeys(tmp_path: Path) -> None:
    """One for all or one for each, of regular frames, too."""
    text = GRID.replace('"3.5 m"', '["4 m", "3 m", "3 m"]') + MEMBERS
    levels = parts_of(tmp_path, text).frame().levels
    assert np.diff([level.z for level in levels]) == pytest.approx([4.0, 3.0, 3.0])
    low = GRID.replace('"3.5 m"', '["4 m", "3 cm", "3 m"]') + MEMBERS
    (doubt,) = file_doubts(parts_of(tmp_path, low).file)
    assert "storey_height of storey 2 is 0.03 m" in doubt
    (doubt,) = file_doubts(project(tmp_path, structure=STRUCTURE.replace("4 m", "4 ft")).file)
    assert "storey_height of storey 1 is 1.219 m" in doubt
    few = GRID.replace('"3.5 m"', '["4 m", "3 m"]') + MEMBERS
    refused(ProjectError, "2 heights for 3 storeys", parts_of, tmp_path, few)


def test_from_tables_to_a_report(tmp_path: Path, put_example: Callable[[Path], object]) -> None:
    """The command runs it with a wall, keeps its tables, and refuses results of others."""
    put_example(tmp_path)
    wall = """
[[structure.walls]]
between = ["A1", "B1"]
thickness = "200 mm"
material = "C30/37"
"""
    analysis = """
[analysis]
level = "pendulum"
bounds = ["nominal"]
accidental_eccentricity = 0.0
"""
    project(tmp_path, rest=wall + LOADS + analysis)
    text = (tmp_path / "project.toml").read_text()
    text = text.replace('"motions"', '"motions"\nonly = ["artificial-3"]\nscale = 0.4')
    file, out = tmp_path / "walled.toml", tmp_path / "out"
    file.write_text(text)
    options = ["--no-figures", str(file), "--results", str(out)]
    done = CliRunner().invoke(app, ["run", *options])
    assert done.exit_code in {0, 1}, done.output
    assert (out / "columns.csv").read_text() == COLUMNS
    assert (out / "beams.csv").read_text() == BEAMS
    page = (out / "report.html").read_text()
    assert "wall A1 to B1, as a wide column" in page
    (tmp_path / "beams.csv").write_text(BEAMS.replace("A1,A2,,B", "A2,A1,,B"))
    again = CliRunner().invoke(app, ["report", *options])
    assert again.exit_code == 2
    assert "tables of members" in again.output


@pytest.mark.parametrize(
    ("columns", "beams", "words"),
    [
        *(
            (name, "beams.csv", f'"{name}" must not have the name of a file of the results')
            for name in NAMES
        ),
        ("a/table.csv", "table.csv", r"are both named table\.csv"),
    ],
)
def test_names_of_tables_that_are_refused(tmp_path, columns, beams, words):
    text = STRUCTURE.replace("columns.csv", columns).replace("beams.csv", beams)
    refused(ProjectError, words, project, tmp_path, structure=text)
