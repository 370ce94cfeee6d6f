"""The slip of the interface over random test cases that meet rims: writes docs/validation/slip.md.

    python -m validation.measurements.slip --count 1000 --workers 2

Bearings and motions of two or three components are drawn; each motion is scaled until the slider
meets its rims. The levels 'pendulum' and 'contact' are compared with 'rigid_body', whose sliders
have a mass, and with both what `level="auto"` calls sufficient. Test cases are run in child processes.
"""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CubicSpline

from frames import audit
from frames.results.assumption_checks import needed_level
from validation import held_slip
from validation.fuzzing.pool import in_children
from validation.fuzzing.rim_scenes import meeting, random_rim_scene
from validation.page import FOLDER
from validation.slip_page import page

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames._types import FloatArray

TARGET = FOLDER / "slip.md"
LEVELS = ("rigid_body", "contact", "pendulum")
QUANTILE = 0.999
"""Of the force, as a spline through its values."""
FINER = 10
"""Points of the spline a step: the axial force rings after impacts with periods of some 20 ms, and
steps of 5 ms alone meet its peaks by chance."""
STEPS = (5e-3, 1e-3)
"""At which the level 'pendulum' is to end as at the step that it chooses [s]."""
LIMIT = 300.0
"""Longest time for a test case with all its runs [s]."""


def finer(data: xr.Dataset, name: str) -> FloatArray:
    """Return the x and y of a bearing's variable between the steps, too, (n, 2)."""
    time = data["time"].to_numpy()
    between = np.linspace(time[0], time[-1], FINER * (len(time) - 1) + 1)
    return np.asarray(CubicSpline(time, data[name].to_numpy()[:, 0, :2])(between))


def outcome(data: xr.Dataset) -> dict[str, Any]:
    """Return what is compared of a result, in SI units."""
    slip = data["interface_slip_size"].to_numpy()[:, 0]
    across = ("bearing_displacement", "bearing_force")
    u, f = (np.linalg.norm(finer(data, name), axis=-1) for name in across)
    rims = data["rim_force"].to_numpy()[:, 0]
    return {
        "status": str(data.attrs["status"]),
        "time": float(data["time"][-1]),
        "slip": float(slip.max()),
        "left": float(slip[-1]),
        "spin": float(data["slider_spin"][-1, 0]),
        "displacement": float(u.max()),
        "force": float(np.quantile(f, QUANTILE)),
        "axial": float(np.quantile(data["axial_force"].to_numpy(), QUANTILE)),
        "rim_bottom": float(np.quantile(rims[:, 0], QUANTILE)),
        "rim_top": float(np.quantile(rims[:, 1], QUANTILE)),
        "lifts": bool((data["axial_force"][1:] <= 0.0).any()),
        "seconds": float(data.attrs["seconds_loop"]),
    }


def perform(number: int, *, seed: int) -> dict[str, Any]:
    """Run a test case at all levels; a test case whose rims are not met has the factor None."""
    scene = random_rim_scene(seed, number)
    found: dict[str, Any] = {"number": number, "factor": meeting(scene)}
    if found["factor"] is None:
        return found
    bearing = scene.bearing
    reach = [d / r for d, r in zip(bearing.rim_displacement, bearing.radii, strict=True)]
    found |= {
        "slider_radius": bearing.slider_radius,
        "capacity": bearing.lateral_capacity,
        "holds": bearing.slip_stability,
        "overlap": bearing.resolved()["slip_capacity"],
        "unequal": abs(reach[0] - reach[1]) > 1e-9,
    }
    for level in LEVELS:
        data = scene.run(found["factor"], level)
        found[level] = outcome(data)
        if level == "pendulum":
            findings = audit(data)
            found["sufficient"] = needed_level(findings) == level
            found["measures"] = {finding.feature: finding.number for finding in findings}
            found["by_step"] = [
                str(scene.run(found["factor"], level, dt).attrs["status"]) for dt in STEPS
            ]
    return found


def _read(path: Path | None) -> list[dict[str, Any]]:
    if path is None:
        return []
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def main(given: Sequence[str] | None = None) -> None:
    """Run the test cases and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.measurements.slip")
    parser.add_argument("--seed", type=int, default=1, help="series of test cases (default 1)")
    parser.add_argument("--count", type=int, default=1000, help="how many are drawn")
    parser.add_argument("--workers", type=int, default=1, help="child processes")
    parser.add_argument("--keep", type=Path, help="a file for the numbers, JSON by line")
    parser.add_argument("--before", type=Path, help="such a file of an earlier state of the code")
    options = parser.parse_args(given)
    found, lost = [], []
    run = partial(perform, seed=options.seed)
    for number, result, how in in_children(run, range(options.count), options.workers, LIMIT):
        if how:
            lost.append(f"{number} ({how})")
            continue
        found.append(result)
        if options.keep:
            with options.keep.open("a", encoding="utf-8") as file:
                file.write(json.dumps(result) + "\n")
    found.sort(key=lambda entry: int(entry["number"]))
    call = f"python -m validation.measurements.slip --seed {options.seed} --count {options.count}"
    text = page(found, lost, call, _read(options.before), held_slip.rows(), held_slip.HEAD)
    TARGET.write_text(text, encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
