"""The study's summary is that of the numbers of its parts, and its fixed sentences hold."""

import json

import pandas as pd
import pytest
from scipy.stats import binomtest, lognorm

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

from validation.page import FOLDER
from validation.study import near_fault as pulses
from validation.study.device import LARGE, LIR
from validation.study.shown import rows_of
from validation.study.summary import (
    COLLAPSE,
    DCFP,
    DRIFT,
    FLOOR,
    NAME,
    collapses,
    page,
    pairs,
    parts_of,
)


@pytest.fixture(scope="module")
def parts():
    return parts_of()


@pytest.fixture(scope="module")
def kept():
    return json.loads((FOLDER / f"{NAME}.json").read_text(encoding="utf-8"))


def test_the_page_is_that_of_the_numbers_of_the_parts(parts, kept):
    assert (FOLDER / f"{NAME}.md").read_text(encoding="utf-8") == page(parts, kept)


def said(told, *of):
    """Return the verdicts of comparisons of a campaign: limit state, group, DCFPs."""
    return {row["verdict"] for row in pairs(told, *of)}


def test_the_fixed_sentences_hold(parts, kept):
    own, near = parts["device"]["own"], parts["near_fault"]["own"]
    contact, held = (parts["device"]["campaigns"][name] for name in ("contact", "held"))
    for terms in ("plan", "moat", "cost"):
        assert said(contact, COLLAPSE, terms) == {"worse"}
    assert "worse" not in said(contact, DRIFT, "plan") | said(contact, FLOOR, "plan")
    for limit in (DRIFT, FLOOR):
        large = said(contact, limit, f"plan, {LARGE}")
        assert not large & {"better", "worse"}
        assert "better" in said(contact, limit, "plan")
    for group in ("plan, 689 mm", "plan, 1009 mm"):
        free, kept_shut = (
            {row["over"]: row["ratio [-]"] for row in pairs(each, COLLAPSE, group)}
            for each in (contact, held)
        )
        assert all(ratio > free[name] for name, ratio in kept_shut.items())
    assert said(parts["after"]["campaigns"]["after"], COLLAPSE, "a stop") == {"not told apart"}
    met, more = pulses.medians(near, pulses.PLAN), pulses.counts(near, pulses.MOAT)
    assert all(met[key][0] < met[key][1] for key in ("acceleration", "drift", "shear"))
    assert more[pulses.PLAIN_BETTER] > more[pulses.LIR_BETTER]
    lir, plain = (kept[name]["peaks"] for name in (LIR, DCFP))
    assert 0.0 < lir["rim force"] < plain["rim force"]
    assert max(kept[DCFP]["axial"]) == pytest.approx(plain["axial"], rel=1e-3)  # in this corner
    assert contact["considered"] == pytest.approx(2.2, abs=0.005)  # the intensity of both histories
    assert own["devices"][DCFP]["capacity"] == pytest.approx(0.364, abs=5e-4)


def test_every_comparison_has_its_exact_test(parts):
    """Of all campaigns: sign tests by scipy; a verdict has its side, and a rate of 10 %."""
    count = 0
    for told in (each for part in parts.values() for each in part["campaigns"].values()):
        for row in rows_of(told["tables"].get("ratios", pd.DataFrame())):
            less, more = row["less"], row["more"]
            expected = binomtest(less, less + more).pvalue if less + more else 1.0
            assert row["p"] == pytest.approx(expected, rel=1e-4)
            decided = row["verdict"] in ("better", "worse")
            assert decided is bool(row["q"] <= 0.1)
            assert not decided or (less > more) is (row["verdict"] == "better")
            count += decided
    assert count > 0


def test_shares_of_collapse_are_those_of_the_lognormal_curve(parts):
    told = parts["device"]["campaigns"]["contact"]
    row = told["tables"]["margins"].set_index("device").loc[LIR]
    at = lognorm(row["dispersion [-]"], scale=row["median [m/s2]"]).cdf(told["considered"])
    assert float(collapses(told, LIR)) == pytest.approx(100.0 * at, abs=0.5)
