"""Figures of a report, drawn from results and kept inside the file."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from frames.design.hazard.plot_hazard import motion_spectra
from frames.design.report.numbers import devices_by_type
from frames.design.report.page import Picture, picture
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
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from frames.design.project.design_run import ProjectRun


def pictures(run: ProjectRun) -> dict[str, list[Picture]]:
    """Return the figures of a run, by the section that they stand in."""
    data, where = run.governing, run.governing_case
    bearing = worst_bearing(data)
    plans: dict[str, list[tuple[str, Callable[[], Figure]]]] = {
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
        "histories": [
            (
                f"The bearing before, during and after the impact, {bearing}; {where}",
                lambda: bearing_sections(data, bearing=bearing),
            ),
            (f"Force over displacement, {bearing}; {where}", lambda: hysteresis(data, bearing)),
            (f"Orbits, {bearing}; {where}", lambda: orbits(data, bearing)),
            (f"Storeys; {where}", lambda: storey_profiles(data)),
            (f"Bearings in plan; {where}", lambda: bearing_plan(data)),
            (f"Energy; {where}", lambda: energy(data)),
        ],
    }
    return {
        section: [picture(title, draw()) for title, draw in made] for section, made in plans.items()
    }
