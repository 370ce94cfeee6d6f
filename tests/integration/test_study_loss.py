"""The study of loss, by hand and by other routes."""

import math

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from frames.risk import HazardCurve, IntensityRuns, LimitState
from frames.risk.campaign.comparison import dish_diameter
from lir_element.units import STANDARD_GRAVITY
from validation.study.capacities import bounds_of, fitted
from validation.study.consequences import AREA, COMPONENTS, REPLACEMENT, STOREYS, repair
from validation.study.hazards import CONSIDERED_PERIOD, L_AQUILA, italian, sites
from validation.study.loss_runs import annual
from validation.study.pairs import BY_LOAD, NAMES, OTHERS, OURS, device
from validation.study.records_runs import INTENSITY


def test_devices_share_the_dish_under_the_centre():
    places = device(OURS).bearings
    dishes = {
        name: max(dish_diameter(link.bearing) for link in device(name).bearings.values())
        for name in NAMES
    }
    for name in OTHERS:
        assert dishes[name] == pytest.approx(dishes[OURS])
        assert all(
            device(name).bearings[place].bearing.is_dcfp is (name != BY_LOAD) for place in places
        )
    assert len({link.bearing.slider_radius for link in places.values()}) == 1


# Capacities


def test_a_fit_to_narrow_intervals_is_least_squares():
    rng = np.random.default_rng(3)
    x = rng.normal(-0.8, 0.3, 40)
    y = 0.9 + 0.6 * x + rng.normal(0.0, 0.25, 40)
    bounds = np.exp(np.column_stack([y - 1e-4, y + 1e-4]))
    line, expected = fitted(bounds, x), stats.linregress(x, y)
    assert line.slope == pytest.approx(expected.slope, abs=1e-3)
    assert line.median(0.0) == pytest.approx(math.exp(expected.intercept), rel=2e-3)
    rest = y - expected.intercept - expected.slope * x
    assert line.dispersion == pytest.approx(rest.std(), rel=1e-2)
    assert fitted(bounds).dispersion == pytest.approx(y.std(), rel=1e-2)
    assert fitted(bounds).median() == pytest.approx(math.exp(y.mean()), rel=1e-3)


def test_a_fit_to_open_intervals_finds_the_truth():
    y = np.random.default_rng(5).normal(0.7, 0.4, 4000)
    levels = np.array([0.0, 1.2, 1.7, 2.4, np.inf])
    k = np.searchsorted(levels, np.exp(y)) - 1
    line = fitted(np.column_stack([levels[k], levels[k + 1]]))
    assert line.median() == pytest.approx(math.exp(0.7), rel=0.03)
    assert line.dispersion == pytest.approx(0.4, rel=0.05)


def test_records_fail_between_two_stripes():
    rows = [("a", 1.0, "ok", 0.01), ("a", 2.0, "ok", 0.03), ("b", 1.0, "slip_exceeded", 0.0)]
    rows += [("b", 2.0, "ok", 0.01), ("c", 1.0, "ok", 0.0), ("c", 2.0, "newton_failed", 9.0)]
    outcome = {"ok": "complete", "slip_exceeded": "bearing failure"}
    frame = pd.DataFrame(rows, columns=["motion", "im", "status", "drift"]).assign(
        scale=1.0, message=""
    )
    frame["outcome"] = [outcome.get(s, "numerical failure") for s in frame["status"]]
    runs = IntensityRuns(frame, INTENSITY, {"drift": "1"})
    found = bounds_of(runs, LimitState("drift", "drift", 0.02), ["a", "b", "c"])
    np.testing.assert_array_equal(found, [[1.0, 2.0], [0.0, 1.0], [1.0, np.inf]])


# Hazard, consequences, annual loss


def test_the_spectrum_of_the_italian_code():
    # 475 years, ground C: S = 1.7 - 0.6 * 2.364 * 0.26614 = 1.3225, C_C = 1.05 * 0.34696**-0.33
    # = 1.4889, T_C = 0.51660 s, T_D = 4 * 0.26614 + 1.6 = 2.66454 s
    expected = 2.6099 * 1.3225 * 2.364 * 0.51660 * 2.66454 / 9.0
    assert italian(*L_AQUILA[6], 3.0) == pytest.approx(expected, rel=1e-3)
    # 2,475 years: T_D = 3.4459 s is beyond 3 s; S = 1.7 - 0.6 * 2.4576 * 0.46147 = 1.0195
    corner = 1.05 * 0.38472 ** (1.0 - 0.33)
    assert italian(*L_AQUILA[8], 3.0) == pytest.approx(
        4.5255 * 1.0195 * 2.4576 * corner / 3.0, rel=1e-3
    )


def test_hazards_go_through_what_is_known():
    santiago, angeles, aquila = sites()
    assert angeles.at(CONSIDERED_PERIOD) == pytest.approx(STANDARD_GRAVITY * 1.054 / 3.0)
    assert angeles.at(475.0) / angeles.at(CONSIDERED_PERIOD) == pytest.approx(0.24 / 0.50)
    assert santiago.at(1950.0) / santiago.at(475.0) == pytest.approx(0.72 / 0.55)
    assert aquila.at(475.0) == pytest.approx(italian(*L_AQUILA[6], 3.0))
    for site in sites():
        rate = np.asarray(site.curve.rate)
        assert rate[0] == pytest.approx(1.0 / 30.0)
        moved = site.moved(2.0)
        assert moved.rates(2.0) == pytest.approx(1.0 / CONSIDERED_PERIOD)


def test_a_component_at_its_median_is_half_damaged():
    by_name = {each.name: each for each in COMPONENTS}
    contents = by_name["E.20.22.023"]
    assert float(contents.cost(np.array(0.4))) == pytest.approx(1000.0)
    walls = by_name["C.10.11.001a"]  # 4.65 units: 2177.5 USD less (3.65 / 9) of the difference
    total = 3.0 * 0.1 * AREA / 0.3048**2 / 100.0
    first = 2677.5 + (total - 1.0) / 9.0 * (1428.0 - 2677.5)
    assert walls.costs[0] == pytest.approx(first)
    at = np.array(0.01)
    p = [stats.norm.cdf(np.log(0.01 / m) / b) for m, b in ((0.005, 0.4), (0.01, 0.3), (0.021, 0.2))]
    one, two, three = walls.costs
    expected = (p[0] - p[1]) * one + (p[1] - p[2]) * two + p[2] * three
    assert float(walls.cost(at)) == pytest.approx(expected)
    whole = REPLACEMENT * AREA * STOREYS
    found = repair(np.array([0.01, 0.0, 0.0]), STANDARD_GRAVITY * np.array([0.4, 0.0, 0.0, 0.0]))
    assert float(found["C.10.11.001a"]) == pytest.approx(walls.count * expected / whole)
    assert float(found["E.20.22.023"]) == pytest.approx(contents.count * 1000.0 / whole)
    assert float(found["C.30.32.003b"]) == 0.0  # the ceiling hangs from the floor above


def test_annual_loss_under_a_power_law():
    # loss = im / 4 up to 4, under rate = 1e-3 im**-2 from 0.5 to 50:
    # 1/4 * integral of im * 2e-3 im**-3 = 5e-4 (1/0.5 - 1/4), and 1 * rate(4)
    hazard = HazardCurve.power(1e-3, 2.0, 0.5, 50.0)
    found = annual(np.array([0.25, 1.0]), np.array([1.0, 4.0]), hazard)
    assert float(found) == pytest.approx(5e-4 * (2.0 - 0.25) + 1e-3 / 16.0, rel=1e-4)


# Pages
