"""Cases at and beyond the limits of the bearing, for `validation.measurements.hard_cases`.

Sources: the bearing of the paper's numerical example (COMPDYN 2023, section 3.1), changed where the
case says so.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import Frame, GroundMotion, Section, lumped_mass
from lir_element import CoulombFriction, DesignWarning, LIRBearing, VelocityFriction
from lir_element.units import STANDARD_GRAVITY
from validation.scenes import MASS, example_bearing, made

if TYPE_CHECKING:
    from lir_element.layout import Floats

USUAL = (("pendulum", 5e-3), ("contact", 5e-3), ("contact", 1e-3))
SHOCK = 0.1
"""Duration of a shock [s]."""
SHOCK_STEP = 1e-3


@dataclass(frozen=True)
class Case:
    """A model under a motion, and the runs (level, step) made of it."""

    name: str
    model: Frame
    motion: GroundMotion
    duration: float
    runs: tuple[tuple[str, float], ...] = USUAL
    reference: str = "rigid_body"
    """Level of the reference; "contact" is run at a tenth of the smallest step."""


def shock(t: Floats, speed: float, start: float) -> Floats:
    """Return half a sine of acceleration that gives the ground `speed` [m/s]."""
    inside = (t >= start) & (t <= start + SHOCK)
    wave = np.sin(math.pi * (t - start) / SHOCK)
    return np.where(inside, -speed * math.pi / (2.0 * SHOCK) * wave, 0.0)


def take_off(rim_speed: float, distance: float, bearing: LIRBearing) -> float:
    """Return the speed that leaves `rim_speed` after `distance`: friction and pendulum take."""
    lost = 2.0 * bearing.effective_friction * STANDARD_GRAVITY * distance
    lost += STANDARD_GRAVITY / bearing.effective_radius * distance**2
    return math.sqrt(rim_speed**2 + lost)


def impact(speed: float, *, oblique: bool, wide: bool = False) -> Case:
    """Return an impact on the rim at about `speed` [m/s], normal or at some 35 degrees."""
    options = {"slip_capacity": 3.0, "rim_overrun": 0.1} if wide else {}
    bearing = example_bearing(**options)
    reach = bearing.lateral_capacity
    t = np.arange(0.0, 4.0, SHOCK_STEP)
    aside = 0.55 * reach if oblique else 0.0
    across = shock(t, take_off(0.0, aside, bearing), 0.0) if oblique else 0.0 * t
    way = math.sqrt(reach**2 - aside**2)
    start = 0.9 if oblique else 0.0
    along = shock(t, take_off(speed, way, bearing), start)
    motion = GroundMotion(x=along, y=across, dt=SHOCK_STEP, name="shock")
    name = f"{'oblique' if oblique else 'normal'} impact, {speed:g} m/s"
    name += ", wide limits" if wide else ""
    return Case(name, lumped_mass(bearing, MASS), motion, 3.0)


def vertical(name: str, peak: float, period: float, cycles: float, runs: Any = USUAL) -> Case:
    """Return a horizontal pulse with a vertical wave of `peak` [m/s2] and `period` [s]."""
    t = np.arange(0.0, 4.0, 0.001)
    horizontal = made("pulse", 4.0, x=(2.3, 1.7, 1.5)).resampled(0.001).components[: len(t), 0]
    span = cycles * period
    inside = np.clip((t - 0.6) / span, 0.0, 1.0)
    wave = peak * np.sin(math.pi * inside) ** 0.5 * np.sin(2.0 * math.pi * (t - 0.6) / period)
    motion = GroundMotion(x=horizontal[: len(t)], z=wave, dt=0.001, name=name)
    return Case(name, lumped_mass(example_bearing(), MASS), motion, 4.0, runs)


def pulsed(name: str, bearing: LIRBearing, peak: float = 2.5, **options: Any) -> Case:
    """Return two horizontal pulses that meet the rims, on a given bearing."""
    motion = made("two pulses", 5.0, x=(peak, 1.7, 1.5), y=(0.6 * peak, 1.3, 1.9))
    return Case(name, lumped_mass(bearing, MASS), motion, 5.0, **options)


def weak(mu_h: float) -> LIRBearing:
    """Return a bearing whose interface is barely stronger than its surfaces."""
    with warnings.catch_warnings(action="ignore", category=DesignWarning):
        return example_bearing(interface_friction=mu_h)


def scaled(name: str, size: float) -> Case:
    """Return the example bearing times `size`, under a motion of scaled time."""
    bearing = LIRBearing(
        radius=1.185 * size,
        slider_height=0.12 * size,
        slider_radius=0.15 * size,
        capacity=0.25 * size,
        friction=VelocityFriction(0.065, 0.0325, 15.0 / math.sqrt(size)),
        interface_friction=0.13,
        yield_displacement=0.25e-3 * min(size, 1.0),
        interface_yield_displacement=0.01e-3 * min(size, 1.0),
    )
    motion = made("two pulses", 5.0, x=(2.5, 1.7, 1.5), y=(1.5, 1.3, 1.9))
    pace = math.sqrt(size)
    quick = GroundMotion(
        x=motion.components[:, 0], y=motion.components[:, 1], dt=motion.dt * pace, name="pulses"
    )
    runs = tuple((level, dt * pace) for level, dt in USUAL)
    return Case(name, lumped_mass(bearing, MASS * size**2), quick, 5.0 * pace, runs)


def stiffness(factor: float) -> Case:
    """Return the example with axial and rim stiffness times `factor`."""
    own = example_bearing().resolved()
    bearing = example_bearing(
        axial_stiffness=factor * own["axial_stiffness"],
        rim_stiffness=factor * own["rim_stiffness"],
        rim_overrun=0.1,
    )
    return pulsed(f"contact stiffness times {factor:g}", bearing)


def tilting(softness: float) -> Case:
    """Return a deck on a bearing whose lower plate turns with the head of a column."""
    inertia = 6e-3 / softness
    section = Section(
        area=0.2,
        inertia_y=inertia,
        inertia_z=inertia,
        torsion_constant=2.0 * inertia,
        elastic_modulus=2e11,
        shear_modulus=8e10,
    )
    bearing = example_bearing(capacity=0.15)
    frame = Frame("pier")
    frame.add_node("foot", 0.0, 0.0, -5.0)
    frame.fix("foot", "all")
    frame.add_node("head", 0.0, 0.0, 0.0)
    frame.add_member("column", "foot", "head", section)
    frame.add_mass("head", 5e3, (1e3, 1e3, 1e3))
    frame.add_node("deck", 0.0, 0.0, bearing.height)
    frame.fix("deck", "rx", "ry", "rz")
    frame.add_mass("deck", MASS)
    frame.add_bearing("bearing", "head", "deck", bearing)
    motion = made("two pulses", 4.0, x=(2.5, 1.4, 1.3), y=(1.8, 1.2, 1.6))
    return Case(
        f"plate on a column, softness {softness:g}", frame, motion, 4.0, reference="contact"
    )


def steps() -> Case:
    """Return an impact at steps over almost four orders."""
    sizes = (5e-2, 2e-2, 1e-2, 1e-3, 1e-4, 1e-5)
    runs = tuple((level, dt) for level in ("pendulum", "contact") for dt in sizes)
    case = impact(0.5, oblique=False)
    return Case("steps, normal impact", case.model, case.motion, 1.0, runs)


def creeping() -> Case:
    """Return a force that rises slowly through the strength of friction: stick and slip."""
    t = np.arange(0.0, 20.0, 0.01)
    motion = GroundMotion(x=-0.9 * t / 20.0, dt=0.01, name="rising force")
    bearing = example_bearing(friction=CoulombFriction(0.065))
    return Case("force rising slowly through friction", lumped_mass(bearing, MASS), motion, 20.0)


def cases() -> list[Case]:
    """Return all cases that are time histories."""
    speeds = (0.1, 0.3, 1.0, 3.0)
    return [
        *(impact(v, oblique=oblique) for oblique in (False, True) for v in speeds),
        *(impact(v, oblique=False, wide=True) for v in (1.0, 3.0)),
        impact(3.0, oblique=True, wide=True),
        vertical("axial load down to zero", 9.9, 0.5, 6.0),
        vertical("uplift and landing, 2 g", 20.0, 0.3, 8.0),
        vertical("vertical at 30 Hz", 8.0, 1.0 / 30.0, 60.0),
        vertical("vertical at 38 Hz, resonance", 4.0, 1.0 / 38.0, 60.0),
        vertical("vertical at 80 Hz", 15.0, 1.0 / 80.0, 120.0),
        pulsed("mu_h = 0.066, mu_d = 0.065", weak(0.066), 2.0),
        pulsed("mu_h = 0.075, mu_d = 0.065", weak(0.075), 2.0),
        pulsed("interface to its limit", example_bearing(), 3.5),
        creeping(),
        pulsed("rigid slider, hard rims", example_bearing(rim_overrun=0.1).as_dcfp(), 2.8),
        pulsed(
            "contacts without dampers, four points",
            example_bearing(axial_damping=0.0, rim_damping=0.0, contact_points=4),
        ),
        pulsed("Bouc-Wen friction", example_bearing(friction_law="bouc-wen")),
        pulsed("sliders of a hundredth of their mass", example_bearing(slider_density=78.5)),
        pulsed(
            "yield displacements of a hundredth",
            example_bearing(yield_displacement=2.5e-6, interface_yield_displacement=1e-7),
        ),
        *(stiffness(factor) for factor in (0.01, 0.1, 1.0, 10.0, 100.0)),
        steps(),
        tilting(1.0),
        tilting(10.0),
        scaled("model scale, 1:20", 0.05),
        scaled("bridge scale, 5:1", 5.0),
    ]
