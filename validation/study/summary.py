"""The study in two pages, from the numbers of its parts: writes docs/validation/study_summary.md.

    python -m validation.study summary

The parts run the campaigns (`python -m validation.study`). This one runs two histories for its figure.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import time_history
from frames.plots import plot_style as ps
from frames.risk.campaign.file import models_in, read_campaign
from validation.page import FOLDER, render
from validation.study import device, runner
from validation.study import near_fault as near_fault  # of the template
from validation.study.part import options_of, quietly, write_part
from validation.study.rounded import rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

NAME = "study_summary"
FILE = runner.HERE / "device-contact.toml"
PLAIN = "rims of 1 W"
OTHER = f"DCFP {device.REFERENCE}, {PLAIN}"
ROWS = {
    "equal plan, 689 mm": ("plan", OTHER),
    "equal plan, 1009 mm": ("plan", f"DCFP 1009 mm, {PLAIN}"),
    "equal moat, 517 mm": ("moat", f"DCFP of moat 517 mm, {PLAIN}"),
    "equal cost": ("cost", f"DCFP of cost as 689 mm, {PLAIN}"),
    "equal plan, 689 mm, rims of 0.5 W": ("plan", f"DCFP {device.REFERENCE}, rims of 0.5 W"),
    "equal plan, 689 mm, unbreakable rims": ("plan", f"DCFP {device.REFERENCE}, unbreakable rims"),
}
"""Comparisons of the table: terms, and the DCFP."""

SHOWN = {"LIR-DCFP": device.LIR, "DCFP, rims of 1 W": OTHER}
RECORD = "Kocaeli, Turkey 1999, Duzce"
BEFORE, AFTER = 0.3, 0.9
"""Time around the largest rim force [s]."""


def parts_of(folder: Path = FOLDER) -> dict[str, Any]:
    """Return the numbers of the parts that the page reads, and of its own histories."""
    names = {"near_fault": "study_near_fault", "device": "study_device", "own": NAME}
    return {
        part: json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        for part, name in names.items()
    }


def page(parts: Found) -> str:
    """Return the page in Markdown."""
    return render(globals(), parts=parts, found=parts["device"], own=parts["device"]["own"])


def pair(parts: Found, row: str, limit: str = device.COLLAPSE) -> dict[str, Any]:
    """Return ratio, counts of records and verdict of a row of the table."""
    terms, other = ROWS[row]
    return device.of_pair(parts["device"]["own"], "contact", terms, other, limit)


def cell(parts: Found, row: str, limit: str) -> str:
    """Return a cell of the table: ratio, records that differ, verdict."""
    one = pair(parts, row, limit)
    ratio = "-" if one["ratio"] is None else "{:.2f} ({:.2f} to {:.2f})".format(*one["ratio"])
    return f"{ratio}; {one['less']} : {one['more']}, {one['verdict']}"


def traced() -> dict[str, Any]:
    """Return loop and axial force of the bearing that is pressed most, for each device shown."""
    frames = models_in(FILE)
    campaign = read_campaign(FILE)
    considered = parts_of_device()["campaigns"]["contact"]["considered"]
    motion = campaign.motions[RECORD].scaled(considered)
    found: dict[str, Any] = {"record": RECORD, "considered": considered, "devices": {}}
    with quietly():
        for name, key in SHOWN.items():
            data = time_history(frames[key], motion, dt=0.01, level="contact")
            found["devices"][name] = _trace(data)
    return found


def parts_of_device(folder: Path = FOLDER) -> dict[str, Any]:
    """Return the numbers of the part on devices."""
    return dict(json.loads((folder / "study_device.json").read_text(encoding="utf-8")))


def _trace(data: xr.Dataset) -> dict[str, Any]:
    rim = data["rim_force"]
    rim = rim.max([d for d in rim.dims if d not in ("time", "bearing")])
    bearing = str(rim["bearing"].to_numpy()[int(rim.max("time").to_numpy().argmax())])
    one = data.sel(bearing=bearing)
    time, load = one["time"].to_numpy(), one["axial_force"].to_numpy()
    at = float(time[int(rim.sel(bearing=bearing).to_numpy().argmax())])
    u, force = (one[k].to_numpy()[:, :2] for k in ("bearing_displacement", "bearing_force"))
    axis = u[np.hypot(*u.T).argmax()] / np.hypot(*u.T).max()
    near = (time > at - BEFORE) & (time < at + AFTER)
    return {
        "bearing": bearing,  # of the largest rim force
        "status": str(data.attrs["status"]),
        "impact": at,
        "displacement": (u @ axis).tolist(),
        "force": (force @ axis / load[0]).tolist(),
        "time": (time[near] - at).tolist(),
        "load": (load[near] / load[0]).tolist(),
        "peak": [float(np.hypot(*u.T).max()), float(np.abs(force @ axis / load[0]).max())],
        "loads": [float(load.min() / load[0]), float(load.max() / load[0])],
    }


def loops_figure(own: Found) -> Figure:
    """Return force over displacement, and axial force over time at the largest impact."""
    figure = ps.new_figure(2.8)
    ((loop, load),) = ps.grid_of(figure, 1, 2)
    for k, (name, one) in enumerate(own["devices"].items()):
        x = 1e3 * np.array(one["displacement"])
        loop.plot(x, one["force"], label=name, **(ps.line_of(k) | {"linewidth": 0.8}))
        load.plot(one["time"], one["load"], **ps.line_of(k))
    ps.caption(loop, x="displacement [mm]", y="force over load at rest [-]")
    ps.caption(
        load, x="time after the largest rim force [s]", y="axial force over load at rest [-]"
    )
    ps.add_legend(figure, loop.get_lines(), columns=2)
    return figure


def write(parts: Found) -> None:
    """Write the page and its figure."""
    figures = {f"{NAME}-loops.png": loops_figure(parts["own"])}
    write_part(NAME, page(parts), figures, parts["own"])


def main(given: Sequence[str] | None = None) -> None:
    """Run the two histories, unless they are kept, and write the page."""
    if not options_of("summary", given).again:
        text = json.dumps(rounded(traced())) + "\n"
        (FOLDER / f"{NAME}.json").write_text(text, encoding="utf-8")
    write(parts_of())


if __name__ == "__main__":
    main()
