"""The command that proposes bearings: candidates, their table and picture, the proposal."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frames.command.console import FAILED_CHECKS, exit_codes, project_in, say
from frames.command.trying import best_of, conclude, tried

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

    from frames.design.project.inputs import ProjectInputs
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.proposal import Design
    from frames.design.sizing.selection import Impossible, Objective
    from frames.design.sizing.target import DesignTarget

OBJECTIVES: dict[str, Objective] = {
    "base-shear": "base shear",
    "displacement": "displacement",
    "plan": "plan diameter",
    "cost-like": "bearing volume",
    "cost": "cost",
}
"""Names of the objectives of `design` in the command."""

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
    file: Annotated[Path, typer.Argument(help="Path of the project file.")] = Path("project.toml"),
    sizes: Annotated[int, typer.Option(help="Number of slider sizes.")] = 1,
    objective: Annotated[
        str,
        typer.Option(
            "--objective",
            "--least",
            help="Quantity to minimise: base-shear, displacement, plan (diameter of the plates), "
            "cost-like (volume of all bearings) or cost (by the prices in the file).",
        ),
    ] = "base-shear",
    top: Annotated[int, typer.Option(min=1, help="Number of candidates to list and to try.")] = 3,
    front: Annotated[
        bool,
        typer.Option("--front", help="Try all Pareto-optimal candidates, also after one passes."),
    ] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run all time histories of the project, too.")
    ] = False,
    write: Annotated[
        bool, typer.Option("--write", help="Write the proposal to the project file.")
    ] = False,
    results: Annotated[Path, typer.Option(help="Folder for tables and figures.")] = Path("design"),
) -> None:
    """Propose LIR-DCFP bearings beside plain ones, as sections of the project file.

    All candidates and their unmet requirements are in candidates.csv and candidates.png. The best
    are sized on one mass under the project's motions (one_mass.csv), then on the building until its
    checks pass (front.csv, front.png). With --verify they are also sized by all analyses of `lir
    run` (verified.csv).
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
        best = best_of(tried(parts, found, asked, results, verify=verify, every=front))
        if best is not None:
            found = found.proposing(best.trial.tried, best.sized)
            _written(found.candidates, found, target, results)
        say(f"\n{found}")
        conclude(best)
        sections = sections_of(found.chosen, found.system.names)
        say(f"\n{sections}")
        if write:
            _put(file, sections)
        if best is not None and not best.passed:
            raise typer.Exit(FAILED_CHECKS)


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
            f"{file}: --write would change other keys, because bearings are not in sections "
            "[bearing] and [bearings.<type>]: insert the section by hand"
        )
        raise ProjectError(msg)
    say(f"written to {file}; the earlier file is {kept}")


def _found(
    parts: ProjectInputs, target: DesignTarget, sizes: int, least: Objective, results: Path
) -> Design:
    # If no candidate meets the target, the candidates are written before the error is shown.
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
        _in_the_way(parts, cause.candidates)
        raise


def _in_the_way(parts: ProjectInputs, found: Sequence[Candidate]) -> None:
    # By how much each limit would have to give, and the motions' share.
    from frames.design._errors import ProjectError
    from frames.design.project.preliminary import scaled_motions
    from frames.design.sizing.trial import excess_of

    for what in dict.fromkeys(one.governing.what for one in found):
        near = min(
            (one for one in found if one.governing.what == what),
            key=lambda one: one.governing.ratio,
        )
        ratio, who = near.governing.ratio, f"radius {near.radius:g} m, friction"
        if 1.0 < ratio < math.inf:
            say(
                f"- {what}: raise its limit by {100.0 * (ratio - 1.0):.2g} % for {who} "
                f"{near.friction.f_max:g}"
            )
    if not found:
        return
    near, spectrum = min(found, key=lambda one: one.governing.ratio), parts.spectrum()
    try:
        motions = scaled_motions(parts, spectrum, near.analysis)
    except ProjectError:
        return  # no motions
    say(f"- effect of the motions: {excess_of(near.analysis, motions, spectrum)}")


def _objective(word: str) -> Objective:
    from frames.design._errors import ProjectError

    named = OBJECTIVES | {name: name for name in OBJECTIVES.values()}  # as design() has them
    if word not in named:
        msg = f"--objective {word!r} must be one of {', '.join(OBJECTIVES)}"
        raise ProjectError(msg)
    return named[word]


def _summary(found: Design, objective: str, top: int) -> None:
    # The best by the objective, the Pareto set, and why the others fell out.
    ranked, best = found.ranked, found.pareto
    say(
        f"{len(found.candidates) + len(found.impossible)} candidates tried, {len(ranked)} "
        f"meet the requirements, {len(best)} of them Pareto-optimal (none has less "
        "displacement, base shear and plan diameter at once)"
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
        say(f"rejected, by their main reason: {listed}")
    for reason in dict.fromkeys(one.reason for one in impossible):
        say(f"cannot be made: {reason}")


def _written(
    candidates: Sequence[Candidate],
    found: Design | None,
    target: DesignTarget,
    folder: Path,
    impossible: Sequence[Impossible] = (),
) -> str:
    # Writes table and picture; returns their paths.
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
