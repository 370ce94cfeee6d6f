"""Four devices under a building that yields, under the records of FEMA P695: runs and numbers.

Records are normalised to a spectral acceleration of 1 m/s2 at the period of the bearings, so that
factors common to all are intensities.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import MotionWarning
from frames.demo import bearing_for
from frames.risk import (
    Campaign,
    FragilityError,
    Intensity,
    IntensityRuns,
    LimitState,
    collapse_margin_ratio,
    compare_fragility,
    fragility_of,
)
from frames.risk.campaign.comparison import filling_intensity
from frames.risk.fragility.fitting import RESAMPLES
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import (
    LIR,
    RIMS,
    TAIL,
    WIDE,
    model_of,
    structures,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import Frame, GroundMotion
    from frames.risk.fragility.curve import CollapseFragility, Fragility

    Curves = dict[str, Fragility | CollapseFragility | str]

ROOM = "LIR-DCFP, larger sliders"
"""The same rims, more room for the slip, and an interface that holds more."""

ROOM_RADIUS, ROOM_FRICTION = 0.06, 0.16
"""What its sliders have more than those of the LIR-DCFP [m]; friction of its interface [-]."""

DEVICES = (LIR, RIMS, WIDE, ROOM)

STRUCTURE = "light"
"""Of `yielding_runs.structures`: the one whose members yield."""

INTENSITY = Intensity(kind="Sa", period=3.0, measure="RotD50")
SCALES = (0.8, 1.2, 1.6, 1.9, 2.2, 2.6, 3.2, 4.2)
"""Intensities of the stripes [m/s2]."""

STEP = 0.01
"""Time step of all runs [s]."""

ULTIMATE = 9.0
"""Ductility of rotation at which a member has failed [-]: an assumption."""

COLLAPSE = LimitState("collapse", "ductility", ULTIMATE)
SLIP = LimitState("slip over half of the overlap", "interface slip over overlap", 0.5)
LIMITS = (
    LimitState.rim_contact(),
    SLIP,
    LimitState.drift(0.02),
    LimitState("ductility 4", "ductility", 4.0),
    LimitState.floor_acceleration(0.5 * STANDARD_GRAVITY),
    LimitState.floor_acceleration(STANDARD_GRAVITY),
    COLLAPSE,
)
DEMANDS = (
    "ductility",
    "storey drift, mean",
    "floor acceleration in plan, mean",
    "bearing displacement",
    "residual bearing displacement",
    "interface slip",
    "residual interface slip",
    "rim force",
    "base shear over weight",
)
ALL = "all"
FRACTILES = (0.16, 0.5, 0.84)


def devices() -> dict[str, Frame]:
    """Return the building on each device."""
    own = {name: model_of(structures()[STRUCTURE], name) for name in (LIR, RIMS, WIDE)}
    larger = {
        name: replace(
            link.bearing,
            slider_radius=link.bearing.slider_radius + ROOM_RADIUS,
            interface_friction=ROOM_FRICTION,
        )
        for name, link in own[LIR].bearings.items()
    }
    return own | {ROOM: own[LIR].with_bearings(larger)}


def normalised(motions: Mapping[str, GroundMotion]) -> dict[str, GroundMotion]:
    """Return motions of an intensity of 1 m/s2, with time to come to rest behind."""
    with warnings.catch_warnings(action="ignore", category=MotionWarning):
        return {
            name: motion.scaled(1.0 / INTENSITY.of(motion)).with_tail(TAIL)
            for name, motion in motions.items()
        }


def campaign(
    motions: Mapping[str, GroundMotion], store: Path, scales: Sequence[float] = SCALES
) -> Campaign:
    """Return the campaign of all devices under motions at intensities [m/s2]."""
    return Campaign(devices(), dict(motions), store=store, scales=list(scales), dt=STEP)


def yield_rotations() -> dict[str, float]:
    """Return the rotation at which columns and beams yield [rad]."""
    return structures()[STRUCTURE].yield_rotations()


def ductilities_of(data: xr.Dataset, at_yield: Callable[[str], float]) -> Any:
    """Return the largest ductility of rotation of each run, (runs,): 1 where no hinge yields.

    Shapes: result (runs,).
    """
    limits = np.array([at_yield(str(name)) for name in data["hinge"].to_numpy()])
    return 1.0 + (data["peak_hinge_rotation"].to_numpy() / limits).max(axis=1)


def ductilities(data: xr.Dataset) -> Any:
    """Return the same of the study's building, whose columns and beams yield alike."""
    at_yield = yield_rotations()
    return ductilities_of(data, lambda hinge: at_yield[hinge.split("-")[0]])


def runs_of(data: xr.Dataset, motions: Mapping[str, GroundMotion], device: str) -> IntensityRuns:
    """Return the runs of a device, with their ductility."""
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == device))
    found = IntensityRuns.from_dataset(own, dict(motions), INTENSITY)
    table = found.table.assign(ductility=ductilities(own))
    return replace(found, table=table, units={**found.units, "ductility": "1"})


def considered() -> float:
    """Return the Sa of the maximum considered earthquake that fills the capacity [m/s2]."""
    assert INTENSITY.period is not None
    return filling_intensity(bearing_for(1000e3), INTENSITY.period)


def curves_of(runs: Mapping[str, IntensityRuns], limit: LimitState, resamples: int) -> Curves:
    """Return a curve by device, or why there is none."""
    found: Curves = {}
    for name, each in runs.items():
        if limit is SLIP and name not in (LIR, ROOM):
            found[name] = "has no interface"
            continue
        try:
            found[name] = fragility_of(each, limit, resamples=resamples)
        except FragilityError as cause:
            found[name] = str(cause)
    return found


def stripes_of(runs: IntensityRuns, limit: LimitState) -> list[list[float]]:
    """Return intensity, runs that exceed a limit, and runs that are known, stripe by stripe."""
    exceeded, im = runs.exceeded(limit), runs.table["im"].to_numpy()
    rows = []
    for level in sorted(set(im.tolist())):
        own = exceeded[im == level]
        rows.append([level, float(np.nansum(own)), float(np.isfinite(own).sum())])
    return rows


def numbers_of(curve: Fragility | CollapseFragility | str, *, band: bool) -> dict[str, Any]:
    """Return what is kept of a curve; to be drawn with its band."""
    if isinstance(curve, str):
        return {"why": curve}
    table = curve.interval(0.9)  # type: ignore[union-attr]
    columns = ["value", "low", "high"]
    kept = {str(name): row.tolist() for name, row in table[columns].iterrows()}
    kept |= {"lost": curve.lost, "records": len(curve.records)}
    if band:
        at = np.linspace(0.05, 1.1 * SCALES[-1], 60)
        drawn = curve.to_dataframe(at).round(4)
        kept |= {"at": at.round(4).tolist()}
        kept |= {str(name): column.tolist() for name, column in drawn.items()}
    return kept


def compared(curves: Curves, device: str) -> dict[str, list[float]]:
    """Return the median of a device over that of each other: value, low, high, share."""
    found = {}
    own = curves[device]
    for name, other in curves.items():
        if name == device or isinstance(other, str) or isinstance(own, str):
            continue
        row = compare_fragility(other, own).to_dataframe(0.9).loc["median, ratio [-]"]
        found[name] = [float(row[key]) for key in ("value", "low", "high", "second better")]
    return found


def fractiles(runs: IntensityRuns, quantity: str) -> list[list[float | None]]:
    """Return fractiles of a demand at each intensity; None where that part has failed."""
    demand, im = runs.demand(quantity), runs.table["im"].to_numpy()
    rows = []
    for level in sorted(set(im.tolist())):
        own = demand[(im == level) & ~np.isnan(demand)]
        values = np.quantile(own, FRACTILES, method="inverted_cdf") if len(own) else [np.inf] * 3
        rows.append([float(value) if np.isfinite(value) else None for value in values])
    return rows


def found_of(
    data: xr.Dataset, sets: Mapping[str, Mapping[str, GroundMotion]], resamples: int = RESAMPLES
) -> dict[str, Any]:
    """Return what the page says of the results of a campaign: plain numbers, for JSON."""
    motions = {name: motion for each in sets.values() for name, motion in each.items()}
    runs = {name: runs_of(data, motions, name) for name in DEVICES}
    groups = {ALL: list(motions)} | {kind: list(each) for kind, each in sets.items()}
    parts: dict[str, Any] = {}
    for kind, names in groups.items():
        own = {device: _only(each, names) for device, each in runs.items()}
        parts[kind] = part = {"motions": len(names), "limits": {}, "demands": {}}
        for limit in LIMITS:
            curves = curves_of(own, limit, resamples)
            part["limits"][limit.name] = {
                "curves": {
                    name: numbers_of(curve, band=kind == ALL) for name, curve in curves.items()
                },
                "stripes": {name: stripes_of(own[name], limit) for name in own},
                "ratios": {name: compared(curves, name) for name in (LIR, ROOM)},
            }
        for quantity in DEMANDS:
            part["demands"][quantity] = {n: fractiles(own[n], quantity) for n in own}
    statuses = {name: each.table["status"].value_counts().to_dict() for name, each in runs.items()}
    failed = [
        [name, str(row["motion"]), float(row["im"]), str(row["message"])]
        for name, each in runs.items()
        for _, row in each.failed.iterrows()
    ]
    largest = runs[WIDE].table.groupby("im")["bearing displacement"].max()
    loop, model = data["seconds_loop"].to_numpy(), data["model"].to_numpy()
    return {
        "scales": sorted(largest.index.tolist()),
        "considered": considered(),
        "parts": parts,
        "statuses": statuses,
        "failed": failed,
        "largest": largest.tolist(),
        "seconds": {
            name: [float(loop[model == name].sum()), float(loop[model == name].max())]
            for name in DEVICES
        },
    }


def margin(found: Mapping[str, Any], kind: str, device: str) -> list[float] | None:
    """Return the collapse margin ratio with its interval of 90 %, None without a curve."""
    curve = found["parts"][kind]["limits"][COLLAPSE.name]["curves"][device]
    if "why" in curve:
        return None
    return [collapse_margin_ratio(value, found["considered"]) for value in curve["median"]]


def _only(runs: IntensityRuns, names: Sequence[str]) -> IntensityRuns:
    table = runs.table[runs.table["motion"].isin(names)].reset_index(drop=True)
    return replace(runs, table=table)
