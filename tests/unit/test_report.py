"""The report of a run: its numbers are those of the results, and a browser shows it whole."""

import base64
import hashlib
import json
import math
import re
import shutil
import subprocess  # noqa: S404
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import reduce
from html import unescape
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("typer")

import numpy as np
import pandas as pd
import xarray as xr
from typer.testing import CliRunner, Result

from frames import load, modes, moment_frame, save
from frames.batch.runs import Runs
from frames.command.app import app
from frames.design import HISTORY_RULES, Check
from frames.design._errors import ProjectError
from frames.design.histories.eccentricity import Case
from frames.design.project.design_run import ProjectRun, evaluate_run
from frames.design.project.inputs import ProjectInputs
from frames.design.project.preliminary import inputs_of, preliminary
from frames.design.project.reading import read_project
from frames.design.report import files as report_files
from frames.design.report.cover import css_string, judged
from frames.design.report.figures import (
    motions_figure,
    profiles_figure,
    typical_bearing,
    utilisation,
)
from frames.design.report.files import pages_of, print_report, read_histories
from frames.design.report.page import Table, Words
from frames.design.report.result_tables import device_table, mode_table, run_tables
from frames.design.report.tables import in_parts
from frames.design.report.writing import SECTIONS, report_in
from lir_element import LIRBearing, VelocityFriction
from tests.patience import patience
from tests.scenes import wide_bearing
from tests.spanish import english_words, untold

pytestmark = pytest.mark.filterwarnings("default")  # the command prints warnings

PROJECT = """
[project]
name = "One storey <& small>"
code = "ASCE 7-22"
engineer = "R. Structure"
date = 2026-11-25
[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["6 m", "6 m"]
storey_mass = ["100 t"]
storey_stiffness = ["400 kN/mm"]
storey_height = "3 m"
base_mass = "100 t"
[superstructure]
R = 6.0
wind_shear = "500 kN"
[bearing]
radius = "1.5 m"
slider_height = "200 mm"
slider_radius = "0.22 m"
capacity = "180 mm"
friction = 0.05
interface_friction = 0.15
[spectrum]
s_ms = 1.2
s_m1 = 0.6
[motions]
folder = "motions"
[bounds]
friction = [0.8, 1.3]
interface = [0.9, 1.1]
[analysis]
bounds = ["lower", "upper"]
level = "pendulum"
"""


@pytest.fixture(scope="module", autouse=True)
def coarse_pictures() -> Iterator[None]:
    """Have pictures of few points: most of the time of a report is drawing."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("frames.design.report.page._DOTS", 40)
        yield


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    folder = put_example(tmp_path_factory.mktemp("project"))
    (folder / "project.toml").write_text(PROJECT)
    done = lir("run", folder)
    assert done.exit_code in {0, 1}, done.output
    return folder / "results"


def lir(command: str, folder: Path, *more: str) -> Result:
    """Give a command for the project of a folder."""
    words = [str(folder / "project.toml"), "--results", str(folder / "results"), *more]
    return CliRunner().invoke(app, [command, *words])


@pytest.fixture
def copied(results: Path, tmp_path: Path) -> Path:
    """The project's folder with its results, for a test alone."""
    return Path(shutil.copytree(results.parent, tmp_path / "project"))


@pytest.fixture(scope="module")
def page(results: Path) -> str:
    return (results / "report.html").read_text(encoding="utf-8")


def section(page: str, anchor: str) -> str:
    """Return a section of the report."""
    return page.partition(f'<h2 id="{anchor}">')[2].partition("<h2 ")[0]


def columns(part: str, first: str) -> dict[str, str]:
    """Return the cells of the rows that begin with a word, by the heads of all their tables."""
    found = {}
    for table in re.findall(r"<table.*?</table>", part, re.S):
        heads = [unescape(c).strip() for c in re.findall(r"<th[^>]*>([^<]*)</th>", table)]
        for row in re.findall(r"<tr>(.*?)</tr>", table, re.S):
            cell = [unescape(c).strip() for c in re.findall(r"<td[^>]*>(.*?)</td>", row, re.S)]
            if cell and cell[0] == first:
                found |= dict(zip(heads, cell, strict=True))
    return found


def test_every_check_is_there_with_its_calculation(results: Path, page: str) -> None:
    checks = pd.read_csv(results / "checks.csv")
    body = page[page.index('<h2 id="checks">') : page.index('<h2 id="input">')]
    assert body.count('<section class="steps">') == len(checks)
    table, calculations = body.split('<h2 id="calculations">')
    table = table.split('<h3 id="provisions">')[0]
    failed = (~checks["passed"] & (checks["verdict"] == "FAILS")).sum()
    assert table.count(">FAILS<") == calculations.count(">FAILS<") == failed
    assert failed >= 3
    assert calculations.count("<math") > 2 * len(checks)
    assert table.count(" *</td>") == checks["standing"].str.startswith("from memory").sum()
    verdict = page[page.index('class="verdict') : page.index('<h2 id="structure">')]
    assert f"{len(checks)} checks" in verdict


def test_doubtful_input_is_named_under_the_verdict(page: str) -> None:
    verdict = page.partition('class="verdict')[2].partition("</div>")[0]
    assert "Doubtful input" in verdict
    assert "wind_shear = 500 kN exceeds" in verdict
    assert verdict.count("slides in wind") == 1


def test_it_stands_alone(results: Path, page: str) -> None:
    sources = re.findall(r'(?:src|href)="([^"#][^"]*)"', page)
    assert sources
    for source in sources:
        assert source.startswith("data:")
    pictures = [s for s in sources if s.startswith("data:image/png;base64,")]
    assert len(pictures) >= 8
    for picture in pictures:
        data = base64.b64decode(picture.partition(",")[2], validate=True)
        assert data.startswith(b"\x89PNG")
    assert "One storey &lt;&amp; small&gt;" in page
    assert (results / "project.toml").read_text().strip() in unescape(page)


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


NEEDS_BROWSER = pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed")


def browser(file: Path, *words: str) -> "subprocess.CompletedProcess[str]":
    """Have a browser without a window read a page."""
    head = [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu"]
    own = f"--user-data-dir={file.parent / 'profile'}"
    return subprocess.run(  # noqa: S603
        [*head, *words, own, file.as_uri()],
        capture_output=True,
        text=True,
        timeout=patience(),
        check=True,
    )


@NEEDS_BROWSER
@pytest.mark.parametrize("width", [1280, 390])
def test_a_browser_shows_it_whole(page: str, tmp_path: Path, width: int) -> None:
    probe = """<script>window.onload = () => {
      const ill = [...document.images].filter(i => !i.complete || i.naturalWidth === 0).length;
      const wide = document.documentElement.scrollWidth - window.innerWidth;
      const cut = [...document.querySelectorAll('td')].filter(
        c => c.scrollWidth > c.clientWidth + 1).length;
      const flat = [...document.querySelectorAll('math')].filter(
        m => m.getBoundingClientRect().height < 5).length;
      document.title = `probe ${ill} ${wide} ${cut} ${flat} ${document.images.length}`;
    }</script>"""
    file = tmp_path / "report.html"
    file.write_text(page.replace("</body>", probe + "</body>"), encoding="utf-8")
    done = browser(file, "--enable-logging=stderr", f"--window-size={width},900", "--dump-dom")
    assert "CONSOLE" not in done.stderr
    found = re.search(r"<title>probe (\d+) (-?\d+) (\d+) (\d+) (\d+)</title>", done.stdout)
    assert found is not None
    missing, beyond, cut, flat, pictures = map(int, found.groups())
    assert (missing, cut, flat) == (0, 0, 0)
    assert beyond <= 0  # tables scroll in their frames, the page does not
    assert pictures >= 8


def without_date(page: str) -> str:
    return re.sub(r"<tr><th>written</th>.*?</tr>", "", page)


def test_it_is_written_anew_from_the_results(page: str, copied: Path) -> None:
    """The same bytes, its date aside; with other limits judged anew, without a time history."""
    file, kept = copied / "project.toml", copied / "results"
    (kept / "report.html").unlink()
    checks = (kept / "checks.csv").read_bytes()
    assert lir("report", copied).exit_code in {0, 1}
    written = (kept / "report.html").read_text(encoding="utf-8")
    assert without_date(written) == without_date(page)
    assert (kept / "checks.csv").read_bytes() == checks

    file.write_text(PROJECT + "[limits]\nfloor_acceleration = '0.01 m/s2'\n")
    assert lir("report", copied, "--no-figures", "--language", "es").exit_code == 1
    assert "floor acceleration" in (kept / "checks.csv").read_text(encoding="utf-8")
    assert "No se cumplen" in (kept / "report.html").read_text(encoding="utf-8")
    done = lir("report", copied, "--language", "fr")
    assert done.exit_code == 2
    assert "language = 'fr' is not a language of reports" in " ".join(done.output.split())


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("friction = 0.05", "friction = 0.06", "belong to other input (bearing, motions differ)"),
        ('bounds = ["lower", "upper"]', "dt = '5 ms'", "belong to other input (analysis differ)"),
        ("s_m1 = 0.6", "s_m1 = 0.7", "belong to other input (motions differ)"),
    ],
)
def test_results_of_another_input_are_refused(copied: Path, old: str, new: str, words: str) -> None:
    (copied / "project.toml").write_text(PROJECT.replace(old, new))
    done = lir("report", copied)
    assert done.exit_code == 2
    assert words in " ".join(done.output.split())


def test_tables_of_members_of_an_earlier_structure_are_removed(copied: Path) -> None:
    """A building of springs has no members."""
    (copied / "results" / "members.csv").write_text("of another structure")
    assert lir("report", copied, "--no-figures").exit_code in {0, 1}
    assert not list((copied / "results").glob("member*.csv"))


def test_results_of_a_version_without_forces_are_refused(copied: Path) -> None:
    path = copied / "results" / "runs-upper.nc"
    data = load(path)
    path.unlink()
    save(data.drop_vars([n for n in data.data_vars if n.startswith("peak_reaction")]), path)
    facts = copied / "results" / "run.json"
    known = json.loads(facts.read_text())
    known["digests"][path.name] = hashlib.sha256(path.read_bytes()).hexdigest()
    facts.write_text(json.dumps(known))
    done = lir("report", copied)
    assert done.exit_code == 2
    assert "and have no forces of members and bearings" in " ".join(done.output.split())


def test_a_folder_without_a_run_is_refused(copied: Path) -> None:
    (copied / "results" / "governing.nc").unlink()
    assert "governing.nc" in lir("report", copied).output.replace("\n", "")
    (copied / "results" / "run.json").unlink()
    done = lir("report", copied)
    assert done.exit_code == 2
    assert "has no run: run `lir run`" in " ".join(done.output.split())


def test_masses_of_modes_along_both_axes() -> None:
    """A frame of unlike bays moves along x or along y: each mode has mass along one axis alone."""
    bearing = wide_bearing(capacity=0.18, interface_friction=0.15)
    frame = moment_frame((3, 1), 2, bearing=bearing)
    table = mode_table(SimpleNamespace(frame=frame, equivalent=SimpleNamespace(bounds={})))
    for title in ("sliding", "fixed base"):
        x, y = (table[f"mass {axis}, {title}"][:-1] for axis in "xy")
        assert min(x.sum(), y.sum()) > 0.6  # fixed base: its mass is not in it
        assert (x * y).max() < 1e-3
        found = modes(frame, 6, bearings="fixed" if title == "fixed base" else title)
        assert x.tolist() == np.round(found.mass_ratios[:, 0], 4).tolist()
        assert y.tolist() == np.round(found.mass_ratios[:, 1], 4).tolist()
        assert table.loc["sum", f"mass x, {title}"] == pytest.approx(x.sum(), abs=1e-3)


def test_pages_for_supplier_tester_and_owner(results: Path, page: str) -> None:
    """Numbers of the CSV files by hand: loops, masses, the lift; places by their axes."""
    given = pd.read_csv(results / "schedule.csv", index_col=0)["standard"].astype(float)
    loads = pd.read_csv(results / "bearings.csv")["average load [N]"]
    assert given["permanent load, mean"] == pytest.approx(loads.mean())
    radius, height, slider, mu = 1.5, 0.2, 0.22, 0.05
    length, d, load = 2.0 * radius - height, given["displacement of these loops"], loads.mean()
    rim = 0.18
    assert d > rim  # the interface does the rest
    turn, mu_h = math.asin(rim / length), 0.15
    shear = mu_h / (math.cos(turn) - mu_h * math.sin(turn)) / math.cos(turn)
    way = 2.0 * mu * (rim * radius / length - 0.25e-3) + shear * (d - rim)
    assert given["EDC, nominal"] == pytest.approx(4.0 * load * way, rel=1e-9)
    force = load * math.tan(turn + math.atan(1.1 * mu_h))
    assert given["k_eff, upper"] == pytest.approx(force / d, rel=1e-9)
    assert math.isnan(given["EDC, accepted to"])
    plate, wall = given["thickness at the vertex, bottom plate"], given["width of the rims"]
    face, up = 0.5 * given["inside diameter of the bottom rim"], given["height of the rims"]
    assert given["outside diameter, top plate"] == pytest.approx(2.0 * (face + wall))
    assert given["total height"] == pytest.approx(2.0 * plate + height)

    def cap(half: float) -> tuple[float, float]:
        deep = radius - math.sqrt(radius**2 - half**2)
        return deep, math.pi * deep**2 * (3.0 * radius - deep) / 3.0

    deep, hollow = cap(face)
    solid = math.pi * (face + wall) ** 2 * (plate + deep + up) - math.pi * face**2 * up - hollow
    edge, bulge = cap(slider)
    body = math.pi * slider**2 * (height - 2.0 * edge) + 2.0 * bulge
    assert given["mass of the slider"] == pytest.approx(7850.0 * body, rel=1e-6)
    assert given["mass of the bearing"] == pytest.approx(7850.0 * (2.0 * solid + body), rel=2e-5)
    replaced = pd.read_csv(results / "replacement.csv").iloc[0]
    axial = 20e9 * math.pi * slider**2 / height
    assert replaced["lift [m]"] == pytest.approx(loads.max() / axial + 5e-3, rel=1e-6)
    assert replaced["jacking force [N]"] >= loads.max() * (1.0 - 1e-9)
    rig = pd.read_csv(results / "rig.csv").iloc[0]
    tests = pd.read_csv(results / "programme.csv")
    assert rig["largest lateral force [N]"] == tests["largest force [N]"].max()
    assert rig["stroke, each way [m]"] == tests["displacement [m]"].max()
    places = pd.read_csv(results / "bearings.csv").set_index(["x [m]", "y [m]"])["axes"]
    assert sorted(places) == ["A-1", "A-2", "B-1", "B-2"]
    assert places[places.index.max()] == "B-2"
    moved = "displacement, time histories", "displacement to allow, equivalent-linear"
    reached = max(given[name] for name in moved)
    assert given["rotation of the slider"] == pytest.approx(math.asin(min(reached, rim) / length))
    part = section(page, "specification")
    assert f"within {1e3 * reached:.0f} mm" in part
    assert f"its {given['mass of the bearing']:.0f} kg." in part
    assert columns(part, "standard")["lift [mm]"] == f"{1e3 * replaced['lift [m]']:.4g}"
    assert section(page, "tender").count("<img") == 2


def test_the_cover_has_lines_to_sign(page: str) -> None:
    cover = page.partition('<header class="cover" id="cover">')[2].partition("</header>")[0]
    assert re.search(r"<th>engineer</th><td>R. Structure</td>", cover)
    assert '<th>checker</th><td><span class="sign"></span></td>' in cover
    assert "<th>date</th><td>2026-11-25</td>" in cover
    digest = hashlib.sha256(PROJECT.encode()).hexdigest()
    assert f"<code>{digest}</code>" in cover
    assert f"input {digest[:12]}" in page.partition("@page {")[2].partition("</style>")[0]


def test_what_governs_are_the_highest_ratios(results: Path, page: str) -> None:
    """Of each check at each level the highest one; counts and scaling aside while they pass."""
    checks = pd.read_csv(results / "checks.csv", keep_default_na=False)
    aside = checks["symbol"].isin(["n", "n_failed", "n_odd", "S_mean"]) & checks["passed"]
    assert aside.sum() >= 5
    aside |= checks["verdict"] == "raised"  # least values, which demands are raised to
    highest = checks[~aside].groupby(["title", "level"])["ratio"].max().nlargest(10)
    part, narrow = section(page, "summary").split('<figure class="bars start">')
    assert narrow.count('class="name"') == len(highest)  # the same for a telephone
    bars = re.findall(r'class="name">(.*?)</text>', part)
    assert [unescape(bar) for bar in bars] == [title for title, _ in highest.index]
    ratios = re.findall(r'<text [^>]*class="ratio">([^<]*)</text>', part)[:-1]
    assert ratios == [f"{ratio:.2f}" for ratio in highest]
    lengths = [float(x) for x in re.findall(r'<rect [^>]*width="([\d.]+)"', part)]
    one = float(re.findall(r'<line x1="([\d.]+)"', part)[0]) - 362.0
    for length, ratio in zip(lengths, highest, strict=True):
        assert length == pytest.approx(one * ratio, abs=0.11) or ratio > 2.5
    assert part.count('class="fails"') == (highest > 1.0).sum()


FAILS = (
    ("s_ms = 1.2", "s_ms = 2.4"),
    ("s_m1 = 0.6", "s_m1 = 1.2"),
    ("400 kN/mm", "5 kN/mm"),
    ('bounds = ["lower", "upper"]', 'bounds = ["lower"]'),
    ("[project]", '[project]\nlanguage = "es"\ndecimal = ","'),
)


@pytest.fixture(scope="module")
def failing(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """Return a project of which every run slips off, judged in Spanish."""
    file = put_example(tmp_path_factory.mktemp("failing")) / "project.toml"
    file.write_text(reduce(lambda text, pair: text.replace(*pair), FAILS, PROJECT))
    done = lir("run", file.parent)
    assert done.exit_code == 1, done.output
    (file.parent / "console.txt").write_text(done.output)
    return file


def test_a_failing_design_names_each_cause_once(failing: Path) -> None:
    """The cover and the console: failed on value and without a valid value apart."""
    checks = pd.read_csv(failing.parent / "results" / "checks.csv", keep_default_na=False)
    void = checks["void"] != ""
    assert (checks["verdict"] == "no value").equals(void)
    assert void.sum() > 10
    assert not checks["passed"][void].any()
    console = (failing.parent / "console.txt").read_text()
    assert f", {void.sum()} without a valid value" in console
    assert console.count("MCE_R, lower: 11 of 11 runs failed") == 1
    assert not re.search(r"before failure.*artificial-1", console)
    page = (failing.parent / "results" / "report.html").read_text(encoding="utf-8")
    cover = re.sub(
        r"<[^>]*>", " ", page.partition('id="verdict"')[2].partition('id="not-checked"')[0]
    )
    assert len(cover.split()) < 350
    assert len(re.findall(r"\d+,\d\d s, bearing", cover)) == 1  # the earliest failure of a cause
    assert f"{void.sum()} de {len(checks)} verificaciones no tienen un valor válido" in cover
    by_value = (checks["verdict"] == "FAILS") & (checks["symbol"] != "n_failed")
    said = f"No se cumplen por su valor {by_value.sum()} de {len(checks)}"
    assert said in " ".join(cover.split())
    linear = section(page, "equivalent-linear-analysis")
    beyond = linear.partition("<ul>")[2].partition("</ul>")[0].count("<li>")
    assert 0 < beyond == linear.count(">no aplica<")  # a drift is no limit of the procedure
    assert ">NO CUMPLE<" in linear
    bars = section(page, "summary")
    assert "sin valor" in bars
    width = float(re.search(r'viewBox="0 0 (\d+)', bars)[1])
    for x, text in re.findall(r'<text x="([\d.]+)"[^>]*class="ratio">([^<]*)<', bars):
        assert float(x) + 7.0 * len(text) < width  # 11 px: no word is cut


def test_a_failing_design_is_in_spanish_throughout(failing: Path) -> None:
    pytest.importorskip("babel")
    run = evaluated_in(failing.parent)
    names = names_of(run)
    words = Words("es", ",", names)
    said = report_in(words, run, failing.read_text(), run_tables(run))
    assert untold(words) == set()
    assert english_words(said, names) == set()
    assert english_words(report_in(Words(), run, "", run_tables(run), figures=False), names)
    assert not [t for t in texts_of(said) if re.search(r"(?<![\w.])\d+\.\d+(?![\w.])", t)]


def test_each_check_says_of_which_runs_its_demand_is(results: Path, page: str) -> None:
    shown = columns(section(page, "checks"), "isolator displacement")
    assert shown["demand is"] == "mean of 7 runs"
    assert columns(section(page, "checks"), "restoring force")["demand is"] == ""


def test_words_stand_where_nothing_is_allowed(page: str) -> None:
    shown = columns(section(page, "checks"), "runs that failed")
    assert (shown["demand"], shown["limit"], shown["ratio"]) == ("none", "none allowed", "")
    text = re.sub(r"<[^>]*>", " ", page.partition("<body")[2].partition('<h2 id="input">')[0])
    assert not re.search(r"\binf\b|\bnan\b", text)


def check_of(demand: float, limit: float, **more: object) -> Check:
    return Check(clause="none", title="a check", demand=demand, limit=limit, **more)


@pytest.mark.parametrize(
    ("check", "said"),
    [
        (check_of(0.0, 0.0), ("none", "", "none allowed", "")),
        (check_of(2.0, 0.0), ("2", "", "none allowed", "")),
        (check_of(0.5, 1.0), ("0.5", "≤", "1", "0.500")),
        (check_of(0.5, 0.0, relation=">="), ("0.5", "≥", "0", "0.000")),
        (check_of(0.5, math.inf), ("0.5", "", "no limit", "")),
        (check_of(math.inf, 1.0), ("not evaluated", "", "1", "")),
        (check_of(math.inf, 1.0, void="a run failed"), ("not known", "", "1", "")),
        (check_of(0.5, 1.0, void="a run failed"), ("(0.5)", "", "1", "")),
    ],
)
def test_checks_in_words(check: Check, said: tuple[str, str, str, str]) -> None:
    shown = judged(check)
    assert (shown.demand, shown.sign, shown.limit, shown.ratio) == said


def test_each_field_of_a_bearing_has_its_term(page: str) -> None:
    names = {field.name for field in fields(LIRBearing)}
    text = page.partition("<body")[2].partition('<h2 id="calculations">')[0]
    text = text.partition('<h3 id="assumptions">')[0]  # which names what to set
    assert not {name for name in names if "_" in name and name in text}


def test_a_bearing_in_words() -> None:
    bearing = LIRBearing(
        radius=(1.5, 1.8),
        slider_height=0.2,
        slider_radius=0.2,
        capacity=math.inf,
        friction=VelocityFriction(f_max=0.06, f_min=0.03, rate=100.0),
        interface_friction=math.inf,
    )
    rows = {row[0]: tuple(row[1:]) for row in device_table(bearing).rows}
    assert rows["radius of the concave surfaces"] == ("1500; 1800", "mm", "given")
    assert rows["friction coefficient of the interface"] == ("rigid slider", "", "given")
    assert rows["displacement capacity, to rim contact"] == ("no restraining rims", "", "given")
    friction = "0.06 at high speed, 0.03 at rest"
    assert rows["friction coefficient of the concave surfaces"] == (friction, "", "given")
    assert rows["axial stiffness of the slider"][1:] == ("kN/m", "default")


def test_wide_tables_are_in_parts() -> None:
    head = ["name", *(f"quantity {k}" for k in range(30))]
    whole = Table(head, [["a", *(f"{k}.123" for k in range(30))]], frozenset({3, 20}))
    parts = in_parts(whole)
    assert len(parts) > 1
    assert [h for part in parts for h in part.head[1:]] == head[1:]
    assert [c for part in parts for c in part.rows[0][1:]] == list(whole.rows[0][1:])
    assert {part.head[k] for part in parts for k in part.left} == {head[3], head[20]}
    assert all(part.head[0] == "name" and part.rows[0][0] == "a" for part in parts)
    narrow = Table(head[:4], [["a", "1", "2", "3"]], frozenset())
    assert in_parts(Table(("members",), []), keep=3) == [Table(["members"], [])]
    kept = in_parts(whole, keep=3)
    assert all(list(part.head[:3]) == head[:3] for part in kept)
    assert [h for part in kept for h in part.head[3:]] == head[3:]
    assert in_parts(narrow) == [Table(head[:4], [["a", "1", "2", "3"]], frozenset())]


def test_strings_of_style_sheets_end_nowhere_else() -> None:
    assert css_string('a "b" </style> \\ c\nd') == ('"a \\22 b\\22  \\3c /style\\3e  \\5c  c d"')


@NEEDS_BROWSER
def test_contents_name_the_pages_of_the_pdf(results, tmp_path, caplog):
    pypdf = pytest.importorskip("pypdf")
    paper = print_report(results / "report.html", tmp_path / "report.pdf")
    assert not caplog.messages
    read = pypdf.PdfReader(paper)
    assert read.metadata["/Producer"].startswith("lir-dcfp ")
    pages = pages_of(read)
    texts = [page.extract_text() for page in read.pages]
    assert 5 <= len(texts) <= 60
    for anchor, title in SECTIONS:
        assert title in texts[pages[anchor] - 1]
        assert re.search(rf"{title}\s*{pages[anchor]}\b", texts[1]), title
    assert not re.search(r"\d+ / \d+", texts[0])
    assert all(f"{k} / {len(texts)}" in text for k, text in enumerate(texts[1:], start=2))
    assert {entry.title for entry in read.outline[1] if not isinstance(entry, list)} >= {
        title for _, title in SECTIONS
    }

    def bare(text: str) -> str:  # without spaces, and without ligatures, which print "floor" has
        return "".join(unicodedata.normalize("NFKC", text).split())

    printed = [bare(text) for text in texts]
    headings = re.findall(r"<h3[^>]*>(.*?)</h3>", (results / "report.html").read_text(), re.DOTALL)
    assert len(headings) > 20
    for heading in headings:  # none begins at the foot of a page and ends on the next
        words = bare(unescape(re.sub(r"<[^>]*>", "", heading)))
        assert any(words in text for text in printed), heading


def test_lines_of_calculations_and_colours(page: str) -> None:
    """Values alone, which have one sign of equality, are told from formulas; colours are there."""
    calculations = page.split('<h2 id="calculations">')[1]
    lines = re.findall(r"<div( class=\"given\")?>(<math>.*?</math>)", calculations)
    given = [bool(marked) for marked, _ in lines]
    assert given == [line.count("<mo>=</mo>") == 1 for _, line in lines]
    assert 0 < sum(given) < len(lines)
    style = page[page.index("<style>") : page.index("</style>")]
    assert set(re.findall(r"var\((--\w+)\)", style)) <= set(re.findall(r"(--\w+):", style))


def test_a_pdf_needs_a_browser(results, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ProjectError, match=r"no browser that prints is on PATH .*: install"):
        print_report(results / "report.html", tmp_path / "report.pdf")
    broken = tmp_path / "chromium"
    broken.write_text("#!/bin/sh\nexit 3\n")
    broken.chmod(0o755)
    with pytest.raises(ProjectError, match="did not print"):
        print_report(results / "report.html", tmp_path / "report.pdf")


def test_prints_that_never_agree_are_told(results, tmp_path, monkeypatch):
    pytest.importorskip("pypdf")
    prints = iter(range(100))
    monkeypatch.setattr(report_files, "_browser", lambda: "none")
    monkeypatch.setattr(report_files, "_print", lambda *_: None)
    monkeypatch.setattr("pypdf.PdfReader", lambda _: None)
    monkeypatch.setattr(report_files, "pages_of", lambda _: {"checks": next(prints)})
    with pytest.raises(ProjectError, match="contents are still wrong after 4 prints"):
        print_report(results / "report.html", tmp_path / "report.pdf")
    assert next(prints) == 4


@pytest.fixture(scope="module")
def evaluated(results: Path) -> ProjectRun:
    """The run as `lir report` evaluates it."""
    return evaluated_in(results.parent)


def evaluated_in(folder: Path) -> ProjectRun:
    parts = ProjectInputs(read_project(folder / "project.toml"), folder)
    known = preliminary(parts)
    histories = read_histories(folder / "results", inputs_of(parts, known))
    return evaluate_run(parts, known, *histories)


def test_lines_of_the_figure_of_motions_are_the_demands(results, evaluated):
    demands = pd.read_csv(results / "demands.csv", index_col=0)
    figure = motions_figure(evaluated)
    rows = (("isolator displacement", 1e3), ("interface slip", 1e3), ("storey drift ratio", 1e2))
    for panel, (name, factor) in zip(figure.axes, rows, strict=True):
        assert panel.get_title(loc="left").startswith(f"{name}: ")
        marks, lines = panel.lines[0::2], panel.lines[1::2]
        for k, bound in enumerate(("lower", "upper")):
            design = factor * demands.filter(like=f"{bound},").loc[name].item()
            assert lines[k].get_ydata()[0] == pytest.approx(design, rel=1e-12)
            assert np.mean(marks[k].get_ydata()) <= design * (1.0 + 1e-12)  # moved masses raise it
            assert len(marks[k].get_ydata()) == 7


def test_bearings_in_plan_reach_the_ratio_that_governs(results, evaluated):
    check, shares = utilisation(evaluated)
    checks = pd.read_csv(results / "checks.csv", keep_default_na=False)
    of_bearings = checks[checks["subject"].isin(list(evaluated.frame.bearings))]
    assert check.ratio == pytest.approx(of_bearings["ratio"].max(), rel=1e-12)
    assert shares.max() == pytest.approx(check.ratio, rel=1e-12)
    assert list(evaluated.frame.bearings)[int(shares.argmax())] == check.subject
    runs = load(results / f"runs-{check.bound}.nc")
    assert check.title == "normalised eccentricity e/a"
    mean = runs["peak_eccentricity_loaded"].mean("run").to_numpy()
    raised = pd.read_csv(results / "eccentricity.csv")
    of = (raised["bound"] == check.bound) & (raised["quantity"] == "eccentricity loaded")
    assert shares == pytest.approx((mean + raised[of]["added"].max()) / check.limit, rel=1e-12)


def test_the_typical_bearing_is_the_median() -> None:
    names = ["a", "b", "c", "d"]
    path = np.zeros((2, 4, 3))
    path[1, :, 0] = 4.0, 1.0, 2.0, 3.0
    data = xr.Dataset(
        {"bearing_displacement": (("time", "bearing", "axis"), path)},
        coords={"time": [0.0, 1.0], "bearing": names, "axis": ["x", "y", "z"]},
    )
    assert typical_bearing(data) == "c"


@pytest.mark.parametrize("storeys", [1, 3])
def test_drifts_of_all_motions_over_the_height(storeys: int) -> None:
    drift = np.arange(1.0, 1.0 + 7 * storeys).reshape(7, storeys) * 1e-3
    lasting = np.zeros((7, 1))
    data = xr.Dataset(
        {
            "peak_drift": (("run", "storey"), drift),
            "peak_time_lifted": (("run", "bearing"), lasting),
            "peak_gap": (("run", "bearing"), lasting),
            "status": ("run", ["ok"] * 7),
            "motion": ("run", list("abcdefg")),
            "scale": ("run", np.ones(7)),
        },
        coords={"storey": [f"floor-{k + 1}" for k in range(storeys)]},
    )
    rules = HISTORY_RULES["ASCE 7-22"]
    level = rules.levels[0].name
    run = SimpleNamespace(rules=rules, cases=[Case(Runs(data), rules, level, "lower")])
    figure = profiles_figure(run)
    if storeys == 1:
        assert figure is None
        return
    stairs = [patch.get_data().values for patch in figure.axes[0].patches]
    assert len(stairs) == 8
    assert stairs[-1] == pytest.approx(1e2 * drift.mean(axis=0))
    assert [t.get_text() for t in figure.axes[0].get_yticklabels()] == list(data["storey"].values)


def names_of(run: ProjectRun) -> set[str]:
    """Return the names that the user gave, or that were made for them."""
    frame = run.frame
    levels = {level.name for level in frame.levels}
    return {frame.name, *frame.bearings, *frame.nodes, *run.motions, *levels}


def test_the_report_in_spanish(results: Path, evaluated: ProjectRun, page: str) -> None:
    """Every text that is ours is said, those of figures included; numbers and clauses are alike."""
    pytest.importorskip("babel")
    names = names_of(evaluated)
    words = Words("es", ",", names)
    tables = run_tables(evaluated)
    said = report_in(words, evaluated, PROJECT, tables)
    assert untold(words) == set()
    assert english_words(said, names) == set()
    assert '<html lang="es">' in said
    assert "Qué controla" in said
    own, ours = (texts_of(text) for text in (page, said))
    assert len(own) == len(ours)
    numbers = sorted(n.replace(",", ".") for cell in ours for n in NUMBER.findall(cell))
    assert len(numbers) > 500
    assert numbers == sorted(n for cell in own for n in NUMBER.findall(cell))
    assert not any(re.search(r"(?<![\w.])\d+\.\d+(?![\w.])", cell) for cell in ours)


NUMBER = re.compile(r"(?<![\w.,])\d+(?:[.,]\d+)?(?![\w.]|,\d)")


def texts_of(page: str) -> list[str]:
    """Return the cells of all tables under headings but those of first columns, and clauses."""
    part = page.partition('<h2 id="structure">')[2].partition('<h2 id="calculations">')[0]
    rows = [re.findall(r"<td[^>]*>(.*?)</td>", row, re.S) for row in part.split("</tr>")]
    cells = [unescape(c) for row in rows for c in row[1:]]  # tables are in other parts
    return [c for c in cells if not re.search(r"ASCE|theory", c)]


def test_each_point_of_the_check_list_has_its_place(page: str) -> None:
    text = (Path(__file__).parents[2] / "docs" / "report_checklist.md").read_text(encoding="utf-8")
    points = re.findall(r"^\| (\d+) \| .*\? \| `#([a-z-]+)` \|$", text, re.M)
    assert [int(number) for number, _ in points] == list(range(1, 31))
    anchors = {anchor for _, anchor in points} | set(re.findall(r"`#([a-z-]+)`", text))
    assert anchors <= set(re.findall(r' id="([a-z-]+)"', page))
    assert len(anchors) > 15
