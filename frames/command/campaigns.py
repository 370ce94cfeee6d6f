"""The commands of campaigns: run one from its file, and show its progress.

Each imports its modules itself: the other commands start without them.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from frames.command.console import INTERRUPTED, exit_codes, say

if TYPE_CHECKING:
    from frames.risk.campaign.campaign import Campaign
    from frames.risk.campaign.file_schema import CampaignFile


def campaign(
    file: Annotated[Path, typer.Argument(help="Path of the campaign file.")],
    store: Annotated[
        Path | None, typer.Option(help="Folder for the results (default: beside the file).")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Number of parallel runs (default: all processors).")
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw the figures of the page.")] = True,
    reuse: Annotated[
        list[Path] | None,
        typer.Option(help="Folder of an earlier campaign, from which equal runs are copied."),
    ] = None,
) -> None:
    """Run a campaign of many time histories from its file, or resume it.

    Writes campaign.html, a page on runs, failures, responses and fragility, and its tables.
    """
    with exit_codes():
        _require_packages()
        from frames.design.project.source_files import SourceFiles
        from frames.results.storage import refuse_links
        from frames.risk.campaign.file import (
            campaign_file,
            comparison_in,
            loss_in,
            read_campaign,
        )

        given = campaign_file(file)
        sources = SourceFiles(given, file.resolve().parent)
        if given.search is not None:
            _search(given, file, store, workers)
            return
        found = read_campaign(given, store=store)
        comparison_in(given)  # raises if its comparison is missing
        loss_in(given)
        sources.require_unchanged()
        refuse_links(found.store.path)
        say(str(found))
        _run(found, workers or given.analysis.workers, reuse or [])
        sources.warn_of_changes()
        _write(found, given, figures=figures)
        say(f"{found.status()}\nresults in {found.store.path}, digest {found.digest()[:16]}")


def _search(given: CampaignFile, file: Path, store: Path | None, workers: int | None) -> None:
    # All points as a table beside their results, and the best one.
    from frames.results.storage import csv_of, refuse_links, write_whole
    from frames.risk.campaign.file import STORE, run_search

    folder = file.with_name(f"{file.stem}-{STORE}") if store is None else store
    refuse_links(folder)
    table = run_search(given, store=folder, workers=workers)
    write_whole(folder / "search.csv", csv_of(table))
    best = table[table["best"]].iloc[0].drop(["best", "stage"])
    said = ", ".join(f"{name} {value:.4g}" for name, value in best.items())
    say(f"{len(table)} points in {folder / 'search.csv'}\nbest: {said}")


def _run(found: Campaign, workers: int | None, reuse: list[Path]) -> None:
    # Exits with the code of the error that stopped it.
    try:
        found.run(workers=workers, progress=True, reuse=reuse)
    except KeyboardInterrupt as cause:
        done = found.status() if found.store.exists else "nothing was run"
        say(f"\ninterrupted: {done}; repeat the command to continue")
        raise typer.Exit(INTERRUPTED) from cause


def _write(found: Campaign, file: CampaignFile, *, figures: bool) -> None:
    from frames.risk.campaign.page import write_page  # with figures
    from frames.risk.campaign.tables import CampaignTables

    path = found.store.path / "campaign.html"
    written = write_page(CampaignTables(found, file), path, file.source.decode(), figures=figures)
    say(f"page {written[0]}, tables {', '.join(path.name for path in written[1:])}")


def campaign_status(
    store: Annotated[Path, typer.Argument(help="Folder with the results.")],
) -> None:
    """Print the progress of a campaign, also while it runs."""
    with exit_codes():
        _require_packages()
        from frames.risk.campaign.store import open_campaign

        found = open_campaign(store).status()
        say(str(found))
        for text in found.warnings:
            say(f"warning: {text}")


def campaign_archive(
    store: Annotated[Path, typer.Argument(help="Folder with the results.")],
    archive: Annotated[Path, typer.Argument(help="Path of the archive (.zip).")],
) -> None:
    """Write the results of a campaign as a data archive: zarr, CSV and a README."""
    with exit_codes():
        _require_packages()
        from frames.risk.campaign.archive import archive_campaign

        written = archive_campaign(store, archive)
        say(f"{written}, {written.stat().st_size / 1e6:.1f} MB, with instructions in its README.md")


def _require_packages() -> None:
    from frames.design._errors import ProjectError
    from frames.risk.campaign.store_writing import lacking_packages

    lacking = lacking_packages()
    if lacking:
        raise ProjectError(lacking)
