"""Run the whole study, part after part: `python -m validation.study --store study-runs`.

    python -m validation.study [part ...] [--store FOLDER] [--workers N or tcp://host:port] [--again]

Each part keeps its runs in a folder of its own within the store, goes on with what is there, and
writes its page; `python -m validation.study.<part>` runs one alone.
"""

from __future__ import annotations

import argparse
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

PARTS = (
    "records",
    "rims",
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
    options = parser.parse_args(given)
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {unknown[0]!r}: one of {', '.join(PARTS)}")
    for part in options.parts or PARTS:
        own = ["--workers", options.workers]
        own += ["--store", str(options.store / part)] if options.store else []
        own += ["--again"] if options.again else []
        import_module(f"validation.study.{part}").main(own)


if __name__ == "__main__":
    main()
