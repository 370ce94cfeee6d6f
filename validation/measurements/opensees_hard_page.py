"""The page on hard cases with OpenSees' elements: its tables, remarks and text."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lir_element.opensees import opensees
from validation.opensees.trials import CODES, ITERATIONS, TOLERANCE
from validation.opensees.worker import LIMIT
from validation.page import table
from validation.scenes import MASS

GROUPS = {
    "impacts": ("impact",),
    "axial load to zero": ("axial load",),
    "uplift": ("uplift",),
    "38 Hz": ("38 Hz",),
}
"""Kinds of cases, by words in their names."""
OFF = 5.0
"""Error of the peak from which a completed run counts as off [%]."""
MADE = 0.01
"""Energy made, over the work done on the device, from which it counts."""


@dataclass(frozen=True)
class Entry:
    """A row of the table."""

    case: str
    kind: str
    model: str
    setting: str
    status: str
    reached: float
    peak: float
    error: float
    """Of the peak against the reference, up to where both go [%]."""
    balance: float
    made: float


def line(entry: Entry) -> tuple[str, ...]:
    """Return an entry as a row."""
    return (
        entry.case,
        entry.kind,
        entry.model,
        entry.setting,
        ended(entry),
        _number(1e3 * entry.peak),
        _number(entry.error, 2),
        _number(entry.balance, 1),
        _number(entry.made, 1),
    )


def _number(value: float, digits: int = 4) -> str:
    if np.isnan(value):
        return ""
    if 10.0**digits <= abs(value) < 1e5:
        return f"{value:.0f}"
    return f"{value + 0.0:.{digits}g}"


def ended(entry: Entry) -> str:
    """Return how a run ended."""
    if entry.status == "ok":
        return "completed"
    if np.isnan(entry.reached):
        return f"**{entry.status}**"
    kind = entry.status if entry.status in CODES.values() else f"`{entry.status}`"
    return f"stopped ({kind}) at {entry.reached:.3g} s"


def summary(found: list[Entry]) -> str:
    """Return the table of counts by model and setting."""
    rows = []
    for model, setting in dict.fromkeys((e.model, e.setting) for e in found):
        own = [e for e in found if (e.model, e.setting) == (model, setting)]
        good = [e for e in own if e.status == "ok"]
        worst = max((e.error for e in good), default=float("nan"))
        largest = max((e.peak for e in own if not np.isnan(e.peak)), default=float("nan"))
        rows.append(
            (
                model,
                setting,
                str(len(own)),
                str(len(good)),
                str(
                    sum(
                        e.status not in {"ok", "not finite"} and not np.isnan(e.reached)
                        for e in own
                    )
                ),
                str(sum(np.isnan(e.reached) for e in own)),
                str(sum(e.status == "not finite" for e in own)),
                str(sum(e.error > OFF for e in good)),
                _number(worst, 2),
                _number(1e3 * largest),
                str(sum(e.made > MADE for e in own)),
            )
        )
    head = (
        "model",
        "setting",
        "runs",
        "completed",
        "stopped",
        "hung or crashed",
        "not finite",
        f"completed, peak off by more than {OFF:g} %",
        "largest error of a completed run [%]",
        "largest displacement [mm]",
        f"energy made, more than {100.0 * MADE:g} %",
    )
    return table(head, rows)


def by_group(found: list[Entry]) -> str:
    """Return the table of completed runs and their largest error, by model and kind of case."""
    rows = []
    for model in dict.fromkeys(e.model for e in found):
        cells = []
        for words in GROUPS.values():
            own = [e for e in found if e.model == model and any(word in e.case for word in words)]
            good = [e.error for e in own if e.status == "ok"]
            worst = f", {_number(max(good), 2)} %" if good else ""
            cells.append(f"{len(good)} of {len(own)}{worst}" if own else "")
        rows.append((model, *cells))
    return table(("model", *GROUPS), rows)


def remarks(found: list[Entry], capacity: float) -> list[str]:
    """Return what stands out, with its numbers."""
    lost = sum(np.isnan(e.reached) or e.status == "not finite" for e in found)
    at_rims = [e for e in found if e.model == "TFP" and e.peak > 0.98 * capacity]
    stopped = sum(e.status != "ok" for e in at_rims)
    far = max((e for e in found if e.status == "ok"), key=lambda e: e.peak)
    macro = [e for e in found if e.model == "macro-model"]
    beyond = max((e for e in macro if e.status == "ok"), key=lambda e: e.peak)
    lifted = [e for e in macro if "uplift" in e.case]
    newton = [e for e in lifted if "Newton" in e.setting]
    fallback = [e.error for e in lifted if "fallback" in e.setting and e.status == "ok"]
    made = max((e for e in found if e.status == "ok"), key=lambda e: e.made)
    return [
        f"- {lost} of {len(found)} runs hung, crashed or ended in numbers that are not finite.",
        f"- TFP reached its rims in {len(at_rims)} runs and stopped there in {stopped}.",
        f"- A completed run need not be one to believe: {far.model} ({far.setting}) ends "
        f'"{far.case}" after {far.peak:.3g} m.',
        f"- Lifting off, the macro-model stops in {sum(e.status != 'ok' for e in newton)} of "
        f"{len(newton)} runs with plain Newton; with the fallback it completes "
        f"{len(fallback)} of {len(lifted) - len(newton)}, its peaks off by "
        f"{_number(min(fallback), 2)} to "
        f"{_number(max(fallback), 2)} %.",
        f'- The macro-model has no limits: "{beyond.case}" goes on to {beyond.peak:.2f} m, where '
        "the bearing has long snapped back (`slip_unstable`).",
        f"- Most energy made in a completed run: {100.0 * made.made:.0f} % of the work, "
        f"{made.model} "
        f'({made.setting}), "{made.case}".',
        "- In uplift the level 'pendulum' of the element is off, too: sliders that lift rock, "
        "which "
        "is what the level 'contact' is for.",
        "- Steps of 50 ms do not see a shock of 100 ms: the error there is the motion's.",
    ]


def write(
    found: list[Entry], sizes: list[Entry], traces: str, *, capacity: float, dt: float, alike: float
) -> str:
    """Return the page."""
    findings = (
        "Completed runs and the largest error of their peaks, all cases but those of several "
        "steps:",
        by_group(found),
        "By setting:",
        summary(found),
        "\n".join(remarks(found, capacity)),
    )
    found = [*found, *sizes]
    version = opensees().version()
    head = (
        "case",
        "device",
        "model",
        "step [ms], algorithm",
        "outcome",
        "peak [mm]",
        "error [%]",
        "balance",
        "energy made",
    )
    return (
        "\n\n".join(
            [
                "# Hard cases with OpenSees' elements",
                "Written by `python -m validation.measurements.opensees_hard_cases`. "
                f"{len(found)} runs, OpenSees {version}. A mass of {1e-3 * MASS:.0f} t on one bearing, "
                "that of the paper's section 3.1 with constant friction 0.065; motions of "
                "[hard_cases.md](hard_cases.md).",
                "**Models.** Each is compared with the element of this package in the same duty: a "
                "pendulum without rims (singleFPBearing, FPBearingPTV), one with rims "
                "(TripleFrictionPendulum, TFP), and the LIR-DCFP "
                "([macro-model](opensees_macro_model.md)). The first four are given what "
                "`lir_element.opensees.builtin_element` gives them; TFP, whose rims it refuses, gets "
                "dishes that end at them. TripleFrictionPendulum and TFP choose the stiffness of their "
                "rims by themselves: their peaks beyond a rim need not be those of the reference.",
                "**Settings.** Newmark's average acceleration, test NormUnbalance of "
                f"{TOLERANCE:g} of the weight, {ITERATIONS} iterations, Transformation, BandGeneral. "
                "*Newton*: plain, stops where it fails. *Fallback*: where Newton fails KrylovNewton, then "
                "ModifiedNewton with the initial stiffness, then the step in halves, six times. The "
                "element "
                f"runs at {1e3 * dt:g} ms and halves its steps by itself. A run that takes more than "
                f"{LIMIT:g} s hangs. They run in a separate process, replaced after a crash or a hang.",
                "**Columns.** Error: of the largest displacement against the level 'rigid_body', up to the "
                "end of the shorter run. Balance: input less kinetic energy less work done on the device, "
                "over the largest input (element: the energy balance). Energy made: the largest amount that the "
                "device gave back of what it had taken up beyond what a pendulum under its axial load, "
                "`N U²/2L`, and its axial spring store, over the largest work, at instants at which it is "
                "off "
                f"the rims and N within {100.0 * alike:g} % of the weight "
                "(element: the largest step back of friction's dissipation). A restoring force that "
                "follows N without a rise of the mass makes and loses energy where N varies.",
                "## Findings",
                *findings,
                "## Steps taken back",
                "A step of 2 mm is tried with one iteration, fails, and is taken back by OpenSees; then "
                "three steps without motion follow. The lateral force that stays, over that of friction, "
                "should be zero. In singleFPBearing and flatSliderBearing an elastic trial leaves the "
                "plastic "
                "displacement of the trial before it, and the next commit keeps it: whatever Newton's "
                "method tried on its way becomes history (seen in their source, `ubPlastic`). A fallback "
                "that "
                "tries a step again therefore goes on from another state: runs complete, and are off.",
                traces,
                "## Runs",
                table(head, [line(entry) for entry in found]),
            ]
        )
        + "\n"
    )
