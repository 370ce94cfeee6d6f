"""Contents of a recording besides its histories, and the message if it kept too little."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Hashable

    import xarray as xr
    from numpy.typing import NDArray

    from frames._types import FloatArray

EVERY_STEP = "every step"
"""Attribute `recording` of a result that holds all base steps and all variables."""

ENDS = "first and last step"
"""Beginning of that attribute if no step between is kept as a rule."""

_OTHERS = {"peak_time", "peak_where", "peak_ground_velocity"}
_RENAMED = {"masses_moved": "mass_shift"}
PEAK = "peak_"
"""Beginning of the names of peaks over all steps: `frames.results.quantities`."""


def is_of_all_steps(name: Hashable) -> bool:
    """Return True if a variable is a peak over all steps."""
    return str(name).startswith(PEAK) and name not in _OTHERS


def with_present_names(data: xr.Dataset) -> xr.Dataset:
    """Return results with the names of now: in version 0.2 peaks began with "reached_"."""
    old = {str(name) for name in data.variables if str(name).startswith("reached_")}
    renamed = {name: PEAK + name.removeprefix("reached_") for name in old}
    return data.rename(renamed | {old: new for old, new in _RENAMED.items() if old in data})


def largest_kept(data: xr.Dataset, name: str) -> tuple[FloatArray, FloatArray] | None:
    """Return the peaks of a quantity in a recording: its largest values and their times [s]."""
    if PEAK + name not in data.variables:
        return None
    return data.variables[PEAK + name].values, data.variables[f"{PEAK}{name}_at"].values


def names_of(data: xr.Dataset, dim: str) -> NDArray[np.str_]:
    """Return the names along a dimension."""
    names: NDArray[np.str_] = data.get_index(dim).to_numpy()
    return names


def noted(data: xr.Dataset) -> dict[str, str]:
    """Return the attribute with the omissions of a history; nothing if it has every step."""
    recording = str(data.attrs.get("recording", EVERY_STEP))
    return {} if recording == EVERY_STEP else {"recording": recording}


def require_recorded(data: xr.Dataset, what: str, *names: str) -> None:
    """Raise a ValueError unless a result has the variables that `what` is made from."""
    missing = [name for name in names if name not in data.variables]
    if missing:
        msg = (
            f"{what}: data has no {', '.join(missing)}; its recording is "
            f'"{data.attrs.get("recording", "not known")}": add it to the channels '
            "(frames.Recording), or pass the Dataset of a time_history"
        )
        raise ValueError(msg)


def require_steps(data: xr.Dataset, what: str) -> None:
    """Raise a ValueError if a result holds nothing between the first and the last step."""
    require_between_ends(str(data.attrs.get("recording", EVERY_STEP)), what)


def require_between_ends(recording: str, what: str) -> None:
    """Raise a ValueError if a recording, in words, has no step between its ends."""
    if recording.startswith(ENDS) and "rim contact" not in recording:
        msg = (
            f"{what}: only the {ENDS} was recorded: run with recording=Recording(every=n), "
            "or record all. Maxima are in peaks(data), and with extremes=True in "
            "envelope(data, variable)"
        )
        raise ValueError(msg)


def require_whole_levels(data: xr.Dataset, what: str) -> None:
    """Raise a ValueError if nodes of a level were not recorded: its mean would be another."""
    if "nodes_of_level" not in data.variables:
        return
    place = data["level_node"].to_numpy()
    there = np.array([int((place == k).sum()) for k in range(data.sizes["level"])])
    lacking = there < data["nodes_of_level"].to_numpy()
    if lacking.any():
        k = int(np.argmax(lacking))
        msg = (
            f"{what}: data holds {there[k]} of the {int(data['nodes_of_level'][k])} nodes of level "
            f'"{data["level"].to_numpy()[k]}": record all nodes, or all levels'
        )
        raise ValueError(msg)


def standing(data: xr.Dataset) -> FloatArray:
    """Return 1 if a bearing carries, 0 if it has failed and its backup carries.

    Shapes: result (time, bearing).
    """
    if "bearing_failed" not in data.variables:
        return np.ones(())
    return 1.0 - data.variables["bearing_failed"].transpose("time", "bearing").to_numpy()
