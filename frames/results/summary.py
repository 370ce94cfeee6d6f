"""Peak values of several results side by side: as a table, and as files."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames.results.auditing import doubts_of
from frames.results.kept import require_steps
from frames.results.measures import energy_error, floor_acceleration, storey_drift
from frames.results.storage import save_groups, write_whole
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr


@dataclass(frozen=True)
class Row:
    """One line of the summary: its text, the factor from SI, the format, and the SI name."""

    text: str
    factor: float
    form: str
    name: str


ROWS = (
    Row("peak bearing displacement [mm]", 1e3, ".0f", "peak_bearing_displacement_m"),
    Row("peak base shear / weight [-]", 1.0, ".3f", "peak_base_shear_over_weight"),
    Row("peak storey drift [%]", 1e2, ".3f", "peak_storey_drift"),
    Row("peak floor acceleration in plan [m/s2]", 1.0, ".2f", "peak_floor_acceleration_m_s2"),
    Row("peak floor acceleration in plan [g]", 1.0 / STANDARD_GRAVITY, ".2f", ""),
    Row("largest interface slip [mm]", 1e3, ".1f", "largest_interface_slip_m"),
    Row("largest rim force [kN]", 1e-3, ".0f", "largest_rim_force_N"),
    Row("largest axial force [kN]", 1e-3, ".0f", "largest_axial_force_N"),
    Row("smallest axial force [kN]", 1e-3, ".0f", "smallest_axial_force_N"),
    Row("residual displacement [mm]", 1e3, ".1f", "residual_displacement_m"),
    Row("residual interface slip [mm]", 1e3, ".1f", "residual_interface_slip_m"),
    Row("energy ledger: error / input [-]", 1.0, ".1e", "energy_error"),
    Row("run time, time loop [s]", 1.0, ".2f", "run_time_s"),
)


def summary_of(data: xr.Dataset) -> dict[str, float]:
    """Return the numbers of the summary by SI name (`ROWS`), from one result."""
    require_steps(data, "the summary")
    u = np.linalg.norm(data["bearing_displacement"].sel(axis=["x", "y"]).to_numpy(), axis=-1)
    shear = np.linalg.norm(data["base_shear"].sel(axis=["x", "y"]).to_numpy(), axis=-1)
    floors = np.linalg.norm(floor_acceleration(data).sel(axis=["x", "y"]).to_numpy(), axis=-1)
    slip = data["interface_slip_size"]
    has_ended = 1.0 if data.attrs["status"] == "ok" else math.nan  # a run that stopped has no rest
    return {
        "peak_bearing_displacement_m": float(u.max()),
        "peak_base_shear_over_weight": float(shear.max()) / float(data["weight"]),
        "peak_storey_drift": float(np.abs(storey_drift(data)).max()),
        "peak_floor_acceleration_m_s2": float(floors.max()),
        "largest_interface_slip_m": float(slip.max()),
        "largest_rim_force_N": float(data["rim_force"].max()),
        "largest_axial_force_N": float(data["axial_force"].max()),
        "smallest_axial_force_N": float(data["axial_force"].min()),
        "residual_displacement_m": has_ended * float(u[-1].max()),
        "residual_interface_slip_m": has_ended * float(slip.isel(time=-1).max()),
        "energy_error": energy_error(data),
        "run_time_s": float(data.attrs["seconds_loop"]),
    }


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
        lines += [f"{name}: look at: {doubt}" for doubt in doubts_of(data)]
    return "\n".join(lines)


def write_results(results: Mapping[str, xr.Dataset], folder: Path) -> None:
    """Write `results.nc`, a group for each system in single precision, and `summary.csv` (SI).

    What stood in either before is replaced once all of it is written.

    Parameters
    ----------
    results : mapping of str to xarray.Dataset
        Results by name of system.
    folder : Path
        Where to.

    Raises
    ------
    OSError
        If a file cannot be written; the message names it.
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
        writer.writerow([name, data.attrs["status"], failed_at, *cells, "; ".join(doubts_of(data))])
    write_whole(folder / "summary.csv", table.getvalue().encode())


def group_of(name: str) -> str:
    """Return the name of a system's group in `results.nc`."""
    return name.lower().replace(" ", "_")


def status_of(data: xr.Dataset) -> str:
    """Return "completed", with a mark where the audit has one, or how and when a run stopped."""
    if "failed_at" in data.attrs:
        return f"{data.attrs['status']} {data.attrs['failed_at']:.2f} s"
    if data.attrs["status"] != "ok":
        return str(data.attrs["status"])
    return "completed, audit: !" if doubts_of(data) else "completed"


def _cell(row: Row, value: float) -> str:
    return f"{row.factor * value + 0.0:{row.form}}" if math.isfinite(value) else "-"
