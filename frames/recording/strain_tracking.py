"""How far strains of imported members went beyond those up to which they keep their stiffness."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.recording.force_rows import element_sections

if TYPE_CHECKING:
    from frames.bundles.run_data import Output
    from frames.model.frame_data import FrameData
    from frames.statics.gravity import GravityState

_AT_ONCE = 256  # steps, whose forces are found at once
_PICKED = (0, 4, 5)  # N, My, Mz


class StrainGauge:
    """Keeps the largest strains over their limits; of a structure without such members, nothing.

    Parameters
    ----------
    model : Frame
        The structure.
    state : GravityState
        Its equilibrium.
    """

    def __init__(self, model: FrameData, state: GravityState) -> None:
        known = {k: v for p in model.superelements.values() for k, v in p.elements.strains.items()}
        names = state.system.elements.names
        kept = [k for k, name in enumerate(names) if name in known]
        self.names = [names[k] for k in kept]
        self.reset()
        if not kept:
            return
        over_q, rest = element_sections(state.system, kept)
        basis = state.basis
        whole = np.hstack([basis.expand_b, basis.expand_e])
        if state.parts is not None:
            whole = np.hstack([whole, -state.part_shift])
        places = (
            18 * np.arange(len(kept))[:, None, None] + [[0], [12]] + np.array(_PICKED)
        ).ravel()
        self._rows = np.asarray(over_q[places] @ whole)
        self._rest = np.asarray(over_q[places] @ basis.offset) + rest[places]
        most = max(len(rows) for name in self.names for rows in known[name])
        self._strains = np.zeros((len(kept), 2, most, 3))
        for k, name in enumerate(self.names):
            for end, rows in enumerate(known[name]):
                self._strains[k, end, : len(rows)] = rows

    def reset(self) -> None:
        """Forget what was taken up."""
        self._most = np.zeros(len(self.names))
        self._time = np.full(len(self.names), np.nan)

    def take(self, out: Output, first: int, last: int) -> None:
        """Take up rows first <= k < last of what was recorded."""
        for begin in range(first, last if self.names else first, _AT_ONCE):
            rows = slice(begin, min(begin + _AT_ONCE, last))
            x = np.hstack([out.b[rows], out.e[rows], out.beyond[rows]])
            forces = self._rows[:, : x.shape[1]] @ x.T + self._rest[:, None]
            forces = forces.reshape(len(self.names), 2, 3, -1)
            now = np.abs(self._strains @ forces).max(axis=(1, 2))
            at = now.argmax(axis=1)
            largest = now[np.arange(len(at)), at]
            more = largest > self._most
            self._most[more], self._time[more] = largest[more], out.time[rows][at[more]]

    def attrs(self) -> dict[str, object]:
        """Return attributes of the result: the largest, where, when, and how many are beyond 1."""
        if not self.names:
            return {}
        k = int(self._most.argmax())
        return {
            "strain_over_limit": float(self._most[k]),
            "strain_over_limit_in": self.names[k],
            "strain_over_limit_at": float(self._time[k]),
            "strain_over_limit_count": int((self._most > 1.0).sum()),
        }
