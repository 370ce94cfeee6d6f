"""Random buildings that yield, are damped, braced and run into walls, on bearings that hit rims."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import ModalDamping, moment_frame, shear_building
from frames.laws import Bilinear, BoucWen, Gap, HertzGap, Pinching, PlasticHinge, Tie, ViscousDamper
from lir_element import CoulombFriction, LIRBearing
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import log_uniform
from validation.fuzzing.motions import random_motion

if TYPE_CHECKING:
    from frames import Frame, GroundMotion

PRESSURE = 40e6  # Pa, of the sliders


def random_yielding(seed: int, number: int) -> tuple[Frame, GroundMotion, dict[str, Any], str]:
    """Draw a building that yields, a motion, the options of its analysis, and a line about it."""
    rng = np.random.default_rng((seed, number, 30))
    if rng.random() < 0.5:
        frame, line = _stick(rng)
    else:
        frame, line = _frame(rng)
    more = [add(rng, frame) for share, add in _EXTRAS if rng.random() < share]
    length = next(iter(frame.bearings.values())).bearing.effective_radius
    motion = random_motion(rng, 2.0 * math.pi * math.sqrt(length / STANDARD_GRAVITY))
    peak = max(float(np.abs(motion.components).max()), 1e-9)
    motion = motion.scaled(log_uniform(rng, 2.0, 12.0) / peak)
    dt = None if rng.random() < 0.5 else float(rng.choice([0.002, 0.005, 0.01]))
    options: dict[str, Any] = {"dt": dt, "duration": min(motion.duration, 12.0)}
    if rng.random() < 0.15:
        options["integrator"] = "generalised-alpha"
    words = ", ".join([line, *more, f"dt {dt}", f"{motion.duration:.3g} s"])
    return frame, motion, options, words


def _bearing(rng: np.random.Generator, load: float) -> LIRBearing:
    # The plates' edges rise by about edge^2 / radius together: less than the slider's height.
    slider = math.sqrt(load / PRESSURE / math.pi) * rng.uniform(0.8, 1.3)
    radius, height = rng.uniform(0.8, 2.5), rng.uniform(0.8, 1.2) * slider
    capacity = rng.uniform(0.1, 0.3)
    edge = slider + capacity
    return LIRBearing(
        radius=max(radius, 1.2 * edge * edge / height),
        slider_height=height,
        slider_radius=slider,
        capacity=capacity,
        friction=CoulombFriction(rng.uniform(0.03, 0.09)),
        interface_friction=rng.uniform(0.15, 0.25),
    )


def _law(rng: np.random.Generator, stiffness: float, force: float) -> Bilinear | BoucWen:
    hardening = 0.0 if rng.random() < 0.2 else float(rng.uniform(0.0, 0.1))
    given: dict[str, Any] = {"stiffness": stiffness, "yield_force": force, "hardening": hardening}
    kind = rng.random()
    if kind < 0.4:
        return Bilinear(**given)
    given |= {"exponent": float(rng.uniform(1.0, 6.0)), "shape": float(rng.uniform(0.2, 1.0))}
    if kind < 0.6:
        return BoucWen(**given)
    given |= {"strength_loss": log_uniform(rng, 1e-4, 0.05)}
    given |= {"stiffness_loss": log_uniform(rng, 1e-4, 0.05)}
    pinching = Pinching(slip=float(rng.uniform(0.3, 0.95)), rate=log_uniform(rng, 0.01, 0.5))
    return BoucWen(**given, pinching=pinching if rng.random() < 0.5 else None)


def _stick(rng: np.random.Generator) -> tuple[Frame, str]:
    storeys = int(rng.integers(1, 7))
    mass = log_uniform(rng, 5e4, 1e6)
    period = 0.1 * storeys * rng.uniform(0.4, 1.6)
    stiffness = (2.0 * math.pi / period) ** 2 * mass * storeys**2 / 2.5
    weight = (storeys + 1) * mass * STANDARD_GRAVITY
    share = log_uniform(rng, 0.08, 0.6)

    def law(k: float) -> Bilinear | BoucWen:
        return _law(rng, k, share * weight * storeys / (storeys + 1))

    plan = ((2, 1), 6.0) if rng.random() < 0.4 else None
    frame = shear_building(
        _bearing(rng, weight / (6 if plan else 1)),
        mass,
        stiffness,
        storeys=storeys,
        plan=plan,
        storey_law=law,
        damping=ModalDamping(0.02),
        overturning=False,
        eccentricity=(0.05, 0.0) if plan and rng.random() < 0.5 else (0.0, 0.0),
    )
    return frame, f"stick of {storeys}, yields at {share:.2g} of the weight"


def _frame(rng: np.random.Generator) -> tuple[Frame, str]:
    bays, storeys = (int(rng.integers(1, 3)), int(rng.integers(1, 3))), int(rng.integers(1, 5))
    columns = (bays[0] + 1) * (bays[1] + 1)
    weight = 1450.0 * STANDARD_GRAVITY * 36.0 * bays[0] * bays[1] * (storeys + 1)
    moment = log_uniform(rng, 0.05, 0.5) * weight / columns * 1.75
    hardening = 0.0 if rng.random() < 0.2 else float(rng.uniform(0.001, 0.05))
    steel = PlasticHinge(moment_y=moment * rng.uniform(0.5, 1.0), hardening=hardening)
    column = PlasticHinge(
        moment_y=moment,
        moment_z=moment * rng.uniform(0.4, 1.0),
        hardening=hardening,
        axial=math.inf if rng.random() < 0.4 else weight / columns * rng.uniform(2.0, 8.0),
        axial_exponent=float(rng.uniform(1.0, 2.0)),
    )
    frame = moment_frame(
        bays,
        storeys,
        bearing=_bearing(rng, weight / columns),
        hinges={"beam": steel, "column": column},
    )
    return frame, f"frame {bays[0]} x {bays[1]} x {storeys}, hinges of {moment / 1e3:.3g} kNm"


def _ends(frame: Frame) -> tuple[str, str]:
    # Nodes of the levels below and above the first storey, apart in plan where there are more.
    low, high = frame.levels[0].nodes, frame.levels[1].nodes
    return low[0], high[-1]


def _weight(frame: Frame) -> float:
    return float(sum(values[0] for values in frame.masses.values())) * STANDARD_GRAVITY


def _damper(rng: np.random.Generator, frame: Frame) -> str:
    weight = _weight(frame)
    law = ViscousDamper(
        coefficient=weight * rng.uniform(0.02, 0.2),
        exponent=float(rng.choice([0.3, 0.5, 1.0])),
        stiffness=math.inf if rng.random() < 0.5 else weight * log_uniform(rng, 5.0, 100.0),
    )
    link = next(iter(frame.bearings.values()))
    frame.add_link("damper-base", link.i, link.j, law, "ux")
    frame.add_link("damper-storey", *_ends(frame), law, (1.0, 0.3, 0.0))
    return f"dampers {law.exponent:g}"


def _braces(rng: np.random.Generator, frame: Frame) -> str:
    weight = _weight(frame)
    law = Tie(
        stiffness=weight * log_uniform(rng, 10.0, 200.0),
        yield_force=0.1 * weight,
        hardening=0.01,
        slack=float(rng.choice([0.0, 0.002])),
    )
    low, high = _ends(frame)
    frame.add_link("tie-1", low, high, law, (1.0, 0.0, 0.3))
    frame.add_link("tie-2", low, high, law, (-1.0, 0.0, 0.3))
    return "ties"


def _walls(rng: np.random.Generator, frame: Frame) -> str:
    weight = _weight(frame)
    gap = rng.uniform(0.05, 0.25)
    nodes = list(frame.levels[0].nodes)
    stiffness = weight / len(nodes) * log_uniform(rng, 20.0, 2000.0)
    if rng.random() < 0.5:
        mass = weight / STANDARD_GRAVITY / len(nodes)
        damping = Gap.damping_for(rng.uniform(0.4, 1.0), stiffness, mass)
        frame.add_moat("moat", nodes, Gap(gap=gap, stiffness=stiffness, damping=damping))
    else:
        law = HertzGap(gap=gap, stiffness=5.0 * stiffness, restitution=rng.uniform(0.4, 1.0))
        frame.add_moat("moat", nodes, law)
    return f"walls at {gap:.2f} m"


_EXTRAS = ((0.25, _damper), (0.25, _braces), (0.35, _walls))
