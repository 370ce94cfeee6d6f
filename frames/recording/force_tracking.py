"""Extremes of forces in members, storeys and bearings, with simultaneous ones; and of strains."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.recording.force_rows import element_sections
from frames.results.recorded import PEAK
from lir_element.results.dataset import labelled

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.bundles.run_data import Output
    from frames.model.frame_data import FrameData
    from frames.recording.force_rows import ForceKind, ForceMaps
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records

WAYS = ("largest", "smallest")
"""Extremes of each force, along the dimension `extreme`."""

_AT_ONCE = 64  # steps, whose forces are found in the processor's own memory

_PLACES = {"member": "component", "storey": "storey_component", "reaction": "reaction"}
"""Dimension of the six forces of each kind."""


class ForceTracker:
    """Keeps the extremes of forces, each with the five others at its instant."""

    def __init__(self, maps: ForceMaps) -> None:
        self._maps = maps
        sections = sum(int(np.prod(kind.shape)) for kind in maps.kinds)
        self._most = np.full((sections, 6, 2), -np.inf)  # of the smallest: their opposite
        self._values = np.full((sections, 6, 2, 6), np.nan)
        self._times = np.full((sections, 6, 2), np.nan)
        self._at_rest = np.full((sections, 6), np.nan)
        self._taken = 0

    def take(self, states: Records, out: Output, first: int, count: int) -> None:
        """Add the new ones of the first `count` recorded steps, `first` being the first."""
        for begin in range(self._taken - first, count, _AT_ONCE):
            rows = slice(begin, min(begin + _AT_ONCE, count))
            values = self._maps.of(out, states, rows)
            if self._taken == 0:
                self._at_rest = values[:, :, 0].copy()
            self._raise(values, out.time[rows])
            self._taken = first + rows.stop

    def variables(self) -> tuple[dict[str, xr.Variable], dict[str, list[str]]]:
        """Return the peaks as variables (docs/recording.md), and their coordinates."""
        variables: dict[str, xr.Variable] = {}
        coordinates: dict[str, list[str]] = {}
        first = 0
        for kind in self._maps.kinds:
            rows = slice(first, first + int(np.prod(kind.shape)))
            first = rows.stop
            if rows.start < rows.stop:
                variables |= self._of(kind, rows)
                six = _PLACES[kind.name]
                coordinates |= {
                    **{dim: list(names) for dim, names in zip(kind.dims, kind.labels, strict=True)},
                    six: list(kind.components),
                    f"{six}_at_once": list(kind.components),
                    "extreme": list(WAYS),
                }
        return variables, coordinates

    def _of(self, kind: ForceKind, rows: slice) -> dict[str, xr.Variable]:
        six, name = _PLACES[kind.name], f"{PEAK}{kind.name}_force"
        dims, shape = (*kind.dims, six), (*kind.shape, 6)

        def variable(values: FloatArray, more: tuple[str, ...], unit: str, text: str) -> Any:
            sizes = values.shape[2:]
            return labelled((*dims, *more), values[rows].reshape(*shape, *sizes), unit, text)

        with_it = ("extreme", f"{six}_at_once")
        words = f"extremes of: {kind.meaning}"
        return {
            name: variable(self._values, with_it, "N, N m", f"{words}; all six at that instant"),
            f"{name}_at": variable(self._times, ("extreme",), "s", f"times of {words}"),
            f"{name}_at_rest": variable(
                self._at_rest, (), "N, N m", f"under permanent loads: {kind.meaning}"
            ),
        }

    def _raise(self, values: FloatArray, time: FloatArray) -> None:
        # Keeps values beyond those before, or the first that is not a number.
        for way, pick in enumerate((np.argmax, np.argmin)):
            at = pick(values, axis=2)
            found = np.take_along_axis(values, at[:, :, None], axis=2)[:, :, 0]
            found = found if way == 0 else -found
            old = self._most[:, :, way]
            section, force = np.nonzero((found > old) | (np.isnan(found) & ~np.isnan(old)))
            step = at[section, force]
            self._most[section, force, way] = found[section, force]
            self._values[section, force, way] = values[section, :, step]
            self._times[section, force, way] = time[step]


_STRAINS_AT_ONCE = 256  # steps, whose forces are found at once
_PICKED = (0, 4, 5)  # N, My, Mz


class StrainGauge:
    """Largest strains over their limits; empty for a structure without members that may yield."""

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
        """Clear the recorded strains."""
        self._most = np.zeros(len(self.names))
        self._time = np.full(len(self.names), np.nan)

    def take(self, out: Output, first: int, last: int) -> None:
        """Add rows first <= k < last of the recorded steps."""
        for begin in range(first, last if self.names else first, _STRAINS_AT_ONCE):
            rows = slice(begin, min(begin + _STRAINS_AT_ONCE, last))
            x = np.hstack([out.b[rows], out.e[rows], out.beyond[rows]])
            forces = self._rows[:, : x.shape[1]] @ x.T + self._rest[:, None]
            forces = forces.reshape(len(self.names), 2, 3, -1)
            now = np.abs(self._strains @ forces).max(axis=(1, 2))
            at = now.argmax(axis=1)
            largest = now[np.arange(len(at)), at]
            more = largest > self._most
            self._most[more], self._time[more] = largest[more], out.time[rows][at[more]]

    def attrs(self) -> dict[str, object]:
        """Return attributes of the result: the largest, its place and time, and the number > 1."""
        if not self.names:
            return {}
        k = int(self._most.argmax())
        return {
            "strain_over_limit": float(self._most[k]),
            "strain_over_limit_in": self.names[k],
            "strain_over_limit_at": float(self._time[k]),
            "strain_over_limit_count": int((self._most > 1.0).sum()),
        }
