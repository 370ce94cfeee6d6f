"""Runs of a campaign again at half of its step: what parts of the study say of the step."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from frames import time_histories
from frames.risk.campaign.ductility import DUCTILITY, ductility
from lir_element.units import STANDARD_GRAVITY
from validation.page import table
from validation.study.part import quietly

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from frames.risk.campaign.tables import CampaignTables

DRIFT, FLOOR = "storey drift, mean", "floor acceleration in plan, mean"
SHOWN = {
    DUCTILITY: ("ductility [-]", 1.0, ".2f"),
    DRIFT: ("storey drift [%]", 1e2, ".2f"),
    FLOOR: ("floor acceleration [g]", 1.0 / STANDARD_GRAVITY, ".2f"),
    "bearing displacement": ("bearing displacement [mm]", 1e3, ".0f"),
    "interface slip": ("interface slip [mm]", 1e3, ".1f"),
}
"""Demands that are compared: their text, a factor from SI, a format."""


def at_two_steps(
    tables: CampaignTables, chosen: Iterable[tuple[str, int, float]]
) -> list[dict[str, Any]]:
    """Return demands at the step of a campaign and at half: structure, number of motion, factor."""
    step = float(tables.file.analysis.dt or 0.01)
    motions, rows = list(tables.campaign.motions.items()), []
    for model, number, scale in chosen:
        name, motion = motions[number % len(motions)]
        runs = []
        for dt in (step, 0.5 * step):
            with quietly():
                frame = tables.frames[model]
                data = time_histories(
                    {model: frame},
                    {name: motion},
                    scales=[scale],
                    dt=dt,
                    level=tables.file.analysis.level,
                )
            peaks = data["peak"].isel(run=0).to_series().to_dict()
            peaks[DUCTILITY] = float(ductility(data, frame)[0])
            values = {q: float(peaks[q]) if isfinite(peaks[q]) else None for q in SHOWN}
            runs.append({"status": str(data["status"].item())} | values)
        rows.append({"device": model, "motion": name, "im": scale, "runs": runs})
    return rows


def steps_said(rows: Sequence[dict[str, Any]]) -> str:
    """Return how far runs at two steps are apart, and their table in Markdown."""
    lines, apart = [], []
    for row in rows:
        whole, half = row["runs"]
        ends = list(dict.fromkeys((whole["status"], half["status"])))
        apart += [row["device"]] if len(ends) > 1 else []
        cells = [
            ", ".join("-" if v is None else f"{factor * v:{form}}" for v in (whole[q], half[q]))
            for q, (_, factor, form) in SHOWN.items()
        ]
        said = "`" + "`, `".join(ends) + "`"
        lines.append([row["device"], row["motion"], f"{row['im']:g}", said, *cells])
    words = []
    for quantity, (text, *_) in SHOWN.items():
        far = [
            abs(whole[quantity] / half[quantity] - 1.0)
            for whole, half in (row["runs"] for row in rows)
            if whole["status"] == half["status"] == "ok" and (half[quantity] or 0.0) > 1e-3
        ]
        words += [f"{100.0 * max(far):.1f} % of {text.split(' [')[0]}"] if far else []
    said = f"demands of complete runs differ by at most {', '.join(words) or 'nothing'}"
    alike = f"ends differ in {'; '.join(apart)}" if apart else "all end alike"
    head = ["device", "record", "Sa [m/s2]", "status", *(text for text, *_ in SHOWN.values())]
    return f"{alike}; {said}.\n\n{table(head, lines)}"
