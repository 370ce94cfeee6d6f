"""SAP2000's tables: bad files are refused with line and remedy, nothing is lost in silence."""

from __future__ import annotations

import contextlib
import re
import warnings
from dataclasses import astuple, replace
from pathlib import Path
from time import perf_counter

import numpy as np
import openpyxl
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, gravity
from frames.demo import bearing_for
from frames.design.report.page import Words
from frames.exchange.building import Modifiers
from frames.exchange.geometry import cardinal_shift, frame_axes
from frames.exchange.links import equivalent_bearing
from frames.exchange.sap2000 import read_sap2000
from frames.exchange.slabs import corner_shares
from tests import sap2000_models as models
from tests.patience import start_up
from tests.refusals import mutated, refused
from tests.spanish import untold

SMALL = models.building(bays=(1, 1), storeys=1, details=True)
TEXT = models.text(SMALL)
BEARING = bearing_for(400e3)


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "model.s2k"
    path.write_text(text, encoding="utf-8")
    return path


def changed(old: str, new: str) -> str:
    assert old in TEXT, old
    return TEXT.replace(old, new, 1)


HINGES = 'TABLE:  "FRAME HINGE ASSIGNS 02 - USER DEFINED PROPERTIES"\n   Frame=C5'
JOINTS, ENDS = r'table "JOINT COORDINATES": ', "END TABLE"
BAD = {
    "truncated": (TEXT[len(TEXT) // 2 :], "", r"may be cut off|must have the form"),
    "no end": ("END TABLE DATA", "", r"ends in table .* without the line END TABLE"),
    "not a table": (TEXT, "hello\n", r"holds no tables of SAP2000.*Export"),
    "decimal comma": ("XorR=6.0", "XorR=6,0", rf'line \d+, {JOINTS}XorR = "6,0" .*decimal=","'),
    "no number": ("Y=5.0", "Y=five", rf'line \d+, {JOINTS}Y = "five" is not a number'),
    "infinite": ("Y=5.0", "Y=inf", r"must be a finite number"),
    "joint twice": ("Joint=2   ", "Joint=1   ", r'Joint "1" already occurs in line \d+'),
    "unknown section": ("AnalSect=COL", "AnalSect=COX", r'"COX" is not defined: there are COL, B'),
    "unknown joint": ("JointJ=5", "JointJ=99", r'"CONNECTIVITY - FRAME": JointJ "99" is not def'),
    "no material": (
        "Material=C30   Shape",
        "Material=C99   Shape",
        r'material "C99", which is not',
    ),
    "no mass source": ("MASS SOURCE", "MASS SAUCE", r"has no mass source: define it .*mass="),
    "units": ("KN, m, C", "stone, m, C", r'CurrUnits = "stone, m, C" must be a force of N, KN'),
    "no units": ("PROGRAM CONTROL", "PROGRAM CONTRAL", r'table "PROGRAM CONTROL" is missing'),
    "no section": ("FRAME SECTION ASSIGNMENTS", "X", r"has no row in FRAME SECTION ASSIGNMENTS"),
    "no yes or no": ("U1=Yes", "U1=Ja", r'U1 = "Ja" must be Yes or No'),
    "not a pair": (
        "CoordSys=GLOBAL",
        "CoordSys GLOBAL",
        r'"CoordSys GLOBAL.*" must have the form K',
    ),
    "load off the frame": (
        "RelDistB=0.7",
        "RelDistB=1.7",
        r"1.7 of the length of frame .* is not on",
    ),
    "negative stiffness": ("E1=", "E1=-", r"must be positive"),
    "hinges": (ENDS, f"{HINGES}\n{ENDS}", r'plastic hinges .*allow=\["hinges"\]'),
    "cables": (ENDS, f'TABLE:  "CONNECTIVITY - CABLE"\n   Cable=1\n{ENDS}', r'allow=\["cables"\]'),
    "new": (
        ENDS,
        f'TABLE:  "FRAME MAGIC"\n   Frame=1\n{ENDS}',
        r'not known here.*allow=\["other tables"\]',
    ),
}


@pytest.mark.parametrize(("old", "new", "message"), BAD.values(), ids=list(BAD))
def test_bad_files_are_refused_with_a_remedy(tmp_path, old, new, message):
    refused(ModelError, message, Frame.from_sap2000, written(tmp_path, changed(old, new)))


def test_a_section_by_its_shape_has_its_modifiers(tmp_path: Path) -> None:
    rows = {"SectionName": "COL", "Material": "C30", "Shape": "Rectangular", "t3": 0.5, "t2": 0.4}
    tables = SMALL | {
        "FRAME SECTION PROPERTIES 01 - GENERAL": [
            rows | {"I3Mod": 0.5} if row["SectionName"] == "COL" else row
            for row in SMALL["FRAME SECTION PROPERTIES 01 - GENERAL"]
        ]
    }
    building = read_sap2000(written(tmp_path, models.text(tables)))
    assert building.sections["COL"].modifiers == Modifiers(inertia_33=0.5)


def test_what_is_allowed_is_left_out_and_noted(tmp_path: Path) -> None:
    path = written(tmp_path, changed(*BAD["hinges"][:2]))
    frame = Frame.from_sap2000(path, allow=["hinges"])
    assert 'accepted by allow = "hinges"' in str(frame.imported)
    words = 'allow has "cables", but'
    refused(ModelError, words, Frame.from_sap2000, path, allow=["hinges", "cables"])


def test_every_table_is_in_the_account(tmp_path: Path) -> None:
    extra = 'TABLE:  "GRID LINES"\n   CoordSys=GLOBAL   AxisDir=X\nEND TABLE DATA'
    frame = Frame.from_sap2000(written(tmp_path, changed("END TABLE DATA", extra)))
    account = str(frame.imported)
    for table in ("GRID LINES (1)", "JOINT COORDINATES", "CONNECTIVITY - FRAME", "WIND"):
        assert table in account


def test_weight_and_mass_are_those_of_the_tables(tmp_path: Path) -> None:
    # by hand: 4 columns, 4 beams, a slab of 30 m2, and 30 % of 3 kN/m2
    tables = models.building(bays=(1, 1), storeys=1)
    frame = Frame.from_sap2000(written(tmp_path, models.text(tables)), BEARING)
    concrete = 4 * 3.0 * 0.5 * 0.4 + 22.0 * 0.6 * 0.3 + 30.0 * 0.15
    check = frame.check()
    assert_allclose(check.weight, 25e3 * concrete + 0.3 * 3e3 * 30.0, rtol=1e-12)
    assert_allclose(check.mass, 2500.0 * concrete + 0.3 * 3e3 * 30.0 / frame.gravity, rtol=1e-12)
    assert len(frame.bearings) == 4
    assert frame.diaphragms["base"].nodes == ("1", "2", "3", "4")


def test_the_workbook_is_the_same_model(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    for k, (name, rows) in enumerate(SMALL.items()):
        sheet = book.create_sheet(f"{k}")
        fields = list(dict.fromkeys(key for row in rows for key in row))
        sheet.append([f"TABLE:  {name.title()}"])
        sheet.append(fields)
        sheet.append(["Text"] * len(fields))
        for row in rows:
            values = [row.get(field) for field in fields]
            sheet.append(["Yes" if v is True else "No" if v is False else v for v in values])
    book.save(tmp_path / "model.xlsx")
    one = Frame.from_sap2000(tmp_path / "model.xlsx")
    two = Frame.from_sap2000(written(tmp_path, TEXT))
    assert list(one.members) == list(two.members)
    for name, member in one.members.items():
        other = two.members[name]
        assert member == replace(other, section=member.section)
        assert_allclose(astuple(member.section), astuple(other.section), rtol=1e-12)
    assert one.nodes == two.nodes
    assert list(one.masses) == list(two.masses)
    for node, mass in one.masses.items():
        assert_allclose(mass, two.masses[node], rtol=1e-12)


@pytest.mark.parametrize(("decimal", "sign"), [(".", "."), (",", ",")])
def test_either_decimal_sign_is_read(tmp_path: Path, decimal: str, sign: str) -> None:
    text = TEXT.replace("XorR=6.0", f"XorR=6{sign}0").replace("Y=5.0", f"Y=5{sign}0")
    if sign == ",":
        text = re.sub(r"=(-?\d+)\.(\d)", r"=\1,\2", text)
        text = text.replace("Version=22,0.0", "Version=22.0.0")
    frame = Frame.from_sap2000(written(tmp_path, text), decimal=decimal)  # type: ignore[arg-type]
    assert frame.nodes["4"].position == (6.0, 5.0, 0.0)


JUNK = ('"', "=", "-", "0", "x", " ", ",", "9e99", "\0", "TABLE:", "nan", "_")


@pytest.mark.filterwarnings("ignore::frames.ModelWarning")  # words that are not known
def test_mutated_files_end_in_models_or_messages(tmp_path: Path) -> None:
    for seed in range(1000):
        with contextlib.suppress(ModelError):
            frame = Frame.from_sap2000(written(tmp_path, mutated(seed, TEXT, JUNK)))
            assert np.isfinite([node.position for node in frame.nodes.values()]).all()


@pytest.mark.slow
def test_ten_thousand_frames_are_read_in_five_seconds(tmp_path: Path) -> None:
    path = written(tmp_path, models.text(models.building(bays=(20, 20), storeys=8)))
    start = perf_counter()
    building = read_sap2000(path)
    taken = perf_counter() - start
    assert len(building.frames) > 10_000
    assert taken < 10.0 * start_up()  # 5 s, where it takes half a second to start


@pytest.mark.parametrize(
    ("end", "angle", "axes"),
    [
        ((5, 0, 0), 0.0, [[1, 0, 0], [0, 0, 1], [0, -1, 0]]),
        ((0, 0, 3), 0.0, [[0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        ((0, 0, 3), 90.0, [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
    ],
)
def test_axes_are_those_of_the_manual(end, angle, axes):
    assert_allclose(frame_axes((0, 0, 0), end, angle), axes, atol=1e-15)


@pytest.mark.parametrize(
    ("point", "shift"), [(8, (-0.3, 0.0)), (1, (0.3, -0.15)), (10, (0.0, 0.0))]
)
def test_insertion_points_shift_the_axis(point: int, shift: tuple[float, float]) -> None:
    assert cardinal_shift(point, 0.6, 0.3) == shift


def test_corner_shares_keep_force_and_moments() -> None:
    points = np.array([[0, 0, 0], [4, 0.5, 0], [5, 3, 0], [1, 4, 0.0]])
    shares = corner_shares(points)
    assert_allclose(shares.sum(), 1.0)
    x, y = points[:, 0], points[:, 1]
    twist = x * np.roll(y, -1) - np.roll(x, -1) * y
    centre = np.array([((x + np.roll(x, -1)) * twist).sum(), ((y + np.roll(y, -1)) * twist).sum()])
    assert_allclose(shares @ points[:, :2], centre / (3 * twist.sum()))


def test_slabs_are_cut_along_the_beams_within_them(tmp_path: Path) -> None:
    # one area over two bays, a beam between them: as two areas
    tables = models.building(bays=(2, 1), storeys=1)
    two = Frame.from_sap2000(written(tmp_path, models.text(tables)), loads={"LIVE": 1.0})
    joints = tables["CONNECTIVITY - AREA"][0] | {"Joint2": 9, "Joint3": 12}
    tables["CONNECTIVITY - AREA"] = [joints]
    for table in ("AREA SECTION ASSIGNMENTS", "AREA LOADS - UNIFORM"):
        tables[table] = tables[table][:1]
    one = Frame.from_sap2000(written(tmp_path, models.text(tables)), loads={"LIVE": 1.0})
    for member, loads in two.tapered_loads.items():
        key = lambda load: (load.a, load.b, load.start)  # noqa: E731
        found = sorted(one.tapered_loads[member], key=key)
        assert len(found) == len(loads)
        for a, b in zip(found, sorted(loads, key=key), strict=True):
            assert_allclose([a.a, a.b, *a.start, *a.end], [b.a, b.b, *b.start, *b.end], atol=1e-9)


PENDULUM = "Fixed=No NonLinear=Yes TransKE=500 TransK=20000 Slow=0.03 Fast=0.06 Rate=20 Radius=2.2"

ENDS_OF_LINKS = "\n".join(f"   Link={k}   JointI={k}   JointJ={k}" for k in range(1, 5))
KIND = 'LinkType="Friction Isolator"   LinkJoints=SingleJoint   LinkProp=FP'
ISOLATORS = "\n".join(f"   Link={k}   {KIND}" for k in range(1, 5))
LINKS = f"""
TABLE:  "LINK PROPERTY DEFINITIONS 01 - GENERAL"
   Link=FP   LinkType="Friction Isolator"   Mass=0   Weight=0
   Link=STOP   LinkType=Gap   Mass=0   Weight=0

TABLE:  "LINK PROPERTY DEFINITIONS 08 - SLIDING ISOLATOR"
   Link=FP   DOF=U1   Fixed=No   NonLinear=Yes   TransKE=2000000   TransCE=0   TransK=2000000
   Link=FP DOF=U2 {PENDULUM}
   Link=FP DOF=U3 {PENDULUM}

TABLE:  "LINK PROPERTY DEFINITIONS 05 - GAP"
   Link=STOP   DOF=U1   Fixed=No   NonLinear=Yes   TransKE=0   TransK=1000   TransOpen=0.02

TABLE:  "CONNECTIVITY - LINK"
{ENDS_OF_LINKS}
   Link=5   JointI=5   JointJ=6

TABLE:  "LINK PROPERTY ASSIGNMENTS"
{ISOLATORS}
   Link=5   LinkType=Gap   LinkJoints=TwoJoint   LinkProp=STOP

END TABLE DATA"""


def isolated(tmp_path: Path) -> Path:
    tables = models.building(bays=(1, 1), storeys=1)
    held = tables["JOINT RESTRAINT ASSIGNMENTS"]
    tables["JOINT RESTRAINT ASSIGNMENTS"] = [
        {"Joint": r["Joint"], "R1": True, "R2": True} for r in held
    ]
    return written(tmp_path, models.text(tables).replace("END TABLE DATA", LINKS))


def test_friction_isolators_become_bearings(tmp_path: Path) -> None:
    frame = Frame.from_sap2000(isolated(tmp_path))
    assert list(frame.bearings) == ["1", "2", "3", "4"]
    bearing = frame.bearings["1"].bearing
    assert_allclose(bearing.effective_radius, 2.2)
    assert bearing.is_dcfp
    assert bearing.axial_stiffness == 2e9
    # at a speed v of the link the surfaces, of R = 1.15 m, slide at v R / L each: Q/W by the speed
    assert_allclose(bearing.effective_friction, 0.06)
    law, speed = bearing.frictions[0], 0.1 * 1.15 / 2.2
    assert_allclose(law.at_speed(speed) * 2.3 / 2.2, 0.06 - 0.03 * np.exp(-20.0 * 0.1))
    forces = dict(zip(frame.bearings, gravity(frame).axial_forces, strict=True))
    for name, part in frame.bearings.items():  # strength over 20 kN/mm
        slid = 0.06 * forces[name] / 20e6 / (2.3 / 2.2)
        assert_allclose(part.bearing.yield_displacement, slid, rtol=2e-2)
    assert_allclose(frame.links["5-U1"].direction, (-1.0, 0.0, 0.0))
    assert "friction isolators, as DCFP" in str(frame.imported)
    given = Frame.from_sap2000(isolated(tmp_path), {"FP": BEARING})
    assert {link.bearing for link in given.bearings.values()} == {BEARING}


def test_a_friction_isolator_without_radius_needs_a_bearing(tmp_path: Path) -> None:
    building = read_sap2000(isolated(tmp_path))
    link = building.link_properties["FP"]
    del link.dofs["U3"].values["radius"]
    refused(ModelError, r"needs nonlinear U2 and U3 with radius", equivalent_bearing, link, "here")


IDLE: models.Rows = {
    "FRAME SECTION PROPERTIES 01 - GENERAL": [{"SectionName": "A", "Shape": "Auto Select"}],
    "AREA SECTION PROPERTIES": [{"Section": "A", "Material": "nowhere", "Thickness": -1}],
    "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES": [{"Material": "BAD", "E1": -1}],
    "LOAD PATTERN DEFINITIONS": [{"LoadPat": "IDLE", "DesignType": "Magic", "SelfWtMult": 0}],
    "LINK PROPERTY DEFINITIONS 01 - GENERAL": [{"Link": "A", "LinkType": "Magic"}],
    "LINK PROPERTY DEFINITIONS 02 - LINEAR": [{"Link": "A", "DOF": "U9"}],
}


def test_what_nothing_has_never_stops_an_import(tmp_path: Path) -> None:
    tables = models.building()
    for name, rows in IDLE.items():
        tables[name] = [*tables.get(name, []), *rows]
    frame = Frame.from_sap2000(written(tmp_path, models.text(tables)))
    assert "which nothing has: A" in str(frame.imported)


def doubts(tmp_path: Path, tables: models.Rows, **options: object) -> tuple[Frame, str]:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        path = written(tmp_path, models.text(tables))
        frame = Frame.from_sap2000(path, BEARING, **options)  # type: ignore[arg-type]
    words = Words("es")
    for each in told:
        words.say(each.message.text)
    assert untold(words) == set()
    return frame, " ".join(str(each.message) for each in told)


def test_mass_and_weight_may_stand_in_the_first_table_of_materials(tmp_path: Path) -> None:
    tables = models.building()
    frame, said = doubts(tmp_path, tables)
    row = tables["MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"][0]
    own = {field: row.pop(field) for field in ("UnitWeight", "UnitMass")}
    tables["MATERIAL PROPERTIES 01 - GENERAL"] = [{"Material": "C30", "Type": "Concrete"} | own]
    other, more = doubts(tmp_path, tables)
    assert other.check().weight == frame.check().weight
    assert said == more == ""


def test_a_field_that_is_not_known_is_told(tmp_path: Path) -> None:
    tables = models.building()
    tables["AREA LOADS - UNIFORM"][0] |= {"DistType": "One way"}
    _, said = doubts(tmp_path, tables)
    assert "AREA LOADS - UNIFORM: unknown words were not read: DistType =" in said
    tables["AREA LOADS - UNIFORM"][0] |= {"DistType": "Two way"}
    assert doubts(tmp_path, tables)[1] == ""


def test_mass_without_weight_is_doubted_and_its_remedy_cures_it(tmp_path: Path) -> None:
    tables = models.building()
    plain = doubts(tmp_path, tables)[0].check()
    joints = range(7, 13)
    tables["JOINT ADDED MASS ASSIGNMENTS"] = [
        {"Joint": k, "Mass1": 5.0, "Mass2": 5.0, "Mass3": 5.0} for k in joints
    ]
    frame, said = doubts(tmp_path, tables)
    check = frame.check()
    assert_allclose([check.mass - plain.mass, check.weight], [30e3, plain.weight])
    assert "30 t added to joints" in said
    assert 'mass={"LIVE": 0.3, "DEAD": 1.0}' in said
    cured, more = doubts(tmp_path, tables, mass={"DEAD": 1.0, "LIVE": 0.3})
    assert more == ""
    assert_allclose(cured.check().mass * cured.gravity, cured.check().weight, rtol=1e-9)


def tied(tables: models.Rows, *free: str) -> None:
    flags = {dof: dof not in free for dof in ("UX", "UY", "UZ", "RX", "RY", "RZ")}
    tables["CONSTRAINT DEFINITIONS - EQUAL"] = [{"Name": "TIE", "CoordSys": "GLOBAL"} | flags]
    tables["JOINT CONSTRAINT ASSIGNMENTS"] += [
        {"Joint": k, "Constraint": "TIE", "Type": "Equal"} for k in range(1, 7)
    ]


def test_a_constraint_that_ties_the_settlements_is_doubted(tmp_path: Path) -> None:
    tables = models.building()
    plain = gravity(doubts(tmp_path, tables)[0]).axial_forces
    tied(tables)
    frame, said = doubts(tmp_path, tables, base_diaphragm=False)
    forces = gravity(frame).axial_forces
    assert_allclose(forces, forces.mean(), rtol=1e-6)  # all carry the same
    assert 'constraint "TIE" ties uz of 6 joints on bearings, which settle by the same' in said
    tied(tables := models.building(), "UZ", "RX", "RY")
    frame, said = doubts(tmp_path, tables, base_diaphragm=False)
    assert said == ""
    assert_allclose(gravity(frame).axial_forces, plain, rtol=1e-6)


def test_rotations_that_supports_hold_beside_beams_are_doubted(tmp_path: Path) -> None:
    tables = models.building()
    models._frame(tables, "B", 1, 2, "BEAM")
    _, said = doubts(tmp_path, tables)
    assert "supports fix the rotations of 6 joints on bearings" in said
    assert 'base_rotations="free"' in said
    assert doubts(tmp_path, tables, base_rotations="free")[1] == ""


def test_a_base_without_mass_is_doubted(tmp_path: Path) -> None:
    tables = models.building()
    modifiers = [
        {"Frame": row["Frame"], "MassMod": 1e-3, "WeightMod": 1e-3}
        for row in tables["CONNECTIVITY - FRAME"]
        if str(row["Frame"]).startswith("C")
    ]
    tables["FRAME PROPERTY MODIFIERS"] = modifiers
    _, said = doubts(tmp_path, tables)
    assert "the level on the bearings has only 0.00" in said
    tables["JOINT ADDED MASS ASSIGNMENTS"] = [
        {"Joint": k} | {f"Mass{i}": 1.0 for i in (1, 2, 3)} for k in range(1, 7)
    ]
    assert "the level on the bearings" not in doubts(tmp_path, tables)[1]


def test_bearings_stand_where_groups_say(tmp_path: Path) -> None:
    tables = models.building(bays=(1, 1), storeys=1)
    tables["GROUPS 2 - ASSIGNMENTS"] = [
        {"GroupName": "EDGE", "ObjectType": "Joint", "ObjectLabel": 1},
        {"GroupName": "EDGE", "ObjectType": "Joint", "ObjectLabel": 2},
        {"GroupName": "REST", "ObjectType": "Joint", "ObjectLabel": 3},
    ]
    path = written(tmp_path, models.text(tables))
    frame = Frame.from_sap2000(path, {"EDGE": BEARING, "REST": BEARING})
    assert list(frame.bearings) == ["bearing-1", "bearing-2", "bearing-3"]
    assert frame.fixed_dofs["4"] == {"ux", "uy", "uz", "rx", "ry", "rz"}
    with pytest.raises(ModelError, match=r'"CORE" is not a group, link property, link or joint'):
        Frame.from_sap2000(path, BEARING, at=["CORE"])


def test_bodies_move_as_one(tmp_path: Path) -> None:
    from frames.assembly.assemble import assemble

    tables = models.building(bays=(1, 1), storeys=1, slabs=False)
    tables["CONSTRAINT DEFINITIONS - BODY"] = [{"Name": "D1", "CoordSys": "GLOBAL"}]
    del tables["CONSTRAINT DEFINITIONS - DIAPHRAGM"]
    for row in tables["JOINT CONSTRAINT ASSIGNMENTS"]:
        row["Type"] = "Body"
    frame = Frame.from_sap2000(written(tmp_path, models.text(tables)))
    assert assemble(frame).transform.shape[1] == 6
