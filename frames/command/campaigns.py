"""The commands of campaigns: run one from its file, and see how far one is.

What they need is imported in them: the other commands start without it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from frames.command.console import FAILED_ANALYSIS, INTERRUPTED, err, say, told
from frames.design._errors import ProjectError


def campaign(
    file: Annotated[Path, typer.Argument(help="The campaign's file.")],
    store: Annotated[Path | None, typer.Option(help="Folder for the results.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Runs at a time.")] = None,
) -> None:
    """Run a campaign, or go on with it: models, motions, scales and parameters of a file."""
    with told():
        _require_packages()
        from frames.risk.campaign.file import read_campaign, workers_of

        found = read_campaign(file, store=store)
        say(str(found))
        try:
            found.run(workers=workers or workers_of(file), progress=True)
        except KeyboardInterrupt as cause:
            done = found.status() if found.store.exists else "nothing was run"
            say(f"\ninterrupted: {done}; the same command goes on")
            raise typer.Exit(INTERRUPTED) from cause
        except OSError as cause:
            err.print(f"error: {cause}", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(FAILED_ANALYSIS) from cause
        say(f"{found.status()}\nresults in {found.store.path}, digest {found.digest()[:16]}")


def campaign_status(
    store: Annotated[Path, typer.Argument(help="Folder of the results.")],
) -> None:
    """Tell how far a campaign is, also while it runs."""
    with told():
        _require_packages()
        from frames.risk.campaign.store import open_campaign

        found = open_campaign(store).status()
        say(str(found))
        for text in found.warnings:
            say(f"warning: {text}")


def _require_packages() -> None:
    from frames.risk.campaign.packages import lacking_packages

    lacking = lacking_packages()
    if lacking:
        raise ProjectError(lacking)
