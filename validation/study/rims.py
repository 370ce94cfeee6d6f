"""LIR-DCFP and DCFP of equal plan whose rims have a strength: writes docs/validation/study_rims.md.

    python -m validation.study.rims --store rim-runs

The campaign can be stopped; the same command goes on with its store. Needs the extras "campaign",
"fema" and "fragility".
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from frames.plots import plot_style as ps
from validation.page import render, table
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
    return render(globals(), BREAKS=BREAKS, found=found)


def _introduction(found: Found) -> str:
    dishes = {wider: 1e3 * max(found["dishes"][kinds[0].name]) for wider, kinds in PLAINS.items()}
    reach = {
        wider: 1e3 * max(found["capacities"][kinds[0].name]) for wider, kinds in PLAINS.items()
    }
    return (
        f"Written by `python -m validation.study.rims` ({found['cost']['date']}, "
        f"{found['cost']['machine']}). In [study.md](study.md) the rims of the DCFP break at several "
        "times the load that the bearing carries, and its comparison of collapse rests on that. Here "
        "rims have a strength: they yield at 0.5, 1 or 2 times the design load W of their bearing and "
        f"break at a deformation of {1e3 * BREAKS:g} mm (hardening 0.005, "
        "[theory](../theory_friction.md)); beside them stand rims that stay elastic and never break. "
        "A broken rim is the failure of its bearing. Devices are compared at equal plan: the dish "
        "under the centre bearing, 2 (D R / L + a), has a diameter of "
        f"{dishes[False]:.0f} mm (smaller plan) or {dishes[True]:.0f} mm (larger plan). "
        f"A DCFP takes it all for displacement, {reach[False]:.0f} and {reach[True]:.0f} mm; a "
        "LIR-DCFP may have larger sliders instead, which let its interface slip further. Building, "
        f"intensities ({INTENSITY.label}) and limit states are those of the study, the records the "
        f"{found['records']} pairs of FEMA P695's {RECORDS} set, steps 10 ms. Collapse is a "
        "ductility of 9 of a hinge or the failure of a bearing."
    )


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


def _medians(found: Found) -> str:
    head = [
        "device",
        "D [mm]",
        *(f"{limit.name}, median [m/s2]" for limit in LIMITS),
        "collapse margin (90 %)",
        "runs with rims that yield [%]",
        "ends",
    ]
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
    return table(head, rows)


def _ratios(found: Found) -> str:
    # Collapse medians of the best LIR-DCFP over those of each DCFP, and of accelerations.
    rows = []
    for wider, plan in PLANS.items():
        best = _best(found, wider)
        for kind in PLAINS[wider]:
            ratios = [_ratio(found, limit.name, best, kind) for limit in LIMITS]
            cells = ["-" if ratio is None else f"{ratio:.2f}" for ratio in ratios]
            rims = "never break" if kind.strength is None else f"{kind.strength:g} W"
            rows.append([plan, rims, *cells])
    head = ["plan", "rims of the DCFP", *(limit.name for limit in LIMITS)]
    return (
        "Median of the best LIR-DCFP of a plan over that of a DCFP of the same plan: above 1 the "
        "LIR-DCFP is better.\n\n" + table(head, rows)
    )


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
