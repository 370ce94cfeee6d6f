"""Random buildings that yield, each at two steps: writes docs/validation/yielding.md.

    python -m validation.measurements.yielding --count 200 --workers 2
    python -m validation.measurements.yielding --only 17

Every test case is run as drawn and again at half the step, or at a quarter of the tolerance where the
program chooses the step. Test cases are run in child processes.
"""

from __future__ import annotations

import argparse
import warnings
from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import energy_error, time_history
from frames.laws import Bilinear, BoucWen
from lir_element import RunStatus
from validation.fuzzing.pool import in_children
from validation.fuzzing.yielding import random_yielding
from validation.measurements.benchmark_runs import cpu_clock
from validation.page import FOLDER, table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

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
QUANTILES = (0.5, 0.9, 1.0)
CALL = "python -m validation.measurements.yielding"


def perform(number: int, *, seed: int) -> dict[str, Any]:
    """Run a test case at both steps and return what the page says of it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # bearings near their limits, and the ends of the runs
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
    ends = [
        (status, str(first[status]), str(second[status])) for status in sorted({*first, *second})
    ]
    bad = [entry for entry in found if not is_sound(entry)]
    texts = [
        "# Random buildings that yield",
        f"Written by `{call}`. {len(found)} test cases: sticks of one to six storeys with bilinear and "
        "Bouc-Wen storeys (degrading and pinching, too), and moment frames with hinges in beams "
        "and columns (with axial force, too), on LIR-DCFPs; some of them with dampers, ties and "
        "walls around the base. Motions are scaled to peaks of 2 to 12 m/s². Every test case is run "
        "as drawn (half of them at given steps of 2, 5 or 10 ms, the others at steps that the "
        "program chooses), and again at half the step or a quarter of the tolerance.",
        "## Ends",
        table(("end", "as drawn", "finer"), ends),
        "What the bearing names (`slip_exceeded` and its like) is a failure of the bearing, not of "
        f"the computation. The rims are met in {sum(one['rims'] for one in found)} test cases; "
        f"{_count(found, 'link')} sticks and {_count(found, 'hinge')} frames yield.",
        *_unexplained(bad, lost),
        "## Energy",
        table(
            ("what", "limit", "median", "worst"),
            [
                ("energy balance: error / input", f"{LEDGER:g}", *_middle(found, "ledger", max)),
                (
                    "work given back by a part / input",
                    f"{-GIVEN_BACK:g}",
                    *_middle(found, "given_back", min),
                ),
            ],
        ),
        "A link or hinge may give back what it stores, but never more than it has taken up.",
        "## Step",
        f"Difference of the two runs over the value of the finer one, of what is above "
        f"{1e3 * LEAST['peak']:g} mm, a ductility of {LEAST['link']:g}, or {LEAST['hinge']:g} rad; "
        "runs that end early are compared up to the end of the shorter one.",
        table(
            (
                "quantity",
                "step",
                "test cases",
                *(_quantile(q) for q in QUANTILES),
                "worst test case",
            ),
            [
                row
                for name in WORDS
                for adaptive in (True, False)
                if (row := _difference(found, name, adaptive=adaptive))
            ],
        ),
        _worst(found),
        "## Cost",
        table(
            (
                "model",
                "test cases",
                *(f"µs a step, {_quantile(q)}" for q in QUANTILES),
                "largest, runs to the end",
                "costliest test case",
            ),
            [_cost(found, kind) for kind in (False, True)],
        ),
        "CPU time of the compiled loop over its steps, what was tried and halved included. A run that "
        "ends early tries its last step again and again.",
    ]
    return "\n\n".join(text for text in texts if text) + "\n"


def _count(found: Sequence[dict[str, Any]], name: str) -> int:
    return sum(one[name][0] > LEAST[name] for one in found)


def _unexplained(bad: Sequence[dict[str, Any]], lost: Sequence[str]) -> list[str]:
    count = f"Test cases with an end that is not explained, or energies out of bounds: {len(bad)}."
    lines = [
        f"- {one['number']} ({one['words']}): {' / '.join(one['status'])}; energy balance "
        f"{one['ledger']:.1e}, given back {one['given_back']:.1e}"
        for one in bad
    ]
    lines += [f"- {one}" for one in lost]
    return [count, "\n".join(lines)]


def _middle(
    found: Sequence[dict[str, Any]], name: str, worst: Callable[[list[float]], float]
) -> tuple[str, str]:
    values = [one[name] for one in found]
    return f"{abs(np.median(values)):.1e}", f"{abs(worst(values)):.1e}"


def _quantile(share: float) -> str:
    return {0.5: "median", 1.0: "largest"}.get(share, f"{100.0 * share:g} %")


def _apart(one: dict[str, Any], name: str) -> float:
    first, second = one[name]
    return float(abs(first - second) / second)


def _compared(found: Sequence[dict[str, Any]], name: str) -> list[dict[str, Any]]:
    return [one for one in found if one[name][1] > LEAST[name] and is_sound(one)]


def _difference(
    found: Sequence[dict[str, Any]], name: str, *, adaptive: bool
) -> tuple[str, ...] | None:
    among = [one for one in _compared(found, name) if one["adaptive"] == adaptive]
    if not among:
        return None
    apart = [_apart(one, name) for one in among]
    how = "chosen, against a quarter of the tolerance" if adaptive else "given, against half of it"
    shares = (f"{100.0 * np.quantile(apart, q):.2g} %" for q in QUANTILES)
    return WORDS[name], how, str(len(among)), *shares, str(among[int(np.argmax(apart))]["number"])


def _worst(found: Sequence[dict[str, Any]]) -> str:
    named = {
        one["number"]: one
        for name in WORDS
        for adaptive in (True, False)
        for one in sorted(
            (one for one in _compared(found, name) if one["adaptive"] == adaptive),
            key=lambda one: _apart(one, name),
        )[-1:]
    }
    lines = [f"- {number}: {one['words']}" for number, one in sorted(named.items())]
    return "Test cases named there:\n\n" + "\n".join(lines) if lines else ""


def _cost(found: Sequence[dict[str, Any]], frame: bool) -> tuple[str, ...]:
    among = [one for one in found if one["frame"] == frame]
    name = "frame with hinges" if frame else "stick"
    if not among:
        return name, "0", *[""] * (len(QUANTILES) + 2)
    costs = [one["microseconds"] for one in among]
    whole = [one["microseconds"] for one in among if one["status"][0] == "ok"]
    worst = among[int(np.argmax(costs))]
    return (
        name,
        str(len(among)),
        *(f"{np.quantile(costs, q):.0f}" for q in QUANTILES),
        f"{max(whole):.0f}" if whole else "",
        f"{worst['number']}: {worst['words']}",
    )


def main(given: Sequence[str] | None = None) -> int:
    """Run the test cases and write the page; return how many are not sound."""
    parser = argparse.ArgumentParser(prog=CALL)
    parser.add_argument("--seed", type=int, default=1, help="series of test cases (default 1)")
    parser.add_argument("--count", type=int, default=200, help="how many are drawn")
    parser.add_argument("--workers", type=int, default=1, help="child processes")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="run this test case alone")
    options = parser.parse_args(given)
    if options.only is not None:
        for name, value in perform(options.only, seed=options.seed).items():
            print(f"{name:>12}: {value}")
        return 0
    found, lost = [], []
    run = partial(perform, seed=options.seed)
    for number, entry, how in in_children(run, range(options.count), options.workers, LIMIT):
        if how:
            why = f"not done within {LIMIT:g} s" if how == "hang" else how
            lost.append(f"{number} ({random_yielding(options.seed, number)[3]}): {why}")
        else:
            found.append(entry)
    found.sort(key=lambda entry: int(entry["number"]))
    call = f"{CALL} --seed {options.seed} --count {options.count}"
    TARGET.write_text(page(found, lost, call), encoding="utf-8")
    return len(lost) + sum(not is_sound(entry) for entry in found)


if __name__ == "__main__":
    raise SystemExit(min(main(), 1))
