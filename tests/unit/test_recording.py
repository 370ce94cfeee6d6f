"""The recording as an object: what it takes, what it refuses, what it calls itself."""

import dataclasses

import numpy as np
import pytest

from frames import Recording
from frames.recording.recording import recording_of
from frames.recording.reduction import _regular
from frames.results.peak_response import Extreme, extreme_of, larger_of


def test_constructors_are_fields_put_together():
    assert Recording.everything() == Recording(every=1)
    assert Recording.everything().is_everything
    assert Recording.impacts(0.1, 0.4, every=5) == Recording(every=5, around_impacts=(0.1, 0.4))
    assert Recording.peaks() == Recording(every=None, extremes=True)
    assert not Recording(extremes=True).is_everything
    both = dataclasses.replace(Recording.impacts(), extremes=True, channels=["energy", "energy"])
    assert (both.channels, both.every, both.extremes) == (("energy",), 10, True)


def test_it_is_frozen_and_can_be_a_key():
    one = Recording(channels=["energy"], every=2.0)
    assert {one: 1}[Recording(every=2, channels=("energy",))] == 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        one.every = 3
    assert eval(repr(one)) == one  # noqa: S307


BAD = [
    ({"every": 0}, ValueError, "every = 0 must be a whole number of at least 1"),
    ({"every": 1.5}, ValueError, "every = 1.5 must be a whole number"),
    ({"every": float("nan")}, ValueError, "every = nan must be a whole number"),
    ({"every": "a"}, TypeError, "every = 'a' must be a whole number.*count base steps"),
    ({"every": True}, TypeError, "every = True must be a whole number"),
    ({"channels": "energy"}, TypeError, r"channels = 'energy' must be a sequence.*\('energy',\)"),
    ({"channels": ()}, ValueError, "channels is empty: name at least one"),
    ({"nodes": 3}, TypeError, "nodes = 3 must be a sequence of names"),
    ({"bearings": [1]}, TypeError, "bearings: 1 .* must be a name"),
    ({"levels": []}, ValueError, "levels is empty"),
    ({"around_impacts": 0.2}, TypeError, r"around_impacts = 0.2 must be a pair.*\(0.2, 0.5\)"),
    ({"around_impacts": (0.2,)}, TypeError, "must be a pair of times"),
    ({"around_impacts": (-0.1, 0.2)}, ValueError, "before a rim contact = -0.1 .* at least 0"),
    ({"around_impacts": (0.1, np.inf)}, ValueError, "after a rim contact = inf .* finite"),
    ({"extremes": 1}, TypeError, "extremes = 1 must be True or False"),
    ({"forces": "yes"}, TypeError, "forces = 'yes' must be True or False"),
]


@pytest.mark.parametrize(("options", "kind", "message"), BAD, ids=[str(b[0]) for b in BAD])
def test_what_cannot_be_recorded_is_refused(options, kind, message):
    with pytest.raises(kind, match=message):
        Recording(**options)


def test_the_older_argument_stands_for_a_recording():
    assert recording_of(None, 4) == Recording(every=4)
    assert recording_of(Recording.peaks(), 1) == Recording.peaks()
    with pytest.raises(ValueError, match=r"record_every = 2 and recording = Recording\(every=3\)"):
        recording_of(Recording(every=3), 2)
    with pytest.raises(TypeError, match="recording = 'peaks' must be a Recording"):
        recording_of("peaks", 1)


@pytest.mark.parametrize(
    ("every", "words"), [(2, "2nd"), (3, "3rd"), (11, "11th"), (21, "21st"), (112, "112th")]
)
def test_words(every, words):
    assert str(Recording(every=every)) == f"every {words} step"
    assert str(Recording()) == "every step"


def test_extremes_of_pieces_are_those_of_the_whole():
    """The first of equal values counts, as in the whole; what is not a number stays so."""
    history = np.array([[1.0, 2.0, 0.0], [3.0, 2.0, np.nan], [3.0, -1.0, 1.0], [0.0, 2.0, 5.0]])
    time = np.array([0.0, 0.1, 0.2, 0.3])
    whole = extreme_of(history, time)
    assert whole.at.tolist() == [0.1, 0.0, 0.1]
    for cut in (1, 2, 3):
        parts = [extreme_of(history[s], time[s]) for s in (slice(None, cut), slice(cut, None))]
        joined = larger_of(*parts)
        assert isinstance(joined, Extreme)
        np.testing.assert_array_equal(joined.values, whole.values)
        np.testing.assert_array_equal(joined.at, whole.at)


def test_regular_steps():
    assert np.flatnonzero(_regular(np.arange(3, 14), 5)).tolist() == [2, 7]
    assert np.flatnonzero(_regular(np.arange(4), None)).tolist() == [0]
