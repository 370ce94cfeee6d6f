"""A comparison of two devices as one HTML page and tables."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from frames.design.calculation.rendering import quantity, usual_unit
from frames.design.project.comparison import BY_MOTION, OURS, PLAIN
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

    from frames.design.project.comparison import Comparison, RunCounts


ALIKE = 0.02
"""Difference of two numbers over the larger up to which they count as equal [-]."""

PRICE = tuple(DEMANDS[name].demand for name in ("slip", "slip_left"))
"""Demands that a rigid slider cannot have: the price of the slider in two pieces."""

MAIN = [
    "displacement",
    "displacement_left",
    "rim_force",
    "gap",
    "base_shear",
    "drift",
    "floor_plan",
]
"""Demands that decide which device is called better: tables have the others as well."""


_LEAST_SLIP = 1e-4  # m: the elastic displacement of an interface that holds is less


class Verdict(NamedTuple):
    """Conclusion from the numbers of one level of the seismic action."""

    level: str  # level of the seismic action
    head: str  # the verdict in a sentence
    # True if the LIR-DCFP is the better device; None if neither is, or the numbers do not decide
    is_ours: bool | None
    details: tuple[str, ...]  # sentences with the numbers


def verdicts(found: Comparison) -> list[Verdict]:
    """Return the conclusions at each level of the seismic action."""
    return [_verdict(found, level) for level in found.levels]


def _verdict(found: Comparison, level: str) -> Verdict:
    ours, plain = (_at(found.demands[device], level) for device in (OURS, PLAIN))
    counts = {device: found.counts(device, level) for device in (OURS, PLAIN)}
    void = {device: why for device in (OURS, PLAIN) if (why := found.void(device, level))}
    details = _of_runs(counts)
    if void:
        details += [f"{device}, no values for design: {why}." for device, why in void.items()]
        details.append("Values of these runs are the largest before they stopped.")
        better = None if len(void) == 2 else PLAIN in void
        return Verdict(level, _head_of_failures(counts, void), better, tuple(details))
    lower, higher, alike = _sorted(ours, plain)
    for words, names in (("lower", lower), ("higher", higher)):
        if names:
            listed = "; ".join(_numbers(name, ours, plain) for name in names)
            details.append(f"With the {OURS} {words}: {listed}.")
    if alike:
        details.append(f"Equal within {100.0 * ALIKE:g} %: {', '.join(alike)}.")
    if price := _price(ours):
        details.append(price)
    if not any(each.met for each in counts.values()):
        text = (
            "No run reaches a restraining rim. The two devices behave equally under these "
            f"motions, and a plain {PLAIN} has fewer parts than the {OURS}."
        )
        return Verdict(level, text, False, tuple(details))
    head, is_ours = _head(lower, higher)
    return Verdict(level, head, is_ours, tuple(details))


def _head(lower: list[str], higher: list[str]) -> tuple[str, bool | None]:
    under = "Under these motions"
    if lower and not higher:
        return (
            f"{under} no governing demand is higher with the {OURS}, and at least one is lower.",
            True,
        )
    if higher and not lower:
        text = f"{under} the plain {PLAIN} is the better device: no governing demand is higher"
        return f"{text}, and its slider has no interface to maintain.", False
    if not lower:
        return (
            f"{under} the demands of both devices are equal; the plain {PLAIN} is simpler.",
            False,
        )
    text = (
        f"Neither device is better in every demand: with the {OURS} {_joined(lower)} {_are(lower)} "
        f"lower, {_joined(higher)} {_are(higher)} higher. The designer decides which counts more."
    )
    return text, None


def _head_of_failures(counts: Mapping[str, RunCounts], void: Mapping[str, str]) -> str:
    if len(void) == 2:
        return "No verdict: neither device has values for design."
    device = next(iter(void))
    runs, _, stopped, _ = counts[device]
    why = f"{stopped} of its {runs} runs stopped" if stopped else "its runs may not count"
    other = PLAIN if device == OURS else OURS
    return (
        f"Only the {other} has values for design: of the {device} {why}. The {device} is not shown "
        "to withstand these motions."
    )


def _sorted(ours: pd.DataFrame, plain: pd.DataFrame) -> tuple[list[str], list[str], list[str]]:
    # Names of the demands that are lower with the LIR-DCFP, higher, and equal.
    lower: list[str] = []
    higher: list[str] = []
    alike: list[str] = []
    for name in (DEMANDS[key].demand for key in MAIN if DEMANDS[key].demand in ours.index):
        one, two = float(ours.loc[name, "envelope"]), float(plain.loc[name, "envelope"])
        if math.isnan(one) or math.isnan(two):
            continue
        if abs(one - two) <= ALIKE * max(abs(one), abs(two)):
            if max(abs(one), abs(two)) > 0.0:
                alike.append(name)
        else:
            (lower if one < two else higher).append(name)
    return lower, higher, alike


def _numbers(name: str, ours: pd.DataFrame, plain: pd.DataFrame) -> str:
    unit = str(ours.loc[name, "unit"])
    one, two = float(ours.loc[name, "envelope"]), float(plain.loc[name, "envelope"])
    change = f", {100.0 * (one / two - 1.0):+.0f} %" if two else ""
    return f"{name} {_shown(name, one, unit)} against {_shown(name, two, unit)}{change}"


def _price(ours: pd.DataFrame) -> str:
    slip, stays = (
        float(ours.loc[name, "envelope"]) if name in ours.index else math.nan for name in PRICE
    )
    if not slip > _LEAST_SLIP:
        return ""
    rest = "" if math.isnan(stays) else f", of which {_shown(PRICE[1], stays, 'm')} stay"
    return (
        f"In return the interface slips by {_shown(PRICE[0], slip, 'm')}{rest}; inspect and "
        "re-centre the sliders after the earthquake."
    )


def _of_runs(counts: Mapping[str, RunCounts]) -> list[str]:
    met = (f"with the {name} in {each.met} of {each.runs}" for name, each in counts.items())
    found = [f"Rim contact occurs {', '.join(met)} runs."]
    for name, each in counts.items():
        if each.stopped:
            found.append(
                f"Of the {name} {each.stopped} of {each.runs} runs stopped before their end."
            )
        if each.doubtful:
            found.append(
                f"Of the {name} {each.doubtful} of {each.runs} runs have a warning of the check of "
                "modelling assumptions: their values may be wrong; see the report of `lir run`."
            )
    return found


def _at(demands: pd.DataFrame, level: str) -> pd.DataFrame:
    return demands[demands["level"] == level]


def _shown(name: str, value: float, unit: str) -> str:
    if "drift" in name:
        return f"{100.0 * value:.3g} %"
    return quantity(value, unit, "mm" if unit == "m" else usual_unit(unit))


def _joined(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _are(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"


def write_comparison(
    found: Comparison,
    folder: Path,
    source: str,
    histories: tuple[Mapping[str, xr.Dataset], str, str] | None,
) -> list[Path]:
    """Write the results of a comparison of two devices."""
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
    """Draw the peaks of each motion with each device, the largest over the bounds."""
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
    """Return the figures of a comparison by their section."""
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
