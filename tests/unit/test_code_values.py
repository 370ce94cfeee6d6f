"""What codes give, value by value: each has a standing, and checks that of what they rest on."""

from __future__ import annotations

import ast
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from frames.design import (
    ASCE7,
    EN1998,
    Check,
    CheckError,
    Checks,
    NCh2745,
    Spectrum,
    Superstructure,
    code_named,
    equivalent_linear,
)
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from frames.design.codes.analysis import BUILT_IN
from frames.design.codes.code_values import E031, NTC, UFC_BNBC, standing_by, weakest
from frames.design.codes.registry import standing_in
from frames.design.codes.values_of_asce7 import VALUES as ASCE_VALUES
from frames.design.project.asked_by_runs import TITLES
from frames.results.quantities import DEMANDS
from tests.refusals import refused
from tests.square_system import square_system

if TYPE_CHECKING:
    from frames.design import DesignCode

DESIGN = Path(__file__).parents[2] / "frames" / "design"
INPUTS = {"irregular", "no_tension", "pressure_limit", "property_variation"}
INPUTS |= {"simplified", "fault_distance"}
"""Fields of analyses that a project tells of itself."""

SYSTEM = square_system(combinations={"most": (2e6,) * 4})
ABOVE = Superstructure(
    fixed_base_period=0.3,
    storey_weights=(2e6, 2e6),
    storey_heights=(3.0, 3.0),
    storey_stiffness=(4e8, 4e8),
    R=2.0,
    vertical_period=0.05,
)


def checks_of(code: ASCE7 | EN1998 | NCh2745) -> Checks:
    spectrum = {
        "ASCE 7-22": Spectrum.asce7(s_ms=1.2, s_m1=0.6),
        "EN 1998": Spectrum.en1998(2.4, "C"),
        "NCh2745": Spectrum.nch2745(soil="II", zone=3),
    }[code.name]
    found = equivalent_linear(SYSTEM, spectrum, bounds=None, superstructure=ABOVE, code=code)
    return found["nominal"].checks


@pytest.mark.parametrize("code", BUILT_IN, ids=lambda code: code.name)
def test_every_factor_of_a_code_is_a_value_with_a_standing(code: DesignCode) -> None:
    factors = {f.name for f in fields(code.analysis)} - INPUTS  # type: ignore[arg-type]
    listed = [value.field for value in code.values.values() if value.field]
    assert set(listed) == factors
    assert len(listed) == len(set(listed))
    for value in code.values.values():
        assert value.clause
        assert value.what
        assert value.standing.kind in {"read", "agrees", "memory"}


@pytest.mark.parametrize("code", BUILT_IN, ids=lambda code: code.name)
def test_every_code_has_an_edition(code: DesignCode) -> None:
    assert code.edition
    assert code.cited == f"{code.name}: {code.title} ({code.edition})"
    assert code.standing("no such value") == FROM_MEMORY


def test_tables_of_2003_do_not_go_by_the_name_of_2013() -> None:
    assert code_named("NCh2745:2003").name == "NCh2745"
    assert "2003" in code_named("NCh2745").edition
    refused(CheckError, "'NCh2745:2013'", code_named, "NCh2745:2013")


def test_every_check_of_the_package_is_made_with_a_standing() -> None:
    """`CheckBuilder` is given one wherever it is called."""
    calls, without = 0, []
    for path in DESIGN.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            name = getattr(getattr(node, "func", None), "id", "")
            if not isinstance(node, ast.Call) or path.parent.name in {"sizing", "report"}:
                continue
            place = {"CheckBuilder": 3}.get(name)
            if place is None:
                continue
            calls += 1
            said = len(node.args) >= place or any(k.arg == "standing" for k in node.keywords)
            if not said:
                without.append(f"{path.name}:{node.lineno}")
    assert calls > 20
    assert without == []


def test_every_remedy_of_a_check_is_of_one_that_is_made() -> None:
    """By the texts of the modules that make checks; a title that is changed there is seen here."""
    made = {quantity.heading for quantity in DEMANDS.values()}
    for path in (DESIGN / name for name in ("codes", "devices", "histories")):
        for module in set(path.glob("*.py")) - set(path.glob("*values*.py")):
            tree = ast.parse(module.read_text(encoding="utf-8"))
            texts = (n.value for n in ast.walk(tree) if isinstance(n, ast.Constant))
            made |= {text for text in texts if isinstance(text, str)}
    lost = {title for title in TITLES if not any(text.startswith(title) for text in made)}
    assert len(TITLES) > 15
    assert not lost


ASCE_TITLES = (
    *("effective period", "effective damping", "effective stiffness ratio, D_M to 0.2 D_M"),
    *("period ratio T_M / T_fb", "storeys", "height"),
)
EN_TITLES = (
    *("effective stiffness ratio, d_dc to 0.2 d_dc", "effective damping", "restoring force"),
    *("variation of properties", "side of the plan", "effective period", "vertical period"),
    "period ratio T_eff / T_fb",
)
SIMPLIFIED = EN1998(simplified=True, fault_distance=20e3, property_variation=0.08)


@pytest.mark.parametrize(
    ("code", "known"),
    [
        (ASCE7(pressure_limit=60e6, irregular=True), dict.fromkeys(ASCE_TITLES, E031)),
        (SIMPLIFIED, dict.fromkeys(EN_TITLES, NTC)),
        (NCh2745(pressure_limit=60e6), {}),
    ],
    ids=lambda each: getattr(each, "name", ""),
)
def test_checks_have_the_standing_of_what_they_rest_on(code, known):
    found = checks_of(code)
    agreeing = {check.title: check.standing for check in found if check.standing != FROM_MEMORY}
    assert agreeing == known
    assert len(found) > len(known)
    table = found.to_dataframe()
    assert table["standing"].str.startswith("from memory").sum() == str(found).count(" *\n") + str(
        found
    ).endswith(" *")


def test_tables_of_spectra_that_were_compared_have_no_star() -> None:
    for code, spectrum in (
        ("EN 1998", Spectrum.en1998(2.4, "C")),
        ("NCh2745", Spectrum.nch2745(soil="II", zone=3)),
    ):
        own = code_named(code)
        found = {spectrum.standing, own.damping.standing, own.standing("spectrum")}
        assert found == {own.standing("damping factor")}
        assert found.pop().kind == "agrees"


def test_a_value_from_memory_has_its_star(monkeypatch: pytest.MonkeyPatch) -> None:
    def damping() -> Check:
        return next(c for c in checks_of(ASCE7()) if c.title == "effective damping")

    assert damping().cited == "ASCE 7-22 17.4.1"
    value = ASCE_VALUES["most damping"]
    monkeypatch.setitem(ASCE_VALUES, "most damping", value._replace(standing=FROM_MEMORY))
    assert damping().cited == "ASCE 7-22 17.4.1 *"
    assert Checks([damping()]).to_dataframe()["standing"].tolist() == [str(FROM_MEMORY)]


def test_of_a_factor_that_is_changed_nothing_is_known() -> None:
    changed = {c.title: c.standing for c in checks_of(ASCE7(most_damping=0.25))}
    assert changed["effective damping"] == FROM_MEMORY
    assert changed["effective period"] == E031


def test_the_weakest_counts() -> None:
    read = Standing("read", "ASCE/SEI 7-22, 17.5.4")
    assert weakest([read, E031]) == E031
    assert weakest([E031, FROM_MEMORY, read]) == FROM_MEMORY
    assert weakest([E031, UFC_BNBC, E031]).source == f"{E031.source}; {UFC_BNBC.source}"
    for none in ([], [E031, PROJECT]):
        refused(CheckError, "at least one", weakest, none)


def test_values_are_named() -> None:
    refused(CheckError, "'drifts' is not a value", standing_by, ASCE_VALUES, "drifts")
    assert standing_in("ASCE 7", "history drift") == UFC_BNBC
    assert standing_in("Atlantis 12", "history drift") == FROM_MEMORY


def test_a_spectrum_has_the_standing_of_its_formula() -> None:
    assert Spectrum.nch433("B", 2).standing.kind == "agrees"
    assert Spectrum.asce7(s_ms=1.2, s_m1=0.6).standing == FROM_MEMORY
    given = Spectrum.given([0.1, 1.0, 3.0], [5.0, 4.0, 1.0])
    assert given.standing == PROJECT
