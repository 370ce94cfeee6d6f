"""Bundle of a bearing in the testing rig, as kernels read it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.bundles.contact_data import as_rows
from lir_element.layout import BODIES, STATE, WORK

if TYPE_CHECKING:
    from lir_element.layout import Floats, Records, Words


class RigRun(NamedTuple):
    """A bearing (records are arrays of one), its path, where it stands, and what it leaves."""

    props: Records  # (1,)
    old: Records
    new: Records
    old_words: Words  # (1, words): the same memory
    new_words: Words
    work: Records
    heat: Floats  # parts of the temperatures (`heat_parts`)
    path: Floats  # (n, 2) places of the top plate
    loads: Floats  # (n,) axial loads, linear between
    velocity: float
    increment: float  # m, largest
    u: Floats  # (12,)
    v: Floats
    tangent: Floats  # (12, 12)
    states: Records  # (n,) STATE at the points
    velocities: Floats  # (n, 2)
    bodies: Records  # (n,) BODIES, where the sliders are bodies
    states_words: Words  # (n, words): the same memory
    bodies_words: Words
    reached: Words  # (2,) points reached, increments since
    clock: Floats  # (2,) time of the last point, of the last trial


def rig_run(
    props: Records,
    start: Records,
    heat: Floats,
    path: Floats,
    loads: Floats,
    velocity: float,
    increment: float,
) -> RigRun:
    """Return a bearing at rest that is to follow a path.

    Shapes: props, start (1,), path (n, 2), loads (n,).
    """
    old, new = start.copy(), start.copy()
    states, bodies = np.zeros(len(path), dtype=STATE), np.zeros(len(path), dtype=BODIES)
    return RigRun(
        props,
        old,
        new,
        as_rows(old),
        as_rows(new),
        np.zeros(1, dtype=WORK),
        heat,
        path,
        loads,
        velocity,
        increment,
        np.zeros(12),
        np.zeros(12),
        np.zeros((12, 12)),
        states,
        np.zeros((len(path), 2)),
        bodies,
        as_rows(states),
        as_rows(bodies),
        np.zeros(2, dtype=np.int64),
        np.zeros(2),
    )
