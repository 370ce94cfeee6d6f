"""The best LIR-DCFP of a plan beside DCFPs, by plan and by cost: writes study_device.md.

    python -m validation.study.device --store device-runs

Several campaigns, each of which can be stopped; the same command goes on with its store. Needs the
extras "campaign", "fema" and "fragility".
"""

from __future__ import annotations

import datetime
import os
import platform
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.design import MotionSet
from frames.risk.fragility.fitting import RESAMPLES
from validation.measurements.benchmark import processor
from validation.measurements.yielding_runs import LIR, WIDE
from validation.study import device_search
from validation.study.device_figures import figures
from validation.study.device_numbers import (
    device_numbers,
    eccentricity_of,
    free_of,
    pair_of,
)
from validation.study.device_page import NAME, page
from validation.study.device_runs import (
    COMPARED,
    HALF_STRIPES,
    OTHERS,
    REFERENCE,
    STRIPES,
    Device,
    campaign_of,
    free_campaign,
    half_campaign,
    own_bearings,
    plain_devices,
    plan_of,
    soft_device,
    varied_devices,
)
from validation.study.part import performed, run_part, write_part
from validation.study.records_runs import COLLAPSE, considered, normalised, runs_of
from validation.study.rounded import csv_of, rounded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr

    from frames import GroundMotion
    from frames.risk import Campaign, IntensityRuns
    from validation.study.device_numbers import Curve

    Found = Mapping[str, Any]

RECORDS = "far-field"
DIGITS = 6


class Performed:
    """Campaigns of the study, run or gone on with, and what they cost."""

    def __init__(self, motions: Mapping[str, GroundMotion], workers: int | str) -> None:
        self.motions = motions
        self.workers = workers
        self.costs: list[dict[str, Any]] = []

    def results(self, what: str, campaign: Campaign) -> xr.Dataset:
        """Return the results of a campaign, which is run where it is not done."""
        cost = performed(campaign, self.workers)
        data = campaign.results()
        seconds = float(data["seconds_loop"].sum())
        self.costs.append(
            {"what": what, "runs": cost["runs"], "seconds": seconds, "digest": cost["digest"]}
        )
        return data


def searched(done: Performed, store: Path) -> list[dict[str, Any]]:
    """Return what the search says of all its points."""
    points = device_search.first_points()
    runs = device_search.campaign_of(points, done.motions, store / "search-1")
    rows = device_search.rows_of(
        points, done.results("search, first design", runs), done.motions, "first"
    )
    points = device_search.second_points(rows)
    runs = device_search.campaign_of(points, done.motions, store / "search-2")
    data = done.results("search, at each plan", runs)
    return rows + device_search.rows_of(points, data, done.motions, "second")


def study(motions: Mapping[str, GroundMotion], store: Path, workers: int | str) -> dict[str, Any]:
    """Run all campaigns, and return what the page says of them."""
    done = Performed(motions, workers)
    rows = searched(done, store)
    free = runs_of(done.results("no rims", free_campaign(motions, store / "free")), motions, WIDE)
    plans = []
    for more in COMPARED:
        plan = plan_of(more)
        row = device_search.best_of(rows, plan)
        best = device_search.device_at(plan, *device_search.EDGE)
        if row is not None:
            best = Device(plan, False, least=row["least"], interface=row["interface"])
        found, runs = _plan(done, best, free, store)
        plans.append(found)
        if more == REFERENCE:
            varied = _varied(done, best, runs, store)
    soft = soft_device()
    data = done.results("soft rims", campaign_of([soft], motions, store / "soft"))
    return {
        "considered": considered(),
        "records": len(motions),
        "sliders": list(device_search.sliders()),
        "least_load": min(each.resolved()["design_load"] for each in own_bearings()),
        "search": rows,
        "plans": plans,
        "varied": varied,
        "soft": _numbers({soft.name: soft}, data, motions)[0],
        "costs": done.costs,
        "date": f"{datetime.date.today():%Y-%m-%d}",
        "machine": f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}",
    }


def _numbers(
    devices: Mapping[str, Device], data: xr.Dataset, motions: Mapping[str, GroundMotion]
) -> tuple[dict[str, Any], dict[str, IntensityRuns], dict[str, dict[str, Curve]]]:
    kept: dict[str, Any] = {}
    runs: dict[str, IntensityRuns] = {}
    curves: dict[str, dict[str, Curve]] = {}
    for name, device in devices.items():
        runs[name] = runs_of(data, motions, device.name)
        eccentric = eccentricity_of(data, device.name)
        kept[name], curves[name] = device_numbers(device, runs[name], RESAMPLES, eccentric)
    return kept, runs, curves


def _plan(
    done: Performed, best: Device, free: IntensityRuns, store: Path
) -> tuple[dict[str, Any], dict[str, IntensityRuns]]:
    # Devices of one plan, and the LIR-DCFP beside each other one.
    label = f"{1e3 * best.plan:.0f}"
    plain = plain_devices(best.plan)
    kept: dict[str, Any] = {}
    runs: dict[str, IntensityRuns] = {}
    curves: dict[str, dict[str, Curve]] = {}
    for kind, devices in (("lir", {LIR: best}), ("plain", plain)):
        campaign = campaign_of(list(devices.values()), done.motions, store / f"{kind}-{label}")
        data = done.results(f"{label} mm, {'LIR-DCFP' if kind == 'lir' else 'DCFPs'}", campaign)
        each = _numbers(devices, data, done.motions)
        kept |= each[0]
        runs |= each[1]
        curves |= each[2]
    own, name = Device(best.plan, True, strength=None), OTHERS[-1]
    runs[name] = free_of(free, best.plan)
    kept[name], curves[name] = device_numbers(own, runs[name], RESAMPLES, None)
    kept[name] |= {"name": f"DCFP {label} mm, no rims", "cost": None}
    pairs = {
        other: pair_of(runs[LIR], runs[other], (curves[LIR], curves[other]), RESAMPLES)
        for other in OTHERS
    }
    return {"plan": best.plan, "devices": kept, "pairs": pairs}, runs


def _varied(
    done: Performed, best: Device, runs: Mapping[str, IntensityRuns], store: Path
) -> list[dict[str, Any]]:
    # Devices that are varied, and the same ones at the other level: runs that collapse, and that are
    # known, under every second record.
    found = [
        {"device": name, "what": "as it is", "counts": _counted(runs[name], done.motions)}
        for name in (LIR, OTHERS[1])
    ]
    varied = varied_devices(best)
    campaign = half_campaign(list(varied.values()), done.motions, store / "varied")
    data = done.results("LIR-DCFP, varied", campaign)
    motions = dict(list(done.motions.items())[::2])
    for what, device in varied.items():
        own = runs_of(data, motions, device.name)
        found.append({"device": LIR, "what": what, "counts": _counted(own, done.motions)})
    bodies = {LIR: best, OTHERS[1]: plain_devices(best.plan)[OTHERS[1]]}
    campaign = half_campaign(list(bodies.values()), done.motions, store / "contact", "contact")
    data = done.results("level contact", campaign)
    for name, device in bodies.items():
        own = runs_of(data, motions, device.name)
        counts = _counted(own, done.motions)
        found.append({"device": name, "what": "level `contact`", "counts": counts})
    return found


def _counted(runs: IntensityRuns, motions: Mapping[str, GroundMotion]) -> list[list[float]]:
    exceeded, im = runs.exceeded(COLLAPSE), runs.table["im"].to_numpy()
    own = runs.table["motion"].isin(list(motions)[::2]).to_numpy()
    rows = []
    for at in HALF_STRIPES:
        there = exceeded[own & np.isclose(im, at)]
        rows.append([at, float(np.nansum(there)), float(np.isfinite(there).sum())])
    return rows


def table_rows(found: Found) -> list[dict[str, Any]]:
    """Return the table of all devices in SI units."""
    rows = []
    for plan in found["plans"]:
        for kind, kept in plan["devices"].items():
            device, median = kept["device"], kept["limits"][COLLAPSE.name].get("median")
            low, high = median[1:] if median else (None, None)
            rows.append(
                {
                    "device": kept["name"],
                    "plan [m]": plan["plan"],
                    "capacity [m]": kept["capacity"],
                    "smallest slider radius [m]": kept["sliders"][0],
                    "interface friction [-]": None if device["plain"] else device["interface"],
                    "rims": LIR if kind == LIR else kind,
                    "collapse, median [m/s2]": median[0] if median else None,
                    "collapse, low [m/s2]": low,
                    "collapse, high [m/s2]": high,
                    "cost [kg of steel]": sum(kept["cost"].values()) if kept["cost"] else None,
                    "volume [m3]": kept["volume"],
                }
                | {
                    f"share that collapses at {at:g} m/s2 [-]": share
                    for at, share in zip(STRIPES, kept["collapse"], strict=True)
                }
                | {
                    f"share with a failed bearing at {at:g} m/s2 [-]": share
                    for at, share in zip(STRIPES, kept["failed"], strict=True)
                }
            )
    return rows


def write(found: Found) -> None:
    """Write the page, its figures, tables and the numbers."""
    tables = {"devices": table_rows(found), "search": _flat(found["search"])}
    texts = {f"{NAME}-{name}.csv": csv_of(rows) for name, rows in tables.items()}
    write_part(NAME, page(found), figures(found), found, texts)


def _flat(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    return [
        {
            "stage": row["stage"],
            "plan [m]": row["plan"],
            "smallest slider radius [m]": row["least"],
            "interface friction [-]": row["interface"],
            "kappa [-]": row["kappa"],
            "collapse, median [m/s2]": row["median"],
        }
        for row in rows
    ]


def run(store: Path, workers: int | str) -> dict[str, Any]:
    """Run what is not done under the records, and return what the page says of it."""
    motions = normalised(MotionSet.fema_p695(RECORDS))
    found: dict[str, Any] = rounded(study(motions, store, workers), DIGITS)
    return found


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaigns, and write the page."""
    run_part("device", given, run, write)


if __name__ == "__main__":
    main()
