"""Isolated buildings that yield, on four systems: writes docs/validation/yielding_comparison.md.

    LIR_RECORDS=<folder of records> python -m validation.measurements.yielding_comparison

The demo's building and one of light members, with plastic hinges in columns and beams, stand on
LIR-DCFP bearings, on plain bearings with the same rims, on plain bearings of a larger plan, and on
these in a moat whose walls stand where the rims were. Records are scaled to equal demands.
"""

from __future__ import annotations

import argparse
import json
import os
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from validation.fuzzing.pool import in_children
from validation.measurements.yielding_runs import (
    SYSTEMS,
    factor_for,
    perform,
    records_in,
    structures,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

DEMANDS = (0.9, 1.1, 1.2, 1.35, 1.6)
"""Displacement without rims over the capacity of bearings with rims."""

ELASTIC_AT = 1.2
"""The demand at which the same runs are made with frames that stay elastic."""

LIMIT = 300.0
"""Longest time for a run [s]."""


def tasks(folder: Path, records: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Yield what is run; a record that would need too large a factor is left out."""
    for record in records:
        for demand in DEMANDS:
            factor = factor_for(demand, record, folder)
            if factor is None:
                continue
            for structure in structures():
                for system in SYSTEMS:
                    for elastic in (False, True)[: 2 if demand == ELASTIC_AT else 1]:
                        yield {
                            "record": record, "demand": demand, "factor": factor,
                            "structure": structure, "system": system, "elastic": elastic,
                        }  # fmt: skip


def main(given: Sequence[str] | None = None) -> None:
    """Run the buildings and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.measurements.yielding_comparison")
    parser.add_argument("--keep", type=Path, help="a file for the numbers, JSON by line")
    parser.add_argument("--workers", type=int, default=1, help="child processes")
    parser.add_argument("--records", nargs="*", help="of these names; default all")
    options = parser.parse_args(given)
    folder = Path(os.environ.get("LIR_RECORDS", ""))
    found = []
    run = partial(perform, folder=folder)
    todo = tasks(folder, options.records or list(records_in(folder)))
    for task, result, how in in_children(run, todo, options.workers, LIMIT):
        row = result if not how else task | {"status": how}
        found.append(row)
        if options.keep:
            with options.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
    print(len(found))


if __name__ == "__main__":
    main()
