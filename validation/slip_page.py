"""The page on the slip of the interface: its tables and text, from the numbers of the scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Entry = dict[str, Any]

LEAST = 0.02
"""Slip over the capacity: errors of a smaller largest slip are over this one [-]."""
ALLOWED = {"displacement": 0.05, "force": 0.05, "slip": 0.1, "left": 0.1}
"""Errors up to which a run that is called sufficient keeps its promise [-]."""
PLACED = 0.02
"""Slip beside the one that holds, within which the end is a matter of a per cent [-]."""
SHOWN = 12
NAMES = {
    "slip": "largest slip", "left": "slip left, over the largest",
    "displacement": "peak displacement", "force": "force (99.9 %)",
}  # fmt: skip


def ends_well(entry: Entry, level: str) -> bool:
    """Return whether a run came to its end without a failure of the bearing."""
    return entry[level]["status"] in {"ok", "inaccurate"}


def errors(entry: Entry, level: str) -> dict[str, float]:
    """Return the errors of a level against the rigid bodies [-]."""
    ours, theirs = entry[level], entry["rigid_body"]
    slip = max(theirs["slip"], LEAST * entry["capacity"])
    scales = {"slip": slip, "left": slip} | {n: theirs[n] for n in ("displacement", "force")}
    return {name: abs(ours[name] - theirs[name]) / scale for name, scale in scales.items()}


def of_levels(entries: Sequence[Entry], title: str) -> list[tuple[str, ...]]:
    """Return rows on a group of scenes: errors of both levels."""
    rows = []
    for level in ("pendulum", "contact"):
        fit = [e for e in entries if ends_well(e, level) and ends_well(e, "rigid_body")]
        each = [errors(entry, level) for entry in fit]
        for name, words in NAMES.items():
            e = 100.0 * np.array([one[name] for one in each])
            if len(e) == 0:
                continue
            rows.append((
                f"{title} ({len(fit)})", f"`{level}`", words, f"{np.median(e):.2g}",
                f"{np.percentile(e, 90):.2g}", f"{e.max():.3g}", f"{(e <= 5.0).mean():.1%}",
                f"{(e <= 10.0).mean():.1%}",
            ))  # fmt: skip
    return rows


def promise(entries: Sequence[Entry]) -> tuple[list[Entry], list[Entry]]:
    """Return the scenes that are called sufficient at 'pendulum', and those that miss it."""
    sufficient = [e for e in entries if e["sufficient"]]
    missed = [
        e for e in sufficient
        if ends_well(e, "pendulum") != ends_well(e, "rigid_body")
        or (
            ends_well(e, "rigid_body")
            and any(errors(e, "pendulum")[name] > most for name, most in ALLOWED.items())
        )
    ]  # fmt: skip
    return sufficient, missed


def unlike(entries: Sequence[Entry], level: str) -> list[Entry]:
    """Return the scenes that end with a failure at one of both levels alone."""
    return [e for e in entries if ends_well(e, level) != ends_well(e, "rigid_body")]


def page(found: Sequence[Entry], lost: Sequence[str], call: str) -> str:
    """Return the page."""
    met = [entry for entry in found if entry["factor"] is not None]
    groups: tuple[tuple[str, Callable[[Entry], bool]], ...] = (
        ("equal rims, no uplift", lambda e: not e["unequal"] and not e["rigid_body"]["lifts"]),
        ("unequal rims", lambda e: bool(e["unequal"])),
        ("uplift", lambda e: bool(e["rigid_body"]["lifts"])),
    )
    rows = [row for title, fits in groups for row in of_levels([e for e in met if fits(e)], title)]
    sufficient, missed = promise(met)
    ends = unlike(met, "pendulum")
    apart = sorted(
        (e for e in met if ends_well(e, "pendulum") and ends_well(e, "rigid_body")),
        key=lambda e: -max(errors(e, "pendulum")[name] for name in ("slip", "left")),
    )[:SHOWN]
    spun = sum(abs(e["rigid_body"]["spin"]) > 0.05 for e in met)
    share = len(missed) / max(len(sufficient), 1)
    return "\n".join([
        "# Slip of the interface, level by level", "",
        f"Written by `{call}`: {len(found)} random bearings under motions of two or three "
        f"components, scaled until the slider meets its rims, which {len(met)} do. Levels "
        "`pendulum` and `contact` against `rigid_body`, whose sliders have a mass; `dt=None`. In "
        f"{spun} scenes the sliders spin by more than 0.05 rad."
        + (f" Without a report: scenes {', '.join(lost)}." if lost else ""), "",
        table(_HEAD, rows), "",
        f"Errors in per cent; those of a slip below {LEAST:.0%} of the capacity are over that. "
        "Wide sliders rock by some millimetres before the interface slips, which `pendulum` "
        "leaves out.", "",
        "## What `level=\"auto\"` calls sufficient", "",
        f"At the level `pendulum`: {len(sufficient)} of {len(met)} scenes. Of these {len(missed)} "
        f"({share:.1%}) are more than 5 % off in displacement or force, more than 10 % in slip, or "
        "end otherwise." + (" " + _listed(missed) if missed else ""), "",
        "## Another end", "",
        table(_ENDS, [_end(entry) for entry in ends]) if ends else "None.", "",
        "Beside `slip_stability` ([theory](../theory.md), 2) the interface holds the slip or "
        "does not: a per cent decides there, and the audit of the run says so.", "",
        "## Farthest apart", "",
        table(_APART, [_apart(entry) for entry in apart]), "",
    ])  # fmt: skip


_HEAD = ("scenes", "level", "of", "median", "90 % below", "worst", "within 5 %", "within 10 %")
_ENDS = (
    "scene", "pendulum", "contact", "rigid_body", "largest slip [mm]", "slip that holds [mm]",
    "called sufficient",
)  # fmt: skip
_APART = (
    "scene", "slider radius [mm]", "rims", "slip [mm]", "slip left [mm]", "spin [rad]",
    "displacement [mm]", "called sufficient",
)  # fmt: skip
_BOTH = ("pendulum", "rigid_body")


def _listed(entries: Sequence[Entry]) -> str:
    parts = []
    for entry in entries:
        each = errors(entry, "pendulum")
        worst = max(each, key=lambda name: each[name] / ALLOWED[name])
        parts.append(f"{entry['number']} ({NAMES[worst].split(',')[0]}: {each[worst]:.0%})")
    return "Scenes " + ", ".join(parts) + "."


def _end(entry: Entry) -> tuple[str, ...]:
    return (
        str(entry["number"]),
        *(f"`{entry[level]['status']}`" for level in ("pendulum", "contact", "rigid_body")),
        ", ".join(f"{1e3 * entry[level]['slip']:.1f}" for level in _BOTH),
        f"{1e3 * entry['holds']:.1f}", "yes" if entry["sufficient"] else "no",
    )  # fmt: skip


def _apart(entry: Entry) -> tuple[str, ...]:
    def both(name: str, factor: float, form: str) -> str:
        return ", ".join(f"{factor * entry[level][name]:{form}}" for level in _BOTH)

    return (
        str(entry["number"]), f"{1e3 * entry['slider_radius']:.0f}",
        "unequal" if entry["unequal"] else "equal",
        both("slip", 1e3, ".1f"), both("left", 1e3, ".1f"), both("spin", 1.0, ".2f"),
        both("displacement", 1e3, ".1f"), "yes" if entry["sufficient"] else "no",
    )  # fmt: skip
