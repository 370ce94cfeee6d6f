"""Run the whole study, part after part: `python -m validation.study --store study-runs`.

    python -m validation.study [part ...] [--store FOLDER] [--workers N or tcp://host:port] [--again]
                               [--trial N] [--to FOLDER] [--archive FOLDER]

Each part keeps its runs in a folder of its own within the store, goes on with what is there, and
writes its page. `--archive FOLDER` runs nothing, and writes the results of each part in the store as
one archive, for others. `--trial 2` runs two records of each set at two intensities, `--to FOLDER` writes
pages there.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from frames.risk import archive_campaign
from validation.page import FOLDER
from validation.study import summary
from validation.study.part import workers_of
from validation.study.runner import Work, files_of, name_of, run, write

if TYPE_CHECKING:
    from collections.abc import Sequence

PARTS = (
    "near_fault",
    "records",
    "device",
    "buildings",
    "motions",
    "after",
    "loss",
    "uncertainty",
    "summary",
)
"""Modules of this folder, in the order in which one needs what another found."""


def main(given: Sequence[str] | None = None) -> None:
    """Run the parts that are named, or all."""
    parser = argparse.ArgumentParser(prog="python -m validation.study")
    parser.add_argument("parts", nargs="*", metavar="part", help=f"of: {', '.join(PARTS)}")
    parser.add_argument("--store", type=Path, help="a folder for the runs, kept")
    parser.add_argument(
        "--workers", default="1", help="runs at a time, or the address of a Dask scheduler"
    )
    parser.add_argument(
        "--again", action="store_true", help="run nothing: write the pages from their JSON"
    )
    parser.add_argument("--trial", type=int, help="so many records and intensities of each set")
    parser.add_argument("--to", type=Path, default=FOLDER, help="folder for the pages")
    parser.add_argument("--archive", type=Path, help="folder for archives of the results")
    options = parser.parse_args(given)
    if options.archive is not None and options.store is None:
        parser.error("--archive FOLDER packs what is in --store FOLDER: name it, too")
    if options.trial is not None and options.to == FOLDER:
        parser.error("--trial N is no result: --to FOLDER says where its pages go")
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {unknown[0]!r}: one of {', '.join(PARTS)}")
    if options.archive is not None:
        for part in options.parts or PARTS:
            archived(part, options.store / part, options.archive)
        return
    for part in options.parts or PARTS:
        if files_of(part):
            _perform(part, options)
        else:
            summary.main(["--again"] * options.again)


def archived(part: str, store: Path, to: Path) -> None:
    """Write the campaigns of a part as one archive, if it has any."""
    found = sorted(path.parent for path in store.rglob("plan.json"))
    if not found:
        print(f"{part}: no campaign in {store}")
        return
    named = {"" if each == store else each.relative_to(store).as_posix(): each for each in found}
    command = f"python -m validation.study {part}"
    print(archive_campaign(named, to / f"{name_of(part)}.zip", command=command))


def _perform(part: str, options: argparse.Namespace) -> None:
    if options.again:
        write(part, options.to)
        return
    with tempfile.TemporaryDirectory() as folder:
        store, workers = options.store or Path(folder), workers_of(options.workers)
        run(part, Work(store, options.to, workers, options.trial))


if __name__ == "__main__":
    main()
