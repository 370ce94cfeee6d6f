"""What links and hinges of a run reached, from what its loop records, without any Dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.model.components import hinged_ends
from frames.nonlinear_layout import N_PLASTIC, WORK_DONE
from frames.results.peak_response import Extreme, extreme_of, later

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.kernel_data import Output
    from frames.model.frame_data import FrameData
    from frames.statics.gravity import GravityState


class PartGauge:
    """Keeps what nonlinear parts reached; of a structure without any, nothing.

    Parameters
    ----------
    state : GravityState
        Of the structure.
    model : Frame
        The structure.
    """

    def __init__(self, state: GravityState, model: FrameData) -> None:
        found = state.system.parts
        self._links = len(found.links)
        self._elastic = found.elastic[: self._links]
        limits = [getattr(link.law, "yield_deformation", np.nan) for link in found.links]
        self._yields = np.where(np.isfinite(limits), limits, np.inf)
        order = {member: k for k, member in enumerate(found.hinged, start=self._links)}
        ends = hinged_ends(model.hinges) if found.hinged else []
        self._hinges = [(order[member], end) for _, member, end, _ in ends]
        self._reached: dict[str, Extreme] = {}

    def take(self, out: Output, first: int, last: int) -> None:
        """Take up rows first <= k < last of what was recorded, which follow those before."""
        time = out.time[first:last]
        for name, values in self._histories(out, first, last).items():
            if len(time):
                now = extreme_of(values, time)
                before = self._reached.get(name)
                self._reached[name] = now if before is None else later(before, now)

    def reached(self) -> dict[str, Extreme]:
        """Return what was reached, by quantity."""
        return self._reached

    def left(self, out: Output, row: int) -> dict[str, FloatArray]:
        """Return what is left at a row of what was recorded, by quantity."""
        here = self._histories(out, row, row + 1)
        kept = ("link_deformation", "link_work", "hinge_rotation", "hinge_work")
        return {name: here[name][0] for name in kept if name in here}

    def _histories(self, out: Output, first: int, last: int) -> dict[str, FloatArray]:
        # As `part_variables` and frames.results.formulas form them.
        found: dict[str, FloatArray] = {}
        n, state = self._links, out.part_state[first:last]
        if n:
            d = out.deformation[first:last, :n]
            force = out.beyond[first:last, :n] + self._elastic * d
            found["link_ductility"] = np.where(d * force > 0.0, np.abs(d) / self._yields, 0.0)
            found["link_deformation"], found["link_force"] = np.abs(d), np.abs(force)
            found["link_reversal"], found["link_work"] = -force, state[:, :n, WORK_DONE]
        if self._hinges:
            part = np.array([k for k, _ in self._hinges])
            end = np.array([e for _, e in self._hinges])
            turns = [state[:, part, 3 * end + axis] for axis in (1, 2)]
            found["hinge_rotation"] = np.linalg.norm(np.stack(turns, axis=-1), axis=-1)
            found["hinge_turn"] = state[:, part, N_PLASTIC + end]
            found["hinge_work"] = state[:, part, WORK_DONE + end]
        return found
