"""Facts of the part on buildings: period, weight, loads, plan, uplift."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames import modes
from frames.risk.fragility.runs import COMPLETE
from validation.study.shown import bearings_of, sizes_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.risk.campaign.tables import CampaignTables

WIDTH, HEIGHT = 12.0, 3.5
"""Width of the plan, height of a storey [m]."""

UPLIFT = 0.05
"""Uplift above which runs are counted [m]."""


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return by building sizes, period, kN and MN; runs that lift by device."""
    tables, found = every["buildings"], {}
    for name in tables.file.structures:
        devices = [each for each in tables.frames if each.startswith(f"{name}, ")]
        frame = tables.frames[devices[0]]
        bearings = bearings_of(frame)
        loads = [1e-3 * each.resolved()["design_load"] for each in bearings]
        found[name] = sizes_of(frame) | {
            "period": float(modes(frame, 1, bearings="fixed").periods[0]),
            "slenderness": (len(frame.levels) - 1) * HEIGHT / WIDTH,
            "weight": 1e-3 * sum(loads),
            "loads": [min(loads), max(loads)],
            "height": 1e3 * bearings[0].slider_height,
            "uplift": [_lifted(tables.runs[each].table) for each in devices],
        }
    return found


def _lifted(table: Any) -> str:
    complete = table[table["outcome"] == COMPLETE]
    return f"{int((complete['maximum uplift'] > UPLIFT).sum())} of {len(complete)}"
