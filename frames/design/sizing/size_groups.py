"""Bearings of unlike loads in groups, each with sliders of one radius."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError

if TYPE_CHECKING:
    from frames.design.codes.isolation import IsolationSystem


class Size(NamedTuple):
    """Loads of the bearings that have sliders of one radius [N].

    Attributes
    ----------
    least, average, largest : float
        Least load of all combinations, largest of the average combination, and of all.
    lightest, typical : float
        Of the average combination: the least, and the mean weighted by the loads themselves,
        which is the load under which the friction of all of them together is developed.
    number : int
        Number of bearings.
    """

    least: float
    average: float
    largest: float
    lightest: float
    typical: float
    number: int


def grouped(system: IsolationSystem, sizes: int) -> tuple[tuple[int, ...], tuple[Size, ...]]:
    """Return which size each bearing has, smallest first, and the loads of each size.

    The largest loads are parted so that the sliders' areas, all together, are least.

    Shapes: result (n_bearings,).
    """
    if sizes < 1:
        msg = f"sizes = {sizes}: give a number of sliders, at least 1"
        raise CheckError(msg)
    columns = list(zip(system.loads, *system.combinations.values(), strict=True))
    largest = [max(column) for column in columns]
    rounded = [float(f"{load:.3g}") for load in largest]
    steps = sorted(set(rounded))
    counts = [rounded.count(step) for step in steps]
    inner = range(len(steps) - 1)

    def area(tops: tuple[int, ...]) -> float:
        ends = (*tops, len(steps) - 1)
        starts = (0, *(top + 1 for top in tops))
        return sum(
            steps[end] * sum(counts[start : end + 1])
            for start, end in zip(starts, ends, strict=True)
        )

    tops = min(combinations(inner, min(sizes, len(steps)) - 1), key=area)
    limits = [steps[top] for top in tops]
    places = tuple(sum(load > limit for limit in limits) for load in rounded)
    return places, tuple(
        _loads([columns[k] for k, size in enumerate(places) if size == number])
        for number in range(len(limits) + 1)
    )


def _loads(columns: list[tuple[float, ...]]) -> Size:
    # A bearing that a combination lifts is asked by its least load while it carries.
    pressed = [load for column in columns for load in column if load > 0.0]
    average = [column[0] for column in columns]
    return Size(
        least=min(pressed),
        average=max(average),
        largest=max(pressed),
        lightest=min(average),
        typical=sum(load * load for load in average) / sum(average),
        number=len(columns),
    )
