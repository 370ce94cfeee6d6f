"""The study in two pages, from the numbers of its parts: writes docs/validation/study_summary.md.

    python -m validation.study.summary [--again]

Two histories are run for its figures, and kept in study_summary.json; with `--again` none is.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import Recording, peaks, time_history
from frames.plots import plot_style as ps
from frames.risk.campaign.file import models_in, read_campaign
from validation.page import FOLDER, render, table
from validation.study import device, recompute
from validation.study import near_fault as pulses
from validation.study.device import LIMITS, LIR, REFERENCE, RIMS, TERMS, ratio_of
from validation.study.part import quietly
from validation.study.runner import HERE, name_of, rounded, told_of
from validation.study.shown import rows_of, where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    Own = Mapping[str, Any]
    Parts = Mapping[str, Own]

NAME = "study_summary"
DRIFT, DUCTILITY, FLOOR, COLLAPSE = LIMITS
DECIDED = ("better", "worse")
DCFP = f"DCFP {REFERENCE}, {RIMS[0]}"

OTHERS = ("records", "buildings", "after", "motions", "uncertainty", "loss")

RECORD, SCALE, STEP, BEARING = "Kocaeli, Turkey 1999, Duzce", 2.2, 0.002, "bearing-2-2"
"""Of the histories: the record, its Sa [m/s2], the step [s], a corner."""

SPAN, IMPACTS = (7.0, 17.0), ((8.5, 9.3), (14.1, 14.9))
"""Times that are kept, and two impacts [s]."""

PRINT = 180  # of figures [1/in]


def parts_of(folder: Path = FOLDER) -> Parts:
    """Return the numbers of the parts."""
    found = {}
    for part in ("device", "near_fault", *OTHERS):
        given = json.loads((folder / f"{name_of(part)}.json").read_text(encoding="utf-8"))
        found[part] = {"campaigns": told_of(given), "own": given["own"]}
    return found


def histories() -> dict[str, Any]:
    """Run the record on both devices; return a bearing's history, and peaks, by device."""
    file, found = HERE / "device-contact.toml", {}
    with quietly():
        motion, frames = read_campaign(file).motions[RECORD].scaled(SCALE), models_in(file)
        for name in (LIR, DCFP):
            kept = Recording(every=5, around_impacts=(0.1, 0.4))
            run = time_history(frames[name], motion, dt=STEP, level="contact", recording=kept)
            found[name] = _kept(run)
    return found


def _kept(data: xr.Dataset) -> dict[str, Any]:
    # Of one bearing, along its largest displacement, forces over its load at rest.
    own, t = data.sel(bearing=BEARING, axis=["x", "y"]), data["time"].to_numpy()
    way, force = (own[f"bearing_{key}"].to_numpy() for key in ("displacement", "force"))
    toward = way[np.hypot(*way.T).argmax()] / np.hypot(*way.T).max()
    over = 1.0 / float(own["static_axial_force"])
    series = {"time": t, "displacement": way @ toward, "force": over * (force @ toward)}
    series["axial"] = over * own["axial_force"].to_numpy()
    kept = (SPAN[0] <= t) & (t <= SPAN[1])
    axial = float((data["axial_force"] / data["static_axial_force"]).max())
    most = peaks(data)["value"].to_dict() | {"axial": axial}
    found = {key: values[kept].round(4).tolist() for key, values in series.items()}
    return found | {"peaks": rounded(most)}


def pairs(own: Own, limit: str, terms: str = "plan", end: str = "", level: int = 0) -> list[Own]:
    """Return comparisons of a limit state on equal terms, of DCFPs whose name ends so."""
    rows = own[device.LEVELS[level]]["pairs"][terms]
    return [row for row in rows if row["limit"] == limit and row["other"].endswith(end)]


def span(rows: Sequence[Own]) -> str:
    """Return the range of ratios of medians."""
    found = [row["ratio"][0] for row in rows if row["ratio"]]
    ends = dict.fromkeys(f"{end:.2f}" for end in (min(found), max(found))) if found else ()
    return " to ".join(ends) or "not known"


def verdicts(rows: Sequence[Own]) -> str:
    """Return how many comparisons have each verdict."""
    counted = Counter(row["verdict"] for row in rows)
    return ", ".join(f"{word} in {count} of {len(rows)}" for word, count in counted.items())


def _cell(row: Own) -> str:
    # Ratio, and records with fewer and more exceedances; bold if the exact test decides.
    text = f"{ratio_of(row)}; {row['less']}:{row['more']}"
    return f"**{text}**" if row["verdict"] in DECIDED else text


def table_of(own: Own) -> str:
    """Return comparisons at level contact, and collapse at level pendulum, in Markdown."""
    lines = []
    for terms in TERMS:
        simple = {row["other"]: _cell(row) for row in pairs(own, COLLAPSE, terms, level=1)}
        for rows in zip(*(pairs(own, limit, terms) for limit in LIMITS), strict=True):
            name, size = rows[0]["other"], 1e3 * own["devices"][rows[0]["other"]]["plan"]
            if not name.endswith(RIMS[2]) or name.startswith(f"DCFP {REFERENCE}"):
                text = f"{size:.0f} mm, {name.rsplit(', ', 1)[1]}"
                lines.append([terms, text, *map(_cell, rows), simple.get(name, "-")])
    return table(["equal", "DCFP", *LIMITS, "collapse, `pendulum`"], lines)


def line_of(part: Own) -> str:
    """Return level of a part and the ratios of collapse of its LIR-DCFPs over its DCFPs."""
    told = part["campaigns"].values()
    levels = sorted({f"`{each['plan']['level of fidelity']}`" for each in told})
    rows = [
        row | {"ratio": [row["ratio [-]"]] if row["ratio [-]"] > 0.0 else None}
        for each in told
        if "ratios" in each["tables"]
        for row in rows_of(where(each["tables"]["ratios"], limit_state=COLLAPSE))
        if "LIR" in row["own"]
        and "LIR" not in row["over"]
        and ("stop" in row["own"]) is ("stop" in row["over"])
    ]
    ratios = f"{span(rows)}, " if any(row["ratio"] for row in rows) else ""
    said = f" Collapse: {ratios}{verdicts(rows)}." if rows else ""
    return f"Level {', '.join(levels)}.{said}"


def recomputed() -> str:
    """Return how far recomputed numbers of the campaigns are from the pages' ones."""
    rows = recompute.table_of(FOLDER / recompute.TABLE)
    count = sum(int(row["numbers"]) for row in rows)
    far = 100.0 * max(float(row["largest relative difference"]) for row in rows)
    parts = len({row["page"] for row in rows})
    return f"{count} numbers of {parts} parts; the largest difference is {far:.1g} %"


def page(parts: Parts, kept: Own) -> str:
    """Return the page in Markdown."""
    own, near = parts["device"]["own"], parts["near_fault"]["own"]
    return render(globals(), parts=parts, kept=kept, own=own, near=near)


def decision_figure(parts: Parts) -> Figure:
    """Return collapse margins over plan and moat, and which device survives which pulse."""
    own, near = parts["device"]["own"], parts["near_fault"]["own"]
    margins = parts["device"]["campaigns"]["contact"]["tables"]["margins"].set_index("device")
    figure = ps.new_figure(5.6)
    above, below = ps.grid_of(figure, 2, 2)
    for panel, key in zip(above, ("plan", "moat"), strict=True):
        device.margins_over(panel, own, margins, key)
    for panel, pair in zip(below, (pulses.PLAN, pulses.MOAT), strict=True):
        pulses.draw_cells(panel, near, pair)
        title, x, y = f"pulses, equal {pair}", "T_p / T_b [-]", "peak velocity [m/s]"
        ps.caption(panel, x=x, y=y, title=title)
    device.legend(figure)
    look: dict[str, Any] = {"ncols": 3, "fontsize": ps.SMALL, "frameon": False}
    figure.legend(handles=pulses.legend_handles(), loc="outside lower center", **look)
    return figure


def history_figures(kept: Own) -> dict[str, Figure]:
    """Return force over displacement of the bearing, and its axial force at two impacts."""
    figures: dict[str, Figure] = {name: ps.new_figure(2.4) for name in ("loops", "axial")}
    (loops,), (axial,) = (ps.grid_of(each, 1, 2, share_y=True) for each in figures.values())
    for k, (name, run) in enumerate(kept.items()):
        loops[k].plot(1e3 * np.array(run["displacement"]), run["force"], "k", linewidth=0.8)
        ps.caption(loops[k], title=name, x="displacement [mm]", y="force / W [-]")
        for panel, ends in zip(axial, IMPACTS, strict=True):
            panel.plot(run["time"], run["axial"], label=name, **ps.line_of(k))
            panel.set_xlim(*ends)
            ps.caption(panel, x="time [s]", y="N / W [-]")
    axial[1].legend(fontsize=ps.SMALL, frameon=False)
    return figures


def main(given: Sequence[str] | None = None) -> None:
    """Write the page from the numbers of the parts; with `--again` run nothing."""
    parts, path = parts_of(), FOLDER / f"{NAME}.json"
    again = "--again" in (sys.argv if given is None else given)
    kept = json.loads(path.read_text(encoding="utf-8")) if again else histories()
    path.write_text(json.dumps(kept) + "\n", encoding="utf-8")
    path.with_suffix(".md").write_text(page(parts, kept), encoding="utf-8")
    for name, figure in (history_figures(kept) | {"decision": decision_figure(parts)}).items():
        target = FOLDER / "figures" / f"{NAME}-{name}.png"
        figure.savefig(target, dpi=PRINT, metadata={"Software": None})


if __name__ == "__main__":
    main()
