"""The study's summary is that of the numbers of its parts, and its fixed sentences hold."""

import json

import pytest
from scipy.stats import binomtest

pytest.importorskip("filelock")
pytest.importorskip("pyFragility")

from validation.page import FOLDER
from validation.study import near_fault as pulses
from validation.study.__main__ import PARTS
from validation.study.device import LIR, PLANS
from validation.study.summary import (
    COLLAPSE,
    DCFP,
    DRIFT,
    DUCTILITY,
    FLOOR,
    NAME,
    OTHERS,
    line_of,
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
    assert {*OTHERS, "device", "near_fault", "summary"} == {*PARTS}


def said(own, limit, terms="plan", end=""):
    """Return the verdicts of the comparisons of a limit state."""
    return {row["verdict"] for row in pairs(own, limit, terms, end)}


def test_the_fixed_sentences_hold(parts, kept):
    own, near = parts["device"]["own"], parts["near_fault"]["own"]
    worse = {"worse"}
    assert (
        said(own, COLLAPSE) == said(own, COLLAPSE, "moat") == said(own, COLLAPSE, "cost") == worse
    )
    assert said(own, DUCTILITY, "moat") == said(own, DUCTILITY, "cost") == worse
    assert said(own, DRIFT, "moat") == worse
    assert "worse" not in said(own, DRIFT) | said(own, FLOOR)
    for limit in (DRIFT, FLOOR):
        small = {row["verdict"] for row in pairs(own, limit) if PLANS[-1] not in row["other"]}
        large = {row["verdict"] for row in pairs(own, limit) if PLANS[-1] in row["other"]}
        assert "better" in small - large
    failed = {
        name: each["tables"]["margins"].set_index("device")["bearing failed"][LIR]
        for name, each in parts["device"]["campaigns"].items()
        if name in ("contact", "held")
    }
    assert failed["held"] < failed["contact"]
    met, more = pulses.medians(near, pulses.PLAN), pulses.counts(near, pulses.MOAT)
    assert all(met[key][0] < met[key][1] for key in ("acceleration", "drift", "shear"))
    assert more[pulses.PLAIN_BETTER] > more[pulses.LIR_BETTER]
    lir, plain = (kept[name]["peaks"] for name in (LIR, DCFP))
    assert 0.0 < lir["rim force"] < plain["rim force"]
    axial = kept[DCFP]
    assert max(axial["axial"]) == pytest.approx(plain["axial"], rel=1e-3)  # in this corner
    considered = parts["device"]["campaigns"]["contact"]["considered"]
    assert considered == pytest.approx(2.2, abs=0.005)  # the intensity of both histories


def test_every_comparison_has_its_exact_test(parts):
    """Sign tests by scipy from the records that differ; a verdict has its ratio's side."""
    own, count = parts["device"]["own"], 0
    for level in ("contact", "pendulum"):
        for row in [row for rows in own[level]["pairs"].values() for row in rows]:
            less, more = row["less"], row["more"]
            expected = binomtest(less, less + more).pvalue if less + more else 1.0
            assert row["p"] == pytest.approx(expected, rel=1e-4)
            if row["verdict"] in ("better", "worse"):
                assert (less > more) is (row["verdict"] == "better")
                count += 1
    assert count > 0


def test_a_part_of_campaign_files_has_its_level_and_ratios(parts):
    ratios = parts["device"]["campaigns"]["pendulum"]["tables"]["ratios"]
    collapse = ratios[ratios["limit state"] == COLLAPSE]["ratio [-]"].dropna()
    text = line_of({"campaigns": {"one": parts["device"]["campaigns"]["pendulum"]}})
    assert text.startswith("Level `pendulum`. Collapse: ")
    assert f"{collapse.min():.2f} to {collapse.max():.2f}, " in text
