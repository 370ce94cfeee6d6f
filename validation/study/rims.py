"""LIR-DCFP and DCFP of equal plan whose rims have a strength: writes docs/validation/study_rims.md.

    python -m validation.study.rims --store rim-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from frames.plots import plot_style as ps
from validation.page import render
from validation.study.far_field import RECORDS, far_field
from validation.study.part import run_part, write_part
from validation.study.records_runs import COLLAPSE, INTENSITY
from validation.study.rims_runs import BREAKS, KINDS, LIMITS, Kind, campaign, found_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    Found = Mapping[str, Any]

NAME = "study_rims"
FIGURE = f"{NAME}-collapse.png"
PLAINS = {wider: [k for k in KINDS if k.plain and k.wider is wider] for wider in (False, True)}
OURS = {wider: [k for k in KINDS if not k.plain and k.wider is wider] for wider in (False, True)}
PLANS = {False: "smaller plan", True: "larger plan"}


def page(found: Found) -> str:
    """Return the page in Markdown."""
    return render(
        globals(), BREAKS=BREAKS, found=found, INTENSITY=INTENSITY, LIMITS=LIMITS, RECORDS=RECORDS
    )


def _introduction(found: Found) -> tuple[Any, ...]:
    dishes = {wider: 1e3 * max(found["dishes"][kinds[0].name]) for wider, kinds in PLAINS.items()}
    reach = {
        wider: 1e3 * max(found["capacities"][kinds[0].name]) for wider, kinds in PLAINS.items()
    }
    return dishes, reach


def _verdict(found: Found) -> str:
    lines = []
    for wider, plan in PLANS.items():
        best = _best(found, wider)
        own = found["margins"][best.name]
        words = []
        for kind in PLAINS[wider]:
            other = found["margins"].get(kind.name)
            rims = "rims that never break" if kind.strength is None else f"{kind.strength:g} W"
            if other is None:
                words.append(f"{rims}: no run collapses")
                continue
            words.append(f"{rims}: {other[0]:.2f} ({other[1]:.2f} to {other[2]:.2f})")
        lines.append(
            f"- **{plan.capitalize()}.** Collapse margin of the best LIR-DCFP tried ({best.name}) "
            f"{own[0]:.2f} ({own[1]:.2f} to {own[2]:.2f}); of the DCFP by its rims: "
            f"{'; '.join(words)}."
        )
    return "\n".join(lines) + "\n\n" + _conclusion(found)


def _conclusion(found: Found) -> str:
    # Where the best LIR-DCFP of a plan is ahead of a DCFP of the same plan, limit by limit.
    words = []
    for limit in LIMITS:
        ratios = [
            ratio
            for wider in PLANS
            for kind in PLAINS[wider]
            if (ratio := _ratio(found, limit.name, _best(found, wider), kind)) is not None
        ]
        ahead = sum(ratio > 1.0 for ratio in ratios)
        words.append(
            f"{limit.name} in {ahead} of {len(ratios)} comparisons (median over median "
            f"{min(ratios):.2f} to {max(ratios):.2f})"
        )
    return (
        f"The best LIR-DCFP of a plan is ahead in: {'; '.join(words)}. Its rims are met as early as "
        "those of a DCFP of its capacity, but its interface bounds the force on them, so that their "
        "strength hardly changes its margin; what ends it is the overlap of its sliders, and what "
        "ends the DCFP its rims or the frame."
    )


def _ratio(found: Found, limit: str, best: Kind, other: Kind) -> float | None:
    own, their = (found["limits"][limit][kind.name] for kind in (best, other))
    if "median" not in own or "median" not in their:
        return None
    return float(own["median"][0] / their["median"][0])


def _best(found: Found, wider: bool) -> Kind:
    known = [kind for kind in OURS[wider] if kind.name in found["margins"]]
    return max(known, key=lambda kind: found["margins"][kind.name][0])


def _medians(found: Found) -> Any:
    rows = []
    for kind in KINDS:
        curves = [found["limits"][limit.name][kind.name] for limit in LIMITS]
        margin = found["margins"].get(kind.name)
        ends = ", ".join(f"{n} `{end}`" for end, n in found["statuses"][kind.name].items())
        rows.append(
            [
                kind.name,
                f"{1e3 * max(found['capacities'][kind.name]):.0f}",
                *(f"{c['median'][0]:.2f}" if "median" in c else c["why"] for c in curves),
                "-" if margin is None else "{:.2f} ({:.2f} to {:.2f})".format(*margin),
                f"{100.0 * found['bent'][kind.name]:.0f}" if kind.strength is not None else "-",
                ends,
            ]
        )
    return rows


def _ratios(found: Found) -> tuple[Any, ...]:
    # Collapse medians of the best LIR-DCFP over those of each DCFP, and of accelerations.
    rows = []
    for wider, plan in PLANS.items():
        best = _best(found, wider)
        for kind in PLAINS[wider]:
            ratios = [_ratio(found, limit.name, best, kind) for limit in LIMITS]
            cells = ["-" if ratio is None else f"{ratio:.2f}" for ratio in ratios]
            rims = "never break" if kind.strength is None else f"{kind.strength:g} W"
            rows.append([plan, rims, *cells])
    return (rows, [limit.name for limit in LIMITS])


def figure_of(found: Found) -> Figure:
    """Return collapse over intensity, a panel a plan."""
    figure = ps.new_figure(3.4)
    (panels,) = ps.grid_of(figure, 1, 2, share_x=True, share_y=True)
    for panel, (wider, plan) in zip(panels, PLANS.items(), strict=True):
        shown = [*PLAINS[wider], _best(found, wider)]
        for k, kind in enumerate(shown):
            curve = found["limits"][COLLAPSE.name][kind.name]
            if "why" in curve:
                continue
            rims = "never break" if kind.strength is None else f"{kind.strength:g} W"
            label = f"DCFP, rims {rims}" if kind.plain else "LIR-DCFP, best"
            look = ps.line_of(k)
            panel.plot(curve["at"], curve["probability"], label=label, **look)
        panel.axvline(found["considered"], color=ps.GREY, linewidth=0.7, linestyle=":")
        panel.set_ylim(0.0, 1.02)
        ps.caption(panel, title=plan, x="Sa(3 s) [m/s2]")
    ps.add_legend(figure, panels[0].get_lines()[:-1], columns=3)
    ps.caption(panels[0], y="probability of collapse [-]")
    return figure


def write(found: Found) -> None:
    """Write the page, its figure and the numbers."""
    write_part(NAME, page(found), {FIGURE: figure_of(found)}, found)


def main(given: Sequence[str] | None = None) -> None:
    """Run the campaign, and write the page."""
    run_part("rims", given, partial(far_field, campaign, found_of), write)


if __name__ == "__main__":
    main()
