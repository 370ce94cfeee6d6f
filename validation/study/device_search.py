"""The LIR-DCFP of a plan that collapses last: bounds, what is maximised, and the search."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.optimize import Bounds, brentq, direct
from scipy.stats import norm, qmc

from frames.design.sizing.target import LEAST_PRESSURE
from frames.risk import Campaign
from validation.study.device_runs import (
    LEAST,
    MOST,
    SEARCHED,
    Device,
    bearing_of,
    frame_of,
    own_bearings,
    plan_of,
    reach_of,
)
from validation.study.records_runs import COLLAPSE, STEP, runs_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import GroundMotion
    from frames.risk import IntensityRuns

STRIPES = (1.9, 2.6, 3.6)
"""Intensities of the search [m/s2], under every second record of the set."""

DISPERSION = 0.25
"""Of collapse over these records [-]: what `median_of` takes."""

POINTS = 16
"""Of the first design: Sobol' points of plan, sliders and interface."""

SMOOTHING = 1e-3
"""Of the response surface: runs are few, so that a point is not met exactly."""


EDGE = (1.0, 2.0)
"""Share of sliders and kappa where the work by hand is largest without loss of way."""


class Sliders(NamedTuple):
    """Bounds of the least slider's radius [m].

    Attributes
    ----------
    smallest, largest : float
        Radii of the smallest and the largest slider that the pressure allows.
    most : float
        Radius at which equal sliders are pressed so lightly that the friction of liners is hardly
        known, 10 MPa in the mean weighted by the loads.
    """

    smallest: float
    largest: float
    most: float


def sliders() -> Sliders:
    """Return the bounds of the study's building."""
    own = own_bearings()
    radii = [each.slider_radius for each in own]
    loads = np.array([each.resolved()["design_load"] for each in own])
    typical = float((loads**2).sum() / loads.sum())
    return Sliders(min(radii), max(radii), math.sqrt(typical / (math.pi * LEAST_PRESSURE)))


def least_of(share: float) -> float:
    """Return the least radius of a slider [m]."""
    return float(np.interp(share, (0.0, 1.0, 2.0), sliders()))


def interface_of(kappa: float, least: float, plan: float) -> float:
    """Return the friction of the interface, ``mu_e + kappa a / L``."""
    own = own_bearings()[0]
    one = bearing_of(own, Device(plan, True), 0.1)  # the way to the rims has no part in it
    return one.effective_friction + kappa * least / one.effective_radius


def device_at(plan: float, share: float, kappa: float) -> Device:
    """Return the LIR-DCFP of a point of the search."""
    least = least_of(share)
    return Device(plan, False, least=least, interface=interface_of(kappa, least, plan))


def energies(device: Device) -> dict[str, float]:
    """Return the work that a device takes in one way from rest, over the weight [m]."""
    own = own_bearings()
    bearings = [bearing_of(each, device, reach_of(device, own)) for each in own]
    one = bearings[0]
    reach, length, friction = one.lateral_capacity, one.effective_radius, one.effective_friction
    slip = min(each.slider_radius for each in bearings)
    weight = sum(each.resolved()["design_load"] for each in bearings)
    rims = [
        each.rim_yield_force * each.resolved()["rim_overrun"]
        for each in bearings
        if math.isfinite(each.rim_yield_force)
    ]
    return {
        "sliding": reach**2 / (2.0 * length) + friction * reach,
        "slip": 0.0 if device.plain else (reach / length + device.interface) * slip,
        "rims": sum(rims) / weight,
    }


def work_of(device: Device) -> float:
    """Return the work by sliding and slip, over the weight [m]."""
    parts = energies(device)
    return parts["sliding"] + parts["slip"]


def median_of(shares: Sequence[float], stripes: Sequence[float] = STRIPES) -> float:
    """Return the median intensity that goes with shares of collapse at stripes [m/s2].

    Of a lognormal curve of a known dispersion whose mean over the stripes is that of the shares:
    there is one even where a fit of both would not settle.
    """
    at, mean = np.log(stripes), float(np.mean(shares))
    mean = min(max(mean, 1e-3), 1.0 - 1e-3)

    def excess(middle: float) -> float:
        return float(norm.cdf((at - middle) / DISPERSION).mean()) - mean

    return math.exp(brentq(excess, at[0] - 2.0, at[-1] + 2.0))


def coarse(motions: Mapping[str, GroundMotion]) -> dict[str, GroundMotion]:
    """Return every second record."""
    return dict(list(motions.items())[::2])


def first_points() -> list[tuple[float, float, float]]:
    """Return plans [m], shares of sliders and kappas of the first design."""
    low, high = (plan_of(LEAST), 0.0, 1.0), (plan_of(MOST), 2.0, 2.0)
    drawn = qmc.Sobol(3, rng=1).random(POINTS)
    return [(float(p), float(s), float(k)) for p, s, k in qmc.scale(drawn, low, high)]


def campaign_of(
    points: Sequence[tuple[float, float, float]], motions: Mapping[str, GroundMotion], store: Path
) -> Campaign:
    """Return the campaign of points of the search."""
    frames = {named(point): frame_of(device_at(*point)) for point in dict.fromkeys(points)}
    return Campaign(frames, coarse(motions), store=store, scales=list(STRIPES), dt=STEP)


def named(point: tuple[float, float, float]) -> str:
    """Return the name of a point."""
    return "plan {:.4f} m, sliders {:.4f}, kappa {:.4f}".format(*point)


def collapsed(runs: IntensityRuns) -> tuple[list[float], int]:
    """Return the share of collapse by stripe, and how many runs are unknown."""
    exceeded, im = runs.exceeded(COLLAPSE), runs.table["im"].to_numpy()
    shares = [float(np.nanmean(exceeded[np.isclose(im, at)])) for at in STRIPES]
    return shares, int(np.isnan(exceeded).sum())


def rows_of(
    points: Sequence[tuple[float, float, float]],
    data: xr.Dataset,
    motions: Mapping[str, GroundMotion],
    stage: str,
) -> list[dict[str, Any]]:
    """Return what a campaign says of its points: plain numbers."""
    rows = []
    for point in points:
        shares, unknown = collapsed(runs_of(data, coarse(motions), named(point)))
        device = device_at(*point)
        rows.append(
            {
                "stage": stage,
                "plan": point[0],
                "sliders": point[1],
                "kappa": point[2],
                "least": device.least,
                "interface": device.interface,
                "work": work_of(device),
                "shares": shares,
                "unknown": unknown,
                "median": median_of(shares),
            }
        )
    return rows


def proposals(
    rows: Sequence[Mapping[str, Any]], plans: Sequence[float]
) -> list[tuple[float, float, float]]:
    """Return the point of each plan at which the response surface through all points is highest.

    The surface is a power of the work by hand, and on it radial functions of what that leaves over;
    `direct` finds its maximum without a start.
    """
    low = np.array([plan_of(LEAST), 0.0, 1.0])
    span = np.array([plan_of(MOST), 2.0, 2.0]) - low
    known = np.array([[row["plan"], row["sliders"], row["kappa"]] for row in rows])
    medians, work = (np.log([row[key] for row in rows]) for key in ("median", "work"))
    trend = np.polyfit(work, medians, 1)
    rest = RBFInterpolator(
        (known - low) / span,
        medians - np.polyval(trend, work),
        kernel="linear",
        degree=0,
        smoothing=SMOOTHING,
    )
    found = []
    for plan in plans:

        def depth(where: np.ndarray, plan: float = plan) -> float:
            point = np.array([plan, *(low[1:] + span[1:] * where)])
            by_hand = np.polyval(trend, math.log(work_of(device_at(*point))))
            return -float(by_hand + rest([(point - low) / span])[0])

        best = direct(depth, Bounds([0.0, 0.0], [1.0, 1.0]), maxfun=200)
        share, kappa = low[1:] + span[1:] * best.x
        found.append((plan, round(float(share), 2), round(float(kappa), 2)))
    return found


def second_points(rows: Sequence[Mapping[str, Any]]) -> list[tuple[float, float, float]]:
    """Return the points that are tried at each plan compared."""
    plans = [plan_of(more) for more in SEARCHED]
    found = {point[0]: point for point in proposals(rows, plans)}
    return list(dict.fromkeys(p for plan in plans for p in (found[plan], (plan, *EDGE))))


def best_of(rows: Sequence[Mapping[str, Any]], plan: float) -> Mapping[str, Any] | None:
    """Return the row of the plan that collapses last; None where none was tried."""
    own = [row for row in rows if math.isclose(row["plan"], plan, rel_tol=1e-9)]
    return max(own, key=lambda row: row["median"], default=None)
