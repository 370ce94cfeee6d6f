"""A random building on a grid of bearings, brought near its rims or beyond: for levels compared."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames import GroundMotion, MotionWarning, Recording, lumped_mass, shear_building, time_history
from lir_element import AnalysisWarning, DesignWarning, LIRBearing, VelocityFriction
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import log_uniform
from validation.fuzzing.scenes import random_bays, storey_values

if TYPE_CHECKING:
    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray

LEVEL_GOALS = (0.6, 1.25)
"""Least and largest of the peak displacement, over the one at which rims are met [-]."""
UNLIKE_GOALS = (0.06, 1.2)
"""The same where the surfaces are of unlike friction, which matters at small displacements, too."""
UNLIKE = (1.03, 5.0)
"""Least and largest ratio of their coefficients of friction [-]."""
LEVEL_NEAR, NEAR_SMALL = 0.05, 0.1
"""Of the goal: in its own unit, over the goal."""
LEVEL_TRIALS = 12


def random_level_scene(
    seed: int, number: int, *, unlike: bool = False
) -> tuple[Frame, LIRBearing, GroundMotion, float]:
    """Return building, bearing, motion and goal of test case `number` of the series `seed`.

    One to four storeys that overturn, slender ones that lift among them, masses off the centre.
    """
    with warnings.catch_warnings(action="ignore", category=DesignWarning):
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
    height = float(bearing.effective_radius * rng.uniform(0.5, 2.0))
    off_x, off_y = rng.uniform(-0.05, 0.05, 2).tolist()
    model = shear_building(
        bearing,
        masses,
        stiffness,
        base_mass=base,
        storey_height=height,
        plan=(bays, width),
        eccentricity=(off_x, off_y),
    )
    with warnings.catch_warnings(
        action="ignore", category=MotionWarning
    ):  # the ground may move on at the end
        x, y, z = scene.waves.T
        motion = GroundMotion(x=x, y=y, z=z if z.any() else None, dt=DT, name="random")
    goal = log_uniform(own, *UNLIKE_GOALS) if unlike else float(rng.uniform(*LEVEL_GOALS))
    return model, bearing, motion, goal


def with_unlike_friction(rng: np.random.Generator, bearing: LIRBearing) -> LIRBearing:
    """Return the bearing, the friction of its two surfaces as unlike as drawn; their mean stays."""
    ratio = log_uniform(rng, *UNLIKE)
    shares = [2.0 * ratio / (1.0 + ratio), 2.0 / (1.0 + ratio)]
    if rng.random() < 0.5:
        shares.reverse()
    laws: tuple[Any, ...] = bearing.frictions
    bottom, top = (
        replace(law, f_max=share * law.f_max, f_min=share * law.f_min)
        for law, share in zip(laws, shares, strict=True)
    )
    high = max(bearing.interface_friction, 1.1 * max(bottom.f_max, top.f_max))
    with warnings.catch_warnings(action="ignore", category=DesignWarning):
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
    return np.asarray(data["peak_displacement"].to_numpy())


def factor_for(
    model: Frame, bearing: LIRBearing, motion: GroundMotion, goal: float
) -> float | None:
    """Return the factor that takes a bearing as far as wanted; None if none does."""
    low, high, factor = 0.0, math.inf, 4.0
    for _ in range(LEVEL_TRIALS):
        data = run_level(model, motion, factor, "pendulum", DT)
        share = float(moved(data).max()) / bearing.lateral_capacity
        is_whole = data.attrs["status"] == "ok"
        if is_whole and abs(share - goal) < min(LEVEL_NEAR, NEAR_SMALL * goal):
            return factor
        if is_whole and share < goal:
            low = factor
        else:
            high = factor
        factor = 0.5 * (low + high) if math.isfinite(high) else 1.6 * factor
    return None


DT = 0.005  # s
GOALS = (1.02, 1.3)
"""Least and largest of the peak displacement, over the one at which a rim is met [-]."""
NEAR = 0.05
"""Of the goal."""
TRIALS = 18
UNEQUAL_RADII, UNEQUAL_RIMS, VERTICAL = 0.3, 0.15, 0.4
"""Shares of test cases with radii that differ, with rims that differ, with three components."""


class RimScene(NamedTuple):
    """A mass on a bearing, and the motion along x, y and z that shakes it."""

    number: int
    model: Frame
    bearing: LIRBearing
    waves: FloatArray
    """(n_steps, 3) [m/s2]; the third is not scaled."""
    goal: float

    def motion(self, factor: float) -> GroundMotion:
        """Return the motion, its horizontal components scaled."""
        x, y = (factor * self.waves[:, k] for k in range(2))
        z = self.waves[:, 2]
        with warnings.catch_warnings(
            action="ignore", category=MotionWarning
        ):  # the ground may move on at the end
            return GroundMotion(x=x, y=y, z=z if z.any() else None, dt=DT, name="random")

    def run(self, factor: float, level: str, dt: float | None = None) -> xr.Dataset:
        """Analyse the test case; failures are results, too."""
        with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
            return time_history(self.model, self.motion(factor), level=level, dt=dt)


def random_rim_bearing(rng: np.random.Generator) -> LIRBearing:
    """Draw a bearing of usual proportions."""
    size = rng.uniform(0.6, 2.5)
    ratio = rng.uniform(0.7, 1.4) if rng.random() < UNEQUAL_RADII else 1.0
    radii = (2.0 * size / (1.0 + ratio), 2.0 * size * ratio / (1.0 + ratio))
    height, slider = rng.uniform(0.07, 0.16) * size, rng.uniform(0.06, 0.15) * size
    mu = rng.uniform(0.03, 0.09)
    law = VelocityFriction(mu, rng.uniform(0.5, 1.0) * mu, rng.uniform(15.0, 100.0))
    length = sum(radii) - height
    high, capacity = mu + rng.uniform(0.03, 0.13), rng.uniform(0.12, 0.25) * length
    edges = [capacity * r / length + slider for r in radii]
    while sum(r - math.sqrt(r * r - e * e) for r, e in zip(radii, edges, strict=True)) > height:
        capacity *= 0.9  # plates that would meet each other at rest
        edges = [capacity * r / length + slider for r in radii]
    shares = [1.0, 1.0]
    if rng.random() < UNEQUAL_RIMS:
        shares[int(rng.integers(2))] = rng.uniform(0.75, 0.98)
    rims = tuple(s * capacity * r / length for s, r in zip(shares, radii, strict=True))
    return LIRBearing(
        radius=radii,
        slider_height=height,
        slider_radius=slider,
        friction=law,
        interface_friction=high,
        rims=(rims[0], rims[1]),
    )


def random_rim_scene(seed: int, number: int) -> RimScene:
    """Return test case `number` of the series `seed`: always the same one."""
    rng = np.random.default_rng((seed, number))
    bearing = random_rim_bearing(rng)
    mass = bearing.resolved()["design_load"] / STANDARD_GRAVITY * rng.uniform(0.3, 2.0)
    t = np.arange(0.0, min(6.0 * bearing.period, 16.0), DT)
    waves = np.zeros((len(t), 3))
    for k in range(2):
        for _ in range(int(rng.integers(1, 4))):
            own = bearing.period * 10.0 ** rng.uniform(-0.7, 0.1)
            centre, width = rng.uniform(0.15, 0.7) * t[-1], own * rng.uniform(0.5, 2.0)
            bell = rng.uniform(0.3, 1.0) * np.exp(-(((t - centre) / width) ** 2))
            waves[:, k] += bell * np.sin(2.0 * math.pi * t / own + rng.uniform(0.0, 6.3))
        noise = np.convolve(rng.normal(size=len(t)), np.ones(20) / 20.0, mode="same")
        waves[:, k] += 0.3 * noise / np.abs(noise).max()
        waves[:, k] *= rng.uniform(0.3, 1.0)
    if rng.random() < VERTICAL:
        noise = np.convolve(rng.normal(size=len(t)), np.ones(8) / 8.0, mode="same")
        bell = np.exp(-(((t / t[-1] - 0.4) / 0.3) ** 2))
        waves[:, 2] = rng.uniform(0.1, 0.7) * STANDARD_GRAVITY * noise / np.abs(noise).max() * bell
    goal = float(rng.uniform(*GOALS))
    return RimScene(number, lumped_mass(bearing, float(mass)), bearing, waves, goal)


def meeting(scene: RimScene) -> float | None:
    """Return the factor at which the slider meets its rims as far as wanted; None if none does."""
    low, high, factor = 0.0, math.inf, 4.0
    for _ in range(TRIALS):
        data = scene.run(factor, "pendulum", DT)
        moves = data["bearing_displacement"].to_numpy()[:, 0, :2]
        share = float(np.linalg.norm(moves, axis=-1).max()) / scene.bearing.lateral_capacity
        if data.attrs["status"] == "ok" and abs(share - scene.goal) < NEAR:
            return factor
        if data.attrs["status"] == "ok" and share < scene.goal:
            low = factor
        else:
            high = factor
        factor = 0.5 * (low + high) if math.isfinite(high) else 1.6 * factor
    return None
