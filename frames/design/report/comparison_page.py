"""A comparison of two devices as one HTML page and tables."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.design.project.comparison import OURS, PLAIN
from frames.design.report.comparison_words import verdicts
from frames.design.report.page import page_table, page_template
from frames.design.report.tables import in_mm_and_kn
from frames.results.storage import csv_of, make_folder, write_whole
from lir_element.results.dataset import package_version

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr

    from frames.design.project.comparison import Comparison


def write_comparison(
    found: Comparison,
    folder: Path,
    source: str,
    histories: tuple[Mapping[str, xr.Dataset], str, str] | None,
) -> list[Path]:
    """Write what a comparison of two devices gave."""
    make_folder(folder)
    texts = {
        "compare.csv": csv_of(found.table()),
        "compare-motions.csv": csv_of(found.by_motion(), index=False),
        "compare.html": _page(found, source, histories),
    }
    written = []
    for name, text in texts.items():
        path = folder / name
        write_whole(path, text)
        written.append(path)
    return written


def _page(
    found: Comparison,
    source: str,
    histories: tuple[Mapping[str, xr.Dataset], str, str] | None,
) -> str:
    motions = found.by_motion()
    pictures = {}
    if histories is not None:
        from frames.design.report.comparison_figures import comparison_pictures

        pictures = comparison_pictures(motions, *histories)
    return page_template("compare.html.j2").render(
        name=found.known.frame.name,
        code=found.known.equivalent.code,
        verdicts=verdicts(found),
        demands=page_table(_differences(found), "quantity"),
        statistics={device: _statistic(found, device) for device in (OURS, PLAIN)},
        motions=page_table(_numbered(motions), "motion"),
        eccentricity=found.eccentricity,
        case="" if histories is None else histories[1],
        pictures=pictures,
        doubts=found.known.doubts,
        source=source,
        written=f"{datetime.now(tz=UTC):%Y-%m-%d %H:%M} UTC, lir-dcfp {package_version()}",
    )


def _differences(found: Comparison) -> pd.DataFrame:
    # The envelopes of both devices, and how far the first is from the second.
    ours, plain = (found.demands[device] for device in (OURS, PLAIN))
    one, two = ours["envelope"], plain["envelope"].to_numpy()
    change = 100.0 * (one / np.where(np.abs(two) > 0.0, two, math.nan) - 1.0)
    void = (ours["void"] != "").to_numpy() | (plain["void"] != "").to_numpy()
    words = [
        "no value" if failed else "-" if math.isnan(value) else f"{value:+.0f} %"
        for value, failed in zip(change, void, strict=True)
    ]
    table = ours[["unit"]].assign(**{OURS: one, PLAIN: two, f"{OURS} to {PLAIN}": words})
    return table if ours["level"].nunique() == 1 else table.assign(level=ours["level"])


def _statistic(found: Comparison, device: str) -> str:
    statistics: Mapping[str, str] = found.demands[device].attrs["statistics"]
    said = dict.fromkeys(statistics.values())
    if len(said) == 1:
        return next(iter(said))
    return "; ".join(f"{bound}: {words}" for bound, words in statistics.items())


def _numbered(motions: pd.DataFrame) -> pd.DataFrame:
    # Motions with the numbers that the figure has.
    number = {name: k for k, name in enumerate(dict.fromkeys(motions["motion"]), start=1)}
    named = [f"{number[name]} {name}" for name in motions["motion"]]
    shown = motions.drop(columns="motion").rename(columns={"failed": "runs that stopped"})
    shown.index = pd.Index(named, name="motion")
    if shown["level"].nunique() == 1:
        shown = shown.drop(columns="level")
    shown = in_mm_and_kn(shown)
    return shown.iloc[sorted(range(len(shown)), key=lambda k: number[motions["motion"].iloc[k]])]
