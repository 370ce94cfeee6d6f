"""What contributors are given agrees with itself: versions, commands, hooks."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def text_of(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_one_version(project: dict[str, Any]) -> None:
    version = project["project"]["version"]
    assert f"\nversion: {version}\n" in text_of("CITATION.cff")
    assert f"version = {{{version}}}" in text_of("README.md")
    assert f'`git tag -a v{version} -m "{version}"`' in text_of("CONTRIBUTING.md")
    date = re.search(r"date-released: (.*)", text_of("CITATION.cff"))[1]
    assert f"\n## {version} - {date}\n" in text_of("CHANGELOG.md")


def test_the_changelog_has_a_place_for_the_next_change() -> None:
    assert re.findall(r"^## (.*)$", text_of("CHANGELOG.md"), re.MULTILINE)[0] == "Unreleased"


def test_the_workflow_runs_every_supported_python(project: dict[str, Any]) -> None:
    named = [c.rpartition(" ")[2] for c in project["project"]["classifiers"] if ":: 3." in c]
    workflow = text_of(".github/workflows/checks.yml")
    assert f"python: {named}".replace("'", '"') in workflow
    minors = " ".join(version.split(".")[1] for version in reversed(named))
    assert f'versions="{minors}"' in text_of(".ci/venv")


def test_hooks_have_the_rules_of_the_project(project: dict[str, Any]) -> None:
    wanted = [Requirement(r) for r in project["project"]["optional-dependencies"]["dev"]]
    ruff = next(r for r in wanted if r.name == "ruff")
    pinned = re.findall(r'"ruff==([\d.]+)"', text_of(".pre-commit-config.yaml"))
    assert len(pinned) == 2
    assert all(ruff.specifier.contains(version) for version in pinned)


def test_targets_that_the_pages_name_exist() -> None:
    targets = set(re.findall(r"^([a-z]+):", text_of("Makefile"), re.MULTILINE))
    for page in ("README.md", "CONTRIBUTING.md", ".github/workflows/checks.yml"):
        assert set(re.findall(r"(?:`|    |run: )make ([a-z]+)", text_of(page))) <= targets
