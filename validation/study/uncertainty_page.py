"""The page of the study of uncertainty, from its numbers alone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frames.plots import plot_style as ps
from frames.risk.fragility.sobol import WIDEST
from validation.page import render
from validation.study.rounded import with_interval
from validation.study.uncertainty_runs import (
    BEST,
    BREAKING,
    LEVEL,
    LEVELS,
    MEANINGS,
    PAIR,
    RECORD,
    SAMPLES,
    SHARES,
    SPREADS,
    STRENGTH,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

INDICES, MARGINS = "study_uncertainty-indices.png", "study_uncertainty-margins.png"
RANGES = {
    "friction": "uniform, 0.7 to 1.3",
    "interface": "uniform, 0.7 to 1.3",
    "stiffness": "log-uniform, 0.1 to 1",
    "strength": "log-uniform, 0.5 to 2",
    "breaks": "uniform, 0.01 to 0.04",
    "damping": "uniform, 0.01 to 0.05",
    "axial": "log-uniform, 0.3 to 3",
    "yield": "log-uniform, 0.00005 to 0.002",
    RECORD: "each of the set as likely",
}
WHAT = {**{name: name for name in PAIR}, "ratio": "LIR-DCFP over DCFP"}
KINDS = {
    BEST: BEST,
    "LIR-DCFP": "LIR-DCFP, sliders by load",
    "DCFP, never": "DCFP, rims that never break",
    f"DCFP, {STRENGTH:g} W": f"DCFP, rims that yield at {STRENGTH:g} W and break 20 mm later",
    "DCFP, elastic": "DCFP, rims that stay elastic and break at 20 mm",
}
"""Devices whose rims have one stiffness after another."""


def shares_of_kind(kind: str) -> tuple[float, ...]:
    """Return the stiffness of the rims over the default that a device was run with."""
    return BREAKING if kind == "DCFP, elastic" else SHARES


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(),
        found=found,
        BEST=BEST,
        LEVEL=LEVEL,
        SAMPLES=SAMPLES,
        SPREADS=SPREADS,
        WIDEST=WIDEST,
        math=math,
    )


def _introduction(found: Found) -> Any:
    rows = [[key, MEANINGS[key], RANGES[key]] for key in SPREADS]
    return rows


def is_known(index: Sequence[float]) -> bool:
    """Return whether an index is a result: its interval is not too wide, and it is no more than 1."""
    return index[2] - index[1] <= WIDEST and index[0] <= 1.0


def known(index: Sequence[float]) -> str:
    """Return an index with its interval, if it is a result."""
    return with_interval(index) if is_known(index) else "not known"


def leading(found: Found, name: str) -> dict[str, Sequence[float]]:
    """Return the total indices of the properties that are known, the largest first."""
    rows = found["shares"][name]["total"].items()
    totals = {key: each for key, each in rows if key != RECORD and is_known(each)}
    return dict(sorted(totals.items(), key=lambda row: -row[1][0]))


def _verdict(found: Found) -> str:
    lines = []
    for name, text in WHAT.items():
        totals = leading(found, name)
        largest = "; ".join(f"{key} {with_interval(totals[key])}" for key in list(totals)[:2])
        open_ = ", ".join(key for key in SPREADS if key != RECORD and key not in totals)
        lines.append(
            f"- **{text}**: the share of the record is not known, nor the total index of: {open_ or '-'}. "
            f"The largest of those that are known: {largest}."
        )
    ratios = found["stiffness"]["ratios"]
    below = [name for name, r in ratios.items() if r[2] < 1.0]
    above = [name for name, r in ratios.items() if r[1] > 1.0]
    names = [f"{KINDS[n.split('|')[0]]} at {n.split('|')[1]} of the stiffness" for n in above]
    lines.append(
        f"- **Rims**: the collapse margin of {BEST}, is below that of the others in {len(below)} of "
        f"{len(ratios)} pairs of equal stiffness, above it in {len(above)}"
        + (f" ({'; '.join(names)})" if names else "")
        + f". {_cause(found)}"
    )
    return "\n".join(lines)


def _cause(found: Found) -> str:
    # By how much margins of each DCFP change from the stiffest rims it was run with to the softest.
    margins = found["stiffness"]["margins"]
    words_ = []
    for kind, text in KINDS.items():
        keys = [f"{kind}|{share:g}" for share in shares_of_kind(kind)]
        first, last = margins[keys[0]][0], margins[keys[-1]][0]
        words_.append(
            f"{text}: {first:.2f} at {keys[0].split('|')[1]}, {last:.2f} at {SHARES[-1]:g}"
        )
    return (
        f"Margins by stiffness over the default: {'; '.join(words_)}. Rims that yield, or never "
        "break, keep their strength when they are softer; rims that break at one deformation break "
        "at a force that falls with their stiffness."
    )


def _indices(found: Found) -> tuple[Any, ...]:
    rows = []
    for key in SPREADS:
        cells = []
        for name in WHAT:
            own = found["shares"][name]
            cells += [known(own["first"][key]), known(own["total"][key])]
        rows.append([key, *cells])
    told = "; ".join(
        f"{text}: mean {found['shares'][name]['mean']:.2f}, deviation "
        f"{found['shares'][name]['deviation']:.2f}, {found['shares'][name]['left out']} samples left "
        "out for a run whose analysis failed"
        for name, text in WHAT.items()
    )
    collapsed = ", ".join(f"{name} {100.0 * v:.0f} %" for name, v in found["collapsed"].items())
    return (
        collapsed,
        rows,
        told,
        [f"{text}, {kind}" for text in WHAT.values() for kind in ("first", "total")],
    )


def _effects(found: Found) -> Any:
    rows = [
        [
            key,
            *(
                with_interval([100.0 * math.expm1(v) for v in found["effects"][n][key]], 0)
                for n in WHAT
            ),
        ]
        for key in SPREADS
        if key != RECORD
    ]
    return rows


def _margins(found: Found) -> tuple[Any, ...]:
    rows = []
    stiff = found["stiffness"]
    for kind, text in KINDS.items():
        for share in shares_of_kind(kind):
            key = f"{kind}|{share:g}"
            failed = ", ".join(f"{100.0 * v:.0f}" for v in stiff["failed"][key])
            down = ", ".join(f"{100.0 * v:.0f}" for v in stiff["collapse"][key])
            ratio = stiff["ratios"].get(key)
            rows.append(
                [
                    text,
                    f"{share:g}",
                    with_interval(stiff["margins"][key]),
                    "-" if ratio is None else with_interval(ratio),
                    failed,
                    down,
                ]
            )
    return (rows, ", ".join(f"{v:g}" for v in LEVELS))


def _cost(found: Found) -> tuple[Any, ...]:
    cost = found["cost"]
    digests = "; ".join(f"{name}: `{digest}`" for name, digest in cost["digests"].items())
    return cost, digests


def figures(found: Found) -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {INDICES: _bars(found), MARGINS: _lines(found)}


def _bars(found: Found) -> Figure:
    figure = ps.new_figure(3.4)
    (panels,) = ps.grid_of(figure, 1, 3, share_y=True)
    keys = [key for key in SPREADS if key != RECORD]
    places = np.arange(len(keys))[::-1]
    farthest = 1.1 * max(row[2] for n in WHAT for row in leading(found, n).values())
    for panel, (name, text) in zip(panels, WHAT.items(), strict=True):
        shown = leading(found, name)
        values = np.array([shown.get(key, [np.nan] * 3) for key in keys])
        ends = np.abs(values[:, 1:] - values[:, :1]).T
        panel.barh(places, values[:, 0], height=0.6, color="0.75", edgecolor="black", linewidth=0.6)
        panel.errorbar(
            values[:, 0], places, xerr=ends, fmt="none", ecolor="black", elinewidth=0.9, capsize=2.0
        )
        panel.set_xlim(0.0, farthest)
        ps.caption(panel, title=text, x="total index [-]")
    panels[0].set_yticks(places, keys)
    return figure


def _lines(found: Found) -> Figure:
    figure = ps.new_figure(3.8)
    (panels,) = ps.grid_of(figure, 1, 2, share_x=True)
    for k, (kind, text) in enumerate(KINDS.items()):
        at = np.array(shares_of_kind(kind))
        keys = [f"{kind}|{share:g}" for share in at]
        values = np.array([found["stiffness"]["margins"][key] for key in keys])
        failed = [100.0 * found["stiffness"]["failed"][key][1] for key in keys]
        look = ps.line_of(k)
        panels[0].fill_between(
            at, values[:, 1], values[:, 2], alpha=0.12, color=look["color"], linewidth=0.0
        )
        for panel, line in zip(panels, (values[:, 0], failed), strict=True):
            panel.plot(at, line, marker="osv^d"[k], markersize=4.0, label=text, **look)
    panels[0].axhline(1.0, color=ps.GREY, linewidth=0.7, linestyle=":")
    panels[1].set_ylim(-2.0, 102.0)
    for panel in panels:
        panel.set_xscale("log")
        panel.set_xticks(list(SHARES), [f"{share:g}" for share in SHARES])
        panel.minorticks_off()
        ps.caption(panel, x="stiffness of rims over the default [-]")
    ps.caption(panels[0], y="collapse margin [-]")
    ps.caption(panels[1], y=f"records that fail a bearing at {LEVELS[1]:g} m/s2 [%]")
    ps.add_legend(figure, panels[0].get_lines()[: len(KINDS)], columns=1)
    return figure
