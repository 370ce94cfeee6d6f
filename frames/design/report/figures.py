"""Figures of a report: of all runs of a project, of the governing one, and the bearings in plan."""

from __future__ import annotations

import math
from functools import partial, reduce
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from frames.design.hazard.plot_hazard import motion_spectra
from frames.design.histories.demand_table import worst_place
from frames.design.histories.eccentricity import Case, levels_of, reached_by
from frames.design.histories.suite import names_of, peaks_of_runs
from frames.design.project.level_runs import most_displaced, named_case
from frames.design.report.page import Picture, picture
from frames.design.report.tender import types_of
from frames.design.report.tender_plan import tender_plan
from frames.plots import (
    bearing_dimensions,
    bearing_plan,
    bearing_sections,
    energy,
    hysteresis,
    model_view,
    orbits,
    storey_profiles,
    worst_bearing,
)
from frames.plots import plot_style as ps
from frames.results.peak_response import largest
from frames.results.quantities import JUDGED
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import TypeAlias

    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from frames.design.calculation.check import Check
    from frames.design.project.design_run import ProjectRun
    from frames.design.report.page import Words

    Plan: TypeAlias = tuple[str, Callable[[], Figure | None]]
    """Title of a figure, and the function that draws it; None if there is nothing to draw."""


_OF_BEARINGS = {
    quantity.heading: name
    for name, quantity in JUDGED.items()
    if quantity.dims == ("bearing",) and quantity.kind == "peak" and name != "gap"
} | {
    "slip over the overlap": "slip",
    "slip over its stable limit s*": "slip",
    "residual slip": "slip_left",
}
"""Checks whose demand is of one bearing, and the quantity that it is of."""


class Reached(NamedTuple):
    """Peaks of the motions at one bound, at the governing place."""

    case: Case  # the runs of that bound, and how they count
    values: FloatArray  # (n_runs,) of each motion
    design: float  # their design value by the code: mean or largest
    where: str  # bearing or storey


def reached(run: ProjectRun, name: str) -> list[Reached]:
    """Return the peaks of a quantity in all motions at each bound."""
    of_bearings = JUDGED[name].dims == ("bearing",)
    level = run.rules.bearing_level if of_bearings else _structure_level(run)
    found = []
    for case in levels_of(run.cases)[level]:
        if case.keeps(name):
            design = case.design(name)
            k = worst_place(design)
            values = reached_by(case.data, name)[:, k]
            found.append(Reached(case, values, design[k], names_of(case.data, name)[k]))
    return found


def _structure_level(run: ProjectRun) -> str:
    return next(level.name for level in run.rules.levels if level.judges_structure)


def _placed(one: Reached) -> str:
    if not one.case.bound:
        return one.where
    return worded("{where} at {bound}", where=one.where, bound=one.case.bound)


def motions_figure(run: ProjectRun) -> Figure:
    """Draw displacement, slip and drift of every motion at every bound, and their design values."""
    shown = [
        (JUDGED[name].demand, *JUDGED[name].in_figures, found)
        for name in ("displacement", "slip", "drift")
        if (found := reached(run, name))
    ]
    figure, panels = ps.panels_of(len(shown), 1, 1.75, share=False)
    for panel, (title, unit, factor, found) in zip(panels, shown, strict=True):
        _motions(panel, found, factor)
        where = joined(*dict.fromkeys(_placed(one) for one in found), by=", ")
        ps.caption(panel, y=f"[{unit}]", title=worded("{what}: {where}", what=title, where=where))
    cases = [each.case for each in shown[0][3]]
    motions = list(map(str, cases[0].data["motion"].to_numpy()))
    for panel in panels:
        panel.set_xticks(range(len(motions)), motions if panel is panels[-1] else [], rotation=90)
    every = [each.case.suite for *_, found in shown for each in found]
    raised = "raised by moved masses"
    statistics = {joined(e.statistic, raised if e.raised else "", by=", ") for e in every}
    handles = [
        Line2D(
            [],
            [],
            color=ps.PALETTE[k],
            marker="o^v"[k % 3],
            linestyle="-",
            label=case.bound or "runs",
        )
        for k, case in enumerate(cases)
    ]
    title = worded(
        "All motions; lines: the {statistic}, at the place that governs",
        statistic=reduce(
            lambda one, other: worded("{one} or the {other}", one=one, other=other),
            sorted(statistics),
        ),
    )
    if any(any(each.failed) for each in every):
        handles.append(_cross(label="run that failed"))
    if not all(each.is_usable for each in every):
        title = VOID_TITLE
    ps.add_legend(figure, handles, title=title)
    return figure


VOID_TITLE = "All motions; runs failed: lines show their largest values, not valid for design"
"""Title of a figure whose lines are no values for design."""


def _cross(**more: Any) -> Line2D:
    return Line2D([], [], color=ps.GREY, marker="x", linestyle="none", **more)


def _motions(panel: Axes, found: list[Reached], factor: float) -> None:
    for k, each in enumerate(found):
        shift = 0.18 * (k - 0.5 * (len(found) - 1))
        places = np.arange(len(each.values)) + shift
        failed = np.array(each.case.suite.failed)
        for which, mark in ((~failed, "o^v"[k % 3]), (failed, "x")):
            if which.any():
                values = factor * each.values[which]
                panel.plot(places[which], values, mark, color=ps.PALETTE[k], markersize=4.0)
        if math.isfinite(each.design):
            panel.axhline(factor * each.design, color=ps.PALETTE[k], linewidth=1.0)
    panel.margins(y=0.1)
    panel.set_ylim(bottom=0.0)


def profiles_figure(run: ProjectRun) -> Figure | None:
    """Draw the drift of every storey in every motion, and its design value."""
    cases = [case for case in levels_of(run.cases)[_structure_level(run)] if case.keeps("drift")]
    if not cases or len(names_of(cases[0].data, "drift")) < 2:
        return None
    figure, panels = ps.panels_of(len(cases), len(cases), 3.0)
    for k, (panel, case) in enumerate(zip(panels, cases, strict=True)):
        _profile(panel, case, ps.PALETTE[k])
        ps.caption(panel, x="storey drift ratio [%]", title=case.bound or "runs")
    panels[0].set_xlim(left=0.0)
    title = "Storey drift of all motions, and the value for design"
    usable = all(case.suite.is_usable for case in cases)
    ps.add_legend(figure, [], title=title if usable else VOID_TITLE)
    return figure


def _profile(panel: Axes, case: Case, colour: str) -> None:
    values, design = 1e2 * peaks_of_runs(case.data, "drift"), 1e2 * case.design("drift")
    edges = np.arange(values.shape[1] + 1)
    look: dict[str, Any] = {"orientation": "horizontal", "baseline": None}
    for motion, failed in zip(values, case.suite.failed, strict=True):
        line = ":" if failed else "-"
        panel.stairs(motion, edges, color=ps.GREY, linewidth=0.5, linestyle=line, **look)
    panel.stairs(design, edges, color=colour, linewidth=1.8, **look)
    panel.set_yticks(edges[:-1] + 0.5, names_of(case.data, "drift"))


def typical_bearing(data: xr.Dataset) -> str:
    """Return the bearing whose largest displacement in a run is the median of all."""
    values = largest(data, "displacement").values
    order = np.argsort(values, kind="stable")
    return str(data["bearing"].to_numpy()[order[(len(order) - 1) // 2]])


def utilisation(run: ProjectRun) -> tuple[Check, FloatArray] | None:
    """Return how far each bearing is used by the check of bearings that governs.

    Shapes: result (n_bearings,).
    """
    alike = len({link.bearing for link in run.frame.bearings.values()}) == 1
    of_one = [c for c in run.checks if c.title in _OF_BEARINGS and c.subject and not c.void]
    if not alike or not of_one:
        return None
    check = max(of_one, key=lambda c: c.ratio)
    level, name = check.level or run.rules.bearing_level, _OF_BEARINGS[check.title]
    each = next(
        case.design(name) for case in levels_of(run.cases)[level] if case.bound == check.bound
    )
    if check.symbol == "D_d":
        each = run.rules.displacement_factor * each
        least = check.trace.value("D_least") if "D_least" in check.trace else 0.0
        each = np.maximum(each, least)
    return check, each / check.limit


def plan_figure(run: ProjectRun) -> Figure | None:
    """Draw the bearings in plan by how far the check that governs uses them."""
    found = utilisation(run)
    if found is None:
        return None
    check, shares = found
    links = run.frame.bearings
    spots = np.array([[run.frame.nodes[k.j].x, run.frame.nodes[k.j].y] for k in links.values()])
    gaps = np.linalg.norm(spots[:, None] - spots[None], axis=-1)
    apart = float(gaps[gaps > 0.0].min()) if (gaps > 0.0).any() else 1.0
    low, high = spots.min(axis=0) - 0.7 * apart, spots.max(axis=0) + 0.7 * apart
    width = ps.PAGE_WIDTH
    tall = float(np.clip(width * (high[1] - low[1]) / (high[0] - low[0]), 2.4, 4.6))
    figure = ps.new_figure(tall)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    colours = ScalarMappable(Normalize(0.0, max(1.0, float(shares.max()))), "YlOrRd")
    for name, (x, y), share in zip(links, spots, shares, strict=True):
        panel.add_patch(
            Circle((x, y), 0.2 * apart, facecolor=colours.to_rgba(share), edgecolor=ps.GREY)
        )
        text = f"{name}\n{share:.2f}"
        panel.annotate(text, (x, y - 0.23 * apart), ha="center", va="top", fontsize=ps.SMALL)
    panel.set_aspect("equal")
    panel.set_xlim(low[0], high[0])
    panel.set_ylim(low[1], high[1])
    ps.caption(panel, x="x [m]", y="y [m]")
    bar = figure.colorbar(colours, ax=panel, shrink=0.8)
    bar.set_label("ratio to the limit [-]", fontsize=ps.LABEL)
    bar.ax.tick_params(labelsize=ps.SMALL)
    ps.add_legend(figure, [], title=joined(check.title, check.bound, by=", "))
    return figure


def pictures(run: ProjectRun, words: Words) -> dict[str, list[Picture]]:
    """Return the figures of a run, by their section."""
    kinds = types_of(run)
    plans: dict[str, list[Plan]] = {
        "structure": [("The model", lambda: model_view(run.frame))],
        "tender": [
            ("The bearings in plan, with axes and numbers", lambda: tender_plan(run)),
            *(
                (
                    worded("The bearing, type {kind}, to scale", kind=one.name)
                    if len(kinds) > 1
                    else "The bearing, to scale",
                    partial(bearing_dimensions, one.bearing, one.make.plates, reach=one.make.reach),
                )
                for one in kinds
            ),
        ],
        "motions": [
            (
                "Spectra of the scaled motions, and the design spectrum",
                lambda: motion_spectra(run.motions, run.spectrum),
            ),
        ],
        "suite": [
            (
                "Displacement, slip and drift of every motion at each bound; lines are the values "
                "for design of the table above",
                lambda: motions_figure(run),
            ),
            (
                "Storey drift of every motion, and the value for design",
                lambda: profiles_figure(run),
            ),
            (
                "Bearings in plan, by the ratio of the check of bearings that governs",
                lambda: plan_figure(run),
            ),
        ],
        "histories": _of_one_run(run),
    }
    return {section: list(_drawn(made, words)) for section, made in plans.items()}


def _of_one_run(run: ProjectRun) -> list[Plan]:
    # as a file has it, the title is English
    data = run.governing.assign_attrs(title=named_case(most_displaced(run.runs), failed=False))
    bearing, typical = worst_bearing(data), typical_bearing(data)
    is_met = bool((data["rim_force"].sel(bearing=bearing) > 0.0).any())
    event = "the impact" if is_met else "its largest displacement"
    plans: list[Plan] = [
        (
            worded("The bearing before, during and after {event}", event=event),
            lambda: bearing_sections(data, bearing=bearing),
        ),
        ("Force over displacement of this bearing", lambda: hysteresis(data, bearing)),
    ]
    if typical != bearing:
        title = "Force over displacement of the bearing with the median displacement"
        plans.append((title, lambda: hysteresis(data, typical)))
    return [
        *plans,
        ("Energy", lambda: energy(data)),
        ("Path of the bearing", lambda: orbits(data, bearing)),
        ("Storey drifts and floor accelerations", lambda: storey_profiles(data)),
        ("Bearings in plan", lambda: bearing_plan(data)),
    ]


def _drawn(made: list[Plan], words: Words) -> Iterator[Picture]:
    # One after the other: a figure is closed before the next is drawn.
    for title, draw in made:
        figure = draw()
        if figure is not None:
            yield picture(title, figure, words)
