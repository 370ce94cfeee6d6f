"""Trials of candidates on one mass and on the building: their results and failures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from frames.command.console import err, say

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.verification import Verified
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.fitting import Asked
    from frames.design.sizing.proposal import Design
    from frames.design.sizing.trial import OneMass, Trial


class Attempt(NamedTuple):
    """A candidate tried on one mass, on the building's quick model, and as the project runs."""

    trial: Trial
    quick: Verified | None = None  # None if no run on one mass was complete
    full: Verified | None = None  # None if it was not requested

    @property
    def last(self) -> Verified | None:
        """The best model that it was tried on."""
        return self.full or self.quick

    @property
    def sized(self) -> Candidate:
        """The candidate as it was sized last."""
        return self.trial.sized if self.last is None else self.last.candidate

    @property
    def passed(self) -> bool:
        """True if no check fails on that."""
        return self.last is not None and self.last.passed

    @property
    def rank(self) -> tuple[float, ...]:
        """Distance from passing: the less, the nearer."""
        if self.last is None or self.last.run is None:
            return (2.0, float(self.trial.failures(1.0)))
        return (float(not self.passed), float(len(self.last.obstacles)))


def tried(
    parts: ProjectInputs,
    found: Design,
    candidates: Sequence[Candidate],
    folder: Path,
    *,
    verify: bool,
    every: bool,
) -> list[Attempt]:
    """Try candidates until one passes, or each of them; none without motions.

    Those that do not pass on one mass are tried on the building after the others.
    """
    import pandas as pd

    from frames.design.project.verification import MARGIN, quick
    from frames.design.sizing.trial import tried_on_one_mass
    from frames.results.storage import csv_of, write_whole

    how = _one_mass(parts)
    if how is None:
        return []
    soon, rows = quick(parts), list[dict[str, object]]()
    done, later = list[Attempt](), list[Attempt]()

    def on_building(last: Attempt) -> bool:
        one = last.trial.sized
        say(
            f"\nradius {one.radius:g} m, friction {one.friction.f_max:g} on the building (level "
            f'"pendulum", bounds {", ".join(soon.file.analysis.bounds)}), sized until its checks '
            f"pass with a margin of {MARGIN:g} ..."
        )
        own = _sized(soon, found, one, last.trial.asked, MARGIN)
        last = last._replace(quick=own)
        if verify and last.passed:
            say("time histories and checks of `lir run` ...")
            last = last._replace(full=_sized(parts, found, own.candidate, own.asked, 1.0))
        done.append(last)
        _write_tried(done, folder)
        return last.passed and not every

    for one in candidates:
        say(f"\nradius {one.radius:g} m, friction {one.friction.f_max:g}: tried ...")
        trial = tried_on_one_mass(found, one, how)
        rows += trial.rows()
        write_whole(folder / "one_mass.csv", csv_of(pd.DataFrame(rows), index=False))
        say(str(trial))
        if not trial.passed:
            later.append(Attempt(trial))
        elif on_building(Attempt(trial)):
            break
    else:
        for last in later:
            if last.trial.failures(1.0):
                done.append(last)
            elif on_building(last):
                break
    tables = "one_mass.csv, front.csv" + (", verified.csv" if verify else "")
    say(f"\nruns on one mass, demands of the building: {tables} in {folder}")
    return done


def _one_mass(parts: ProjectInputs) -> OneMass | None:
    # Trial of candidates on one mass, described; None without motions, with a warning.
    from frames.design._errors import ProjectError
    from frames.design.project.preliminary import scaled_motions
    from frames.design.sizing.trial import MARGIN, OneMass

    try:
        motions = parts.motions()
    except ProjectError as cause:
        err.print(
            f"warning: the proposal is not tried, because there are no motions: {cause}",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )
        return None
    rules, spectrum, at = parts.rules(), parts.spectrum(), parts.file.analysis.bounds
    levels = ", ".join(f"{each.name} x {each.factor:g}" for each in rules.levels)
    say(
        f"\nOne mass (a rigid building) under {len(motions)} motions with the project's scaling, "
        f"times 1 and {MARGIN:g}: levels {levels}; bounds {', '.join(at)}. One mass does not "
        "overturn, so the building is run next"
    )
    return OneMass(
        lambda analysis: scaled_motions(parts, spectrum, analysis),
        spectrum,
        rules,
        parts.bounds(),
        at,
        progress=True,
    )


def _sized(
    parts: ProjectInputs, found: Design, one: Candidate, asked: Asked, margin: float
) -> Verified:
    # Sizing on the building, reported round by round.
    from frames.design.project.verification import verified

    return verified(
        parts,
        found,
        one,
        asked=asked,
        margin=margin,
        progress=True,
        told=lambda last: say(f"round {last.rounds}: {_said(last)}"),
    )


def _said(one: Verified) -> str:
    t, run = one.candidate.trace, one.run
    sliders = "/".join(f"{1e3 * each.slider_radius:.0f}" for each in one.candidate.bearings)
    said = (
        f"capacity {1e3 * t.value('U_cap'):.0f} mm, slider radius {sliders} mm, interface friction "
        f"{t.value('mu_h'):g}: "
    )
    if run is None:
        return f"{said}cannot be run: {one.reason}"
    fails = one.row()["fails"]
    nearest = one.nearest
    said += f"{run.checks.tally}{f': {fails}' if fails else ''}"
    return said if nearest is None else f"{said}; governing for the bearing: {nearest.brief}"


def _write_tried(done: Sequence[Attempt], folder: Path) -> None:
    # Tables and picture of the trials on the building.
    from frames.design.plots import tried_candidates
    from frames.design.project.verification import verification_table
    from frames.plots.plot_style import png_of
    from frames.results.storage import csv_of, write_whole

    quick = [one.quick for one in done if one.quick is not None]
    full = [one.full for one in done if one.full is not None]
    for each, name in ((quick, "front.csv"), (full, "verified.csv")):
        if each:
            write_whole(folder / name, csv_of(verification_table(each), index=False))
    table = verification_table([one for one in quick if one.run is not None])
    if len(table):
        write_whole(folder / "front.png", png_of(tried_candidates(table), 150))


def best_of(attempts: Sequence[Attempt]) -> Attempt | None:
    """Return the first that passes; else the nearest to it."""
    passed = next((one for one in attempts if one.passed), None)
    return passed or min(attempts, key=lambda one: one.rank, default=None)


def conclude(best: Attempt | None) -> None:
    """Report that all checks pass and the margin; else the failures."""
    if best is None:
        return
    last, who = best.last, f"radius {best.sized.radius:g} m, friction {best.sized.friction.f_max:g}"
    how = "in the runs of `lir run`" if best.full is not None else "on the building's quick model"
    if last is not None and last.passed:
        nearest = (
            "" if last.nearest is None else f"; governing for the bearing: {last.nearest.brief}"
        )
        say(f"\n{who}: every check passes {how}{nearest}")
        return
    say(f"\nno candidate passes every check; the section below is of the nearest, {who}. Reasons:")
    for lack in () if last is None else last.lacks:
        say(f"- rejected at the size that its runs require: {lack}")
    if last is None or last.run is None:
        reason = "" if last is None else last.reason
        say(f"- {reason or f'{best.trial.failures(1.0)} runs on one mass fail'}")
    for lack in best.trial.larger_lacks:
        say(f"- rejected at the size that one mass requires: {lack}")
    for each in () if last is None else last.obstacles:
        say(f"- {each}")
    say(f"- effect of the motions: {best.trial.excess}")
