"""Records and devices of the study of loss: runs, spectral shape, loss and rates in plain numbers."""

from __future__ import annotations

import json
import warnings
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import Recording, floor_spectrum, time_history
from frames.risk import (
    Campaign,
    FragilityError,
    HazardCurve,
    Intensity,
    LimitState,
    RiskWarning,
    fragility_of,
    mean_annual_frequency,
)
from frames.risk.fragility.runs import FAILURE, UNKNOWN
from lir_element.units import STANDARD_GRAVITY
from validation.study.capacities import bounds_of, draws, fitted, interval
from validation.study.consequences import COMPONENTS, repair
from validation.study.hazards import CONSIDERED_PERIOD, sites
from validation.study.pairs import NAMES, OURS, device, devices
from validation.study.records_runs import (
    COLLAPSE,
    INTENSITY,
    SCALES,
    STEP,
    considered,
    runs_of,
    stripes_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import GroundMotion
    from frames._types import FloatArray
    from frames.risk import IntensityRuns
    from frames.risk.fragility.curve import CollapseFragility, Fragility

LIMITS = (LimitState.drift(0.02), LimitState.floor_acceleration(STANDARD_GRAVITY), COLLAPSE)
PERIODS = np.geomspace(0.6, 4.5, 10)
"""Of the average spectrum [s]: 0.2 to 1.5 times 3 s, where the records are usable."""

MEASURES = {
    "Sa(3 s)": INTENSITY,
    "Sa(2 s)": Intensity(kind="Sa", period=2.0),
    "Sa_avg(0.6 to 4.5 s)": Intensity(kind="Sa_avg", periods=PERIODS.tolist()),
    "PGV": Intensity(kind="PGV"),
    "PGA": Intensity(kind="PGA"),
}
TARGET = float(np.sqrt(PERIODS[0] * PERIODS[-1]) / 3.0)
"""Sa(3 s) over the average of a spectrum that falls as 1 / T, as codes have it [-]."""

STRUCTURE = "B.10.35.001"
"""The component whose repair is most of what devices differ by."""

DRAWS = 300
FLOOR_PERIODS = np.geomspace(0.05, 4.0, 40)
FLOOR_DEVICES = NAMES[:4]
"""Those whose floor spectra are formed."""


def campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return the campaign of all devices under records of 1 m/s2 at the study's intensities."""
    return Campaign(devices(), dict(motions), store=store, scales=list(SCALES), dt=STEP)


def best_campaign(motions: Mapping[str, GroundMotion], store: Path) -> Campaign:
    """Return the same of the best LIR-DCFP of the plan."""
    return Campaign({OURS: device(OURS)}, dict(motions), store=store, scales=list(SCALES), dt=STEP)


def floor_levels() -> dict[str, float]:
    """Return the intensities of floor spectra [m/s2]: the design earthquake, and the considered."""
    return {"design earthquake": considered() / 1.5, "maximum considered earthquake": considered()}


def floor_spectra(
    motions: Mapping[str, GroundMotion], folder: Path
) -> dict[str, dict[str, list[Any]]]:
    """Run what floor spectra need, or read what is there."""
    folder.mkdir(parents=True, exist_ok=True)
    found: dict[str, dict[str, list[Any]]] = {}
    keep = Recording(channels=("node_acceleration",))
    for level, im in floor_levels().items():
        found[level] = {}
        for name in FLOOR_DEVICES:
            file = folder / f"{level}, {name}.json".replace(" ", "_")
            if not file.is_file():
                rows: list[Any] = []
                for motion in motions.values():
                    data = time_history(device(name), motion.scaled(im), dt=STEP, recording=keep)
                    status = str(data.attrs["status"])
                    if status not in {"ok", "inaccurate"}:
                        rows.append(status)
                        continue
                    spectrum = floor_spectrum(data, FLOOR_PERIODS).isel(level=[0, -1])
                    larger = spectrum.sel(axis=["x", "y"]).max("axis")
                    rows.append(larger.transpose("level", "period").to_numpy().round(4).tolist())
                file.write_text(json.dumps(rows), encoding="utf-8")
            found[level][name] = json.loads(file.read_text(encoding="utf-8"))
    return found


def floors_of(spectra: Mapping[str, Mapping[str, list[Any]]]) -> dict[str, Any]:
    """Return medians over records [m/s2], None where half of them failed, and shares that failed."""
    found: dict[str, Any] = {}
    for level, each in spectra.items():
        found[level] = {}
        for name, rows in each.items():
            shape = (2, len(FLOOR_PERIODS))
            values = np.array([np.full(shape, np.inf) if isinstance(r, str) else r for r in rows])
            middle = np.quantile(values, 0.5, axis=0, method="inverted_cdf")
            lost = sum(isinstance(row, str) for row in rows)
            found[level][name] = {
                "median": [[_finite(v) for v in line] for line in middle],
                "failed": lost,
                "records": len(rows),
            }
    return found


def _finite(value: float) -> float | None:
    return float(f"{value:.5g}") if isfinite(value) else None


def shapes_of(
    runs: Mapping[str, IntensityRuns], motions: Mapping[str, GroundMotion]
) -> dict[str, Any]:
    """Return what the shape of spectra does to collapse, and how efficient measures are."""
    records = list(motions)
    values = {
        name: np.array([measure.of(motions[each]) for each in records])
        for name, measure in MEASURES.items()
    }
    ratio = values["Sa(3 s)"] / values["Sa_avg(0.6 to 4.5 s)"]
    x, drawn, at = np.log(ratio), draws(len(records), DRAWS), considered()
    lines: dict[str, Any] = {}
    margins: dict[str, FloatArray] = {}
    efficiency: dict[str, Any] = {measure: {} for measure in MEASURES}
    for name, each in runs.items():
        bounds = bounds_of(each, COLLAPSE, records)
        line = fitted(bounds, x)
        again = [fitted(bounds[rows], x[rows]) for rows in drawn]
        target = np.log(TARGET)
        margins[name] = np.array([other.median(target) for other in again]) / at
        lines[name] = {
            "slope": [line.slope, *interval([other.slope for other in again])],
            "dispersion": line.dispersion,
            "alone": fitted(bounds).dispersion,
            "margin": [line.median() / at, *interval([o.median() / at for o in again])],
            "corrected": [line.median(target) / at, *interval(margins[name].tolist())],
            "bounds": [[_finite(v) for v in row] for row in bounds],
        }
        for measure, sizes in values.items():
            moved = bounds * sizes[:, None]
            spread = [fitted(moved[rows]).dispersion for rows in drawn]
            efficiency[measure][name] = [fitted(moved).dispersion, *interval(spread)]
    ratios = {
        name: [
            lines[OURS]["corrected"][0] / lines[name]["corrected"][0],
            *interval((margins[OURS] / margins[name]).tolist()),
        ]
        for name in runs
        if name != OURS
    }
    return {
        "ratio": {n: float(f"{v:.5g}") for n, v in zip(records, ratio, strict=True)},
        "target": TARGET,
        "lines": lines,
        "ratios": ratios,
        "efficiency": efficiency,
    }


def losses_of(
    data: xr.Dataset, runs: IntensityRuns, name: str, left_out: Sequence[str] = ()
) -> dict[str, FloatArray]:
    """Return expected losses of the runs of a device over the cost of a new building.

    Shapes: result (runs,).
    """
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == name))
    down = runs.exceeded(COLLAPSE)
    parts = repair(own["peak_drift"].to_numpy(), own["peak_floor_plan"].to_numpy())
    parts |= {number: np.zeros_like(parts[number]) for number in left_out}
    whole = np.sum([*parts.values()], axis=0)
    scale = np.where(whole > 1.0, 1.0 / np.maximum(whole, 1.0), 1.0)
    found = {"collapse": down}
    for each in COMPONENTS:
        found[each.name] = np.where(down > 0.0, 0.0, scale * parts[each.name]) + 0.0 * down
    return found


def annual(loss: FloatArray, at: FloatArray, hazard: HazardCurve) -> FloatArray:
    """Return expected annual losses.

    Shapes: loss (..., n), at (n,).
    """
    low, high = hazard.ends
    im = np.union1d(np.geomspace(low, high, 1000), at)
    rate = hazard.rates(np.clip(im, low, high))
    flat = loss.reshape(-1, loss.shape[-1])
    known = np.concatenate([[0.0], at])
    lines = np.array([np.interp(im, known, [0.0, *row]) for row in flat])
    steps = 0.5 * (lines[:, 1:] + lines[:, :-1]) @ -np.diff(rate) + lines[:, -1] * rate[-1]
    return np.asarray(steps.reshape(loss.shape[:-1]))


def by_record(losses: FloatArray, runs: IntensityRuns, records: list[str]) -> FloatArray:
    """Return losses as a table (records, intensities)."""
    table = runs.table[["motion", "im"]].assign(loss=losses)
    return np.asarray(
        table.pivot_table(index="motion", columns="im", values="loss", dropna=False)
        .loc[records]
        .to_numpy()
    )


def loss_of(
    results: Mapping[str, xr.Dataset],
    runs: Mapping[str, IntensityRuns],
    records: list[str],
    left_out: Sequence[str] = (),
) -> dict[str, Any]:
    """Return expected losses over intensity and a year, device by device, but for components."""
    at = np.array(sorted(set(next(iter(runs.values())).table["im"].tolist())))
    drawn = draws(len(records), DRAWS)
    curves: dict[str, Any] = {}
    means: dict[str, FloatArray] = {}
    yearly: dict[str, Any] = {}
    for name, each in runs.items():
        parts = {
            part: by_record(values, each, records)
            for part, values in losses_of(results[name], each, name, left_out).items()
        }
        total = np.sum([*parts.values()], axis=0)
        means[name] = np.nanmean(total[drawn], axis=1)  # (draws, intensities)
        ends = np.quantile(means[name], [0.05, 0.95], axis=0)
        curves[name] = {
            "mean": np.nanmean(total, axis=0).round(5).tolist(),
            "low": ends[0].round(5).tolist(),
            "high": ends[1].round(5).tolist(),
            "parts": {p: np.nanmean(v, axis=0).round(5).tolist() for p, v in parts.items()},
        }
    for key, hazard in hazards().items():
        yearly[key] = {}
        values = {name: annual(means[name], at, hazard) for name in runs}
        for name in runs:
            one = float(annual(np.array(curves[name]["mean"]), at, hazard))
            down = float(annual(np.array(curves[name]["parts"]["collapse"]), at, hazard))
            yearly[key][name] = {"loss": [one, *interval(values[name].tolist())], "collapse": down}
            if name != OURS:
                own = float(annual(np.array(curves[OURS]["mean"]), at, hazard))
                yearly[key][name]["ratio"] = [
                    own / one,
                    *interval((values[OURS] / values[name]).tolist()),
                ]
    return {"im": at.tolist(), "curves": curves, "annual": yearly}


def hazards() -> dict[str, HazardCurve]:
    """Return the curves of the sites as they are, and so that 2,475 years have the device's MCE."""
    found = {}
    for site in sites():
        found[f"{site.name}, as it is"] = site.curve
        found[f"{site.name}, moved"] = site.moved(considered())
    return found


def rates_of(runs: Mapping[str, IntensityRuns], resamples: int) -> dict[str, Any]:
    """Return fragility and mean annual frequencies of limit states, device by device."""
    found: dict[str, Any] = {"limits": {}, "stripes": {}, "rates": {}}
    curves: dict[str, dict[str, Fragility | CollapseFragility]] = {}
    for limit in LIMITS:
        curves[limit.name] = {}
        found["limits"][limit.name] = {}
        found["stripes"][limit.name] = {n: stripes_of(each, limit) for n, each in runs.items()}
        for name, each in runs.items():
            try:
                curve = fragility_of(each, limit, resamples=resamples)
            except FragilityError as cause:
                found["limits"][limit.name][name] = {"why": str(cause)}
                continue
            curves[limit.name][name] = curve
            row = curve.interval(0.9).loc["median"]  # type: ignore[union-attr]
            found["limits"][limit.name][name] = {
                "median": [float(row[key]) for key in ("value", "low", "high")],
                "dispersion": float(curve.dispersion),  # type: ignore[union-attr]
            }
    for key, hazard in hazards().items():
        found["rates"][key] = {name: {} for name in curves}
        for limit_name, own_curves in curves.items():
            with warnings.catch_warnings(action="ignore", category=RiskWarning):
                risks = {
                    name: mean_annual_frequency(curve, hazard) for name, curve in own_curves.items()
                }
            for name, risk in risks.items():
                row = {"rate": [risk.rate, *risk.interval(0.9)]}
                if name != OURS and OURS in risks:
                    own = risks[OURS]
                    row["ratio"] = [
                        own.rate / risk.rate,
                        *interval((own.resampled / risk.resampled).tolist()),
                    ]
                found["rates"][key][limit_name][name] = row
    return found


def sites_of() -> dict[str, Any]:
    """Return what the page says of the sites."""
    at = considered()
    return {
        site.name: {
            "source": site.source,
            "slope": site.slope(),
            "at": {f"{t:g}": site.at(t) for t in (475.0, CONSIDERED_PERIOD)},
            "period": float(1.0 / site.curve.rates(at)),
        }
        for site in sites()
    }


def statuses_of(runs: Mapping[str, IntensityRuns]) -> dict[str, Any]:
    """Return how the runs of each device ended, and shares of failed bearings by intensity."""
    found: dict[str, Any] = {}
    for name, each in runs.items():
        table = each.table
        counts = {str(k): int(v) for k, v in table["status"].value_counts().items()}
        failed = table.assign(f=table["outcome"] == FAILURE).groupby("im")["f"].mean()
        unknown = int((table["outcome"] == UNKNOWN).sum())
        found[name] = {"counts": counts, "failed": failed.round(4).tolist(), "unknown": unknown}
    return found


def found_of(
    data: Sequence[xr.Dataset], motions: Mapping[str, GroundMotion], resamples: int
) -> dict[str, Any]:
    """Return what the page says of the campaigns, but for floor spectra and cost."""
    named = {str(name): each for each in data for name in each["model"].to_numpy()}
    results = {name: named[name] for name in NAMES}
    runs = {name: runs_of(each, motions, name) for name, each in results.items()}
    return {
        "considered": considered(),
        "records": len(motions),
        "statuses": statuses_of(runs),
        "shape": shapes_of(runs, motions),
        "loss": loss_of(results, runs, list(motions)),
        "without": loss_of(results, runs, list(motions), [STRUCTURE])["annual"],
        "sites": sites_of(),
    } | rates_of(runs, resamples)
