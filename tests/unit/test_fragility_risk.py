"""Risk, comparison and sensitivity: against closed forms."""

import math
import re
import warnings
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from scipy.special import ndtr
from scipy.stats import uniform

from frames.risk import (
    FragilityError,
    HazardCurve,
    Intensity,
    IntensityRuns,
    LimitState,
    RiskWarning,
    collapse_margin_ratio,
    compare_fragility,
    fit_capacities,
    fit_stripes,
    lognormal_fragility,
    mean_annual_frequency,
    paired_tests,
    saltelli_sample,
    sobol_indices,
    tornado,
)
from frames.risk.fragility.sobol import saltelli_sets
from frames.risk.plots import risk_deaggregation, tornado_chart
from lir_element.units import STANDARD_GRAVITY
from tests.refusals import refused

RECORDS = [f"record {k:02d}" for k in range(30)]


@pytest.mark.parametrize("slope", [1.5, 2.5, 4.0])
@pytest.mark.parametrize("dispersion", [0.2, 0.5])
def test_cornells_closed_form(slope: float, dispersion: float) -> None:
    hazard = HazardCurve.power(2e-3, slope, 1e-3, 1e4)
    found = mean_annual_frequency(lognormal_fragility(4.0, dispersion), hazard)
    closed = 2e-3 * 4.0**-slope * math.exp(0.5 * (slope * dispersion) ** 2)
    assert found.rate == pytest.approx(closed, rel=2e-4)
    # the deaggregation by parts: -H P, and the rate's share of a lognormal that is shifted
    z = np.log(found.im / 4.0) / dispersion
    up_to = closed * ndtr(z + slope * dispersion) - 2e-3 * found.im**-slope * ndtr(z)
    table = found.to_dataframe()
    np.testing.assert_allclose(table["share"], up_to / closed, atol=2e-3)
    area = np.trapezoid(found.contribution, np.log(found.im))
    assert area == pytest.approx(found.rate, rel=1e-3)


def test_a_sharp_limit_is_the_hazard_itself() -> None:
    hazard = HazardCurve([0.1, 1.0, 2.0, 20.0], [0.5, 1e-2, 2e-3, 1e-7])
    found = mean_annual_frequency(lognormal_fragility(1.5, 0.01), hazard)
    between = 1e-2 * (2e-3 / 1e-2) ** (math.log(1.5) / math.log(2.0))
    assert found.rate == pytest.approx(between, rel=1e-3)
    assert found.probability(50.0) == pytest.approx(1.0 - math.exp(-50.0 * found.rate))
    assert hazard.to_dataframe().shape == (4, 2)


def test_what_the_hazard_does_not_cover_is_told() -> None:
    curve = lognormal_fragility(2.0, 0.5, name="collapse")
    with pytest.warns(RiskWarning, match=r"collapse: .* give more of the curve"):
        mean_annual_frequency(curve, HazardCurve.power(1e-3, 2.0, 0.1, 2.0))
    with pytest.warns(RiskWarning):
        mean_annual_frequency(curve, HazardCurve.power(1e-3, 2.0, 1.9, 100.0))
    with pytest.raises(FragilityError, match="out of the hazard curve"):
        HazardCurve.power(1e-3, 2.0, 0.1, 2.0).rates([3.0])


def test_interval_of_the_rate_by_hand() -> None:
    values = 2.0 * np.exp(0.3 * np.random.default_rng(1).standard_normal(30))
    curve = fit_capacities(values, RECORDS, resamples=40)
    hazard = HazardCurve.power(1e-3, 2.5, 1e-2, 1e3)
    found = mean_annual_frequency(curve, hazard)
    closed = [1e-3 * m**-2.5 * math.exp(0.5 * (2.5 * b) ** 2) for m, b in curve.parameters]
    np.testing.assert_allclose(found.resampled, closed, rtol=1e-3)
    assert found.interval(0.9) == pytest.approx(tuple(np.quantile(closed, [0.05, 0.95])), rel=1e-3)


def test_pairs_tell_more_than_two_samples() -> None:
    """Capacities that are 20 % higher record by record: the ratio is known without doubt."""
    values = np.exp(0.4 * np.random.default_rng(2).standard_normal(30))
    first, second = (
        fit_capacities(factor * values, RECORDS, resamples=100) for factor in (1.0, 1.2)
    )
    hazard = HazardCurve.power(1e-3, 2.0, 1e-3, 1e3)
    found = compare_fragility(first, second, hazard).to_dataframe()
    median, ratio = found.loc["median, ratio [-]"], found.loc["rate, ratio [-]"]
    assert tuple(median) == pytest.approx((1.2, 1.2, 1.2, 1.0))
    assert tuple(ratio)[:3] == pytest.approx([1.2**-2.0] * 3, rel=1e-3)
    assert found.loc["median, difference [m/s2]", "value"] == pytest.approx(0.2 * first.median)
    assert found.loc["rate, difference [1/year]", "value"] < 0.0
    assert compare_fragility(first, second).rates is None


def test_unlike_records_are_not_compared() -> None:
    values = np.exp(0.4 * np.random.default_rng(2).standard_normal(30))
    one = fit_capacities(values, RECORDS, resamples=10)
    for other in (
        fit_capacities(values[1:], RECORDS[1:], resamples=10),
        fit_capacities(values, RECORDS, resamples=10, seed=2),
        lognormal_fragility(1.0, 0.4),
    ):
        refused(FragilityError, "the curves differ in records", compare_fragility, one, other)
    with pytest.raises(FragilityError, match="one intensity measure"):
        compare_fragility(one, fit_capacities(values, RECORDS, unit="m/s"))


def test_stripes_and_capacities_of_the_same_records_are_paired() -> None:
    """A step of the levels that is fine makes the resamples of both methods nearly the same."""
    values = np.exp(0.4 * np.random.default_rng(3).standard_normal(30))
    levels = np.geomspace(0.2, 5.0, 25)
    im = np.tile(levels, 30)
    over = (im > np.repeat(values, 25)).astype(float)
    stripes = fit_stripes(im, over, list(np.repeat(RECORDS, 25)), resamples=40)
    moments = fit_capacities(values, RECORDS, resamples=40)
    pair = np.log([stripes.parameters[:, 0], moments.parameters[:, 0]])
    assert np.corrcoef(pair)[0, 1] > 0.9


def test_collapse_margin_ratio() -> None:
    assert collapse_margin_ratio(2.4, 1.5, 1.25) == pytest.approx(2.0)
    refused(FragilityError, "maximum_considered", collapse_margin_ratio, 2.4, 0.0)


def test_a_tornado_of_a_line() -> None:
    calls = []

    def result(sets: list[dict[str, float]]) -> list[float]:
        calls.append(len(sets))
        return [3.0 * each["a"] - 2.0 * each["b"] + each["c"] for each in sets]

    found = tornado(result, {"a": (0.9, 1.0, 1.1), "b": (0.0, 1.0, 2.0), "c": (1.0, 1.0, 1.0)})
    assert calls == [7]
    assert found.base == 2.0
    assert list(found.table.index) == ["b", "a", "c"]
    assert found.table["swing"].tolist() == pytest.approx([4.0, 0.6, 0.0])
    assert found.table.loc["b", ["at low", "at high"]].tolist() == [4.0, 0.0]


def test_sobol_indices_of_ishigami() -> None:
    """Closed form: S = 0.3139, 0.4424, 0; total 0.5576, 0.4424, 0.2437; variance 13.845."""

    def ishigami(sets: list[dict[str, float]]) -> np.ndarray:
        a, b, c = (np.array([each[name] for each in sets]) for name in "abc")
        return np.sin(a) + 7.0 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a)

    angles = uniform(-math.pi, 2.0 * math.pi)
    found = sobol_indices(ishigami, dict.fromkeys("abc", angles), samples=1024)
    assert found.runs == 5 * 1024
    assert found.mean == pytest.approx(3.5, abs=0.02)
    assert found.deviation == pytest.approx(math.sqrt(13.845), rel=0.02)
    table = found.table
    pages = ishigami(saltelli_sets(dict.fromkeys("abc", angles), 1024, 1)).reshape(5, 1, 1024)
    func = {"f_A": pages[0], "f_B": pages[1], "f_AB": pages[2:]}
    peer = stats.sobol_indices(func=func, n=1024)
    np.testing.assert_allclose(table["total"], peer.total_order.ravel(), rtol=1e-12)
    np.testing.assert_allclose(table["first"], peer.first_order.ravel().clip(0.0), rtol=1e-10)
    np.testing.assert_allclose(table["first"], [0.3139, 0.4424, 0.0], atol=0.03)
    np.testing.assert_allclose(table["total"], [0.5576, 0.4424, 0.2437], atol=0.03)
    for kind, exact in (("first", [0.3139, 0.4424, 0.0]), ("total", [0.5576, 0.4424, 0.2437])):
        assert (table[f"{kind}, low"] <= exact).all()
        assert (exact < table[f"{kind}, high"]).all()
    sample = saltelli_sample(dict.fromkeys("abc", angles), 1024)
    given = ishigami([sample[k] for k in range(len(sample))])
    again = sobol_indices(given, dict.fromkeys("abc", angles), samples=1024)
    assert (again.table == table).all(axis=None)
    with pytest.raises(FragilityError, match="return one number for each of 5120 sets"):
        sobol_indices(given[:-1], dict.fromkeys("abc", angles), samples=1024)


def test_indices_conditional_on_the_record() -> None:
    """Ishigami's function times one number a record and plus another, which are known.

    Conditional indices are those of the function. The variance is that of the numbers.
    """
    angles, samples = dict.fromkeys("abc", uniform(-math.pi, 2.0 * math.pi)), 1024
    a, b, c = saltelli_sample(angles, samples).values.T
    result = np.sin(a) + 7.0 * np.sin(b) ** 2 + 0.1 * c**4 * np.sin(a) - 3.5
    variance = 13.8446
    more, times = (
        np.array([-3.0, 0.0, 1.0, 2.0, 4.0, 5.0]),
        np.array([1.0, 1.5, 0.5, 1.0, 2.0, 0.7]),
    )
    results = more + times * result[:, None]
    found = sobol_indices(results, angles, samples=samples, widest=2.0)
    np.testing.assert_allclose(found.table["first"], [0.3139, 0.4424, 0.0], atol=0.03)
    np.testing.assert_allclose(found.table["total"], [0.5576, 0.4424, 0.2437], atol=0.03)
    both = float(times.var(ddof=1)) * variance
    first = np.array([more.var(ddof=1), times.mean() ** 2 * variance - both / len(times)])
    assert found.groups is not None
    whole = first.sum() + both
    np.testing.assert_allclose(found.groups["first"], first / whole, atol=0.02)
    np.testing.assert_allclose(found.groups["total"], (first + both) / whole, atol=0.02)
    inside = [found.table, found.groups]
    assert all((t["total, low"] <= t["total"]).all() for t in inside)
    # one result that is not known costs its record the sample, a set that is not built all records
    gaps = results.copy()
    gaps[7, 2] = gaps[samples + 3] = np.nan
    some = sobol_indices(gaps, angles, samples=samples, widest=2.0)
    assert (some.left_out, some.runs) == (1 + len(times), results.size - 1 - len(times))
    np.testing.assert_allclose(some.table["total"], found.table["total"], atol=0.03)
    gaps[: samples - 7] = np.nan
    words = "7 of 1024 samples of record 0 are known"
    refused(FragilityError, words, sobol_indices, gaps, angles, samples=samples)


def test_a_wide_interval_of_an_index_is_told_with_a_remedy_that_works() -> None:
    inputs = {"a": uniform(), "b": uniform()}

    def line(sets: list[dict[str, float]]) -> list[float]:
        return [each["a"] + 0.1 * each["b"] for each in sets]

    with pytest.warns(RiskWarning, match=r"first index of a is no result: .* exceeds 0.2") as told:
        wide = sobol_indices(line, inputs, samples=16).table
    assert wide.loc["a", "first, high"] - wide.loc["a", "first, low"] > 0.2
    assert math.isnan(wide.loc["a", "first"])
    (text,) = re.findall(r"samples=(\d+)", str(told[0].message))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sobol_indices(line, inputs, samples=int(text))


def test_what_makes_no_sense_is_refused() -> None:
    def same(value: float) -> Callable[[list[object]], list[float]]:
        return lambda sets: [value for _ in sets]

    one, curve = {"a": (0.0, 1.0, 3.0)}, lognormal_fragility(1.0, 0.4, unit="m/s")
    for words, call, *given in (
        ("2 at least", HazardCurve, [1.0], [0.1]),
        ("fall", HazardCurve, [1.0, 2.0], [0.1, 0.2]),
        ("rise", HazardCurve, [2.0, 1.0], [0.2, 0.1]),
        ("positive", HazardCurve, [1.0, 2.0], [0.1, 0.0]),
        ("one unit", mean_annual_frequency, curve, HazardCurve([1.0, 2.0], [0.2, 0.1])),
        ("in this order", tornado, same(0.0), {"a": (2.0, 1.0, 3.0)}),
        ("one number for each", tornado, lambda _: [0.0], one),
        ("must be finite", tornado, same(math.nan), one),
        ("results are 1: vary", sobol_indices, same(1.0), {"a": uniform(0, 1)}),
        ("give distributions", sobol_indices, same(1.0), {"a": 1.0}),
    ):
        refused(FragilityError, words, call, *given)
    given = same(0.0), {"a": uniform(0, 1)}
    refused(FragilityError, "power of 2", sobol_indices, *given, samples=100)


def test_figures_of_risk_and_tornado() -> None:
    hazard = HazardCurve.power(1e-3, 2.5, 1e-2, 1e3)
    found = mean_annual_frequency(lognormal_fragility(STANDARD_GRAVITY, 0.4), hazard)
    figure = risk_deaggregation({"a": found, "b": found})
    im, contribution = figure.axes[0].lines[1].get_data()
    np.testing.assert_allclose(im * STANDARD_GRAVITY, found.im)
    np.testing.assert_allclose(contribution, found.contribution)
    low, high = figure.axes[0].get_xlim()
    assert low < math.exp(-2.5 * 0.4**2) < high
    assert figure.legends[0].get_texts()[1].get_text() == f"b: {found.rate:.2e} a year"
    swings = tornado(
        lambda sets: [3.0 * each["a"] - each["b"] for each in sets],
        {"a": (0.0, 1.0, 2.0), "b": (0.0, 1.0, 2.0)},
    )
    bars = tornado_chart(swings, label="shift", unit="m").axes[0]
    assert [text.get_text() for text in bars.get_yticklabels()] == ["b", "a"]  # widest on top
    spans = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars.patches)
    assert spans == [(2.0, -1.0), (2.0, 1.0), (2.0, 3.0), (2.0, 5.0)]
    refused(TypeError, "a Risk", risk_deaggregation, [1.0])  # type: ignore[list-item]


def _runs(demand: np.ndarray, outcome: str = "complete") -> IntensityRuns:
    """Runs of records, (records, scales), with a drift; infinite: the bearing failed."""
    records, scales = np.indices(demand.shape).reshape(2, -1)
    drift = demand.ravel()
    table = pd.DataFrame(
        {
            "motion": [RECORDS[k] for k in records],
            "scale": scales + 1.0,
            "im": scales + 1.0,
            "outcome": np.where(np.isinf(drift), "bearing failure", outcome),
            "status": "ok",
            "message": "",
            "storey drift, mean": np.where(np.isinf(drift), 0.0, drift),
        }
    )
    return IntensityRuns(table, Intensity(kind="scale"), {"storey drift, mean": "-"})


def test_paired_tests_are_the_exact_binomial() -> None:
    # at scale 1 eight records exceed on one alone, at scale 2 all, at scale 3 one side each
    one, two = np.zeros((12, 3)), np.zeros((12, 3))
    one[:8, 0], one[:, 1], two[:, 1] = np.inf, np.inf, np.inf
    one[0, 2], two[1, 2] = 0.02, 0.02
    limit = LimitState.drift(0.01)
    runs = {"A": _runs(one), "B": _runs(two)}
    found = paired_tests(runs, [("A", "B"), ("B", "A")], [limit, "storey drift, mean"])
    table = found.set_index(["measure", "own", "scale"])
    row = table.loc[limit.name, "A", 1.0]
    assert (row["records"], row["more"], row["less"]) == (12, 8, 0)
    assert row["p"] == pytest.approx(2.0 * 0.5**8)
    assert row["verdict"] == "worse"
    assert table.loc[(limit.name, "B", 1.0), "verdict"] == "better"
    for scale in (2.0, 3.0):
        row = table.loc[limit.name, "A", scale]
        assert (row["p"], row["verdict"]) == (1.0, "too few differ")
        assert np.isnan(row["q"])
    # over all scales: record 1 exceeds once on each, the seven others of the first eight are worse
    row = table.loc[limit.name, "A", np.inf]
    assert (row["more"], row["less"]) == (7, 0)
    unknown = paired_tests(
        {"A": _runs(one, "numerical failure"), "B": runs["B"]}, [("A", "B")], [limit]
    )
    assert unknown.loc[unknown["scale"] == 1.0, "records"].item() == 8  # of failed bearings alone
    # motions in pairs of one record: four are worse, not eight
    for each in runs.values():
        each.table["record"] = np.indices(one.shape)[0].ravel() // 2
    made = paired_tests(runs, [("A", "B")], [limit]).set_index("scale").loc[1.0]
    assert (made["records"], made["more"], made["p"]) == (6, 4, pytest.approx(2.0 * 0.5**4))
    refused(FragilityError, "structure", paired_tests, runs, [("A", "C")], [limit])
    refused(FragilityError, "rate", paired_tests, runs, [("A", "B")], [limit], 1.0)


def test_few_discoveries_are_made_where_nothing_differs() -> None:
    rng, found = np.random.default_rng(3), 0
    for _ in range(60):
        same = {name: _runs(rng.lognormal(0.0, 0.4, (22, 3))) for name in "ABCD"}
        table = paired_tests(same, [("A", other) for other in "BCD"], [LimitState.drift(1.0)])
        found += table["verdict"].isin(["better", "worse"]).any()
    assert found <= 12  # of 60 tables, each with two families at a rate of 0.1
