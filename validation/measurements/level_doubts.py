"""What the level 'pendulum' has wrong in buildings: writes docs/validation/level_doubts.md.

    python -m validation.measurements.level_doubts --count 1000 --unlike 400 --workers 2

Random buildings on bearings, near their rims and beyond, at the levels 'pendulum' and 'contact';
others whose bearings have surfaces of unlike friction; bearing by bearing, in the classes of
`frames.results.level_doubts`. The level 'contact' is held
against rigid bodies in docs/validation/slip.md.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.results import level_doubts
from frames.results.level_doubts import CLASSES, STILL, errors_of, travels
from validation.fuzzing.level_scenes import UNLIKE_GOALS, factor_for, random_level_scene, run_level
from validation.fuzzing.pool import series, series_parser
from validation.page import FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from frames._types import FloatArray

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


def perform(task: tuple[int, bool], *, seed: int) -> dict[str, Any]:
    """Run a test case at both levels; the factor is None where it comes to no peak as wanted."""
    number, unlike = task
    model, bearing, motion, goal = random_level_scene(seed, number, unlike=unlike)
    factor = factor_for(model, bearing, motion, goal)
    found: dict[str, Any] = {"number": number, "unlike": unlike, "factor": factor}
    if factor is None:
        return found
    reach = [d / r for d, r in zip(bearing.rim_displacement, bearing.radii, strict=True)]
    found |= {"unequal": abs(reach[0] - reach[1]) > 1e-9, "capacity": bearing.lateral_capacity}
    found |= {"length": bearing.effective_radius, "friction": [f.f_max for f in bearing.frictions]}
    for level in ("pendulum", "contact"):
        data = run_level(model, motion, factor, level)
        found[level] = {
            "status": str(data.attrs["status"]),
            "seconds": float(data.attrs["seconds_loop"]),
            "base_shear": float(data["peak_base_shear"]),
        }
        for name in (*REACHED, "eccentricity", "lifted"):
            found[level][name] = data[f"peak_{name}"].to_numpy().tolist()
    return found


def classes(entry: dict[str, Any]) -> list[str]:
    """Return the class of each bearing, by its run at the level 'pendulum'."""
    ours = {name: np.array(value) for name, value in entry["pendulum"].items()}
    met, lifted = ours["rim_force"] > 0.0, ours["lifted"] > 0.0
    unequal = np.full(met.shape, entry["unequal"])
    friction = np.array([entry["friction"]] * len(met))
    travel = travels(ours["displacement"], friction, np.full(met.shape, entry["length"]))
    errors, doubtful = errors_of(met, lifted, ours["eccentricity"], unequal, travel)
    names = {kind.errors: kind.name for kind in CLASSES}
    return [
        names[tuple(row)] if any_ else NOTHING
        for row, any_ in zip(errors.tolist(), doubtful, strict=True)
    ]


def errors(entry: dict[str, Any]) -> FloatArray:
    """Return the errors of each bearing, as `SHOWN` [-]; those of the base shear are the run's."""
    ours, theirs = entry["pendulum"], entry["contact"]
    force = np.array(theirs["force"])
    least = {
        "displacement": STILL * entry["length"],
        "slip": LEAST_SLIP * entry["capacity"],
        "rim_force": LEAST_RIM * force,
    }
    columns = []
    for name in REACHED:
        right = np.array(theirs[name])
        columns.append((np.array(ours[name]) - right) / np.maximum(right, least.get(name, 1e-12)))
    shear = ours["base_shear"] / theirs["base_shear"] - 1.0
    columns.append(np.full(len(force), shear))
    return np.stack(columns, axis=1)


class Compared(NamedTuple):
    """Runs that both levels completed, and what came of them."""

    kinds: list[str]
    """Class of each bearing."""
    off: FloatArray
    """Its errors, as `SHOWN`."""
    calm: list[bool]
    """Whether `auto` keeps the run."""
    both: list[bool]
    """Whether it keeps a run that has an error that counts."""
    ends: str
    """The runs that end otherwise."""
    ratio: float
    """Time of the loops, over that of 'pendulum'."""


def compared(found: list[dict[str, Any]]) -> Compared:
    """Sort the bearings of all runs by class."""
    runs = [entry for entry in found if entry["factor"] is not None]
    fine = [e for e in runs if e["pendulum"]["status"] == "ok" == e["contact"]["status"]]
    ends = [e for e in runs if e["pendulum"]["status"] != e["contact"]["status"]]
    seconds = [sum(e[level]["seconds"] for e in fine) for level in ("pendulum", "contact")]
    said = "; ".join(
        f"{e['number']} ({e['pendulum']['status']}, {e['contact']['status']})" for e in ends
    )
    kinds, off = [classes(entry) for entry in fine], [errors(entry) for entry in fine]
    calm = [set(those) == {NOTHING} for those in kinds]
    return Compared(
        kinds=[kind for those in kinds for kind in those],
        off=np.concatenate(off),
        calm=calm,
        both=[
            c and bool((np.abs(those) > BOUNDS).any()) for c, those in zip(calm, off, strict=True)
        ],
        ends=said or "none",
        ratio=seconds[1] / max(seconds[0], 1e-9),
    )


def spreads(those: Compared) -> dict[str, tuple[int, Iterator[tuple[float, float, float]]]]:
    """Return quantile of 90 %, least and largest of the errors, as `SHOWN`, by class [%]."""
    found: dict[str, tuple[int, Iterator[tuple[float, float, float]]]] = {}
    for kind in (NOTHING, *(each.name for each in CLASSES)):
        off = 100.0 * those.off[[own == kind for own in those.kinds]]
        if len(off):
            found[kind] = (
                len(off),
                zip(
                    np.quantile(abs(off), 0.9, axis=0),
                    off.min(axis=0),
                    off.max(axis=0),
                    strict=True,
                ),
            )
    return found


def page(
    found: list[dict[str, Any]], unlike: list[dict[str, Any]], lost: list[str], call: str
) -> str:
    """Return the page."""
    alike, other = compared(found), compared(unlike)
    count = sum(entry["factor"] is not None for entry in found)
    return render(
        globals(),
        alike=alike,
        call=call,
        count=count,
        doubts=level_doubts,
        goals=UNLIKE_GOALS,
        lost=lost,
        other=other,
    )


def main(given: Sequence[str] | None = None) -> None:
    """Run the test cases and write the page."""
    parser = series_parser("validation.measurements.level_doubts", count=1000, unlike=400)
    options = parser.parse_args(given)
    found, hung = series(
        partial(perform, seed=options.seed),
        [*((n, False) for n in range(options.count)), *((n, True) for n in range(options.unlike))],
        options,
        LIMIT,
    )
    found.sort(key=lambda entry: int(entry["number"]))
    alike, other = ([e for e in found if e["unlike"] is unlike] for unlike in (False, True))
    lost = [f"{n}{' of unlike friction' if unlike else ''} ({how})" for (n, unlike), how in hung]
    call = f"{parser.prog} --seed {options.seed} --count {options.count} --unlike {options.unlike}"
    TARGET.write_text(page(alike, other, lost, call), encoding="utf-8")
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
