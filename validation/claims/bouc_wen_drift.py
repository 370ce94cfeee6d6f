"""Claim: Bouc-Wen friction with a finite exponent lets the interface drift, by a known amount.

    LIR_RECORDS=<folder of records> python -m validation.claims.bouc_wen_drift

Sources: the biaxial Bouc-Wen law (Park, Wen and Ang 1986) that the paper names in section 3, with
A = 1, beta = gamma = 1/2; derivation on the page; Newhall as in `validation.claims.newhall`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D
from scipy.integrate import quad

from frames import GroundMotion, lumped_mass, time_history
from frames.plots.plot_style import GREY, PALETTE, add_legend, caption, grid_of, new_figure
from lir_element.units import STANDARD_GRAVITY
from validation.page import Check, Claim, Page, render, run, stated
from validation.scenes import EXAMPLE_MASS, EXAMPLE_RECORD, LEVELS_DRIFT, example_bearing

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import xarray as xr
    from matplotlib.figure import Figure

    from frames._types import FloatArray
    from lir_element.device.features import AnyLevel

CLAIM = Claim(
    "bouc_wen_drift",
    "Drift of the interface under Bouc-Wen friction",
    "With a finite exponent Bouc-Wen lets the interface drift by a share of u_y each cycle of a "
    "vibration; the elastic-plastic law does not drift",
    "derived; paper 3 (law), 3.1 (Newhall)",
    EXAMPLE_RECORD,
)
EXPONENTS = (1.0, 2.0, 4.0, 8.0, 20.0)
YIELDS = (0.01e-3, 0.1e-3, 1e-3)  # m
HELD, VIBRATION = 0.19, 0.01  # g, of the synthetic motion: held, and its vibration
FREQUENCY, CYCLES = 1.0, 20  # Hz; cycles of the vibration
RISE, REST = 6.0, 3.0  # s, in which the held part grows; before the vibration begins
FIRST, LAST = 7.0, 20.0  # s, of Newhall: after the impacts, and where it is read


def bearing_options(exponent: float, yield_displacement: float) -> dict[str, Any]:
    """Return options of the bearing: infinite exponent for the elastic-plastic law."""
    options: dict[str, Any] = {"interface_yield_displacement": yield_displacement}
    if math.isfinite(exponent):
        options |= {"friction_law": "bouc-wen", "bouc_wen_exponent": exponent}
    return options


def made_input() -> GroundMotion:
    """Return an acceleration that grows to a held value and then vibrates about it."""
    dt = 0.005
    t = np.arange(0.0, RISE + REST + CYCLES / FREQUENCY + 0.5 * dt, dt)
    share = np.clip(t / RISE, 0.0, 1.0)
    held = HELD * share**2 * (3.0 - 2.0 * share)
    since = t - RISE - REST
    wave = VIBRATION * np.sin(2.0 * np.pi * FREQUENCY * since) * (since > 0.0)
    return GroundMotion(x=-STANDARD_GRAVITY * (held + wave), dt=dt, name="held and vibrating")


def bias() -> tuple[float, float]:
    """Return z of the interface under the held force, and the amplitude of its vibration [-]."""
    # the slider lies on the rim, tilted: the interface carries the part of the force along it
    bearing = example_bearing()
    tilt = math.asin(bearing.lateral_capacity / bearing.effective_radius)
    low, high = (
        math.tan(math.atan(a) - tilt) / bearing.interface_friction
        for a in (HELD - VIBRATION, HELD + VIBRATION)
    )
    return 0.5 * (low + high), 0.5 * (high - low)


def estimate(exponent: float) -> float:
    """Return the drift a cycle over the yield displacement [-], from the law by force control."""
    # unloading follows dw = u_y dz, loading dw = u_y dz / (1 - z^eta)
    if math.isinf(exponent):
        return 0.0
    middle, amplitude = bias()
    low, high = middle - amplitude, middle + amplitude
    return float(quad(lambda z: z**exponent / (1.0 - z**exponent), low, high)[0])


def slip_of(data: xr.Dataset) -> FloatArray:
    """Return the size of the slip along x [m]."""
    return np.asarray(np.abs(data["interface_slip"].sel(axis="x")[:, 0].to_numpy()))


def held_runs() -> dict[tuple[float, float], xr.Dataset]:
    """Run the synthetic motion, by exponent and yield displacement."""
    motion = made_input()
    return {
        (eta, u_y): time_history(
            lumped_mass(example_bearing(**bearing_options(eta, u_y)), EXAMPLE_MASS), motion
        )
        for u_y in YIELDS
        for eta in (*EXPONENTS, math.inf)
    }


def drift(data: xr.Dataset) -> float:
    """Return the drift a cycle of the synthetic motion [m], of all cycles but the first."""
    slip, time = slip_of(data), data["time"].to_numpy()
    begin = RISE + REST + 1.0 / FREQUENCY
    first, last = np.interp([begin, RISE + REST + CYCLES / FREQUENCY], time, slip)
    return float(last - first) / (CYCLES - 1)


def held_checks(found: dict[tuple[float, float], xr.Dataset]) -> list[Check]:
    """Check the synthetic motion against the estimate."""
    small = YIELDS[:2]
    errors = [
        abs(drift(found[eta, u_y]) / (u_y * estimate(eta)) - 1.0)
        for eta in EXPONENTS[:4]
        for u_y in small
    ]
    coarse = [
        abs(drift(found[eta, YIELDS[2]]) / (YIELDS[2] * estimate(eta)) - 1.0)
        for eta in EXPONENTS[:3]
    ]
    still = max(abs(drift(found[math.inf, u_y])) / u_y for u_y in small)
    return stated(f"""
        synthetic motion: drift a cycle / estimate − 1, exponents 1 to 8, u_y up to 0.1 mm | u_y ∫ z^η / (1 − z^η) dz | < 0.05 | {max(errors)}
        the same, exponents 1 to 4, u_y = 1 mm (the mass vibrates on the interface) | the same | < 0.25 | {max(coarse)}
        elastic-plastic: drift a cycle / u_y, u_y up to 0.1 mm | 0 | < 0.001 | {still}
        """)


def newhall_runs(record: GroundMotion, level: AnyLevel) -> dict[tuple[float, float], xr.Dataset]:
    """Run the numerical example, by exponent and yield displacement."""
    return {
        (eta, u_y): time_history(
            lumped_mass(example_bearing(**bearing_options(eta, u_y)), EXAMPLE_MASS),
            record,
            level=level,
        )
        for u_y in YIELDS
        for eta in (*EXPONENTS, math.inf)
    }


def growth(data: xr.Dataset) -> tuple[float, float]:
    """Return the slip after the impacts, and what it gains until 20 s [m]."""
    first, last = np.interp([FIRST, LAST], data["time"].to_numpy(), slip_of(data))
    return float(first), float(last - first)


def newhall_checks(found: dict[tuple[float, float], xr.Dataset], level: str) -> list[Check]:
    """Check that the slip of the example drifts with Bouc-Wen alone."""
    plastic = max(abs(growth(found[math.inf, u_y])[1]) for u_y in YIELDS)
    worst = growth(found[1.0, YIELDS[2]])[1]
    default = growth(found[2.0, YIELDS[0]])[1]
    of = f" ({level})"
    return stated(f"""
        Newhall, elastic-plastic: growth of the slip, 7 to 20 s{of} | 0; 38 mm of slip | < 0.2 mm | {1e3 * plastic}
        Newhall, Bouc-Wen, exponent 2, u_y = 0.01 mm (default): the same{of} | as elastic-plastic | < 0.2 mm | {1e3 * abs(default)}
        Newhall, Bouc-Wen, exponent 1, u_y = 1 mm: the same{of} | it drifts | > 2 mm | {1e3 * worst}
        """)


def cycles(exponent: float, yield_displacement: float) -> str:
    """Return the number of cycles after which 1 mm of drift is reached, in words."""
    share = estimate(exponent) * yield_displacement
    return f"{1e-3 / share:,.0f}".replace(",", " ") if share > 1e-12 else "> 10⁹"


def page(folder: Path | None) -> Page:
    """Run the synthetic motion and the numerical example, and return the page."""
    if folder is None:
        message = f"{CLAIM.name} needs the record {CLAIM.record}"
        raise ValueError(message)
    record = GroundMotion.from_at2(x=folder / EXAMPLE_RECORD)
    held = held_runs()
    found = {level: newhall_runs(record, level) for level in LEVELS_DRIFT}
    results = held_checks(held)
    for level, runs in found.items():
        results += newhall_checks(runs, level)
    first = next(iter(found.values()))
    low, high = (1e3 * growth(first[2.0, u_y])[1] for u_y in (YIELDS[0], YIELDS[2]))
    ratios = {key: drift(data) / key[1] for key, data in held.items()}
    curve = {float(eta): estimate(float(eta)) for eta in np.geomspace(1.0, 20.0, 40)}
    return Page(
        CLAIM,
        f"synthetic motion within {100.0 * float(results[0].got):.1f} % of the estimate; Newhall, "
        f"exponent 2, 7 to 20 s: {low:+.2f} mm with u_y = 0.01 mm, {high:+.2f} mm with 1 mm",
        results,
        render(globals(), bias=bias(), found=found, held=held),
        {"held": drift_figure(held, ratios, curve), "newhall": newhall_figure(first)},
    )


MARKS = ("o", "s", "^")


def drift_figure(
    found: Mapping[tuple[float, float], xr.Dataset],
    ratios: Mapping[tuple[float, float], float],
    estimates: Mapping[float, float],
) -> Figure:
    """Draw the slip under the synthetic motion, and the drift a cycle over the exponent."""
    drawn = new_figure(3.3)
    left, right = grid_of(drawn, 1, 2)[0]
    shown = 0.1e-3
    finite = sorted({eta for eta, _ in ratios if math.isfinite(eta)})
    exponents = [*finite, math.inf]
    handles = []
    for k, eta in enumerate(exponents):
        data = found[eta, shown]
        colour = PALETTE[k] if math.isfinite(eta) else "black"
        name = f"η = {eta:g}" if math.isfinite(eta) else "elastic-plastic"
        slip = abs(data["interface_slip"].sel(axis="x")[:, 0])
        left.plot(data["time"], 1e3 * slip, color=colour, linewidth=1.0)
        handles.append(Line2D([], [], color=colour, linewidth=1.2, label=name))
    left.set_xlim(8.0, float(found[math.inf, shown]["time"][-1]))
    left.set_ylim(4.6, 6.1)
    caption(left, x="time [s]", y="interface slip [mm]", title="slip, u$_y$ = 0.1 mm")
    right.plot(list(estimates), list(estimates.values()), color=GREY, linewidth=1.0)
    marks = [Line2D([], [], color=GREY, linewidth=1.0, label="estimate")]
    yields = sorted({u_y for _, u_y in ratios})
    for k, u_y in enumerate(yields):
        points = [(eta, ratios[eta, u_y]) for eta in finite if ratios[eta, u_y] > 0.0]
        look: dict[str, Any] = {
            "marker": MARKS[k],
            "color": PALETTE[k],
            "linestyle": "",
            "markersize": 4.5,
            "markerfacecolor": "none",
        }
        right.plot(*zip(*points, strict=True), **look)
        marks.append(Line2D([], [], label=f"u$_y$ = {1e3 * u_y:g} mm", **look))
    right.set_xscale("log")
    right.set_yscale("log")
    right.set_xticks(finite, [f"{eta:g}" for eta in finite])
    right.minorticks_off()
    caption(right, x="exponent η [-]", y="drift a cycle / u$_y$ [-]", title="drift")
    right.legend(handles=marks, frameon=False, fontsize=7.5, loc="lower left")
    add_legend(drawn, handles, columns=6, title="Bouc-Wen friction on the rim, synthetic motion")
    return drawn


def newhall_figure(found: Mapping[tuple[float, float], xr.Dataset]) -> Figure:
    """Draw the slip of the numerical example over time, a panel for each yield displacement."""
    drawn = new_figure(2.7)
    yields = sorted({u_y for _, u_y in found})
    row = grid_of(drawn, 1, len(yields), share_x=True, share_y=True)[0]
    handles = []
    for panel, u_y in zip(row, yields, strict=True):
        for k, eta in enumerate(sorted({eta for eta, _ in found})):
            data = found[eta, u_y]
            colour = PALETTE[k] if math.isfinite(eta) else "black"
            slip = abs(data["interface_slip"].sel(axis="x")[:, 0])
            panel.plot(data["time"], 1e3 * slip, color=colour, linewidth=1.0)
            if panel is row[0]:
                name = f"η = {eta:g}" if math.isfinite(eta) else "elastic-plastic"
                handles.append(Line2D([], [], color=colour, linewidth=1.2, label=name))
        caption(panel, x="time [s]", title=f"u$_y$ = {1e3 * u_y:g} mm")
    row[0].set_xlim(4.0, 20.0)
    row[0].set_ylim(36.0, 43.0)
    caption(row[0], y="interface slip [mm]")
    add_legend(drawn, handles, columns=6, title="Slip of the interface, Newhall 360")
    return drawn


if __name__ == "__main__":
    run(CLAIM, page)
