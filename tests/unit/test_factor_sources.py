"""Factors on friction by source in a project's file, put together as each code does, by hand."""

from __future__ import annotations

from pathlib import Path

import pytest

from frames.design import ProjectError, PropertyBounds
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.report.cover import factor_steps
from tests.refusals import refused
from tests.scenes import MOTIONS, STICK, project_head

SPECTRUM = '[spectrum]\npoints = [["0 s", "0.6 g"], ["1 s", "0.8 g"], ["5 s", "0.1 g"]]\n'
PROJECT = project_head("Sources", "CODE") + STICK + MOTIONS + SPECTRUM
AGED = "ageing = [1.0, 1.2]\ncontamination = [0.9, 1.1]\n"
TESTED = "test = [0.85, 1.25]\nspecification = [0.9, 1.15]\n"


def bounds_of(folder: Path, text: str, code: str = "ASCE 7-22") -> PropertyBounds:
    (folder / "site.toml").write_text(PROJECT.replace("CODE", code) + text, encoding="utf-8")
    return ProjectInputs(read_project(folder / "site.toml"), folder).bounds()


def test_asce_adjusts_ageing_and_keeps_floors(tmp_path: Path) -> None:
    full = f"[bounds.friction]\n{AGED}{TESTED}full_scale_tests = true\n"
    found = bounds_of(tmp_path, full)
    upper = (1.0 + 0.75 * (1.2 * 1.1 - 1.0)) * 1.25 * 1.15
    lower = (1.0 - 0.75 * (1.0 - 0.9)) * 0.85 * 0.9
    assert found.friction.upper == pytest.approx(upper, rel=1e-12)
    assert found.friction.lower == pytest.approx(lower, rel=1e-12)
    assert found.interface_factors is found.friction
    kept = bounds_of(tmp_path, f"[bounds.friction]\n{AGED}{TESTED}")
    assert kept.friction.upper == pytest.approx(max(upper, 1.8))
    assert kept.friction.lower == pytest.approx(0.60)
    apart = bounds_of(tmp_path, "[bounds]\nfriction = [0.8, 1.3]\n[bounds.interface]\n" + AGED)
    assert (apart.friction.lower, apart.friction.upper) == (0.8, 1.3)
    assert apart.interface_factors.upper == 1.8
    [(what, steps)] = factor_steps(apart)
    assert what == "Factors on the friction of the interface"
    assert len(steps) == len(apart.interface_factors.trace)
    assert not factor_steps(bounds_of(tmp_path, "[bounds]\nfriction = [0.8, 1.3]\n"))


def test_en_combines_by_importance(tmp_path: Path) -> None:
    text = (
        "[bounds.friction]\nageing = [1.0, 1.1]\ntemperature = [1, 1.2]\n"
        'specification = [0.9, 1.2]\nimportance_class = "III"\n'
    )
    found = bounds_of(tmp_path, text, "EN 1998").friction
    assert found.upper == pytest.approx(1.2 * (1.0 + 0.1 * 0.9) * (1.0 + 0.2 * 0.9), rel=1e-12)
    assert found.lower == 0.9


def test_a_code_without_a_rule_takes_the_product(tmp_path: Path) -> None:
    found = bounds_of(tmp_path, f"[bounds.friction]\n{AGED}{TESTED}", "NCh2745").friction
    assert found.upper == pytest.approx(1.2 * 1.1 * 1.25 * 1.15, rel=1e-12)
    assert found.lower == pytest.approx(0.9 * 0.85 * 0.9, rel=1e-12)
    alone = bounds_of(tmp_path, "[bounds.friction]\nwear = [1.0, 1.3]\n", "NCh2745").friction
    assert (alone.lower, alone.upper) == (1.0, 1.3)


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("ageing = [1.1, 1.2]", "ASCE 7-22", "lower factor of aging = 1.1 .* give the lower at m"),
        ("ageing = [1.1, 1.2]", "NCh2745", "lower factor of ageing = 1.1 .* give the lower at m"),
        ("ageing = [0.9, 1.2]", "EN 1998", "only raise friction"),
        ("test = [0.9, 1.2]", "EN 1998", "test is not a source of factors"),
        ("wear = [1.0, 1.2]", "ASCE 7-22", "wear is not a source of factors"),
        ('importance_class = "II"', "NCh2745", "importance_class is not a source"),
        ("ageing = 1.2", "ASCE 7-22", "bounds.friction.ageing = 1.2 must be a list"),
        ("agieng = [1.0, 1.2]", "ASCE 7-22", 'agieng is not known; is "ageing" meant'),
        ('importance_class = "IV"', "EN 1998", "importance_class"),
    ],
)
def test_what_is_no_factor_is_refused(tmp_path: Path, text: str, code: str, words: str) -> None:
    refused(ProjectError, words, bounds_of, tmp_path, f"[bounds.friction]\n{text}\n", code)
