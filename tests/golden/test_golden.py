"""Projects run by the command, every reported number recomputed by a script without the package."""

import ast
import importlib
import json
import re
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")
pytest.importorskip("typer")

from typer.testing import CliRunner

from frames.command.app import app
from frames.design.project import example
from frames.design.project.example import write_example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from validation.golden_review import GOLDEN, Review, prepared, projects, recomputed, review, table

RUN = {
    "01-asce-frame": ("lower", "nominal"),
    "09-nch-shear": ("lower",),
    "11-en-types": ("lower", "upper"),
    "12-nch-types": ("lower",),
    "13-asce-types": ("upper",),
    "14-asce-etabs": ("lower",),
}
DAILY = {"11-en-types", "14-asce-etabs"}
"""A frame of members, a stick, frames with loads by area, types of bearings and moved masses, and a
model of ETABS;
three codes, means and largest, with the bounds that are run here, the frames at the level that is
soonest done. The suite runs two of them; `make nightly` runs all, three as they are, with all
bounds, and `validation.golden_review` all projects."""
LEAST = {
    "peaks of all runs, from histories": 2000,
    "demands: statistics over motions": 80,
    "demands of each motion": 400,
    "equivalent-linear analysis": 16,
    "demands and limits of checks": 60,
    "tables of the report": 800,
    "factors of scaling": 9,
    "programme of tests": 100,
    "reactions of bearings, from histories": 2000,
    "storey forces, from histories": 400,
}
"""Numbers of values that each project of three bounds compares at least: a comparison that is
skipped is seen."""
SHARE = {"01-asce-frame": 2 / 3, "09-nch-shear": 1 / 3, "11-en-types": 0.4}
SHARE |= {"12-nch-types": 0.2, "13-asce-types": 0.2, "14-asce-etabs": 0.15}
"""Of these, of the projects as they are run here."""
OF_TYPES = {"moved masses: raises of each way": 280, "loads and masses, by hand": 4}
OF_TYPES |= {"reactions by combination": 2000, "members by combination": 10000}
OF_TYPES |= {"tension of a restraint": 24}
"""Of what projects with types of bearings alone have."""
CHANGED = {  # file, what is changed, to what, in which category it is seen, and where there
    "09-nch-shear": [
        (
            "demands.csv",
            r"^(isolator displacement,m,)(\d\.\d{3})\d",
            r"\g<1>\g<2>9",
            "demands: statistics",
            "isolator displacement lower",
        ),
        (
            "demands-by-motion.csv",
            r"^(\w+,lower,,[^,]+,1.0,ok,\w+,0\.\d\d)\d\d",
            r"\g<1>99",
            "demands of each motion",
            "lower isolator displacement",
        ),
        ("checks.csv", r",FAILS$", ",ok", "ratios and verdicts", "verdict"),
        (
            "report.html",
            r"(<tr><td[^>]*>lower</td><td[^>]*>)(\d)",
            r"\g<1>9\g<2>",
            "tables of the report",
            "linear lower",
        ),
        (
            "equivalent-linear.csv",
            r"^(lower,0\.\d{5})\d",
            r"\g<1>",
            "equivalent-linear",
            "lower displacement",
        ),
        ("programme.csv", r",3\.0,", ",4.0,", "programme of tests", "cycles"),
        (
            "reactions.csv",
            r"(0-1,above,N,max,N,[\d.]+,)(\d)",
            r"\g<1>9\g<2>",
            "reactions of bearings",
            "0-1 above N max",
        ),
        ("storeys.csv", r"(Fz,max,N,[-\d.]+,-)(\d)", r"\g<1>9\g<2>", "storey forces", "permanent"),
    ],
    "11-en-types": [
        (
            "eccentricity.csv",
            r"^(design,upper,\+x,displacement,m,[\d.]+,[\d.]+,1\.0)\d",
            r"\g<1>9",
            "moved masses",
            r"upper \+x displacement factor",
        ),
        (
            "eccentricity.csv",
            r"^(design,upper,-y,displacement left,m,[^,]+,[^,]+,,)[^,]+",
            r"\g<1>0.5",
            "moved masses",
            "upper -y displacement_left added",
        ),
        (
            "member-groups.csv",
            r"^(beam-x-base at 0.2 m,4,Vz,N,-)(\d)",
            r"\g<1>9\g<2>",
            "groups of members",
            "beam-x-base",
        ),
        (
            "reactions.csv",
            r"^(design,upper,bearing-2-1,below,N,max,N,[\d.]+,[\d.]+,)[\d.]+",
            r"\g<1>12345.0",
            "reactions of bearings",
            "2-1 below N max",
        ),
        (
            "storeys.csv",
            r"^(design,upper,floor-2,Vx,max,N,)[\d.]+",
            r"\g<1>12345.0",
            "storey forces",
            "floor-2 Vx max",
        ),
        (
            "reaction-combinations.csv",
            r"(bearing-1-1,below,N,max,N,m\d,)(\d)",
            r"\g<1>9\g<2>",
            "reactions by combination",
            "bearing-1-1 below N max$",
        ),
        (
            "uplift.csv",
            r"^(bearing-1-1,design,\w+,[^,]+,)(\d)",
            r"\g<1>9\g<2>",
            "tension of a restraint",
            "bearing-1-1 least",
        ),
        (
            "bearings.csv",
            r"^(bearing-1-1,\d+,[A-Z]-\d+,)heavy",
            r"\1standard",
            "table of bearings",
            "bearing-1-1 type",
        ),
        (
            "friction.csv",
            r'^("interface, heavy",[\d.]+,)0.14',
            r"\g<1>0.12",
            "table of friction",
            "interface, heavy nominal",
        ),
        (
            "checks.csv",
            r",(sliding under wind,)60000\.0,",
            r",\g<1>70000.0,",
            "demands and limits",
            "sliding under wind",
        ),
        (
            "checks.csv",
            r"(,clearance to the moat wall,[\d.]+,)0\.33,",
            r"\g<1>0.44,",
            "demands and limits",
            "clearance to the moat wall",
        ),
    ],
    "12-nch-types": [
        (
            "friction.csv",
            r'^("bottom surface, middle",)[\d.]+',
            r"\g<1>0.048",
            "table of friction",
            "bottom surface, middle lower",
        ),
        (
            "demands-by-motion.csv",
            r"^(maximum,lower,-x,[^,]+,[^,]+,ok,no,)[\d.]+",
            r"\g<1>0.2",
            "demands of each motion",
            "lower isolator displacement",
        ),
        (
            "equivalent-linear.csv",
            r"^(lower,0\.\d{5})\d",
            r"\g<1>",
            "equivalent-linear",
            "lower displacement",
        ),
    ],
    "14-asce-etabs": [
        (
            "report.html",
            r"frame objects by story \(33\)",
            "frame objects by story (34)",
            "tables of the report",
            "import",
        ),
        (
            "bearings.csv",
            r"^(bearing-1-Base,(?:[^,]*,)*?)(\d{6}\.\d+)",
            r"\g<1>100000.0",
            "equivalent-linear",
            "lower",
        ),
    ],
}
Reviewed = Callable[[str], tuple[Path, Review]]


def run_daily(names: Iterable[str]) -> list[object]:
    """Return projects as parameters: but for two, in `make nightly`."""
    marks = {name: [] if name in DAILY else [pytest.mark.nightly] for name in names}
    return [pytest.param(name, marks=marks[name]) for name in marks]


OWN = {
    "building",
    "checks",
    "codes",
    "demands",
    "described",
    "forces",
    "ground",
    "histories",
    "imported",
    "motions",
    "reading",
    "report",
    "tally",
}
MODULES = [GOLDEN / f"{name}.py" for name in (*sorted(OWN), "recompute")]


def written(name: str, folder: Path) -> Path:
    """Write a project that runs the bounds of RUN alone; returns its folder."""
    own = prepared(GOLDEN / "projects" / f"{name}.toml", folder)
    text = (own / "project.toml").read_text(encoding="utf-8")
    bounds = f"bounds = {json.dumps(RUN[name])}\n"
    if bounds not in text:
        text += bounds
    if name == "01-asce-frame":
        text += 'level = "pendulum"\n'
    (own / "project.toml").write_text(text, encoding="utf-8")
    return own


def ran(own: Path) -> Review:
    """Run a project by the command, in this process, and recompute what it reports."""
    file, results = str(own / "project.toml"), str(own / "results")
    done = CliRunner().invoke(app, ["run", "--no-figures", file, "--results", results])
    assert done.exit_code in {0, 1}, done.output
    return recomputed(own)


@pytest.fixture(scope="module")
def reviewed(tmp_path_factory) -> Reviewed:
    """The projects of RUN, each run once: its folder and what was compared."""
    folder, kept = tmp_path_factory.mktemp("golden"), dict[str, tuple[Path, Review]]()

    def of(name: str) -> tuple[Path, Review]:
        if name not in kept:
            own = written(name, folder)
            kept[name] = own, ran(own)
        return kept[name]

    return of


def test_the_recomputation_imports_nothing_of_the_package():
    allowed = OWN | {
        "numpy",
        "h5py",
        "csv",
        "functools",
        "html",
        "json",
        "math",
        "pathlib",
        "re",
        "sys",
        "tomllib",
    }
    for module in MODULES:
        tree = ast.parse(module.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            named = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            named += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert {name.partition(".")[0] for name in named} <= allowed, module
        words = module.read_text(encoding="utf-8")
        assert not re.search(r"importlib|__import__|exec\(|runpy|subprocess", words), module


def test_there_are_projects_of_three_codes_and_kinds():
    texts = [path.read_text(encoding="utf-8") for path in projects()]
    assert len(texts) == 14
    for key, kinds in (("code", 3), ("kind", 4)):
        found = [re.search(rf'^{key} = "(.*)"', text, re.M)[1] for text in texts]
        assert all(found.count(word) >= 2 for word in set(found) - {"etabs"})
        assert len(set(found)) == kinds


def test_an_example_from_sap2000_weighs_what_its_tables_say(tmp_path, monkeypatch):
    pytest.importorskip("openseespy")
    monkeypatch.setattr(example, "PULSES", {"artificial-1": 1.9})
    monkeypatch.syspath_prepend(str(GOLDEN))
    tables = importlib.import_module("imported").Tables
    write_example(tmp_path, building="imported")
    parts = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path)
    dead, live, mass = tables(tmp_path / "office.s2k").cases()
    system = parts.system(parts.provisional_frame(), parts.spectrum())
    assert system.seismic_weight == pytest.approx(9.80665 * mass, rel=1e-9)
    assert sum(system.loads) == pytest.approx(dead + 0.3 * live, rel=1e-6)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")  # the command prints warnings
@pytest.mark.parametrize("name", run_daily(RUN))
def test_every_reported_number_is_found_again(name, reviewed):
    agrees(reviewed(name)[1], SHARE[name])


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("name", run_daily(name for name in RUN if name.endswith("types")))
def test_moved_masses_types_and_loads_are_recomputed(name, reviewed):
    counts = reviewed(name)[1].counts
    few = {name: counts.get(name, 0) for name in OF_TYPES}
    assert all(count >= OF_TYPES[name] for name, count in few.items()), few


@pytest.mark.nightly
@pytest.mark.parametrize("name", ["01-asce-frame", "05-en-shear", "09-nch-shear"])
def test_every_reported_number_of_all_bounds_is_found_again(name, tmp_path):
    agrees(review(prepared(GOLDEN / "projects" / f"{name}.toml", tmp_path)))


def agrees(found: Review, share: float = 1.0):
    assert not found.bad, table({"": found})
    assert not found.missing, table({"": found})
    few = {name: found.counts.get(name, 0) for name in LEAST}
    assert all(count >= share * LEAST[name] for name, count in few.items()), few


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("name", run_daily(CHANGED))
def test_numbers_that_are_changed_are_seen(name, reviewed, tmp_path):
    """Otherwise the comparison would be one that cannot fail. Each is seen where it is read."""
    own = Path(shutil.copytree(reviewed(name)[0], tmp_path / "changed"))
    for file, old, new, *_ in CHANGED[name]:
        path = own / "results" / file
        text = path.read_text(encoding="utf-8")
        changed = re.sub(old, new, text, count=1, flags=re.M)
        assert changed != text, (file, old)
        path.write_text(changed, encoding="utf-8")
    bad = recomputed(own).bad
    for _, old, _, category, where in CHANGED[name]:
        assert any(category in row[0] and re.search(where, row[1]) for row in bad), (old, bad)
