"""Batches of a campaign as tasks of Dask: workers compute, the database's owner alone writes."""

from __future__ import annotations

import threading
import warnings
from collections import Counter
from typing import TYPE_CHECKING, Any

from frames.batch.processes import Crew
from frames.risk._errors import CampaignError
from frames.risk.campaign.batches import Batch, CampaignJob, compute

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import xarray as xr

_AHEAD = 2  # batches at a worker: one computed, one waiting

_LOSSES = 3  # of a batch's result, before it was fetched
_GONE = {"cancelled", "lost"}

_LOST = "the connection to Dask's scheduler is lost: run again to resume from the batches done"

_ONE_AT_A_TIME = threading.Lock()  # a worker computes a batch with all of its threads


def over_cluster(
    client: Any, work: CampaignJob, layout: xr.Dataset, batches: Sequence[int], workers: int | None
) -> Iterator[tuple[int, Batch]]:
    """Compute batches on a Dask cluster, in any order."""
    from distributed import as_completed
    from distributed.protocol.pickle import dumps

    payload = dumps((work, layout))
    shared = _shared(client, payload)
    todo, running = list(reversed(batches)), as_completed()
    numbers: dict[Any, int] = {}
    lost: Counter[int] = Counter()
    try:
        while todo or numbers:
            for _ in range(min(_AHEAD * _width(client) - len(numbers), len(todo))):
                number = todo.pop()
                future = client.submit(_computed, shared, number, workers, pure=False)
                numbers[future] = number
                running.add(future)
            future = next(running)
            number = numbers.pop(future)
            batch = _result(future, number)
            if batch is not None:
                yield number, batch
                continue
            lost[number] += 1
            if lost[number] > _LOSSES or client.status != "running":
                msg = f"batch {number} was cancelled, or {_LOST}"
                raise CampaignError(msg)
            todo.append(number)
            if shared.status in _GONE:
                shared = _shared(client, payload)
    finally:
        if client.status == "running":
            client.cancel([shared, *numbers])


def _shared(client: Any, payload: bytes) -> Any:
    # Common input of all batches, as the result of a task: scattered data die with their worker.
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Sending large graph")
        return client.submit(_unpacked, payload, pure=False)


def _width(client: Any) -> int:
    # Workers that there are now: some may come, some go.
    if client.status != "running":
        raise CampaignError(_LOST)
    try:
        return max(len(client.ncores()), 1)
    except OSError as cause:
        raise CampaignError(_LOST) from cause


def _result(future: Any, number: int) -> Batch | None:
    # Results of a batch; None if it was lost with its worker before it was fetched.
    from distributed import CancelledError, KilledWorker

    if future.status in _GONE:
        return None
    try:
        batch: Batch = future.result()
    except CancelledError:
        return None
    except KilledWorker as cause:
        msg = (
            f"batch {number} ended its workers repeatedly ({cause}): give them more memory, or use "
            "smaller batches in another folder"
        )
        raise CampaignError(msg) from cause
    return batch


def _unpacked(payload: bytes) -> tuple[CampaignJob, xr.Dataset]:
    from distributed.protocol.pickle import loads

    found: tuple[CampaignJob, xr.Dataset] = loads(payload)
    return found


def _computed(shared: tuple[CampaignJob, xr.Dataset], number: int, workers: int | None) -> Batch:
    from distributed import get_worker

    work, layout = shared
    crew = Crew(workers or get_worker().state.nthreads, 0)  # no processes: the cluster has them
    with _ONE_AT_A_TIME:
        return compute(work, layout, number, crew)
