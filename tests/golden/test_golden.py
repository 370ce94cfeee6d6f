"""Projects run by the command, every reported number recomputed by a script without the package."""

import ast
import re
from pathlib import Path

import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")
pytest.importorskip("typer")

from validation.golden_review import GOLDEN, Review, prepared, projects, recomputed, review, table

RUN = {
    "01-asce-frame": ("lower", "nominal"),
    "05-en-shear": ("upper",),
    "09-nch-shear": ("lower",),
}
"""A frame and sticks, three codes, means and largest, with the bounds that are run here, the frame
at the level that is soonest done; `make nightly` runs these as they are, with all bounds,
`validation.golden_review` all ten projects."""
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
OWN = {
    "checks",
    "codes",
    "demands",
    "described",
    "forces",
    "ground",
    "histories",
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
    assert text.count('histories = "all"\n') == 1
    bounds = f'histories = "all"\nbounds = {list(RUN[name])}\n'
    if "frame" in name:
        bounds += 'level = "pendulum"\n'
    text = text.replace('histories = "all"\n', bounds)
    (own / "project.toml").write_text(text, encoding="utf-8")
    return own


@pytest.fixture(scope="module")
def first(tmp_path_factory) -> tuple[Path, Review]:
    """The smallest project, run once: its folder and what was compared."""
    own = written("09-nch-shear", tmp_path_factory.mktemp("golden"))
    return own, review(own)


def test_the_recomputation_imports_nothing_of_the_package():
    allowed = OWN | {
        "numpy",
        "h5py",
        "csv",
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


def test_there_are_ten_projects_of_three_codes_and_kinds():
    texts = [path.read_text(encoding="utf-8") for path in projects()]
    assert len(texts) == 10
    for key in ("code", "kind"):
        found = [re.search(rf'^{key} = "(.*)"', text, re.M)[1] for text in texts]
        assert all(found.count(word) >= 2 for word in set(found))
        assert len(set(found)) == 3


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in RUN if name != "09-nch-shear"])
def test_every_reported_number_is_found_again(name, tmp_path):
    agrees(review(written(name, tmp_path)), share=len(RUN[name]) / 3)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name, bounds in RUN.items() if len(bounds) < 3])
def test_every_reported_number_of_all_bounds_is_found_again(name, tmp_path):
    agrees(review(prepared(GOLDEN / "projects" / f"{name}.toml", tmp_path)))


@pytest.mark.slow
def test_every_number_of_two_levels_is_found_again(first):
    agrees(first[1], share=len(RUN["09-nch-shear"]) / 3)


def agrees(found: Review, share: float = 1.0):
    assert not found.bad, table({"": found})
    assert not found.missing, table({"": found})
    few = {name: found.counts.get(name, 0) for name in LEAST}
    assert all(count >= share * LEAST[name] for name, count in few.items()), few


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "old", "new", "category"),
    [
        ("demands.csv", r"(?m)^(isolator displacement,m,)(\d\.\d{3})\d", r"\g<1>\g<2>9", "demands"),
        (
            "demands-by-motion.csv",
            r"(?m)^(\w+,lower,,[^,]+,1.0,ok,\w+,0\.\d\d)\d\d",
            r"\g<1>99",
            "demands of each motion",
        ),
        ("checks.csv", r",FAILS$", ",ok", "ratios and verdicts"),
        ("report.html", r"(<tr><td>lower</td><td>)(\d)", r"\g<1>9\g<2>", "tables of the report"),
        ("equivalent-linear.csv", r"(?m)^(lower,0\.\d{5})\d", r"\g<1>", "equivalent-linear"),
        ("programme.csv", r",3\.0,", ",4.0,", "programme of tests"),
        (
            "reactions.csv",
            r"(0-1,above,N,max,N,[\d.]+,)(\d)",
            r"\g<1>9\g<2>",
            "reactions of bearings",
        ),
        ("storeys.csv", r"(Fz,max,N,[-\d.]+,-)(\d)", r"\g<1>9\g<2>", "storey forces"),
    ],
)
def test_a_number_that_is_changed_is_seen(first, name, old, new, category):
    """Otherwise the comparison would be one that cannot fail."""
    own, _ = first
    path = own / "results" / name
    text = path.read_text(encoding="utf-8")
    changed = re.sub(old, new, text, count=1, flags=re.M)
    assert changed != text
    path.write_text(changed, encoding="utf-8")
    try:
        assert any(category in row[0] for row in recomputed(own).bad)
    finally:
        path.write_text(text, encoding="utf-8")
