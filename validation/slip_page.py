"""The page on the slip of the interface: its tables and text, from the numbers of the test cases."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from validation.page import table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames._types import FloatArray

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
            rows.append(
                (
                    f"{title} ({len(fit)})",
                    f"`{level}`",
                    words,
                    *_spread(e),
                )
            )
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


def changed(now: Sequence[Entry], before: Sequence[Entry]) -> list[str]:
    """Return lines that compare test cases with what 'pendulum' gave earlier; none without that."""
    kept = {entry["number"]: entry["pendulum"] for entry in before if "pendulum" in entry}
    if not kept:
        return []
    alike = [
        e
        for e in now
        if e["number"] in kept
        and not e["unequal"]
        and not e["rigid_body"]["lifts"]
        and ends_well(e, "rigid_body")
        and ends_well(e, "pendulum")
    ]
    were = [entry | {"pendulum": kept[entry["number"]]} for entry in alike]
    rows = []
    for name, words in NAMES.items():
        for title, entries in (("before", were), ("now", alike)):
            e = 100.0 * np.array([errors(entry, "pendulum")[name] for entry in entries])
            rows.append(
                (
                    words,
                    title,
                    *_spread(e),
                )
            )
    past = [entry for entry in now if entry["number"] in kept]
    past = [entry | {"pendulum": kept[entry["number"]]} for entry in past]
    return [
        "## Before the sliders could spin",
        "",
        f"The level `pendulum` without spin, in the same {len(alike)} test cases with equal rims and "
        "without uplift, against the same rigid bodies.",
        "",
        table(("of", "", *SPREAD), rows),
        "",
        f"Test cases that end otherwise than the rigid bodies: then {len(unlike(past, 'pendulum'))} of "
        f"{len(past)}, now {len(unlike(now, 'pendulum'))}.",
        "",
    ]


def by_step(met: Sequence[Entry]) -> list[str]:
    """Return lines on the ends of 'pendulum' at fixed steps; none where they were not asked."""
    asked = [entry for entry in met if "by_step" in entry]
    if not asked:
        return []
    other = [
        f"{e['number']} ({', '.join(f'`{status}`' for status in e['by_step'])}; "
        f"{e['pendulum']['slip'] / e['holds']:.2f} of the stable limit of interface slip, "
        f"{e['pendulum']['slip'] / e['overlap']:.2f} of the overlap)"
        for e in asked
        if any((status in FINE) is not ends_well(e, "pendulum") for status in e["by_step"])
    ]
    return [
        f"At steps of 5 and 1 ms the level `pendulum` ends otherwise than at the step that it "
        f"chooses in {len(other)} of {len(asked)} test cases"
        + (f": {', '.join(other)}." if other else "."),
        "",
    ]


def on_rig(rows: Sequence[tuple[str, ...]], head: tuple[str, ...]) -> list[str]:
    """Return lines on the stable limit of interface slip, tried on the rig."""
    if not rows:
        return []
    return [
        "## The stable limit of interface slip, on the rig",
        "",
        "A slip beyond `slip_stability` runs off the overlap as soon as the motion turns again in "
        "its direction, whatever the level (`validation/held_slip.py`). In each cell: "
        "`pendulum`, `contact`, `rigid_body`.",
        "",
        table(head, rows),
        "",
    ]


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
    groups: tuple[tuple[str, Callable[[Entry], bool]], ...] = (
        ("equal rims, no uplift", lambda e: not e["unequal"] and not e["rigid_body"]["lifts"]),
        ("unequal rims", lambda e: bool(e["unequal"])),
        ("uplift", lambda e: bool(e["rigid_body"]["lifts"])),
    )
    rows = [row for title, fits in groups for row in of_levels([e for e in met if fits(e)], title)]
    sufficient, missed = promise(met)
    ends = unlike(met, "pendulum")
    apart = sorted(
        (
            e
            for e in met
            if ends_well(e, "pendulum") and ends_well(e, "rigid_body") and not e["unequal"]
        ),
        key=lambda e: -max(errors(e, "pendulum")[name] for name in ("slip", "left")),
    )[:SHOWN]
    spun = sum(abs(e["rigid_body"]["spin"]) > 0.05 for e in met)
    share = len(missed) / max(len(sufficient), 1)
    return "\n".join(
        [
            "# Slip of the interface, level by level",
            "",
            f"Written by `{call}`: {len(found)} random bearings under motions of two or three "
            f"components, scaled until the slider meets its rims, which {len(met)} do. Levels "
            "`pendulum` and `contact` against `rigid_body`, whose sliders have a mass; `dt=None`. In "
            f"{spun} test cases the sliders spin by more than 0.05 rad."
            + (f" Without a report: test cases {', '.join(lost)}." if lost else ""),
            "",
            table(_HEAD, rows),
            "",
            f"Errors in per cent; those of a slip below {LEAST:.0%} of the capacity are over that. "
            "How sliders rock is left out by `pendulum`.",
            "",
            '## What `level="auto"` calls sufficient',
            "",
            f"At the level `pendulum`: {len(sufficient)} of {len(met)} test cases. Of these {len(missed)} "
            f"({share:.1%}) are more than 5 % off in displacement or force, more than 10 % in slip, or "
            "end otherwise." + (" " + _listed(missed) if missed else ""),
            "",
            "## Runs that end otherwise",
            "",
            table(_ENDS, [_end(entry) for entry in ends]) if ends else "None.",
            "",
            "Beside `slip_stability` ([theory](../theory.md), 2) and beside the overlap a few per cent "
            "of slip decide; where the axial force oscillates, the interface lets go earlier. The assumption check marks "
            "80 % of the one and 90 % of the other.",
            "",
            *by_step(met),
            "## Farthest apart, with equal rims",
            "",
            table(_APART, [_apart(entry) for entry in apart]),
            "",
            *on_rig(rig, head),
            *changed(met, before),
        ]
    )


_HEAD = ("scenes", "level", "of", *SPREAD)
_ENDS = (
    "scene",
    "pendulum",
    "contact",
    "rigid_body",
    "largest slip [mm]",
    "stable limit of interface slip [mm]",
    "overlap [mm]",
    "rims",
    "called sufficient",
)
_APART = (
    "scene",
    "slider radius [mm]",
    "slip [mm]",
    "residual slip [mm]",
    "spin [rad]",
    "displacement [mm]",
    "called sufficient",
)
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
        f"{1e3 * entry['holds']:.1f}",
        f"{1e3 * entry['overlap']:.1f}",
        "unequal" if entry["unequal"] else "equal",
        "yes" if entry["sufficient"] else "no",
    )


def _apart(entry: Entry) -> tuple[str, ...]:
    def both(name: str, factor: float, form: str) -> str:
        return ", ".join(f"{factor * entry[level][name]:{form}}" for level in _BOTH)

    return (
        str(entry["number"]),
        f"{1e3 * entry['slider_radius']:.0f}",
        both("slip", 1e3, ".1f"),
        both("left", 1e3, ".1f"),
        both("spin", 1.0, ".2f"),
        both("displacement", 1e3, ".1f"),
        "yes" if entry["sufficient"] else "no",
    )
