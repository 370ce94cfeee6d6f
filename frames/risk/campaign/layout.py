"""Arrays of a campaign's results database: their layout, and a digest of what they hold."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.risk._errors import CampaignError
from frames.risk.fragility.runs import outcome_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import xarray as xr

    from frames.risk.campaign.plan import Plan

_ROWS = {"run", "model", "motion", "scale", "parameter_set"}
"""Coordinates of a row, besides its parameters."""

_FLAT: Any = {"name": "default", "separator": "."}
"""Chunks of an array are files beside one another: no folder for each batch."""

EVERY_CHUNK: Any = {"write_empty_chunks": True}
"""Chunks of nothing but NaN, 0 or "" are files, too: one that is missing was removed."""

_TIMINGS = {"seconds_loop"}
"""What no run has twice."""


def digest_of(batches: Iterable[Mapping[str, Any]]) -> str:
    """Return a digest of arrays (runs, ...) by name, however the runs are parted into batches."""
    found: dict[str, Any] = {}
    for arrays in batches:
        for name in arrays.keys() - _TIMINGS:
            found.setdefault(name, hashlib.sha256()).update(_bytes(np.asarray(arrays[name])))
    whole = "".join(f"{name} {found[name].hexdigest()}\n" for name in sorted(found))
    return hashlib.sha256(whole.encode()).hexdigest()


def _bytes(values: Any) -> bytes:
    if values.dtype.kind == "f":
        return np.where(np.isnan(values), np.nan, values).astype("<f8").tobytes()  # one NaN
    return "".join(f"{text}\0" for text in values.ravel().tolist()).encode()


def lay_out(where: Path, plan: Plan, layout: xr.Dataset) -> None:
    """Make empty arrays for the results of all runs, a chunk a batch; labels and plan are there."""
    import zarr

    labels = {str(name): layout[name] for name in layout.coords if "run" not in layout[name].dims}
    planned = _planned(plan)
    names = () if plan.sample is None else plan.sample.names
    taken = {*names} & {*map(str, layout.variables), *_ROWS, "done", "motion_digest", OUTCOME}
    if taken:
        msg = f'the parameter "{min(taken)}" has the name of a result or column: give it another'
        raise CampaignError(msg)
    group = zarr.create_group(where)
    group.attrs["results"] = [str(name) for name in layout.data_vars]
    group.attrs["coordinates"] = " ".join(sorted({*labels, *planned} - {*map(str, layout.dims)}))
    for name in layout.data_vars:
        variable, is_text = layout[name], layout[name].dtype.kind != "f"
        group.create_array(
            str(name),
            shape=(plan.runs, *variable.shape[1:]),
            chunks=(plan.batch, *(max(size, 1) for size in variable.shape[1:])),
            dtype="string" if is_text else "float64",
            fill_value="" if is_text else np.nan,
            chunk_key_encoding=_FLAT,
            dimension_names=tuple(map(str, variable.dims)),
            attributes=dict(variable.attrs),
            config=EVERY_CHUNK,
        )
    for name, values in planned.items():
        _fill(group, name, ("run",), values, {})
    for name, variable in labels.items():
        _fill(group, name, tuple(map(str, variable.dims)), variable.to_numpy(), variable.attrs)


def _planned(plan: Plan) -> dict[str, Any]:
    # Coordinates of all rows.
    model, chosen, motion, scale = plan.places()
    found: dict[str, Any] = {
        "run": np.arange(plan.runs),
        "model": np.array(plan.models, dtype=object)[model],
        "motion": np.array(plan.motions, dtype=object)[motion],
        "scale": np.array(plan.scales)[scale],
    }
    if plan.sample is not None:
        found["parameter_set"] = chosen
        found |= {n: plan.sample.values[chosen, k] for k, n in enumerate(plan.sample.names)}
    return found


def _fill(group: Any, name: str, dims: tuple[str, ...], values: Any, attrs: Any) -> None:
    is_text = values.dtype.kind not in "fiu"
    array = group.create_array(
        name,
        shape=values.shape,
        chunks=tuple(max(size, 1) for size in values.shape),
        dtype="string" if is_text else values.dtype,
        fill_value="" if is_text else 0,
        chunk_key_encoding=_FLAT,
        dimension_names=dims,
        attributes=dict(attrs),
        config=EVERY_CHUNK,
    )
    array[...] = values.astype(object) if is_text else values


ROWS = ("model", "parameter_set", "motion", "scale")
"""Columns that tell the run, before its parameters."""

OUTCOME = "outcome"
ENDS = ("status", "message", "doubts", "seconds_loop")
"""Columns that tell how a run ended; `OUTCOME` stands before them."""


def run_table(data: xr.Dataset, parameters: Sequence[str]) -> pd.DataFrame:
    """Return the runs that are done as a table."""
    done = np.flatnonzero(data["done"].to_numpy())
    own = data.isel(run=done)
    names = [name for name in (*ROWS, *parameters) if name in own.coords]
    columns: dict[str, Any] = {name: own[name].to_numpy() for name in names}
    columns[OUTCOME] = [outcome_of(str(status)) for status in own["status"].to_numpy()]
    columns |= {name: own[name].to_numpy() for name in ENDS}
    quantities = [str(name) for name in own["quantity"].to_numpy()]
    columns |= dict(zip(quantities, own["peak"].to_numpy().T, strict=True))
    table = pd.DataFrame(columns, index=pd.Index(own["run"].to_numpy(), name="run"))
    units = {"scale": "1", "seconds_loop": "s"}
    units |= dict(zip(quantities, map(str, own["unit"].to_numpy()), strict=True))
    table.attrs = {"units": units} | {str(name): text for name, text in data.attrs.items()}
    return table
