"""The command that writes the page on which a run is looked at in motion."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from frames.command.console import project_in, say, told


def view(
    file: Annotated[Path, typer.Argument(help="The project's file.")] = Path("project.toml"),
    results: Annotated[Path, typer.Option(help="Folder with the results.")] = Path("results"),
    size: Annotated[float, typer.Option(help="What the histories may take [MB].")] = 3.0,
) -> None:
    """Write view.html: model and bearings of the governing run in motion, on one page."""
    from frames.design._errors import ProjectError
    from frames.design.project.level_runs import most_displaced, named_case
    from frames.design.project.preliminary import inputs_of, preliminary
    from frames.design.report.files import read_checks, read_histories
    from frames.results.storage import refuse_links
    from frames.viewer import write_view  # with figures

    with told():
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
