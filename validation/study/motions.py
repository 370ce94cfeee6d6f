"""Records turned, with a vertical component, one after another, and pulses: writes study_motions.md.

    python -m validation.study.motions --store motion-runs

The campaigns can be stopped; the same command goes on with their stores. Needs the extras
"campaign", "fema", "fragility" and "demo", and for the vertical component the folder LIR_RECORDS
with records of three components.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk.fragility.runs import COMPLETE, FAILURE, UNKNOWN
from validation.measurements.yielding_runs import LIR
from validation.study.buildings_runs import BUILDINGS, SCALES, building, yield_rotations
from validation.study.device_runs import best_devices
from validation.study.motions_figures import figures
from validation.study.motions_page import NAME, csv_tables, page
from validation.study.motions_runs import (
    ANGLE_SCALES,
    ANGLES,
    MAIN_SCALES,
    PULSE_SCALES,
    PULSES,
    SECONDS,
    TRIED,
    VERTICAL_SCALES,
    After,
    followed,
    pulses,
    three_components,
    turned,
    velocities,
    vertical_over_horizontal,
    without_vertical,
)
from validation.study.paired import (
    LIMITS,
    WEAK,
    at_scales,
    curve_of,
    joined,
    median_of,
    on_devices,
    performed_each,
    ratio_of,
    shares_of,
    table_of,
    told_of,
)
from validation.study.part import run_part, write_part
from validation.study.records_runs import COLLAPSE, considered, normalised
from validation.study.rounded import rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames import GroundMotion
    from frames.risk import IntensityRuns

    Found = Mapping[str, Any]
    from collections.abc import Mapping

    import pandas as pd

BASE = BUILDINGS[0]
RECORDS = "far-field"


class Runner:
    """Runs campaigns of the building of three storeys in folders of one store."""

    def __init__(self, store: Path, workers: int) -> None:
        self._store, self._workers = store, workers
        self._frames = on_devices(building(BASE))
        self._yields = yield_rotations(BASE)
        self.costs: list[dict[str, Any]] = []

    def runs(
        self, name: str, motions: Mapping[str, GroundMotion], scales: Sequence[float]
    ) -> dict[str, IntensityRuns]:
        """Return the runs of a campaign by device."""
        frames = {self._frames[device].name: self._frames[device] for device in TRIED}
        data, cost = performed_each(frames, motions, self._store / name, scales, self._workers)
        self.costs.append(cost)
        return {
            key.removeprefix(f"{BASE.name}, "): table_of(each, motions, self._yields)
            for key, each in data.items()
        }


RESAMPLES = 200


def found_of(runner: Runner, folder: Path) -> dict[str, Any]:
    """Run what is not done, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    base = runner.runs("base", motions, SCALES)
    angles = {0: {name: at_scales(runs, ANGLE_SCALES) for name, runs in base.items()}} | {
        angle: runner.runs(f"angle-{angle}", turned(motions, angle), ANGLE_SCALES)
        for angle in ANGLES[1:]
    }
    after = {
        each.name: {
            name: runs.table
            for name, runs in runner.runs(
                f"after-{k}", followed(motions, each), MAIN_SCALES
            ).items()
        }
        for k, each in enumerate(SECONDS)
    }
    impulses = runner.runs("pulses", pulses(), PULSE_SCALES)
    whole = three_components(folder)
    flat = without_vertical(whole)
    vertical = of_vertical(
        runner.runs("vertical-without", flat, VERTICAL_SCALES),
        runner.runs("vertical-with", whole, VERTICAL_SCALES),
        RESAMPLES,
    )
    return {
        "records": len(motions),
        "lir": told_of(best_devices()[LIR]),
        "considered": considered(),
        "angles": of_angles(angles, RESAMPLES),
        "seconds": of_seconds(
            {name: runs.table for name, runs in base.items()},
            after,
            {each.name: each for each in SECONDS},
        ),
        "vertical": vertical,
        "three": {
            name: [motion.peak["z"], vertical_over_horizontal(motion)]
            for name, motion in whole.items()
        },
        "pulses": of_pulses(impulses),
        "velocities": velocities(),
        "cost": joined(runner.costs),
    }


def write(found: Found) -> None:
    """Write the page, its figures, its tables and the numbers."""
    write_part(NAME, page(found), figures(found), found, csv_tables(found))


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done; records of three components are where LIR_RECORDS says."""
    records = os.environ.get("LIR_RECORDS")
    if not records:
        msg = "LIR_RECORDS names no folder: set it to one with records of three components"
        raise SystemExit(msg)
    found: dict[str, Any] = rounded(found_of(Runner(store, workers), Path(records)))
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("motions", given, run, write)


def of_angles(runs: Mapping[int, Mapping[str, IntensityRuns]], resamples: int) -> dict[str, Any]:
    """Return medians by angle and device, ratios, and how often an angle decides."""
    found: dict[str, Any] = {"limits": {}, "differ": {}}
    for limit in LIMITS:
        own: dict[str, Any] = {}
        for angle, each in runs.items():
            curves = {name: curve_of(table, limit, resamples) for name, table in each.items()}
            own[str(angle)] = {
                "medians": {name: median_of(curve) for name, curve in curves.items()},
                "ratio": ratio_of(curves[LIR], curves[WEAK]),
                "shares": {name: shares_of(table, limit) for name, table in each.items()},
            }
        found["limits"][limit.name] = own
    for name in next(iter(runs.values())):
        over = np.array([each[name].exceeded(COLLAPSE) for each in runs.values()])
        known = np.isfinite(over).all(axis=0)
        some = over[:, known].max(axis=0) > over[:, known].min(axis=0)
        found["differ"][name] = [int(some.sum()), int(known.sum())]
    return found


def of_seconds(
    alone: Mapping[str, pd.DataFrame],
    after: Mapping[str, Mapping[str, pd.DataFrame]],
    kinds: Mapping[str, After],
) -> dict[str, Any]:
    """Return what second shocks do to buildings that survived the first."""
    return {
        second: {name: _second(alone[name], table, kinds[second]) for name, table in own.items()}
        for second, own in after.items()
    }


def _second(alone: pd.DataFrame, both: pd.DataFrame, after: After) -> list[dict[str, Any]]:
    keys = ["motion", "scale"]
    first = alone.set_index(keys)
    names = list(dict.fromkeys(alone["motion"]))
    following = dict(zip(names, names[1:] + names[:1] if after.other else names, strict=True))
    rows = []
    for scale, own in both.groupby("scale"):
        row: dict[str, Any] = {"scale": float(scale)}
        at = own.set_index("motion")
        before = first.loc[[(name, scale) for name in at.index]].droplevel("scale")
        survived = (before["outcome"] == COMPLETE) & ~collapsed(before)
        known = survived & (at["outcome"] != UNKNOWN)
        fallen = known & collapsed(at)
        next_ones = first.loc[[(following[name], scale) for name in at.index]]
        intact = next_ones["outcome"].to_numpy() != UNKNOWN
        row["motions"] = len(at)
        row["survived"] = int(survived.sum())
        row["known"] = int(known.sum())
        row["collapsed"] = int(fallen.sum())
        row["bearing"] = int((known & (at["outcome"] == FAILURE)).sum())
        alone_falls = known.to_numpy() & intact & collapsed(next_ones).to_numpy()
        row["intact"] = [int(alone_falls.sum()), int((known.to_numpy() & intact).sum())]
        held = known & (at["outcome"] == COMPLETE)
        for key in ("residual interface slip", "residual bearing displacement"):
            row[key] = [_median(before[key][held]), _median(at[key][held])]
        rows.append(row)
    return rows


def collapsed(table: pd.DataFrame) -> pd.Series:
    """Return whether runs collapse: a bearing failed, or the ductility of collapse is exceeded."""
    assert COLLAPSE.limit is not None
    return (table["outcome"] == FAILURE) | (table["ductility"] > COLLAPSE.limit)


def _median(values: pd.Series) -> float | None:
    return float(values.median()) if len(values) else None


VERTICAL_SHOWN = (
    "axial force",
    "minimum axial force",
    "maximum uplift",
    "floor acceleration, vertical, mean",
    "bearing displacement",
    "interface slip",
)


def of_vertical(
    flat: Mapping[str, IntensityRuns], whole: Mapping[str, IntensityRuns], resamples: int
) -> dict[str, Any]:
    """Return what the vertical component changes, by device."""
    found: dict[str, Any] = {}
    for name, before in flat.items():
        after = whole[name]
        curves = [curve_of(each, COLLAPSE, resamples) for each in (before, after)]
        over = np.array([each.exceeded(COLLAPSE) for each in (before, after)])
        both = (before.table["outcome"] == COMPLETE) & (after.table["outcome"] == COMPLETE)
        at = before.table["im"]
        found[name] = {
            "medians": [median_of(curve) for curve in curves],
            "ratio": ratio_of(curves[1], curves[0]),
            "shares": [shares_of(each, COLLAPSE) for each in (before, after)],
            "turned": [int((one < other).sum()) for one, other in (over, over[::-1])],
            "peaks": {
                quantity: [
                    [
                        float(level),
                        int((both & (at == level)).sum()),
                        *(
                            _median(each.table[quantity][both & (at == level)])
                            for each in (before, after)
                        ),
                    ]
                    for level in sorted(set(at))
                ]
                for quantity in VERTICAL_SHOWN
            },
        }
    curves_of = {
        kind: {name: curve_of(each, COLLAPSE, resamples) for name, each in runs.items()}
        for kind, runs in (("flat", flat), ("whole", whole))
    }
    return {
        "devices": found,
        "ratios": {kind: ratio_of(c[LIR], c[WEAK]) for kind, c in curves_of.items()},
    }


def of_pulses(runs: Mapping[str, IntensityRuns]) -> dict[str, Any]:
    """Return by device and pulse the intensity of collapse, and where the bearing failed first."""
    found: dict[str, Any] = {}
    for name, each in runs.items():
        table = each.table.assign(over=each.exceeded(COLLAPSE))
        rows = {}
        for pulse in PULSES:
            own = table[table["motion"] == pulse.name].sort_values("im")
            rows[pulse.name] = first_over(
                own["im"].to_numpy(), own["over"].to_numpy(), own["status"].to_numpy()
            )
        found[name] = rows
    return found


def first_over(im: Any, over: Any, status: Sequence[str]) -> dict[str, Any]:
    """Return between which intensities collapse begins, how, and whether it goes on above.

    Shapes: im, over, status (n,).
    """
    known = np.isfinite(over)
    places = np.flatnonzero(known & (np.asarray(over) > 0.5))
    if not len(places):
        return {"low": float(np.asarray(im)[known].max()), "high": None, "status": "", "again": 0}
    first = int(places[0])
    before = np.flatnonzero(known[:first])
    return {
        "low": float(im[before[-1]]) if len(before) else None,
        "high": float(im[first]),
        "status": str(status[first]),
        "again": int((np.asarray(over)[first:] < 0.5).sum()),
    }


if __name__ == "__main__":
    main()
