"""Random bearings, from a twentieth of the usual size to bridges: unequal in everything."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from lir_element import CoulombFriction, LIRBearing, VelocityFriction

if TYPE_CHECKING:
    import numpy as np


SIZES = (0.05, 5.0)
"""Smallest and largest of the mean radius [m]."""
KINDS = {"lir": 0.65, "dcfp": 0.2, "no rims": 0.08, "dcfp, no rims": 0.07}
"""Shares of the kinds of bearing."""


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Return a number between `low` and `high` whose logarithm is uniform."""
    return float(10.0 ** rng.uniform(math.log10(low), math.log10(high)))


def chosen(rng: np.random.Generator, shares: dict[Any, float]) -> Any:
    """Return a key of `shares`, drawn by its share."""
    keys, weights = list(shares), list(shares.values())
    place = rng.choice(len(keys), p=[weight / sum(weights) for weight in weights])
    return keys[int(place)]


def random_friction(rng: np.random.Generator) -> CoulombFriction | VelocityFriction:
    """Return the friction of a surface: 0.5 to 20 %, none in a few."""
    mu = 0.0 if rng.random() < 0.02 else log_uniform(rng, 0.005, 0.2)
    if rng.random() < 0.35:
        return CoulombFriction(mu)
    return VelocityFriction(mu, rng.uniform(0.2, 1.0) * mu, log_uniform(rng, 1.0, 300.0))


def fitting_rims(
    rng: np.random.Generator, radii: tuple[float, float], height: float, slider: float
) -> tuple[float, float]:
    """Return sliding displacements at the rims whose plates do not meet each other at rest."""
    shares = rng.uniform(0.03, 0.3, 2)
    if rng.random() < 0.5:
        shares[1] = shares[0]
    edges = [s * r + slider for s, r in zip(shares, radii, strict=True)]
    while sum(r - math.sqrt(r * r - e * e) for r, e in zip(radii, edges, strict=True)) > (
        0.9 * height
    ):
        shares *= 0.9
        edges = [s * r + slider for s, r in zip(shares, radii, strict=True)]
    return float(shares[0] * radii[0]), float(shares[1] * radii[1])


def random_bearing(rng: np.random.Generator, size: float | None = None) -> LIRBearing:
    """Draw a bearing that can be built, with everything that an engineer can choose."""
    size = log_uniform(rng, *SIZES) if size is None else size
    ratio = 1.0 if rng.random() < 0.4 else rng.uniform(0.5, 2.0)
    radii = (2.0 * size / (1.0 + ratio), 2.0 * size * ratio / (1.0 + ratio))
    height = rng.uniform(0.06, 0.25) * min(radii)
    slider = rng.uniform(0.3, 0.9) * height
    laws = (random_friction(rng), random_friction(rng))
    if rng.random() < 0.5:
        laws = (laws[0], laws[0])
    kind = chosen(rng, KINDS)
    moment = sum(law.f_max * r for law, r in zip(laws, radii, strict=True))
    least = max(moment / (sum(radii) - height), *(law.f_max for law in laws), 0.01)
    rims = fitting_rims(rng, radii, height, slider)
    length = sum(radii) - height
    options: dict[str, Any] = {"capacity": length * min(rims[0] / radii[0], rims[1] / radii[1])}
    if rng.random() < 0.4:
        options = {"rims": rims}
    if "no rims" in kind:
        options = {"capacity": math.inf}
    yielding = log_uniform(rng, 1e-5, 1e-3) * (1.0 if rng.random() < 0.5 else size)
    bearing = LIRBearing(
        radius=radii,
        slider_height=height,
        slider_radius=slider,
        friction=laws,
        interface_friction=min(least * rng.uniform(1.03, 4.0), 0.9),
        yield_displacement=yielding,
        interface_yield_displacement=yielding * log_uniform(rng, 0.02, 1.0),
        friction_law="bouc-wen" if rng.random() < 0.2 else "elastic-plastic",
        bouc_wen_exponent=float(rng.choice([1.0, 2.0, 4.0, 10.0])),
        torsional_friction=bool(rng.random() < 0.8),
        plate_thickness=0.0 if rng.random() < 0.7 else (0.1 * height, 0.3 * height),
        **options,
        **random_contacts(rng),
    )
    return bearing.as_dcfp() if "dcfp" in kind else bearing


def random_contacts(rng: np.random.Generator) -> dict[str, Any]:
    """Return the options of contacts and rims: mostly the defaults."""
    options: dict[str, Any] = {}
    if rng.random() < 0.2:
        options["rim_damping"] = 0.0
    if rng.random() < 0.1:
        options["axial_damping"] = 0.0
    if rng.random() < 0.15:
        options["contact_points"] = int(rng.choice([4, 16]))
    if rng.random() < 0.1:
        options["slider_density"] = log_uniform(rng, 2000.0, 20000.0)
    return options
