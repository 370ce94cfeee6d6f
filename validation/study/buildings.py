"""Facts of the part on buildings: period, weight, loads, plan, uplift."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames import modes
from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.devices import highest_ratio
from frames.risk.fragility.runs import COMPLETE

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.risk.campaign.tables import CampaignTables

WIDTH, HEIGHT = 12.0, 3.5
"""Width of the plan, height of a storey [m]."""

UPLIFT = 0.05
"""Uplift above which runs are counted [m]."""


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return by building what the page says of it: s, MN, kN and mm; runs that lift by device."""
    tables, found = every["buildings"], {}
    for name in tables.file.structures:
        devices = [each for each in tables.frames if each.startswith(f"{name}, ")]
        frame = tables.frames[devices[0]]
        bearings = [link.bearing for link in frame.bearings.values()]
        loads = [1e-3 * each.resolved()["design_load"] for each in bearings]
        found[name] = {
            "period": float(modes(frame, 1, bearings="fixed").periods[0]),
            "slenderness": (len(frame.levels) - 1) * HEIGHT / WIDTH,
            "weight": 1e-3 * sum(loads),
            "loads": [min(loads), max(loads)],
            "plan": 1e3 * max(map(dish_diameter, bearings)),
            "height": 1e3 * bearings[0].slider_height,
            "interface": bearings[0].interface_friction,
            "ratio": highest_ratio(frame),
            "uplift": [_lifted(tables.runs[each].table) for each in devices],
        }
    return found


def _lifted(table: Any) -> str:
    complete = table[table["outcome"] == COMPLETE]
    return f"{int((complete['maximum uplift'] > UPLIFT).sum())} of {len(complete)}"
