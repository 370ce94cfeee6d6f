"""The slip of the interface over random test cases that meet rims: writes docs/validation/slip.md.

    python -m validation.measurements.slip --count 1000 --workers 2

Bearings and motions of two or three components are drawn; each motion is scaled until the slider
meets its rims. The levels 'pendulum' and 'contact' are compared with 'rigid_body', whose sliders
have a mass, and with both what `level="auto"` calls sufficient. Test cases are run in child processes.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CubicSpline

from frames import audit
from frames.results.assumption_checks import needed_level
from validation import held_slip
from validation.fuzzing.level_scenes import meeting, random_rim_scene
from validation.fuzzing.pool import kept, series, series_parser
from validation.page import FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

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
Entry = dict[str, Any]

LEAST = 0.02
"""Slip over the capacity: errors of a smaller largest slip are over this one [-]."""
LEAST_RIM = 0.05
"""Rim force over the bearing's force: errors of a smaller rim force are over this one [-]."""
ALLOWED = {
    "displacement": 0.05,
    "force": 0.05,
    "axial": 0.05,
    "rim_bottom": 0.05,
    "rim_top": 0.05,
    "slip": 0.1,
    "left": 0.1,
}
"""Errors up to which a run that is called sufficient keeps its promise [-]."""
FINE = ("ok", "inaccurate")
SHOWN = 12
BOUNDS = (3.0, 5.0, 10.0)
SPREAD = ("median", "90 % below", "worst", *(f"within {bound:g} %" for bound in BOUNDS))
NAMES = {
    "slip": "largest slip",
    "left": "residual slip, over the largest",
    "displacement": "peak displacement",
    "force": "force (99.9 %)",
    "axial": "axial force (99.9 %)",
    "rim_bottom": "bottom rim's force (99.9 %)",
    "rim_top": "top rim's force (99.9 %)",
}


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


def ends_well(entry: Entry, level: str) -> bool:
    """Return whether a run came to its end without a failure of the bearing."""
    return entry[level]["status"] in FINE


def errors(entry: Entry, level: str) -> dict[str, float]:
    """Return the errors of a level against the rigid bodies [-]."""
    ours, theirs = entry[level], entry["rigid_body"]
    slip = max(theirs["slip"], LEAST * entry["capacity"])
    scales = {"slip": slip, "left": slip} | {
        n: theirs[n] for n in ("displacement", "force", "axial")
    }
    least = LEAST_RIM * theirs["force"]
    scales |= {name: max(theirs[name], least) for name in ("rim_bottom", "rim_top")}
    return {name: abs(ours[name] - theirs[name]) / scale for name, scale in scales.items()}


def of_levels(entries: Sequence[Entry], title: str) -> list[tuple[str, ...]]:
    """Return rows on a group of test cases: errors of both levels."""
    rows = []
    for level in ("pendulum", "contact"):
        fit = [e for e in entries if ends_well(e, level) and ends_well(e, "rigid_body")]
        each = [errors(entry, level) for entry in fit]
        for name, words in NAMES.items():
            e = 100.0 * np.array([one[name] for one in each])
            if len(e) == 0:
                continue
            rows.append((f"{title} ({len(fit)})", f"`{level}`", words, *_spread(e)))
    return rows


def promise(entries: Sequence[Entry]) -> tuple[list[Entry], list[Entry]]:
    """Return the test cases that are called sufficient at 'pendulum', and those that miss it."""
    sufficient = [e for e in entries if e["sufficient"]]
    missed = [
        e
        for e in sufficient
        if ends_well(e, "pendulum") != ends_well(e, "rigid_body")
        or (
            ends_well(e, "rigid_body")
            and any(errors(e, "pendulum")[name] > most for name, most in ALLOWED.items())
        )
    ]
    return sufficient, missed


def unlike(entries: Sequence[Entry], level: str) -> list[Entry]:
    """Return the test cases that end with a failure at one of both levels alone."""
    return [e for e in entries if ends_well(e, level) != ends_well(e, "rigid_body")]


def _spread(e: FloatArray) -> tuple[str, ...]:
    # The cells under `SPREAD` of errors [%].
    shares = (f"{(e <= bound).mean():.1%}" for bound in BOUNDS)
    return f"{np.median(e):.2g}", f"{np.percentile(e, 90):.2g}", f"{e.max():.3g}", *shares


def changed(alike: Sequence[Entry], past: Sequence[Entry]) -> list[tuple[str, ...]]:
    """Return rows on the errors of 'pendulum' earlier and now, in test cases alike."""
    were = {entry["number"]: entry for entry in past}
    rows = []
    for name, words in NAMES.items():
        for title, entries in (("before", [were[e["number"]] for e in alike]), ("now", alike)):
            e = 100.0 * np.array([errors(entry, "pendulum")[name] for entry in entries])
            rows.append((words, title, *_spread(e)))
    return rows


def page(
    found: Sequence[Entry],
    lost: Sequence[str],
    call: str,
    before: Sequence[Entry] = (),
    rig: Sequence[tuple[str, ...]] = (),
    head: tuple[str, ...] = (),
) -> str:
    """Return the page."""
    met = [entry for entry in found if entry["factor"] is not None]
    even = [
        e
        for e in met
        if ends_well(e, "pendulum") and ends_well(e, "rigid_body") and not e["unequal"]
    ]
    groups: tuple[tuple[str, Callable[[Entry], bool]], ...] = (
        ("equal rims, no uplift", lambda e: not e["unequal"] and not e["rigid_body"]["lifts"]),
        ("unequal rims", lambda e: bool(e["unequal"])),
        ("uplift", lambda e: bool(e["rigid_body"]["lifts"])),
    )
    earlier = {entry["number"]: entry["pendulum"] for entry in before if "pendulum" in entry}
    past = [e | {"pendulum": earlier[e["number"]]} for e in met if e["number"] in earlier]
    alike = [e for e in even if e["number"] in earlier and not e["rigid_body"]["lifts"]]
    asked = [entry for entry in met if "by_step" in entry]
    sufficient, missed = promise(met)
    return render(
        globals(),
        alike=alike,
        apart=sorted(
            even, key=lambda e: -max(errors(e, "pendulum")[name] for name in ("slip", "left"))
        )[:SHOWN],
        asked=asked,
        call=call,
        changes=changed(alike, past) if earlier else [],
        earlier=earlier,
        ends=unlike(met, "pendulum"),
        found=found,
        head=head,
        lines=[
            row for title, fits in groups for row in of_levels([e for e in met if fits(e)], title)
        ],
        lost=lost,
        met=met,
        missed=missed,
        other=[
            e
            for e in asked
            if any((status in FINE) is not ends_well(e, "pendulum") for status in e["by_step"])
        ],
        past=past,
        rig=rig,
        spun=sum(abs(e["rigid_body"]["spin"]) > 0.05 for e in met),
        sufficient=sufficient,
    )


def _listed(entries: Sequence[Entry]) -> str:
    parts = []
    for entry in entries:
        each = errors(entry, "pendulum")
        worst = max(each, key=lambda name: each[name] / ALLOWED[name])
        parts.append(f"{entry['number']} ({NAMES[worst].split(',')[0]}: {each[worst]:.0%})")
    return "Scenes " + ", ".join(parts) + "."


def main(given: Sequence[str] | None = None) -> None:
    """Run the test cases and write the page."""
    parser = series_parser("validation.measurements.slip", count=1000)
    parser.add_argument("--before", type=Path, help="such a file of an earlier state of the code")
    options = parser.parse_args(given)
    run = partial(perform, seed=options.seed)
    found, hung = series(run, range(options.count), options, LIMIT)
    found.sort(key=lambda entry: int(entry["number"]))
    lost = [f"{number} ({how})" for number, how in hung]
    call = f"{parser.prog} --seed {options.seed} --count {options.count}"
    text = page(found, lost, call, kept(options.before), held_slip.rows(), held_slip.HEAD)
    TARGET.write_text(text, encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
