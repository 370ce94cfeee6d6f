"""Figures of fragility: curves with their bands and data, risk by intensity, tornado charts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator

from frames.plots import plot_style as ps
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import CollapseFragility, Fragility, checked_confidence
from frames.risk.fragility.intensity import Measured, require_one_measure
from frames.risk.fragility.risk import Risk
from frames.risk.fragility.sensitivity import Tornado
from lir_element.argument_checks import require_type
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from frames._types import FloatArray

CURVE_POINTS = 200

Curve: TypeAlias = Fragility | CollapseFragility
"""A curve of either kind."""


def shown_intensity(unit: str, label: str = "intensity") -> tuple[float, str]:
    """Return the factor that intensities are drawn with, accelerations in g, and their label."""
    if unit == "m/s2":
        return 1.0 / STANDARD_GRAVITY, f"{label} [g]"
    return 1.0, f"{label} [{unit}]"


def fragility_curves(
    curves: Curve | Sequence[Curve] | Mapping[str, Curve],
    *,
    confidence: float = 0.9,
    label: str | None = None,
) -> Figure:
    """Draw fragility curves with their confidence bands and the fitted data.

    Parameters
    ----------
    curves : Fragility or CollapseFragility, or a sequence or mapping of up to six
        The curves, of one intensity measure; by the names of a mapping, else by their own.
    confidence : float
        Confidence of the bands [-]; bands of a curve that was given are not drawn.
    label : str, optional
        Label of the intensity; its measure's `Intensity.label` if None.

    Returns
    -------
    Figure
        Probabilities over the intensity: of stripes their shares, of an IDA its capacities.

    Raises
    ------
    FragilityError
        If there is none or too many, or their measures or units differ.

    Examples
    --------
    In the gallery: "Fragility of two devices" (docs/gallery/research/b_fragility.py).
    """
    named = _named("curves", curves, (Fragility, CollapseFragility), "a fragility curve")
    many = [curve for _, curve in named]
    checked_confidence(confidence)
    figure = ps.new_figure(3.9)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    size, text = shown_intensity(many[0].unit, label or _label_of(many))
    end = max(float(curve.grid(1)[-1]) for curve in many)
    im = np.linspace(0.0, end, CURVE_POINTS + 1)[1:]
    handles: list[Artist] = []
    for k, (name, curve) in enumerate(named):
        look = ps.line_of(k, 0.3)
        draw_curve(panel, curve, im, size, look, confidence)
        _data(panel, curve, size, look["color"])
        handles.append(Line2D([], [], label=name, **look))
    if any(curve.records for curve in many):
        band = f"{100.0 * confidence:g} % band, records resampled"
        handles.append(Patch(color=ps.GREY, alpha=0.2, label=band))
    panel.set_xlim(0.0, size * end)
    panel.set_ylim(0.0, 1.02)
    ps.caption(panel, x=text, y="probability of exceedance [-]")
    ps.add_legend(figure, handles, columns=2, title="Fragility")
    return figure


def draw_curve(
    panel: Axes, curve: Curve, im: FloatArray, size: float, look: dict[str, Any], confidence: float
) -> None:
    """Draw a curve over intensities times a factor, with its band if it has records."""
    if curve.records:
        band = curve.band(im, confidence)
        panel.fill_between(size * im, *band, color=look["color"], alpha=0.15, linewidth=0.0)
    panel.plot(size * im, curve.probability(im), **look)


def _named(what: str, given: Any, kinds: tuple[type, ...], one: str) -> list[tuple[str, Any]]:
    # Curves to draw, by name.
    if isinstance(given, kinds):
        given = [given]
    pairs = (
        list(given.items())
        if isinstance(given, Mapping)
        else [(getattr(each, "name", ""), each) for each in given]
    )
    for name, each in pairs:
        require_type(f"{what}[{name!r}]", each, kinds, one)
    if not 1 <= len(pairs) <= len(ps.PALETTE):
        msg = f"{len(pairs)} {what}: give 1 to {len(ps.PALETTE)} of one intensity measure"
        raise FragilityError(msg)
    for name, each in pairs[1:]:
        require_one_measure(pairs[0][1], each, (f"{pairs[0][0]!r}", f"{name!r}"))
    return [(name or f"limit state {k}", each) for k, (name, each) in enumerate(pairs, 1)]


def _label_of(many: Sequence[Measured]) -> str:
    stated = [each.intensity.label for each in many if each.intensity is not None]
    return stated[0] if stated else "intensity"


def _data(panel: Axes, curve: Fragility | CollapseFragility, size: float, color: str) -> None:
    # Shares of stripes, capacities in their order; a cloud has its runs at 0 and 1.
    data = curve.data
    mark: dict[str, Any] = {"color": color, "linestyle": "none", "markersize": 3.5}
    if "total" in data:
        share = data["exceeded"] / data["total"]
        panel.plot(size * data["im"], share, marker="o", clip_on=False, **mark)
    elif "capacity" in data:
        at = np.sort(data["capacity"][~data["censored"]].to_numpy())
        share = (np.arange(len(at)) + 0.5) / len(data)
        panel.plot(size * at, share, marker="o", clip_on=False, **mark)
    elif isinstance(curve, CollapseFragility):
        over = (data["demand"] > curve.limit).to_numpy(dtype=np.float64)
        panel.plot(size * data["im"], over, marker="|", clip_on=False, **mark)


def risk_deaggregation(
    risks: Risk | Sequence[Risk] | Mapping[str, Risk], *, label: str | None = None
) -> Figure:
    """Draw the contribution of intensities to the mean annual frequency of exceedance.

    Parameters
    ----------
    risks : Risk, or a sequence or mapping of up to six
        Results of `mean_annual_frequency`, of one intensity measure.
    label : str, optional
        Label of the intensity.

    Returns
    -------
    Figure
        Contributions by the logarithm of the intensity: the area below a line is its rate.

    Raises
    ------
    FragilityError
        If there is none or too many, or their measures or units differ.

    Examples
    --------
    In the gallery: "Which intensities make the risk" (docs/gallery/research/c_risk.py).
    """
    named = _named("risks", risks, (Risk,), "a Risk")
    many = [one for _, one in named]
    figure = ps.new_figure(3.6)
    panel = ps.grid_of(figure, 1, 1)[0][0]
    size, text = shown_intensity(many[0].unit, label or _label_of(many))
    handles: list[Artist] = []
    for k, (name, one) in enumerate(named):
        look = ps.line_of(k, 0.3)
        panel.fill_between(
            size * one.im, one.contribution, color=look["color"], alpha=0.12, linewidth=0.0
        )
        panel.plot(size * one.im, one.contribution, **look)
        text_of = f"{name}: {one.rate:.2e} a year"
        handles.append(Line2D([], [], label=text_of, **look))
    panel.set_xscale("log")
    for axis in (panel.xaxis.set_major_formatter, panel.xaxis.set_minor_formatter):
        axis("{x:g}")
    panel.xaxis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    panel.tick_params(which="minor", labelsize=ps.SMALL)
    panel.set_xlim(
        size * min(_middle(one)[0] for one in many), size * max(_middle(one)[1] for one in many)
    )
    panel.set_ylim(bottom=0.0)
    ps.caption(panel, x=text, y="contribution to the rate\nby ln of the intensity [1/year]")
    ps.add_legend(figure, handles, columns=2, title="Mean annual frequency of exceedance")
    return figure


def _middle(one: Risk) -> tuple[float, float]:
    # Range of all contributions but a thousandth.
    share = one.to_dataframe()["share"].to_numpy()
    inside: FloatArray = one.im[(share > 5e-4) & (share < 1.0 - 5e-4)]
    ends = inside if len(inside) else one.im
    return float(ends[0]), float(ends[-1])


def tornado_chart(found: Tornado, *, label: str = "result", unit: str = "") -> Figure:
    """Draw the results of a tornado: a bar a parameter, the widest on top.

    Parameters
    ----------
    found : Tornado
        Result of `tornado`.
    label, unit : str
        Label of the result, and its unit.

    Returns
    -------
    Figure
        Bars from the result at the lower to that at the upper value, about the base.

    Examples
    --------
    In the gallery: "Which property matters" (docs/gallery/research/d_tornado.py).
    """
    require_type("found", found, Tornado, "a Tornado")
    table = found.table.iloc[::-1]
    figure = ps.new_figure(1.1 + 0.34 * len(table))
    panel = ps.grid_of(figure, 1, 1)[0][0]
    places = np.arange(len(table))
    ends = {"low": ("at low", ps.PALETTE[0]), "high": ("at high", ps.PALETTE[1])}
    handles: list[Artist] = []
    for name, (column, color) in ends.items():
        panel.barh(places, table[column] - found.base, left=found.base, height=0.6, color=color)
        handles.append(Patch(color=color, label=f"parameter at its {name} value"))
        for k, (result, value) in enumerate(zip(table[column], table[name], strict=True)):
            side = 1.0 if result >= found.base else -1.0
            panel.annotate(
                f"{value:.4g}",
                (result, k),
                xytext=(4.0 * side, 0.0),
                textcoords="offset points",
                ha="left" if side > 0.0 else "right",
                va="center",
                fontsize=ps.SMALL,
            )
    panel.axvline(found.base, color=ps.GREY, linewidth=1.0)
    panel.set_yticks(places, list(table.index))
    panel.margins(x=0.14)
    panel.grid(visible=False, axis="y")
    ps.caption(panel, x=ps.text_of(label, unit))
    ps.add_legend(figure, handles, columns=2)
    return figure
