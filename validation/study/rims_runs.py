"""LIR-DCFP and DCFP of equal plan whose rims have a strength: devices, runs and numbers.

The building, intensities and limit states are those of `records_runs`, the records the far-field set.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from frames.risk import Campaign, LimitState, collapse_margin_ratio
from frames.risk.campaign.comparison import dish_diameter
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.yielding_runs import LIR, RIMS, model_of, structures
from validation.study.records_runs import (
    COLLAPSE,
    SCALES,
    STEP,
    STRUCTURE,
    considered,
    curves_of,
    numbers_of,
    runs_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import xarray as xr

    from frames import Frame, GroundMotion
    from lir_element import LIRBearing

BREAKS = 0.02
"""Deformation at which a rim that yields breaks [m]: an assumption."""

ENDLESS = 1.0
"""The same of a rim that never does [m]."""

MORE = 0.06
"""Radius by which the dishes of the larger plan exceed those of the smaller one [m]."""


class Kind(NamedTuple):
    """A device of the study: its sliders, its place in the plan, its rims."""

    plain: bool
    wider: bool  # of the larger plan
    wider_sliders: float  # share of what the plan is wider by that is the sliders'
    interface: float  # friction; of plain bearings without meaning
    strength: float | None  # of a rim over the design load; None: neither yields nor breaks

    @property
    def name(self) -> str:
        """How the page calls it."""
        rims = "rims that never break" if self.strength is None else f"rims of {self.strength:g} W"
        plan = "larger plan" if self.wider else "smaller plan"
        if self.plain:
            return f"DCFP, {plan}, {rims}"
        sliders = f", sliders {1e3 * MORE * self.wider_sliders:+.0f} mm" if self.wider else ""
        return f"LIR-DCFP, {plan}{sliders}, mu_h {self.interface:.2f}, {rims}"


STRENGTHS = (None, 2.0, 1.0, 0.5)
KINDS = (
    *(Kind(True, False, 0.0, 0.0, s) for s in STRENGTHS),
    *(Kind(True, True, 0.0, 0.0, s) for s in STRENGTHS),
    *(Kind(False, False, 0.0, 0.13, s) for s in (None, 0.5)),
    *(Kind(False, True, 1.0, 0.16, s) for s in (None, 0.5)),
    Kind(False, True, 1.0, 0.20, None),
    Kind(False, True, 0.5, 0.16, None),
)

LIMITS = (
    LimitState.drift(0.02),
    LimitState("ductility 4", "ductility", 4.0),
    LimitState.floor_acceleration(STANDARD_GRAVITY),
    COLLAPSE,
)


def bearing_of(own: LIRBearing, kind: Kind) -> LIRBearing:
    """Return a bearing of the smaller plan as one of a kind: its dish is what the plan allows."""
    slider = own.slider_radius + (MORE * kind.wider_sliders if kind.wider else 0.0)
    reach = own.rim_displacement[0] + own.slider_radius + (MORE if kind.wider else 0.0) - slider
    load = own.resolved()["design_load"]
    changes: dict[str, Any] = {
        "slider_radius": slider,
        "capacity": reach * own.effective_radius / own.radii[0],
        "rims": None,
        "design_load": load,
        "rim_stiffness": own.resolved()["rim_stiffness"],
        "rim_overrun": ENDLESS if kind.strength is None else BREAKS,
    }
    if kind.strength is not None:
        changes["rim_yield_force"] = kind.strength * load
    if not kind.plain:
        changes["interface_friction"] = kind.interface
    return replace(own, **changes)


def devices() -> dict[str, Frame]:
    """Return the building on each device."""
    found = {}
    for kind in KINDS:
        frame = model_of(structures()[STRUCTURE], RIMS if kind.plain else LIR)
        found[kind.name] = frame.with_bearings(
            {name: bearing_of(link.bearing, kind) for name, link in frame.bearings.items()}
        )
    return found


def campaign(
    motions: Mapping[str, GroundMotion], store: Path, scales: Sequence[float] = SCALES
) -> Campaign:
    """Return the campaign of all devices under motions at intensities [m/s2]."""
    return Campaign(devices(), dict(motions), store=store, scales=list(scales), dt=STEP)


def found_of(
    data: xr.Dataset, motions: Mapping[str, GroundMotion], resamples: int
) -> dict[str, Any]:
    """Return what the page says of the results of a campaign: plain numbers, for JSON."""
    runs = {kind.name: runs_of(data, motions, kind.name) for kind in KINDS}
    limits = {}
    for limit in LIMITS:
        curves = curves_of(runs, limit, resamples)
        limits[limit.name] = {
            name: numbers_of(curve, band=limit is COLLAPSE) for name, curve in curves.items()
        }
    at = considered()
    margins = {
        name: [collapse_margin_ratio(value, at) for value in curve["median"]]
        for name, curve in limits[COLLAPSE.name].items()
        if "median" in curve
    }
    models = devices()
    bent = data["peak_rim_plastic"].max("bearing").to_numpy()
    model = data["model"].to_numpy()
    return {
        "considered": at,
        "limits": limits,
        "margins": margins,
        "statuses": {
            name: each.table["status"].value_counts().to_dict() for name, each in runs.items()
        },
        "bent": {name: float((bent[model == name] > 0.0).mean()) for name in runs},
        "dishes": {
            name: sorted(
                {round(dish_diameter(link.bearing), 4) for link in frame.bearings.values()}
            )
            for name, frame in models.items()
        },
        "capacities": {
            name: sorted(
                {round(link.bearing.lateral_capacity, 4) for link in frame.bearings.values()}
            )
            for name, frame in models.items()
        },
    }
