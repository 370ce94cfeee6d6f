"""The parts on pulses and on motions: what is counted, by hand, and what their files say."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from frames.risk.campaign.file import campaign_file, models_in, read_campaign
from frames.risk.fragility.runs import COMPLETE, FAILURE
from validation.study import motions, near_fault
from validation.study.near_fault import LOOKS, PAIRS, PLAN
from validation.study.runner import tried
from validation.study.shown import sizes_of

HERE = Path(near_fault.__file__).parent


def test_devices_of_the_map_are_alike_but_for_what_is_limited():
    """Equal plan, or equal moat, within 2 mm; the LIR-DCFP is within the package's checks."""
    frames = models_in(HERE / "near_fault.toml")
    sizes = {name: sizes_of(frame) for name, frame in frames.items()}
    for pair, names in PAIRS.items():
        key, *size = pair.split()
        if size:
            wanted = 1e-3 * float(size[0])
            assert [sizes[name][key] for name in names] == pytest.approx([wanted] * 2, abs=2e-3)
    ratios = {name: each["ratio"] for name, each in sizes.items() if name.startswith("LIR")}
    assert ratios.pop(near_fault.BEYOND) > 1.2
    assert max(ratios.values()) <= 1.0


def test_a_cell_of_the_map_is_for_the_device_that_survives_or_is_lower():
    """One row: alike, lower drift, one of each, either alone, neither; 10 % are alike."""
    one = {"drift": [1.0, 0.8, 0.8, 1.0, 9.0, 9.0], "acceleration": [1.0, 1.05, 1.2, 1.0, 1.0, 1.0]}
    other = {"drift": [1.09, 1.0, 1.0, 9.0, 1.0, 9.0], "acceleration": [1.0] * 6}
    lost = [0, 0, 0, 0, 1, 1], [0, 0, 0, 1, 0, 1]
    cells = [{k: [row] for k, row in each.items()} for each in (one, other)]
    devices = {
        name: each | {"lost": [gone]}
        for name, each, gone in zip(PAIRS[PLAN], cells, lost, strict=True)
    }
    found = near_fault.verdicts({"devices": devices}, PLAN)[0]
    assert [LOOKS[int(kind)][3] for kind in found] == [
        "both survive, alike",
        "both survive, LIR-DCFP better",
        "both survive, one better in each",
        "LIR-DCFP alone survives",
        "DCFP alone survives",
        "neither survives",
    ]
    counted = near_fault.counts({"devices": devices}, PLAN)
    assert sum(counted.values()) == 6
    assert near_fault.both(counted) == 3


def test_cells_at_half_the_step_are_those_that_both_steps_have():
    """Of cells of 1, 2 and 3 s the last is missing at half, the second fails there alone."""
    columns = ["motion", "outcome", *(name for name, *_ in near_fault.QUANTITIES.values())]

    def cells(*rows):
        runs = pd.DataFrame([(*row, *[row[-1]] * 4) for row in rows], columns=columns)
        return near_fault.cells_of(runs.assign(model="LIR", scale=1.0))

    def pulse(shape, period, drift, outcome=COMPLETE):
        return f"{shape} pulse of {period} s, 1 m/s", outcome, drift

    whole = cells(
        pulse("symmetric", 1, 0.02), pulse("antisymmetric", 1, 0.01),
        pulse("symmetric", 2, 0.01), pulse("symmetric", 3, 0.06),
    )  # fmt: skip
    half = cells(
        pulse("symmetric", 1, 0.01), pulse("antisymmetric", 1, 0.021),
        pulse("symmetric", 2, 0.01, FAILURE),
    )  # fmt: skip
    assert whole["lost"].tolist() == [0.0, 0.0, 1.0]  # a drift above 5 %
    found = near_fault.steps_of(whole, half)["LIR"]
    counted = {key: found[key] for key in ("cells", "failed", "lost", "survived")}
    assert counted == {"cells": 2, "failed": 1, "lost": 1, "survived": 1}
    assert found["drift"] == pytest.approx([0.05, 0.05])  # of the worse shapes, 0.021 over 0.02


def test_motions_have_the_names_that_the_numbers_look_for():
    turned, same = (
        [*read_campaign(tried(campaign_file(HERE / f"motions-{name}.toml"), 2)).motions]
        for name in ("turned", "same")
    )
    assert len(turned) == len(same) == 3 * 2
    for angle in motions.ANGLES[1:]:
        assert sum(name.endswith(f", {angle} degrees") for name in turned) == 2
    assert sum(", then " in name for name in same) == 2 * 2
    assert campaign_file(HERE / "motions-vertical.toml").motions.vertical == ("with", "without")


def runs_of(rows):
    """Return runs by motion, outcome, ductility and residual slip, with those over 9."""
    ends = {"ok": "complete", "fails": "bearing failure", "unknown": "numerical failure"}
    columns = ("motion", "outcome", "ductility", "residual interface slip")
    table = pd.DataFrame(rows, columns=columns).assign(scale=2.0)
    table["outcome"] = table["outcome"].map(ends)
    over = ((table["outcome"] == ends["fails"]) | (table["ductility"] > 9.0)).astype(float)
    return table.assign(over=over.where(table["outcome"] != ends["unknown"]))


def test_survivors_of_the_first_shock_count():
    """Of a (fails at once), b (collapses in the second), c (holds), d (analysis of both failed)."""
    alone = runs_of(
        [("a", "fails", 1.0, 0.0), ("b", "ok", 3.0, 0.01), ("c", "ok", 1.0, 0.02),
         ("d", "ok", 1.0, 0.03)]
    )  # fmt: skip
    both = runs_of(
        [("a, then 1 b", "fails", 1.0, 0.0), ("b, then 1 c", "ok", 9.5, 0.05),
         ("c, then 1 d", "ok", 2.0, 0.06), ("d, then 1 a", "unknown", 1.0, 0.0)]
    )  # fmt: skip
    held = both.assign(over=both["over"].where(both["over"].isna(), 0.0), ductility=1.0)
    found = motions.second_shocks({"LIR-DCFP": [alone, both], "DCFP": [alone, held]}, "next", 1.0)
    assert (found["LIR-DCFP"]["survived"], found["LIR-DCFP"]["collapsed"]) == (2, 1)
    assert found["LIR-DCFP"]["slip"] == pytest.approx([15.0, 55.0])
    assert found["DCFP"]["collapsed"] == 0
    assert found["apart"] == [1, 0, 1.0]


def test_the_angle_decides_where_outcomes_differ():
    """Record a collapses turned by 30 degrees alone, b at all angles, c is unknown at one."""
    names = [f"{name}{turn}" for name in "abc" for turn in ("", ", 30 degrees", ", 60 degrees")]
    over = [0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, np.nan, 0.0]
    own = pd.DataFrame({"motion": names, "record": [*"aaabbbccc"], "over": over})
    found = motions.turned({"LIR-DCFP": own, "DCFP": own.assign(over=0.0)})
    assert found["decides"] == {"LIR-DCFP": [1, 2], "DCFP": [0, 3]}
    assert found["angles"]["30"] == {"LIR-DCFP": [2, 2], "DCFP": [0, 3], "apart": [2, 0, 0.5]}
