"""Part of a campaign's page that compares devices: sizes, ratios of medians, margins, figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from frames.design.report.page import Picture, Table, page_table, picture
from frames.design.report.tables import in_mm_and_kn
from frames.plots import plot_style as ps
from frames.risk.campaign.comparison import LIR
from frames.risk.campaign.plot_response import response_by_factor
from frames.risk.fragility.plot_fragility import shown_intensity

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.risk.campaign.comparison import DeviceComparison
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns


class Compared(NamedTuple):
    """What the page says of devices."""

    sizes: Table  # as the page has them
    ratios: Table
    margins: Table
    collapse: str  # what counts as collapse, in words
    considered: str  # the maximum considered earthquake, in words
    pictures: list[Picture]  # a figure of curves and one of responses for each kind of rims
    files: dict[str, pd.DataFrame]  # tables in SI units, by the end of their name


class Fitted(NamedTuple):
    """Curves of a campaign."""

    runs: Mapping[str, IntensityRuns]  # by structure, over the measure of the curves
    by_factor: Mapping[str, IntensityRuns]  # the same over the factor on the motions
    limits: Sequence[LimitState]  # what was fitted
    curves: Mapping[str, Mapping[str, Fragility]]  # by limit state and structure
    table: pd.DataFrame  # a row a structure and limit state; "no curve" says why there is none


def compared(
    comparison: DeviceComparison, fitted: Fitted, confidence: float, axis: str, *, figures: bool
) -> Compared:
    """Return what a campaign says of devices."""
    name = comparison.collapse.name
    why = {device: str(fitted.table.loc[f"{device}, {name}", "no curve"]) for device in fitted.runs}
    sizes = comparison.sizes(fitted.runs)
    ratios = comparison.ratios(fitted.curves, confidence)
    own = fitted.curves.get(name, {})
    margins = comparison.margins(fitted.runs, own, why, confidence)
    pictures = []
    for rims, devices in comparison.groups.items() if figures else ():
        runs = {device: fitted.runs[device] for device in devices}
        drawn = device_curves(
            runs,
            fitted.curves,
            fitted.limits,
            confidence=confidence,
            considered=comparison.considered,
        )
        pictures.append(picture(f"Fragility, {rims}", drawn))
        by_factor = {device: fitted.by_factor[device] for device in devices}
        title = f"Responses and runs that failed, {rims}"
        pictures.append(picture(title, response_by_factor(by_factor, axis=axis)))
    return Compared(
        page_table(in_mm_and_kn(sizes), "device"),
        _ratio_table(ratios),
        _margin_table(margins),
        _collapse(comparison.collapse),
        _considered(comparison, fitted),
        pictures,
        {"devices": sizes, "ratios": ratios.set_index("limit state"), "margins": margins},
    )


def _ratio_table(ratios: pd.DataFrame) -> Table:
    # A row rims and limit state, a column another device, in words.
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for _, row in ratios.iterrows():
        said = str(row["verdict"])
        if not pd.isna(row["ratio [-]"]):
            ends = f"({row['low [-]']:.2f} to {row['high [-]']:.2f})"
            said = f"{said}, {row['ratio [-]']:.2f} {ends}"
        over = str(row["over"]).split(",", maxsplit=1)[0]
        rows.setdefault((row["rims"], row["limit state"]), {})[f"over {over}"] = said
    words = pd.DataFrame(list(rows.values()))
    words.insert(0, "limit state", [limit for _, limit in rows])
    return page_table(words.set_index(pd.Index([rims for rims, _ in rows])), f"{LIR} with")


def _margin_table(margins: pd.DataFrame) -> Table:
    # Numbers with their intervals in one cell; without a curve why there is none.
    words = margins[["runs", "collapsed", "bearing failed", "analysis failed"]].copy()
    for name in [str(c) for c in margins.columns if str(c).startswith(("median [", "margin ["))]:
        word, unit = name.split(" ", 1)
        ends = [margins[f"{word}, {end} {unit}"] for end in ("low", "high")]
        words[name] = [
            "" if pd.isna(value) else f"{value:.2f} ({low:.2f} to {high:.2f})"
            for value, low, high in zip(margins[name], *ends, strict=True)
        ]
    if "dispersion [-]" in margins:
        words["dispersion [-]"] = [
            "" if pd.isna(value) else f"{value:.2f}" for value in margins["dispersion [-]"]
        ]
    if (margins["no curve"] != "").any():
        words["no curve"] = margins["no curve"]
    return page_table(words, "device")


def _collapse(limit: LimitState) -> str:
    if limit.limit is None:
        return "Collapse is failure of a bearing"
    return f"Collapse is failure of a bearing, or a storey drift above {100.0 * limit.limit:g} %"


def _considered(comparison: DeviceComparison, fitted: Fitted) -> str:
    measure = next(iter(fitted.runs.values())).intensity
    if comparison.considered is None:
        return (
            "There are no margins, for no maximum considered earthquake is known: "
            "maximum_considered under [compare], or [fragility] with Sa, gives it."
        )
    whose = (
        "that fills the capacity of the bearing: its displacement by ASCE 7-22 (17.5-1) is the "
        "capacity"
        if comparison.filling
        else "of the file"
    )
    value = f"{measure.label} = {comparison.considered:.3g} {measure.unit}"
    return f"The maximum considered earthquake is the one {whose}, {value}."


MARKERS = "os^d"
POINTS = 80


def device_curves(
    runs: Mapping[str, IntensityRuns],
    curves: Mapping[str, Mapping[str, Fragility]],
    limits: Sequence[LimitState],
    *,
    confidence: float,
    considered: float | None = None,
) -> Figure:
    """Draw the fragility of devices, a panel a limit state."""
    measure = next(iter(runs.values())).intensity
    factor, label = shown_intensity(measure.unit, measure.label)
    top = 1.05 * max(float(each.of("im").max()) for each in runs.values())
    at = np.linspace(top / POINTS, top, POINTS)
    figure, panels = ps.panels_of(len(limits), min(3, len(limits)), 2.3, share=False)
    for panel, limit in zip(panels, limits, strict=True):
        for k, (name, each) in enumerate(runs.items()):
            curve = curves.get(limit.name, {}).get(name)
            if curve is not None:
                _curve(panel, curve, at, factor, k, confidence)
            im, shares = shares_exceeded(each, limit)
            color = ps.PALETTE[k]
            panel.plot(factor * im, shares, MARKERS[k], markersize=3.0, color=color)
        if considered is not None:
            panel.axvline(factor * considered, color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_xlim(0.0, factor * top)
        panel.set_ylim(0.0, 1.02)
        ps.caption(panel, x=label, title=limit.name)
    for panel in panels[:: min(3, len(limits))]:
        ps.caption(panel, y="probability [-]")
    handles = [
        Line2D([], [], label=name, marker=MARKERS[k], markersize=3.0, **ps.line_of(k))
        for k, name in enumerate(runs)
    ]
    said = "Dotted: maximum considered earthquake" if considered is not None else ""
    ps.add_legend(figure, handles, columns=2, title=said)
    return figure


def shares_exceeded(runs: IntensityRuns, limit: LimitState) -> tuple[np.ndarray, np.ndarray]:
    """Return the intensities of runs, and the share at each that exceeds a limit state."""
    each = {im: own.exceeded(limit) for (im,), own in runs.by("im").items()}
    found = np.array(sorted(each))
    known = [each[im][~np.isnan(each[im])] for im in found.tolist()]
    return found, np.array([own.mean() if len(own) else np.nan for own in known])


def _curve(
    panel: Axes, curve: Fragility, at: np.ndarray, factor: float, k: int, confidence: float
) -> None:
    table, look = curve.to_dataframe(at, confidence), ps.line_of(k)
    panel.fill_between(
        factor * at, table["low"], table["high"], alpha=0.15, color=look["color"], linewidth=0.0
    )
    panel.plot(factor * at, table["probability"], **look)
