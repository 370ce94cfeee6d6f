"""Isolated buildings that yield, on four systems: writes docs/validation/yielding_comparison.md.

    LIR_RECORDS=<folder of records> python -m validation.measurements.yielding_comparison

The demo's building and one of light members, with plastic hinges in columns and beams, stand on
LIR-DCFP bearings, on plain bearings with the same rims, on plain bearings of a larger diameter, and on
these in a moat whose walls stand where the rims were. Records are scaled to equal demands.
"""

from __future__ import annotations

import os
from functools import partial
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from validation.fuzzing.pool import series, series_parser
from validation.measurements.yielding_page import FIGURE, figure, page
from validation.measurements.yielding_runs import (
    AT2,
    SYSTEMS,
    VARIANTS,
    factor_for,
    perform,
    records_in,
    structures,
)
from validation.page import DPI, FOLDER

if TYPE_CHECKING:
    from collections.abc import Sequence

DEMANDS = (0.9, 1.1, 1.2, 1.35, 1.6)
"""Displacement without rims over the capacity of bearings with rims."""

ELASTIC_AT = 1.2
"""The demand at which the same runs are made with frames that stay elastic."""

VARIANTS_AT = (1.35, 1.6)
"""The demands at which a soft moat and walls behind the LIR-DCFP are run."""

LIMIT = 300.0
"""Longest time for a run [s]."""


def plan(folder: Path, records: Sequence[str]) -> tuple[list[dict[str, Any]], list[str]]:
    """Return what is run, and the records at demands that would need too large a factor."""
    todo: list[dict[str, Any]] = []
    left_out = []
    for record in records:
        for demand in DEMANDS:
            factor = factor_for(demand, record, folder)
            if factor is None:
                left_out.append(f"{record} from {demand:g} on")
                break
            more = VARIANTS if demand in VARIANTS_AT else ()
            for structure, system in product(structures(), (*SYSTEMS, *more)):
                own = {
                    "record": record,
                    "demand": demand,
                    "factor": factor,
                    "structure": structure,
                    "system": system,
                }
                todo.append(own | {"elastic": False})
                if demand == ELASTIC_AT and system in SYSTEMS:
                    todo.append(own | {"elastic": True})
    return todo, left_out


def lacking(folder: Path) -> list[str]:
    """Return the files of records that a folder does not hold."""
    names = [*AT2.values(), *(f"TCU065-{axis}.ATH" for axis in "ENV"), "landers/luc.bbp"]
    return [name for name in names if not (folder / name).is_file()]


def write(found: Sequence[dict[str, Any]], left_out: Sequence[str]) -> None:
    """Write the page and its figure."""
    target = FOLDER / "figures" / FIGURE
    figure(found).savefig(target, dpi=DPI, metadata={"Software": None})
    text = page(found, left_out, ELASTIC_AT)
    (FOLDER / "yielding_comparison.md").write_text(text, encoding="utf-8")
    print(f"written to {FOLDER}")


def main(given: Sequence[str] | None = None) -> None:
    """Run the buildings and write the page; skipped where a record is lacking."""
    options = series_parser("validation.measurements.yielding_comparison").parse_args(given)
    folder = Path(os.environ.get("LIR_RECORDS", ""))
    missing = lacking(folder)
    if missing:
        print(f"yielding_comparison: skipped, LIR_RECORDS names no folder with {missing[0]}")
        return
    todo, left_out = plan(folder, list(records_in(folder)))
    found, hung = series(partial(perform, folder=folder), todo, options, LIMIT)
    if hung:
        print(*hung, sep="\n")
        raise SystemExit(1)
    write(found, left_out)


if __name__ == "__main__":
    main()
