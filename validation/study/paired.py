"""The devices that the parts on buildings and motions compare, on equal terms, and their runs.

All are made of bearings of the smaller plan that are sized for their loads, and have dishes that
are 60 mm larger in radius (`rims_runs`): the LIR-DCFP is the best that the search of devices found.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.risk import (
    Campaign,
    FragilityError,
    Intensity,
    IntensityRuns,
    LimitState,
    compare_fragility,
    fragility_of,
)
from frames.risk.fragility.runs import FAILURE, UNKNOWN
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR
from validation.study.device_runs import Device, best_devices, reach_of
from validation.study.device_runs import bearing_of as best_of
from validation.study.pairs import KINDS, UNBREAKABLE
from validation.study.part import performed
from validation.study.records_runs import COLLAPSE, STEP, ductilities_of
from validation.study.rims_runs import MORE, bearing_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    import pandas as pd
    import xarray as xr

    from frames import Frame, GroundMotion
    from frames.risk.fragility.curve import CollapseFragility, Fragility
    from lir_element import LIRBearing

    Curve = Fragility | CollapseFragility

WEAK, STRONG = "DCFP, rims of 1 W", UNBREAKABLE
PLAIN = {name: KINDS[name] for name in (WEAK, STRONG)}
OTHERS = tuple(PLAIN)
DEVICES = (LIR, *OTHERS)
LIMITS = (
    LimitState.drift(0.02),
    LimitState("ductility 4", "ductility", 4.0),
    LimitState.floor_acceleration(STANDARD_GRAVITY),
    COLLAPSE,
)
FACTOR = Intensity(kind="scale")
"""Motions have an intensity of 1 m/s2 or 1 m/s: the factor on them is their intensity."""

BEYOND = 1.25
"""By which a median may be outside of the intensities that were run [-]: more is no finding."""

WEIGHED = 0.9
"""Confidence of intervals [-]."""


def lir_device(own: Iterable[LIRBearing]) -> Device:
    """Return the best LIR-DCFP for a building: all sliders as wide as the widest."""
    bearings = list(own)
    widest = max(each.slider_radius for each in bearings)
    plan = 2.0 * (bearings[0].rim_displacement[0] + widest + MORE)
    return best_devices()[LIR]._replace(plan=plan, least=widest)


def devices_of(own: Mapping[str, LIRBearing]) -> dict[str, dict[str, LIRBearing]]:
    """Return each device's bearings by name."""
    best = lir_device(own.values())
    reach = reach_of(best, own.values())
    found = {LIR: {name: best_of(each, best, reach) for name, each in own.items()}}
    for device, kind in PLAIN.items():
        found[device] = {name: bearing_of(each.as_dcfp(), kind) for name, each in own.items()}
    return found


def on_devices(frame: Frame) -> dict[str, Frame]:
    """Return a building on LIR-DCFPs of the smaller plan as the same on each device, by device."""
    own = {name: link.bearing for name, link in frame.bearings.items()}
    return {
        device: frame.with_bearings(bearings, f"{frame.name}, {device}")
        for device, bearings in devices_of(own).items()
    }


def told_of(device: Device) -> dict[str, Any]:
    """Return what pages keep of a LIR-DCFP: friction of its interface, strength of its rims."""
    return {"interface": device.interface, "strength": device.strength}


def told_lir(told: Mapping[str, Any]) -> str:
    """Return in brackets what `told_of` keeps."""
    strength = told["strength"]
    rims = "never break" if strength is None else f"yield at {strength:g} W"
    return f"(friction of the interface {told['interface']:.2f}, rims that {rims})"


def performed_each(
    frames: Mapping[str, Frame],
    motions: Mapping[str, GroundMotion],
    store: Path,
    scales: Sequence[float],
    workers: int,
) -> tuple[dict[str, xr.Dataset], dict[str, Any]]:
    """Run a campaign a building: one that changes leaves the runs of the others."""
    found, costs = {}, []
    for name, frame in frames.items():
        place = store / "".join(c if c.isalnum() else "-" for c in name)
        runs = Campaign({name: frame}, dict(motions), store=place, scales=list(scales), dt=STEP)
        cost = performed(runs, workers)
        found[name] = runs.results()
        costs.append(cost | {"loop": float(found[name]["seconds_loop"].sum())})
    return found, joined(costs)


def joined(costs: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return what campaigns cost together; each store has its digest."""
    total = {key: sum(each[key] for each in costs) for key in ("runs", "loop")}
    digests = [d for each in costs for d in each.get("digests", [each.get("digest")])]
    last = {key: costs[-1][key] for key in ("date", "machine")}
    return total | {"digests": digests} | last


def table_of(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], at_yield: Mapping[str, float]
) -> IntensityRuns:
    """Return the runs of a building with their ductility; intensities are factors."""
    found = IntensityRuns.from_dataset(data, dict(motions), FACTOR)
    table = found.table.assign(
        ductility=ductilities_of(data, lambda hinge: at_yield[hinge.split(":")[0]])
    )
    return IntensityRuns(table, FACTOR, {**found.units, "ductility": "1"})


def curve_of(runs: IntensityRuns, limit: LimitState, resamples: int) -> Curve | str:
    """Return the fragility of a building against a limit state, or why there is none."""
    try:
        curve = fragility_of(runs, limit, resamples=resamples)
    except FragilityError as cause:
        return str(cause)
    im = runs.table["im"]
    if not im.min() / BEYOND <= curve.median <= BEYOND * im.max():
        return "the median is far from all intensities that were run"
    return curve


def median_of(curve: Curve | str) -> list[float] | None:
    """Return the median of a curve and its interval of 90 %, None without a curve."""
    if isinstance(curve, str):
        return None
    row = curve.interval(WEIGHED).loc["median"]
    return [float(row[key]) for key in ("value", "low", "high")]


def ratio_of(own: Curve | str, other: Curve | str) -> list[float] | None:
    """Return the median of one device over that of another: value and interval, records paired."""
    if isinstance(own, str) or isinstance(other, str):
        return None
    table = compare_fragility(other, own).to_dataframe(confidence=WEIGHED)  # type: ignore[arg-type]
    row = table.loc["median, ratio [-]"]
    return [float(row[key]) for key in ("value", "low", "high")]


def shares_of(runs: IntensityRuns, limit: LimitState) -> list[list[float]]:
    """Return by intensity: runs that exceed a limit, of them failed bearings, known, unknown."""
    over, table = runs.exceeded(limit), runs.table
    im, outcome = table["im"].to_numpy(), table["outcome"].to_numpy()
    rows = []
    for level in sorted(set(im.tolist())):
        at = im == level
        failed = int((outcome[at] == FAILURE).sum())
        unknown = int((outcome[at] == UNKNOWN).sum())
        rows.append([level, int(np.nansum(over[at])), failed, int(at.sum()) - unknown, unknown])
    return rows


def statuses_of(table: pd.DataFrame) -> dict[str, int]:
    """Return how many runs ended how."""
    return {str(name): int(count) for name, count in table["status"].value_counts().items()}


def cost_line(cost: Mapping[str, Any]) -> str:
    """Return what campaigns cost, in a sentence, with the digests of their stores."""
    digests = ", ".join(f"`{digest[:16]}`" for digest in cost["digests"])
    return (
        f"{cost['runs']} histories; their time loops took {cost['loop']:.0f} s, on processors shared with "
        f"other work. They are in {len(cost['digests'])} results databases, one a building, device and "
        f"set of motions, whose digests begin with {digests}."
    )


def as_csv(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table as CSV; what is not known is empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()
