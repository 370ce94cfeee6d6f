"""What follows a bearing's failure: the study's devices; its page is that of its numbers."""

import json
import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import binom, norm

from frames.risk.campaign.comparison import dish_diameter
from validation.page import FOLDER
from validation.study.after import DEVICES, DROPS, KINDS, NAME, Kind, devices, page
from validation.study.device_runs import REFERENCE, plan_of
from validation.study.records_runs import COLLAPSE, SCALES, considered


def test_devices_are_alike_but_for_what_follows():
    every = devices()
    assert set(every) == {kind.name for kind in KINDS}
    for device in DEVICES:
        alone = every[Kind(device, None).name].bearings
        largest = max(dish_diameter(link.bearing) for link in alone.values())
        assert largest == pytest.approx(plan_of(REFERENCE))
        for drop in DROPS[1:]:
            for name, link in every[Kind(device, drop).name].bearings.items():
                own = link.bearing
                assert own.backup.drop == drop
                assert alone[name].bearing.backup is None
                assert own.resolved() == alone[name].bearing.resolved()
                assert own.rim_yield_force == alone[name].bearing.rim_yield_force


def test_the_page_is_that_of_its_numbers():
    stored = json.loads((FOLDER / f"{NAME}.json").read_text(encoding="utf-8"))
    assert (FOLDER / f"{NAME}.md").read_text(encoding="utf-8") == page(stored)
    assert stored["considered"] == pytest.approx(considered())
    for kind in KINDS:
        assert sum(stored["statuses"][kind.name].values()) == stored["records"] * len(SCALES)
        rows = stored["stripes"][kind.name]
        assert [row["im"] for row in rows] == list(SCALES)
        assert all(row["collapsed"] <= row["known"] <= stored["records"] for row in rows)
        if kind.drop is None:
            assert "bearing_lost" not in stored["statuses"][kind.name]
            assert all(row["failed"] <= row["collapsed"] for row in rows)
        else:
            # the same bearings fail, whatever follows
            before = stored["stripes"][Kind(kind.device, None).name]
            pairs = zip(rows, before, strict=True)
            assert all(abs(a["failed"] - b["failed"]) <= 1 for a, b in pairs)
        margin = stored["margins"].get(kind.name)
        if margin:
            median = stored["limits"][COLLAPSE.name][kind.name]["median"][0]
            assert margin[0] == pytest.approx(median / stored["considered"])
            assert math.isfinite(margin[2])


def test_medians_are_those_of_the_counts():
    """By scipy alone: the lognormal curve under which the counts of all stripes are likeliest."""
    stored = json.loads((FOLDER / f"{NAME}.json").read_text(encoding="utf-8"))
    for kind in KINDS:
        curve = stored["limits"][COLLAPSE.name][kind.name]
        if "median" not in curve:
            continue
        rows = stored["stripes"][kind.name]
        im, over, known = (
            np.array([row[key] for row in rows]) for key in ("im", "collapsed", "known")
        )

        def unlikely(p, im=im, over=over, known=known):
            share = norm.cdf((np.log(im) - p[0]) / math.exp(p[1]))
            return -binom.logpmf(over, known, np.clip(share, 1e-12, 1.0 - 1e-12)).sum()

        found = minimize(unlikely, [1.0, -1.0], method="Nelder-Mead", tol=1e-10)
        assert math.exp(found.x[0]) == pytest.approx(curve["median"][0], rel=1e-5)
        assert math.exp(found.x[1]) == pytest.approx(curve["dispersion"][0], rel=1e-3)
