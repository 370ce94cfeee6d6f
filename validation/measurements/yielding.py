"""Random buildings that yield, each at two steps: writes docs/validation/yielding.md.

    python -m validation.measurements.yielding --count 200 --workers 2
    python -m validation.measurements.yielding --only 17

Every test case is run as drawn and again at half the step, or at a quarter of the tolerance where the
program chooses the step. Test cases are run in child processes.
"""

from __future__ import annotations

import warnings
from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import energy_error, time_history
from frames.laws import Bilinear, BoucWen
from lir_element import RunStatus
from validation.fuzzing.pool import series, series_parser
from validation.fuzzing.yielding import random_yielding
from validation.measurements.benchmark_runs import cpu_clock
from validation.page import FOLDER, render

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray

TARGET = FOLDER / "yielding.md"
TOLERANCE = 1e-4
"""Error of a step over the displacement reached, the default of `time_history`."""
LEDGER = 1e-3
"""Largest gap of the energy balance that passes [-]."""
GIVEN_BACK = -1e-3
"""What a part may give back beyond what it took up, over the input of energy [-]: its work is
summed by the trapezoidal rule, in which a contact that begins within a step leaves an error."""
LIMIT = 300.0
"""Longest time for a test case with both runs [s]."""
LEAST = {"peak": 1e-3, "link": 1.0, "hinge": 1e-3}
"""From which on a value is compared: displacement [m], ductility [-], rotation [rad]."""
WORDS = {
    "peak": "peak displacement of the bearings",
    "link": "ductility of yielding storeys",
    "hinge": "plastic rotation of hinges",
}
QUANTILES = {0.5: "median", 0.9: "90 %", 1.0: "largest"}


def perform(number: int, *, seed: int) -> dict[str, Any]:
    """Run a test case at both steps and return what the page says of it."""
    with warnings.catch_warnings(
        action="ignore"
    ):  # bearings near their limits, and the ends of the runs
        frame, motion, options, words = random_yielding(seed, number)
        finer = {**options, **_finer(options["dt"])}
        with cpu_clock():
            runs = [time_history(frame, motion, **given) for given in (options, finer)]
    until = min(float(data["time"][-1]) for data in runs)
    reached = [_reached(data.sel(time=slice(0.0, until + 1e-9)), frame) for data in runs]
    data = runs[0]
    return {
        "number": number,
        "words": words,
        "frame": words.startswith("frame"),
        "adaptive": options["dt"] is None,
        "status": [str(run.attrs["status"]) for run in runs],
        "message": str(data.attrs["message"]),
        "ledger": max(energy_error(run) for run in runs),
        "given_back": min(given_back(run) for run in runs),
        "finite": all(_is_finite(run) for run in runs),
        "microseconds": 1e6 * data.attrs["seconds_loop"] / max(int(data.attrs["steps"]), 1),
        "rims": bool((data["rim_closure"] > 0.0).any()),
        **{name: [one[name] for one in reached] for name in reached[0]},
    }


def _finer(dt: float | None) -> dict[str, float]:
    return {"tolerance": 0.25 * TOLERANCE} if dt is None else {"dt": 0.5 * dt}


def _reached(data: xr.Dataset, frame: Frame) -> dict[str, float]:
    # Largest displacement of a bearing [m], ductility of a link, rotation of a hinge [rad].
    found = {"peak": _size(data["bearing_displacement"].to_numpy()[..., :2]), "link": 0.0}
    yields = [
        name for name, link in frame.links.items() if isinstance(link.law, Bilinear | BoucWen)
    ]
    if yields:
        own = data.sel(link=yields)
        found["link"] = float(np.abs(own["link_deformation"] / own["link_yield_deformation"]).max())
    turned = "hinge_rotation" in data
    found["hinge"] = _size(data["hinge_rotation"].to_numpy()[..., 1:]) if turned else 0.0
    return found


def _size(vectors: FloatArray) -> float:
    return float(np.linalg.norm(vectors, axis=-1).max())


def given_back(data: xr.Dataset) -> float:
    """Return the least work that a link or hinge has taken up, over the largest input of energy."""
    given = float(np.abs(data["energy"].sel(term="input")).max())
    least = min(float(data[name].min()) for name in ("link_work", "hinge_work") if name in data)
    return min(least, 0.0) / max(given, 1e-300)


def _is_finite(data: xr.Dataset) -> bool:
    return all(
        bool(np.isfinite(values.to_numpy()).all())
        for values in data.data_vars.values()
        if "time" in values.dims and values.dtype.kind == "f"
    )


def is_sound(entry: dict[str, Any]) -> bool:
    """Return whether both runs of a test case ended in order, with their energies."""
    named = {"ok", *(status.name.lower() for status in RunStatus if status.is_bearing_failure)}
    return (
        named.issuperset(entry["status"])
        and entry["finite"]
        and entry["ledger"] < LEDGER
        and entry["given_back"] > GIVEN_BACK
    )


def page(found: Sequence[dict[str, Any]], lost: Sequence[str], call: str) -> str:
    """Return the page from the entries of `perform`, and test cases whose process hung or died."""
    first, second = (Counter(entry["status"][k] for entry in found) for k in range(2))
    among = {
        (name, adaptive): sorted(
            (
                (float(abs(one[name][0] - one[name][1]) / one[name][1]), one)
                for one in found
                if one["adaptive"] == adaptive and one[name][1] > LEAST[name] and is_sound(one)
            ),
            key=lambda pair: pair[0],
        )
        for name in WORDS
        for adaptive in (True, False)
    }
    worst = {pairs[-1][1]["number"]: pairs[-1][1] for pairs in among.values() if pairs}
    return render(
        globals(),
        among=among,
        bad=[entry for entry in found if not is_sound(entry)],
        call=call,
        ends=[(status, first[status], second[status]) for status in sorted({*first, *second})],
        found=found,
        lost=lost,
        yielded={name: sum(one[name][0] > LEAST[name] for one in found) for name in WORDS},
        worst=sorted(worst.items()),
    )


def main(given: Sequence[str] | None = None) -> int:
    """Run the test cases and write the page; return how many are not sound."""
    parser = series_parser("validation.measurements.yielding", count=200)
    parser.add_argument("--only", type=int, metavar="NUMBER", help="run this test case alone")
    options = parser.parse_args(given)
    if options.only is not None:
        for name, value in perform(options.only, seed=options.seed).items():
            print(f"{name:>12}: {value}")
        return 0
    run = partial(perform, seed=options.seed)
    found, hung = series(run, range(options.count), options, LIMIT)
    found.sort(key=lambda entry: int(entry["number"]))
    lost = [
        f"{n} ({random_yielding(options.seed, n)[3]}): "
        + (f"not done within {LIMIT:g} s" if how == "hang" else how)
        for n, how in hung
    ]
    call = f"{parser.prog} --seed {options.seed} --count {options.count}"
    TARGET.write_text(page(found, lost, call), encoding="utf-8")
    return len(lost) + sum(not is_sound(entry) for entry in found)


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
