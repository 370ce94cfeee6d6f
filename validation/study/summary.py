"""The study in two pages, from the numbers of its parts: `python -m validation.study summary`.

Two histories are run for its figures, and kept in study_summary.json; with `--again` none is.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import norm

from frames import Recording, peaks, time_history
from frames.plots import plot_style as ps
from frames.risk.campaign.comparison import COLLAPSE
from frames.risk.campaign.file import models_in, read_campaign
from validation.page import FOLDER, render, table
from validation.study import device, recompute
from validation.study import near_fault as pulses
from validation.study.device import LEVELS, LIR, REFERENCE, RIMS
from validation.study.levels import corner
from validation.study.runner import HERE, PARTS, quietly, rounded, told_of
from validation.study.shown import interval, rows_of, where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from matplotlib.figure import Figure

    Own = Mapping[str, Any]
    Parts = Mapping[str, Own]

NAME = "study_summary"
LIMITS = DRIFT, DUCTILITY, FLOOR, _ = (
    "storey drift 2 %",
    "ductility 4",
    "floor acceleration 1 g",
    COLLAPSE,
)
DECIDED = ("better", "worse")
DCFP = f"DCFP {REFERENCE}, {RIMS[0]}"

RECORD, SCALE, STEP = "Kocaeli, Turkey 1999, Duzce", 2.2, 0.002
"""Of the histories: the record, its Sa [m/s2], the step [s]."""

SPAN, IMPACTS = (7.0, 17.0), ((8.5, 9.3), (14.1, 14.9))
"""Times that are kept, and two impacts [s]."""

PRINT = 180  # of figures [1/in]


def parts_of(folder: Path = FOLDER) -> Parts:
    """Return the numbers of the parts."""
    return {part: told_of(part, folder) for part in PARTS}


def histories() -> dict[str, Any]:
    """Run the record on both devices; return a bearing's history, and peaks, by device."""
    file, found = HERE / "device-contact.toml", {}
    with quietly():
        motion, frames = read_campaign(file).motions[RECORD].scaled(SCALE), models_in(file)
        for name in (LIR, DCFP):
            kept = Recording(every=5, around_impacts=(0.1, 0.4))
            run = time_history(frames[name], motion, dt=STEP, level="contact", recording=kept)
            axial = float((run["axial_force"] / run["static_axial_force"]).max())
            most = peaks(run)["value"].to_dict() | {"axial": axial}
            found[name] = corner(run, SPAN) | {"peaks": rounded(most)}
    return found


def pairs(told: Own, limit: str = COLLAPSE, group: str = "", over: str = "") -> list[Own]:
    """Return ratios of a campaign for a limit state, by starts of groups and ends of DCFPs."""
    rows = rows_of(where(told["tables"]["ratios"], limit_state=limit))
    return [r for r in rows if r["rims"].startswith(group) and r["over"].endswith(over)]


def span(rows: Sequence[Own], name: str = "ratio [-]") -> str:
    """Return the range of a number of rows, of ratios of medians unless named."""
    found = [row[name] for row in rows if math.isfinite(row[name])]
    ends = dict.fromkeys(f"{end:.2f}" for end in (min(found), max(found))) if found else ()
    return " to ".join(ends) or "not known"


def verdicts(rows: Sequence[Own]) -> str:
    """Return how many comparisons have each verdict."""
    counted = Counter(row["verdict"] for row in rows)
    return ", ".join(f"{word} in {count} of {len(rows)}" for word, count in counted.items())


def collapses(told: Own, name: str) -> str:
    """Return the share of collapse at the maximum considered earthquake by the curve [%]."""
    (row,) = rows_of(where(told["tables"]["margins"], device=name))
    beyond = math.log(told["considered"] / row["median [m/s2]"]) / row["dispersion [-]"]
    return f"{100.0 * norm.cdf(beyond):.0f}"


def _cell(row: Own) -> str:
    # Ratio, and records with fewer and more exceedances; bold if the exact test decides.
    text = f"{row['ratio [-]']:.2f}; {row['less']:.0f}:{row['more']:.0f}"
    return f"**{text}**" if row["verdict"] in DECIDED else text


def table_of(part: Own) -> str:
    """Return comparisons with the LIR-DCFP of the reference plan at both levels, in Markdown."""
    contact, pendulum = (part["campaigns"][level] for level in LEVELS)
    simple = {(row["rims"], row["over"]): _cell(row) for row in pairs(pendulum)}
    lines = []
    for rows in zip(*(pairs(contact, limit) for limit in LIMITS), strict=True):
        name, group = rows[0]["over"], rows[0]["rims"]
        if group.endswith((device.SMALL, device.LARGE)):
            continue
        text = f"{1e3 * part['own']['devices'][name]['plan']:.0f} mm, {name.rsplit(', ', 1)[1]}"
        same = simple.get((group, name), "-")
        lines.append([group.split(",")[0], text, *map(_cell, rows), same, collapses(contact, name)])
    return table(["equal", "DCFP", *LIMITS, "collapse, `pendulum`", "collapse at MCE [%]"], lines)


def recomputed() -> str:
    """Return how far recomputed numbers of the campaigns are from the pages' ones."""
    rows = recompute.table_of(FOLDER / recompute.TABLE)
    count = sum(int(row["numbers"]) for row in rows)
    far = 100.0 * max(float(row["largest relative difference"]) for row in rows)
    parts = len({row["page"] for row in rows})
    return f"{count} numbers of {parts} parts; the largest difference is {far:.1g} %"


def page(parts: Parts, kept: Own) -> str:
    """Return the page in Markdown."""
    device_campaigns = parts["device"]["campaigns"]
    return render(
        globals(),
        parts=parts,
        kept=kept,
        own=parts["device"]["own"],
        near=parts["near_fault"]["own"],
        contact=device_campaigns["contact"],
        held=device_campaigns["held"],
        campaigns=[each for part in parts.values() for each in part["campaigns"].values()],
        interval=interval,
    )


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


def main(*, again: bool = False) -> None:
    """Write the page from the numbers of the parts, with histories that are run or kept."""
    parts, path = parts_of(), FOLDER / f"{NAME}.json"
    kept = json.loads(path.read_text(encoding="utf-8")) if again else histories()
    path.write_text(json.dumps(kept) + "\n", encoding="utf-8")
    path.with_suffix(".md").write_text(page(parts, kept), encoding="utf-8")
    for name, figure in (history_figures(kept) | {"decision": decision_figure(parts)}).items():
        target = FOLDER / "figures" / f"{NAME}-{name}.png"
        figure.savefig(target, dpi=PRINT, metadata={"Software": None})
