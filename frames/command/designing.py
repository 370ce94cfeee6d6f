"""The command that proposes bearings: candidates, their table and picture, the proposal."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frames.command.console import FAILED_CHECKS, err, exit_codes, project_in, say

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.verification import Verified
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.proposal import Design
    from frames.design.sizing.selection import Impossible, Objective
    from frames.design.sizing.target import DesignTarget
    from frames.design.sizing.trial import Trial

OBJECTIVES: dict[str, Objective] = {
    "base-shear": "base shear",
    "displacement": "displacement",
    "plan": "plan diameter",
    "cost-like": "bearing volume",
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
            help="What is made least: base-shear, displacement, plan (diameter of the plates) or "
            "cost-like (volume of all bearings).",
        ),
    ] = "base-shear",
    top: Annotated[
        int, typer.Option(min=1, help="How many of the best are listed, and verified.")
    ] = 3,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run the time histories of the best as well.")
    ] = False,
    results: Annotated[Path, typer.Option(help="Folder for tables and picture.")] = Path("design"),
) -> None:
    """Propose LIR-DCFP bearings, beside plain ones, and print them as a section of the file.

    All candidates, with why each fell out, are in candidates.csv and candidates.png. The best are
    sized on one mass under the project's motions: one_mass.csv. With --verify they are put to the
    time histories and checks of the project as well: verified.csv.
    """
    from frames.design.project.verification import section_of
    from frames.results.storage import make_folder

    with exit_codes():
        least = _objective(objective)
        _require_one_size(verify, sizes)
        parts = project_in(file)
        make_folder(results)
        target = parts.target()
        found = _found(parts, target, sizes, least, results)
        say(_written(found.candidates, found, target, results))
        _summary(found, objective, top)
        trials = _tried(parts, found, found.ranked[:top], results, every=verify)
        best = _best(trials)
        if best is not None:
            found = found.proposing(best.tried, best.sized)
            _written(found.candidates, found, target, results)
        say(f"\n{found}")
        chosen = found.chosen
        if verify:
            sized = [one.sized for one in trials] or found.ranked[:top]
            chosen = _verify(parts, sized, results) or chosen
        for bearing in chosen.bearings:
            say(f"\n{section_of(bearing)}")
        _leave(best)


def _leave(best: Trial | None) -> None:
    # With the code of a check that fails where the proposal does.
    if best is not None and best.failures(1.0):
        raise typer.Exit(FAILED_CHECKS)


def _tried(
    parts: ProjectInputs,
    found: Design,
    candidates: Sequence[Candidate],
    folder: Path,
    *,
    every: bool,
) -> list[Trial]:
    # Until one passes on one mass, or each of them; none where there are no motions to try.
    import pandas as pd

    from frames.design._errors import ProjectError
    from frames.design.project.preliminary import scaled_motions
    from frames.design.sizing.trial import MARGIN, OneMass, tried_on_one_mass
    from frames.results.storage import csv_of, write_whole

    try:
        motions = parts.motions()
    except ProjectError as cause:
        err.print(
            f"warning: the proposal is of the formula alone, no motions to try it: {cause}",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )
        return []
    rules, spectrum, at = parts.rules(), parts.spectrum(), parts.file.analysis.bounds
    how = OneMass(
        lambda analysis: scaled_motions(parts, spectrum, analysis),
        spectrum,
        rules,
        parts.bounds(),
        at,
        progress=True,
    )
    levels = ", ".join(f"{each.name} x {each.factor:g}" for each in rules.levels)
    say(
        f"\nOne mass (a rigid building) under {len(motions)} motions as the project scales them, "
        f"times 1 and {MARGIN:g}: levels {levels}; bounds {', '.join(at)}. "
        "One mass does not overturn: uplift is for the time histories of the project"
    )
    done: list[Trial] = []
    for one in candidates:
        say(f"\nradius {one.radius:g} m, friction {one.friction.f_max:g}: tried ...")
        done.append(tried_on_one_mass(found, one, how))
        rows = [row for each in done for row in each.rows()]
        write_whole(folder / "one_mass.csv", csv_of(pd.DataFrame(rows), index=False))
        say(str(done[-1]))
        if done[-1].passed and not every:
            break
    say(f"\nruns on one mass: {folder / 'one_mass.csv'}")
    return done


def _best(trials: Sequence[Trial]) -> Trial | None:
    # The first that passes; else the one with the fewest failures, which is said.
    from frames.design.sizing.trial import FACTORS, MARGIN

    passed = next((one for one in trials if one.passed), None)
    if passed is not None or not trials:
        return passed
    best = min(trials, key=lambda one: [one.failures(factor) for factor in FACTORS])
    counts = f"{best.failures(1.0)} runs fail, {best.failures(MARGIN)} at {MARGIN:g} times"
    say(f"none passes on one mass; the section below is of the one with the fewest: {counts}")
    return best


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


def _verify(
    parts: ProjectInputs, candidates: Sequence[Candidate], folder: Path
) -> Candidate | None:
    # The first of which no check fails, told as they are done; None without.
    import pandas as pd

    from frames.design.project.level_runs import said_of_runs
    from frames.design.project.verification import verification_table, verified
    from frames.design.report.tables import in_mm_and_kn, rows_of
    from frames.results.storage import csv_of, write_whole
    from lir_element.texts import text_table

    say(f"\nTime histories of the best {len(candidates)}: {said_of_runs(parts, parts.motions())}")
    done: list[Verified] = []
    for one in verified(parts, candidates, progress=True):
        done.append(one)
        write_whole(folder / "verified.csv", csv_of(verification_table(done), index=False))
        say(f"\n{_said(one)}")
    table = verification_table(done).drop(columns="fails")
    table.index = pd.Index(range(1, len(table) + 1))
    shown = in_mm_and_kn(table.rename(columns={"radius [m]": "radius (m)"}))
    say(f"\n{text_table(rows_of(shown), ('', *map(str, shown.columns)))}")
    say(f"\nenvelopes over the bounds, in SI units with what fails: {folder / 'verified.csv'}")
    best = next((one.candidate for one in done if one.passed), None)
    if best is None:
        say("\nnone passes all checks of the time histories: the section below is of the first")
    else:
        who = f"radius {best.radius:g} m, friction {best.friction.f_max:g}"
        say(f"\nthe first that passes all checks: {who}")
    return best


def _said(one: Verified) -> str:
    who = f"radius {one.candidate.radius:g} m, friction {one.candidate.friction.f_max:g}"
    if one.run is None:
        return f"{who}: cannot be run: {one.reason}"
    fails = one.row()["fails"]
    return f"{who}: {one.run.checks.tally}{f': {fails}' if fails else ''}"


def _require_one_size(verify: bool, sizes: int) -> None:
    from frames.design._errors import ProjectError

    if verify and sizes > 1:
        msg = f"--verify with --sizes {sizes}: [bearing] of a project has one size, leave one out"
        raise ProjectError(msg)


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
