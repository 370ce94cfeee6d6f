"""A campaign as one HTML page: what was run, what failed and why, responses, fragility."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.design.report.page import Picture, Table, page_table, page_template, picture
from frames.design.report.tables import in_mm_and_kn
from frames.results.storage import csv_of, write_whole
from frames.risk._errors import FragilityError
from frames.risk.campaign.page_comparison import Fitted, compared
from frames.risk.campaign.plot_response import (
    failure_table,
    response_by_factor,
    response_table,
    runs_by_model,
)
from frames.risk.fragility.of_runs import fragility_of
from frames.risk.fragility.plot_fragility import fragility_curves
from lir_element._version import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames.risk.campaign.campaign import Campaign
    from frames.risk.campaign.comparison import DeviceComparison
    from frames.risk.fragility.curve import Fragility
    from frames.risk.fragility.intensity import Intensity
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns

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
        tables |= {name: csv_of(table) for name, table in devices.files.items()}
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
