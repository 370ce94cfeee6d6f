"""Own numbers and figures of the part on buildings: what they are, and what is called collapse."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.stats import norm

from frames import modes
from frames.plots import plot_style as ps
from frames.risk import FragilityError, LimitState, compare_fragility, fragility_of
from frames.risk.campaign.page import shares_exceeded
from frames.risk.fragility.runs import COMPLETE, FAILURE
from lir_element.units import STANDARD_GRAVITY
from validation.study.steps import at_two_steps, steps_said  # noqa: F401  (of the template)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from frames.frame import Frame
    from frames.risk import IntensityRuns
    from frames.risk.campaign.tables import CampaignTables

LIR, WEAK, STRONG = "LIR-DCFP", "DCFP, rims of 1 W", "DCFP, rims that never break"
DEVICES = LIR, WEAK, STRONG
SPAN, HEIGHT = 6.0, 3.5
UPLIFT, ULTIMATE, HALVED_AT = 0.05, 9.0, 2.6
UNHARMED = (1.0, 4.0, ULTIMATE)
"""Ductilities below which frames are counted whose bearings failed [-]."""


class Definition(NamedTuple):
    """What may be called collapse: demands over their limits, bearings that fail or not."""

    name: str
    limits: tuple[tuple[str, float], ...]
    bearings: bool = True

    def of(self, runs: IntensityRuns) -> tuple[IntensityRuns, LimitState]:
        """Return runs with the largest demand over its limit, and the limit state of 1."""
        table = runs.table
        shares = [table[quantity].to_numpy() / limit for quantity, limit in self.limits]
        changes = {"share": np.max(shares, axis=0) if shares else np.zeros(len(table))}
        if not self.bearings:
            outcome = table["outcome"].to_numpy()
            changes["outcome"] = np.where(outcome == FAILURE, COMPLETE, outcome)
        own = replace(runs, table=table.assign(**changes), units={**runs.units, "share": "1"})
        return own, LimitState(self.name, "share", 1.0)


DRIFT, FLOOR = "storey drift, mean", "floor acceleration in plan, mean"
NINE = ("ductility", ULTIMATE)
DEFINITIONS = (
    Definition("ductility 9 or a bearing", (NINE,)),
    Definition("ductility 6 or a bearing", (("ductility", 6.0),)),
    Definition("ductility 12 or a bearing", (("ductility", 12.0),)),
    Definition("drift 4 % or a bearing", ((DRIFT, 0.04),)),
    Definition(
        "ductility 9, floor acceleration 2 g or a bearing", (NINE, (FLOOR, 2.0 * STANDARD_GRAVITY))
    ),
    Definition("ductility 9, uplift 50 mm or a bearing", (NINE, ("maximum uplift", UPLIFT))),
    Definition("a bearing alone", ()),
    Definition("ductility 9 alone, as far as runs went", (NINE,), bearings=False),
    Definition("drift 4 % alone, as far as runs went", ((DRIFT, 0.04),), bearings=False),
)


def numbers(every: Mapping[str, CampaignTables]) -> dict[str, Any]:
    """Return what the tables do not have, by building."""
    tables = every["buildings"]
    names = tables.file.structures
    chosen = [
        (f"{name}, {device}", 3 * k, HALVED_AT)
        for k, name in enumerate(names)
        for device in (LIR, WEAK)
    ]
    found: dict[str, Any] = {"halved": at_two_steps(tables, chosen), "buildings": {}}
    for name in names:
        runs = {device: tables.runs[f"{name}, {device}"] for device in DEVICES}
        found["buildings"][name] = {
            "facts": facts_of(tables.frames[f"{name}, {WEAK}"]),
            "definitions": {each.name: _defined(each, runs) for each in DEFINITIONS},
            "shares": {device: _shares(each) for device, each in runs.items()},
            "uplift": {device: _uplift(each) for device, each in runs.items()},
            "unharmed": {device: _unharmed(each) for device, each in runs.items()},
        }
    return found


def facts_of(frame: Frame) -> dict[str, float]:
    """Return what a building is: period, strength, slenderness, loads, sliders."""
    bearings = [link.bearing for link in frame.bearings.values()]
    loads = [each.resolved()["design_load"] for each in bearings]
    storeys = len(frame.levels) - 1
    return {
        "period": float(modes(frame, 1, bearings="fixed").periods[0]),
        "strength": strength(frame),
        "slenderness": storeys * HEIGHT / (2.0 * SPAN),
        "weight": float(sum(loads)),
        "least load": float(min(loads)),
        "largest load": float(max(loads)),
        "least slider": min(each.slider_radius for each in bearings),
        "largest slider": max(each.slider_radius for each in bearings),
        "slider height": bearings[0].slider_height,
    }


def strength(frame: Frame) -> float:
    """Return the base shear of a beam mechanism over the weight [-]: equal forces at all floors.

    Beams along x turn at both ends at every floor, columns and walls at their feet alone.
    """
    total, storeys = 0.0, len(frame.levels) - 1
    for name, pair in frame.hinges.items():
        foot = name.startswith("column-1-")
        if foot or name.startswith("beam-x"):
            ends = pair[:1] if foot else pair
            moments = [hinge.moment_y for hinge in ends if hinge is not None]
            total += sum(moment for moment in moments if np.isfinite(moment))
    loads = [link.bearing.resolved()["design_load"] for link in frame.bearings.values()]
    return float(total / (0.5 * (storeys + 1) * HEIGHT) / sum(loads))


def _defined(definition: Definition, runs: Mapping[str, IntensityRuns]) -> dict[str, Any]:
    curves, counts = {}, {}
    for device, each in runs.items():
        own, limit = definition.of(each)
        counts[device] = int(np.nansum(own.exceeded(limit)))
        with suppress(FragilityError):  # outcomes that do not overlap
            curves[device] = fragility_of(own, limit, method="stripes", resamples=100)
    ratios = {}
    for other in (WEAK, STRONG):
        if LIR in curves and other in curves:
            found = compare_fragility(curves[other], curves[LIR])
            row = found.to_dataframe(0.9).loc["median, ratio [-]"]
            ratios[other] = {f"{k} [-]": float(row[k]) for k in ("value", "low", "high")}
    return {"counts": counts, "ratios": ratios}


def span_of_definitions(own: Mapping[str, Any], other: str) -> str:
    """Return the smallest and the largest ratio of medians, with what is called collapse there."""
    found = [
        (ratios[other]["value [-]"], each.name)
        for each in DEFINITIONS
        for one in own["buildings"].values()
        if each.bearings and other in (ratios := one["definitions"][each.name]["ratios"])
    ]
    if not found:
        return "is not known"
    (low, first), (high, last) = min(found), max(found)
    return f"from {low:.2f} ({first}) to {high:.2f} ({last})"


def _shares(runs: IntensityRuns) -> list[list[float]]:
    # Intensities, and the shares that collapse at each.
    return [each.tolist() for each in shares_exceeded(*DEFINITIONS[0].of(runs))]


def _uplift(runs: IntensityRuns) -> dict[str, list[float]]:
    # By intensity: complete runs, of them lifted by more than UPLIFT, their median uplift [m].
    table = runs.table[runs.table["outcome"] == COMPLETE]
    return {
        f"{level:g}": [len(u), int((u > UPLIFT).sum()), float(u.median())]
        for level, u in table.groupby("im")["maximum uplift"]
    }


def _unharmed(runs: IntensityRuns) -> list[int]:
    # Runs whose bearing failed, and of them those below each ductility until then.
    own = runs.table[runs.table["outcome"] == FAILURE]["ductility"]
    return [len(own), *(int((own <= bound).sum()) for bound in UNHARMED)]


def figures(campaigns: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Figure]:
    """Return the ratios of medians with their intervals, a panel a limit state."""
    table, names = campaigns["buildings"]["tables"]["ratios"], list(own["buildings"])
    limits = list(dict.fromkeys(table["limit state"]))
    figure, panels = ps.panels_of(len(limits), 2, 2.4)
    for panel, limit in zip(panels, limits, strict=True):
        for k, other in enumerate((WEAK, STRONG)):
            rows = table[table["limit state"] == limit]
            rows = rows[rows["over"].str.endswith(other)].dropna(subset="ratio [-]")
            at = [names.index(name) + 0.2 * (k - 0.5) for name in rows["structure"]]
            ends = [rows["ratio [-]"] - rows["low [-]"], rows["high [-]"] - rows["ratio [-]"]]
            look = ps.line_of(k)
            panel.errorbar(
                rows["ratio [-]"], at, xerr=ends, fmt="os"[k], color=look["color"], label=other
            )
        panel.axvline(1.0, color=ps.GREY, linewidth=0.7)
        panel.set_yticks(range(len(names)), names)
        ps.caption(panel, title=limit, x=f"median of the {LIR} over the other [-]")
    ps.add_legend(figure, panels[0].get_legend_handles_labels()[0], columns=2)
    return {"ratios": figure, "collapse": _collapse(campaigns["buildings"], own)}


def _collapse(told: Mapping[str, Any], own: Mapping[str, Any]) -> Figure:
    # Curves and shares, a panel a building.
    table = told["tables"]["fragility"]
    table = table[table["limit state"] == "collapse"].set_index("structure")
    figure, panels = ps.panels_of(len(own["buildings"]), 3, 2.2)
    at = np.linspace(0.1, 4.6, 80)
    for panel, (name, one) in zip(panels, own["buildings"].items(), strict=True):
        for k, (device, (im, shares)) in enumerate(one["shares"].items()):
            row = table.loc[f"{name}, {device}"]
            if row.get("median [m/s2]", 0.0) > 0.0:
                curve = norm.cdf(np.log(at / row["median [m/s2]"]) / row["dispersion [-]"])
                panel.plot(at, curve, **ps.line_of(k))
            panel.plot(im, shares, "osd"[k], markersize=3.5, color=ps.PALETTE[k])
        panel.axvline(told["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(-0.02, 1.03)
        ps.caption(panel, title=name, x="Sa(3 s) [m/s2]", y="collapse [-]")
    for k, device in enumerate(DEVICES):
        panels[0].plot([], [], marker="osd"[k], label=device, **ps.line_of(k))
    ps.add_legend(figure, panels[0].get_lines()[-len(DEVICES) :], columns=3)
    return figure
