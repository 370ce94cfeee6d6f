"""Largest and smallest forces of a run in members, storeys and bearings, with what acts at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.results.recorded import REACHED
from lir_element.results.dataset import labelled

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.bundles.run_data import Output
    from frames.recording.force_rows import ForceKind, ForceMaps
    from lir_element.layout import Records

WAYS = ("largest", "smallest")
"""Of each force, along the dimension `extreme`."""

_AT_ONCE = 64  # steps, whose forces are found in the processor's own memory

_PLACES = {"member": "component", "storey": "storey_component", "reaction": "reaction"}
"""Dimension of the six forces of each kind."""


class ForceTracker:
    """Keeps the extremes of forces, each with the five others at its instant.

    Parameters
    ----------
    maps : ForceMaps
        How forces follow from what is recorded.
    """

    def __init__(self, maps: ForceMaps) -> None:
        self._maps = maps
        sections = sum(int(np.prod(kind.shape)) for kind in maps.kinds)
        self._most = np.full((sections, 6, 2), -np.inf)  # of the smallest: their opposite
        self._values = np.full((sections, 6, 2, 6), np.nan)
        self._times = np.full((sections, 6, 2), np.nan)
        self._at_rest = np.full((sections, 6), np.nan)
        self._taken = 0

    def take(self, states: Records, out: Output, first: int, count: int) -> None:
        """Take up what is new among the first `count` recorded steps, `first` being the first."""
        for begin in range(self._taken - first, count, _AT_ONCE):
            rows = slice(begin, min(begin + _AT_ONCE, count))
            values = self._maps.of(out, states, rows)
            if self._taken == 0:
                self._at_rest = values[:, :, 0].copy()
            self._raise(values, out.time[rows])
            self._taken = first + rows.stop

    def variables(self) -> tuple[dict[str, xr.Variable], dict[str, list[str]]]:
        """Return what was reached as variables (docs/results.md), and their coordinates."""
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
        six, name = _PLACES[kind.name], f"{REACHED}{kind.name}_force"
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
