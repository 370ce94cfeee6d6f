"""Figure of a proposal's candidates: displacement over base shear and plate diameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from matplotlib.lines import Line2D

from frames.design._errors import CheckError
from frames.design.sizing.proposal import Design
from frames.design.sizing.selection import placed
from frames.plots import plot_style as ps

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.selection import Place
    from frames.design.sizing.target import DesignTarget

_MARKERS = ("o", "s", "^", "D", "v", "P")
_OTHERS = "something else"
_SIZE = 34.0  # of a marker [pt2]
_REACHED = "isolator displacement [m]"
_AIMS = {  # columns of the trials, their captions, and factors of these units
    "base shear / weight [-]": ("base shear / weight [%]", 100.0),
    "floor acceleration in plan [m/s2]": ("floor acceleration [m/s²]", 1.0),
    "cost": ("cost", 1.0),
}


def design_candidates(
    found: Design | Sequence[Candidate], *, target: DesignTarget | None = None
) -> Figure:
    """Draw the candidates of a proposal by their governing limit.

    Displacement over base shear to the left, over the diameter of the plates to the right. Colour
    and shape show the limit that is nearest or exceeded most. Candidates that meet the target are
    filled, others are open, and a cross marks sliders under low pressure. A ring marks
    Pareto-optimal candidates in the three quantities, with radius and friction, a second ring the
    proposed one.

    Parameters
    ----------
    found : Design, or sequence of Candidate
        The proposal, or its candidates.
    target : DesignTarget, optional
        Target whose limits of displacement, base shear and plan diameter are drawn.

    Returns
    -------
    Figure
        The candidates.

    Raises
    ------
    CheckError
        If there is none.

    Examples
    --------
    In the tutorial: "6. A design" (docs/tutorials/f_design_project.py).
    """
    chosen = found.chosen if isinstance(found, Design) else None
    candidates = found.candidates if isinstance(found, Design) else tuple(found)
    if not candidates:
        msg = "candidates is empty: give a Design, or the candidates of a NoCandidateError"
        raise CheckError(msg)
    places = placed(candidates, chosen)
    looks = _looks(candidates)
    figure = ps.new_figure(3.9)
    left, right = ps.grid_of(figure, 1, 2, share_y=True)[0]
    for panel, of in ((left, _base_shear), (right, lambda one: 1e3 * one.plan_diameter)):
        for place in places:
            _mark(panel, place, of(place.candidate), looks, named=panel is left)
    ps.caption(left, x="base shear / weight [%]", y="displacement to allow, without rims [mm]")
    ps.caption(right, x="plan diameter [mm]")
    if target is not None:
        _limits(left, right, target)
    ps.add_legend(figure, _handles(places, looks), columns=3, size=ps.SMALL)
    return figure


def tried_candidates(tried: pd.DataFrame) -> Figure:
    """Draw the results of candidates in time histories, aim by aim.

    Displacement over base shear, floor acceleration and, if prices are given, cost. Colour and
    shape show the check that is nearest to its limit, or farthest beyond; candidates that pass
    every check are filled.

    Parameters
    ----------
    tried : pandas.DataFrame
        A row for each, as `lir design` writes them to ``front.csv``.

    Returns
    -------
    Figure
        The candidates.

    Raises
    ------
    CheckError
        If there is none.

    Examples
    --------
    In the how-to: "Bearings proposed: `lir design`" (docs/sizing.md).
    """
    if not len(tried):
        msg = "rows is empty: give the rows of front.csv"
        raise CheckError(msg)
    over = {name: unit for name, unit in _AIMS.items() if name in tried}
    names = tried["limited by"].tolist()
    looks = _looks_of(names)
    figure = ps.new_figure(3.9)
    panels = ps.grid_of(figure, 1, len(over), share_y=True)[0]
    for panel, (name, (label, factor)) in zip(panels, over.items(), strict=True):
        for _, row in tried.iterrows():
            colour, marker = looks.get(row["limited by"], looks.get(_OTHERS, (ps.GREY, "X")))
            filled = colour if row["outcome"] == "passes" else "none"
            x, y = factor * row[name], 1e3 * row[_REACHED]
            look: dict[str, Any] = {"facecolors": filled, "edgecolors": colour, "zorder": 3}
            panel.scatter(x, y, s=_SIZE, marker=marker, **look)
            who = f"R {row['radius [m]']:g} m, μ {row['friction [-]']:g}"
            beside: dict[str, Any] = {"textcoords": "offset points", "fontsize": ps.SMALL}
            panel.annotate(who, (x, y), xytext=(5.0, 4.0), **beside)
        panel.margins(x=0.3, y=0.15)
        ps.caption(panel, x=label)
    ps.caption(panels[0], y="displacement of histories [mm]")
    point: dict[str, Any] = {"linestyle": "none", "markersize": 5.5}
    handles: list[Artist] = [
        Line2D([], [], marker=marker, color=colour, label=f"nearest: {name}", **point)
        for name, (colour, marker) in looks.items()
    ]
    if any(tried["outcome"] != "passes"):
        open_: dict[str, Any] = {"marker": "o", "markerfacecolor": "none", "color": ps.GREY}
        handles.append(Line2D([], [], label="open: a check fails", **open_, **point))
    ps.add_legend(figure, handles, columns=2, size=ps.SMALL)
    return figure


def _base_shear(one: Candidate) -> float:
    return 100.0 * one.base_shear


def _looks(candidates: Sequence[Candidate]) -> dict[str, tuple[str, str]]:
    # Colour and marker of each limit, those that limit most candidates first.
    return _looks_of([one.governing.what for one in candidates])


def _looks_of(names: list[str]) -> dict[str, tuple[str, str]]:
    order = sorted(dict.fromkeys(names), key=lambda name: -names.count(name))
    found = dict(zip(order, zip(ps.PALETTE, _MARKERS, strict=True), strict=False))
    return found | ({_OTHERS: (ps.GREY, "X")} if len(order) > len(found) else {})


def _mark(
    panel: Axes, place: Place, x: float, looks: dict[str, tuple[str, str]], *, named: bool
) -> None:
    one = place.candidate
    y = 1e3 * one.displacement
    colour, marker = looks.get(one.governing.what, looks.get(_OTHERS, (ps.GREY, "X")))
    filled = colour if not one.lacks else "none"
    panel.scatter(x, y, s=_SIZE, marker=marker, facecolors=filled, edgecolors=colour, zorder=3)
    if one.warnings:
        panel.scatter(x, y, s=0.5 * _SIZE, marker="x", color="black", linewidths=0.8, zorder=5)
    if place.outcome not in {"Pareto-optimal", "proposed"}:
        return
    ring: dict[str, Any] = {"marker": "o", "facecolors": "none", "edgecolors": "black"}
    panel.scatter(x, y, s=3.0 * _SIZE, linewidths=0.8, zorder=4, **ring)
    if place.outcome == "proposed":
        panel.scatter(x, y, s=6.0 * _SIZE, linewidths=1.4, zorder=4, **ring)
    if named:
        panel.annotate(
            f"R {one.radius:g} m, μ {one.friction.f_max:g}",
            (x, y),
            xytext=(9.0, 3.0),
            textcoords="offset points",
            fontsize=ps.SMALL,
        )


def _limits(left: Axes, right: Axes, target: DesignTarget) -> None:
    line: dict[str, Any] = {"color": ps.GREY, "linestyle": "--", "linewidth": 0.9, "zorder": 1}
    if target.max_displacement is not None:
        for panel in (left, right):
            panel.axhline(1e3 * target.max_displacement, **line)
    if target.max_base_shear is not None:
        left.axvline(100.0 * target.max_base_shear, **line)
    if target.max_plan_diameter is not None:
        right.axvline(1e3 * target.max_plan_diameter, **line)


def _handles(places: Sequence[Place], looks: dict[str, tuple[str, str]]) -> list[Artist]:
    point: dict[str, Any] = {"linestyle": "none", "markersize": 5.5}
    found: list[Artist] = [
        Line2D([], [], marker=marker, color=colour, label=f"limited by: {name}", **point)
        for name, (colour, marker) in looks.items()
    ]
    open_: dict[str, Any] = {"marker": "o", "markerfacecolor": "none", "color": ps.GREY, **point}
    if any(place.candidate.lacks for place in places):
        found.append(Line2D([], [], label="open: rejected", **open_))
    if any(place.candidate.warnings for place in places):
        cross = open_ | {"marker": "x", "color": "black", "markersize": 4.0}
        found.append(Line2D([], [], label="cross: liners under low pressure", **cross))
    if any(not place.candidate.lacks for place in places):
        ring = open_ | {"color": "black", "markersize": 9.0}
        found.append(Line2D([], [], label="ring: Pareto-optimal", **ring))
    if any(place.outcome == "proposed" for place in places):
        ring = open_ | {"color": "black", "markersize": 11.0, "markeredgewidth": 1.4}
        found.append(Line2D([], [], label="two rings: proposed", **ring))
    return found
