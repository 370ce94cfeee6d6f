"""What a run may take: its number of steps, and the memory of its results."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING

from frames.bundles.nonlinear_data import part_sizes
from lir_element.argument_checks import require_positive
from lir_element.layout import BODIES, STATE
from lir_element.units import meant

if TYPE_CHECKING:
    import xarray as xr

    from frames.statics.gravity import GravityState

MOST_STEPS = 10**9
"""Steps beyond which a run is refused: the fastest would take an hour."""

COARSEST = 1.0
"""Step that resolves no earthquake [s]."""

USUAL_MEMORY = 8e9
"""Memory to count on where the system does not tell [bytes]."""

COPIES = 3.0
"""Size of the Dataset and of what it is made from over that of the states recorded."""


def number_of_steps(duration: float, dt: float | None, largest: float) -> int:
    """Return the base steps of a run, or refuse what cannot end."""
    step = largest if dt is None else require_positive("dt", dt, "s")
    if dt is not None and dt > duration * (1.0 + 1e-9):
        msg = (
            f"dt = {dt:g} s is longer than the run of {duration:g} s: a step of 0.005 s is usual; "
            "give it in seconds, or leave it out"
        )
        raise ValueError(msg)
    if dt is not None and dt > COARSEST:
        hint = meant(dt, "s", 1e-5, 0.05)
        msg = f"dt = {dt:g} s is longer than any step of an analysis, {COARSEST:g} s: {hint}"
        raise ValueError(msg)
    if duration / step > MOST_STEPS:
        msg = (
            f"duration = {duration:g} s in steps of {step:g} s makes {duration / step:.3g} steps: "
            f"at most {MOST_STEPS:g} are taken; give both in seconds, shorten the run or use "
            "larger steps"
        )
        raise ValueError(msg)
    return max(1, math.ceil(duration / step - 1e-9))


def bytes_of_step(state: GravityState) -> float:
    """Return the memory of a step: of the states recorded, and of the Dataset made of them."""
    with_points = 0 if state.contacts is None else len(state.contacts.sliders)
    row = len(state.model.props) * STATE.itemsize + with_points * BODIES.itemsize
    row += 8 * (3 * len(state.run.b) + 2 * len(state.run.e) + 24 * len(state.system.node_names))
    deformations, parts, words = part_sizes(state.parts)
    row += 8 * (4 * deformations + parts * words)
    return COPIES * row


def require_memory(state: GravityState, records: int) -> None:
    """Refuse to record all variables of more steps than the machine's memory holds."""
    require_room(bytes_of_step(state), records)


def require_room(step: float, records: int, besides: float = 0.0) -> None:
    """Refuse to record more than the machine's memory holds."""
    needed, there = step * records + besides, memory()
    if needed > there:
        msg = (
            f"{records} recorded steps take about {1e-9 * needed:.3g} GB, the machine has "
            f"{1e-9 * there:.3g} GB: use record_every = {math.ceil(2.0 * needed / there)} or more "
            "(times the present one), fewer channels or none (frames.Recording), or a shorter run"
        )
        raise ValueError(msg)


def memory() -> float:
    """Return the machine's memory [bytes]."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):  # not on every system
        return USUAL_MEMORY


def bytes_over_time(data: xr.Dataset) -> float:
    """Return the memory of one recorded step of a result [bytes]."""
    histories = [data[name].nbytes for name in data.variables if "time" in data[name].dims]
    return float(sum(histories)) / data.sizes["time"]


def require_rows(needed: float, runs: int, asked: int) -> None:
    """Refuse more results of many runs than the machine's memory holds."""
    there = memory()
    if needed > there:
        msg = (
            f"the results of {runs} of {asked} runs take about {1e-9 * needed:.3g} GB, the machine "
            f"has {1e-9 * there:.3g} GB: call time_histories for fewer cases at a time and save "
            "each, or record less (record=None keeps what was reached alone)"
        )
        raise ValueError(msg)
