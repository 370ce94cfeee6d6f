"""The records of FEMA P695 on four devices under a building that yields: writes the study's page.

    python -m validation.study.records --store study-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import resource
import tempfile
import warnings
from contextlib import contextmanager
from math import isfinite
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

from frames import ModelWarning, time_histories
from frames.design.hazard.fema_records import RECORD_SETS
from frames.risk import open_campaign
from lir_element.errors import AnalysisWarning
from validation.measurements.benchmark import processor
from validation.measurements.yielding_runs import LIR, RIMS, WIDE
from validation.page import DPI, FOLDER
from validation.study.records_figures import figures
from validation.study.records_page import page
from validation.study.records_runs import (
    DEMANDS,
    SCALES,
    STEP,
    campaign,
    devices,
    ductilities,
    found_of,
    record_sets,
)

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping, Sequence

    from frames import GroundMotion
    from frames.risk import Campaign

    Sets = Mapping[str, Mapping[str, GroundMotion]]

FAR, PULSE, PLAIN = RECORD_SETS
HALVED = (
    (LIR, FAR, 0, 1.6),
    (RIMS, FAR, 5, 2.2),
    (RIMS, PULSE, 8, 1.9),
    (WIDE, PULSE, 0, 2.6),
    (LIR, PLAIN, 8, 1.6),
)
"""Runs at half the step: device, set, motion by number, intensity [m/s2]."""


@contextmanager
def _quietly() -> Generator[None, None, None]:
    # What is doubtful of a run or a model is in the tables.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", ModelWarning)
        yield


def halved(sets: Sets) -> list[dict[str, Any]]:
    """Return demands of some runs at the step of the campaign, and at half of it."""
    models = devices()
    rows = []
    for device, kind, number, scale in HALVED:
        name, motion = list(sets[kind].items())[number]
        numbers = []
        for dt in (STEP, 0.5 * STEP):
            with _quietly():
                data = time_histories(
                    {device: models[device]}, {name: motion}, scales=[scale], dt=dt
                )
            peaks = data["peak"].isel(run=0).to_series().to_dict()
            peaks["ductility"] = float(ductilities(data)[0])
            status = str(data["status"].item())
            numbers.append(
                {"status": status}
                | {key: float(peaks[key]) if isfinite(peaks[key]) else None for key in DEMANDS}
            )
        rows.append({"device": device, "motion": name, "im": scale, "runs": numbers})
    return rows


def performed(runs: Campaign, workers: int | str) -> dict[str, Any]:
    """Run what is not done, and return what it cost, with the results database's digest.

    Parameters
    ----------
    runs : Campaign
        The campaign.
    workers : int or str
        Runs at a time, here; or the address of a Dask scheduler, whose workers' processor time is
        not counted.

    Returns
    -------
    dict
        Runs, seconds, memory [MB], digest, date and machine.
    """
    before = runs.store.status().done if runs.store.exists else 0
    clock, cpu = perf_counter(), process_time()
    with _quietly():
        workers = _run(runs, workers)
    status = runs.status()
    return {
        "runs": status.done,
        "computed": status.done - before,
        "workers": workers,
        "clock": perf_counter() - clock,
        "cpu": process_time() - cpu,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        "digest": runs.digest(),
        "date": f"{datetime.date.today():%Y-%m-%d}",
        "machine": f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}",
    }


def _run(runs: Campaign, workers: int | str) -> int:
    # Returns how many workers it had.
    if isinstance(workers, int):
        runs.run(workers=workers, progress=True)
        return workers
    from distributed import Client

    with Client(workers) as client:
        runs.run(client=client, progress=True)
        return len(client.ncores())


def workers_of(text: str) -> int | str:
    """Return a number of workers, or the address of a Dask scheduler, of an option."""
    return int(text) if text.isdecimal() else text


def write(found: Mapping[str, Any], folder: Path = FOLDER) -> None:
    """Write the page, its figures and the numbers."""
    for name, figure in figures(found).items():
        figure.savefig(folder / "figures" / name, dpi=DPI, metadata={"Software": None})
    (folder / "study.md").write_text(page(found), encoding="utf-8")
    (folder / "study.json").write_text(json.dumps(found) + "\n", encoding="utf-8")
    print(f"written to {folder}")


def study(sets: Sets, store: Path, workers: int | str, scales: Sequence[float]) -> dict[str, Any]:
    """Run the campaign, and return what the page says of it."""
    motions = {name: motion for each in sets.values() for name, motion in each.items()}
    runs = campaign(motions, store, scales)
    cost = performed(runs, workers)
    return found_of(runs.results(), sets) | {"cost": cost}


def options_of(name: str, given: Sequence[str] | None) -> argparse.Namespace:
    """Return the options of a study's command: store, workers, again."""
    parser = argparse.ArgumentParser(prog=f"python -m validation.study.{name}")
    parser.add_argument("--store", type=Path, help="a folder for the runs, kept")
    parser.add_argument(
        "--workers",
        type=workers_of,
        default=1,
        help="runs at a time, or the address of a Dask scheduler",
    )
    parser.add_argument(
        "--again", action="store_true", help="run nothing: write the page from its JSON"
    )
    return parser.parse_args(given)


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaign, and write the page."""
    options = options_of("records", given)
    if options.again:
        found = json.loads((FOLDER / "study.json").read_text(encoding="utf-8"))
        if options.store:  # fitted anew; cost and halved steps are those of the run
            found |= found_of(open_campaign(options.store).results(), record_sets())
        write(found)
        return
    with tempfile.TemporaryDirectory() as folder:
        sets = record_sets()
        found = study(sets, options.store or Path(folder, "runs"), options.workers, SCALES)
        write(found | {"halved": halved(sets)})


if __name__ == "__main__":
    main()
