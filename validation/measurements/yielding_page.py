"""The page and the figure of isolated buildings that yield: what was run, what it shows."""

from __future__ import annotations

import math
from statistics import median
from typing import TYPE_CHECKING

from frames.plots import plot_style as ps
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import (
    BEHIND,
    LIR,
    LONGEST,
    MOAT,
    MOST,
    RESTITUTION,
    RIMS,
    SOFT,
    SYSTEMS,
    VARIANTS,
    WALL_STIFFNESS,
    WALLS,
    WIDE,
    YIELD_STRESS,
    structures,
)
from validation.measurements.yielding_tables import (
    LEAST,
    SAME,
    chosen,
    completed,
    elastic_table,
    ends,
    losses,
    medians,
    of_record,
    pairs,
    wins_table,
    worse,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from validation.measurements.yielding_tables import Row

FIGURE = "yielding_comparison-demand.png"
PACOIMA = "Pacoima Dam 1971"


def figure(found: Sequence[Row]) -> Figure:
    """Draw drift, hinge rotation and floor acceleration over the demand, medians of records."""
    drawn = ps.new_figure(4.9)
    grid = ps.grid_of(drawn, 2, 4, share_x=True)
    shown = (
        ("storey drift [%]", "drift", 1e2),
        ("hinge rotation [mrad]", "rotation", 1e3),
        ("floor acceleration [g]", "floor", 1.0 / STANDARD_GRAVITY),
    )
    demands = sorted({row["demand"] for row in found})
    for (*panels, last), structure in zip(grid, structures(), strict=True):
        _failed_share(last, found, structure, demands)
        for panel, (text, key, factor) in zip(panels, shown, strict=True):
            for k, system in enumerate(SYSTEMS):
                points = []
                for demand in demands:
                    rows = chosen(
                        found, structure=structure, demand=demand, system=system, elastic=False
                    )
                    done = completed(rows)
                    full = len(done) == len(rows)
                    values = [factor * float(row[key]) for row in done]
                    points.append(median(values) if full and values else math.nan)
                    panel.plot(
                        [demand] * len(values),
                        values,
                        ".",
                        markersize=2.5,
                        alpha=0.5,
                        color=ps.PALETTE[k],
                    )
                panel.plot(demands, points, marker="os^D"[k], markersize=3.5, **ps.line_of(k))
            ps.caption(panel, title=f"{structure} frame", y=text)
            panel.set_ylim(bottom=0.0)
    for panel in grid[1]:
        ps.caption(panel, x="demand / capacity [-]")
    handles = grid[0][0].get_lines()
    named = [line for line in handles if line.get_linestyle() not in ("None", "")]
    for line, system in zip(named, SYSTEMS, strict=True):
        line.set_label(system)
    ps.add_legend(drawn, named, columns=4, title="Medians over records where all runs complete")
    return drawn


def _failed_share(panel: Axes, found: Sequence[Row], structure: str, demands: list[float]) -> None:
    # What the lines of the other panels leave out: without it a device that fails looks ideal.
    for k, system in enumerate(SYSTEMS):
        shares = []
        for demand in demands:
            rows = chosen(found, structure=structure, demand=demand, system=system, elastic=False)
            shares.append(100.0 * (1.0 - len(completed(rows)) / len(rows)) if rows else math.nan)
        panel.plot(demands, shares, marker="os^D"[k], markersize=3.5, **ps.line_of(k))
    panel.set_ylim(0.0, 102.0)
    ps.caption(panel, y="runs with a failed bearing [%]")


def yield_rotations() -> str:
    """Return the rotations at which the members yield, M_p L / (6 E I), in words."""
    parts = []
    for structure in structures().values():
        numbers = [
            f"{kind}s {1e3 * value:.1f}" for kind, value in structure.yield_rotations().items()
        ]
        parts.append(f"{structure.name} frame: {' and '.join(numbers)} mrad")
    return "; ".join(parts)


def page(found: Sequence[Row], left_out: Sequence[str], elastic_at: float) -> str:
    """Return the page in Markdown; at a demand frames were elastic, too."""
    every = sorted({row["demand"] for row in found})
    met = [d for d in every if 1.0 < d < every[-1]]
    return (
        "\n\n".join(
            [
                "# Isolated buildings that yield: LIR-DCFP, rims, a larger diameter, a moat wall",
                introduction(found, left_out),
                f"![Storey drift, hinge rotation and floor acceleration over the demand, four systems, two frames](figures/{FIGURE})",
                "Dots are single records; a line ends before the demand at which a run of its system "
                "stopped: a bearing failed. The last column has the share of runs that did.",
                "## Medians over the records",
                *(
                    part
                    for name in structures()
                    for part in (f"### The {name} frame", medians(found, name, every, SYSTEMS))
                ),
                "## Which system performs better, and where",
                verdict(found, met, every[-1]),
                wins_table(found, met),
                f'Completed runs at demand to capacity ratios of {met[0]:g} to {met[-1]:g}; "same" is within '
                f"{100.0 * SAME:g} %, of rotations within {1e3 * LEAST['rotation']:g} mrad, of drifts "
                f"left within {1e2 * LEAST['residual']:g} %.",
                "Runs in which rims or a wall do better than the LIR-DCFP by drift, hinge rotation or "
                "residual drift (LIR-DCFP first):",
                losses(found, met),
                "## What yielding changes",
                yielding_changes(found, elastic_at),
                elastic_table(found, elastic_at),
                "## A soft wall, and walls behind the LIR-DCFP",
                variants(found),
                *(
                    part
                    for name in structures()
                    for part in (
                        f"### On the {name} frame",
                        medians(found, name, _of_variants(found), (LIR, BEHIND, MOAT, SOFT)),
                    )
                ),
                "## The demo's record",
                of_record(found, PACOIMA, [d for d in every if d > 1.0]),
            ]
        )
        + "\n"
    )


def introduction(found: Sequence[Row], left_out: Sequence[str]) -> str:
    """Return what was run."""
    records = list(dict.fromkeys(row["record"] for row in found))
    plastic = "; ".join(
        f"{each.name}: columns {1e-3 * YIELD_STRESS * each.moduli[0]:.0f}, beams "
        f"{1e-3 * YIELD_STRESS * each.moduli[1]:.0f} kN m"
        for each in structures().values()
    )
    without = f" Left out, for they would need more than {MOST:g} times themselves: " + (
        ", ".join(left_out) + "."
    )
    return "\n\n".join(
        [
            "Written by `LIR_RECORDS=<folder> python -m validation.measurements.yielding_comparison`. "
            "The demo's frame ([demo.md](../demo.md): three storeys, 2 × 2 bays, nine bearings) with "
            "plastic hinges at both ends of columns and beams, and a light frame of the same plan (box "
            "300 × 16, I 400). Plastic moments are plastic moduli times 345 MPa "
            f"({plastic}); columns interact with their axial force; hardening 2 and 3 %. Columns are "
            "stronger than beams; the girders above the bearings stay elastic. Rotations are plastic "
            f"ones; members yield at M L / 6 E I: {yield_rotations()}.",
            "Systems: the LIR-DCFP, rims at 250 mm, its interface free to slip by some 80 mm more; the "
            "plain DCFP with the same rims; the plain DCFP of a larger diameter, which "
            "meets none; and that "
            "one in a moat whose walls stand 250 mm away on all sides "
            f"({WALL_STIFFNESS / 1e6:g} kN/mm a side, restitution {RESTITUTION:g}: assumptions, as "
            "is the default stiffness of the rims, and impact forces go with their "
            "roots). A wall keeps x "
            "and y apart, a rim is round: under two components the corner of the moat is reached "
            "later.",
            "The demand of a record is the displacement of a single bearing without rims over the 250 "
            f"mm; records are scaled to it. {len(records)} records, the first {LONGEST:g} s: "
            f"{', '.join(records)}.{without if left_out else ''} Accelerations are largest ones of a "
            "level's mean, the slab above the bearings included, drifts those of a storey's mean. Two "
            "frames and some records are no fragility study.",
        ]
    )


def verdict(found: Sequence[Row], met: Sequence[float], highest: float) -> str:
    """Return in words, with numbers, where each system wins."""
    last, g = met[-1], 1.0 / STANDARD_GRAVITY
    runs = chosen(found, system=LIR, demand=last, elastic=False)

    def over(key: str, other: str, factor: float, form: str) -> str:
        both = pairs(found, other, [last])
        values = (factor * median(float(each[k][key]) for each in both) for k in (0, 1))
        return " against ".join(f"{value:{form}}" for value in values)

    def middle(system: str, key: str) -> float:
        rows = completed(chosen(found, system=system, demand=highest, elastic=False))
        return median(float(row[key]) for row in rows)

    def done(system: str) -> str:
        return f"{system} {ends(chosen(found, system=system, demand=highest, elastic=False))}"

    gaps = [
        1e3 * max(float(each[k]["displacement"]) for each in pairs(found, WIDE, [last]))
        for k in (0, 1)
    ]
    behind = sum(len(worse(found, other, met)) for other in (RIMS, MOAT))
    all_runs = sum(len(pairs(found, other, met)) for other in (RIMS, MOAT))
    return "\n".join(
        [
            "- **While the interface holds, the LIR-DCFP avoids the effects of impacts.** "
            f"At a demand to capacity ratio of {last:g}, "
            f"medians of the {len(completed(runs))} of {len(runs)} runs that it completes: floor "
            f"acceleration {over('floor', RIMS, g, '.2f')} g with rims and "
            f"{over('floor', MOAT, g, '.2f')} g in the moat; drift {over('drift', RIMS, 1e2, '.2f')} % "
            f"and {over('drift', MOAT, 1e2, '.2f')} %; hinge rotation "
            f"{over('rotation', RIMS, 1e3, '.1f')} mrad and {over('rotation', MOAT, 1e3, '.1f')} mrad.",
            "- **The larger-diameter DCFP is the best of all where there is room for it.** At the same "
            f"demand, LIR-DCFP first: base shear {over('shear', WIDE, 1.0, '.2f')} W, drift "
            f"{over('drift', WIDE, 1e2, '.2f')} %, floor acceleration {over('floor', WIDE, g, '.2f')} "
            f"g, displacement up to {gaps[0]:.0f} against {gaps[1]:.0f} mm. What the LIR-DCFP saves is "
            "plan of the bearing, hardly the gap around the building.",
            "- **When its interface has slipped off its overlap, the LIR-DCFP has "
            "failed, and the others "
            f"go on.** At a demand to capacity ratio of {last:g} these are {len(runs) - len(completed(runs))} of {len(runs)} "
            f"runs. Completed at {highest:g}: {'; '.join(done(system) for system in SYSTEMS)}. With "
            f"walls the hinges then turn by {1e3 * middle(MOAT, 'rotation'):.1f} mrad, "
            f"{1e2 * middle(MOAT, 'residual'):.2f} % of drift are left, and floors feel "
            f"{g * middle(MOAT, 'floor'):.1f} g: damaged, and standing. Walls behind the "
            "LIR-DCFP give it the same ([below](#a-soft-wall-and-walls-behind-the-lir-dcfp)).",
            f"- **In {behind} of {all_runs} comparisons with rims or walls these do better** by drift, "
            "hinge rotation or residual drift (second table below): where the impact is slight, as the "
            "corner of a moat is farther than the rims, and in the light frame where the limit of the "
            "LIR-DCFP lets hinges yield, too.",
            "- **It needs a wider gap than a building that is stopped**: displacement at a demand to capacity ratio of "
            f"{last:g} {over('displacement', RIMS, 1e3, '.0f')} mm with rims.",
        ]
    )


def _of_variants(found: Sequence[Row]) -> list[float]:
    # The demands at which the variants were run.
    return sorted({row["demand"] for row in found if row["system"] in VARIANTS})


def variants(found: Sequence[Row]) -> str:
    """Return what a softer wall and walls behind the LIR-DCFP change, in words."""
    demands = _of_variants(found)
    g = 1.0 / STANDARD_GRAVITY

    def middle(system: str, key: str) -> float:
        rows = completed(chosen(found, system=system, demand=demands[-1], elastic=False))
        return median(float(row[key]) for row in rows)

    stopped, held = (
        ", ".join(
            f"{ends(chosen(found, system=system, demand=d, elastic=False))} at {d:g}"
            for d in demands
        )
        for system in (LIR, BEHIND)
    )
    soft, hard = (
        f"{g * middle(system, 'floor'):.2f} g, {1e2 * middle(system, 'drift'):.2f} % of drift and "
        f"{1e3 * middle(system, 'displacement'):.0f} mm"
        for system in (SOFT, MOAT)
    )
    return (
        f"Runs that the LIR-DCFP alone completes: {stopped}; with walls "
        f"{1e3 * WALLS[BEHIND][0]:.0f} mm away behind it {held}. Where the walls stop it, the "
        f"frame feels them as with the plain DCFP: at a demand to capacity ratio of {demands[-1]:g} a median of "
        f"{1e2 * middle(BEHIND, 'drift'):.2f} % of drift and {g * middle(BEHIND, 'floor'):.2f} g. "
        f"With walls of a tenth of the stiffness the moat's {hard} become {soft} (medians, "
        "both frames): what an impact does depends on what is assumed of the wall, and a soft one "
        "comes near to the LIR-DCFP."
    )


def yielding_changes(found: Sequence[Row], demand: float) -> str:
    """Return what frames that yield change of the numbers of elastic ones."""
    elastic, yields = (
        chosen(found, record=PACOIMA, demand=demand, structure="demo", system=RIMS, elastic=how)[0]
        for how in (True, False)
    )
    g = 1.0 / STANDARD_GRAVITY
    both = [
        (a, b)
        for a in completed(chosen(found, demand=demand, elastic=False))
        for b in completed(
            chosen(
                found,
                demand=demand,
                elastic=True,
                system=a["system"],
                structure=a["structure"],
                record=a["record"],
            )
        )
        if a["hinges"] > 0
    ]
    spans = []
    for key, name in (
        ("shear", "base shear"),
        ("floor", "floor acceleration"),
        ("roof", "acceleration of the roof"),
        ("drift", "drift"),
    ):
        ratios = [float(a[key]) / float(b[key]) for a, b in both]
        if ratios:
            spans.append(f"{name} {min(ratios):.3f} to {max(ratios):.3f}")
    return (
        f"Under the demo's record at a demand to capacity ratio of {demand:g} the plain DCFP with rims has "
        f"{elastic['shear']:.2f} W and {g * elastic['floor']:.1f} g with an elastic frame, "
        f"{yields['shear']:.2f} W and {g * yields['floor']:.1f} g with hinges, of which "
        f"{yields['hinges']} yield. So 2 W and nearly 8 g are no artefact of an "
        "elastic frame: they "
        "are those of the slab above the bearings while it is stopped, which is over before the "
        f"frame answers. In the {len(both)} runs at this demand in which hinges yield, values over "
        f"those of the elastic frame are: {', '.join(spans)}. Yielding limits what reaches the "
        "storeys; neither the impact nor the displacement of the bearings changes. At higher "
        "demands hinges do yield in the demo's frame, too (last table)."
    )
