"""Runs that other results databases hold already, taken over in place of being computed again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.risk._errors import CampaignError
from frames.risk.campaign.batches import DIGEST
from frames.risk.campaign.plan import differences, listed
from frames.risk.campaign.store import CampaignStore

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames.risk.campaign.batches import CampaignJob

_SAME = "program", "sources", "options", "record", "measures"
_HISTORIES = "what was reached"


def known_runs(
    stores: Sequence[str | Path], work: CampaignJob, planned: Mapping[str, Any]
) -> dict[str, tuple[xr.Dataset, int]]:
    """Return runs of other results databases by what they are of: `CampaignJob.digest`."""
    found: dict[str, tuple[xr.Dataset, int]] = {}
    for path in stores:
        store = CampaignStore(path)
        stored, data = store.plan(), store.results()
        unlike = differences(*({key: plan.get(key) for key in _SAME} for plan in (stored, planned)))
        if unlike:
            msg = (
                f"reuse = {path}: its runs were computed otherwise: leave it out, or plan this "
                f"campaign alike\n{listed(unlike)}"
            )
            raise CampaignError(msg)
        if planned["record"] != _HISTORIES:
            msg = f"reuse = {path}: histories are not taken over: leave out record or reuse"
            raise CampaignError(msg)
        digests = data[DIGEST].to_numpy().tolist() if DIGEST in data else []
        own = {digest: (data, row) for row, digest in enumerate(digests) if digest}
        if not any(digest in own for digest in work.digests(range(work.plan.runs))):
            msg = (
                f"reuse = {path}: no run is the same (its models: {', '.join(stored['models'])}): "
                "name of the model, structure with its parameters, motion and scale have to be "
                "those of a run of this campaign"
            )
            raise CampaignError(msg)
        found = own | found
    return found
