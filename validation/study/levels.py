"""Why levels differ where LIR-DCFPs fail: failures by level and hold of the halves, a traced run.

    python -m validation.study.levels --store level-runs

Writes study_levels.json and its figure; `section` is what a page includes. Needs the extras
"campaign" and "fema".
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import time_history
from frames.design import MotionSet
from frames.plots import plot_style as ps
from frames.risk import Campaign
from validation.page import DPI, FOLDER
from validation.study.device_runs import Device, frame_of, plan_of
from validation.study.part import performed, quietly, run_part
from validation.study.records_runs import STEP, normalised

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from frames import Frame, GroundMotion

    Found = Mapping[str, Any]

NAME = "study_levels"
STRIPES = (3.2, 4.2)
HOLDS = (0.0, 300.0, 1e3)
"""Forces that hold the halves of a slider [N]."""

RUNS = {"pendulum": HOLDS[:1], "contact": HOLDS}
TRACED, AT = "Kobe, Japan 1995, Nishi-Akashi", 4.2
SHOWN = (("pendulum", 0.0), ("contact", 0.0), ("contact", 1e3))
BEFORE, AFTER = 0.4, 1.6
"""What is shown around the instant at which a bearing's slip begins [s]."""


def device() -> Device:
    """Return the LIR-DCFP of the largest plan compared."""
    return Device(plan_of(0.22), False, least=0.1527, interface=0.207)


def frame(hold: float) -> Frame:
    """Return the study's building on it, its halves held by a force [N]."""
    own = frame_of(device())
    return own.with_bearings(
        {name: replace(link.bearing, interface_hold=hold) for name, link in own.bearings.items()}
    )


def ends(data: xr.Dataset, hold: float) -> list[list[str]]:
    """Return the records under which a bearing failed, stripe by stripe."""
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == named(hold)))
    failed = own["status"].to_numpy() != "ok"
    return [
        sorted(own["motion"].to_numpy()[failed & (own["scale"].to_numpy() == stripe)].tolist())
        for stripe in STRIPES
    ]


def named(hold: float) -> str:
    """Return the name of a model in the campaign."""
    return f"held by {hold:g} N"


def trace(motion: GroundMotion) -> dict[str, Any]:
    """Return axial force and slip of the bearing that slips most at the level contact, unheld."""
    runs: dict[str, Any] = {}
    with quietly():
        for level, hold in SHOWN:
            data = time_history(frame(hold), motion, dt=STEP, level=level, duration=20.0)
            runs[f"{level}, {named(hold)}"] = data
    unheld = runs[f"contact, {named(0.0)}"]
    slip = unheld["interface_slip_size"]
    bearing = str(slip["bearing"].to_numpy()[int(slip.max("time").argmax())])
    own = slip.sel(bearing=bearing).to_numpy()
    start = float(unheld["time"][int(np.argmax(own > 1e-3))])
    found: dict[str, Any] = {"bearing": bearing, "start": start, "runs": {}}
    for name, data in runs.items():
        one = data.sel(bearing=bearing)
        time = one["time"].to_numpy()
        seen = (time > start - BEFORE) & (time < start + AFTER)
        found["runs"][name] = {
            "time": time[seen].round(4).tolist(),
            "load": (1e-3 * one["axial_force"].to_numpy()[seen]).round(2).tolist(),
            "slip": (1e3 * one["interface_slip_size"].to_numpy()[seen]).round(2).tolist(),
        }
    return found


def found_of(store: Path, workers: int | str) -> dict[str, Any]:
    """Run the campaigns, or go on with them, and return what is found."""
    motions = dict(list(normalised(MotionSet.fema_p695("far-field")).items())[::2])
    found: dict[str, Any] = {"records": len(motions), "failed": {}, "cost": {}}
    for level, holds in RUNS.items():
        frames = {named(hold): frame(hold) for hold in holds}
        campaign = Campaign(
            frames, motions, store=store / level, scales=list(STRIPES), dt=STEP, level=level
        )
        found["cost"][level] = performed(campaign, workers)
        data = campaign.results()
        found["failed"][level] = {f"{hold:g}": ends(data, hold) for hold in holds}
    return found | {"trace": trace(motions[TRACED].scaled(AT))}


def figure_of(found: Found) -> Figure:
    """Return axial force and slip of the traced bearing over time, level by level."""
    figure = ps.new_figure(3.6)
    panels = [row[0] for row in ps.grid_of(figure, 2, 1, share_x=True)]
    for k, (name, run) in enumerate(found["trace"]["runs"].items()):
        for panel, key in zip(panels, ("load", "slip"), strict=True):
            panel.plot(run["time"], run[key], label=name, **ps.line_of(k))
    ps.caption(panels[0], y="axial force [kN]")
    ps.caption(panels[1], x="time [s]", y="slip [mm]")
    ps.add_legend(figure, panels[0].get_lines(), columns=3)
    return figure


def section(found: Found) -> str:
    """Return the table of failures, in Markdown."""
    head = f"| level | hold [N] | {' | '.join(f'{s:g} m/s2' for s in STRIPES)} |\n"
    rows = [
        f"| `{level}` | {hold} | {' | '.join(str(len(records)) for records in stripes)} |"
        for level, holds in found["failed"].items()
        for hold, stripes in holds.items()
    ]
    return head + "| --- | --- | --- | --- |\n" + "\n".join(rows) + "\n"


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns and write numbers and figure."""

    def write(found: Found) -> None:
        file = FOLDER / "figures" / f"{NAME}-trace.png"
        figure_of(found).savefig(file, dpi=DPI, metadata={"Software": None})
        (FOLDER / f"{NAME}.json").write_text(json.dumps(found) + "\n", encoding="utf-8")
        print(section(found))

    run_part("levels", given, found_of, write)


if __name__ == "__main__":
    main()
