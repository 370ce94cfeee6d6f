"""docs/validation: a page for each claim, all in the index, figures there and small."""

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest
from jinja2 import meta

import validation
from validation import page
from validation.measurements.opensees_cost import BASE, verdict
from validation.page import CLAIMS, FOLDER, TEMPLATES, index
from validation.study import runner, shown

MEASUREMENTS = (
    "benchmark",
    "speed_error",
    "opensees_hard_cases",
    "opensees_cost",
    "opensees_public_models",
    "robustness",
    "slip",
    "study",
    "study_summary",
    "study_near_fault",
    "study_loss",
    "study_uncertainty",
    "study_device",
    "study_buildings",
    "study_motions",
    "study_after",
    "level_doubts",
    "performance",
    "features",
    "worked_building",
    "yielding",
    "yielding_comparison",
)
PACKAGE = Path(str(validation.__file__)).parent
FIGURE = re.compile(r"!\[[^\]]+\]\((figures/[^)]+)\)")
claims = pytest.mark.parametrize("name", CLAIMS)


def text_of(name: str) -> str:
    return (FOLDER / f"{name}.md").read_text(encoding="utf-8")


def test_every_script_is_listed():
    found = {
        path.stem
        for path in (PACKAGE / "claims").glob("*.py")
        if re.search(r"^CLAIM = ", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert found == set(CLAIMS)


@claims
def test_a_script_names_its_claim(name):
    module = import_module(f"validation.claims.{name}")
    claim = module.CLAIM
    assert claim.name == name
    assert claim.statement
    assert claim.source
    assert callable(module.page)
    assert f"python -m validation.claims.{name}" in module.__doc__
    assert "Source" in module.__doc__


@claims
def test_a_script_has_its_page(name):
    claim = import_module(f"validation.claims.{name}").CLAIM
    text = text_of(name)
    assert text.startswith(f"# {claim.title}\n")
    assert f"| {claim.statement} | {claim.source} |" in text
    assert FIGURE.search(text)


@claims
def test_all_statements_hold(name):
    assert "**no**" not in text_of(name)


def test_the_index_is_that_of_the_pages():
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert text == index(), "run: python -m validation"
    assert all(f"]({name}.md) |" in text for name in CLAIMS)


@pytest.mark.parametrize("name", MEASUREMENTS)
def test_measurements_are_in_the_index(name):
    assert f"({name}.md)" in text_of("README")
    command = name.replace("study_", "study[. ]").replace("robustness", "random_scenes")
    assert re.search(rf"python -m validation\.(measurements\.)?{command}\b", text_of(name))


def test_pages_and_figures_belong_to_claims():
    pages = (*CLAIMS, *MEASUREMENTS)
    assert {path.stem for path in FOLDER.glob("*.md")} == {"README", *pages}
    shown = {target for name in pages for target in FIGURE.findall(text_of(name))}
    there = {f"figures/{path.name}" for path in (FOLDER / "figures").iterdir()}
    assert there == shown


def test_tables_belong_to_pages():
    linked = re.findall(r"\(tables/([^)]+)\)", "".join(map(text_of, MEASUREMENTS + CLAIMS)))
    kept = {path.name for path in (FOLDER / "tables").iterdir()}
    assert set(linked) == {name for name in kept if not name.startswith("study")}


def test_tables_are_kept_as_csv(tmp_path, monkeypatch):
    monkeypatch.setattr(page, "FOLDER", tmp_path)
    link = page.as_csv("runs", lambda: "\n| case | `a` |\n| --- | --- |\n| x, y | **no** |\n")
    assert link == "[runs.csv](tables/runs.csv) (1 rows)"
    assert (tmp_path / "tables/runs.csv").read_text() == 'case,a\n"x, y",no\n'


def test_figures_are_small():
    for path in (FOLDER / "figures").iterdir():
        assert path.stat().st_size < (1_500_000 if path.suffix == ".gif" else 200_000), path.name


def test_each_coupling_is_held_against_its_goal():
    times = {BASE: [1.0, 2.0], "LIR-DCFP, in-process coupling": [1.2, 2.8]}
    times["LIR-DCFP, out-of-process coupling"] = [3.5, 7.5]
    assert verdict("house", times) == (
        "house: in-process 1.30 (met), out-of-process 3.62 (**missed**)."
    )


def rendered():
    """Module, template and names given of every call of `render`."""
    for path in sorted(PACKAGE.rglob("*.py")):
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "render":
                if ast.unparse(call.args[0]) != "globals()":
                    continue  # the parts of the study that are campaign files
                name = call.args[1].value if len(call.args) > 1 else path.stem
                given = {keyword.arg for keyword in call.keywords}
                yield path, path.with_name(f"{name}.md.j2"), given


def of_parts():
    """Template and module of every part of the study that is a campaign file."""
    for template in sorted((PACKAGE / "study").glob("*.md.j2")):
        part = template.name.removesuffix(".md.j2")
        if runner.files_of(part):
            yield template, runner.own_module(part)


def test_templates_have_the_names_they_use():
    found = list(rendered())
    parts = dict(of_parts())
    assert {template for _, template, _ in found} | set(parts) == set(PACKAGE.rglob("*.md.j2"))
    given = {"own", "campaigns", "only", "figure_of", "written", *vars(shown)}
    for template, module in parts.items():
        used = meta.find_undeclared_variables(TEMPLATES.parse(template.read_text("utf-8")))
        assert used <= given | set(vars(module or shown)) | set(TEMPLATES.globals), template.name
    for path, template, given in found:
        used = meta.find_undeclared_variables(TEMPLATES.parse(template.read_text("utf-8")))
        module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        own = set(vars(import_module(module)))
        assert used <= own | given | set(TEMPLATES.globals), template.name
        assert given <= used, template.name


def test_a_script_runs_when_all_of_it_is_defined():
    for path in PACKAGE.rglob("*.py"):
        body = ast.parse(path.read_text(encoding="utf-8")).body
        assert not any("__main__" in ast.unparse(each) for each in body[:-1]), path
