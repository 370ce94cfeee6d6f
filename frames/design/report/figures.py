"""Figures of a report, drawn from results and kept inside the file."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from frames.design.hazard.plot_hazard import motion_spectra
from frames.design.report.numbers import devices_by_type
from frames.design.report.page import Picture, picture
from frames.design.report.suite_figures import (
    motions_figure,
    plan_figure,
    profiles_figure,
    typical_bearing,
)
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

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import TypeAlias

    from matplotlib.figure import Figure

    from frames.design.project.design_run import ProjectRun
    from frames.design.report.words import Words

    Plan: TypeAlias = tuple[str, Callable[[], Figure | None]]
    """Title of a figure, and what draws it; None where there is nothing to draw."""


def pictures(run: ProjectRun, words: Words) -> dict[str, list[Picture]]:
    """Return the figures of a run, by the section that they stand in."""
    plans: dict[str, list[Plan]] = {
        "structure": [("The model", lambda: model_view(run.frame))],
        "bearings": [
            (
                f"The bearing, type {kind}, to scale" if kind else "The bearing, to scale",
                partial(bearing_dimensions, device),
            )
            for kind, device in devices_by_type(run).items()
        ],
        "motions": [
            (
                "Spectra of the motions as they were run, and the design spectrum",
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
    data, where = run.governing, run.governing_case
    bearing, typical = worst_bearing(data), typical_bearing(data)
    is_met = bool((data["rim_force"].sel(bearing=bearing) > 0.0).any())
    event = "the impact" if is_met else "its largest displacement"
    plans: list[Plan] = [
        (
            f"The bearing before, during and after {event}, {bearing}; {where}",
            lambda: bearing_sections(data, bearing=bearing),
        ),
        (f"Force over displacement, {bearing}; {where}", lambda: hysteresis(data, bearing)),
    ]
    if typical != bearing:
        title = f"Force over displacement of a typical bearing, {typical}; {where}"
        plans.append((title, lambda: hysteresis(data, typical)))
    return [
        *plans,
        (f"Energy; {where}", lambda: energy(data)),
        (f"Orbits, {bearing}; {where}", lambda: orbits(data, bearing)),
        (f"Storeys; {where}", lambda: storey_profiles(data)),
        (f"Bearings in plan; {where}", lambda: bearing_plan(data)),
    ]


def _drawn(made: list[Plan], words: Words) -> Iterator[Picture]:
    # One after the other: a figure is closed before the next is drawn.
    for title, draw in made:
        figure = draw()
        if figure is not None:
            yield picture(title, figure, words)
