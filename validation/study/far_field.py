"""A part of the study that is one campaign under FEMA P695's far-field set: its command, its files."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frames.design import MotionSet
from frames.risk import open_campaign
from frames.risk.fragility.resampling import RESAMPLES
from validation.page import DPI, FOLDER
from validation.study.records import options_of, performed
from validation.study.records_runs import normalised

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr
    from matplotlib.figure import Figure

    from frames import GroundMotion
    from frames.risk import Campaign

    Found = Mapping[str, Any]
    Motions = Mapping[str, GroundMotion]

RECORDS = "far-field"


def run_part(
    part: str,
    given: Sequence[str] | None,
    campaign: Callable[[Motions, Path], Campaign],
    found_of: Callable[[xr.Dataset, Motions, int], dict[str, Any]],
    write: Callable[[Found], None],
) -> None:
    """Run the campaign of a part, or go on with it, and write its page.

    Parameters
    ----------
    part : str
        Its name, as in ``python -m validation.study.<part>``.
    given : sequence of str or None
        Options; None: those of the command.
    campaign : callable
        Makes the campaign of motions in a folder.
    found_of : callable
        Makes plain numbers of its results, motions and a number of resamples.
    write : callable
        Writes what was found.
    """
    options = options_of(part, given)
    if options.again:
        write(json.loads((FOLDER / f"study_{part}.json").read_text(encoding="utf-8")))
        return
    motions = normalised(MotionSet.fema_p695(RECORDS))
    with tempfile.TemporaryDirectory() as folder:
        store = options.store or Path(folder, "runs")
        cost = performed(campaign(motions, store), options.workers)
        data = open_campaign(store).results()
        write(found_of(data, motions, RESAMPLES) | {"cost": cost, "records": len(motions)})


def write_part(
    name: str, text: str, figures: Mapping[str, Figure], found: Found, folder: Path = FOLDER
) -> None:
    """Write a page, its figures by file and its numbers."""
    for file, figure in figures.items():
        figure.savefig(folder / "figures" / file, dpi=DPI, metadata={"Software": None})
    (folder / f"{name}.md").write_text(text, encoding="utf-8")
    (folder / f"{name}.json").write_text(json.dumps(found) + "\n", encoding="utf-8")
    print(f"written to {folder}")
