"""Claim: the paper's numerical example comes out as the paper describes it.

    LIR_RECORDS=<folder of records> python -m validation.claims.newhall

Source: paper (COMPDYN 2023), section 3.1 and Figs 6 to 8: a mass of 204 t on one bearing under one
component of Newhall (Northridge 1994), here 360. Figures of 'rigid body' come from an independent
model of 18 degrees of freedom (contact pairs, explicit), whose spread is its own, over its steps.
"""

from __future__ import annotations

import math
import warnings
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from frames import GroundMotion, energy_error, lumped_mass, time_history
from frames.plots import bearing_sections
from lir_element import AnalysisWarning
from validation.body_motion import body_motion, rise
from validation.claims.newhall_figures import NAME, film, forces, motions
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import EXAMPLE_MASS, EXAMPLE_RECORD, LEVELS_HISTORY, example_bearing

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import xarray as xr

    from lir_element import LIRBearing
    from lir_element.device.features import AnyLevel

CLAIM = Claim(
    "newhall",
    "Numerical example: Newhall (paper, section 3.1, Figs 6 to 8)",
    "The numerical example comes out as the paper describes it: impact at 4.2 s, slip, no dramatic "
    "rise of the force",
    "paper 3.1, Figs 6-8",
    EXAMPLE_RECORD,
)

INERTIA = 0.02
"""Share of the moments that the inertia of sliders with a mass may take."""


def motion(folder: Path) -> GroundMotion:
    """Return the record, one component along x."""
    return GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)


def histories(
    record: GroundMotion, levels: Sequence[AnyLevel] = LEVELS_HISTORY
) -> dict[str, xr.Dataset]:
    """Run the example at some levels of fidelity."""
    model = lumped_mass(example_bearing(), EXAMPLE_MASS)
    return {level: time_history(model, record, level=level) for level in levels}


def impact(data: xr.Dataset) -> tuple[int, float]:
    """Return the step of the first rim contact, and its largest force over the one before it."""
    force = np.abs(data["bearing_force"].sel(axis="x", bearing=NAME).to_numpy())
    touches = data["rim_force"].sel(bearing=NAME).max("surface").to_numpy() > 0.0
    start = int(np.argmax(touches))
    end = start + int(np.argmin(touches[start:]))
    return start, float(force[start:end].max() / force[start - 1])


def unbalanced(data: xr.Dataset, bearing: LIRBearing) -> float:
    """Return the error of m_i + m_j + (x_j - x_i) x f_j = 0 about y, over the largest moment."""
    chosen = data.sel(bearing=NAME)
    lever = chosen["bearing_displacement"].to_numpy() + np.array([0.0, 0.0, bearing.height])
    couple = np.cross(lever, chosen["bearing_force"].to_numpy())[:, 1]
    ends = chosen["bearing_moment"].sel(axis="y").to_numpy()
    return float(np.abs(ends.sum(axis=1) + couple).max() / np.abs(ends).max())


def checks(data: xr.Dataset, level: str) -> list[Check]:
    """Check the statements about the example at one level."""
    bearing, weight = example_bearing(), float(data["weight"])
    time = data["time"].to_numpy()
    u = data["bearing_displacement"].sel(axis="x", bearing=NAME).to_numpy()
    slip = data["interface_slip"].sel(axis="x", bearing=NAME).to_numpy()
    force = data["bearing_force"].sel(axis="x", bearing=NAME).to_numpy()
    start, _ = impact(data)
    peak = int(np.argmax(np.abs(u)))
    bodies = body_motion(data, bearing, NAME)
    lift = bodies["position"].sel(body="top_plate", axis="z").to_numpy()
    turn = np.abs(bodies["rotation"].sel(body="top_slider", axis="y").to_numpy()).max()
    expected = float(rise(bearing, u[peak : peak + 1], slip[peak : peak + 1])[0])
    tilt = math.asin(bearing.lateral_capacity / bearing.effective_radius)
    of = f" ({level})"
    return stated(f"""
        impact: first rim contact{of} | paper, Fig. 6 | 4.2 s ± 1 % | {time[start]}
        the same{of} | rigid body 4.16-4.17 s | 4.165 s ± 0.36 % | {time[start]}
        peak displacement{of} | rigid body 288.7-292.6 mm | 289.5 mm ± 1.5 % | {1e3 * abs(u[peak])}
        time of the peak{of} | rigid body | 4.305 s ± 0.5 % | {time[peak]}
        slip before the impact{of} | paper, Fig. 6(a) | < 0.1 mm | {1e3 * np.abs(slip[:start]).max()}
        offset between the sliders at the end{of} | rigid body | 38 mm ± 5 % | {1e3 * abs(slip[-1])}
        rise of the top plate at the peak{of} | L − sqrt(L² + s² − U²) | {1e3 * expected} mm ± 2 % | {1e3 * (lift[peak] - lift[0])}
        largest rotation of the sliders{of} | asin(U_cap / L) | {1e3 * tilt} mrad ± 1 % | {1e3 * turn}
        largest force / static limit W tan(θ + atan μ_h){of} | paper, Fig. 8(a): no dramatic rise | < 1.08 | {np.abs(force).max() / bearing.force_limit(weight)}
        moments on the ends, out of balance{of} | statics, P-Delta included | < {1e-6 if level == "pendulum" else INERTIA} | {unbalanced(data, bearing)}
        energy balance{of} | balance | < 0.001 | {energy_error(data)}
        """)


def comparison(lir: xr.Dataset, record: GroundMotion) -> tuple[list[Check], float, xr.Dataset]:
    """Return the rise of the force at the impact, here and of the plain DCFP with the same rims."""
    bearing = example_bearing()
    with warnings.catch_warnings(
        action="ignore", category=AnalysisWarning
    ):  # the rims are overrun in a later impact
        model = lumped_mass(bearing.as_dcfp(), EXAMPLE_MASS)
        plain = time_history(model, record)
    tilt = math.asin(bearing.lateral_capacity / bearing.effective_radius)
    before = math.tan(tilt + math.atan(bearing.effective_friction))
    expected = bearing.force_limit(1.0) / before
    rise_lir, rise_plain = impact(lir)[1], impact(plain)[1]
    of, words = "the same, plain DCFP with these rims", f"{rise_plain:.3g}"
    result = stated(f"""
        force in the first contact / force just before it | closed forms, static | {expected} ± 5 % | {rise_lir}
        """)
    result.append(Check(of, "comparison", "> 5", words, rise_plain > 5.0))
    return result, rise_plain, plain


def sensitivity(record: GroundMotion) -> dict[str, xr.Dataset]:
    """Run the example over the elastic sliding before slip, and over the step."""
    cases: list[tuple[str, dict[str, float], float]] = [
        (f"`yield_displacement` {1e3 * u_y:g} mm, step 2 ms", {"yield_displacement": u_y}, 0.002)
        for u_y in (0.05e-3, 0.1e-3, 0.25e-3, 0.5e-3, 1e-3)
    ]
    cases += [
        (f"`yield_displacement` 0.25 mm, step {1e3 * dt:g} ms", {}, dt)
        for dt in (0.02, 0.01, 0.005, 1e-3, 1e-4)
    ]
    return {
        name: time_history(lumped_mass(example_bearing(**changes), EXAMPLE_MASS), record, dt=dt)
        for name, changes, dt in cases
    }


def peak(data: xr.Dataset) -> float:
    """Return the largest displacement [mm]."""
    return 1e3 * float(np.abs(data["bearing_displacement"].sel(axis="x")).max())


def offset(data: xr.Dataset) -> float:
    """Return the offset between the sliders at the end [mm]."""
    return 1e3 * abs(float(data["interface_slip"].sel(axis="x")[-1, 0]))


def page(folder: Path | None) -> Page:
    """Run the example and return its page."""
    if folder is None:
        message = f"{CLAIM.name} needs the record {CLAIM.record}"
        raise ValueError(message)
    record, bearing = motion(folder), example_bearing()
    found = histories(record)
    results = [check for level, data in found.items() for check in checks(data, level)]
    data = next(iter(found.values()))
    more, rise_plain, plain = comparison(data, record)
    start, rises = impact(data)
    contact = float(data["time"][start])
    moment = abs(data["bearing_moment"].sel(axis="y", bearing=NAME)).max("time")
    return Page(
        CLAIM,
        f"impact at {contact:.3f} s, peak {peak(data):.0f} mm, offset {offset(data):.0f} mm; in the impact the "
        f"force rises by {rises:.2f} (plain DCFP: {rise_plain:.1f})",
        results + more,
        render(
            globals(),
            energy_error=energy_error,
            moment=1e-3 * moment.to_numpy(),
            plain=plain,
            rise=rise_plain,
            runs=sensitivity(record),
        ),
        {
            "motions": motions(found, bearing, contact),
            "sections": bearing_sections(data, bearing, NAME),
            "forces": forces(found, bearing.force_limit(1.0), contact),
        },
        {"impact.gif": partial(film, data, bearing)},
    )


if __name__ == "__main__":
    run(CLAIM, page)
