"""Own numbers and figures of the part on the records of FEMA P695."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from frames.risk.campaign.comparison import dish_diameter
from frames.risk.campaign.ductility import yield_rotations
from validation.study.shown import where
from validation.study.steps import at_two_steps, checked, checks_said, steps_said  # noqa: F401  (of the template)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from frames.risk.campaign.tables import CampaignTables

LIR, RIMS, WIDE = "LIR-DCFP", "DCFP with rims", "larger-diameter DCFP"
ROOM = "LIR-DCFP, larger sliders"
HALVED = ((LIR, 0, 1.6), (RIMS, 5, 2.2), (RIMS, 30, 1.9), (WIDE, 22, 2.6), (LIR, 44, 1.6))
"""Runs at half the step: device, number of the motion, intensity [m/s2]."""


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return what the tables do not have."""
    tables = every["records"]
    bearings = [link.bearing for link in tables.frames[LIR].bearings.values()]
    options = [each.resolved() for each in bearings]
    wide, widest = tables.runs[WIDE].table, max(bearings, key=lambda each: each.slider_radius)
    reached = wide.groupby("im")["bearing displacement"]
    strengths = {
        round(o["rim_stiffness"] * o["rim_overrun"] / o["design_load"], 1) for o in options
    }
    return {
        "halved": at_two_steps(tables, HALVED),
        "checks": checked(tables),
        "slip": min(o["slip_capacity"] for o in options),
        "rims": sorted(strengths),
        "yields": {
            name.split("-")[0]: rotation
            for name, rotation in yield_rotations(tables.frames[LIR]).items()
        },
        "dishes": {
            f"{im:g}": [
                dish_diameter(widest, d) for d in (own.median(), own.quantile(0.84), own.max())
            ]
            for im, own in reached
        },
        "displacements": {
            f"{im:g}": [own.median(), own.quantile(0.84), own.max()] for im, own in reached
        },
    }


def same_as_failures(told: Mapping[str, Any], device: str) -> list[str]:
    """Return the limit states that those runs alone exceed whose bearing fails."""
    failed = where(told["tables"]["margins"], device=device, record_set="all")[
        "bearing failed"
    ].iloc[0]
    own = where(told["tables"]["fragility"], structure=device, record_set="all")
    return [str(row["limit state"]) for _, row in own.iterrows() if row["exceeded"] == failed]


def stripe(told: Mapping[str, Any], device: str, at: float) -> Mapping[str, Any]:
    """Return the responses of a device at the intensity next to a wanted one."""
    own = where(told["tables"]["response"], structure=device)
    return dict(own.iloc[int(np.argmin(np.abs(own["factor"].to_numpy() - at)))])


def last_held(told: Mapping[str, Any], device: str) -> Mapping[str, Any]:
    """Return the last responses of a device at which half of the records have no failed bearing."""
    own = where(told["tables"]["response"], structure=device)
    return dict(own[own["bearing failed [-]"] < 0.5].iloc[-1])


def figures(campaigns: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the medians over the intensity, with the share of failed bearings."""
    table = campaigns["records"]["tables"]["response"]
    shown = {
        "ductility": ("ductility [-]", 1.0),
        "floor acceleration in plan, mean": ("floor acceleration [m/s2]", 1.0),
        "residual bearing displacement": ("residual displacement [mm]", 1e3),
        "bearing failed": ("bearings failed [%]", 100.0),
    }
    figure, panels = ps.panels_of(4, 2, 2.3, share=False)
    for panel, (name, (text, factor)) in zip(panels, shown.items(), strict=True):
        for k, (_, rows) in enumerate(table.groupby("structure", sort=False)):
            column = next(c for c in rows if c.startswith((f"{name}, median [", f"{name} [")))
            values = rows[column].replace(np.inf, np.nan)
            panel.plot(rows["factor"], factor * values, marker="os^d"[k], **ps.line_of(k))
        ps.caption(panel, x="Sa(3 s) [m/s2]", y=text)
    for k, name in enumerate(dict.fromkeys(table["structure"])):
        panels[0].plot([], [], marker="os^d"[k], label=name, **ps.line_of(k))
    ps.add_legend(figure, panels[0].get_lines()[-len(set(table["structure"])) :], columns=2)
    return {"medians": figure}
