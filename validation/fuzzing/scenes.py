"""A random test case: a model, a motion and the options of its analysis, from two numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from frames import Frame, ModalDamping, RayleighDamping, lumped_mass, moment_frame, shear_building
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import SIZES, chosen, log_uniform, random_bearing
from validation.fuzzing.motions import random_motion

if TYPE_CHECKING:
    from frames import GroundMotion
    from lir_element import LIRBearing

MODELS = {"mass": 0.72, "tilting mass": 0.06, "stick": 0.09, "stick on a grid": 0.07, "frame": 0.06}
"""Shares of the models."""
LEVELS = {"pendulum": 0.8, "contact": 0.13, "auto": 0.03, "rigid_body": 0.04}
"""Shares of the levels, where a model has the choice."""
MOST_STEPS = 8000
LONGEST_RIGID = 1.5
"""Longest analysis at the level "rigid_body" [s]: its sliders may ring undamped."""

Build: TypeAlias = Callable[[bool], Frame]
"""Makes the model, or its image in a mirror along y."""
Grid: TypeAlias = dict[tuple[int, int], "LIRBearing"]


@dataclass(frozen=True)
class Scene:
    """A model under a motion, and how it is analysed."""

    seed: int
    number: int
    model: str
    build: Build
    motion: GroundMotion
    options: Mapping[str, Any]
    is_axisymmetric: bool
    """Whether the model looks the same from all sides."""
    length: float
    """Smallest effective radius [m]."""

    @property
    def level(self) -> str:
        """Level of fidelity; "mixed" where the bearings differ."""
        given = self.options["level"]
        return given if isinstance(given, str) else "mixed"

    def images(self) -> dict[str, str]:
        """Return by the name of each bearing that of its image in a mirror along y."""
        names = list(self.build(False).bearings)
        if len(names) == 1:
            return {names[0]: names[0]}
        places = {name: tuple(int(part) for part in name.split("-")[1:]) for name in names}
        last = max(iy for _, iy in places.values())
        return {name: f"bearing-{ix}-{last - iy}" for name, (ix, iy) in places.items()}

    def options_of(self, in_mirror: bool) -> Mapping[str, Any]:
        """Return the options of the analysis, or those of the test case seen in a mirror along y."""
        level = self.options["level"]
        if not in_mirror or isinstance(level, str):
            return self.options
        images = self.images()
        return {**self.options, "level": {images[name]: own for name, own in level.items()}}

    @property
    def is_newmark(self) -> bool:
        """Whether the scheme conserves energy and balances the ends of each step."""
        return self.options["integrator"] in {None, "newmark"} and self.level != "rigid_body"

    def describe(self) -> str:
        """Return the test case in a line."""
        dt, scheme = self.options["dt"], self.options["integrator"] or "default"
        if scheme == "generalised-alpha":
            scheme += f" {self.options['spectral_radius']:g}"
        size = "None" if dt is None else f"{1e3 * dt:.3g} ms"
        axes = "".join(a for a in "xyz" if getattr(self.motion, a) is not None)
        return (
            f"{self.model}, L = {self.length:.3g} m, {self.level}, {scheme}, dt = {size}, "
            f"motion {axes} of {self.motion.duration:.3g} s at {1e3 * self.motion.dt:.3g} ms"
        )


def random_scene(seed: int, number: int, level: str | None = None) -> Scene:
    """Return test case `number` of the series `seed`: always the same one."""
    kind = chosen(np.random.default_rng((seed, number, 0)), MODELS)
    rng = np.random.default_rng((seed, number, 1))
    devices, build = _MAKERS[kind](rng)
    length = min(device.effective_radius for device in devices)
    rng = np.random.default_rng((seed, number, 2))
    motion = random_motion(rng, 2.0 * math.pi * math.sqrt(length / STANDARD_GRAVITY))
    options = random_options(np.random.default_rng((seed, number, 3)), kind, motion, build)
    if level is not None:
        options["level"] = level
    return Scene(
        seed=seed,
        number=number,
        model=kind,
        build=build,
        motion=motion,
        options=options,
        is_axisymmetric=len(devices) == 1,
        length=length,
    )


def random_options(
    rng: np.random.Generator, kind: str, motion: GroundMotion, build: Build
) -> dict[str, Any]:
    """Return what `time_history` is called with: level, step, scheme."""
    level: Any = chosen(rng, LEVELS)
    if kind == "tilting mass":
        level = "contact" if rng.random() < 0.6 else "rigid_body"
    elif kind != "mass":
        level = "auto" if rng.random() < 0.06 else "pendulum"
        names = list(build(False).bearings)
        if rng.random() < 0.12:
            level = {str(name): "contact" for name in rng.choice(names, size=1)}
    dt = None
    if rng.random() < 0.65:
        dt = motion.dt * (log_uniform(rng, 0.1, 8.0) if rng.random() < 0.8 else 1.0)
        dt = min(max(dt, motion.duration / MOST_STEPS), 0.1 * motion.duration)
    integrator, radius = None, 0.8
    if level != "rigid_body" and rng.random() < 0.35:
        integrator = "generalised-alpha"
        radius = float(rng.choice([0.0, 0.3, 0.5, 0.8, 0.9, 1.0]))
    elif rng.random() < 0.2 and level != "rigid_body":
        integrator = "newmark"
    duration = motion.duration * (1.0 if rng.random() < 0.8 else rng.uniform(0.3, 1.3))
    if level == "rigid_body":
        duration = min(duration, LONGEST_RIGID)
    return {
        "duration": duration,
        "dt": dt,
        "level": level,
        "integrator": integrator,
        "spectral_radius": radius,
    }


def random_load(rng: np.random.Generator, bearing: LIRBearing) -> float:
    """Return a mass for a bearing [kg]: 2 % to twice of its design load."""
    low, high = (0.02, 0.2) if rng.random() < 0.15 else (0.2, 2.0)
    return bearing.resolved()["design_load"] / STANDARD_GRAVITY * log_uniform(rng, low, high)


def a_mass(rng: np.random.Generator) -> tuple[list[LIRBearing], Build]:
    """Make a mass on one bearing, its plates parallel."""
    bearing = random_bearing(rng)
    mass = random_load(rng, bearing)
    return [bearing], lambda _: lumped_mass(bearing, mass)


def a_tilting_mass(rng: np.random.Generator) -> tuple[list[LIRBearing], Build]:
    """Make a mass on one bearing, free to tilt and to twist."""
    bearing = random_bearing(rng)
    mass = random_load(rng, bearing)
    across, along = (
        mass * (bearing.slider_radius * log_uniform(rng, 0.5, 10.0)) ** 2 for _ in range(2)
    )
    return [bearing], lambda _: lumped_mass(bearing, mass, inertia=(across, across, along))


def storey_values(rng: np.random.Generator, total: float) -> tuple[list[float], list[float], float]:
    """Return masses [kg] and stiffnesses [N/m] of one to four storeys, and the base's mass."""
    count = int(rng.integers(1, 5))
    shares = rng.uniform(0.3, 1.0, count + 1)
    masses = total * shares / shares.sum()
    period = rng.uniform(0.08, 0.8)
    stiffness = masses[1:].sum() * (2.0 * math.pi / period) ** 2 * rng.uniform(0.7, 1.5, count)
    return masses[1:].tolist(), stiffness.tolist(), float(masses[0])


def random_damping(rng: np.random.Generator) -> ModalDamping | RayleighDamping | None:
    """Return none, modal or Rayleigh damping."""
    kind = rng.integers(0, 3)
    if kind == 0:
        return None
    if kind == 1:
        return ModalDamping(log_uniform(rng, 0.005, 0.1))
    return RayleighDamping(log_uniform(rng, 0.005, 0.1), periods=(0.5, 0.05))


def a_stick(rng: np.random.Generator) -> tuple[list[LIRBearing], Build]:
    """Put storeys on one bearing."""
    bearing = random_bearing(rng)
    masses, stiffness, base = storey_values(rng, random_load(rng, bearing))
    damping = random_damping(rng)
    return [bearing], lambda _: shear_building(
        bearing, masses, stiffness, base_mass=base, damping=damping
    )


def random_grid(rng: np.random.Generator, bays: tuple[int, int], size: float) -> Grid:
    """Return bearings for a grid: alike, or a second kind at some places."""
    first = random_bearing(rng, size)
    second = random_bearing(rng, size) if rng.random() < 0.3 else first
    places = [(ix, iy) for ix in range(bays[0] + 1) for iy in range(bays[1] + 1)]
    return {place: second if rng.random() < 0.4 else first for place in places}


def seen(grid: Grid, bays: tuple[int, int], in_mirror: bool) -> Grid:
    """Return the grid, or its image in a mirror along y."""
    if not in_mirror:
        return grid
    return {(ix, iy): grid[ix, bays[1] - iy] for ix, iy in grid}


def random_bays(rng: np.random.Generator) -> tuple[int, int]:
    """Return one or two bays along x and y."""
    return int(rng.integers(1, 3)), int(rng.integers(1, 3))


def a_stick_on_a_grid(rng: np.random.Generator) -> tuple[list[LIRBearing], Build]:
    """Put storeys on a grid of bearings, free to turn about the vertical."""
    bays = random_bays(rng)
    size = log_uniform(rng, *SIZES)
    grid = random_grid(rng, bays, size)
    width = size * rng.uniform(2.0, 6.0)
    loads = [random_load(rng, device) for device in dict.fromkeys(grid.values())]
    masses, stiffness, base = storey_values(rng, len(grid) * min(loads))
    damping = random_damping(rng)
    return list(grid.values()), lambda in_mirror: shear_building(
        seen(grid, bays, in_mirror),
        masses,
        stiffness,
        base_mass=base,
        plan=(bays, width),
        damping=damping,
        overturning=False,  # as the test cases of docs/validation/robustness.md
    )


def a_frame(rng: np.random.Generator) -> tuple[list[LIRBearing], Build]:
    """Make a steel moment frame of one to three storeys on a grid of bearings."""
    bays = random_bays(rng)
    grid = random_grid(rng, bays, log_uniform(rng, 0.6, 3.0))
    storeys, width = int(rng.integers(1, 4)), float(rng.uniform(4.0, 8.0))
    load, damping = float(rng.uniform(400.0, 2000.0)), random_damping(rng)
    return list(grid.values()), lambda in_mirror: moment_frame(
        bays,
        storeys,
        bearing=seen(grid, bays, in_mirror),
        bay_width=width,
        floor_load=load,
        damping=damping,
    )


_MAKERS: dict[str, Callable[[np.random.Generator], tuple[list[LIRBearing], Build]]] = {
    "mass": a_mass,
    "tilting mass": a_tilting_mass,
    "stick": a_stick,
    "stick on a grid": a_stick_on_a_grid,
    "frame": a_frame,
}


def with_yielding_rims(scene: Scene) -> Scene:
    """Return a test case with rims of a drawn strength, in half of the cases with a flange."""
    rng = np.random.default_rng((scene.seed, scene.number, 77))
    flange = 0.05 if rng.random() < 0.5 else None
    share, hardening, overrun = (
        log_uniform(rng, *bounds) for bounds in ((0.02, 1.0), (1e-3, 0.2), (0.003, 0.05))
    )

    def build(in_mirror: bool) -> Frame:
        frame = scene.build(in_mirror)
        changed = {
            name: replace(
                link.bearing,
                rim_yield_force=share * link.bearing.resolved()["design_load"],
                rim_hardening=hardening,
                rim_overrun=overrun,
                flange=flange,
            )
            for name, link in frame.bearings.items()
        }
        return frame.with_bearings(changed)

    return replace(scene, build=build)
