"""A campaign as one HTML page: what was run, what failed and why, responses, fragility."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from frames.design.report.page import Picture, Table, page_table, page_template, picture
from frames.design.report.tables import in_mm_and_kn
from frames.plots import plot_style as ps
from frames.results.storage import csv_of, write_whole
from frames.risk._errors import FragilityError
from frames.risk.campaign.comparison import LIR
from frames.risk.campaign.plot_response import (
    failure_table,
    response_by_factor,
    response_table,
    runs_by_model,
)
from frames.risk.fragility.of_runs import fragility_of
from frames.risk.fragility.plot_fragility import fragility_curves, shown_intensity
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.risk.campaign.campaign import Campaign
    from frames.risk.campaign.comparison import DeviceComparison
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.intensity import Intensity
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns


class Fitted(NamedTuple):
    """Curves of a campaign."""

    runs: Mapping[str, IntensityRuns]  # by structure, over the measure of the curves
    by_factor: Mapping[str, IntensityRuns]  # the same over the factor on the motions
    limits: Sequence[LimitState]  # what was fitted
    curves: Mapping[str, Mapping[str, Fragility]]  # by limit state and structure
    table: pd.DataFrame  # a row a structure and limit state; "no curve" says why there is none


def compared(
    comparison: DeviceComparison, fitted: Fitted, confidence: float, axis: str, *, figures: bool
) -> dict[str, Any]:
    """Return what a campaign says of devices, by the names that the page has for it."""
    name = comparison.collapse.name
    why = {device: str(fitted.table.loc[f"{device}, {name}", "no curve"]) for device in fitted.runs}
    sizes = comparison.sizes(fitted.runs)
    tests = comparison.tests(fitted.runs, fitted.limits)
    ratios = comparison.ratios(fitted.curves, tests, confidence)
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
    return {
        "sizes": page_table(in_mm_and_kn(sizes), "device"),
        "ratios": _ratio_table(ratios),
        "margins": _margin_table(margins),
        "collapse": _collapse(comparison.collapse),
        "considered": _considered(comparison, fitted),
        "pictures": pictures,
        "files": {
            "devices": sizes,
            "ratios": ratios.set_index("limit state"),
            "margins": margins,
            "tests": tests.set_index("measure"),
        },
    }


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


CONFIDENCE = 0.9


def write_page(
    campaign: Campaign,
    path: Path,
    source: str,
    *,
    limits: Sequence[LimitState] = (),
    intensity: Intensity | None = None,
    scaled: Intensity | None = None,
    comparison: DeviceComparison | None = None,
    figures: bool = True,
) -> list[Path]:
    """Write what a campaign gave, as a page and tables beside it."""
    data = campaign.results()
    models = runs_by_model(data, campaign.motions)
    responses, failures = response_table(models), failure_table(models)
    asked = [*limits, *([] if comparison is None else [comparison.collapse])]
    measured = runs_by_model(data, campaign.motions, intensity) if asked else {}
    curves, fragility = _curves(measured, asked)
    axis = _axis(scaled)
    fitted = Fitted(measured, models, asked, curves, fragility)
    devices = None
    if comparison is not None:
        devices = compared(comparison, fitted, CONFIDENCE, axis, figures=figures)
    drawn = figures and devices is None
    page = page_template("campaign.html.j2", "frames.risk.campaign").render(
        name=campaign.store.path.name,
        status=campaign.status(),
        planned=page_table(_planned(campaign, data, axis), ""),
        failures=page_table(failures.set_index("structure"), "structure")
        if len(failures)
        else None,
        responses=[_in_words(in_mm_and_kn(one), f"{axis}, {n}") for n, one in _parts(responses)],
        fragility=page_table(fragility, "structure and limit state") if len(fragility) else None,
        compared=devices,
        confidence=f"{100.0 * CONFIDENCE:g} %",
        several_sets=campaign.sets > 1,
        response_pictures=_responses(models, axis) if drawn else [],
        fragility_pictures=_fragility(curves) if drawn else [],
        figures=figures,
        store=str(campaign.store.path),
        digest=campaign.digest(),
        model=next(iter(models)),
        source=source,
        written=f"{datetime.now(tz=UTC):%Y-%m-%d %H:%M} UTC, lir-dcfp {package_version()}",
    )
    tables = {
        "response": csv_of(responses, index=False),
        "failures": csv_of(failures, index=False),
    }
    if asked:
        tables["fragility"] = csv_of(fragility)
    if devices is not None:
        tables |= {name: csv_of(table) for name, table in devices["files"].items()}
    texts = {path: page}
    texts |= {path.with_name(f"{path.stem}-{name}.csv"): text for name, text in tables.items()}
    for file, text in texts.items():
        write_whole(file, text)
    return list(texts)


def _axis(scaled: Intensity | None) -> str:
    # What the factors on the motions are.
    return "factor on the motions" if scaled is None else f"{scaled.label} [{scaled.unit}]"


def _planned(campaign: Campaign, data: xr.Dataset, axis: str) -> pd.DataFrame:
    # What was run, in words.
    plan: dict[str, Any] = campaign.store.plan()
    rows = {
        "structures": ", ".join(plan["models"]),
        "motions": f"{len(plan['motions'])}: {', '.join(plan['motions'])}",
        axis: ", ".join(f"{scale:g}" for scale in plan["scales"]),
    }
    for name in plan["parameters"]:
        values = np.unique(data[name].to_numpy())
        rows[f"parameter {name}"] = (
            f"{len(values)} values, {values[0]:.4g} to {values[-1]:.4g} (SI)"
        )
    if sample := plan["provenance"].get("sample"):
        rows["sets of parameters"] = f"{campaign.sets}, {sample}"
    options = plan["options"]
    rows["level of fidelity"] = str(options["level"])
    for word, key in (("step [s]", "dt"), ("duration [s]", "duration")):
        if options[key] is not None:
            rows[word] = f"{options[key]:g}"
    rows["runs"] = f"{plan['runs']}, in batches of {plan['batch']}"
    rows["begun with"] = f"lir-dcfp {plan['program']}"
    return pd.DataFrame({"what was run": rows})


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


def _curves(
    models: Mapping[str, IntensityRuns], limits: Sequence[LimitState]
) -> tuple[dict[str, dict[str, Fragility]], pd.DataFrame]:
    # Curves by limit state and structure, and their table; where there is none it says why.
    found: dict[str, dict[str, Fragility]] = {}
    rows: dict[str, dict[str, object]] = {}
    for limit in limits:
        for name, runs in models.items():
            row: dict[str, object] = {}
            try:
                over = runs.exceeded(limit)
                known = ~np.isnan(over)
                row["exceeded"] = f"{int(over[known].sum())} of {int(known.sum())} runs"
                curve: Any = fragility_of(runs, limit, method="stripes")
            except (FragilityError, ImportError) as cause:
                rows[f"{name}, {limit.name}"] = row | {"no curve": str(cause)}
                continue
            found.setdefault(limit.name, {})[name] = curve
            interval = curve.interval(CONFIDENCE)
            for number in ("median", "dispersion"):
                unit = f" [{curve.unit}]" if number == "median" else " [-]"
                row[number + unit] = float(interval.loc[number, "value"])
                ends = (float(interval.loc[number, end]) for end in ("low", "high"))
                row[f"{number}, {100.0 * CONFIDENCE:g} %"] = " to ".join(f"{e:.3g}" for e in ends)
            rows[f"{name}, {limit.name}"] = row | {"no curve": ""}
    return found, pd.DataFrame.from_dict(rows, orient="index")


def _responses(models: Mapping[str, IntensityRuns], axis: str) -> list[Picture]:
    title = f"Responses over {axis}, and runs that failed"
    return [picture(title, response_by_factor(models, axis=axis))]


def _fragility(curves: Mapping[str, Mapping[str, Fragility]]) -> list[Picture]:
    return [
        picture(f"Probability of exceedance: {limit}", fragility_curves(dict(each)))
        for limit, each in curves.items()
    ]
