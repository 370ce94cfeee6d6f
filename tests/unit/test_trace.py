"""Calculations with a trace: what is shown is what was computed; design checks as values."""

import math
from xml.dom.minidom import parseString  # noqa: S408

import pytest

from frames.design import Check, CheckError, Checks, Trace
from frames.design.calculation.rendering import number, quantity
from tests.refusals import refused


def test_a_formula_is_shown_as_it_is_computed() -> None:
    t = Trace()
    t.given("g", 9.81, "m/s2")
    t.given("S_M1", 0.9)
    t.given("T_M", 2.9161, "s")
    t.given("B_M", 1.1966)
    found = t("D_M", "g * S_M1 * T_M / (4 * pi**2 * B_M)", "m", source="(17.5-1)")
    assert found == pytest.approx(9.81 * 0.9 * 2.9161 / (4.0 * math.pi**2 * 1.1966), rel=1e-14)
    assert t["D_M"].text() == (
        "D_M = g S_M1 T_M / (4 π² B_M) = 9.81 · 0.9 · 2.916 / (4 π² · 1.197) = 0.545 m"
    )
    assert [e.symbol for e in t["D_M"].entered] == ["g", "S_M1", "T_M", "B_M"]
    assert "[(17.5-1)]" in t.text()
    # The numbers as they are shown give the value as it is shown.
    shown = "9.81 * 0.9 * 2.916 / (4 * math.pi**2 * 1.197)"
    assert eval(shown) == pytest.approx(0.545, abs=6e-4)  # noqa: S307


@pytest.mark.parametrize(
    ("formula", "value", "text"),
    [
        ("a - (b - c)", 2.0, "a - (b - c)"),
        ("a / (b / c)", 4.0 / 3.0 * 1.0, "a / (b / c)"),
        ("a / b / c", 4.0 / 3.0, "a / b / c"),
        ("a / b * c", 4.0 / 3.0, "a / b · c"),
        ("-a**2", -16.0, "-a²"),
        ("(-a)**2", 16.0, "(-a)²"),
        ("(a + b) * c", 7.0, "(a + b) c"),
        ("a ** (1 / 2)", 2.0, "a^(1 / 2)"),
        ("sqrt(a * c)", 2.0, "√(a c)"),
        ("min(a, b, c) + max(a, b)", 5.0, "min(a, b, c) + max(a, b)"),
        ("abs(b - a) * exp(-c) * log(a)", math.log(4) / math.e, "|b - a| exp(-c) log(a)"),
        ("2 * a * 3", 24.0, "2 a · 3"),
    ],
)
def test_precedence_is_kept(formula: str, value: float, text: str) -> None:
    t = Trace()
    for name, v in {"a": 4.0, "b": 3.0, "c": 1.0}.items():
        t.given(name, v)
    assert t("x", formula) == pytest.approx(value, rel=1e-14)
    assert t["x"].text().split(" = ")[1] == text
    assert parseString(t["x"].mathml()).documentElement.tagName == "math"  # noqa: S318


def test_fractions_and_powers_are_held_in_mathml() -> None:
    t = Trace()
    for name in ("a_1", "b"):
        t.given(name, 2.0, "m")
    t("x", "(a_1 / b)**2 - (a_1 - b) * (-b)", shown="%")
    a, b = "<msub><mi>a</mi><mi>1</mi></msub>", "<mi>b</mi>"
    plain = t["x"].mathml().replace("<mrow>", "").replace("</mrow>", "")
    assert plain == (
        f"<math><mi>x</mi><mo>=</mo><msup><mo>(</mo><mfrac>{a}{b}</mfrac><mo>)</mo><mn>2</mn>"
        f"</msup><mo>-</mo><mo>(</mo>{a}<mo>-</mo>{b}<mo>)</mo><mo>&#x2062;</mo><mo>(</mo>"
        f"<mo>-</mo>{b}<mo>)</mo><mo>=</mo><mtext>100 %</mtext></math>"
    )


def test_several_values_are_summed_and_none_is_dropped() -> None:
    t = Trace()
    t.given_each("W", [100e3, 200e3, 300e3, 400e3, 500e3], "N")
    t.given_each("mu", [0.1, 0.2, 0.1, 0.2, 0.1])
    assert t.each("F", "mu * W", "N") == pytest.approx((10e3, 40e3, 30e3, 80e3, 50e3))
    assert t("V", "sum(F)", "N") == pytest.approx(210e3)
    assert t("F_min", "min(F)", "N") == pytest.approx(10e3)
    assert t["F"].text() == "F = μ W = (10, 40, …, 50) kN"
    assert t["V"].text() == "V = Σ(F) = 210 kN"
    assert t.each("S", "above(F)", "N") == pytest.approx((210e3, 200e3, 160e3, 130e3, 50e3))
    t.given_each("x", [1.0, 2.0], "m")
    refused(CheckError, "different lengths", t.each, "M", "F * x", "N m")
    refused(CheckError, "5 values: use sum", t, "G", "2 * F", "N")
    refused(CheckError, "has one value", t.each, "H", "2 * V", "N")


def test_a_calculation_of_some_symbols_has_what_they_follow_from() -> None:
    t = Trace()
    t.given("a", 1.0)
    t.given("b", 2.0)
    t("c", "2 * a")
    t("d", "b + 1")
    t.looked_up("e", 1.5, ["c"], source="Table 1")
    assert [step.symbol for step in t.of("e")] == ["a", "c", "e"]
    assert t["e"].text() == "e = 1.5 at c = 2"
    later = t.copy()
    later("f", "e + d")
    assert "f" not in t


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("a +", "cannot be read"),
        ("a if a else b", "use numbers, names"),
        ("__import__('os')", "use numbers, names"),
        ("a.real", "use numbers, names"),
        ("a < b", "use numbers, names"),
        ("sqrt + a", "use numbers, names"),
        ("sqrt(a, b)", "use numbers, names"),
        ("unknown * a", "symbol 'unknown' is not in the calculation"),
        ("a / b", "not finite at a = 1, b = 0"),
        ("log(b)", "not finite"),
        ("sqrt(b - a)", "not finite"),
    ],
)
def test_what_is_no_formula_is_refused(formula: str, words: str) -> None:
    t = Trace()
    t.given("a", 1.0)
    t.given("b", 0.0)
    refused(CheckError, words, t, "x", formula)


def test_symbols_units_and_numbers_are_checked_at_the_door() -> None:
    t = Trace()
    t.given("a", 1.0)
    for symbol in ("a", "pi", "2a", "D M"):
        refused(CheckError, "symbol", t.given, symbol, 1.0)
    refused(CheckError, "not a number", t.given, "b", math.nan)
    refused(CheckError, "cannot be shown in 'kN'", t.given, "b", 1.0, "m", shown="kN")


def test_numbers_have_four_digits() -> None:
    shown = [number(v) for v in (0.0, 1234567.0, 12345.6, 0.054616, 1.5e-6, -2e9, 0.3)]
    assert quantity(2.0, "m/s2", "m/s2") == "2 m/s²"
    assert shown == ["0", "1.235·10⁶", "12346", "0.05462", "1.5·10⁻⁶", "-2·10⁹", "0.3"]


@pytest.mark.parametrize(
    ("demand", "relation", "limit", "ratio"),
    [
        (1.0, "<=", 2.0, 0.5),
        (3.0, "<=", 2.0, 1.5),
        (2.0, ">=", 1.0, 0.5),
        (1.0, ">=", 2.0, 2.0),
        (-1.0, "<=", 2.0, 0.0),
        (0.0, "<=", 0.0, 0.0),
        (1.0, "<=", 0.0, math.inf),
        (-4.0, "<=", -2.0, 0.5),
        (-1.0, "<=", -2.0, 2.0),
        (-1.0, ">=", 0.0, math.inf),
        (-1.0, ">=", -2.0, 0.5),
        (0.0, ">=", 1.0, math.inf),
        (math.inf, ">=", 0.5, 0.0),
        (0.5, "<=", math.inf, 0.0),
    ],
)
def test_a_ratio_of_one_at_most_is_a_check_that_passes(demand, relation, limit, ratio):
    check = Check(clause="", title="t", demand=demand, limit=limit, relation=relation)
    assert check.ratio == pytest.approx(ratio)
    assert check.passed == (demand <= limit if relation == "<=" else demand >= limit)


@pytest.mark.parametrize(
    ("demand", "relation", "limit", "words"),
    [
        (7.0, "<=", 0.0, "7 <= 0, none allowed"),
        (1.0, "<=", -2.0, "1 <= -2, no ratio to a limit below 0"),
        (0.0, ">=", 1.0, "0 >= 1, no ratio of a demand that is not above 0"),
        (math.inf, "<=", 1.0, "no ratio without a demand"),
    ],
)
def test_without_a_ratio_a_check_says_why(demand, relation, limit, words):
    check = Check(clause="", title="t", demand=demand, limit=limit, relation=relation)
    assert check.said[2] == "-"
    assert words in str(check)
    assert str(check).endswith("FAILED []")


def test_what_cannot_be_judged_is_refused() -> None:
    for demand, limit in ((math.nan, 1.0), (1.0, math.nan), (math.inf, math.inf)):
        with pytest.raises(CheckError):
            Check(clause="c", title="t", demand=demand, limit=limit)
    with pytest.raises(CheckError, match="relation"):
        Check(clause="c", title="t", demand=1.0, limit=1.0, relation="<")


def test_a_limit_of_a_procedure_is_no_failure() -> None:
    given = {"clause": "c", "title": "period", "limit": 3.0, "unit": "s", "scope": "procedure"}
    within, beyond = (Check(demand=value, **given) for value in (2.0, 4.0))
    failing = Check(clause="c", title="drift", demand=2.0, limit=1.0, level="MCE_R")
    assert [c.verdict for c in (within, beyond, failing)] == ["ok", "does not apply", "FAILS"]
    assert Checks([within, beyond]).passed
    checks = Checks([within, beyond, failing])
    assert list(checks.failed) == [failing]
    assert list(checks.inapplicable) == [beyond]
    assert "3 checks, 1 failed, 1 limits of the procedure exceeded" in checks.tally
    assert "does not apply" in str(beyond)
    assert "(MCE_R)" in str(failing)
    assert str(checks).count("FAILS") == 1


def test_checks_know_which_governs() -> None:
    t = Trace()
    t.given("F", 100e3, "N")
    one = Check(clause="A 1", title="force", demand=100e3, limit=80e3, unit="N", trace=t)
    two = Check(clause="A 2", title="drift", demand=0.01, limit=0.015, bound="lower", subject="s1")
    t.given("late", 1.0)
    assert "late" not in one.trace
    checks = Checks([two]) + Checks([one])
    assert not checks.passed
    assert Checks([two]).passed
    assert not Checks().passed
    assert checks.governing is one
    assert list(checks.failed) == [one]
    assert list(checks.of(bound="lower")) == list(checks.of("A 2")) == [two]
    table = checks.to_dataframe()
    assert table["ratio"].tolist() == pytest.approx([2.0 / 3.0, 1.25])
    assert "100 kN" in str(checks)
    assert "FAILS" in checks._repr_html_()
    with pytest.raises(CheckError, match="none governs"):
        Checks().governing  # noqa: B018
