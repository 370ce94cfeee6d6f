"""Figures of the hazard: spectra for several dampings, and sets of motions against a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames._errors import MotionError
from frames.design.hazard.motion_set import MotionSet
from frames.design.hazard.spectrum import Spectrum
from frames.plots import plot_style as ps
from lir_element.argument_checks import require_positive, require_type
from lir_element.texts import joined, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

SHORTEST, POINTS = 0.05, 90
"""Shortest period at which spectra of motions are drawn [s], and number of periods."""


def design_spectra(
    spectra: Spectrum | Sequence[Spectrum] | Mapping[str, Spectrum],
    dampings: Sequence[float] = (0.05, 0.10, 0.20, 0.30),
    *,
    longest: float = 5.0,
) -> Figure:
    """Draw pseudo-accelerations and displacements of spectra over the period.

    Parameters
    ----------
    spectra : Spectrum, or sequence or mapping of them
        One spectrum for several dampings, or up to six, of which each has a colour.
    dampings : sequence of float
        Parts of the critical damping [-], four at most; each has its kind of line.
    longest : float
        Longest period [s].

    Returns
    -------
    Figure
        The spectra.

    Raises
    ------
    MotionError
        If there is none or too many, or a damping is out of its bounds.

    Examples
    --------
    In the gallery: "Design spectra of three codes" (docs/gallery/design/a_spectra.py).
    """
    if isinstance(spectra, Spectrum):
        named = {spectra.name: spectra}
    else:
        named = (
            dict(spectra)
            if isinstance(spectra, Mapping)
            else {getattr(each, "name", "?"): each for each in spectra}
        )
    for name, spectrum in named.items():
        require_type(f"spectra[{name!r}]", spectrum, Spectrum, "a Spectrum")
    end = require_positive("longest", longest, "s", error=MotionError)
    if not 1 <= len(named) <= len(ps.PALETTE) or not 1 <= len(dampings) <= 4:
        msg = (
            f"{len(named)} spectra and {len(dampings)} dampings: give 1 to {len(ps.PALETTE)} "
            "spectra and 1 to 4 dampings"
        )
        raise MotionError(msg)
    figure = ps.new_figure(3.1)
    left, right = ps.grid_of(figure, 1, 2)[0]
    one = len(named) == 1
    names: list[Artist] = []
    marks: list[Artist] = []
    for k, (name, spectrum) in enumerate(named.items()):
        corners = [c for c in spectrum.corner_periods.values() if c < end]
        start, last = spectrum.reach
        periods = np.union1d(np.linspace(start, min(end, last), 400), corners)
        for j, damping in enumerate(dampings):
            look: dict[str, Any] = {
                "color": ps.PALETTE[j if one else k],
                "linestyle": ps.LINES[0 if one else j],
            }
            left.plot(periods, spectrum.acceleration(periods, damping) / STANDARD_GRAVITY, **look)
            right.plot(periods, spectrum.displacement(periods, damping), **look)
            if one or k == 0:
                kind = look if one else {**look, "color": ps.GREY}
                marks.append(Line2D([], [], label=f"{100.0 * damping:g} %", **kind))
        if not one:
            names.append(Line2D([], [], label=name, color=ps.PALETTE[k]))
    for panel, text in ((left, "pseudo-acceleration [g]"), (right, "displacement [m]")):
        panel.set_xlim(0.0, end)
        panel.set_ylim(bottom=0.0)
        ps.caption(panel, x="period [s]", y=text)
    title = f"{next(iter(named))}, damping" if one else "Design spectra, damping"
    ps.add_legend(figure, names + marks, columns=4 if one else 2, title=title)
    return figure


def motion_spectra(
    motions: MotionSet,
    target: Spectrum | None = None,
    *,
    measure: str | None = None,
    damping: float | None = None,
    longest: float = 5.0,
) -> Figure:
    """Draw the spectra of a set of motions, their mean, and the target with its range.

    Parameters
    ----------
    motions : MotionSet
        The set; of one that is scaled, target, measure and damping need not be given.
    target : Spectrum, optional
        The target.
    measure : str, optional
        Measure of a pair; "RotD100" for a set that is not scaled.
    damping : float, optional
        Part of the critical damping [-]; 5 % for a set that is not scaled.
    longest : float
        Longest period [s].

    Returns
    -------
    Figure
        Pseudo-accelerations and displacements, and the mean over the target if there is one.

    Raises
    ------
    MotionError
        If an argument is out of its bounds, or a component is missing.

    Examples
    --------
    In the gallery: "A set of motions scaled to a spectrum" (docs/gallery/design/b_motions.py).
    """
    require_type("motions", motions, MotionSet, "a MotionSet")
    done = motions.scaling
    goal = target if target is not None or done is None else done.target
    kind = measure or (done.measure if done else "RotD100")
    ratio = damping if damping is not None else done.damping if done else 0.05
    end = require_positive("longest", longest, "s", error=MotionError)
    periods = np.geomspace(SHORTEST, max(end, 2.0 * SHORTEST), POINTS)
    table = motions.spectra(periods, ratio, kind).to_numpy()
    mean = table.mean(axis=1)
    figure = ps.new_figure(3.6 if goal is None else 5.0)
    rows, heights = ("ad", (1.0,)) if goal is None else ("ad;rr", (1.7, 1.0))
    panels = figure.subplot_mosaic(rows, height_ratios=heights)
    for panel in panels.values():
        ps.style(panel)
        panel.set_xlim(0.0, end)
        ps.caption(panel, x="period [s]")
    shift = (periods / (2.0 * np.pi)) ** 2  # of pseudo-accelerations to displacements
    sizes = {"a": np.full(POINTS, 1.0 / STANDARD_GRAVITY), "d": shift}
    for key, size in sizes.items():
        handles = _motions(panels[key], size[:, None] * table, size * mean, periods)
    if goal is not None:
        known = (periods >= goal.reach[0]) & (periods <= goal.reach[1])
        level = np.where(known, 1.0, np.nan)
        level[known] = goal.acceleration(periods[known], ratio)
        look: dict[str, Any] = {"color": ps.PALETTE[1], "linewidth": 1.4, "linestyle": "--"}
        for key, size in sizes.items():
            panels[key].plot(periods, size * level, **look)
        handles.append(
            Line2D([], [], label=worded("target: {spectrum}", spectrum=goal.name), **look)
        )
        panels["r"].plot(periods, mean / level, color=ps.PALETTE[0], linewidth=1.7)
        panels["r"].axhline(done.part if done else 1.0, **look)
        panels["r"].set_ylim(bottom=0.0)
        ps.caption(panels["r"], y="mean / target [-]")
    if done is not None:
        low, high = done.periods
        for panel in panels.values():
            panel.axvspan(low, high, color=ps.PALETTE[4], alpha=0.15, linewidth=0.0)
        text = worded("range {a:.3g} s to {b:.3g} s", a=low, b=high)
        handles.append(Patch(color=ps.PALETTE[4], alpha=0.25, label=text))
    ps.caption(panels["a"], y="pseudo-acceleration [g]")
    ps.caption(panels["d"], y="displacement [m]")
    for key in sizes:
        panels[key].set_ylim(bottom=0.0)
    title = worded(
        "{motions}: {measure}, {share:g} % damping",
        motions=joined(
            worded("{n} motions", n=len(motions)),
            worded("scaled by {code}", code=done.rule) if done else "",
            by=", ",
        ),
        measure=kind,
        share=100.0 * ratio,
    )
    ps.add_legend(figure, handles, columns=2, title=title)
    return figure


def _motions(panel: Axes, each: FloatArray, mean: FloatArray, periods: FloatArray) -> list[Artist]:
    """Draw all spectra and their mean, and return the entries of the legend."""
    thin: dict[str, Any] = {"color": "#999999", "linewidth": 0.6}
    thick: dict[str, Any] = {"color": ps.PALETTE[0], "linewidth": 2.0}
    panel.plot(periods, each, **thin)
    panel.plot(periods, mean, **thick)
    return [Line2D([], [], label="motions", **thin), Line2D([], [], label="mean", **thick)]
