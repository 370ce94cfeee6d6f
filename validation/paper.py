"""The paper's statements about the bearing, checked: writes docs/validation.md and its figures.

    LIR_RECORDS=<folder of records> python -m validation.paper

Sources: COMPDYN 2023 paper, section 2.2 (static cyclic test, Fig. 4) and section 3.1 (numerical
example, Figs 6 to 8; Newhall, Northridge 1994, 360). The figures of 'rigid body' come from an
independent model of 18 degrees of freedom.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from frames import GroundMotion, energy_error, lumped_mass, time_history
from lir_element import cyclic_test
from validation.cases import example_bearing, static_bearing

if TYPE_CHECKING:
    import xarray as xr

    from lir_element import LIRBearing

DOCS = Path(__file__).parent.parent / "docs"
LOAD = 150e3
REACH = 0.185
MASS = 204e3


@dataclass(frozen=True)
class Claim:
    """One statement: what, from where, the expected value and what came out."""

    what: str
    source: str
    expected: str
    got: str
    holds: bool


def static_path() -> np.ndarray:
    """Return two cycles of 0.185 m, points 0.1 mm apart."""
    turns = [0.0, REACH, -REACH, REACH, -REACH, 0.0]
    pieces = [np.linspace(a, b, round(abs(b - a) / 1e-4) + 1)[1:] for a, b in pairwise(turns)]
    return np.concatenate([[0.0], *pieces])


def static_claims(data: xr.Dataset, path: np.ndarray) -> list[Claim]:
    """Check the statements about the static test."""
    bearing = static_bearing()
    slip = data["interface_slip"].sel(axis="x")[:, 0].to_numpy()
    force = data["bearing_force"].sel(axis="x")[:, 0].to_numpy()
    first_reach = round(REACH / 1e-4)
    start = path[np.argmax(np.abs(slip) > 1e-4)]
    left = slip[first_reach]
    back = slice(first_reach, 3 * first_reach)
    second = path[back][np.argmax(slip[back] < left - 1e-4)]
    limit = bearing.force_limit(LOAD)
    zero = np.interp(0.0, path[back][::-1], force[back][::-1])
    sliding = -0.066 * sum(bearing.radii) / bearing.effective_radius * LOAD
    return [
        _claim("first high-friction sliding at", "paper 2.2", 0.175, start, 0.005, "m"),
        _claim("slip that it leaves", "paper 2.2", 0.010, left, 0.005, "m"),
        _claim("next high-friction sliding at", "paper 2.2", -0.165, second, 0.005, "m"),
        _claim("largest force", "W tan(theta + atan mu_h)", limit, force.max(), 0.005, "N"),
        _claim("smallest force", "the same", -limit, force.min(), 0.005, "N"),
        _claim("sliding force at zero", "mu (R1 + R2)/L W", sliding, zero, 0.005, "N"),
    ]


def newhall_claims(data: xr.Dataset) -> list[Claim]:
    """Check the statements about the numerical example."""
    time = data["time"].to_numpy()
    u = data["bearing_displacement"].sel(axis="x")[:, 0].to_numpy()
    rim = data["rim_force"].max(["bearing", "surface"]).to_numpy()
    offset = abs(float(data["interface_slip"].sel(axis="x")[-1, 0]))
    error = energy_error(data)
    return [
        _claim("first rim contact", "rigid body 4.16-4.17", 4.165, time[np.argmax(rim > 0.0)],
               0.015 / 4.165, "s"),
        _claim("peak displacement", "rigid body 0.2887-0.2926", 0.2895, np.abs(u).max(),
               0.015, "m"),
        _claim("time of the peak", "rigid body", 4.305, time[np.argmax(np.abs(u))], 0.005, "s"),
        _claim("offset of the interface", "rigid body", 0.038, offset, 0.05, "m"),
        Claim("ledger of energy", "balance", "< 0.1 %", f"{error:.1e}", error < 1e-3),
    ]  # fmt: skip


def _claim(what: str, source: str, expected: float, got: float, within: float, unit: str) -> Claim:
    holds = bool(abs(got - expected) <= within * abs(expected))
    text = f"{expected:.4g} {unit} ± {100.0 * within:.2g} %"
    return Claim(what, source, text, f"{got:.5g} {unit}", holds)


def static_figure(data: xr.Dataset, path: np.ndarray) -> Figure:
    """Draw the normalised loops of the static test, after the paper's Fig. 4."""
    figure = Figure(figsize=(6.0, 3.8), layout="constrained")
    axes = figure.add_subplot()
    axes.plot(1e3 * path, data["bearing_force"].sel(axis="x")[:, 0] / LOAD, color="#0072B2", lw=1.4)
    limit = static_bearing().force_limit(1.0)
    for sign in (-1.0, 1.0):
        axes.axhline(sign * limit, color="0.5", lw=0.8, ls="--")
    axes.annotate("W tan(θ + atan μh)", (-180, limit), xytext=(0, 3), textcoords="offset points",
                  color="0.4", fontsize=8)  # fmt: skip
    axes.set(xlabel="displacement [mm]", ylabel="force / axial load [-]",
             title="Static cyclic test, two cycles of 185 mm")  # fmt: skip
    axes.grid(color="0.9")
    return figure


def newhall_figure(data: xr.Dataset) -> Figure:
    """Draw displacement, slip and loop of the numerical example, after Figs 6 and 8."""
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    time = data["time"]
    u = data["bearing_displacement"].sel(axis="x")[:, 0]
    left.plot(time, 1e3 * u, color="#0072B2", lw=1.2, label="top plate")
    left.plot(time, 1e3 * data["interface_slip"].sel(axis="x")[:, 0], color="#D55E00", lw=1.2,
              label="interface slip")  # fmt: skip
    left.set(xlim=(0, 20), xlabel="time [s]", ylabel="displacement [mm]")
    left.legend(frameon=False, fontsize=8)
    right.plot(1e3 * u, data["bearing_force"].sel(axis="x")[:, 0] / data["weight"],
               color="#0072B2", lw=0.9)  # fmt: skip
    right.set(xlabel="displacement [mm]", ylabel="force / weight [-]")
    for axes in (left, right):
        axes.grid(color="0.9")
    figure.suptitle("Numerical example, Newhall 360 (Northridge 1994)", fontsize=10)
    return figure


def sensitivity(motion: GroundMotion) -> list[str]:
    """Return rows: peak and offset over the elastic sliding before slip, and over the step."""
    rows = []
    cases: list[tuple[str, LIRBearing, float]] = [
        (f"u_y = {1e3 * u_y:g} mm, dt 0.002 s", example_bearing(yield_displacement=u_y), 0.002)
        for u_y in (0.05e-3, 0.1e-3, 0.25e-3, 0.5e-3, 1e-3)
    ]
    cases += [
        (f"u_y = 0.25 mm, dt {dt:g} s", example_bearing(), dt)
        for dt in (0.02, 0.01, 0.005, 1e-3, 1e-4)
    ]
    for name, bearing, dt in cases:
        data = time_history(lumped_mass(bearing, MASS), motion, dt=dt)
        peak = float(np.abs(data["bearing_displacement"].sel(axis="x")).max())
        offset = abs(float(data["interface_slip"].sel(axis="x")[-1, 0]))
        rows.append(f"| {name} | {peak:.4f} | {offset:.4f} | {energy_error(data):.1e} |")
    return rows


def write(folder: Path) -> str:
    """Run everything, write the figures and return the page."""
    path = static_path()
    static = cyclic_test(static_bearing(), path, axial_load=LOAD)
    motion = GroundMotion.from_at2(x=folder / "RSN1044_NORTHR_NWH360.AT2")
    newhall = time_history(lumped_mass(example_bearing(), MASS), motion)
    (DOCS / "figures").mkdir(exist_ok=True)
    static_figure(static, path).savefig(DOCS / "figures" / "static_test.png", dpi=110)
    newhall_figure(newhall).savefig(DOCS / "figures" / "newhall.png", dpi=110)
    claims = [*static_claims(static, path), *newhall_claims(newhall)]
    return "\n".join([
        "# Validation: the paper's static test and numerical example",
        "",
        "Written by `python -m validation.paper`. Rigid-body figures are those of an independent "
        "model of 18 degrees of freedom; their spread is its own, over its steps.",
        "",
        "| statement | source | expected | got | holds |",
        "|---|---|---|---|---|",
        *(f"| {c.what} | {c.source} | {c.expected} | {c.got} | {'yes' if c.holds else '**no**'} |"
          for c in claims),
        "",
        "![Static cyclic test](figures/static_test.png)",
        "",
        "![Numerical example](figures/newhall.png)",
        "",
        "## What the result depends on",
        "",
        "Newhall: elastic sliding before slip (default 0.25 mm), and the step.",
        "",
        "| case | peak displacement (m) | offset (m) | ledger |",
        "|---|---|---|---|",
        *sensitivity(motion),
        "",
    ])  # fmt: skip


if __name__ == "__main__":
    records = os.environ.get("LIR_RECORDS")
    if not records:
        message = "set LIR_RECORDS to the folder that holds RSN1044_NORTHR_NWH360.AT2"
        raise SystemExit(message)
    page = write(Path(records))
    (DOCS / "validation.md").write_text(page, encoding="utf-8")
    print(page)
