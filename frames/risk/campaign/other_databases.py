"""Other results databases: their runs are copied; those of version 0.2 are converted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from frames.results.chunks import digest_of
from frames.results.recorded import with_present_names
from frames.risk._errors import CampaignError
from frames.risk.campaign.batches import DIGEST, Batch
from frames.risk.campaign.plan import differences, listed
from frames.risk.campaign.plan_description import FORMAT, OLD
from frames.risk.campaign.store import CampaignStore
from frames.risk.campaign.store_writing import StoreWriter, lacking_packages

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.risk.campaign.batches import CampaignJob


def convert_campaign(old: str | Path, new: str | Path) -> CampaignStore:
    """Convert the results database of a campaign of version 0.2 to the present format.

    Parameters
    ----------
    old : str or path
        Folder of the old database, which stays unchanged.
    new : str or path
        The folder to be made.

    Returns
    -------
    CampaignStore
        The new database, with the same rows and histories. To run the missing ones, `Campaign.run`
        needs `accept_other_sources=True`.

    Raises
    ------
    CampaignError
        If `old` holds no campaign of version 0.2, a batch is not as it was written, or `new` is
        there.
    ImportError
        If zarr is not installed.

    Examples
    --------
    >>> from frames.risk import CampaignError, convert_campaign
    >>> try:
    ...     convert_campaign("nowhere", "anew")
    ... except CampaignError as error:
    ...     print(error)
    nowhere holds no campaign of version 0.2: name the folder of one
    """
    if lacking := lacking_packages("zarr"):
        raise ImportError(lacking)
    folder, store = Path(old), StoreWriter(new)
    try:
        plan = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
        is_old = plan["format"] in OLD
    except (OSError, ValueError, LookupError, TypeError):
        is_old = False
    if not is_old:
        msg = f"{old} holds no campaign of version 0.2: name the folder of one"
        raise CampaignError(msg)
    whole = xr.open_zarr(folder / "runs.zarr", chunks=None, consolidated=False)
    results = whole[whole.attrs["results"]].drop_attrs(deep=False)
    present = with_present_names(results)
    of_run = [name for name in results.coords if "run" in results[name].dims]
    rows = _loaded(results[of_run])
    store.create(plan | {"format": FORMAT}, rows, _loaded(present.isel(run=slice(1))))
    for mark in sorted((folder / "done").glob("*.json")):
        number, told = int(mark.stem), json.loads(mark.read_text(encoding="utf-8"))
        own = slice(number * plan["batch"], (number + 1) * plan["batch"])
        found = _loaded(results.isel(run=own).drop_vars(of_run))
        arrays = {str(name): variable.to_numpy() for name, variable in found.data_vars.items()}
        if digest_of([arrays]) != told["digest"]:
            msg = f"batch {number} of {old} is not as it was written: remove {mark}, convert again"
            raise CampaignError(msg)
        now = with_present_names(found).data_vars.items()
        arrays = {str(name): variable.to_numpy() for name, variable in now}
        parts = sorted((folder / "histories" / mark.stem).glob("*.zarr"))
        histories = [_loaded(xr.open_zarr(part, chunks=None, consolidated=False)) for part in parts]
        store.write(number, Batch(arrays, histories, told["warnings"], told.get("reused", 0)))
    return store


def _loaded(data: xr.Dataset) -> xr.Dataset:
    # With results that are texts of Python, labels of numpy.
    found = data.copy()
    for name, own in data.variables.items():
        if own.dtype.kind not in "fiub":
            kind = str if name in data.coords else object
            found[name] = own.dims, np.array(own.to_numpy().tolist(), dtype=kind), own.attrs
    return found


def rows_by_digest(data: xr.Dataset) -> dict[str, int]:
    """Return a row of each complete run by the digest of its input: `CampaignJob.digest`."""
    digests = data[DIGEST].to_numpy().tolist() if DIGEST in data else []
    return {digest: row for row, digest in enumerate(digests) if digest}


_SAME = "program", "sources", "options", "record", "measures"
_HISTORIES = "what was reached"


def known_runs(
    stores: Sequence[str | Path], work: CampaignJob, planned: Mapping[str, Any]
) -> dict[str, tuple[xr.Dataset, int]]:
    """Return runs of other results databases by the digest of their input: `CampaignJob.digest`."""
    found: dict[str, tuple[xr.Dataset, int]] = {}
    for path in stores:
        store = CampaignStore(path)
        stored, data = store.plan(), store.results()
        unlike = differences(*({key: plan.get(key) for key in _SAME} for plan in (stored, planned)))
        if unlike:
            msg = (
                f"reuse = {path}: its runs were computed otherwise: leave it out, or give this "
                f"campaign the same plan\n{listed(unlike)}"
            )
            raise CampaignError(msg)
        if planned["record"] != _HISTORIES:
            msg = f"reuse = {path}: histories cannot be reused: leave out record or reuse"
            raise CampaignError(msg)
        own = {digest: (data, row) for digest, row in rows_by_digest(data).items()}
        if not any(digest in own for digest in work.digests(range(work.plan.runs))):
            msg = (
                f"reuse = {path}: no run is the same (its models: {', '.join(stored['models'])}): "
                "use its names of models, structures, parameters, motions and scales"
            )
            raise CampaignError(msg)
        found = own | found
    return found
