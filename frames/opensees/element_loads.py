"""Loads along the elements of an OpenSees model, and what they add in the middle of an element."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray

_SIZES = {3: 2, 4: 3, 5: 3, 6: 4}
"""Numbers that OpenSees hands over of a load, by the tag of its class: uniform in the plane, at a
point in the plane, uniform in space, at a point in space."""

_UNIFORM = (3, 5)
_TURNED = 1e-2  # of the forces, by which loads that turn with their element may differ


class ElementLoad(NamedTuple):
    """A load of an element in its local axes."""

    force: tuple[float, float, float]
    """Per length, or at a point, in units of the model."""
    at: float | None
    """Place of a point load over the length of the element [-]; None of a uniform load."""


def element_loads(ops: Any, ndm: int) -> dict[int, list[ElementLoad | None]]:
    """Read the loads of all elements."""
    found: dict[int, list[ElementLoad | None]] = {}
    for pattern in ops.getPatterns() or ():
        tags = [int(tag) for tag in ops.getEleLoadTags(pattern) or ()]
        if not tags:
            continue
        kinds = [int(kind) for kind in ops.getEleLoadClassTags(pattern)]
        numbers = list(map(float, ops.getEleLoadData(pattern)))
        is_known = sum(_SIZES.get(kind, 0) for kind in kinds) == len(numbers)
        is_known = is_known and all(kind in _SIZES for kind in kinds)
        factor, first = float(ops.getLoadFactor(pattern)), 0
        for tag, kind in zip(tags, kinds, strict=True):
            load = None
            if is_known:
                own = numbers[first : first + _SIZES[kind]]
                first += _SIZES[kind]
                load = _load(own, kind, ndm, factor)
            found.setdefault(tag, []).append(load)
    return found


def _load(numbers: Sequence[float], kind: int, ndm: int, factor: float) -> ElementLoad:
    # OpenSees lists what is across the element before what is along it.
    across, along = numbers[: ndm - 1], numbers[ndm - 1]
    y, z = (*across, 0.0)[:2]
    at = None if kind in _UNIFORM else numbers[ndm]
    return ElementLoad((factor * along, factor * y, factor * z), at)


def middle_of(
    loads: Sequence[ElementLoad | None], length: float, ends: FloatArray
) -> FloatArray | None:
    """Return what loads of an element add in its middle to the mean of both ends.

    Shapes: ends (12,), result (6,).
    """
    total, found = np.zeros(3), np.zeros(6)
    for load in loads:
        if load is None:
            return None
        force = np.array(load.force)
        at = 0.5 if load.at is None else load.at
        force = force * length if load.at is None else force
        total += force
        if load.at is not None:
            found[:3] += 0.5 * np.sign(at - 0.5) * force
        lever = 0.125 * length if load.at is None else (0.25 - 0.5 * abs(at - 0.5)) * length
        found[4] += lever * force[2]
        found[5] -= lever * force[1]
    apart = np.abs(ends[:3] + ends[6:9] + total).max()
    size = np.abs(ends[:3]).max() + np.abs(ends[6:9]).max()
    return found if apart <= _TURNED * size else None
