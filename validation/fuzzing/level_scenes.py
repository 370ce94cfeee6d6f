"""A random building on a grid of bearings, brought near its rims or beyond: for levels compared."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames import GroundMotion, MotionWarning, Recording, shear_building, time_history
from lir_element import AnalysisWarning, DesignWarning
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import log_uniform
from validation.fuzzing.rim_scenes import DT, random_rim_scene
from validation.fuzzing.scenes import random_bays, storey_values

if TYPE_CHECKING:
    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray
    from lir_element import LIRBearing

GOALS = (0.6, 1.25)
"""Least and largest of the peak displacement, over the one at which rims are met [-]."""
UNLIKE_GOALS = (0.06, 1.2)
"""The same where the surfaces are of unlike friction, which matters at small displacements, too."""
UNLIKE = (1.03, 5.0)
"""Least and largest ratio of their coefficients of friction [-]."""
NEAR, NEAR_SMALL = 0.05, 0.1
"""Of the goal: in its own unit, over the goal."""
TRIALS = 12


def random_level_scene(
    seed: int, number: int, *, unlike: bool = False
) -> tuple[Frame, LIRBearing, GroundMotion, float]:
    """Return building, bearing, motion and goal of test case `number` of the series `seed`.

    One to four storeys that overturn, slender ones that lift among them, masses off the centre.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DesignWarning)
        scene = random_rim_scene(seed, number)
    rng = np.random.default_rng((seed, number, 33))
    bearing, bays = scene.bearing, random_bays(rng)
    own = np.random.default_rng((seed, number, 34))
    if unlike:
        bearing = with_unlike_friction(own, bearing)
    places = (bays[0] + 1) * (bays[1] + 1)
    width = bearing.effective_radius * rng.uniform(1.0, 4.0)
    load = bearing.resolved()["design_load"] / STANDARD_GRAVITY * rng.uniform(0.4, 1.6)
    masses, stiffness, base = storey_values(rng, places * load)
    model = shear_building(
        bearing,
        masses,
        stiffness,
        base_mass=base,
        storey_height=float(bearing.effective_radius * rng.uniform(0.5, 2.0)),
        plan=(bays, width),
        eccentricity=tuple(float(share) for share in rng.uniform(-0.05, 0.05, 2)),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionWarning)  # the ground may move on at the end
        x, y, z = scene.waves.T
        motion = GroundMotion(x=x, y=y, z=z if z.any() else None, dt=DT, name="random")
    goal = log_uniform(own, *UNLIKE_GOALS) if unlike else float(rng.uniform(*GOALS))
    return model, bearing, motion, goal


def with_unlike_friction(rng: np.random.Generator, bearing: LIRBearing) -> LIRBearing:
    """Return the bearing, the friction of its two surfaces as unlike as drawn; their mean stays."""
    ratio = log_uniform(rng, *UNLIKE)
    shares = [2.0 * ratio / (1.0 + ratio), 2.0 / (1.0 + ratio)]
    if rng.random() < 0.5:
        shares.reverse()
    bottom, top = (
        replace(law, f_max=share * law.f_max, f_min=share * law.f_min)
        for law, share in zip(bearing.frictions, shares, strict=True)
    )
    high = max(bearing.interface_friction, 1.1 * max(bottom.f_max, top.f_max))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DesignWarning)
        return replace(bearing, friction=(bottom, top), interface_friction=high)


def run_level(
    model: Frame, motion: GroundMotion, factor: float, level: str, dt: float | None = None
) -> xr.Dataset:
    """Analyse the building, horizontal components scaled; failures are results, too."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", MotionWarning)
        scaled = motion.scaled([factor, factor, 1.0])
        return time_history(model, scaled, level=level, dt=dt, recording=Recording(every=None))


def moved(data: xr.Dataset) -> FloatArray:
    """Return the peak displacements of the bearings [m]."""
    return np.asarray(data["reached_displacement"].to_numpy())


def factor_for(
    model: Frame, bearing: LIRBearing, motion: GroundMotion, goal: float
) -> float | None:
    """Return the factor that takes a bearing as far as wanted; None if none does."""
    low, high, factor = 0.0, math.inf, 4.0
    for _ in range(TRIALS):
        data = run_level(model, motion, factor, "pendulum", DT)
        share = float(moved(data).max()) / bearing.lateral_capacity
        is_whole = data.attrs["status"] == "ok"
        if is_whole and abs(share - goal) < min(NEAR, NEAR_SMALL * goal):
            return factor
        if is_whole and share < goal:
            low = factor
        else:
            high = factor
        factor = 0.5 * (low + high) if math.isfinite(high) else 1.6 * factor
    return None
