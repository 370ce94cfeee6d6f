"""Peak values of several results side by side: as a table, and as files."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from frames.results.findings import doubts_of
from frames.results.peaks import peaks_of
from frames.results.storage import as_text, save_groups, write_whole
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr


@dataclass(frozen=True)
class Row:
    """One line: its text, the factor from SI, the format, the SI name, the quantity of `peaks`."""

    text: str
    factor: float
    form: str
    name: str
    quantity: str


_FLOORS = "floor acceleration in plan, mean"
ROWS = (
    Row(
        "peak bearing displacement in plan [mm]",
        1e3,
        ".0f",
        "peak_bearing_displacement_m",
        "bearing displacement",
    ),
    Row(
        "peak base shear in plan / weight [-]",
        1.0,
        ".3f",
        "peak_base_shear_over_weight",
        "base shear over weight",
    ),
    Row(
        "peak storey drift in plan, mean [%]", 1e2, ".3f", "peak_storey_drift", "storey drift, mean"
    ),
    Row(
        "peak floor acceleration in plan, mean [m/s2]",
        1.0,
        ".2f",
        "peak_floor_acceleration_m_s2",
        _FLOORS,
    ),
    Row("peak floor acceleration in plan, mean [g]", 1.0 / STANDARD_GRAVITY, ".2f", "", _FLOORS),
    Row("largest interface slip [mm]", 1e3, ".1f", "largest_interface_slip_m", "interface slip"),
    Row("largest rim force [kN]", 1e-3, ".0f", "largest_rim_force_N", "rim force"),
    Row("maximum axial force [kN]", 1e-3, ".0f", "largest_axial_force_N", "axial force"),
    Row("minimum axial force [kN]", 1e-3, ".0f", "smallest_axial_force_N", "minimum axial force"),
    Row(
        "residual displacement in plan [mm]",
        1e3,
        ".1f",
        "residual_displacement_m",
        "residual bearing displacement",
    ),
    Row(
        "residual interface slip [mm]",
        1e3,
        ".1f",
        "residual_interface_slip_m",
        "residual interface slip",
    ),
    Row(
        "energy balance: error / input [-]",
        1.0,
        ".1e",
        "energy_error",
        "energy balance: error over input",
    ),
    Row("run time, time loop [s]", 1.0, ".2f", "run_time_s", "seconds of the time loop"),
)
"""In plan: the size of the vector of both horizontal components, at one instant. Mean: of the nodes
of a level."""


def summary_of(data: xr.Dataset) -> dict[str, float]:
    """Return the numbers of the summary by SI name (`ROWS`), from one result: those of `peaks`."""
    found = {peak.quantity: peak.value for peak in peaks_of(data)}
    return {row.name: found.get(row.quantity, math.nan) for row in ROWS if row.name}


def table_of(results: Mapping[str, xr.Dataset]) -> str:
    """Return the summary of all systems as text, a column each."""
    numbers = {name: summary_of(data) for name, data in results.items()}
    wide = max(len(row.text) for row in ROWS)
    lines = [" " * wide + "".join(f"{name:>20}" for name in results)]
    for row in ROWS:
        key = row.name or "peak_floor_acceleration_m_s2"
        cells = [_cell(row, values[key]) for values in numbers.values()]
        lines.append(f"{row.text:<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    cells = [status_of(data) for data in results.values()]
    lines.append(f"{'status':<{wide}}" + "".join(f"{cell:>20}" for cell in cells))
    failed = {n: d.attrs["message"] for n, d in results.items() if "failed_at" in d.attrs}
    lines += [f"{name} stopped {message}" for name, message in failed.items()]
    for name, data in results.items():
        lines += [f"{name}: warning: {doubt}" for doubt in doubts_of(data)]
    return "\n".join(lines)


def write_results(results: Mapping[str, xr.Dataset], folder: Path) -> None:
    """Write `results.nc`, a group for each system in single precision, and `summary.csv` (SI).

    What stood in either before is replaced once all of it is written.
    """
    save_groups({group_of(name): data for name, data in results.items()}, folder / "results.nc")
    table = io.StringIO(newline="")
    writer = csv.writer(table)
    names = [row.name for row in ROWS if row.name]
    writer.writerow(["system", "status", "failed_at_s", *names, "doubts"])
    for name, data in results.items():
        values = summary_of(data)
        failed_at = data.attrs.get("failed_at", "")
        cells = [f"{values[key]:.6g}" for key in names]
        doubts = as_text("; ".join(doubts_of(data)))
        writer.writerow([as_text(name), data.attrs["status"], failed_at, *cells, doubts])
    write_whole(folder / "summary.csv", table.getvalue())


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


def _cell(row: Row, value: float) -> str:
    return f"{row.factor * value + 0.0:{row.form}}" if math.isfinite(value) else "-"
