"""Mistakes that engineers make in a project's file: each is named with value, bound and remedy."""

import re
import warnings
from pathlib import Path

import pytest

pytest.importorskip("typer")

from typer.testing import CliRunner, Result

from frames.command.app import app
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import preliminary
from frames.design.project.reading import read_project
from frames.design.report.page import Words
from tests.spanish import untold
from tests.unit.test_project import ASCE

ABOVE = "[superstructure]\nR = 6.0\n[spectrum]"
SHEAR = ASCE.replace("[spectrum]", ABOVE).replace("scale = 0.8", "scale = 1.1")
SHEAR = SHEAR[: SHEAR.index("[analysis]")]
START, END = SHEAR.index("[structure]"), SHEAR.index("[bearing]")
FRAME = f"""{SHEAR[:START]}[structure]
kind = "moment frame"
bays = [1, 1]
bay_width = ["7 m", "6 m"]
storeys = 2
storey_height = "3.5 m"
columns = {{ box = ["500 mm", "30 mm"], material = "A992" }}
beams = {{ section = "HEB 500" }}
base_beams = {{ section = "HEB 800" }}
[loads]
dead = "7 kN/m2"
live = "3 kN/m2"
facade = "15 kN/m"
{SHEAR[END:]}"""
EN = SHEAR.replace('"ASCE 7-22"', '"EN 1998"').replace(
    "s_ms = 1.0\ns_m1 = 0.5", 'a_g = "3.4 m/s2"\nground_type = "B"'
)
NCH = SHEAR.replace('"ASCE 7-22"', '"NCh2745"').replace(
    "s_ms = 1.0\ns_m1 = 0.5", 'soil = "II"\nzone = 2'
)
LAW = 'friction = {f_max = 0.06, f_min = "3 %", rate = "100 s/m"}'
ANY, FROM, REACH, COUNT = "[limits]", "s_ms = 1.0\ns_m1 = 0.5", '"180 mm"', "storeys = 2"
FLUID = '[dampers.fluid]\nforce = "100 kN"\nspeed = "0.5 m/s"\ncolumns = ["0-0", "1-0"]\n[limits]'
WALL = '[moat]\ngap = "600 mm"\nstiffness = "500 kN/mm"\n[limits]'
IN_G = 'points = [["0 s", "0.4 g"], ["0.6 s", "1 g"], ["0.5 s", "1 g"], ["4 s", "0.1 g"]]'

MISTAKES = {  # file, exit code: name, text in the file, what is written, words
    (SHEAR, 2): [
        ("no unit", REACH, "180", 'capacity = 180 has no unit: write "180 mm"'),
        ("radius in mm", '"1.5 m"', '"1500 m"', "makes a pendulum of .*1500 mm are 1.5 m"),
        ("radius in mm for m", '"1.5 m"', '"1.5 mm"', "does not fit .* 0.0015 m: use a sm"),
        ("capacity in m", REACH, '"180 m"', "must not exceed .*180 mm are 0.18 m"),
        ("height too low", '"200 mm"', '"20 mm"', "two spherical caps, 0.02679 m .*use a higher"),
        ("rims overlap", REACH, '"1100 mm"', "rise of both.*or reduce capacity"),
        ("both ways of rims", REACH, '"180 mm"\nrims = "180 mm"', "give only one of th"),
        ("friction of 5", LAW, "friction = 5", "coefficient = 5 .*5 % is 0.05"),
        ("weak interface", "= 0.18", "= 0.05", "0.06, .* set allow_weak_interface = true"),
        ("interface of 18", "= 0.18", "= 18", "below 1, .*18 % is 0.18.*, or inf for"),
        ("laws exchanged", '0.06, f_min = "3 %"', '0.03, f_min = "6 %"', "swap the values"),
        ("factors exchanged", "[0.8, 1.3]", "[1.3, 0.8]", "lower factor of .* = 1.3 .*: give the"),
        ("factors in per cent", "[0.8, 1.3]", "[80, 130]", "the lower at most 1, the upper"),
        ("factors as differences", "[0.8, 1.3]", "[-0.2, 0.3]", "lower factor of .* = -0.2"),
        ("interface first", "[0.9, 1.1]", "[0.2, 1.1]", "times 0.2: .*narrower factors"),
        ("no R", "R = 6.0", "", "superstructure.R is missing, by which ASCE 7-22 divides f"),
        ("R below 1", "R = 6.0", "R = 0.8", "R = 0.8 must be at least 1: write a number"),
        ("importance of 15", "R = 6.0", "R = 6.0\nimportance = 15", "15 must be at most 3"),
        ("s_ms with a unit", "s_ms = 1.0", 's_ms = "1.2 g"', "pure number, .*: write 1.2"),
        ("s_ms in m/s2", "s_ms = 1.0", "s_ms = 9.8", r"give it in g \(9.8 m/s2 are 0.999"),
        ("falling periods", FROM, IN_G, "rising: sort them"),
        ("no such points", FROM, 'points = "s.csv"', "No such file .*name a CSV"),
        (
            "no such motions",
            '"motions"',
            '"records"',
            "is not a file: give the folder",
        ),
        ("no such motion", '"artificial-1"', '"artificial-9"', "choose one of 'artificial-1'"),
        ("unknown scale", "scale = 1.1", 'scale = "code"', 'must be "spectrum" or a posi'),
        ("damper elsewhere", ANY, FLUID.replace("1-0", "5-0"), "5-0 is not a column with a be"),
        ("exponent in per cent", ANY, f"{FLUID[:-8]}exponent = 30\n[limits]", "30 must be at"),
        ("type of no column", ANY, '[bearings.a]\nabove = "90 MN"\n[limits]', "lower the load"),
        ("type without place", ANY, '[bearings.a]\nradius = "2 m"\n[limits]', "needs its columns"),
        ("negative mass", '["100 t", "100 t"]', '["-100 t", "100 t"]', "must be greater than 0"),
        ("mass in kg as t", '["100 t", "100 t"]', '["9e4 t", "9e4 t"]', "in kg written as t"),
        (
            "weight for a mass",
            '["100 t", "100 t"]',
            '["981 kN", "981 kN"]',
            "of kg: write a number in t$",
        ),
        ("a stiffness too few", ', "300 kN/mm"]', "]", "2 entries, storey_stiffness 1: write"),
        ("drift of 0.5", ANY, "[limits]\ndrift = 0.5", "drift = 0.5 .* below 0.2"),
        ("step in s", ANY, '[analysis]\ndt = "5 s"\n[limits]', r"longer .*\(5 ms are 0.005 s"),
        ("bound twice", ANY, '[analysis]\nbounds = ["lower", "lower"]\n[limits]', "bound once"),
        ("wrong section", "= 0.18", '= 0.18\nmoat_gap = "1 m"', r"is a key of \[limits\]; move"),
        ("decimal comma", "= 0.18", "= 0,18", "write decimals with a point, 0.18"),
        ("unknown code", '"ASCE 7-22"', '"Eurocode"', r"\A[^\n]*must be [^\n]*'NCh2745'\n?\Z"),
        ("frictions of 4", ANY, "[design]\nfrictions = [4, 5]\n[limits]", "frictions: .*0.04"),
        ("room in mm", ANY, '[design]\nmax_displacement = "600 m"\n[limits]', "600 .* and below 5"),
    ],
    (SHEAR, 1): [
        ("capacity in cm", REACH, '"18 mm"', "capacity = 18 mm is less than .* unit"),
        ("overrun", REACH, '"180 mm"\nrim_overrun = "0.3 m"', "overrun = 300 mm is more"),
        ("slip capacity", REACH, '"180 mm"\nslip_capacity = "0.5 m"', "ity = 500 mm is m"),
        ("soft friction", REACH, '"180 mm"\nyield_displacement = "25 mm"', "is more than 5 mm"),
        ("friction of 0.5 %", LAW, "friction = 0.005", "on = 0.005 is less than 0.01, sliding"),
        ("rate in s/mm", '"100 s/m"', '"0.1 s/m"', "rate = 0.1 s/m .*0.1 s/mm are 100 s/m"),
        ("wind in MN", "R = 6.0", 'R = 6.0\nwind_shear = "90 MN"', "wind_shear = 9e.04 kN exceeds"),
        ("s_ms and s_m1", "1.0\ns_m1 = 0.5", "0.5\ns_m1 = 1.0", "are exchanged"),
        ("factor of g", "scale = 1.1", "scale = 9.81", "scale = 9.81 is the factor from g"),
        ("factor of 10", "scale = 1.1", "scale = 10", "above the 2.5 g of almost all records"),
        ("few motions", "scale = 1.1", 'scale = "spectrum"', "3 motions: .* 7 or more"),
        ("damper in MN", ANY, FLUID.replace("kN", "MN"), "force times 2 = 2e.05 kN is more"),
        ("damper in N", ANY, FLUID.replace("100 kN", "100 N"), "times 2 = 0.2 kN is less"),
        ("damper in mm/s", ANY, FLUID.replace(" m/s", " mm/s"), "speed = 0.0005 m/s is less"),
        ("type of all columns", ANY, '[bearings.a]\nabove = "150 N"\n[limits]', r"no column uses"),
        ("soft storey", '["400 kN/mm"', '["400 kN/m"', "0.4 kN/mm and the .* check its u"),
        ("stiff storey", '["400 kN/mm"', '["400 MN/mm"', "4e.05 kN/mm and .* usually above"),
        ("wall nearby", ANY, WALL.replace("600", "60"), "gap = 60 mm is less than .* half of"),
        ("wall nearer than D_TM", ANY, WALL.replace("600", "200"), "FAILS +clearance .*<= 200 mm"),
        ("soft wall", ANY, WALL.replace("500 kN/mm", "500 kN/m"), "stiffness = 0.5 kN/mm is l"),
        ("rims in kN", '"5 MN"', '"3 kN"', "rim_strength = 3 kN is less than"),
        ("limit in g", ANY, '[limits]\nfloor_acceleration = "8 g"', "78.45 m/s2 is more than"),
        (
            "limit below friction",
            ANY,
            '[limits]\nfloor_acceleration = "0.8 m/s2"',
            "less than 1.174",
        ),
        ("one bound", ANY, '[analysis]\nbounds = ["lower"]\n[limits]', r"without the bound upper"),
    ],
    (EN, 1): [
        ("R under EN 1998", ANY, ANY, "R = 6 has no effect: EN 1998 has the behaviour fac"),
        ("importance once", "R = 6.0", "importance = 1.4", "Write one value in both"),
    ],
    (NCH, 1): [
        ("importance, NCh2745", "R = 6.0", "R = 2.0\nimportance = 1.4", "1.4 has no effect: N"),
    ],
    (EN, 2): [
        ("keys of another code", 'a_g = "3.4 m/s2"', "s_ms = 1.0", "s_ms is not known"),
        ("a_g in g", '"3.4 m/s2"', '"3.4 g"', "a_g = 33.34.* exceeds 3 g: give a_g in m/s2"),
    ],
    (FRAME, 2): [
        ("zero storeys", COUNT, "storeys = 0", "storeys = 0 must be at least 1"),
        ("too few heights", '"3.5 m"', '["3.5 m"]', "has 1 heights for 2 storeys: write one"),
        ("damping of 5", COUNT, "damping = 5\nstoreys = 2", 'write 0.05, or "5 %" if'),
        ("eccentricity of 5", COUNT, "eccentricity = [5, 5]\nstoreys = 2", 'or "5 %" if'),
        ("loads in t", '"7 kN/m2"', '"0.7 t/m2"', "not a unit of N/m2: write a number in kN/m2"),
        ("facade by area", '"15 kN/m"', '"3 kN/m2"', "not a unit of N/m: write a number in kN/m"),
        ("thick box", '"30 mm"', '"300 mm"', "overlap, use rectangle for a solid bar"),
        ("unknown material", '"A992"', '"S999"', 'is "A992" meant'),
    ],
    (FRAME, 1): [
        ("tall storey", '"3.5 m"', '"35 m"', "storey 1 is 35 m, outside the usual 2 to 20 m"),
        ("bay in mm", '"7 m"', '"70 mm"', "bay_width = 0.07 m is less than the"),
        ("loads in N", '"7 kN/m2"', '"7 N/m2"', "0.714 kg/m2 .* have 300 to 1500"),
        ("damping of 15 %", COUNT, "damping = 0.15\nstoreys = 2", "0.15 is more than 0.1, s"),
    ],
}

OF_PYTHON = re.compile(r"\w=(True|False|None|\(|\"|\d)|math\.|Section\.|\bpass \w+ ?=")


def checked(file: Path) -> Result:
    """Check a file by the command, which tells warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        return CliRunner().invoke(app, ["check", str(file)])


CASES = [
    pytest.param(*file, *row, id=name) for file, rows in MISTAKES.items() for name, *row in rows
]


@pytest.mark.parametrize(("text", "code", "old", "new", "words"), CASES)
def test_mistakes_are_named_in_the_words_of_the_file(
    tmp_path, put_example, text, code, old, new, words
):
    put_example(tmp_path)
    assert old in text
    text = text.replace(old, new, 1)
    (tmp_path / "mistake.toml").write_text(text)
    done = checked(tmp_path / "mistake.toml")
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exc_info
    said = done.stderr.replace(str(tmp_path), "")
    assert re.search(words, said or done.stdout), said
    assert not OF_PYTHON.search(said), said
    assert done.exit_code == code or (code == 1 and done.exit_code == 0), done.output
    if code == 1:  # a doubt, which stands on the report's cover
        spanish, file = Words("es", ","), tmp_path / "mistake.toml"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            doubts = preliminary(ProjectInputs(read_project(file), tmp_path)).doubts
        assert all(spanish.say(doubt) != doubt for doubt in doubts)
        assert untold(spanish) == set()


def test_without_a_mistake_nothing_is_said(tmp_path, put_example):
    """Doubts that are always there are none."""
    put_example(tmp_path)
    for k, text in enumerate((SHEAR, FRAME, NCH.replace("R = 6.0", "R = 2.0"))):
        (tmp_path / "right.toml").write_text(text)
        done = checked(tmp_path / "right.toml")
        assert done.exit_code in {0, 1}, done.output
        assert not done.stderr, (k, done.stderr)
