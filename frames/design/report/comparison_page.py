"""A comparison of two devices as one HTML page and tables."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from frames.design.project.comparison import BY_MOTION, OURS, PLAIN
from frames.design.report.comparison_words import verdicts
from frames.design.report.page import Picture, page_table, page_template, picture
from frames.design.report.tables import in_mm_and_kn
from frames.plots import bearing_sections, hysteresis, storey_profiles
from frames.plots import plot_style as ps
from frames.results.quantities import DEMANDS
from frames.results.storage import csv_of, make_folder, write_whole
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.design.project.comparison import Comparison


def write_comparison(
    found: Comparison,
    folder: Path,
    source: str,
    histories: tuple[Mapping[str, xr.Dataset], str, str] | None,
) -> list[Path]:
    """Write what a comparison of two devices gave."""
    make_folder(folder)
    texts = {
        "compare.csv": csv_of(found.table()),
        "compare-motions.csv": csv_of(found.by_motion(), index=False),
        "compare.html": _page(found, source, histories),
    }
    written = []
    for name, text in texts.items():
        path = folder / name
        write_whole(path, text)
        written.append(path)
    return written


def _page(
    found: Comparison,
    source: str,
    histories: tuple[Mapping[str, xr.Dataset], str, str] | None,
) -> str:
    motions = found.by_motion()
    pictures = {}
    if histories is not None:
        pictures = comparison_pictures(motions, *histories)
    return page_template("compare.html.j2").render(
        name=found.known.frame.name,
        code=found.known.equivalent.code,
        verdicts=verdicts(found),
        demands=page_table(_differences(found), "quantity"),
        statistics={device: _statistic(found, device) for device in (OURS, PLAIN)},
        motions=page_table(_numbered(motions), "motion"),
        eccentricity=found.eccentricity,
        case="" if histories is None else histories[1],
        pictures=pictures,
        doubts=found.known.doubts,
        source=source,
        written=f"{datetime.now(tz=UTC):%Y-%m-%d %H:%M} UTC, lir-dcfp {package_version()}",
    )


def _differences(found: Comparison) -> pd.DataFrame:
    # The envelopes of both devices, and how far the first is from the second.
    ours, plain = (found.demands[device] for device in (OURS, PLAIN))
    one, two = ours["envelope"], plain["envelope"].to_numpy()
    change = 100.0 * (one / np.where(np.abs(two) > 0.0, two, math.nan) - 1.0)
    void = (ours["void"] != "").to_numpy() | (plain["void"] != "").to_numpy()
    words = [
        "no value" if failed else "-" if math.isnan(value) else f"{value:+.0f} %"
        for value, failed in zip(change, void, strict=True)
    ]
    table = ours[["unit"]].assign(**{OURS: one, PLAIN: two, f"{OURS} to {PLAIN}": words})
    return table if ours["level"].nunique() == 1 else table.assign(level=ours["level"])


def _statistic(found: Comparison, device: str) -> str:
    statistics: Mapping[str, str] = found.demands[device].attrs["statistics"]
    said = dict.fromkeys(statistics.values())
    if len(said) == 1:
        return next(iter(said))
    return "; ".join(f"{bound}: {words}" for bound, words in statistics.items())


def _numbered(motions: pd.DataFrame) -> pd.DataFrame:
    # Motions with the numbers that the figure has.
    number = {name: k for k, name in enumerate(dict.fromkeys(motions["motion"]), start=1)}
    named = [f"{number[name]} {name}" for name in motions["motion"]]
    shown = motions.drop(columns="motion").rename(columns={"failed": "runs that stopped"})
    shown.index = pd.Index(named, name="motion")
    if shown["level"].nunique() == 1:
        shown = shown.drop(columns="level")
    shown = in_mm_and_kn(shown)
    return shown.iloc[sorted(range(len(shown)), key=lambda k: number[motions["motion"].iloc[k]])]


_DEVICES = (OURS, PLAIN)
_MARKERS = ("o", "s")
_ASIDE = (-0.12, 0.12)  # of the number of the motion


def by_motion(table: pd.DataFrame) -> Figure:
    """Draw what each motion reached with each device, the largest over the bounds."""
    titles = [title for title in BY_MOTION if table[title].notna().any()]
    figure, panels = ps.panels_of(len(titles), 2, 2.1, share=False)
    for panel, title in zip(panels, titles, strict=True):
        _panel(panel, table, title)
    handles = [
        Line2D([], [], marker=marker, color=colour, linestyle="none", label=device)
        for device, marker, colour in zip(_DEVICES, _MARKERS, ps.PALETTE, strict=False)
    ]
    if (table["failed"] != "").any():
        cross: dict[str, Any] = {"marker": "x", "color": ps.GREY, "linestyle": "none"}
        handles.append(Line2D([], [], label="a run stopped: reached at least", **cross))
    ps.add_legend(figure, handles)
    return figure


def _panel(panel: Axes, table: pd.DataFrame, title: str) -> None:
    quantity = DEMANDS[BY_MOTION[title]]
    shown, factor = quantity.in_figures
    motions = list(dict.fromkeys(table["motion"]))
    for k, device in enumerate(_DEVICES):
        rows = table[table["device"] == device].set_index("motion").loc[motions]
        values = factor * rows[title].to_numpy(dtype=float)
        places = np.arange(1, len(motions) + 1) + _ASIDE[k]
        failed = (rows["failed"] != "").to_numpy()
        look: dict[str, Any] = {"color": ps.PALETTE[k], "linestyle": "none", "markersize": 5.0}
        panel.plot(places[~failed], values[~failed], marker=_MARKERS[k], **look)
        panel.plot(places[failed], values[failed], marker="x", **look)
        for x, y in zip(places[failed], values[failed], strict=True):
            panel.annotate(
                "",
                (x, y),
                xytext=(0.0, 13.0),
                textcoords="offset points",
                arrowprops={"arrowstyle": "<-", "color": ps.PALETTE[k], "linewidth": 0.9},
            )
    panel.set_xticks(range(1, len(motions) + 1))
    panel.set_xlim(0.5, len(motions) + 0.5)
    panel.set_ylim(0.0, 1.2 * factor * float(np.nanmax(table[title])) or 1.0)
    ps.caption(panel, x="number of the motion", y=f"{quantity.demand} [{shown}]")


def comparison_pictures(
    table: pd.DataFrame, histories: Mapping[str, xr.Dataset], case: str, bearing: str
) -> dict[str, list[Picture]]:
    """Return the figures of a comparison by the section that they stand in."""
    several = table["level"].nunique() > 1
    motions = [
        picture(
            "Largest of each motion over the bounds" + (f", {level} level" if several else ""),
            by_motion(rows),
        )
        for level, rows in table.groupby("level", sort=False)
    ]
    systems = dict(histories)
    loops = [
        picture(f"Force over displacement, {bearing}; {case}", hysteresis(systems, bearing)),
        picture(f"Storeys; {case}", storey_profiles(systems)),
    ]
    loops += [
        picture(f"{device}, {bearing}; {case}", bearing_sections(data, bearing=bearing))
        for device, data in histories.items()
    ]
    return {"motions": motions, "loops": loops}
