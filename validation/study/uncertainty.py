"""Modelling uncertainty of LIR-DCFP and DCFP: writes docs/validation/study_uncertainty.md.

    python -m validation.study.uncertainty --store uncertainty-runs

The campaigns can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk import open_campaign
from frames.risk.fragility.runs import COMPLETE, FAILURE, outcome_of
from validation.study.capacities import bounds_of, draws, fitted, interval
from validation.study.part import performed, run_part, write_part
from validation.study.records_runs import (
    COLLAPSE,
    ULTIMATE,
    considered,
    ductilities,
    normalised,
    runs_of,
    stripes_of,
)
from validation.study.rounded import csv_of, rounded
from validation.study.uncertainty_page import WHAT, figures, page
from validation.study.uncertainty_runs import (
    BEST,
    PAIR,
    RECORD,
    SAMPLES,
    SPREADS,
    best_campaign,
    elastic_campaign,
    record_of,
    sampled,
    sets_of,
    stiffness_campaign,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import GroundMotion
    from frames._types import FloatArray

NAME = "study_uncertainty"
RECORDS = "far-field"
DRAWS = 300
RIMS = {"stiffness": stiffness_campaign, "elastic": elastic_campaign, "best": best_campaign}
"""Campaigns over the stiffness of rims, by the folders of their stores."""


def study(motions: Mapping[str, GroundMotion], store: Path, workers: int | str) -> dict[str, Any]:
    """Run the campaigns, and return what the page says of them."""
    sets, results, costs = sets_of(), [], []
    (store / "sample").mkdir(parents=True, exist_ok=True)
    for numbers, runs in sampled(motions, store / "sample", sets):
        costs.append(performed(runs, workers))
        results.append((numbers, runs.results()))
    tables = table_of(results, SAMPLES)
    digests = {"sample": hashlib.sha256("".join(c["digest"] for c in costs).encode()).hexdigest()}
    for name, make in RIMS.items():
        costs.append(performed(make(motions, store / name), workers))
        digests[name] = costs[-1]["digest"]
    data = {name: open_campaign(store / name).results() for name in RIMS}
    stiff = stiffness_of([*data.values()], motions, DRAWS)
    ran = [*(each for _, each in results), *data.values()]
    return {
        "records": len(motions),
        "shares": shares_of(tables, DRAWS),
        "effects": effects_of(tables, sets, len(motions), DRAWS),
        "collapsed": {
            name: float((values[~np.isnan(values)] >= np.log(ULTIMATE) - 1e-9).mean())
            for name, values in tables.items()
        },
        "stiffness": stiff,
        "cost": costs[-1]
        | {
            "runs": sum(each["runs"] for each in costs),
            "loop": sum(float(each["seconds_loop"].sum()) for each in ran),
            "digests": digests,
        },
    }


def write(found: Mapping[str, Any]) -> None:
    """Write the page, its figures, tables and the numbers."""
    rows = [
        {"result": text, "index": kind, "property": key}
        | dict(zip(("value [-]", "low", "high"), values, strict=True))
        for name, text in WHAT.items()
        for kind in ("first", "total")
        for key, values in found["shares"][name][kind].items()
    ]
    margins = [
        dict(zip(("device", "stiffness over default [-]"), key.split("|"), strict=True))
        | dict(zip(("collapse margin [-]", "low", "high"), values, strict=True))
        for key, values in found["stiffness"]["margins"].items()
    ]
    tables = {f"{NAME}-indices.csv": csv_of(rows), f"{NAME}-margins.csv": csv_of(margins)}
    write_part(NAME, page(found), figures(found), found, tables)


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done under the records, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    found: dict[str, Any] = rounded(study(motions, store, workers))
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("uncertainty", given, run, write)


def capped(data: xr.Dataset) -> FloatArray:
    """Return the logarithm of each run's ductility, that of collapse at most; NaN where unknown."""
    outcome = np.array([outcome_of(str(each)) for each in data["status"].to_numpy()])
    reached = np.where(outcome == FAILURE, ULTIMATE, ductilities(data))
    known = np.isin(outcome, [COMPLETE, FAILURE])
    return np.where(known, np.log(np.minimum(reached, ULTIMATE)), np.nan)


def table_of(
    results: Sequence[tuple[Sequence[int], xr.Dataset]], samples: int
) -> dict[str, FloatArray]:
    """Return the results of the sample, by device."""
    count = samples * (len(SPREADS) + 2)
    found = {name: np.full(count, np.nan) for name in PAIR}
    for numbers, data in results:
        values, model = capped(data), data["model"].to_numpy()
        for name in PAIR:
            found[name][np.asarray(numbers)] = values[model == name]
    return {name: values.reshape(-1, samples) for name, values in found.items()}


def indices(table: FloatArray) -> FloatArray:
    """Return first and total indices (2, d) of results (d + 2, n), for any n: Saltelli (2010)."""
    a, b, mixed = table[0], table[1], table[2:]
    both = np.concatenate([a, b])
    variance = both.var()
    first = ((b - both.mean()) * (mixed - a)).mean(axis=1) / variance
    total = 0.5 * ((a - mixed) ** 2).mean(axis=1) / variance
    return np.array([first, total])


def shares_of(tables: Mapping[str, FloatArray], resamples: int) -> dict[str, Any]:
    """Return first and total Sobol' indices, of both devices and of their difference."""
    whole = dict(tables) | {"ratio": tables["LIR-DCFP"] - tables["DCFP"]}
    found: dict[str, Any] = {}
    for name, values in whole.items():
        kept = values[:, ~np.isnan(values).any(axis=0)]
        drawn = draws(kept.shape[1], resamples)
        again = np.array([indices(kept[:, rows]) for rows in drawn])
        once = indices(kept)
        found[name] = {
            kind: {
                key: [float(once[k, n]), *interval(again[:, k, n].tolist())]
                for n, key in enumerate(SPREADS)
            }
            for k, kind in enumerate(("first", "total"))
        } | {
            "mean": float(kept[:2].mean()),
            "deviation": float(kept[:2].std(ddof=1)),
            "left out": int(values.shape[1] - kept.shape[1]),
        }
    return found


def effects_of(
    tables: Mapping[str, FloatArray],
    sets: Sequence[Mapping[str, float]],
    count: int,
    resamples: int,
) -> dict[str, Any]:
    """Return what a property changes from its fractile of 16 % to that of 84 %, on average."""
    names = [name for name in SPREADS if name != RECORD]
    shares = np.array([[float(SPREADS[n].cdf(each[n])) for n in names] for each in sets])
    record = np.array([record_of(each, count) for each in sets])
    whole = dict(tables) | {"ratio": tables["LIR-DCFP"] - tables["DCFP"]}
    found: dict[str, Any] = {}
    blocks = np.arange(len(sets)).reshape(next(iter(whole.values())).shape)
    every = np.arange(blocks.shape[1])
    drawn = draws(len(every), resamples)
    for name, table in whole.items():
        y = table.ravel()

        def slopes(columns: FloatArray, y: FloatArray = y) -> FloatArray:
            rows = blocks[:, columns].ravel()
            rows = rows[~np.isnan(y[rows])]
            own = record[rows]
            number = np.maximum(np.bincount(own, minlength=count), 1)
            # each record about its own means: its constant is gone
            both = np.column_stack([shares[rows], y[rows]])
            means = np.array([np.bincount(own, column, count) / number for column in both.T]).T
            both = both - means[own]
            return np.asarray(np.linalg.lstsq(both[:, :-1], both[:, -1], rcond=None)[0])

        once, again = 0.68 * slopes(every), 0.68 * np.array([slopes(rows) for rows in drawn])
        found[name] = {
            key: [float(once[k]), *interval(again[:, k].tolist())] for k, key in enumerate(names)
        }
    return found


def stiffness_of(
    results: Sequence[xr.Dataset], motions: Mapping[str, GroundMotion], resamples: int
) -> dict[str, Any]:
    """Return collapse margins by device and stiffness of the rims, and their ratios."""
    records, at = list(motions), considered()
    drawn = draws(len(records), resamples)
    found: dict[str, Any] = {"margins": {}, "failed": {}, "collapse": {}, "ratios": {}}
    again: dict[str, FloatArray] = {}
    named = {str(name): data for data in results for name in data["model"].to_numpy()}
    for name, data in named.items():
        runs = runs_of(data, motions, name)
        bounds = bounds_of(runs, COLLAPSE, records)
        again[name] = np.array([fitted(bounds[rows]).median() / at for rows in drawn])
        found["margins"][name] = [fitted(bounds).median() / at, *interval(again[name].tolist())]
        failed = runs.table.assign(f=runs.table["outcome"] == FAILURE).groupby("im")["f"].mean()
        found["failed"][name] = failed.round(4).tolist()
        found["collapse"][name] = [row[1] / row[2] for row in stripes_of(runs, COLLAPSE)]
    for name in again:
        device_, share = name.split("|")
        ours_ = f"{BEST}|{share}"
        if device_ != BEST:
            found["ratios"][name] = [
                found["margins"][ours_][0] / found["margins"][name][0],
                *interval((again[ours_] / again[name]).tolist()),
            ]
    return found


if __name__ == "__main__":
    main()
