"""The command that proposes bearings: candidates, their table and picture, the proposal."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from frames.command.console import FAILED_CHECKS, err, exit_codes, project_in, say

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.verification import Verified
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.fitting import Asked
    from frames.design.sizing.proposal import Design
    from frames.design.sizing.selection import Impossible, Objective
    from frames.design.sizing.target import DesignTarget
    from frames.design.sizing.trial import OneMass, Trial

OBJECTIVES: dict[str, Objective] = {
    "base-shear": "base shear",
    "displacement": "displacement",
    "plan": "plan diameter",
    "cost-like": "bearing volume",
    "cost": "cost",
}
"""What the command calls the objectives of `design`."""

_SHOWN = [
    "radius [m]",
    "friction [-]",
    "displacement [m]",
    "base shear / weight [-]",
    "rims",
    "plan diameter [m]",
    "bearing volume [m3]",
    "pressure, typical [Pa]",
    "limited by",
    "outcome",
]


def propose(
    file: Annotated[Path, typer.Argument(help="The project's file.")] = Path("project.toml"),
    sizes: Annotated[int, typer.Option(help="Number of unlike sliders.")] = 1,
    objective: Annotated[
        str,
        typer.Option(
            "--objective",
            "--least",
            help="What is made least: base-shear, displacement, plan (diameter of the plates), "
            "cost-like (volume of all bearings) or cost (by the prices of [design]).",
        ),
    ] = "base-shear",
    top: Annotated[
        int, typer.Option(min=1, help="How many of the best are listed, and tried.")
    ] = 3,
    front: Annotated[
        bool, typer.Option("--front", help="Try all that none beats, not until one passes.")
    ] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run the time histories of the project as well.")
    ] = False,
    write: Annotated[
        bool, typer.Option("--write", help="Put the proposal into the project's file.")
    ] = False,
    results: Annotated[Path, typer.Option(help="Folder for tables and picture.")] = Path("design"),
) -> None:
    """Propose LIR-DCFP bearings, beside plain ones, and print them as sections of the file.

    All candidates, with why each fell out, are in candidates.csv and candidates.png. The best are
    sized on one mass under the project's motions (one_mass.csv), then on the building itself until
    its checks pass (front.csv, front.png). With --verify they are sized by the time histories and
    checks that `lir run` makes as well: verified.csv.
    """
    from frames.design.project.verification import sections_of
    from frames.results.storage import make_folder

    with exit_codes():
        least = _objective(objective)
        parts = project_in(file)
        make_folder(results)
        target = parts.target()
        found = _found(parts, target, sizes, least, results)
        say(_written(found.candidates, found, target, results))
        _summary(found, objective, top)
        asked = found.ranked[:top]
        if front:
            asked = tuple(dict.fromkeys((*asked, *found.pareto)))
        tried = _tried(parts, found, asked, results, verify=verify, every=front)
        best = _best(tried)
        if best is not None:
            found = found.proposing(best.trial.tried, best.sized)
            _written(found.candidates, found, target, results)
        say(f"\n{found}")
        _conclusion(best)
        sections = sections_of(found.chosen, found.system.names)
        say(f"\n{sections}")
        if write:
            _put(file, sections)
        if best is not None and not best.passed:
            raise typer.Exit(FAILED_CHECKS)


class Attempt(NamedTuple):
    """A candidate tried on one mass, on the building's quick model, and as the project runs."""

    trial: Trial
    quick: Verified | None = None  # None where no run on one mass came through
    full: Verified | None = None  # None where it is not asked for

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
        """Whether no check fails on that."""
        return self.last is not None and self.last.passed

    @property
    def rank(self) -> tuple[float, ...]:
        """How near it is to passing: the less, the nearer."""
        if self.last is None or self.last.run is None:
            return (2.0, float(self.trial.failures(1.0)))
        return (float(not self.passed), float(len(self.last.obstacles)))


def _tried(
    parts: ProjectInputs,
    found: Design,
    candidates: Sequence[Candidate],
    folder: Path,
    *,
    verify: bool,
    every: bool,
) -> list[Attempt]:
    # Until one passes, or each of them; none where there are no motions to try.
    import pandas as pd

    from frames.design.project.verification import MARGIN, quick
    from frames.design.sizing.trial import tried_on_one_mass
    from frames.results.storage import csv_of, write_whole

    how = _one_mass(parts)
    if how is None:
        return []
    soon, done, rows = quick(parts), list[Attempt](), list[dict[str, object]]()
    said = (
        f'the building (level "pendulum", bounds {", ".join(soon.file.analysis.bounds)}), sized '
        f"until its checks pass with a margin of {MARGIN:g}"
    )
    for one in candidates:
        say(f"\nradius {one.radius:g} m, friction {one.friction.f_max:g}: tried ...")
        trial = tried_on_one_mass(found, one, how)
        rows += trial.rows()
        write_whole(folder / "one_mass.csv", csv_of(pd.DataFrame(rows), index=False))
        say(str(trial))
        last = Attempt(trial)
        if not trial.failures(1.0):
            say(said)
            last = last._replace(quick=_sized(soon, found, trial.sized, trial.asked, MARGIN))
        done.append(last)
        if verify and last.quick is not None and last.passed:
            say("time histories and checks as `lir run` makes them")
            mine = last.quick
            last = last._replace(full=_sized(parts, found, mine.candidate, mine.asked, 1.0))
            done[-1] = last
        _write_tried(parts, done, folder)
        if last.passed and not every:
            break
    tables = "one_mass.csv, front.csv" + (", verified.csv" if verify else "")
    say(f"\nruns on one mass, demands of the building: {tables} in {folder}")
    return done


def _one_mass(parts: ProjectInputs) -> OneMass | None:
    # How candidates are tried on one mass, said; None without motions, which is warned of.
    from frames.design._errors import ProjectError
    from frames.design.project.preliminary import scaled_motions
    from frames.design.sizing.trial import MARGIN, OneMass

    try:
        motions = parts.motions()
    except ProjectError as cause:
        err.print(
            f"warning: the proposal is of the formula alone, no motions to try it: {cause}",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )
        return None
    rules, spectrum, at = parts.rules(), parts.spectrum(), parts.file.analysis.bounds
    levels = ", ".join(f"{each.name} x {each.factor:g}" for each in rules.levels)
    say(
        f"\nOne mass (a rigid building) under {len(motions)} motions as the project scales them, "
        f"times 1 and {MARGIN:g}: levels {levels}; bounds {', '.join(at)}. "
        "One mass does not overturn: the building itself follows"
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
    # Sized on the building, said round by round.
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
    return said if nearest is None else f"{said}; nearest of the bearing's: {nearest.brief}"


def _write_tried(parts: ProjectInputs, done: Sequence[Attempt], folder: Path) -> None:
    # Tables and picture of what was tried on the building.
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


def _best(tried: Sequence[Attempt]) -> Attempt | None:
    # The first that passes; else the nearest to it.
    passed = next((one for one in tried if one.passed), None)
    return passed or min(tried, key=lambda one: one.rank, default=None)


def _conclusion(best: Attempt | None) -> None:
    # Whether all checks pass and by which margin; else what stands in the way.
    if best is None:
        return
    last, who = best.last, f"radius {best.sized.radius:g} m, friction {best.sized.friction.f_max:g}"
    how = "as `lir run` makes them" if best.full is not None else "on the building's quick model"
    if last is not None and last.passed:
        nearest = (
            "" if last.nearest is None else f"; nearest of the bearing's: {last.nearest.brief}"
        )
        say(f"\n{who}: every check passes {how}{nearest}")
        return
    say(f"\nnone passes every check; the section below is of the nearest, {who}. In its way:")
    for lack in () if last is None else last.lacks:
        say(f"- as large as its runs ask for it falls out: {lack}")
    if last is None or last.run is None:
        reason = "" if last is None else last.reason
        say(f"- {reason or f'{best.trial.failures(1.0)} runs on one mass fail'}")
    for lack in best.trial.larger_lacks:
        say(f"- as large as one mass asks for it falls out: {lack}")
    for each in () if last is None else last.obstacles:
        say(f"- {each}")
    say(f"- the motions' share: {best.trial.excess}")


def _put(file: Path, sections: str) -> None:
    # Into the file, if all else stays as it was; the earlier file is kept beside it.
    from frames.design._errors import ProjectError
    from frames.design.project.reading import read_project
    from frames.design.project.verification import with_sections
    from frames.results.storage import write_whole

    text = file.read_text(encoding="utf-8")
    kept, other = file.with_name(f"{file.name}.before"), {"bearing", "bearings"}
    before = read_project(file).model_dump(exclude=other)
    write_whole(kept, text)
    write_whole(file, with_sections(text, sections))
    try:
        same = read_project(file).model_dump(exclude=other) == before
    except ProjectError:
        same = False
    if not same:
        write_whole(file, text)
        msg = (
            f"{file}: its bearings are not in sections [bearing] and [bearings.<type>] of their "
            "own, so that --write would change other keys: put the section in by hand"
        )
        raise ProjectError(msg)
    say(f"written to {file}; the earlier file is {kept}")


def _found(
    parts: ProjectInputs, target: DesignTarget, sizes: int, least: Objective, results: Path
) -> Design:
    # Where no candidate keeps what is asked, they are written before the error is told.
    from frames.design.sizing.proposal import design
    from frames.design.sizing.selection import NoCandidateError

    frame = parts.provisional_frame()
    try:
        return design(
            parts.system(frame, parts.spectrum()),
            parts.spectrum(),
            bounds=parts.bounds(),
            target=target,
            superstructure=parts.superstructure(frame),
            code=parts.analysis(),
            sizes=sizes,
            least=least,
        )
    except NoCandidateError as cause:
        say(_written(cause.candidates, None, target, results, cause.impossible))
        _reasons(cause.candidates, cause.impossible)
        raise


def _objective(word: str) -> Objective:
    from frames.design._errors import ProjectError

    named = OBJECTIVES | {name: name for name in OBJECTIVES.values()}  # as design() has them
    if word not in named:
        msg = f"--objective {word!r} is none of {', '.join(OBJECTIVES)}"
        raise ProjectError(msg)
    return named[word]


def _summary(found: Design, objective: str, top: int) -> None:
    # The best by the objective, the Pareto set, and why the others fell out.
    ranked, best = found.ranked, found.pareto
    say(
        f"{len(found.candidates) + len(found.impossible)} candidates tried, {len(ranked)} keep "
        f"what is asked, {len(best)} of them Pareto-optimal (none has less displacement, base "
        "shear and plan diameter at once)"
    )
    _reasons(found.candidates, found.impossible)
    shown = list(dict.fromkeys((*ranked[:top], *best)))
    say(f"\nThe best {min(top, len(ranked))} by {objective}, and the Pareto set\n")
    say(_listed(shown, found.chosen))


def _listed(shown: Sequence[Candidate], chosen: Candidate) -> str:
    from frames.design.report.tables import in_mm_and_kn, rows_of
    from frames.design.sizing.selection import table_of
    from lir_element.texts import text_table

    table = table_of(shown, chosen)[_SHOWN]
    table = table.rename(columns={"pressure, typical [Pa]": "pressure [MPa]"})
    table["pressure [MPa]"] *= 1e-6
    table.index = range(1, len(table) + 1)
    shown_table: pd.DataFrame = in_mm_and_kn(table.rename(columns={"radius [m]": "radius (m)"}))
    return text_table(rows_of(shown_table), ("", *map(str, shown_table.columns)))


def _reasons(found: Sequence[Candidate], impossible: Sequence[Impossible]) -> None:
    causes = Counter(one.governing.what for one in found if one.lacks)
    causes.update("cannot be made" for _ in impossible)
    if causes:
        listed = ", ".join(f"{what} {count}" for what, count in causes.most_common())
        say(f"fell out, by what they lack most: {listed}")
    for reason in dict.fromkeys(one.reason for one in impossible):
        say(f"cannot be made: {reason}")


def _written(
    candidates: Sequence[Candidate],
    found: Design | None,
    target: DesignTarget,
    folder: Path,
    impossible: Sequence[Impossible] = (),
) -> str:
    # Table and picture; returns where they are.
    from frames.design.plots import design_candidates  # with matplotlib
    from frames.design.sizing.selection import table_of
    from frames.plots.plot_style import png_of
    from frames.results.storage import csv_of, write_whole

    table = table_of(candidates, None, impossible) if found is None else found.to_dataframe()
    write_whole(folder / "candidates.csv", csv_of(table, index=False))
    written = str(folder / "candidates.csv")
    if candidates:
        figure = design_candidates(candidates if found is None else found, target=target)
        write_whole(folder / "candidates.png", png_of(figure, 150))
        written += f", {folder / 'candidates.png'}"
    return f"all candidates: {written}"
