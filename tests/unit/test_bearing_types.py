"""Several types of bearings in a project's file: by column, by load, checked each by its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from frames import gravity, load
from frames.command.app import app
from frames.design import ProjectError, device_checks
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from tests.refusals import refused
from tests.scenes import DEVICE

PROJECT = """
[project]
name = "Two types"
code = "ASCE 7-22"
[structure]
kind = "moment frame"
bays = [2, 1]
bay_width = ["6 m", "6 m"]
storeys = 1
storey_height = "3 m"
floor_load = "2500 kg/m2"
columns = { section = "HEB 300" }
beams = { section = "IPE 450" }
base_beams = { section = "HEB 400" }
[spectrum]
s_ms = 1.0
s_m1 = 0.4
[motions]
folder = "motions"
only = ["artificial-3"]
scale = 0.6
"""
PROJECT += DEVICE.replace("0.06", "0.05").replace("0.18", "0.15")
PROJECT += """
[bounds]
friction = [0.8, 1.3]
[limits]
interface_pressure = "90 MPa"
[analysis]
level = "pendulum"
bounds = ["lower"]
accidental_eccentricity = "none"
"""
MIDDLE = """
[bearings.middle]
columns = ["1-0", "bearing-1-1"]
slider_radius = "250 mm"
friction = 0.06
interface_friction = 0.18
"""
BY_COLUMN = PROJECT + MIDDLE
run = CliRunner().invoke


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    return put_example(tmp_path_factory.mktemp("types"))


def parts_of(folder: Path, text: str) -> ProjectInputs:
    (folder / "types.toml").write_text(text, encoding="utf-8")
    return ProjectInputs(read_project(folder / "types.toml"), folder)


def test_columns_and_loads_choose(folder: Path) -> None:
    parts = parts_of(folder, BY_COLUMN)
    frame, types = parts.frame(), parts.types()
    middle = ["bearing-1-0", "bearing-1-1"]
    assert [name for name, kind in types.items() if kind == "middle"] == middle
    for name, link in frame.bearings.items():
        assert link.bearing.slider_radius == (0.25 if name in middle else 0.2)
        assert link.bearing.lateral_capacity == pytest.approx(0.18)
    loads = dict(zip(frame.bearings, gravity(frame).axial_forces, strict=True))
    between = 0.5e-3 * (loads["bearing-1-0"] + loads["bearing-0-0"])
    rule = BY_COLUMN.replace('columns = ["1-0", "bearing-1-1"]', f'above = "{between} kN"')
    assert parts_of(folder, rule).types() == types
    both = rule + '[bearings.corner]\ncolumns = ["1-0"]\ncapacity = "150 mm"\n'
    mixed = parts_of(folder, both).types()
    assert mixed == types | {"bearing-1-0": "corner"}
    taller = both + 'slider_height = "260 mm"\n'
    high = parts_of(folder, taller).frame()
    low = high.nodes[high.bearings["bearing-1-0"].i]
    assert low.z == pytest.approx(high.nodes[high.bearings["bearing-1-0"].j].z - 0.26)
    rims = both + 'rims = ["80 mm", "100 mm"]\n'
    refused(ProjectError, "rims", lambda: parts_of(folder, rims).frame())
    alone = rims.replace('capacity = "150 mm"\n', "")
    device = parts_of(folder, alone).devices()["corner"]
    assert device.rim_displacement == pytest.approx((0.08, 0.1))


def test_each_type_is_checked_at_its_own_loads(folder: Path) -> None:
    parts = parts_of(folder, BY_COLUMN)
    checked = run(app, ["check", str(folder / "types.toml")])
    assert "type middle: bearing-1-0, bearing-1-1" in checked.stdout
    out = folder / "out"
    done = run(app, ["run", "--no-figures", str(folder / "types.toml"), "--results", str(out)])
    assert done.exit_code in {0, 1}, done.output
    runs = load(out / "runs-lower.nc")
    frame, types = parts.frame(), parts.types()
    checks = pd.read_csv(out / "checks.csv", keep_default_na=False)
    names = list(frame.bearings)
    table = pd.read_csv(out / "bearings.csv", index_col=0)
    assert table["type"].to_dict() == types
    loads = table["average load [N]"]
    for kind, device in parts.devices().items():
        places = [k for k, name in enumerate(names) if types[name] == kind]
        most = max(
            *(float(runs["peak_axial_force"][0, k]) for k in places),
            *(1.2 * loads[names[k]] for k in places),
        )
        rows = checks[checks["subject"].str.startswith(f"type {kind}")]
        [pressure] = rows[rows["title"] == "pressure on the sliders' overlap"]["demand"]
        slip = max(float(runs["peak_slip"][0, k]) for k in places)
        given = {"slip": slip, "bounds": parts.bounds(), "limits": parts.limits()}
        checks_here = device_checks(device, (1.0, most), **given)
        [again] = [c for c in checks_here if c.title == "pressure on the sliders' overlap"]
        assert pressure >= again.demand * (1.0 - 1e-9)  # combinations may load it more
        assert pressure < 1.5 * again.demand
        assert len(rows[rows["title"].str.startswith("interface holds until")]) == 2
    both = checks[checks["title"] == "pressure on the sliders' overlap"]
    own = [row for row in both["subject"] if row.startswith("type ")]
    assert own == ["type standard", "type middle"]
    friction = pd.read_csv(out / "friction.csv", index_col=0)
    assert friction.loc["bottom surface, standard", "nominal"] == 0.05
    assert friction.loc["bottom surface, middle", "upper"] == pytest.approx(0.078)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "<h3>Type middle</h3>" in page
    other = BY_COLUMN.replace("friction = 0.06\n", "friction = 0.07\n")
    (folder / "types.toml").write_text(other)
    again_ = run(app, ["report", str(folder / "types.toml"), "--results", str(out)])
    assert again_.exit_code == 2
    assert "belong to other input (bearings" in " ".join(again_.output.split())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('columns = ["1-0", "bearing-1-1"]\n', "", "needs its columns"),
        ('"bearing-1-1"]', '"bearing-1-1"]\nabove = "1 kN"', "either columns"),
        ('"1-0"', '"1-00"', 'columns: 1-00 is not a column with a bearing; is "1-0" meant'),
        ('columns = ["1-0", "bearing-1-1"]', 'above = "1 GN"', "no column uses"),
        ('columns = ["1-0", "bearing-1-1"]', "above = 100", "above = 100 has no unit"),
        ("[bearings.middle]", "[bearings.standard]", "must not have the name of the type"),
        ("friction = 0.06", "frictoin = 0.06", r"bearings.middle.frictoin is not known; is"),
        ("interface_friction = 0.18", "interface_friction = 0.03", r"\[bearings.middle\]"),
        ("[bearings.middle]", "[bearings]\nmiddle = 3\n[bearings.more]", "bearings.middle"),
    ],
)
def test_what_cannot_be_is_refused(folder: Path, old: str, new: str, words: str) -> None:
    assert BY_COLUMN.count(old) == 1 or old == '"1-0"'
    text = PROJECT + MIDDLE.replace(old, new)
    refused(ProjectError, words, lambda: parts_of(folder, text).frame())


def test_types_need_a_standard_bearing(folder: Path) -> None:
    head, tail = BY_COLUMN.split("[bearing]")
    text = head + "[bounds]" + tail.split("[bounds]")[1]
    refused(ProjectError, r"bearings.middle.radius is missing", parts_of, folder, text)
