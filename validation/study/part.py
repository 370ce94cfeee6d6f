"""What all parts of the study share: running a campaign without warnings, and its cost."""

from __future__ import annotations

import datetime
import os
import platform
import warnings
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING, Any

from frames import ModelWarning, MotionWarning
from lir_element import DesignWarning
from lir_element.errors import AnalysisWarning
from validation.measurements.benchmark import processor

if TYPE_CHECKING:
    from collections.abc import Generator

    from frames.risk import Campaign


@contextmanager
def quietly() -> Generator[None, None, None]:
    """Leave out warnings: what is doubtful of a run or a model is in the tables."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", ModelWarning)
        warnings.simplefilter("ignore", MotionWarning)
        warnings.simplefilter("ignore", DesignWarning)
        yield


def performed(runs: Campaign, workers: int | str) -> dict[str, Any]:
    """Run what is not done, and return what it cost."""
    before = runs.store.status().done if runs.store.exists else 0
    clock = perf_counter()
    with quietly(), client_of(workers) as (own, client):
        runs.run(workers=own, client=client, progress=True)
    done, clock = runs.status().done, perf_counter() - clock
    return {"runs": done, "computed": done - before, "clock": clock, **made_on()}


def made_on() -> dict[str, str]:
    """Return the date, and the machine with its Python."""
    return {
        "date": f"{datetime.date.today():%Y-%m-%d}",
        "machine": f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}",
    }


@contextmanager
def client_of(workers: int | str) -> Generator[tuple[int | None, Any], None, None]:
    """Give the number of workers here, or the client of a Dask scheduler by its address."""
    if isinstance(workers, int):
        yield workers, None
        return
    from distributed import Client

    with Client(workers) as client:
        yield None, client


def workers_of(text: str) -> int | str:
    """Return a number of workers, or the address of a Dask scheduler, of an option."""
    return int(text) if text.isdecimal() else text
