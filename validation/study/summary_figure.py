"""The LIR-DCFP over the DCFP with rims of 1 W under all conditions of the study: one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.plots import plot_style as ps

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    Parts = Mapping[str, Mapping[str, Any]]
    Rows = list[tuple[str, dict[str, Sequence[float]]]]

PLAIN = "rims of 1 W"
LIMIT = 1.6
"""Where the figure ends; intervals that go on have an arrow."""

LIMITS = ("storey drift 2 %", "ductility 4", "floor acceleration 1 g", "collapse")


def comparisons(parts: Parts) -> Rows:
    """Return conditions, and of each the ratios of medians by limit state: value, low, high."""
    rows: Rows = []
    for plan in parts["device"]["plans"]:
        ratios = plan["pairs"][PLAIN]["ratios"]
        rows.append((f"plan {1e3 * plan['plan']:.0f} mm", _known(ratios)))
    for name, each in parts["buildings"]["buildings"].items():
        ratios = {limit: each["limits"][limit]["ratios"].get(f"DCFP, {PLAIN}") for limit in LIMITS}
        rows.append((name, _known(ratios)))
    for angle in ("30", "60"):
        limits = parts["motions"]["angles"]["limits"]
        ratios = {limit: limits[limit][angle]["ratio"] for limit in LIMITS}
        rows.append((f"records turned by {angle} degrees", _known(ratios)))
    after = parts["after"]["ratios"]
    rows.append(("a stop after failure", _known({k: after[k][1] for k in LIMITS if k in after})))
    shape = parts["loss"]["shape"]["ratios"][f"DCFP, {PLAIN}"]
    rows.append(("spectral shape of a code", {"collapse": shape}))
    return rows


def _known(ratios: Mapping[str, Sequence[float] | None]) -> dict[str, Sequence[float]]:
    return {limit: ratio[:3] for limit, ratio in ratios.items() if ratio}


def figure_of(parts: Parts) -> Figure:
    """Return ratios with their intervals, a panel a limit state, a row a condition."""
    rows = comparisons(parts)
    figure = ps.new_figure(0.6 + 0.26 * len(rows))
    (panels,) = ps.grid_of(figure, 1, len(LIMITS), share_x=True, share_y=True)
    for panel, limit in zip(panels, LIMITS, strict=True):
        panel.axvline(1.0, color=ps.GREY, linewidth=0.8)
        for k, (_, ratios) in enumerate(rows):
            if limit not in ratios:
                continue
            value, low, high = ratios[limit]
            sure = low > 1.0 or high < 1.0
            shown = min(high, LIMIT)
            panel.plot([low, shown], [k, k], color="black", linewidth=1.0)
            if high > LIMIT:
                panel.plot([LIMIT], [k], ">", color="black", markersize=4)
            fill = "black" if sure else "white"
            panel.plot([value], [k], "o", color="black", markerfacecolor=fill, markersize=4)
        panel.set_xlim(0.75, LIMIT + 0.05)
        ps.caption(panel, title=limit.replace("acceleration", "\nacceleration"), x="LIR over DCFP")
    panels[0].set_yticks(range(len(rows)), [name for name, _ in rows])
    panels[0].set_ylim(len(rows) - 0.5, -0.5)
    return figure
