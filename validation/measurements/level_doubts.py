"""What the level 'pendulum' has wrong in buildings: writes docs/validation/level_doubts.md.

    python -m validation.measurements.level_doubts --count 1000 --workers 2

Random buildings on bearings, near their rims and beyond, at the levels 'pendulum' and 'contact';
bearing by bearing, in the classes of `frames.results.level_doubts`. The level 'contact' is held
against rigid bodies in docs/validation/slip.md.
"""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.results.level_doubts import CLASSES, errors_of
from validation.fuzzing.level_scenes import factor_for, random_level_scene, run_level
from validation.fuzzing.pool import in_children
from validation.page import FOLDER, table

if TYPE_CHECKING:
    from collections.abc import Sequence

TARGET = FOLDER / "level_doubts.md"
LIMIT = 300.0
"""Longest time for a test case with all its runs [s]."""
LEAST_SLIP, LEAST_RIM = 0.02, 0.05
"""Errors of smaller ones are over this one: of the capacity, of the bearing's force [-]."""
REACHED = ("displacement", "force", "axial_force", "slip", "rim_force")
SHOWN = ("displacement", "force", "axial force", "interface slip", "rim force", "base shear")
NOTHING = "rims not met, no uplift"
BOUNDS = (0.05, 0.05, 0.05, 0.10, 0.05, 0.05)
"""Errors that count, as `SHOWN` [-]."""


def perform(number: int, *, seed: int) -> dict[str, Any]:
    """Run a test case at both levels; the factor is None where it comes to no peak as wanted."""
    model, bearing, motion, goal = random_level_scene(seed, number)
    factor = factor_for(model, bearing, motion, goal)
    found: dict[str, Any] = {"number": number, "factor": factor}
    if factor is None:
        return found
    reach = [d / r for d, r in zip(bearing.rim_displacement, bearing.radii, strict=True)]
    found |= {"unequal": abs(reach[0] - reach[1]) > 1e-9, "capacity": bearing.lateral_capacity}
    for level in ("pendulum", "contact"):
        data = run_level(model, motion, factor, level)
        found[level] = {
            "status": str(data.attrs["status"]),
            "seconds": float(data.attrs["seconds_loop"]),
            "base_shear": float(data["reached_base_shear"]),
        }
        for name in (*REACHED, "eccentricity", "lifted"):
            found[level][name] = data[f"reached_{name}"].to_numpy().tolist()
    return found


def classes(entry: dict[str, Any]) -> list[str]:
    """Return the class of each bearing, by its run at the level 'pendulum'."""
    ours = {name: np.array(value) for name, value in entry["pendulum"].items()}
    met, lifted = ours["rim_force"] > 0.0, ours["lifted"] > 0.0
    unequal = np.full(met.shape, entry["unequal"])
    errors, doubtful = errors_of(met, lifted, ours["eccentricity"], unequal)
    names = {kind.errors: kind.name for kind in CLASSES}
    return [
        names[tuple(row)] if any_ else NOTHING
        for row, any_ in zip(errors.tolist(), doubtful, strict=True)
    ]


def errors(entry: dict[str, Any]) -> list[list[float]]:
    """Return the errors of each bearing, as `SHOWN` [-]; those of the base shear are the run's."""
    ours, theirs = entry["pendulum"], entry["contact"]
    force = np.array(theirs["force"])
    least = {"slip": LEAST_SLIP * entry["capacity"], "rim_force": LEAST_RIM * force}
    columns = []
    for name in REACHED:
        right = np.array(theirs[name])
        columns.append((np.array(ours[name]) - right) / np.maximum(right, least.get(name, 1e-12)))
    shear = ours["base_shear"] / theirs["base_shear"] - 1.0
    columns.append(np.full(len(force), shear))
    return np.stack(columns, axis=1).tolist()


def page(found: list[dict[str, Any]], lost: list[str], call: str) -> str:
    """Return the page."""
    runs = [entry for entry in found if entry["factor"] is not None]
    fine = [e for e in runs if e["pendulum"]["status"] == "ok" == e["contact"]["status"]]
    kinds = [kind for entry in fine for kind in classes(entry)]
    off = np.array([row for entry in fine for row in errors(entry)])
    rows = []
    for kind in (NOTHING, *(each.name for each in CLASSES)):
        those = off[[own == kind for own in kinds]]
        if not len(those):
            continue
        cells = [
            f"{100 * np.quantile(abs(those[:, k]), 0.9):.2g} ({100 * those[:, k].min():.0f} to "
            f"{100 * those[:, k].max():+.0f})"
            for k in range(len(SHOWN))
        ]
        rows.append((kind, str(len(those)), *cells))
    calm = [
        not any(kind != NOTHING for kind in classes(entry)) for entry in fine
    ]  # what `auto` keeps
    worst = [(np.abs(np.array(errors(entry))) > BOUNDS).any() for entry in fine]
    kept, wrong = sum(calm), sum(c and w for c, w in zip(calm, worst, strict=True))
    ends = [e for e in runs if e["pendulum"]["status"] != e["contact"]["status"]]
    seconds = [sum(e[level]["seconds"] for e in fine) for level in ("pendulum", "contact")]
    said = "; ".join(
        f"{e['number']} ({e['pendulum']['status']}, {e['contact']['status']})" for e in ends
    )
    return "\n".join(
        (
            "# What the level `pendulum` has wrong in buildings",
            "",
            f"Written by `{call}`: {len(runs)} random buildings of one to four storeys that "
            "overturn, on four to nine bearings, near their rims and beyond; masses off the centre, "
            "two or three components of motion. The level `pendulum` against `contact`, which is "
            "held against rigid bodies in [slip.md](slip.md); `dt=None`; peaks of single steps.",
            "",
            "Errors of bearings in per cent: nine in ten are smaller (least to largest).",
            "",
            table(("class", "bearings", *SHOWN), rows),
            "",
            f"Errors of a slip below {100 * LEAST_SLIP:.0f} % of the capacity are over that, of a "
            f"rim force below {100 * LEAST_RIM:.0f} % of the bearing's force over that.",
            "",
            "## What is kept at the level `pendulum`",
            "",
            f'`level="auto"` keeps runs in which no bearing met a rim or lifted: {kept} of '
            f"{len(fine)}. Of these {wrong} are more than 5 % off in displacement, force, axial "
            "force, rim force or base shear of a bearing, or more than 10 % in slip.",
            "",
            f"Runs that end otherwise: {said or 'none'}. Test cases lost: {', '.join(lost) or 'none'}.",
            "",
            f"Time of the loops: {seconds[1] / max(seconds[0], 1e-9):.1f} times that of `pendulum`.",
            "",
        )
    )


def main(given: Sequence[str] | None = None) -> None:
    """Run the test cases and write the page."""
    parser = argparse.ArgumentParser(prog="python -m validation.measurements.level_doubts")
    parser.add_argument("--seed", type=int, default=1, help="series of test cases (default 1)")
    parser.add_argument("--count", type=int, default=1000, help="how many are drawn")
    parser.add_argument("--workers", type=int, default=1, help="child processes")
    parser.add_argument("--keep", type=Path, help="a file for the numbers, JSON by line")
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
    module = "python -m validation.measurements.level_doubts"
    call = f"{module} --seed {options.seed} --count {options.count}"
    TARGET.write_text(page(found, lost, call), encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
