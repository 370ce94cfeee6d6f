"""What a bearing in an OpenSees model tells its user, by number (`layout.MESSAGES`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lir_element.errors import RunStatus
from lir_element.opensees.block.layout import (
    HINT,
    LOAD_HIGH,
    LOAD_LOW,
    NEVER_LOADED,
    NOT_SAVED,
    TOLD_ENOUGH,
)

if TYPE_CHECKING:
    from lir_element.opensees.placement import Placement

HINTED = np.zeros(1, dtype=np.int64)
"""1 once a failed step of this process was explained."""


def bearing_messages(tag: int, design_load: float, placement: Placement) -> dict[int, str]:
    """Return the messages of a bearing."""
    who = f"bearing element {tag}"
    load = f"its design load, {design_load:g} N ({design_load / placement.force_unit:g} of the"
    units = (
        "What to try: check the model's loads and units (length_unit, force_unit of "
        "bearing_element), or give the device its design_load."
    )
    up = ", ".join(f"{each:g}" for each in placement.axes[2])
    texts = {
        int(status): f"{who}: {status.meaning}. What to try: {status.remedy}."
        for status in RunStatus
    }
    texts[NEVER_LOADED] = (
        f"{who} has no state where it was moved to, and was never compressed along its axis, "
        f"({up}) in the model. What to try: if the model's vertical is another, name it by "
        "orient=(x, y, z), (0, 1, 0) where y points upwards; apply the weight before anything else."
    )
    texts[LOAD_LOW] = (
        f"{who} carries less than an eighth of {load} model's units) as it begins to move. {units}"
    )
    texts[LOAD_HIGH] = f"{who} carries more than eight times {load} model's units). {units}"
    texts[TOLD_ENOUGH] = f"{who}: trials without a state are not told from here on."
    texts[NOT_SAVED] = (
        f"{who} is neither saved to a database nor restored from one: its state is no part of it. "
        "What to try: run the analysis again up to here, or keep several analyses in one process."
    )
    texts[HINT] = (
        "a step failed in a model with LIR bearings. Try algorithm KrylovNewton or smaller "
        "steps. Where the system of equations is a symmetric one (ProfileSPD, BandSPD, SparseSYM), "
        "that is the cause: the bearings, whose tangent is unsymmetric, need UmfPack, BandGeneral "
        'or FullGeneral, or tangent="symmetric" in bearing_element.'
    )
    return {number: f"WARNING {text}\n" for number, text in texts.items()}
