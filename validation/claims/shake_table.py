"""Claim: the shake table test's statements hold for a stiff structure on four bearings.

    python -m validation.claims.shake_table

Source: paper (COMPDYN 2023), section 4 and Figs 10 and 11. Neither the measured input nor the
structure is published: the input here is a sine that grows and fades, its two amplitudes found by
`search`, and the structure a stiff one of the given weight. So the claim is about the paper's
statements, not about its curves.
"""

from __future__ import annotations

import math
import warnings
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from frames import Frame, GroundMotion, energy_error, shear_building, time_history
from frames.plots.plot_style import GREY, PALETTE, add_legend, caption, grid_of, new_figure
from lir_element import AnalysisWarning, LIRBearing, VelocityFriction
from lir_element.units import STANDARD_GRAVITY
from validation.page import Check, Claim, Page, render, run, stated

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray

CLAIM = Claim(
    "shake_table",
    "Shake table test (paper, section 4, Figs 10 and 11)",
    "On the shake table: a plain DCFP without impact; with impact several high-friction slides, "
    "and a base shear below 60 % of the weight",
    "paper 4, Figs 10-11",
)
WEIGHT = 26.6e3  # N, paper
BEARINGS = 4
PERIOD = 1.25  # s, of the input: about half that of the sliding pendulum, 2.42 s
CYCLES, RAMP = 10, 2  # of the input, and those in which it grows and fades
AMPLITUDES = tuple(round(1.6 + 0.2 * k, 1) for k in range(8))  # m/s2, tried
VERTICAL = 50.0  # Hz, of the structure on its bearings
STRUCTURE_PERIOD = 0.1  # s, of the structure on a fixed base
LIMIT = 0.60  # of the weight, paper: largest base shear
NEAR, BEYOND = 0.9, 1.15  # of the capacity: stays below, without impact; exceeds, with impact
STEP, FINE = 1e-3, 0.5e-3  # s, of the runs; of those with a stiff seat
SLIDE = 1e-3  # m, slip in one direction that counts as a slide


def seat_stiffness(frequency: float = VERTICAL) -> float:
    """Return the vertical stiffness of a bearing's seat for a vertical frequency [N/m]."""
    return WEIGHT / BEARINGS / STANDARD_GRAVITY * (2.0 * math.pi * frequency) ** 2


def bearing(**changes: Any) -> LIRBearing:
    """Return the bearing of the test; rate, slider radius and stiffnesses are assumed."""
    rate = changes.pop("rate", 15.0)
    options: dict[str, Any] = {
        "radius": 0.75,
        "slider_height": 0.05,
        "slider_radius": 0.05,
        "capacity": 0.11,
        "friction": VelocityFriction(f_max=0.14, f_min=0.11, rate=rate),
        "interface_friction": 0.27,
        "design_load": WEIGHT / BEARINGS,
        "axial_stiffness": seat_stiffness(),
        "rim_stiffness": seat_stiffness(),
    }
    return LIRBearing(**{**options, **changes})


def structure(device: LIRBearing) -> Frame:
    """Return two stiff storeys on a square of four bearings, guided along x as on the table."""
    mass = WEIGHT / STANDARD_GRAVITY / 3.0
    # equal masses m and storeys k on a fixed base: first circular frequency 0.618 sqrt(k / m)
    stiffness = mass * (2.0 * math.pi / STRUCTURE_PERIOD / 0.618034) ** 2
    frame = shear_building(
        device,
        [mass, mass],
        stiffness,
        base_mass=mass,
        storey_height=1.0,
        plan=(1, 1.5),
        overturning=False,
        name="stiff structure on the shake table",
    )
    for node in ("base", "floor-1", "floor-2"):
        frame.fix(node, "uy", "rz")
    return frame


def table_motion(amplitude: float) -> GroundMotion:
    """Return the input: a sine of some amplitude [m/s2] that grows, stays and fades."""
    dt = 0.005
    t = np.arange(0.0, CYCLES * PERIOD + 0.5 * dt, dt)
    ends = np.minimum(t, CYCLES * PERIOD - t) / (RAMP * PERIOD)
    wave = amplitude * np.clip(ends, 0.0, 1.0) * np.sin(2.0 * np.pi * t / PERIOD)
    return GroundMotion(x=wave, dt=dt, name=f"sine {amplitude:g} m/s2").with_tail(1.5)


def respond(device: LIRBearing, amplitude: float, dt: float = STEP) -> xr.Dataset:
    """Run the test; a failure of a bearing is in the attributes."""
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        return time_history(structure(device), table_motion(amplitude), dt=dt)


def displacement(data: xr.Dataset) -> FloatArray:
    """Return the displacement of the base [m]: that of all bearings, for it does not turn."""
    return data["bearing_displacement"].sel(axis="x").mean("bearing").to_numpy()


def shear(data: xr.Dataset) -> FloatArray:
    """Return the base shear over the weight [-]."""
    return data["base_shear"].sel(axis="x").to_numpy() / float(data["weight"])


def peak(values: FloatArray) -> float:
    """Return the largest absolute value."""
    return float(np.abs(values).max())


def slides(data: xr.Dataset) -> list[tuple[float, float]]:
    """Return begin [s] and slip [m] of each slide: more than 1 mm one way, without rest."""
    slip = data["interface_slip"].sel(axis="x")[:, 0].to_numpy()
    time = data["time"].to_numpy()
    way = np.sign(np.where(np.abs(np.diff(slip)) > 1e-5, np.diff(slip), 0.0))
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(way)) + 1, [len(way)]])
    found = [(float(time[a]), float(slip[b] - slip[a])) for a, b in pairwise(cuts)]
    return [(begin, size) for begin, size in found if abs(size) > SLIDE]


def search() -> tuple[dict[float, xr.Dataset], float, float]:
    """Run all amplitudes; return the runs, and the amplitudes without and with impact."""
    device = bearing()
    found = {a: respond(device, a) for a in AMPLITUDES}
    reach = {a: peak(displacement(data)) / device.lateral_capacity for a, data in found.items()}
    without = max(a for a, share in reach.items() if share < NEAR)
    return found, without, min(a for a, share in reach.items() if share > BEYOND)


def checks(without: xr.Dataset, plain: xr.Dataset, impact: xr.Dataset) -> list[Check]:
    """Check the statements: runs without impact, of the plain DCFP in it, and with impact."""
    difference = peak(displacement(without) - displacement(plain))
    static = bearing().force_limit(1.0)
    count = len(slides(impact))
    rim = float(without["rim_force"].max())
    return [
        Check(
            "rim force in the test without impact",
            "its definition",
            "0 N",
            f"{rim:g} N",
            not rim > 0.0,
        ),
        *stated(f"""
        without impact: difference to the plain DCFP, displacement | paper 4 | < 0.5 mm | {1e3 * difference}
        the same, base shear / weight | paper 4 | < 0.01 | {peak(shear(without) - shear(plain))}
        with impact: peak displacement (capacity) | paper, Fig. 11(c) | > 110 mm | {1e3 * peak(displacement(impact))}
        with impact: base shear / weight | paper 4 | < {LIMIT} | {peak(shear(impact))}
        the same | tan(θ + atan μ_h), static | {static} ± 25 % | {peak(shear(impact))}
        """),
        Check(
            "high-friction slides of more than 1 mm",
            "paper 4: several",
            ">= 3",
            str(count),
            count >= 3,
        ),
        Check(
            "the bearings survive the test with impact",
            "paper 4",
            "ok",
            str(impact.attrs["status"]),
            impact.attrs["status"] == "ok",
        ),
        *stated(f"""
        energy balance, worst run | balance | < 0.001 | {max(energy_error(data) for data in (without, plain, impact))}
        """),
    ]


def jump(data: xr.Dataset) -> float:
    """Return the largest jump of the plate's vertical speed at a rim contact, U̇ s / L [m/s]."""
    touches = data["rim_force"].max(["bearing", "surface"]).to_numpy() > 0.0
    begins = np.flatnonzero(touches[1:] & ~touches[:-1])
    speed = data["bearing_velocity"].sel(axis="x")[:, 0].to_numpy()[begins]
    slip = data["interface_slip"].sel(axis="x")[:, 0].to_numpy()[begins]
    return peak(speed * slip) / bearing().effective_radius


def assumptions(amplitude: float) -> dict[str, tuple[xr.Dataset, xr.Dataset]]:
    """Run the test with impact, and a stronger one, under other assumptions."""
    default = 20e9 * math.pi * bearing().slider_radius ** 2 / bearing().slider_height
    cases: dict[str, dict[str, Any]] = {
        "as used: rate 15 s/m, vertical 50 Hz, rims as stiff as the seat": {},
        "rate 5 s/m": {"rate": 5.0},
        "rate 50 s/m": {"rate": 50.0},
        "rate 200 s/m": {"rate": 200.0},
        "rims 10 times stiffer": {"rim_stiffness": 10.0 * seat_stiffness()},
        "rims 10 times softer": {"rim_stiffness": 0.1 * seat_stiffness()},
        "vertical 25 Hz": {"axial_stiffness": seat_stiffness(25.0)},
        "vertical 100 Hz": {"axial_stiffness": seat_stiffness(100.0)},
        "vertical 200 Hz": {"axial_stiffness": seat_stiffness(200.0)},
        "vertical 340 Hz: default, 20 GPa on the slider's area": {"axial_stiffness": default},
    }
    first, last = (
        {name: respond(bearing(**changes), a, FINE) for name, changes in cases.items()}
        for a in (amplitude, AMPLITUDES[-1])
    )
    return {name: (first[name], last[name]) for name in cases}


def page(_: Path | None = None) -> Page:
    """Run the tests and return their page."""
    found, without, impact = search()
    plain = respond(bearing().as_dcfp(), without)
    results = checks(found[without], plain, found[impact])
    count = len(slides(found[impact]))
    apart = peak(displacement(found[without]) - displacement(plain))
    motions = {
        name: table_motion(a) for name, a in (("without impact", without), ("with impact", impact))
    }
    return Page(
        CLAIM,
        f"without impact within {1e3 * apart:.2f} mm of the plain DCFP; with impact "
        f"{1e3 * peak(displacement(found[impact])):.0f} mm, {count} slides, base shear "
        f"{peak(shear(found[impact])):.2f} W",
        results,
        render(
            globals(),
            found=found,
            impact=impact,
            others=assumptions(impact),
            speed=jump(found[impact]),
            without=without,
        ),
        {
            "inputs": inputs(motions),
            "responses": responses(found[without], plain, found[impact], bearing()),
        },
    )


def inputs(motions: Mapping[str, GroundMotion]) -> Figure:
    """Draw the accelerations of the table, after Fig. 10."""
    drawn = new_figure(2.0)
    row = grid_of(drawn, 1, len(motions), share_x=True, share_y=True)[0]
    for panel, (name, motion) in zip(row, motions.items(), strict=True):
        panel.plot(motion.time, motion.components[:, 0], color=PALETTE[0], linewidth=1.0)
        caption(panel, x="time [s]", title=f"test {name}")
    row[0].set_xlim(0.0, next(iter(motions.values())).duration)
    caption(row[0], y="acceleration [m/s²]")
    return drawn


def responses(
    without: xr.Dataset, plain: xr.Dataset, impact: xr.Dataset, device: LIRBearing
) -> Figure:
    """Draw base displacement and loops without and with impact, after Fig. 11."""
    drawn = new_figure(4.7)
    grid = grid_of(drawn, 2, 2)
    looks: tuple[dict[str, Any], ...] = (
        {"color": PALETTE[0], "linewidth": 1.8},
        {"color": PALETTE[1], "linewidth": 0.9, "linestyle": "--"},
    )
    for row, pairs, title in (
        (grid[0], ((without, looks[0]), (plain, looks[1])), "without impact"),
        (grid[1], ((impact, {**looks[0], "linewidth": 1.1}),), "with impact"),
    ):
        for data, look in pairs:
            u = 1e3 * data["bearing_displacement"].sel(axis="x").mean("bearing")
            row[0].plot(data["time"], u, **look)
            row[1].plot(u, data["base_shear"].sel(axis="x") / data["weight"], **look)
        for sign in (-1.0, 1.0):
            reach = sign * 1e3 * device.lateral_capacity
            row[0].axhline(reach, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
            row[1].axvline(reach, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)))
            row[1].axhline(0.6 * sign, color="black", linewidth=0.8, linestyle=(0, (1, 2)))
        row[0].set_xlim(0.0, float(without["time"][-1]))
        row[0].set_ylim(-155.0, 155.0)
        row[1].set_xlim(-155.0, 155.0)
        row[1].set_ylim(-0.66, 0.66)
        caption(row[0], y="base displacement [mm]", title=title)
        caption(row[1], y="base shear / weight [-]", title=title)
    caption(grid[1][0], x="time [s]")
    caption(grid[1][1], x="base displacement [mm]")
    handles = [
        Line2D([], [], label="LIR-DCFP", **looks[0]),
        Line2D([], [], label="plain DCFP", **looks[1]),
        Line2D([], [], color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), label="capacity"),
        Line2D([], [], color="black", linewidth=0.8, linestyle=(0, (1, 2)), label="60 % of weight"),
    ]
    add_legend(drawn, handles, columns=4, title="Stiff structure on four bearings")
    return drawn


if __name__ == "__main__":
    run(CLAIM, page)
