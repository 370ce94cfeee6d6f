"""Batches of a campaign as tasks of Dask: workers compute, the owner of the store alone writes."""

from __future__ import annotations

import threading
import warnings
from typing import TYPE_CHECKING, Any

from frames._errors import CampaignError
from frames.campaign.batches import Batch, Work, compute

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import xarray as xr

_AHEAD = 2  # batches at a worker: one computed, one waiting

_ONE_AT_A_TIME = threading.Lock()  # a worker computes a batch with all of its threads


def over_cluster(
    client: Any, work: Work, layout: xr.Dataset, batches: Sequence[int], workers: int | None
) -> Iterator[tuple[int, Batch]]:
    """Compute batches on a Dask cluster, in whichever order they are done.

    Parameters
    ----------
    client : distributed.Client
        Of the cluster.
    work : Work
        The campaign's.
    layout : xarray.Dataset
        Of the store.
    batches : sequence of int
        Which.
    workers : int or None
        Runs at a time in each worker; None: its number of threads.

    Yields
    ------
    tuple of int and Batch
        Number of a batch and what it gave.

    Raises
    ------
    CampaignError
        If a batch ended its workers again and again, or the connection is lost.
    """
    from distributed import as_completed
    from distributed.protocol.pickle import dumps

    payload = dumps((work, layout))
    with warnings.catch_warnings():  # sent once: a task, so that it outlives the worker it is at
        warnings.filterwarnings("ignore", message="Sending large graph")
        shared = client.submit(_unpacked, payload, pure=False)
    todo, running = iter(batches), as_completed()
    numbers: dict[Any, int] = {}
    try:
        while True:
            for number in _next(todo, _AHEAD * max(len(client.ncores()), 1) - len(numbers)):
                future = client.submit(_computed, shared, number, workers, pure=False)
                numbers[future] = number
                running.add(future)
            if not numbers:
                return
            future = next(running)
            number = numbers.pop(future)
            yield number, _result(future, number)
    finally:
        if client.status == "running":
            client.cancel([shared, *numbers])


def _next(todo: Iterator[int], count: int) -> list[int]:
    return [number for _, number in zip(range(count), todo, strict=False)]


def _result(future: Any, number: int) -> Batch:
    from distributed import KilledWorker

    if future.status in {"cancelled", "lost"}:
        msg = (
            f"batch {number} was cancelled, or the connection to Dask's scheduler is lost: the "
            "batches before are kept, run again to go on"
        )
        raise CampaignError(msg)
    try:
        batch: Batch = future.result()
    except KilledWorker as cause:
        msg = (
            f"batch {number} ended its workers again and again ({cause}): give them more memory, "
            "or take smaller batches in another store; the batches before are kept"
        )
        raise CampaignError(msg) from cause
    return batch


def _unpacked(payload: bytes) -> tuple[Work, xr.Dataset]:
    from distributed.protocol.pickle import loads

    found: tuple[Work, xr.Dataset] = loads(payload)
    return found


def _computed(shared: tuple[Work, xr.Dataset], number: int, workers: int | None) -> Batch:
    from distributed import get_worker

    work, layout = shared
    with _ONE_AT_A_TIME:
        return compute(work, layout, number, workers or get_worker().state.nthreads)
