"""Figures of the hazard: spectra for several dampings, and sets of motions against a target."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from frames._errors import MotionError
from frames.hazard.motion_set import MotionSet
from frames.hazard.spectrum import Spectrum
from frames.plots import plot_style as ps
from lir_element.door import require_positive, require_type
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
    """
    if isinstance(spectra, Spectrum):
        named = {spectra.name: spectra}
    else:
        named = (
            dict(spectra)
            if isinstance(spectra, Mapping)
            else {spectrum.name: spectrum for spectrum in spectra}
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
    handles: list[Artist] = []
    for k, (name, spectrum) in enumerate(named.items()):
        corners = [c for c in spectrum.corner_periods.values() if c < end]
        start, last = (
            (spectrum.points[0][0], spectrum.points[-1][0])
            if (spectrum.shape == "given")
            else (0.0, end)
        )
        periods = np.union1d(np.linspace(start, min(end, last), 400), corners)
        for j, damping in enumerate(dampings):
            look: dict[str, Any] = {
                "color": ps.PALETTE[j if one else k],
                "linestyle": ps.LINES[0 if one else j],
            }
            label = f"{name}, {100.0 * damping:g} %" if not one else f"{100.0 * damping:g} %"
            left.plot(periods, spectrum.acceleration(periods, damping) / STANDARD_GRAVITY, **look)
            right.plot(periods, spectrum.displacement(periods, damping), **look)
            handles.append(Line2D([], [], label=label, **look))
    for panel, text in ((left, "pseudo-acceleration [g]"), (right, "displacement [m]")):
        panel.set_xlim(0.0, end)
        panel.set_ylim(bottom=0.0)
        ps.caption(panel, x="period [s]", y=text)
    title = f"{next(iter(named))}, damping" if one else "Design spectra, damping"
    ps.add_legend(figure, handles, columns=4 if one else 2, title=title)
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
        Pseudo-accelerations, and the mean over the target where there is one.

    Raises
    ------
    MotionError
        If an argument is out of its bounds, or a component is missing.
    """
    require_type("motions", motions, MotionSet, "a MotionSet")
    done = motions.scaling
    goal = target if target is not None or done is None else done.target
    kind = measure or (done.measure if done else "RotD100")
    ratio = damping if damping is not None else done.damping if done else 0.05
    end = require_positive("longest", longest, "s", error=MotionError)
    periods = np.geomspace(SHORTEST, max(end, 2.0 * SHORTEST), POINTS)
    table = motions.spectra(periods, ratio, kind)
    mean = table.to_numpy().mean(axis=1)
    figure = ps.new_figure(3.3 if goal is None else 4.9)
    if goal is None:
        upper = ps.grid_of(figure, 1, 1)[0][0]
        panels = [upper]
    else:
        shapes = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (2.3, 1.0)})
        panels = list(shapes)
        upper = panels[0]
        for panel in panels:
            ps.style(panel)
    handles: list[Artist] = _motions(upper, table.to_numpy(), mean, periods)
    part = done.part if done else 1.0
    if goal is not None:
        level = np.asarray(goal.acceleration(periods, ratio), dtype=np.float64)
        handles.append(_target(upper, periods, level, goal.name))
        panels[1].plot(periods, mean / level, color=ps.PALETTE[0], linewidth=1.7)
        panels[1].axhline(part, color=ps.PALETTE[1], linewidth=1.1, linestyle="--")
        panels[1].set_ylim(0.0, max(1.6, 1.1 * float((mean / level)[periods > 0.5].max())))
        ps.caption(panels[1], y="mean / target [-]")
    if done is not None:
        for panel in panels:
            panel.axvspan(*done.periods, color=ps.PALETTE[4], alpha=0.15, linewidth=0.0)
        low, high = done.periods
        handles.append(
            Patch(color=ps.PALETTE[4], alpha=0.25, label=f"range {low:.3g} s to {high:.3g} s")
        )
    upper.set_xlim(0.0, end)
    upper.set_ylim(bottom=0.0)
    ps.caption(upper, y=f"{kind}, {100.0 * ratio:g} % damping [g]")
    ps.caption(panels[-1], x="period [s]")
    rule = f", scaled by {done.rule}" if done else ""
    ps.add_legend(figure, handles, columns=2, title=f"{len(motions)} motions{rule}")
    return figure


def _motions(panel: Axes, each: FloatArray, mean: FloatArray, periods: FloatArray) -> list[Artist]:
    """Draw all spectra and their mean, and return the entries of the legend."""
    thin: dict[str, Any] = {"color": "#999999", "linewidth": 0.6}
    thick: dict[str, Any] = {"color": ps.PALETTE[0], "linewidth": 2.0}
    panel.plot(periods, each / STANDARD_GRAVITY, **thin)
    panel.plot(periods, mean / STANDARD_GRAVITY, **thick)
    return [Line2D([], [], label="motions", **thin), Line2D([], [], label="mean", **thick)]


def _target(panel: Axes, periods: FloatArray, level: FloatArray, name: str) -> Line2D:
    """Draw the target, and return the entry of the legend."""
    look: dict[str, Any] = {"color": ps.PALETTE[1], "linewidth": 1.6, "linestyle": "--"}
    panel.plot(periods, level / STANDARD_GRAVITY, **look)
    return Line2D([], [], label=f"target: {name}", **look)
