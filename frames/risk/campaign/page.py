"""A campaign as one HTML page: runs, failures with causes, responses, fragility."""

from __future__ import annotations

from datetime import UTC, datetime
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from frames.design.report.page import Picture, Table, page_table, page_template, picture
from frames.design.report.tables import in_mm_and_kn
from frames.plots import plot_style as ps
from frames.results.storage import csv_of, write_whole
from frames.risk.campaign.ductility import DUCTILITY
from frames.risk.campaign.plot_response import response_by_factor
from frames.risk.campaign.tables import CONFIDENCE
from frames.risk.fragility.plot_fragility import draw_curve, fragility_curves, shown_intensity
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from matplotlib.figure import Figure

    from frames.risk.campaign.comparison import DeviceComparison
    from frames.risk.campaign.tables import CampaignTables
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns


def compared(
    comparison: DeviceComparison, tables: CampaignTables, *, figures: bool
) -> dict[str, Any]:
    """Return the comparison of devices of a campaign, by the names on the page."""
    drawn = comparison_figures(tables).items() if figures else ()
    pictures = [picture(f"{TITLES[kind]}, {group}", draw()) for (kind, group), draw in drawn]
    return {
        "sizes": page_table(in_mm_and_kn(tables.devices), "device"),
        "ratios": _ratio_table(tables.ratios),
        "margins": _margin_table(tables.margins),
        "collapse": _collapse(comparison.collapse),
        "considered": _considered(comparison, tables),
        "pictures": pictures,
        "own": bool(tables.file.devices),
    }


TITLES = {"fragility": "Fragility", "response": "Responses and runs that failed"}


def comparison_figures(tables: CampaignTables) -> dict[tuple[str, str], Callable[[], Figure]]:
    """Return functions that draw compared devices, by kind of `TITLES` and group."""
    comparison = tables.comparison
    groups = {"": list(tables.runs)} if comparison is None else comparison.groups
    found: dict[tuple[str, str], Callable[[], Figure]] = {}
    for group, devices in groups.items():
        found["fragility", group] = partial(
            device_curves,
            {device: tables.runs[device] for device in devices},
            tables.curves,
            tables.limits,
            confidence=CONFIDENCE,
            considered=None if comparison is None else comparison.considered,
        )
        by_factor = {device: tables.by_factor[device] for device in devices}
        found["response", group] = partial(response_by_factor, by_factor, axis=tables.axis)
    return found


def _fragility_table(fragility: pd.DataFrame) -> Table:
    # A row a structure and limit state, numbers with their intervals.
    words = pd.DataFrame({"exceeded": _of_runs(fragility)}, index=fragility.index)
    for name in ("median", "dispersion"):
        for column in [c for c in fragility.columns if str(c).startswith(f"{name} [")]:
            words[column] = _with_ends(fragility, str(column), ".3g")
    words["no curve"] = fragility["no curve"]
    names = fragility["structure"] + ", " + fragility["limit state"]
    if "record set" in fragility:
        names += ", " + fragility["record set"] + " records"
    return page_table(words.set_index(pd.Index(names)), "structure and limit state")


def _of_runs(fragility: pd.DataFrame) -> list[str]:
    pairs = zip(fragility["exceeded"], fragility["known"], strict=True)
    return ["" if pd.isna(over) else f"{over:.0f} of {known:.0f} runs" for over, known in pairs]


def _with_ends(table: pd.DataFrame, column: str, form: str) -> list[str]:
    # Numbers with their intervals.
    name, unit = column.split(" [", 1)
    ends = [table[f"{name}, {end} [{unit}"] for end in ("low", "high")]
    return [
        "" if pd.isna(value) else f"{value:{form}} ({low:{form}} to {high:{form}})"
        for value, low, high in zip(table[column], *ends, strict=True)
    ]


def _ratio_table(ratios: pd.DataFrame) -> Table:
    # A row rims and limit state, a column another device, in words.
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for _, row in ratios.iterrows():
        said = str(row["verdict"])
        if row["no ratio"]:
            said = f"{said}; {row['no ratio']}"
        else:
            ends = f"({row['low [-]']:.2f} to {row['high [-]']:.2f})"
            said = f"{said}, {row['ratio [-]']:.2f} {ends}"
        said = f"{said}; {row['less']} to {row['more']} records"
        over, where = str(row["over"]).removesuffix(f", {row['rims']}"), str(row["rims"])
        if "structure" in row:
            over = over.removeprefix(f"{row['structure']}, ")
            where = f"{row['structure']}, {where}"
        records = f", {row['record set']} records" if "record set" in row else ""
        place = (f"{where}{records}", row["limit state"])
        rows.setdefault(place, {})[f"over {over}"] = said
    words = pd.DataFrame(list(rows.values()))
    words.insert(0, "limit state", [limit for _, limit in rows])
    return page_table(words.set_index(pd.Index([rims for rims, _ in rows])), "group")


def _margin_table(margins: pd.DataFrame) -> Table:
    # Numbers with their intervals in one cell; without a curve why there is none.
    counts = ["runs", "collapsed", "bearing failed", "analysis failed"]
    words = margins[[*(["record set"] if "record set" in margins else []), *counts]].copy()
    for name in [str(c) for c in margins.columns if str(c).startswith(("median [", "margin ["))]:
        words[name] = _with_ends(margins, name, ".2f")
    if "dispersion [-]" in margins:
        words["dispersion [-]"] = [
            "" if pd.isna(value) else f"{value:.2f}" for value in margins["dispersion [-]"]
        ]
    if (margins["no curve"] != "").any():
        words["no curve"] = margins["no curve"]
    return page_table(words, "device")


def _indices(indices: pd.DataFrame) -> Table:
    # Total indices with their intervals, a row a structure, factor and parameter.
    rows: dict[str, dict[str, str]] = {}
    for _, row in indices.iterrows():
        name = f"{row['structure']}, {row['factor']:.4g}"
        if row["no index"]:
            rows.setdefault(name, {})[str(row["quantity"])] = str(row["no index"])
            continue
        ends = f"{row['total, low [-]']:.2f} to {row['total, high [-]']:.2f}"
        value = row["total [-]"]
        said = f"not known ({ends})" if pd.isna(value) else f"{value:.2f} ({ends})"
        place = f"{name}: {row['parameter']}, of the {row['share of']}"
        rows.setdefault(place, {})[str(row["quantity"])] = said
    table = pd.DataFrame.from_dict(rows, orient="index").fillna("")
    return page_table(table, "structure, factor on the motions, parameter")


def _losses(tables: CampaignTables, *, figures: bool) -> dict[str, Any]:
    # Losses by the names on the page: numbers with their intervals in one cell, in per cent.
    annual, loss = tables.annual_loss, tables.loss
    keys = [name for name in ("hazard", "structure") if name in annual]
    first = annual["structure"].iloc[0]
    annual = annual.set_index(annual[keys].agg(", ".join, axis=1)).drop(columns=keys)
    words = pd.DataFrame({"loss a year [%]": _with_ends(100.0 * annual, LOSS, ".3g")}, annual.index)
    parts = [str(c) for c in annual.columns if str(c).endswith(" [1/year]")]
    for name in [each for each in parts if not each.startswith("loss")]:
        words[f"of it {name.removesuffix(' [1/year]')} [%]"] = 100.0 * annual[name] / annual[LOSS]
    if "ratio [-]" in annual:
        words[f"{first} over it"] = _with_ends(annual, "ratio [-]", ".2f")
    for name in ("below [-]", "above [-]"):
        words[name.replace("[-]", "what was run [%]")] = 100.0 * annual[name]
    im = str(loss.columns[1])
    curves = pd.DataFrame(
        {
            str(name): pd.Series(_with_ends(100.0 * own.iloc[:, 2:], "loss [-]", ".3g"), own[im])
            for name, own in loss.groupby("structure", sort=False)
        }
    )
    return {
        "annual": page_table(words, " and ".join(keys)),
        "curves": page_table(curves, tables.axis),
        "pictures": [picture("Expected loss", loss_curves(loss, tables.axis))] if figures else [],
        "unknown": int(loss["unknown"].sum()),
        "beyond": annual.index[annual["above [-]"] > BEYOND].tolist(),
    }


LOSS = "loss [1/year]"
BEYOND = 0.1
"""Share of the annual loss that may come from above the highest intensity without a word [-]."""


def loss_curves(loss: pd.DataFrame, axis: str) -> Figure:
    """Draw expected losses of structures over the intensity, those of collapse and of repair."""
    figure = ps.new_figure(3.2)
    (panels,) = ps.grid_of(figure, 1, 3, share_x=True, share_y=True)
    im = str(loss.columns[1])
    for k, (name, own) in enumerate(loss.groupby("structure", sort=False)):
        look, at = ps.line_of(k), own[im]
        low, high = 100.0 * own["loss, low [-]"], 100.0 * own["loss, high [-]"]
        panels[0].fill_between(at, low, high, alpha=0.15, color=look["color"], linewidth=0.0)
        whole, down = own["loss [-]"], own["collapse [-]"]
        for panel, values in zip(panels, (whole, down, whole - down), strict=True):
            panel.plot(
                at, 100.0 * values, label=str(name), marker=MARKERS[k % 8], markersize=3.0, **look
            )
    titles = "expected loss", "of it collapse", "of it repair"
    for panel, title in zip(panels, titles, strict=True):
        panel.set_ylim(0.0, 102.0)
        ps.caption(panel, title=title, x=axis)
    ps.caption(panels[0], y="of a new building [%]")
    ps.add_legend(figure, panels[0].get_lines(), columns=2)
    return figure


def _collapse(limit: LimitState) -> str:
    found = "Collapse is failure of a bearing"
    if limit.limit is None:
        return found
    if limit.quantity == DUCTILITY:
        return f"{found}, or a ductility of a plastic hinge above {limit.limit:g}"
    return f"{found}, or a storey drift above {100.0 * limit.limit:g} %"


def _considered(comparison: DeviceComparison, tables: CampaignTables) -> str:
    measure = next(iter(tables.runs.values())).intensity
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


MARKERS = "os^dvP*X"
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
                draw_curve(panel, curve, at, factor, ps.line_of(k), confidence)
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


def write_page(
    tables: CampaignTables, path: Path, source: str, *, figures: bool = True
) -> list[Path]:
    """Write the results of a campaign, as a page and tables beside it."""
    campaign, models = tables.campaign, tables.by_factor
    failures, fragility = tables.failures, tables.fragility
    devices = None
    if tables.comparison is not None:
        devices = compared(tables.comparison, tables, figures=figures)
    drawn = figures and devices is None
    page = page_template("campaign.html.j2", "frames.risk.campaign").render(
        name=campaign.store.path.name,
        status=campaign.status(),
        planned=page_table(tables.plan, ""),
        failures=page_table(failures.set_index("structure"), "structure")
        if len(failures)
        else None,
        responses=[
            (name, _in_words(in_mm_and_kn(one), tables.axis))
            for name, one in _parts(tables.response)
        ],
        fragility=_fragility_table(fragility) if len(fragility) else None,
        compared=devices,
        indices=_indices(tables.indices) if len(tables.indices) else None,
        losses=_losses(tables, figures=figures) if len(tables.loss) else None,
        confidence=f"{100.0 * CONFIDENCE:g} %",
        several_sets=campaign.sets > 1,
        response_pictures=_responses(models, tables.axis) if drawn else [],
        fragility_pictures=_fragility(tables.curves) if drawn else [],
        figures=figures,
        store=str(campaign.store.path),
        digest=campaign.digest(),
        model=next(iter(models)),
        source=source,
        written=f"{datetime.now(tz=UTC):%Y-%m-%d %H:%M} UTC, lir-dcfp {package_version()}",
    )
    texts = {path: page}
    for name, table in tables.all().items():
        text = csv_of(table, index=table.index.name is not None)
        texts[path.with_name(f"{path.stem}-{name}.csv")] = text
    for file, text in texts.items():
        write_whole(file, text)
    return list(texts)


def _in_words(response: pd.DataFrame, name: str) -> Table:
    # An infinite demand is that of a bearing that failed.
    table = page_table(response, name)
    rows = [["failed" if cell == "inf" else cell for cell in row] for row in table.rows]
    return table._replace(rows=rows)


def _parts(responses: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    return [
        (str(name), one.drop(columns="structure").set_index("factor"))
        for name, one in responses.groupby("structure", sort=False)
    ]


def _responses(models: Mapping[str, IntensityRuns], axis: str) -> list[Picture]:
    title = f"Responses over {axis}, and runs that failed"
    return [picture(title, response_by_factor(models, axis=axis))]


def _fragility(curves: Mapping[str, Mapping[str, Fragility]]) -> list[Picture]:
    return [
        picture(f"Probability of exceedance: {limit}", fragility_curves(dict(each)))
        for limit, each in curves.items()
    ]
