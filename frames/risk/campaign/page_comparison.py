"""Part of a campaign's page that compares devices: sizes, ratios of medians, margins, figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pandas as pd

from frames.design.report.page import Picture, Table, page_table, picture
from frames.design.report.tables import in_mm_and_kn
from frames.risk.campaign.compared_devices import LIR
from frames.risk.campaign.plot_comparison import device_curves
from frames.risk.campaign.plot_response import response_by_factor

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

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
