"""Bearings and paths of the property tests: a list of variants, and random smooth motions."""

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from lir_element import (
    CoulombFriction,
    Element,
    Features,
    FrictionHeating,
    LIRBearing,
    PressureDependence,
    VelocityFriction,
)

# Soft contacts (1e8 N/m): the pendulum's stiffness W/L must not drown in that of the contact.
BASE: dict[str, Any] = {
    "radius": (0.75, 1.1),
    "slider_height": 0.11,
    "slider_radius": 0.08,
    "friction": (CoulombFriction(0.05), CoulombFriction(0.08)),
    "interface_friction": 0.15,
    "rims": (0.07, 0.11),
    "axial_stiffness": 1e8,
    "rim_stiffness": 2e7,
    "rim_overrun": 0.05,
    "slip_capacity": 0.4,
    "yield_displacement": 0.5e-3,
    "interface_yield_displacement": 0.3e-3,
    "torsional_friction": False,
}
VELOCITY = (VelocityFriction(0.07, 0.03, 12.0), VelocityFriction(0.09, 0.05, 6.0))
VARIANTS: dict[str, dict[str, Any]] = {
    "coulomb": {},
    "velocity": {"friction": VELOCITY},
    "torsion": {"torsional_friction": True},
    "bouc_wen": {"friction_law": "bouc-wen", "bouc_wen_exponent": 2.0},
    "bouc_wen_velocity": {
        "friction_law": "bouc-wen",
        "bouc_wen_exponent": 4.5,
        "friction": VELOCITY,
        "torsional_friction": True,
        "interface_hold": 4e3,
    },
    "fused": {"interface_friction": math.inf},
    "fused_velocity_torsion": {
        "interface_friction": math.inf,
        "friction": VELOCITY,
        "torsional_friction": True,
    },
    "no_rims": {"rims": None, "capacity": math.inf},
    "one_rim": {"rims": (math.inf, 0.09)},
    "thick_plates": {"plate_thickness": (0.03, 0.08), "friction": VELOCITY, "interface_hold": 2e3},
    "flat_bottom": {"radius": (2.5, 0.6), "rims": (0.2, 0.05)},
    "pressed_and_heated": {
        "friction": VELOCITY,
        "torsional_friction": True,
        "pressure_dependence": PressureDependence(reference_pressure=5e6, rate=4e-8),
        "friction_heating": FrictionHeating(variant="third", initial_temperature=0.0),
    },
}


def random_options(seed: int) -> dict[str, Any]:
    """Return the options of a random valid bearing."""
    rng = np.random.default_rng(seed)
    radius = rng.uniform(0.6, 2.0, 2)
    slow = rng.uniform(0.02, 0.06, 2)
    fast = slow + rng.uniform(0.0, 0.04, 2)
    return BASE | {
        "radius": tuple(radius),
        "slider_height": rng.uniform(0.06, 0.2),
        "slider_radius": rng.uniform(0.05, 0.1),
        "friction": tuple(
            VelocityFriction(f, s, a)
            for f, s, a in zip(fast, slow, rng.uniform(0.0, 20.0, 2), strict=True)
        ),
        "interface_friction": rng.uniform(1.4, 2.0) * fast.max(),
        "rims": tuple(radius * rng.uniform(0.08, 0.14, 2)),
        "friction_law": ("elastic-plastic", "bouc-wen")[seed % 2],
        "bouc_wen_exponent": rng.uniform(1.0, 6.0),
        "torsional_friction": bool(rng.integers(2)),
        "plate_thickness": tuple(rng.uniform(0.0, 0.1, 2)),
        "axial_stiffness": rng.uniform(0.8e8, 1.5e8),
        "rim_stiffness": rng.uniform(1e7, 3e7),
    }


def make(name: str, **changes: object) -> LIRBearing:
    """Return the bearing of a variant, or the random one of 'random-<seed>', with changes."""
    if name.startswith("random-"):
        return LIRBearing(**(random_options(int(name[7:])) | changes))
    return LIRBearing(**(BASE | VARIANTS[name] | changes))


def vertical(bearing: LIRBearing, u: np.ndarray, load: float) -> float:
    """Return u[8] at which the string (without slip) is stretched to `load` (conventions.md)."""
    t_i, t_j = np.broadcast_to(bearing.plate_thickness, 2)
    arm_i = (bearing.radii[0] + t_i) * Rotation.from_rotvec(u[3:6]).as_matrix()[:, 2]
    arm_j = (bearing.radii[1] + t_j) * Rotation.from_rotvec(u[9:12]).as_matrix()[:, 2]
    c = u[6:8] - u[0:2] - arm_i[:2] - arm_j[:2]
    length = bearing.effective_radius + load / bearing.resolved()["axial_stiffness"]
    return u[2] - math.sqrt(length**2 - c @ c) + arm_i[2] + arm_j[2] - bearing.height


def smooth_path(
    bearing: LIRBearing,
    seed: int,
    count: int,
    *,
    reach: float = 1.35,
    tilt: float = 0.008,
    twist: float = 0.02,
    load: float = 1e5,
    swing: float = 0.4,
    duration: float = 2.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Return displacements (count, 12) and times of a random smooth motion that starts at rest.

    `reach` is the largest lateral displacement over the capacity, `swing` the variation of the
    load over its mean: above 1 the bearing lifts off.
    """
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, duration, count)
    s = time[:, None] / duration
    waves = sum(
        rng.normal(size=(1, 12)) * np.sin(2.0 * np.pi * k * s) / k
        + rng.normal(size=(1, 12)) * (1.0 - np.cos(2.0 * np.pi * k * s)) / k
        for k in (1, 2, 3)
    )
    peaks = np.take_along_axis(waves, np.abs(waves).argmax(axis=0)[None], axis=0)
    waves /= -peaks  # largest value -1: the load surely falls to its least
    turns = [tilt, tilt, twist]
    amplitude = np.array([0.05, 0.05, 0.02, *turns, 0.0, 0.0, 0.0, *turns])
    u = amplitude * waves
    capacity = min(bearing.lateral_capacity, 0.15)
    size = np.hypot(waves[:, 6], waves[:, 7]).max()
    u[:, 6:8] = u[:, 0:2] + reach * capacity * waves[:, 6:8] / size
    ramp = np.minimum(1.0, 20.0 * s[:, 0])
    loads = load * ramp * (1.0 + swing * waves[:, 8])
    for row, n in zip(u, loads, strict=True):
        row[8] = vertical(bearing, row, n)
    return u, time


def walk(
    bearing: LIRBearing,
    u: np.ndarray,
    time: np.ndarray,
    names: tuple[str, ...] = (),
    visit: Callable[[Element, int], None] | None = None,
    features: Features | None = None,
    level: str = "pendulum",
) -> SimpleNamespace:
    """Take a new element through a path; return forces (n, 12) and the histories of `names`."""
    element = Element(bearing, level, features=features)
    kept: dict[str, list[Any]] = {name: [] for name in ("resisting", *names)}
    for k in range(len(u)):
        element.set_trial(u[k], np.zeros(12), time[k])
        if visit is not None:
            visit(element, k)
        element.commit()
        kept["resisting"].append(element.resisting_force())
        for name in names:
            kept[name].append(element.response(name))
    return SimpleNamespace(**{k: np.array(v) for k, v in kept.items()}, element=element)


def differences(element: Element, u: np.ndarray, time: float, step: float) -> np.ndarray:
    """Return central differences of fourth order of the resisting forces."""
    k = np.zeros((12, 12))
    for column in range(12):
        for shift, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)):
            moved = u.copy()
            moved[column] += shift * step
            element.set_trial(moved, np.zeros(12), time)
            k[:, column] += weight * element.resisting_force() / (12.0 * step)
    return k


@pytest.fixture(scope="session")
def lab() -> SimpleNamespace:
    """Return the makers of bearings and paths."""
    return SimpleNamespace(make=make, smooth_path=smooth_path, walk=walk, vertical=vertical)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that takes `variant` over the list and a random bearing; four more at night."""
    if "variant" in metafunc.fixturenames:
        at_night = [pytest.param(f"random-{k}", marks=pytest.mark.nightly) for k in range(1, 5)]
        metafunc.parametrize("variant", [*VARIANTS, "random-0", *at_night])
