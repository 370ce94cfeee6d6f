"""The recorded steps that a page keeps: all where it can, else those that curves need most."""

from __future__ import annotations

import heapq
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, IntArray

CONTACT = 4.0
"""How many times as much an error counts where a rim is touched or a bearing has lifted."""

WINDOW = 0.02
"""Time before and after it in which that holds [s]."""


def kept_steps(time: FloatArray, curves: FloatArray, contact: BoolArray, count: int) -> IntArray:
    """Return the steps between which straight lines follow the curves best.

    The first and the last step and the extremes of each curve are kept. Then, again and again,
    the step that lies farthest off the line between its kept neighbours.

    Shapes: time (n_steps,), curves (n_steps, m), contact (n_steps,).
    """
    if count >= len(time):
        return np.arange(len(time))
    weights = np.where(_widened(time, contact), CONTACT, 1.0)
    kept = set(_extremes(curves).tolist())
    order = sorted(kept)
    heap = [_farthest(time, curves, weights, *ends) for ends in pairwise(order)]
    heapq.heapify(heap)
    while heap and len(kept) < count:
        error, first, step, last = heapq.heappop(heap)
        if not error < 0.0:
            break
        kept.add(step)
        for ends in ((first, step), (step, last)):
            heapq.heappush(heap, _farthest(time, curves, weights, *ends))
    return np.array(sorted(kept), dtype=np.int64)


def line_error(time: FloatArray, curves: FloatArray, kept: IntArray) -> float:
    """Return the largest distance of recorded curves (n_steps, m) from lines between kept steps."""
    place = np.searchsorted(kept, np.arange(len(time)), side="right").clip(1, len(kept) - 1)
    first, last = kept[place - 1], kept[place]
    share = ((time - time[first]) / (time[last] - time[first]))[:, None]
    return float(np.abs(curves - (1.0 - share) * curves[first] - share * curves[last]).max())


def _extremes(curves: FloatArray) -> IntArray:
    ends = np.array([0, len(curves) - 1])
    return np.unique(np.concatenate([ends, curves.argmax(axis=0), curves.argmin(axis=0)]))


def _widened(time: FloatArray, where: BoolArray) -> BoolArray:
    # Also what is less than the window away from a step that is marked.
    at = time[where]
    if not len(at):
        return where
    after = np.searchsorted(at, time - WINDOW)
    nearest = at[after.clip(max=len(at) - 1)]
    return np.asarray(np.abs(nearest - time) <= WINDOW) | where


def _farthest(
    time: FloatArray, curves: FloatArray, weights: FloatArray, first: int, last: int
) -> tuple[float, int, int, int]:
    # Minus the largest weighed error between two kept steps, and the step that has it: heaps give
    # the smallest.
    if last - first < 2:
        return 0.0, first, first, last
    inside = slice(first + 1, last)
    share = ((time[inside] - time[first]) / (time[last] - time[first]))[:, None]
    line = curves[first] + share * (curves[last] - curves[first])
    errors = np.abs(curves[inside] - line).max(axis=1) * weights[inside]
    step = int(errors.argmax())
    return -float(errors[step]), first, first + 1 + step, last
