"""The commands that show a project: a run in motion, beside rigid sliders, in other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from frames.command.console import exit_codes, out, project_in, say


def view(
    file: Annotated[Path, typer.Argument(help="Path of the project file.")] = Path("project.toml"),
    results: Annotated[Path, typer.Option(help="Folder with the results.")] = Path("results"),
    size: Annotated[float, typer.Option(help="Largest size of the histories [MB].")] = 3.0,
) -> None:
    """Write view.html, a page that shows model and bearings in motion in the governing run."""
    from frames.design._errors import ProjectError
    from frames.design.project.level_runs import most_displaced, named_case
    from frames.design.project.preliminary import inputs_of, preliminary
    from frames.design.report.files import read_checks, read_histories
    from frames.results.storage import refuse_links
    from frames.viewer import write_view  # with figures

    with exit_codes():
        refuse_links(results)
        parts = project_in(file)
        runs, governing = read_histories(results, inputs_of(parts, preliminary(parts)))
        checks = read_checks(results)
        try:
            said = write_view(
                governing, parts.frame(), results / "view.html", checks=checks, size=size
            )
        except ValueError as cause:
            raise ProjectError(str(cause)) from cause
        say(f"{said}; the run: {named_case(most_displaced(runs))}")


def compare(
    file: Annotated[Path, typer.Argument(help="Path of the project file.")] = Path("project.toml"),
    results: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("results"),
    figures: Annotated[bool, typer.Option(help="Draw the figures of the page.")] = True,
) -> None:
    """Compare the LIR-DCFP with the plain DCFP: the same bearing with a rigid slider.

    Writes compare.html, compare.csv and compare-motions.csv.
    """
    from frames.design.project.comparison import compare_project, compared_histories
    from frames.design.report.comparison_page import verdicts, write_comparison
    from frames.design.report.tables import rows_of
    from frames.results.storage import make_folder
    from lir_element.texts import text_table

    with exit_codes():
        parts = project_in(file)
        make_folder(results)
        found = compare_project(parts, progress=True)
        histories = compared_histories(parts, found) if figures else None
        written = write_comparison(found, results, parts.sources.text, histories)
        table = found.table()
        out.print("\n[bold]Envelope over bounds[/]")
        say(text_table(rows_of(table), ("", *map(str, table.columns))))
        said = verdicts(found)
        for one in said:
            say(f"\n{f'{one.level}: ' if len(said) > 1 else ''}{one.head}")
            for text in one.details:
                say(f"  {text}")
        say(f"\n{found.eccentricity}")
        say(f"\n{', '.join(path.name for path in written)} in {results}")


def export(
    file: Annotated[Path, typer.Argument(help="Path of the project file.")] = Path("project.toml"),
    to: Annotated[str, typer.Option(help="Program: etabs or sap2000.")] = "etabs",
    results: Annotated[Path, typer.Option(help="Folder for the files.")] = Path("export"),
) -> None:
    """Write the project for another program, and the expected response spectrum results.

    Writes a model at each friction bound, with the effective stiffness and damping of the
    equivalent-linear analysis in its links, and links.csv, spectrum.csv (with that damping) and
    expected.csv.
    """
    from typing import get_args

    from frames.design._errors import ProjectError
    from frames.design.project.handover import Program, handed_over
    from frames.design.project.preliminary import preliminary
    from frames.design.report.tables import in_mm_and_kn, rows_of
    from frames.results.storage import csv_of, make_folder, write_whole
    from lir_element.argument_checks import require_choice
    from lir_element.texts import text_table

    with exit_codes():
        require_choice("--to", to, get_args(Program), error=ProjectError)
        parts = project_in(file)
        known = preliminary(parts)
        make_folder(results)
        found = handed_over(parts, known, to, results)  # type: ignore[arg-type]  # refused before
        for name, table in found.tables.items():
            write_whole(results / f"{name}.csv", csv_of(table, index=False))
        for line in found.said:
            say(line)
        shown = in_mm_and_kn(known.equivalent.to_dataframe())
        say(text_table(rows_of(shown), ("", *map(str, shown.columns))))
        say(f"{', '.join(f'{name}.csv' for name in found.tables)} in {results}, in SI units")
