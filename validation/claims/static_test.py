"""Claim: the element reproduces the paper's static cyclic test, statement by statement.

    python -m validation.claims.static_test

Source: paper (COMPDYN 2023), section 2.2 and Fig. 4: 150 kN of axial load, two cycles of 18.5 cm at
constant speed. Closed forms: docs/theory.md, section 2.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames.plots import plot_style as ps
from lir_element import cyclic_test
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import LEVELS_STATIC, REACH, static_bearing, static_path

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from lir_element.device.features import AnyLevel

CLAIM = Claim(
    "static_test",
    "Static cyclic test (paper, section 2.2, Fig. 4)",
    "The static cyclic test comes out as the paper states it",
    "paper 2.2, Fig. 4",
)
LOAD = 150e3  # N
FRICTION = 0.066
STEP = 1e-4  # m, between the points of the path
SLIPS = 1e-4  # m, slip that counts as sliding


def loops(levels: Sequence[AnyLevel] = LEVELS_STATIC) -> dict[str, xr.Dataset]:
    """Run the test at some levels of fidelity."""
    bearing, way = static_bearing(), static_path()
    return {level: cyclic_test(bearing, way, axial_load=LOAD, level=level) for level in levels}


DYNAMIC = 0.01
"""Of the largest forces, where the rig's plate has a mass: the axial force swings at the rims."""


def checks(data: xr.Dataset, level: str) -> list[Check]:
    """Check the statements about the test at one level."""
    bearing, way = static_bearing(), static_path()
    slip = data["interface_slip"].sel(axis="x")[:, 0].to_numpy()
    force = data["bearing_force"].sel(axis="x")[:, 0].to_numpy()
    turn = round(REACH / STEP)
    first = int(np.argmax(np.abs(slip) > SLIPS))
    left = slip[turn]
    back = slice(turn, 3 * turn)
    second = way[back][np.argmax(slip[back] < left - SLIPS)]
    limit = bearing.force_limit(LOAD)
    zero = np.interp(0.0, way[back][::-1], force[back][::-1])
    sliding = FRICTION * sum(bearing.radii) / bearing.effective_radius * LOAD
    work = data["work_high_friction"][:, 0].to_numpy()
    cycle = slice(turn, 5 * turn)  # from +185 mm to +185 mm
    tilt = math.asin(bearing.lateral_capacity / bearing.effective_radius)
    normal = LOAD * math.cos(tilt) + limit * math.sin(tilt)
    slides = 4.0 * (REACH - bearing.lateral_capacity)
    of = f" ({level})"
    within = DYNAMIC if level == "rigid_body" else 0.005
    return stated(f"""
        displacement at the first high-friction sliding{of} | paper 2.2 | 175 mm ± 0.5 % | {1e3 * way[first]}
        slip that it leaves{of} | paper 2.2 | 10 mm ± 0.5 % | {1e3 * left}
        displacement at the next one{of} | paper 2.2 | -165 mm ± 0.5 % | {1e3 * second}
        largest force / force that starts the first high-friction sliding{of} | paper 2.2 | < {1.0 + within} | {np.abs(force).max() / force[first]}
        largest force{of} | W tan(θ + atan μ_h) | {1e-3 * limit} kN ± {100.0 * within} % | {1e-3 * force.max()}
        smallest force{of} | the same | {-1e-3 * limit} kN ± {100.0 * within} % | {1e-3 * force.min()}
        characteristic strength Q{of} | μ (R1 + R2)/L W | {1e-3 * sliding} kN ± 0.5 % | {-1e-3 * zero}
        energy that the interface takes up in a cycle{of} | μ_h N 4 (18.5 − 17.5 cm) | {bearing.interface_friction * normal * slides} J ± 1 % | {work[cycle][-1] - work[cycle][0]}
        """)


def draw(found: dict[str, xr.Dataset]) -> Figure:
    """Draw the normalised loops, after the paper's Fig. 4, and the slip of the interface."""
    drawn = ps.new_figure(3.1)
    left, right = ps.grid_of(drawn, 1, 2)[0]
    way, limit = 1e3 * static_path(), static_bearing().force_limit(1.0)
    handles = []
    for k, (level, data) in enumerate(found.items()):
        look: dict[str, Any] = {
            "color": ps.PALETTE[k],
            "linestyle": ps.LINES[k],
            "linewidth": ps.WIDTHS[k],
        }
        reached = way[: data.sizes["step"]]
        left.plot(reached, data["bearing_force"].sel(axis="x")[:, 0] / LOAD, **look)
        right.plot(reached, 1e3 * data["interface_slip"].sel(axis="x")[:, 0], **look)
        handles.append(Line2D([], [], label=f"level {level}", **look))
    for sign in (-1.0, 1.0):
        left.axhline(sign * limit, color=ps.GREY, linewidth=0.8, linestyle=(0, (4, 3)))
    left.text(-190.0, limit + 0.008, "tan(θ + atan μ$_h$)", fontsize=ps.SMALL, color=ps.GREY)
    notes = (
        ("1st slide: +175 mm", (175.0, 0.2), (20.0, 0.225), left),
        ("2nd slide: −165 mm", (-165.0, -0.2), (-20.0, -0.225), left),
    )
    for text, point, place, panel in notes:
        panel.annotate(
            text,
            point,
            place,
            fontsize=ps.SMALL,
            va="center",
            ha="right" if point[0] > 0.0 else "left",
            arrowprops={"arrowstyle": "->", "linewidth": 0.6, "shrinkB": 2.0},
        )
    left.set_ylim(-0.31, 0.31)
    ps.caption(left, x="displacement [mm]", y="lateral force / axial load [-]", title="loops")
    ps.caption(right, x="displacement [mm]", y="interface slip [mm]", title="slip of the interface")
    ps.add_legend(drawn, handles, title="Static cyclic test, two cycles of 185 mm")
    return drawn


def page(_: Path | None = None) -> Page:
    """Run the test and return its page."""
    found = loops()
    results = [check for level, data in found.items() for check in checks(data, level)]
    first, left, second = (check.got for check in results[:3])
    result = f"slides first at {first}, leaves {left} of slip, slides again at {second}"
    return Page(CLAIM, result, results, render(globals()), {"loops": draw(found)})


if __name__ == "__main__":
    run(CLAIM, page)
