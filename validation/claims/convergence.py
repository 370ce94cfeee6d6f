"""Claim: the rigid-body level is a reference, for its result does not depend on its parameters.

    LIR_RECORDS=<folder of records> python -m validation.claims.convergence

Source: the paper's model of 18 degrees of freedom (section 3, Eqs (1) to (5)); its numerical
example (section 3.1) under Newhall, followed beyond the peak displacement. Refined: the step
(tolerance of the implicit method, and an explicit method of equal small steps), the stiffness of
the contacts, the number of contact points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import GroundMotion, energy_error, lumped_mass, time_history
from frames.plots.plot_style import PALETTE, caption, grid_of, new_figure
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import EXAMPLE_MASS, EXAMPLE_RECORD, example_bearing

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

CLAIM = Claim(
    "convergence",
    "Convergence of the rigid-body level",
    "The peak displacement of the rigid-body level is stable to 0.1 % under refinement of step, "
    "contact stiffness and number of contact points",
    "paper 3 (model), 3.1 (example)",
    EXAMPLE_RECORD,
)
DURATION = 7.0  # s, the peak lies at 4.3 s
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
STIFFNESSES = (0.1, 0.3, 1.0, 3.0, 10.0)
POINTS = (4, 6, 8, 12, 16, 32)
EXPLICIT = (2.0, 1.0)  # of half the stability limit


class Row(NamedTuple):
    """What one run gives: its name, the peak displacement [m], all else."""

    name: str
    peak: float
    data: xr.Dataset


def history(name: str, record: GroundMotion, changes: dict[str, Any], **options: Any) -> Row:
    """Run the example with changes of its bearing."""
    model = lumped_mass(example_bearing(**changes), EXAMPLE_MASS)
    data = time_history(model, record, level="rigid_body", **options)
    peak = float(np.abs(data["bearing_displacement"].sel(axis="x")).max())
    return Row(name, peak, data)


def rows_of_steps(record: GroundMotion) -> list[Row]:
    """Refine the step: tolerance, then explicit."""
    rows = [
        history(f"tolerance {t:.0e}", record, {}, duration=DURATION, tolerance=t)
        for t in TOLERANCES
    ]
    first = history("", record, {}, duration=0.01, integrator="explicit")  # tells the step
    for factor in EXPLICIT:
        dt = 0.99 * factor * float(first.data.attrs["dt"])
        options = {"duration": DURATION, "integrator": "explicit", "dt": dt}
        rows.append(history(f"explicit, {1e6 * dt:.2f} µs", record, {}, **options))
    return rows


def rows_of_stiffness(record: GroundMotion) -> list[Row]:
    """Vary the stiffness of the contacts along the slider's axis, rims kept."""
    options = example_bearing().resolved()
    rows = []
    for factor in STIFFNESSES:
        changes = {
            "axial_stiffness": factor * options["axial_stiffness"],
            "rim_stiffness": options["rim_stiffness"],
        }
        rows.append(history(f"stiffness × {factor:g}", record, changes, duration=DURATION))
    return rows


def rows_of_points(record: GroundMotion) -> list[Row]:
    """Vary the number of contact points an interface."""
    return [
        history(f"{count} points", record, {"contact_points": count}, duration=DURATION)
        for count in POINTS
    ]


def spread(rows: list[Row]) -> float:
    """Return the spread of the peaks in per cent."""
    peaks = [row.peak for row in rows]
    return 100.0 * (max(peaks) - min(peaks)) / min(peaks)


def draw(steps: list[Row], stiffness: list[Row], points: list[Row]) -> Figure:
    """Draw the peak displacement over what is refined."""
    drawn = new_figure(2.6)
    panels = grid_of(drawn, 1, 3)[0]
    implicit, exact = steps[: len(TOLERANCES)], steps[-1]
    for panel, values, rows, name in (
        (panels[0], TOLERANCES, implicit, "tolerance of a step [-]"),
        (panels[1], STIFFNESSES, stiffness, "contact stiffness / default [-]"),
        (panels[2], POINTS, points, "contact points an interface"),
    ):
        panel.axhspan(1e3 * exact.peak * 0.999, 1e3 * exact.peak * 1.001, color="0.93", zorder=0)
        panel.axhline(1e3 * exact.peak, color=PALETTE[1], linewidth=0.9)
        panel.semilogx(
            values, [1e3 * row.peak for row in rows], color=PALETTE[0], marker="o", markersize=4
        )
        panel.set_ylim(1e3 * exact.peak * 0.997, 1e3 * exact.peak * 1.003)
        caption(panel, x=name)
    caption(panels[0], y="peak displacement [mm]")
    panels[0].invert_xaxis()
    panels[2].set_xticks(POINTS, labels=[str(count) for count in POINTS])
    panels[2].minorticks_off()
    drawn.suptitle("Points: implicit; line: explicit; band: ± 0.1 % of it", fontsize=9)
    return drawn


def page(folder: Path | None) -> Page:
    """Make the page."""
    if folder is None:
        msg = "this claim needs its record"
        raise ValueError(msg)
    record = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    steps, stiffness = rows_of_steps(record), rows_of_stiffness(record)
    points = rows_of_points(record)
    implicit = [row for row in steps if row.name.startswith("tolerance")]
    explicit = [row for row in steps if not row.name.startswith("tolerance")]
    checks: list[Check] = stated(f"""
        peak, tolerance 1e-6 to 1e-10 | refinement | < 0.1 % | {spread(implicit)}
        peak, finest implicit against explicit | other method | < 0.02 % | {spread([implicit[-1], explicit[-1]])}
        peak, both explicit steps | refinement | < 0.02 % | {spread(explicit)}
        peak, contacts × 0.3 to × 10 | refinement | < 0.1 % | {spread(stiffness[1:])}
        peak, 4 to 32 points | refinement | < 0.1 % | {spread(points)}
        peak, 8 to 32 points | refinement | < 0.01 % | {spread(points[2:])}
        """)
    result = (
        f"peak {1e3 * implicit[-1].peak:.2f} mm; spread {spread(implicit):.2f} % over the step, "
        f"{spread(stiffness[1:]):.2f} % over the contact stiffness, {spread(points):.2f} % over "
        "the contact points"
    )
    body = render(
        globals(), energy_error=energy_error, points=points, steps=steps, stiffness=stiffness
    )
    return Page(CLAIM, result, checks, body, {"peaks": draw(steps, stiffness, points)})


if __name__ == "__main__":
    run(CLAIM, page)
