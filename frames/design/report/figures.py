"""Figures of a report, drawn from results and kept inside the file."""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING, NamedTuple

from frames.design.hazard.plot_hazard import motion_spectra
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

_DOTS = 110  # per inch


class Picture(NamedTuple):
    """A figure of the report.

    Attributes
    ----------
    title : str
        What it shows.
    source : str
        A data URI of a PNG file.
    """

    title: str
    source: str


def pictures(run: ProjectRun) -> dict[str, list[Picture]]:
    """Return the figures of a run, by the section that they stand in."""
    data, where = run.governing, run.governing_case
    bearing = worst_bearing(data)
    device = next(iter(run.frame.bearings.values())).bearing
    plans: dict[str, list[tuple[str, Callable[[], Figure]]]] = {
        "structure": [("The model", lambda: model_view(run.frame))],
        "bearings": [("The bearing, to scale", lambda: bearing_dimensions(device))],
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
        section: [Picture(title, _embedded(draw())) for title, draw in made]
        for section, made in plans.items()
    }


def _embedded(figure: Figure) -> str:
    import matplotlib.pyplot as plt

    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=_DOTS, bbox_inches="tight")
    plt.close(figure)
    return "data:image/png;base64," + base64.b64encode(file.getvalue()).decode("ascii")
