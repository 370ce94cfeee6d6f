"""What follows the failure of a bearing: collapse, or a stop that carries on: runs and numbers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.risk import Campaign, LimitState, collapse_margin_ratio
from frames.risk.fragility.runs import UNKNOWN
from lir_element import BackupSupport
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR
from validation.study.device_runs import best_devices, frame_of
from validation.study.records_runs import (
    COLLAPSE,
    SCALES,
    STEP,
    compared,
    considered,
    curves_of,
    numbers_of,
    runs_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import Frame, GroundMotion

DROPS = (None, 0.02)
"""Way down to the stop [m]; None: the run ends by the failure, which is collapse."""

FRICTION = 0.3
"""Of the stop: an assumption, steel on steel or mortar."""

STRENGTHS = (1.0,)
"""Of the DCFP's rims, over the design load."""

LIMITS = (
    LimitState.drift(0.02),
    LimitState.drift(0.04),
    LimitState.floor_acceleration(STANDARD_GRAVITY),
    COLLAPSE,
)


class Kind(NamedTuple):
    """A device, and what carries after its failure."""

    device: str
    drop: float | None

    @property
    def name(self) -> str:
        """How the page calls it."""
        then = "ends" if self.drop is None else f"stop after {1e3 * self.drop:.0f} mm"
        return f"{self.device}: {then}"


DEVICES = (LIR, *(f"DCFP, rims of {strength:g} W" for strength in STRENGTHS))
KINDS = tuple(Kind(device, drop) for device in DEVICES for drop in DROPS)


def devices() -> dict[str, Frame]:
    """Return the building on each device, with each of the backups."""
    best = best_devices()
    found = {}
    for kind in KINDS:
        frame = frame_of(best[kind.device])
        if kind.drop is not None:
            backup = BackupSupport(drop=kind.drop, friction=FRICTION)
            own = frame.bearings.items()
            frame = frame.with_bearings(
                {name: replace(link.bearing, backup=backup) for name, link in own}
            )
        found[kind.name] = frame
    return found


def campaign(
    motions: Mapping[str, GroundMotion], store: Path, scales: Sequence[float] = SCALES
) -> Campaign:
    """Return the campaign of all devices under motions at intensities [m/s2]."""
    return Campaign(devices(), dict(motions), store=store, scales=list(scales), dt=STEP)


def found_of(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], resamples: int
) -> dict[str, Any]:
    """Return what the page says of the results of a campaign: plain numbers, for JSON."""
    runs = {kind.name: runs_of(data, motions, kind.name) for kind in KINDS}
    at = considered()
    limits: dict[str, Any] = {}
    ratios: dict[str, Any] = {}
    for limit in LIMITS:
        curves = curves_of(runs, limit, resamples)
        limits[limit.name] = {n: numbers_of(curve, band=False) for n, curve in curves.items()}
        ratios[limit.name] = [
            compared(curves, Kind(LIR, drop).name).get(Kind(DEVICES[1], drop).name)
            for drop in DROPS
        ]
    margins = {
        name: [collapse_margin_ratio(value, at) for value in curve["median"]]
        for name, curve in limits[COLLAPSE.name].items()
        if "median" in curve
    }
    stripes: dict[str, list[dict[str, float]]] = {}
    for name, each in runs.items():
        table = each.table
        failed = each.exceeded(LimitState.bearing_failure())
        collapsed = each.exceeded(COLLAPSE)
        rows = []
        for level in sorted(set(table["im"])):
            own = (table["im"] == level).to_numpy() & (table["outcome"] != UNKNOWN).to_numpy()
            lost = own & (table["status"] == "bearing_lost").to_numpy()
            rows.append(
                {
                    "im": float(level),
                    "known": int(own.sum()),
                    "failed": int(np.nansum(failed[own])),
                    "collapsed": int(np.nansum(collapsed[own])),
                    "drift": _median(table["storey drift, mean"].to_numpy()[lost]),
                    "floor": _median(
                        table["floor acceleration in plan, mean"].to_numpy()[lost]
                        / STANDARD_GRAVITY
                    ),
                    "ductility": _median(table["ductility"].to_numpy()[lost]),
                }
            )
        stripes[name] = rows
    return {
        "considered": at,
        "limits": limits,
        "ratios": ratios,
        "loop": round(float(data["seconds_loop"].sum()), 1),
        "margins": margins,
        "stripes": stripes,
        "statuses": {n: each.table["status"].value_counts().to_dict() for n, each in runs.items()},
    }


def _median(values: Any) -> float | None:
    # Of the runs that went on; none: None.
    return float(np.round(np.median(values), 5)) if len(values) else None
