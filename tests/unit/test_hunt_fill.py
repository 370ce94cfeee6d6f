"""Hunt and fill: the intensities it asks for, against capacities that are known."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frames.risk import FragilityError, HuntFill
from tests.refusals import refused


def played(rules: HuntFill, capacity: float, failing: object = None) -> tuple[list, list]:
    """Return intensities and outcomes of a record of a capacity, run until it is done."""
    im: list[float] = []
    over: list[float] = []
    while asked := rules.next_intensities(im, over):
        for each in asked:
            im.append(each)
            fails = failing is not None and failing(each)
            over.append(math.nan if fails else float(each > capacity))
    return im, over


def test_the_steps_of_the_hunt_grow() -> None:
    rules = HuntFill(first=1.0, step=2.0, growth=0.5, runs=5)
    im, over = played(rules, math.inf)
    assert im == [1.0, 3.0, 5.5, 8.5, 12.0]
    assert not any(over)


def test_hunt_bracket_and_fill_by_hand() -> None:
    im, over = played(HuntFill(first=1.0, step=1.0, growth=0.0, resolution=0.3, runs=7), 2.2)
    # up to 3, a third of the gap above 2 (2.33 exceeds: 14 % of 2.33 is narrow), then the widest
    assert im[:4] == pytest.approx([1.0, 2.0, 3.0, 2.0 + 1.0 / 3.0])
    assert im[4:] == pytest.approx([0.5, 1.5, 0.25])
    assert over == [0, 0, 1, 1, 0, 0, 0]


@given(st.floats(0.05, 60.0), st.floats(0.02, 0.3))
def test_the_gap_closes_and_no_intensity_is_run_twice(capacity: float, resolution: float) -> None:
    rules = HuntFill(first=1.0, resolution=resolution, runs=60)
    im, over = (np.array(values) for values in played(rules, capacity))
    assert len(im) == 60
    assert len(set(im)) == len(im)
    upper = im[over == 1].min()
    lower = im[over == 0].max(initial=0.0)
    assert lower <= capacity <= upper
    assert upper - lower <= resolution * upper


@given(st.floats(0.5, 20.0), st.integers(0, 2**20))
def test_failed_runs_are_gone_around(capacity: float, seed: int) -> None:
    """Every third run fails, wherever: the rules still end, and never ask for the same again."""
    chance = np.random.default_rng(seed)
    im, over = played(HuntFill(first=1.0, runs=40), capacity, lambda _: chance.random() < 0.33)
    assert len(im) <= 40
    assert len(set(im)) == len(im)
    known = np.array(over) == 1
    if known.any():
        assert min(np.array(im)[known]) > capacity


def test_a_failed_run_is_neither() -> None:
    rules = HuntFill(first=1.0, step=1.0, growth=0.0)
    assert rules.next_intensities([1.0, 2.0], [0.0, math.nan]) == (3.0,)
    # in a gap that failed at 2.4: the middle of its widest part
    assert rules.next_intensities([2.0, 3.0, 2.4], [0.0, 1.0, math.nan]) == (2.7,)


def test_above_a_first_failure_nothing_counts() -> None:
    """A structure that holds again higher up: the lowest exceedance is bracketed."""
    rules = HuntFill(first=1.0)
    assert rules.next_intensities([1.0, 2.0, 3.0], [0.0, 1.0, 0.0])[0] == pytest.approx(4.0 / 3.0)


def test_the_hunt_ends_at_the_highest() -> None:
    im, _ = played(HuntFill(first=1.0, step=1.0, growth=0.0, highest=2.5, runs=5), math.inf)
    assert im[:3] == [1.0, 2.0, 2.5]
    assert sorted(im[3:]) == [0.5, 1.5]


@pytest.mark.parametrize(
    ("words", "given"),
    [
        ("first", {"first": 0.0}),
        ("runs", {"first": 1.0, "runs": 1}),
        ("resolution", {"first": 1.0, "resolution": 1.5}),
        ("below", {"first": 2.0, "highest": 1.0}),
    ],
)
def test_what_makes_no_sense_is_refused(words, given):
    refused(FragilityError, words, HuntFill, **given)
    refused(FragilityError, "one length", HuntFill(first=1.0).next_intensities, [1.0], [])
