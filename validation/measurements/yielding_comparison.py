"""Isolated buildings that yield, on four systems: writes docs/validation/yielding_comparison.md.

    LIR_RECORDS=<folder of records> python -m validation.measurements.yielding_comparison

The demo's building and one of light members, with plastic hinges in columns and beams, stand on
LIR-DCFP bearings, on plain bearings with the same rims, on plain bearings of a larger diameter, and on
these in a moat whose walls stand where the rims were. Records are scaled to equal demands.
"""

from __future__ import annotations

import math
import os
from functools import partial
from itertools import product
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

from frames.plots import plot_style as ps
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.pool import series, series_parser
from validation.measurements import yielding_runs
from validation.measurements.yielding_runs import (
    AT2,
    LIR,
    RIMS,
    SYSTEMS,
    VARIANTS,
    factor_for,
    perform,
    records_in,
    structures,
)
from validation.page import DPI, FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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


Row = dict[str, Any]
FIGURE = "yielding_comparison-demand.png"
PACOIMA = "Pacoima Dam 1971"
COLUMNS = (
    ("bearing displacement [mm]", "displacement", 1e3, ".0f"),
    ("storey drift [%]", "drift", 1e2, ".2f"),
    ("hinge rotation [mrad]", "rotation", 1e3, ".1f"),
    ("hinges that yield", "hinges", 1.0, ".0f"),
    ("residual drift [%]", "residual", 1e2, ".2f"),
    ("base shear / W", "shear", 1.0, ".2f"),
    ("floor acceleration [g]", "floor", 1.0 / STANDARD_GRAVITY, ".2f"),
    ("of the roof [g]", "roof", 1.0 / STANDARD_GRAVITY, ".2f"),
    ("work of yielding / input [%]", "yielding", 1e2, ".1f"),
)
MEASURES = (
    ("drift", "storey drift"),
    ("rotation", "hinge rotation"),
    ("floor", "floor acceleration"),
    ("residual", "residual drift"),
    ("shear", "base shear"),
)
SAME = 0.02
"""Share within which two numbers are no win."""
LEAST = {"drift": 0.0, "rotation": 1e-4, "residual": 5e-4, "floor": 0.0, "shear": 0.0}
"""Differences that are none."""
SPANS = {
    "shear": "base shear",
    "floor": "floor acceleration",
    "roof": "acceleration of the roof",
    "drift": "drift",
}
"""Values of frames that yield over those of elastic ones."""


def chosen(found: Iterable[Row], **wanted: Any) -> list[Row]:
    """Return the rows that have these values."""
    return [row for row in found if all(row[key] == value for key, value in wanted.items())]


def completed(rows: Iterable[Row]) -> list[Row]:
    """Return the runs that were completed."""
    return [row for row in rows if row["status"] == "ok"]


def ends(rows: Sequence[Row]) -> str:
    """Return how many runs were completed, and how the others stopped."""
    stopped = sorted({row["status"] for row in rows} - {"ok"})
    counts = [f"{len(chosen(rows, status=status))} `{status}`" for status in stopped]
    return ", ".join([f"{len(completed(rows))} of {len(rows)}", *counts])


def cells(rows: Sequence[Row]) -> list[str]:
    """Return the medians of what is compared, over completed runs; a dash where there is none."""
    return [
        "-"
        if not rows or any(row[key] is None for row in rows)
        else f"{factor * median(float(row[key]) for row in rows) + 0.0:{form}}"
        for _, key, factor, form in COLUMNS
    ]


def middle(found: Sequence[Row], system: str, demand: float, key: str) -> float:
    """Return the median of a value over the completed runs of a system at a demand."""
    rows = completed(chosen(found, system=system, demand=demand, elastic=False))
    return median(float(row[key]) for row in rows)


def pairs(found: Sequence[Row], other: str, demands: Sequence[float]) -> list[tuple[Row, Row]]:
    """Return the completed runs of the LIR-DCFP with those of another system beside them."""
    mine = {
        (r["record"], r["demand"], r["structure"]): r
        for r in completed(chosen(found, system=LIR, elastic=False))
    }
    return [
        (mine[place], row)
        for row in completed(chosen(found, system=other, elastic=False))
        if (place := (row["record"], row["demand"], row["structure"])) in mine
        and row["demand"] in demands
    ]


def wins(both: Iterable[tuple[Row, Row]], key: str) -> tuple[int, int, int]:
    """Return how often the first is lower, about equal, higher."""
    count = [0, 0, 0]
    for mine, theirs in both:
        a, b = float(mine[key]), float(theirs[key])
        same = abs(a - b) <= max(SAME * max(a, b), LEAST[key])
        count[1 if same else 0 if a < b else 2] += 1
    return count[0], count[1], count[2]


def worse(found: Sequence[Row], other: str, demands: Sequence[float]) -> list[tuple[Row, Row]]:
    """Return the pairs in which the LIR-DCFP does worse by drift, rotation or residual drift."""
    return [
        pair
        for pair in pairs(found, other, demands)
        if any(wins([pair], key)[2] for key in ("drift", "rotation", "residual"))
    ]


def figure(found: Sequence[Row]) -> Figure:
    """Draw drift, hinge rotation and floor acceleration over the demand, medians of records."""
    drawn = ps.new_figure(4.9)
    grid = ps.grid_of(drawn, 2, 4, share_x=True)
    shown = (
        ("storey drift [%]", "drift", 1e2),
        ("hinge rotation [mrad]", "rotation", 1e3),
        ("floor acceleration [g]", "floor", 1.0 / STANDARD_GRAVITY),
    )
    demands = sorted({row["demand"] for row in found})
    for (*panels, last), structure in zip(grid, structures(), strict=True):
        _failed_share(last, found, structure, demands)
        for panel, (text, key, factor) in zip(panels, shown, strict=True):
            for k, system in enumerate(SYSTEMS):
                points = []
                for demand in demands:
                    rows = chosen(
                        found, structure=structure, demand=demand, system=system, elastic=False
                    )
                    done = completed(rows)
                    full = len(done) == len(rows)
                    values = [factor * float(row[key]) for row in done]
                    points.append(median(values) if full and values else math.nan)
                    panel.plot(
                        [demand] * len(values),
                        values,
                        ".",
                        markersize=2.5,
                        alpha=0.5,
                        color=ps.PALETTE[k],
                    )
                panel.plot(demands, points, marker="os^D"[k], markersize=3.5, **ps.line_of(k))
            ps.caption(panel, title=f"{structure} frame", y=text)
            panel.set_ylim(bottom=0.0)
    for panel in grid[1]:
        ps.caption(panel, x="demand / capacity [-]")
    handles = grid[0][0].get_lines()
    named = [line for line in handles if line.get_linestyle() not in ("None", "")]
    for line, system in zip(named, SYSTEMS, strict=True):
        line.set_label(system)
    ps.add_legend(drawn, named, columns=4, title="Medians over records where all runs complete")
    return drawn


def _failed_share(panel: Axes, found: Sequence[Row], structure: str, demands: list[float]) -> None:
    # What the lines of the other panels leave out: without it a device that fails looks ideal.
    for k, system in enumerate(SYSTEMS):
        shares = []
        for demand in demands:
            rows = chosen(found, structure=structure, demand=demand, system=system, elastic=False)
            shares.append(100.0 * (1.0 - len(completed(rows)) / len(rows)) if rows else math.nan)
        panel.plot(demands, shares, marker="os^D"[k], markersize=3.5, **ps.line_of(k))
    panel.set_ylim(0.0, 102.0)
    ps.caption(panel, y="runs with a failed bearing [%]")


def over(found: Sequence[Row], demand: float, other: str, key: str) -> tuple[float, float]:
    """Return medians of the LIR-DCFP and of another system, of runs that both complete."""
    both = pairs(found, other, [demand])
    return median(float(a[key]) for a, _ in both), median(float(b[key]) for _, b in both)


def spans(found: Sequence[Row], demand: float) -> tuple[int, dict[str, tuple[float, float]]]:
    """Return how many runs yield, and the span of values over those of the elastic frame."""
    both = [
        (a, b)
        for a in completed(chosen(found, demand=demand, elastic=False))
        for b in completed(
            chosen(
                found,
                **{"demand": demand, "elastic": True, "system": a["system"]},
                **{"structure": a["structure"], "record": a["record"]},
            )
        )
        if a["hinges"] > 0
    ]
    ratios = {key: [float(a[key]) / float(b[key]) for a, b in both] for key in SPANS}
    return len(both), {SPANS[key]: (min(r), max(r)) for key, r in ratios.items() if r}


def page(found: Sequence[Row], left_out: Sequence[str], elastic_at: float) -> str:
    """Return the page in Markdown; at a demand frames were elastic, too."""
    every = sorted({row["demand"] for row in found})
    met = [d for d in every if 1.0 < d < every[-1]]
    runs = chosen(found, system=LIR, demand=met[-1], elastic=False)
    elastic, yields = (
        chosen(
            found,
            **{"record": PACOIMA, "demand": elastic_at, "structure": "demo"},
            **{"system": RIMS, "elastic": how},
        )[0]
        for how in (True, False)
    )
    return render(
        globals(),
        elastic=elastic,
        elastic_at=elastic_at,
        every=every,
        found=found,
        g=1.0 / STANDARD_GRAVITY,
        left_out=left_out,
        met=met,
        of=yielding_runs,
        runs=runs,
        spans=spans(found, elastic_at),
        variants_at=sorted({row["demand"] for row in found if row["system"] in VARIANTS}),
        yields=yields,
    )


if __name__ == "__main__":
    main()
