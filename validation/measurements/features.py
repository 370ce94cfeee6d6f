"""What each feature costs, and what leaving it out changes: writes docs/validation/features.md.

    LIR_RECORDS=<folder of records> python -m validation.measurements.features

Runs of one test case take turns; processor time, gravity and assumption check included. The fastest of each
counts: a busy machine only adds time.
"""

from __future__ import annotations

import os
import platform
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames import GroundMotion, audit, gravity, lumped_mass, moment_frame, time_history
from frames.demo import design, pacoima
from frames.solve.escalation import escalate_level
from lir_element import AnalysisWarning, Features
from validation.page import FOLDER, render
from validation.scenes import example_bearing

if TYPE_CHECKING:
    import xarray as xr

    from frames import Frame

TARGET = FOLDER / "features.md"
REPEATS = 7
CHEAPEST = Features().without(
    "rims", "interface", "plate_rotation", "velocity_dependence", "vertical_coupling"
)
STARTS = {
    "everything": Features(),
    "without rims and interface": Features(rims=False, interface=False),
    "without plate rotation": Features(plate_rotation=False),
    "the cheapest": CHEAPEST,
}


class Scene(NamedTuple):
    """A model and its motion."""

    title: str
    frame: Frame
    motion: GroundMotion


def scenes() -> list[Scene]:
    """Return the test cases measured."""
    record = Path(os.environ["LIR_RECORDS"]) / "RSN1044_NORTHR_NWH360.AT2"
    building = moment_frame(bearing=design())
    return [
        Scene(
            "one bearing, lumped mass, Newhall 360",
            lumped_mass(example_bearing(), 204e3),
            GroundMotion.from_at2(x=record),
        ),
        Scene("demo building, Pacoima Dam times 0.8: rims met", building, pacoima(0.8)),
        Scene("demo building, Pacoima Dam times 0.5: rims not met", building, pacoima(0.5)),
    ]


def analyse(scene: Scene, features: Features) -> xr.Dataset:
    """Run a test case; a failure is told by the table."""
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        return time_history(scene.frame, scene.motion, features=features)


def peak(data: xr.Dataset) -> float:
    """Return the largest lateral displacement of a bearing [m]."""
    moves = data["bearing_displacement"].sel(axis=["x", "y"]).to_numpy()
    return float(np.linalg.norm(moves, axis=-1).max())


def feature_rows(scene: Scene) -> list[str]:
    """Measure a test case with everything, with each feature left out, and with the cheapest model."""
    cases = [Features(), *(Features().without(name) for name in Features.names()), CHEAPEST]
    seconds: list[list[float]] = [[] for _ in cases]
    results: list[xr.Dataset] = []
    for turn in range(REPEATS):
        results = []
        for place, features in enumerate(cases):
            began = time.process_time()
            results.append(analyse(scene, features))
            if turn:  # the first warms up
                seconds[place].append(time.process_time() - began)
    base, full = min(seconds[0]), peak(results[0])
    rows = []
    for features, data, times in zip(cases, results, seconds, strict=True):
        cost = min(times)
        is_ok = data.attrs["status"] == "ok"
        verdict = "; ".join(
            f.sentence for f in audit(data) if f.is_missing and f.feature in features.left_out
        )
        if not features.left_out:
            verdict = "-"
        count = len(gravity(scene.frame, features).basis.bearing_dofs)
        change = f"{100.0 * (peak(data) / full - 1.0):+.1f} %" if is_ok else data.attrs["status"]
        time_share = f"{cost / base:.2f}" if is_ok else "-"
        rows.append(
            f"| {', '.join(features.left_out) or 'nothing'} | {count} | {data.attrs['steps']} | "
            f"{data.attrs['newton_iterations']} | {cost:.3f} | {time_share} | {change} | "
            f"{verdict or 'nothing left out mattered'} |"
        )
    return rows


def of_auto(scene: Scene, start: Features) -> xr.Dataset:
    """Analyse a test case as `auto` does, with these features to begin with."""
    return escalate_level(lambda kept, _: analyse(scene, kept), start)


def start_rows(all_scenes: list[Scene]) -> list[str]:
    """Measure the whole of `auto` for several features to begin with."""
    rows = []
    for scene in all_scenes:
        times: dict[str, list[float]] = {name: [] for name in STARTS}
        runs: dict[str, int] = {}
        for _ in range(5):
            for name, start in STARTS.items():
                began = time.process_time()
                data = of_auto(scene, start)
                times[name].append(time.process_time() - began)
                runs[name] = data.attrs["auto_runs"].count("\n") + 1
        base = min(times["everything"])
        cells = [f"{min(times[n]) / base:.2f} ({runs[n]})" for n in STARTS]
        rows.append(f"| {scene.title} | " + " | ".join(cells) + " |")
    return rows


def write() -> str:
    """Measure everything and return the page."""
    machine = f"{os.cpu_count()} cores ({platform.machine()})"
    return render(globals(), machine=machine, measured=scenes())


if __name__ == "__main__":
    page = write()
    TARGET.write_text(page, encoding="utf-8")
    print(page)
