"""Mistakes that engineers make in a project's file: each is named with value, bound and remedy."""

import re
import warnings
from pathlib import Path

import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")
pytest.importorskip("typer")
pytest.importorskip("babel")

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
ANY = "[limits]"
FLUID = '[dampers.fluid]\nforce = "100 kN"\nspeed = "0.5 m/s"\ncolumns = ["0-0", "1-0"]\n[limits]'
WALL = '[moat]\ngap = "600 mm"\nstiffness = "500 kN/mm"\n[limits]'
IN_G = 'points = [["0 s", "0.4 g"], ["0.6 s", "1 g"], ["0.5 s", "1 g"], ["4 s", "0.1 g"]]'

MISTAKES: dict[str, tuple[str, str, str, int, str]] = {
    # name: file, text in it, what is written, exit code, words
    "no unit": (SHEAR, '"180 mm"', "180", 2, 'capacity = 180 has no unit: write "180 mm"'),
    "radius in mm": (SHEAR, '"1.5 m"', '"1500 m"', 2, "makes a pendulum of .*1500 mm are 1.5 m"),
    "radius in mm for m": (SHEAR, '"1.5 m"', '"1.5 mm"', 2, "does not fit .* 0.0015 m: use a sm"),
    "capacity in m": (SHEAR, '"180 mm"', '"180 m"', 2, "must not exceed .*180 mm are 0.18 m"),
    "capacity in cm": (SHEAR, '"180 mm"', '"18 mm"', 1, "capacity = 18 mm is less than .* unit"),
    "height too low": (
        SHEAR,
        '"200 mm"',
        '"20 mm"',
        2,
        "two spherical caps, 0.02679 m .*use a higher",
    ),
    "rims overlap": (SHEAR, '"180 mm"', '"1100 mm"', 2, "overlap at rest.*or less capacity"),
    "both ways of rims": (SHEAR, '"180 mm"', '"180 mm"\nrims = "180 mm"', 2, "give only one of th"),
    "overrun": (
        SHEAR,
        '"180 mm"',
        '"180 mm"\nrim_overrun = "0.3 m"',
        1,
        "overrun = 300 mm is more",
    ),
    "slip capacity": (
        SHEAR,
        '"180 mm"',
        '"180 mm"\nslip_capacity = "0.5 m"',
        1,
        "ity = 500 mm is m",
    ),
    "soft friction": (
        SHEAR,
        '"180 mm"',
        '"180 mm"\nyield_displacement = "25 mm"',
        1,
        "25 mm is more than 5 mm",
    ),
    "friction of 5": (SHEAR, LAW, "friction = 5", 2, "coefficient = 5 .*5 per cent are 0.05"),
    "friction of 0.5 %": (
        SHEAR,
        LAW,
        "friction = 0.005",
        1,
        "on = 0.005 is less than 0.01, sliding",
    ),
    "weak interface": (
        SHEAR,
        "= 0.18",
        "= 0.05",
        2,
        "must exceed .* 0.06 .* write allow_weak_interface = true",
    ),
    "interface of 18": (
        SHEAR,
        "= 0.18",
        "= 18",
        2,
        "below 1, .*18 per cent are 0.18.*, or inf for",
    ),
    "laws exchanged": (SHEAR, '0.06, f_min = "3 %"', '0.03, f_min = "6 %"', 2, "exchange the two"),
    "rate in s/mm": (SHEAR, '"100 s/m"', '"0.1 s/m"', 1, "rate = 0.1 s/m .*0.1 s/mm are 100 s/m"),
    "factors exchanged": (
        SHEAR,
        "[0.8, 1.3]",
        "[1.3, 0.8]",
        2,
        "lower factor of .* = 1.3 .*: give the l",
    ),
    "factors in per cent": (SHEAR, "[0.8, 1.3]", "[80, 130]", 2, "the lower at most 1, the upper"),
    "factors as differences": (SHEAR, "[0.8, 1.3]", "[-0.2, 0.3]", 2, "lower factor of .* = -0.2"),
    "interface slides first": (
        SHEAR,
        "[0.9, 1.1]",
        "[0.2, 1.1]",
        2,
        "at the lower bound, .* times 0.2: .*narrower factors",
    ),
    "R under EN 1998": (EN, ANY, ANY, 1, "R = 6 changes nothing: EN 1998 has the behaviour fac"),
    "importance, NCh2745": (
        NCH,
        "R = 6.0",
        "R = 2.0\nimportance = 1.4",
        1,
        "importance = 1.4 changes nothing: NCh2745",
    ),
    "importance once": (EN, "R = 6.0", "importance = 1.4", 1, "give both sections the same"),
    "no R": (SHEAR, "R = 6.0", "", 2, "superstructure.R is missing: ASCE 7-22 divides forces by i"),
    "R below 1": (SHEAR, "R = 6.0", "R = 0.8", 2, "R = 0.8 must be at least 1: give a number"),
    "importance of 15": (SHEAR, "R = 6.0", "R = 6.0\nimportance = 15", 2, "15 must be at most 3"),
    "wind in MN": (
        SHEAR,
        "R = 6.0",
        'R = 6.0\nwind_shear = "90 MN"',
        1,
        "wind_shear = 9e.04 kN is",
    ),
    "keys of another code": (EN, 'a_g = "3.4 m/s2"', "s_ms = 1.0", 2, "s_ms is not known"),
    "s_ms with a unit": (SHEAR, "s_ms = 1.0", 's_ms = "1.2 g"', 2, "pure number, .*: write 1.2"),
    "s_ms in m/s2": (SHEAR, "s_ms = 1.0", "s_ms = 9.8", 2, r"give it in g \(9.8 m/s2 are 0.999"),
    "s_ms and s_m1": (SHEAR, "1.0\ns_m1 = 0.5", "0.5\ns_m1 = 1.0", 1, "probably exchanged"),
    "a_g in g": (EN, '"3.4 m/s2"', '"3.4 g"', 2, "a_g = 33.34.* is more than 3 g: give m/s2"),
    "falling periods": (SHEAR, "s_ms = 1.0\ns_m1 = 0.5", IN_G, 2, "rising: sort them"),
    "no such points": (
        SHEAR,
        "s_ms = 1.0\ns_m1 = 0.5",
        'points = "s.csv"',
        2,
        "s.csv: No such file .*name a CSV",
    ),
    "no such motions": (SHEAR, '"motions"', '"records"', 2, "is no file: give the folder"),
    "no such motion": (
        SHEAR,
        '"artificial-1"',
        '"artificial-9"',
        2,
        "choose one of 'artificial-1'",
    ),
    "factor of g": (SHEAR, "scale = 1.1", "scale = 9.81", 1, "scale = 9.81 is the factor from g"),
    "factor of 10": (SHEAR, "scale = 1.1", "scale = 10", 1, "almost no record has more than 2.5 g"),
    "unknown scale": (SHEAR, "scale = 1.1", 'scale = "code"', 2, 'must be "spectrum", or a fact'),
    "few motions": (SHEAR, "scale = 1.1", 'scale = "spectrum"', 1, "3 motions: .* 7 or more"),
    "damper in MN": (SHEAR, ANY, FLUID.replace("kN", "MN"), 1, "force times 2 = 2e.05 kN is more"),
    "damper in N": (SHEAR, ANY, FLUID.replace("100 kN", "100 N"), 1, "times 2 = 0.2 kN is less"),
    "damper in mm/s": (SHEAR, ANY, FLUID.replace(" m/s", " mm/s"), 1, "speed = 0.0005 m/s is less"),
    "damper elsewhere": (SHEAR, ANY, FLUID.replace("1-0", "5-0"), 2, "5-0 is no column with a be"),
    "exponent in per cent": (
        SHEAR,
        ANY,
        FLUID.replace("[limits]", "exponent = 30\n[limits]"),
        2,
        "30 must be at most 2",
    ),
    "type of no column": (SHEAR, ANY, '[bearings.a]\nabove = "90 MN"\n[limits]', 2, "a lower load"),
    "type of all columns": (
        SHEAR,
        ANY,
        '[bearings.a]\nabove = "150 N"\n[limits]',
        1,
        r"\[bearing\] stands under no col",
    ),
    "type without place": (
        SHEAR,
        ANY,
        '[bearings.a]\nradius = "2 m"\n[limits]',
        2,
        "under which c",
    ),
    "zero storeys": (FRAME, "storeys = 2", "storeys = 0", 2, "storeys = 0 must be at least 1"),
    "tall storey": (FRAME, '"3.5 m"', '"35 m"', 1, "storey 1 is 35 m, storeys have 2 to 20 m"),
    "too few heights": (FRAME, '"3.5 m"', '["3.5 m"]', 2, "has 1 heights for 2 storeys: give one"),
    "bay in mm": (FRAME, '"7 m"', '"70 mm"', 1, "bay_width = 0.07 m is less than the"),
    "negative mass": (
        SHEAR,
        '["100 t", "100 t"]',
        '["-100 t", "100 t"]',
        2,
        r'"-100 t" must be greater than 0',
    ),
    "mass in kg as t": (SHEAR, '["100 t", "100 t"]', '["9e4 t", "9e4 t"]', 2, "in kg written as t"),
    "weight for a mass": (
        SHEAR,
        '["100 t", "100 t"]',
        '["981 kN", "981 kN"]',
        2,
        'no unit of kg: as "200 t"$',
    ),
    "soft storey": (SHEAR, '["400 kN/mm"', '["400 kN/m"', 1, "0.4 kN/mm lets the .* look at its u"),
    "stiff storey": (SHEAR, '["400 kN/mm"', '["400 MN/mm"', 1, "4e.05 kN/mm lets .* stay above"),
    "a stiffness too few": (SHEAR, ', "300 kN/mm"]', "]", 2, "2 entries, storey_stiffness 1: give"),
    "damping of 5": (FRAME, "storeys = 2", "damping = 5\nstoreys = 2", 2, 'give 0.05, or "5 %" if'),
    "eccentricity of 5": (
        FRAME,
        "storeys = 2",
        "eccentricity = [5, 5]\nstoreys = 2",
        2,
        'as "5 %" if per cent',
    ),
    "loads in t": (FRAME, '"7 kN/m2"', '"0.7 t/m2"', 2, 'no unit of N/m2: as "4.5 kN/m2"'),
    "loads in N": (FRAME, '"7 kN/m2"', '"7 N/m2"', 1, "0.714 kg on each m2 .* have 300 to 1500"),
    "facade by area": (FRAME, '"15 kN/m"', '"3 kN/m2"', 2, 'no unit of N/m: as "8 kN/m"'),
    "thick box": (FRAME, '"30 mm"', '"300 mm"', 2, "overlap, use rectangle for a solid bar"),
    "unknown material": (FRAME, '"A992"', '"S999"', 2, 'is "A992" meant'),
    "wall nearby": (
        SHEAR,
        ANY,
        WALL.replace("600", "60"),
        1,
        "gap = 60 mm is less than .* half of",
    ),
    "wall nearer than D_TM": (
        SHEAR,
        ANY,
        WALL.replace("600", "200"),
        1,
        "FAILS +clearance to the moat wall, equivalent-linear .*: 2.* mm <= 200 mm",
    ),
    "soft wall": (
        SHEAR,
        ANY,
        WALL.replace("500 kN/mm", "500 kN/m"),
        1,
        "stiffness = 0.5 kN/mm is l",
    ),
    "rims in kN": (SHEAR, '"5 MN"', '"3 kN"', 1, "rim_strength = 3 kN is less than"),
    "limit in g": (
        SHEAR,
        ANY,
        '[limits]\nfloor_acceleration = "8 g"',
        1,
        "78.45 m/s2 is more than",
    ),
    "a limit that friction alone exceeds": (
        SHEAR,
        ANY,
        '[limits]\nfloor_acceleration = "0.8 m/s2"',
        1,
        "0.8 m/s2 is less than 1.174 m/s2, the isolation pushes with 0.12",
    ),
    "damping of 15 %": (
        FRAME,
        "storeys = 2",
        "damping = 0.15\nstoreys = 2",
        1,
        "damping = 0.15 is more than 0.1, structures on isolators",
    ),
    "drift of 0.5": (SHEAR, ANY, "[limits]\ndrift = 0.5", 2, "drift = 0.5 .* below 0.2"),
    "step in s": (
        SHEAR,
        ANY,
        '[analysis]\ndt = "5 s"\n[limits]',
        2,
        r"longer .*\(5 ms are 0.005 s",
    ),
    "bound twice": (
        SHEAR,
        ANY,
        '[analysis]\nbounds = ["lower", "lower"]\n[limits]',
        2,
        "bound once",
    ),
    "one bound": (
        SHEAR,
        ANY,
        '[analysis]\nbounds = ["lower"]\n[limits]',
        1,
        r"without the bound upper",
    ),
    "wrong section": (
        SHEAR,
        "= 0.18",
        '= 0.18\nmoat_gap = "1 m"',
        2,
        r"is a key of \[limits\]; move",
    ),
    "decimal comma": (SHEAR, "= 0.18", "= 0,18", 2, "decimals have a point: 0.18"),
    "unknown code": (
        SHEAR,
        '"ASCE 7-22"',
        '"Eurocode"',
        2,
        r"\A[^\n]*must be [^\n]*'NCh2745'\n?\Z",
    ),
    "frictions of 4": (
        SHEAR,
        ANY,
        "[design]\nfrictions = [4, 5]\n[limits]",
        2,
        "frictions: .*0.04",
    ),
    "room in mm": (
        SHEAR,
        ANY,
        '[design]\nmax_displacement = "600 m"\n[limits]',
        2,
        "600 .* and below 5",
    ),
}
"""More than sixty."""

OF_PYTHON = re.compile(r"\w=(True|False|None|\(|\"|\d)|math\.|Section\.|\bpass \w+ ?=")


def checked(file: Path) -> Result:
    """Check a file by the command, which tells warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        return CliRunner().invoke(app, ["check", str(file)])


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_named_in_the_words_of_the_file(tmp_path, name, put_example):
    text, old, new, code, words = MISTAKES[name]
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
