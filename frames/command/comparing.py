"""The command that compares the bearings of a project with rigid sliders."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from frames.command.console import out, project_in, say, told


def compare(
    file: Annotated[Path, typer.Argument(help="The project's file.")] = Path("project.toml"),
    results: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("results"),
    figures: Annotated[bool, typer.Option(help="Draw the figures of the page.")] = True,
) -> None:
    """Compare the LIR-DCFP with the same bearing and a rigid slider, the plain DCFP.

    Writes compare.html, compare.csv and compare-motions.csv.
    """
    from frames.design.project.comparison import compare_project, compared_histories
    from frames.design.report.comparison_page import write_comparison
    from frames.design.report.comparison_words import verdicts
    from frames.design.report.tables import rows_of
    from frames.results.storage import make_folder
    from lir_element.tables import text_table

    with told():
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
