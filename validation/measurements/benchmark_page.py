"""The page of the benchmark, in Markdown."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from validation.measurements.benchmark_batch import HISTORIES, LENGTH, THERE
from validation.measurements.benchmark_cases import EFFORTS, METHODS, device_of
from validation.measurements.benchmark_models import SCALE, STRUCTURES
from validation.measurements.benchmark_runs import RESCUES, USUAL
from validation.measurements.benchmark_search import (
    ALLOWED,
    CANDIDATES,
    DURATION,
    FINE,
    STEPS,
    setting_of,
)
from validation.measurements.benchmark_tables import (
    bound,
    growth,
    growth_with_steps,
    second_cost,
    short,
    there_are,
    whole_cost,
)
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Sequence

LIMITS = (
    "- CPU time of the process, steps alone: neither program builds the model, finds the "
    "equilibrium at rest or reads its results in it. Where whole runs are meant it is said.",
    "- Both have one thread: those of the dense algebra spin while they wait, and would count as "
    "CPU time.",
    "- Both record the bearings' displacements at every step, OpenSees to a file.",
    f"- A step of OpenSees that its algorithm does not solve is taken by KrylovNewton; a setting "
    f"that needs that in more than {100.0 * RESCUES:g} % of the steps is given up.",
    "- Of cases c and d OpenSees runs a window of the strong motion alone, with the steps "
    "of the building on nine bearings and the setting that is cheapest in five of its own steps, "
    "whatever its error; its cost for a whole motion follows from its cost a step.",
    "- The elements of OpenSees have laws of their own: what separates their peaks from ours with "
    "all steps small is another matter, [opensees_pendulum.md](opensees_pendulum.md), "
    "[opensees_macro_model.md](opensees_macro_model.md).",
    "- Here a step counts if all smaller ones keep the error, too; in OpenSees the largest one "
    "that does is taken.",
)


def text(kept: dict[str, Any]) -> str:
    """Return the page from what was kept; what was not measured is left out."""
    dates = sorted({one["when"] for one in kept.values() if isinstance(one, dict)})
    measured = there_are(kept)
    missing = [
        f"{one.name} ({kept.get(key, {}).get('state', 'not run')})"
        for key, one in STRUCTURES.items()
        if one not in measured
    ]
    parts = [
        "# Cost for the same accuracy, beside OpenSees",
        f"Written by `python -m validation.measurements.benchmark`; measured {_span(dates)} on "
        f"{kept.get('machine', 'no machine yet')}.",
        f"Each program takes the largest step that keeps the peak displacement of the bearings "
        f"within {100.0 * ALLOWED:g} % of its converged value (here {1e3 * FINE['here']:g} ms; "
        f"OpenSees {1e3 * FINE['there']:g} ms, of what yields {1e3 * FINE['yielding']:g} ms; with "
        "our element in it that of ours). With these steps they run in turns over the strong part "
        f"of the motion; ratios are medians of those within a turn. Motion: Newhall 1994 times {SCALE:g}, at 30 degrees in plan, {DURATION:g} "
        "s, or synthetic motions where the record is missing. The LIR-DCFP meets its rims; the plain DCFP "
        "has none. Usual settings of OpenSees: "
        f"{USUAL.name}. Its best: system, algorithm, numberer and test are varied one after the "
        f"other; the {CANDIDATES} settings cheapest a step and the usual one then each take their "
        "largest step, and the cheapest a second of motion counts.",
        "![Cost over number of bearings, and error over cost](figures/benchmark-cost.png)",
        "## In short",
        "How often OpenSees costs what this program does, with the element of it that is cheapest:",
        table(("structure", "device", "in OpenSees", "usual / here", "best / here"), short(kept)),
        *_bounds(kept),
        "## Cost",
        table(
            (
                "structure",
                "unknowns",
                "in OpenSees",
                "step here [ms]",
                "steps there [ms]",
                "here [ms/s]",
                "usual [ms/s]",
                "best [ms/s]",
                "usual / here",
                "best / here",
            ),
            [row for one in measured for row in cost_rows(kept[one.key])],
        ),
        "Steps there: usual and best settings. ms/s: CPU time of a second of the motion. "
        + _refusals(kept),
        *([f"Not measured: {'; '.join(missing)}."] if missing else []),
        "## Steps",
        *_steps(kept),
        "## Settings of OpenSees",
        *_settings(kept),
        "## Growth",
        *_growth(kept),
        "## Many histories",
        *_batch(kept),
        "## What bounds a step",
        *_profiles(kept),
        "## How it is measured",
        "\n".join(LIMITS),
    ]
    return "\n\n".join(parts) + "\n"


def cost_rows(found: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return the rows of a structure in the table of costs: a row a kind and method."""
    name, sizes, rows = STRUCTURES[found["key"]].name, found["sizes"], []
    for kind, pairs in found["pairs"].items():
        there = found["there"][kind]
        for method in METHODS:
            if method not in pairs:
                continue
            ratios = pairs["ratios"]
            rows.append(
                (
                    name,
                    str(sizes["unknowns"]),
                    kind,
                    f"{_ms(found['here'][device_of(kind)][method]['dt'])} ({method})",
                    f"{_ms(there['usual']['dt'])}, {_ms(there['best']['dt'])}",
                    *(
                        _number(1e3 * second_cost(found, kind, who))
                        for who in (method, "usual", "best")
                    ),
                    *(
                        _number(ratios.get(f"{who} over {method}", math.nan))
                        for who in ("usual", "best")
                    ),
                )
            )
    return rows


def _span(dates: Sequence[str]) -> str:
    if not dates:
        return "never"
    return dates[0] if dates[0] == dates[-1] else f"{dates[0]} to {dates[-1]}"


def _number(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:g}" if math.isfinite(seconds) else "stops"


def _refusals(kept: dict[str, Any]) -> str:
    for one in there_are(kept):
        for methods in kept[one.key]["here"].values():
            for method, values in methods.items():
                if "refused" in values:
                    return f"The method {method} is left out: {values['refused']}."
    return ""


def _bounds(kept: dict[str, Any]) -> list[str]:
    spent = kept.get("profile", {})
    said = [
        f"{STRUCTURES[key].name}: {bound(values)}"
        for key, values in spent.items()
        if key in STRUCTURES and values
    ]
    return [f"What takes most of a step here: {'; '.join(said)}."] if said else []


def _steps(kept: dict[str, Any]) -> list[str]:
    rows = []
    for one in there_are(kept):
        if not EFFORTS[one.case].full:
            continue
        for device, methods in kept[one.key]["here"].items():
            for method, found in methods.items():
                for run, error in zip(found.get("runs", []), found.get("errors", []), strict=True):
                    rows.append(
                        (
                            one.name,
                            device,
                            method,
                            f"{1e3 * run['dt']:g}" if math.isfinite(run["dt"]) else "its own",
                            str(run["steps"]),
                            f"{100.0 * error:.3f}",
                            f"{1e3 * run['loop']:.1f}",
                            f"{1e3 * run['whole']:.0f}",
                            run["status"],
                        )
                    )
    head = (
        "structure",
        "device",
        "method",
        "dt [ms]",
        "steps",
        "error of the peak [%]",
        "steps alone [ms]",
        "whole call [ms]",
        "status",
    )
    return [f'Runs of {DURATION:g} s here; "its own" is `dt=None`.', table(head, rows)]


def _settings(kept: dict[str, Any]) -> list[str]:
    rows = []
    for one in there_are(kept):
        for kind, there in kept[one.key]["there"].items():
            if "tried" not in there:
                continue
            best = there["best"]
            stopped = sum(not math.isfinite(cost) for cost in there["tried"].values())
            theirs, ours = whole_cost(kept[one.key], kind)
            rows.append(
                (
                    one.name,
                    kind,
                    setting_of(best["setting"]).name,
                    _ms(best["dt"]),
                    f"{100.0 * best['error']:.2f}",
                    str(best.get("rescued", 0)),
                    f"{stopped} of {len(there['tried'])}",
                    _number(theirs),
                    _number(ours),
                )
            )
    head = (
        "structure",
        "element",
        "best setting",
        "step [ms]",
        "error [%]",
        "steps by KrylovNewton",
        "settings that stop",
        "whole run [s]",
        "here [s]",
    )
    return [
        table(head, rows),
        f"Steps {', '.join(f'{1e3 * dt:g}' for dt in STEPS)} ms. Whole run: {DURATION:g} s with "
        "building the model, equilibrium at rest and reading the results, in both programs. Of a "
        "single run here the steps are the smaller part; in a batch the rest is done once.",
    ]


def _growth(kept: dict[str, Any]) -> list[str]:
    rows = growth(kept)
    parts = []
    if rows:
        parts = [
            "Exponents of the cost of a step over the numbers of bearings and of unknowns, fitted "
            "to cases b, c and d:",
            table(("program", "over bearings", "over unknowns"), rows),
            "Not linear: a frame lets every bearing act on every other. Bearings share the "
            "slab's three unknowns, but each keeps its vertical displacement and its rotations, "
            "whose stiffness against all others is a full matrix; and the modes that are kept grow "
            "with the bearings, each coupled with all of them. Both products grow with the square. "
            "The reduced method keeps fewer modes, not fewer bearings.",
        ]
    if kept.get("b", {}).get("state") == "ok":
        parts.append(
            "Over the number of steps of the building on nine bearings, here: "
            f"{growth_with_steps(kept['b']):.2f}; below 1, for smaller steps take fewer iterations."
        )
    return parts


def _batch(kept: dict[str, Any]) -> list[str]:
    found = kept.get("e")
    if not found or found["state"] != "ok":
        return ["Not measured."]
    here = found["here"]
    each = here["cpu"] / here["histories"]
    lines = [
        f"{HISTORIES} histories of {LENGTH:g} s of the building on nine bearings, steps of "
        f"{1e3 * here['dt']:g} ms, by {here['how']}: {here['clock']:.1f} s by the clock, "
        f"{here['cpu']:.1f} s of CPU time on {here['cores']} cores, {here['memory'] / 2**30:.2f} "
        f"GiB at most ({here['before'] / 2**30:.2f} before).",
    ]
    rows = [
        (kind, str(one["run"]), _ms(one["dt"]), _number(one["cpu"]), _number(one["cpu"] / each))
        for kind, one in found["there"].items()
    ]
    head = (
        "in OpenSees, at its best",
        "histories run",
        "step [ms]",
        "CPU time of one [s]",
        "there / here",
    )
    return [
        *lines,
        table(head, rows),
        f"OpenSees runs {THERE} of them in each of {here['cores']} processes; all others cost the "
        "same.",
    ]


def _profiles(kept: dict[str, Any]) -> list[str]:
    rows = []
    for key, spent in kept.get("profile", {}).items():
        if key not in STRUCTURES or not spent:
            continue
        left = spent["step"] - spent["states"] - spent["tangents"] - spent["arithmetic"]
        rows.append(
            (
                STRUCTURES[key].name,
                f"{spent['coordinates']:.0f}, {spent['modes']:.0f}",
                f"{spent['iterations']:.2f}, {spent['states made']:.2f}, {spent['tangents made']:.2f}",
                *(f"{spent[name]:.1f}" for name in ("step", "states", "tangents")),
                f"{spent['multiply-adds']:.0f}",
                f"{spent['arithmetic']:.1f}",
                f"{left:.1f}",
                f"{spent['recording']:.1f}",
            )
        )
    if not rows:
        return ["Not measured."]
    head = (
        "structure",
        "bearing coordinates, modes",
        "iterations, states, tangents a step",
        "step [µs]",
        "state determinations [µs]",
        "tangents [µs]",
        "multiply-adds",
        "their time [µs]",
        "left [µs]",
        "recording all, on top [µs]",
    )
    return [
        table(head, rows),
        "State determinations and tangents: as often as a step makes them, at their cost alone "
        "along an orbit of 0.2 m. Multiply-adds: what mass, damping, stiffness, elimination of the "
        "modes and Newton's solutions need, counted, and their time at the machine's rate in a "
        "product of a matrix of 160 x 160 and a vector. Left: energies, control of the step, "
        "recording of the bearings' displacements; below zero where the orbit's states cost more "
        "than those of the motion.",
    ]
