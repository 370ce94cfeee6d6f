"""The page on random test cases: what was run, how it ended, what was found."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from validation.fuzzing import checks, trial
from validation.fuzzing.checks import BALANCE, GIVEN_BACK, INACCURATE, LEDGER, WORKS
from validation.fuzzing.scenes import LEVELS, MODELS
from validation.fuzzing.trial import AUTO, FINER, TURN
from validation.page import render

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

Entry = dict[str, Any]
"""A report as it is kept: `Report.as_dict`."""

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
    return render(
        globals(),
        buildings=buildings,
        call=call,
        checks=checks,
        columns=[*LEVELS, "mixed"],
        counts=Counter((entry["outcome"], entry["level"]) for entry in scenes),
        everything=everything,
        found=Counter(kind for e in everything for kind in {f[0] for f in e["findings"]}),
        ledgers=[0.0, *(entry["ledger"] for entry in scenes)],
        listed=listed(everything),
        models=MODELS,
        numerical=[0.0, *(entry["numerical"] for entry in scenes if entry["outcome"] == "ok")],
        outcomes=sorted({e["outcome"] for e in scenes}, key=lambda name: (name != "ok", name)),
        scenes=scenes,
        sensitive=sum((e["sensitivity"] or 0.0) > trial.TURN / trial.MARGIN for e in scenes),
        spent=spent,
        trial=trial,
    )


def looked_at(kind: str, scenes: Sequence[Entry], buildings: Sequence[Entry]) -> int:
    """Return how many test cases were looked at for a kind of finding."""
    if kind in {"weight", "rest"}:
        return len(buildings)
    if kind == "auto":
        return sum(entry["level"] == "auto" for entry in scenes)
    value = {"finer": "peak_error"}.get(kind.split()[0], kind.split()[0])
    if value in {"turn", "mirror", "peak_error"}:
        return len(given(scenes, value))
    return len(scenes) + (len(buildings) if kind == "gravity" else 0)


def given(scenes: Iterable[Entry], name: str) -> list[Entry]:
    """Return the test cases of which a value was measured."""
    return [entry for entry in scenes if entry[name] is not None]


PARTS: dict[str, Callable[[Entry], bool]] = {
    "": lambda _: True,
    ", not `inaccurate`": lambda entry: entry["outcome"] != INACCURATE,
    ", pendulum": lambda entry: entry["level"] == "pendulum",
    ", contact": lambda entry: entry["level"] == "contact",
}
"""Which test cases the errors of the chosen step are shown of."""


def errors(scenes: Sequence[Entry]) -> list[list[str]]:
    """Return rows on the errors of the chosen step."""
    rows = []
    for lifts, words in ((False, "without uplift"), (True, "with uplift")):
        measured = [e for e in given(scenes, "peak_error") if e["has_uplift"] == lifts]
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
    return rows


def _shares(own: Sequence[Entry], name: str) -> list[str]:
    values = 100.0 * np.quantile([entry[name] for entry in own], SHARES)
    return [str(len(own)), *(f"{value:.2g}" for value in values)]


def gravity(buildings: Sequence[Entry]) -> list[list[str]]:
    """Return rows on the ends of buildings under their weight, and what they say."""
    return [
        [
            f"`{name}`",
            str(count),
            "; ".join(Counter(_kind_of(e["message"]) for e in buildings if e["outcome"] == name)),
        ]
        for name, count in Counter(entry["outcome"] for entry in buildings).most_common()
    ]


def _kind_of(message: str) -> str:
    # The first words of a message, without its numbers and names.
    words = message.split(": ", 1)[-1].split(". What to try")[0]
    return "".join(c for c in words.split('"')[0].split(" at ")[0] if not c.isdigit())[:90].strip()


def listed(entries: Sequence[Entry]) -> list[list[str]]:
    """Return rows on all findings, in the order of the page and by size."""
    order = list(KINDS)
    found = [
        (order.index(kind) if kind in order else -1, -abs(size), kind, words, entry)
        for entry in entries
        for kind, size, words in entry["findings"]
    ]
    return [
        [
            f"building {entry['number']}" if entry["model"] == "building" else str(entry["number"]),
            *(kind, words[:160], entry["scene"]),
        ]
        for _, _, kind, words, entry in sorted(found, key=lambda row: row[:2])
    ]
