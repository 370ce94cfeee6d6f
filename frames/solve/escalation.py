"""The level "auto": repeated runs with the features that the assumption check found missing."""

from __future__ import annotations

from collections.abc import Mapping
from time import perf_counter
from typing import TYPE_CHECKING, TypeAlias

from frames.results.assumption_checks import asking_for_contact
from frames.results.findings import Findings, findings_of, remark
from lir_element.errors import RunStatus
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import xarray as xr

    from frames.results.findings import Finding
    from lir_element import Features

Level: TypeAlias = str | Mapping[str, str]
"""One for all bearings, or "contact" by name: the others are at the level "pendulum"."""

MOST_RUNS = 5
"""Features and level settle in two or three runs; this limits repeated findings."""


def escalate_level(
    analyse: Callable[[Features, Level], xr.Dataset], features: Features
) -> xr.Dataset:
    """Run with `features`, and again with the missing ones."""
    level: Level = "pendulum"
    lines: list[str] = []
    for count in range(1, MOST_RUNS + 1):
        began = perf_counter()
        data = analyse(features, level)
        seconds = perf_counter() - began
        findings = findings_of(data)
        names = tuple(str(name) for name in data.variables["bearing"].to_numpy())
        wider, higher, reason = _next(findings, features, level, names)
        is_last = count == MOST_RUNS or (wider, higher) == (features, level)
        out = ", ".join(features.left_out) or "nothing"
        at = (
            level if isinstance(level, str) else f"{len(level)} of {len(names)} bearings at contact"
        )
        lines.append(f"run {count}: {at}, left out {out}, {seconds:.3f} s: {reason}")
        if is_last:
            break
        features, level = wider, higher
    data.attrs["auto_runs"] = "\n".join(lines)
    return data


def mark_other_end(data: xr.Dataset, ends: Sequence[tuple[RunStatus, float]]) -> None:
    """Record in the check of `escalate_level` that an earlier run ended otherwise."""
    last, time = ends[-1]
    others = [
        k for k, (status, _) in enumerate(ends[:-1]) if status.is_complete != last.is_complete
    ]
    if not others:
        return
    first, earlier = ends[others[-1]]
    line = worded(
        "ends: run {first} {how_first}, run {last} {how_last} (auto_runs): a little more or less "
        "decides whether a bearing fails",
        first=others[-1] + 1,
        how_first=_ended(first, earlier),
        last=len(ends),
        how_last=_ended(last, time),
    )
    noted = remark("ends", float(others[-1] + 1), line, doubtful=True)
    data.attrs |= Findings((noted, *findings_of(data))).attrs()
    data.attrs["auto_runs"] += f"\n{line}"


def _ended(status: RunStatus, time: float) -> str:
    how = "completed" if status.is_complete else f"stopped ({status.name.lower()})"
    return worded("{how} at t = {time:.4g} s", how=how, time=time)


def _next(
    findings: tuple[Finding, ...], features: Features, level: Level, names: tuple[str, ...]
) -> tuple[Features, Level, str]:
    # Features and level of the next run (the same: settled), and why.
    out = features.left_out
    missing = [f for f in findings if f.is_missing and f.feature in out]
    if missing:
        wider = features.including(*(f.feature for f in missing))
        if wider.rims and not features.rims:  # a rigid slider would break its rims
            wider = wider.including("interface")
        return wider, level, "again, for " + "; ".join(f.sentence for f in missing)
    asking = asking_for_contact(findings)
    if not asking:
        return features, level, "sufficient"
    raised = _raised(level, names, {name for found in asking for name in found.bearings})
    who = "all bearings" if raised == "contact" else ", ".join(raised)
    why = "; ".join(f.sentence for f in asking)
    return features, raised, f"again with {who} at the level 'contact': {why}"


def _raised(level: Level, names: tuple[str, ...], asked: set[str]) -> Level:
    # The level with more bearings at "contact".
    at_contact = asked if isinstance(level, str) else asked | set(level)
    chosen = {name: "contact" for name in names if name in at_contact}
    return "contact" if len(chosen) == len(names) else chosen
