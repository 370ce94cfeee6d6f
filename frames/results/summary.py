"""Peak values of several results side by side: as a table, and as files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.results.assumption_checks import doubts_of
from frames.results.peaks import peaks_of, summary
from frames.results.storage import csv_of, save_groups, write_whole
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr


ROWS = (
    ("bearing displacement", "mm", ".0f"),
    ("base shear over weight", "-", ".3f"),
    ("storey drift, mean", "%", ".3f"),
    ("floor acceleration in plan, mean", "m/s2", ".2f"),
    ("floor acceleration in plan, mean", "g", ".2f"),
    ("interface slip", "mm", ".1f"),
    ("rim force", "kN", ".0f"),
    ("axial force", "kN", ".0f"),
    ("minimum axial force", "kN", ".0f"),
    ("residual bearing displacement", "mm", ".1f"),
    ("residual interface slip", "mm", ".1f"),
    ("energy balance: error over input", "-", ".1e"),
    ("seconds of the time loop", "s", ".2f"),
)
"""Quantities of `peaks` with their unit and format."""

_FACTORS = {"mm": 1e3, "kN": 1e-3, "%": 1e2, "g": 1.0 / STANDARD_GRAVITY}


def table_of(results: Mapping[str, xr.Dataset]) -> str:
    """Return the summary of all systems as text, a column each."""
    numbers = [{peak.quantity: peak.value for peak in peaks_of(data)} for data in results.values()]
    heads = [f"{quantity} [{unit}]" for quantity, unit, _ in ROWS]
    wide = max(map(len, heads))
    lines = [" " * wide + "".join(f"{name:>20}" for name in results)]
    for head, (quantity, unit, form) in zip(heads, ROWS, strict=True):
        values = [_FACTORS.get(unit, 1.0) * each.get(quantity, math.nan) for each in numbers]
        cells = [f"{value + 0.0:{form}}" if math.isfinite(value) else "-" for value in values]
        lines.append(f"{head:<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    cells = [status_of(data) for data in results.values()]
    lines.append(f"{'status':<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    failed = {n: d.attrs["message"] for n, d in results.items() if "failed_at" in d.attrs}
    lines += [f"{name} stopped {message}" for name, message in failed.items()]
    for name, data in results.items():
        lines += [f"{name}: warning: {doubt}" for doubt in doubts_of(data)]
    return "\n".join(lines)


def write_results(results: Mapping[str, xr.Dataset], folder: Path) -> None:
    """Write `results.nc`, a group for each system in single precision, and `summary.csv`.

    What stood in either before is replaced once all of it is written.
    """
    save_groups({group_of(name): data for name, data in results.items()}, folder / "results.nc")
    write_whole(folder / "summary.csv", csv_of(summary(results).T.rename_axis("system")))


def group_of(name: str) -> str:
    """Return the name of a system's group in `results.nc`."""
    return name.lower().replace(" ", "_")


def status_of(data: xr.Dataset) -> str:
    """Return "completed", with a mark where the check has one, or how and when a run stopped."""
    if "failed_at" in data.attrs:
        return f"{data.attrs['status']} {data.attrs['failed_at']:.2f} s"
    if data.attrs["status"] != "ok":
        return str(data.attrs["status"])
    return "completed, warning" if doubts_of(data) else "completed"
