"""Random test cases (validation.fuzzing): a run completes or says when and why it stopped.

Nothing else is allowed: no NaN, no silent failure, no bearing computed on beyond its limits, no
energy from nowhere. Every sixth at the level "pendulum" is run again, turned and mirrored; the
thousands, and finer steps, are for `python -m validation.random_scenes`.
"""

import pytest

from lir_element import RunStatus
from validation.fuzzing.buildings import try_building
from validation.fuzzing.scenes import random_scene, with_yielding_rims
from validation.fuzzing.trial import try_scene

SEED = 1
CASES, NIGHTLY = 30, 300
"""Number of test cases, and with those that `make nightly` adds."""
AGAIN = 6
BUILDINGS = 8
HARD_BUILDINGS = (119, 123)
"""Lateral loads on friction that holds within a micrometre, sliders of unlike size and friction."""
HARD = (342, 533, 962, 1044, 1086, 1657, 2639, 3728)
"""Found once: one bearing of a grid with contact points, seen in
a mirror; Newton's method that tells east from north; friction that owes work; a mass that nothing
holds against a twist; sliders of a bearing that has lifted."""
BENT = (8, 20, 35, 43, 53, 55, 61, 63, 70, 71, 85, 98, 101, 115, 123, 126, 127, 138, 155, 171)
"""Whose rims, given a strength, yield; those of 71 and 101 break."""
FAILURES = {status.name.lower() for status in RunStatus} - {"ok"}


@pytest.mark.parametrize(
    "number",
    [
        *range(CASES),
        *HARD,
        *(pytest.param(one, marks=pytest.mark.nightly) for one in range(CASES, NIGHTLY)),
    ],
)
def test_completes_or_reports(number):
    again = number % AGAIN == 0 and random_scene(SEED, number).level == "pendulum"
    report = try_scene(SEED, number, again=again or number in HARD, finer=False)
    assert report.findings == [], report.scene
    assert report.outcome in {"ok", *FAILURES}, report.message


@pytest.mark.parametrize(
    "number",
    [
        *BENT[::3],
        *(
            pytest.param(one, marks=pytest.mark.nightly)
            for one in sorted({*BENT, *range(172, NIGHTLY)} - {*BENT[::3]})
        ),
    ],
)
def test_with_rims_that_yield(number):
    report = try_scene(
        SEED, number, again=number in BENT[::4], finer=False, change=with_yielding_rims
    )
    assert report.findings == [], report.scene
    assert report.outcome in {"ok", *FAILURES}, report.message


@pytest.mark.parametrize("number", [*range(BUILDINGS), *HARD_BUILDINGS])
def test_a_building_finds_its_equilibrium_and_rests(number):
    report = try_building(SEED, number)
    assert report.findings == [], report.scene
    assert report.outcome in {"ok", "uplifted", "refused"}, report.message
