"""The page on random test cases: what was run, how it ended, what was found."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from validation.fuzzing.checks import BALANCE, GIVEN_BACK, LEDGER, SMALL_INPUT, WORKS
from validation.fuzzing.ends import FAILED_BEARINGS, INACCURATE, LATE
from validation.fuzzing.scenes import LEVELS, MODELS
from validation.fuzzing.trial import AUTO, FINER, MARGIN, NOISE, SENSITIVE_ERROR, SMALL_PEAK, TURN
from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

Entry = dict[str, Any]
"""A report as it is kept: `Report.as_dict`."""

MOST_LISTED = 60
"""Rows of the list of findings."""
SHARES = (0.5, 0.9, 0.95, 0.99, 1.0)
GOALS = {False: (0.99, 0.01), True: (0.95, 0.03)}
"""Without and with uplift: share of the test cases [-], largest error of the peak [-]."""
KINDS = {
    "crash": "an exception that is not one of the project's, or the process died",
    "hang": "no end within the limit of time",
    "refused": "a model or an option that is refused",
    "end": "an end without time, place, remedy or warning",
    "not finite": "a number that is not finite",
    "limits": "computed on beyond a limit of the bearing, or an axial force that pulls",
    "ledger": f"gap of the energy balance above {LEDGER:g} of the input",
    "numerical": f"numerical term of the energy balance above {LEDGER:g} of the input, status ok",
    "given back": f"dissipation that falls by more than {-GIVEN_BACK:g} of its end",
    "store": f"elastic store of friction below {GIVEN_BACK:g} of its largest",
    "balance": f"masses times accelerations against forces: off by more than {BALANCE:g}",
    "works": f"work of the forces in the Dataset against the energy balance: off by more than {WORKS:g}",
    "repeat": "a second run that differs in a bit",
    "turn": f"motion turned: displacement changes by more than {TURN:g} of its peak",
    "turn ends differently": "motion turned: another end",
    "mirror": "seen in a mirror: the same",
    "mirror ends differently": "seen in a mirror: another end",
    "auto": f'level="auto" against all features: the peak differs by more than {AUTO:g}',
    "finer ends differently": f"chosen step against one {FINER} times finer: another end",
    "gravity": "no equilibrium under the weight",
    "weight": "bearings of a building that do not carry its weight",
    "rest": "a building that moves without a motion",
}
"""What is looked for, in the order of the page."""


def write(scenes: Sequence[Entry], buildings: Sequence[Entry], call: str, spent: str) -> str:
    """Return the page."""
    everything = [*scenes, *buildings]
    bad = sum(bool(entry["findings"]) for entry in everything)
    return (
        "\n\n".join(
            [
                "# Random test cases",
                f"Written by `{call}`: {len(scenes)} test cases and {len(buildings)} buildings under their "
                f"weight, {spent}. {bad} of them have a finding.",
                "A test case is a model, a motion and the options of its analysis, drawn from its number: "
                "bearings from a twentieth of the usual size to those of bridges, plain DCFPs among them, "
                "radii, frictions, rims and yield displacements unlike, both laws of friction; a mass, "
                "storeys or a steel frame on them; pulses, noise, spikes, steps and pauses in up to three "
                "components, the vertical one up to 1.6 g; all levels and schemes, steps given (a tenth of "
                "the motion's to eight times as much) or chosen. "
                "`python -m validation.random_scenes --seed SEED --only NUMBER` runs one again.",
                "## How they ended",
                _ends(scenes),
                "## What is looked for",
                "Every test case is run twice, once more seen in a mirror, once more with its motion turned "
                "about the vertical (one bearing; by a random angle, with contact points by quarter "
                f"turns), and where the program chooses the step with one {FINER} times finer. The energy balance "
                f"is not looked at where the input is below {SMALL_INPUT:g} of weight times effective "
                "radius. "
                "A turn, a mirror image or a feature left out is a finding where it changes the "
                f"displacement more than {MARGIN:g} times as much as a change of the motion in its ninth "
                f"digit ({NOISE:g}): what lands often or hangs on an edge amplifies every difference. "
                "A finer step must end alike: bearings fail in both or in none. Which limit of a bearing "
                "is passed first is not compared, if the times differ by no more than "
                f"{100.0 * LATE:g} %; nor a failure that the other run missed by less than the error of "
                f"the displacement, at most {100.0 * SENSITIVE_ERROR:g} % of its peak.",
                _checks(scenes, buildings),
                "## Error of the chosen step",
                f"`dt=None` against a step {FINER} times finer: error of the peak displacement, and "
                "largest difference of the displacement at any time over its peak, in per cent; a peak "
                f"below {SMALL_PEAK:g} of the effective radius counts as that.",
                _errors(scenes),
                "## Buildings under their weight",
                _gravity(buildings),
                "## Findings",
                _findings(everything),
            ]
        )
        + "\n"
    )


def _ends(scenes: Sequence[Entry]) -> str:
    columns = [*LEVELS, "mixed"]
    counts = Counter((entry["outcome"], entry["level"]) for entry in scenes)
    outcomes = sorted({entry["outcome"] for entry in scenes}, key=lambda name: (name != "ok", name))
    rows = []
    for name in outcomes:
        own = [counts[name, level] for level in columns]
        what = "completed" if name == "ok" else f"`{name}`"
        if name in FAILED_BEARINGS:
            what += " (the bearing failed)"
        elif name == INACCURATE:
            what += " (completed, and says that its energy balance is open)"
        rows.append([what, *(str(n) for n in own), str(sum(own))])
    total = [sum(entry["level"] == level for entry in scenes) for level in columns]
    rows.append(["all", *(str(n) for n in total), str(len(scenes))])
    kinds = ", ".join(
        f"{kind} {sum(entry['model'] == kind for entry in scenes)}" for kind in MODELS
    )
    lifted, met = (sum(entry[name] for entry in scenes) for name in ("has_uplift", "has_rim"))
    text = f"Models: {kinds}. {lifted} test cases lift off at some time, {met} meet a rim."
    return table(["end", *columns, "all"], rows) + "\n\n" + text


def _checks(scenes: Sequence[Entry], buildings: Sequence[Entry]) -> str:
    found = Counter(kind for e in (*scenes, *buildings) for kind in {f[0] for f in e["findings"]})
    looked = {
        "turn": _given(scenes, "turn"),
        "mirror": _given(scenes, "mirror"),
        "turn ends differently": _given(scenes, "turn"),
        "mirror ends differently": _given(scenes, "mirror"),
        "auto": [entry for entry in scenes if entry["level"] == "auto"],
        "finer ends differently": _given(scenes, "peak_error"),
    }
    rows = []
    for kind, words in KINDS.items():
        count = len(looked.get(kind, scenes))
        if kind in {"weight", "rest"}:
            count = len(buildings)
        elif kind == "gravity":
            count += len(buildings)
        rows.append([words, str(count), f"**{found[kind]}**" if found[kind] else "0"])
    complete = [entry for entry in scenes if entry["outcome"] == "ok"]
    ledger = max((entry["ledger"] for entry in scenes), default=0.0)
    numerical = max((entry["numerical"] for entry in complete), default=0.0)
    sensitive = sum((entry["sensitivity"] or 0.0) > TURN / MARGIN for entry in scenes)
    doubted = sum(bool(entry["doubts"]) for entry in scenes)
    text = (
        f"Worst gap of the energy balance: {ledger:.1e} of the input; worst numerical term of a run that "
        f"completed with the status `ok`: {numerical:.1e}. Test cases seen to be sensitive: "
        f"{sensitive}. Models or motions found strange before the run: {doubted}."
    )
    return table(["finding", "looked at", "scenes"], rows) + "\n\n" + text


def _given(scenes: Iterable[Entry], name: str) -> list[Entry]:
    return [entry for entry in scenes if entry[name] is not None]


PARTS: dict[str, Callable[[Entry], bool]] = {
    "": lambda _: True,
    ", not `inaccurate`": lambda entry: entry["outcome"] != INACCURATE,
    ", pendulum": lambda entry: entry["level"] == "pendulum",
    ", contact": lambda entry: entry["level"] == "contact",
}
"""Which test cases the errors of the chosen step are shown of."""


def _errors(scenes: Sequence[Entry]) -> str:
    rows = []
    for lifts, words in ((False, "without uplift"), (True, "with uplift")):
        measured = [e for e in _given(scenes, "peak_error") if e["has_uplift"] == lifts]
        share, limit = GOALS[lifts]
        for part, belongs in PARTS.items():
            own = [entry for entry in measured if belongs(entry)]
            if not own:
                continue
            within = float(np.mean([entry["peak_error"] <= limit for entry in own]))
            result = f"{100.0 * within:.3g} % within {100.0 * limit:g} %"
            goal = "" if part else f" (goal {100.0 * share:g} %)"
            rows.append([words + part, "peak", *_shares(own, "peak_error"), result + goal])
            if not part:
                rows.append([words, "path", *_shares(own, "path_error"), ""])
    head = ["scenes", "error of", "number", "median", "90 %", "95 %", "99 %", "worst", "result"]
    return table(head, rows)


def _shares(own: Sequence[Entry], name: str) -> list[str]:
    values = 100.0 * np.quantile([entry[name] for entry in own], SHARES)
    return [str(len(own)), *(f"{value:.2g}" for value in values)]


def _gravity(buildings: Sequence[Entry]) -> str:
    rows = []
    for name, count in Counter(entry["outcome"] for entry in buildings).most_common():
        messages = Counter(_kind_of(e["message"]) for e in buildings if e["outcome"] == name)
        rows.append([f"`{name}`", str(count), "; ".join(messages)])
    return (
        "Frames and sticks of one to six storeys on 4 to 16 bearings, sliders loaded from 2 to "
        "400 MPa, yield displacements down to a tenth of a micrometre: equilibrium, and rest for "
        "a moment without a motion.\n\n" + table(["end", "buildings", "what it says"], rows)
    )


def _kind_of(message: str) -> str:
    # The first words of a message, without its numbers and names.
    words = message.split(": ", 1)[-1].split(". What to try")[0]
    return "".join(c for c in words.split('"')[0].split(" at ")[0] if not c.isdigit())[:90].strip()


def _findings(entries: Sequence[Entry]) -> str:
    rows = []
    order = list(KINDS)
    listed = [
        (order.index(kind) if kind in order else -1, -abs(size), kind, words, entry)
        for entry in entries
        for kind, size, words in entry["findings"]
    ]
    if not listed:
        return "None."
    for _, _, kind, words, entry in sorted(listed, key=lambda row: row[:2])[:MOST_LISTED]:
        name = f"building {entry['number']}" if entry["model"] == "building" else entry["number"]
        rows.append([str(name), kind, words[:160], entry["scene"]])
    text = table(["number", "kind", "what", "scene"], rows)
    if len(listed) > MOST_LISTED:
        text += f"\n\n{len(listed) - MOST_LISTED} further findings are not listed."
    return text
