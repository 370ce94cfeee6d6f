"""Fragility curves: fits against closed forms and another program, bands against repetition."""

import math
import sys

import numpy as np
import pandas as pd
import pytest
from scipy.special import expit, ndtr, ndtri
from scipy.stats import linregress

from frames.risk import FragilityError, fit_capacities, fit_cloud, fit_stripes, lognormal_fragility
from tests.refusals import refused

LEVELS = np.array([0.3, 0.5, 0.7, 0.9, 1.2, 1.6])


def names(count: int) -> list[str]:
    return [f"record {k:03d}" for k in range(count)]


def striped(capacity: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Return intensities, outcomes and records of stripes of records of some capacities."""
    im = np.tile(LEVELS, len(capacity))
    over = (im > np.repeat(capacity, len(LEVELS))).astype(float)
    return im, over, list(np.repeat(names(len(capacity)), len(LEVELS)))


def drawn(seed: int, count: int = 30, median: float = 0.8, dispersion: float = 0.4) -> np.ndarray:
    return median * np.exp(dispersion * np.random.default_rng(seed).standard_normal(count))


def test_stripes_are_a_regression_of_probits() -> None:
    """The same as by statsmodels: other code, other method (iterated weighted least squares)."""
    models = pytest.importorskip("statsmodels.api")
    im, over, records = striped(drawn(3))
    curve = fit_stripes(im, over, records, resamples=20)
    probit = models.families.Binomial(models.families.links.Probit())
    fit = models.GLM(over, models.add_constant(np.log(im)), family=probit).fit(
        cov_type="cluster",
        cov_kwds={"groups": pd.factorize(np.array(records))[0], "use_correction": False},
    )
    b0, b1 = fit.params
    assert curve.median == pytest.approx(math.exp(-b0 / b1), rel=1e-6)
    assert curve.dispersion == pytest.approx(1.0 / b1, rel=1e-6)
    jacobian = np.array([[-1.0 / b1, b0 / b1**2], [0.0, -1.0 / b1**2]])
    robust = jacobian @ fit.cov_params() @ jacobian.T
    np.testing.assert_allclose(curve.covariance, robust, rtol=2e-3)
    assert curve.data["total"].tolist() == [30] * 6
    assert curve.data["exceeded"].sum() == over.sum()


def test_capacities_by_moments_in_closed_form() -> None:
    values = np.array([0.5, 0.8, 1.1, 1.9])
    curve = fit_capacities(values, names(4), resamples=50)
    logs = np.log(values)
    assert curve.median == pytest.approx(math.exp(logs.mean()))
    assert curve.dispersion == pytest.approx(logs.std(ddof=1))
    # of a normal sample: variance of the mean s^2/n, of the deviation s^2/(2 (n - 1))
    s = logs.std(ddof=1)
    np.testing.assert_allclose(curve.covariance, np.diag([s**2 / 4.0, s**2 / 6.0]))
    assert curve.probability(curve.median) == pytest.approx(0.5)


def test_the_bootstrap_by_hand() -> None:
    """Each resample is the fit to records that a generator of the same seed draws."""
    values = drawn(1, 6)
    curve = fit_capacities(values, names(6), resamples=3, seed=9)
    rng = np.random.default_rng(9)
    for row in curve.parameters:
        own = np.repeat(values, rng.multinomial(6, np.full(6, 1.0 / 6.0)))
        assert row[0] == pytest.approx(np.exp(np.log(own).mean()))
        assert row[1] == pytest.approx(np.log(own).std(ddof=1))


def test_the_order_of_records_does_not_matter() -> None:
    values, labels = drawn(1, 8), names(8)
    one = fit_capacities(values, labels, resamples=10)
    other = fit_capacities(values[::-1], labels[::-1], resamples=10)
    np.testing.assert_allclose(one.parameters, other.parameters)
    assert one.records == other.records


def test_censored_capacities_give_the_curve_that_all_would() -> None:
    """400 records, a third of them not run to their capacity: within three standard errors."""
    values = drawn(2, 400)
    censored = values > 1.0
    curve = fit_capacities(np.minimum(values, 1.0), names(400), censored=censored, resamples=2)
    assert "likelihood" in curve.method
    for found, true, place in (
        (math.log(curve.median), math.log(0.8), 0),
        (curve.dispersion, 0.4, 1),
    ):
        assert found == pytest.approx(true, abs=3.0 * math.sqrt(curve.covariance[place, place]))
    whole = fit_capacities(values, names(400), method="likelihood", resamples=2)
    assert whole.dispersion == pytest.approx(np.log(values).std(), rel=1e-5)  # of n


def test_bands_cover_the_truth() -> None:
    """90 % bands at the true median, of 200 sets of 40 records: 84 to 96 % of them cover."""
    hits = np.zeros(2)
    for seed in range(200):
        curve = fit_capacities(drawn(seed, 40), names(40), resamples=200, seed=seed)
        for k, (low, high) in enumerate((curve.band([0.8]), curve.delta_band([0.8]))):
            hits[k] += low[0] <= 0.5 <= high[0]
    assert (hits / 200.0 > 0.84).all()
    assert (hits / 200.0 < 0.96).all()


def test_resampling_and_the_delta_method_agree() -> None:
    im, over, records = striped(drawn(11, 60))
    curve = fit_stripes(im, over, records, resamples=400)
    at = np.array([0.5, 0.8, 1.2])
    for one, other in zip(curve.band(at), curve.delta_band(at), strict=True):
        np.testing.assert_allclose(one, other, atol=0.05)
    low, high = curve.band(at)
    assert (low < curve.probability(at)).all()
    assert (curve.probability(at) < high).all()


def test_a_cloud_is_a_line_through_logarithms() -> None:
    rng = np.random.default_rng(4)
    x = rng.normal(-0.5, 0.6, 40)
    y = -2.0 + 1.2 * x + 0.3 * rng.standard_normal(40)
    curve = fit_cloud(np.exp(x), np.exp(y), 0.1, names(40), resamples=300)
    line = linregress(x, y)
    spread = math.sqrt(((y - line.intercept - line.slope * x) ** 2).sum() / 38.0)
    assert curve.median == pytest.approx(math.exp((math.log(0.1) - line.intercept) / line.slope))
    assert curve.dispersion == pytest.approx(spread / line.slope)
    found = np.cov(np.log(curve.parameters[:, 0]), curve.parameters[:, 1])
    np.testing.assert_allclose(
        np.sqrt(np.diag(found)), np.sqrt(np.diag(curve.covariance)), rtol=0.3
    )


def test_a_cloud_with_collapse_has_five_parameters() -> None:
    """3000 runs of a known model: the curve comes back within 0.03, its median within 3 %."""
    rng = np.random.default_rng(8)
    x = rng.normal(0.0, 0.8, 3000)
    demand = np.exp(-3.0 + 1.1 * x + 0.35 * rng.standard_normal(3000))
    demand[rng.random(3000) < expit(-2.0 + 3.0 * x)] = np.inf
    curve = fit_cloud(np.exp(x), demand, 0.08, names(3000), resamples=3)
    at = np.exp(np.linspace(-1.5, 1.5, 7))
    fell = expit(-2.0 + 3.0 * np.log(at))
    over = ndtr((-3.0 + 1.1 * np.log(at) - math.log(0.08)) / 0.35)
    np.testing.assert_allclose(curve.probability(at), fell + (1.0 - fell) * over, atol=0.03)
    assert float(curve.probability(curve.median)) == pytest.approx(0.5)
    assert curve.resampled_medians() == pytest.approx([curve.median] * 3, rel=0.05)


def test_added_dispersion_flattens_the_curve_about_its_median() -> None:
    curve = fit_capacities(drawn(1, 10), names(10), resamples=20)
    flat = curve.with_dispersion(0.3)
    assert flat.dispersion == pytest.approx(math.hypot(curve.dispersion, 0.3))
    assert flat.probability(curve.median) == pytest.approx(0.5)
    np.testing.assert_allclose(flat.with_dispersion(0.0).parameters, curve.parameters)
    # what the records leave open of the median is the same, in units of the dispersion it is less
    wide, narrow = (float(ndtri(each.delta_band([curve.median])[1][0])) for each in (curve, flat))
    assert narrow / wide == pytest.approx(curve.dispersion / flat.dispersion)


def test_tables() -> None:
    curve = fit_capacities(drawn(1, 10), names(10), unit="m/s", resamples=20)
    table = curve.to_dataframe([0.0, 0.5, 1.0], confidence=0.8)
    assert table.index.name == "im [m/s]"
    assert table["probability"].iloc[0] == 0.0
    assert (table["low"] <= table["high"]).all()
    assert len(curve.to_dataframe()) == 50
    assert curve.interval().loc["median", "value"] == curve.median


def test_what_determines_no_curve_is_refused() -> None:
    im, over, records = striped(drawn(3))
    four, curve = [1.0, 2.0, 3.0, 4.0], lognormal_fragility(1.0, 0.4)
    for words, fit, *given in (
        ("no run exceeds", fit_stripes, im, np.zeros_like(over), records),
        ("all runs exceed", fit_stripes, im, np.ones_like(over), records),
        ("must overlap", fit_stripes, im, (im > 0.8).astype(float), records),
        ("grow with the intensity", fit_stripes, im, 1.0 - over, records),
        ("are one stripe", fit_stripes, 1.0 + 0.05 * im / im.max(), over, records),
        ("one length", fit_stripes, im, over[1:], records),
        ("positive", fit_stripes, -im, over, records),
        ("at least 3", fit_capacities, [1.0, 2.0], ["a", "b"]),
        ("a record once", fit_capacities, [1.0, 2.0, 3.0], ["a", "a", "b"]),
        ("must be positive", fit_cloud, four, [0.0, 1.0, 2.0, 3.0], 1.0, names(4)),
        ("no rising line", fit_cloud, four, four[::-1], 1.0, names(4)),
        ("at least 0", curve.probability, [-1.0]),
        ("confidence", curve.band, [1.0], 1.0),
    ):
        refused(FragilityError, words, fit, *given)
    some = {"censored": [0, 0, 0, 1], "method": "moments"}
    refused(FragilityError, "censored", fit_capacities, four, names(4), **some)


def test_without_the_package_an_error_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyFragility", None)
    refused(ImportError, r"lir-dcfp\[fragility\]", fit_stripes, *striped(drawn(3)))
    assert fit_capacities(drawn(3), names(30), resamples=5).method.startswith("IDA, moments")
