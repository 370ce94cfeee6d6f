"""The sliders as bodies: mass, inertia and contact points from a bearing's geometry."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from lir_element.argument_checks import as_pair
from lir_element.device.bearing import STANDARD_GRAVITY, LIRBearing
from lir_element.layout import BODIES, POINT, SLIDERS, TOUCH, Floats, Records

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

INTERFACES = 3
"""Bottom surface, plane interface, top surface: in series along the slider's axis."""


def half_slider(
    radius: float, sphere: float, height: float, density: float
) -> tuple[float, float, tuple[float, float]]:
    """Return mass, place and inertia of one half of the slider: a plane and a spherical cap."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    r = 0.5 * radius * (nodes + 1.0)
    dr = 0.5 * radius * weights
    low = sphere - np.sqrt(sphere**2 - r**2)
    ring = 2.0 * math.pi * density * r * dr
    mass = float(np.sum(ring * (height - low)))
    centre = float(np.sum(ring * 0.5 * (height**2 - low**2))) / mass
    axial = float(np.sum(ring * r**2 * (height - low)))
    upright = float(np.sum(ring * (height**3 - low**3))) / 3.0
    return mass, centre, (0.5 * axial + upright - mass * centre**2, axial)


def ring_points(count: int, radius: float) -> tuple[Floats, Floats]:
    """Return the contact points of an interface in plan."""
    rings = 1 if count < 8 else 2 if count <= 64 else count // 32
    each = count // rings
    where, weight = np.ones(1), np.ones(1)
    if rings > 1:  # over 0 < r < 1 with the weight 2 r, one place at r = 1
        from scipy.special import roots_jacobi  # a tenth of the time of `import frames`

        x, own = roots_jacobi(rings - 1, 1.0, 1.0)
        own = 0.5 * own / (1.0 - x)
        where = np.append(0.5 * (1.0 + x), 1.0)[::-1]
        weight = np.append(own, 1.0 - own.sum())[::-1]
    plan, share = [], []
    for k, (r, part) in enumerate(zip(where, weight, strict=True)):  # outermost first
        angle = 2.0 * math.pi * np.arange(each) / each + (k % 2) * math.pi / each
        plan.append(radius * r * np.column_stack([np.cos(angle), np.sin(angle)]))
        share.append(np.full(each, part / each))
    return np.concatenate(plan), np.concatenate(share)


def gripping(plan: Floats, share: Floats, sphere: float) -> float:
    """Return the friction of a pressed cap over ``mu N``, if each of its points has mu.

    Pressures point to the sphere's centre, so that their sum exceeds the axial force; the lever of
    friction about that centre is shorter off the line of sliding. docs/theory.md, Eq. (7.7).

    Shapes: plan (n, 2), share (n,).
    """
    upright = np.sqrt(1.0 - np.sum(plan**2, axis=1) / sphere**2)
    lever = np.sqrt(1.0 - plan**2 / sphere**2).mean(axis=1)
    return float(np.sum(share * upright * lever) / np.sum(share * upright**2))


def interface_height(
    radii: ArrayLike, slider_radius: ArrayLike, slider_height: ArrayLike
) -> Floats:
    """Return the height of the interface over the vertex of the bottom cap, on the axis.

    The edges of both sliders are equally high: with the caps' heights ``c = R - sqrt(R^2 - a^2)``,
    ``h_b - c_1 = (h - h_b) - c_2``, so ``h_b = (h + c_1 - c_2) / 2``.

    Shapes: radii (..., 2).
    """
    spheres, edge = np.asarray(radii, dtype=np.float64), np.asarray(slider_radius)[..., None]
    caps = edge**2 / (spheres + np.sqrt(spheres**2 - edge**2))  # R - sqrt(R^2 - a^2)
    return np.asarray(0.5 * (np.asarray(slider_height) + (caps[..., 0] - caps[..., 1])))


def slider_record(bearing: LIRBearing, gravity: float = STANDARD_GRAVITY) -> Records:
    """Return the sliders' constants, a record array of shape (1,)."""
    first, second = bearing.radii
    lower = float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))
    upper = bearing.slider_height - lower
    thickness = as_pair("plate_thickness", bearing.plate_thickness)
    bodies = [
        half_slider(bearing.slider_radius, sphere, height, bearing.slider_density)
        for sphere, height in ((first, lower), (second, upper))
    ]
    given_mass = as_pair("slider_mass", bearing.slider_mass)
    record = np.zeros(1, dtype=SLIDERS)
    for k, (mass, _, (across, along)) in enumerate(bodies):
        own = given_mass[k]
        scale = 1.0 if own is None else float(own) / mass
        record["mass"][0, k] = scale * mass
        moments = (scale * across, scale * along)
        if bearing.slider_inertia is not None:
            moments = bearing.slider_inertia[k]
        record["inertia"][0, k] = moments[0], moments[0], moments[1]
    bottom = -first + bodies[0][1]
    top = -first + bearing.slider_height - bodies[1][1]
    interface = -first + lower
    record["place"][0, :, 2] = (
        -first - thickness[0],
        bottom,
        top,
        -first + bearing.slider_height + thickness[1],
    )
    record["plane"][0] = interface - bottom, interface - top
    record["vertex"][0] = -first - bottom, -first + bearing.slider_height - top
    record["grip"][0] = 1.0
    if bearing.contact_points is not None:
        plan, share = ring_points(bearing.contact_points, bearing.slider_radius)
        record["grip"][0] = [1.0 / gripping(plan, share, sphere) for sphere in bearing.radii]
    options = bearing.resolved()
    record["stiffness"] = INTERFACES * options["axial_stiffness"]
    record["damping"] = INTERFACES * options["axial_damping"]
    record["radius"] = bearing.slider_radius
    record["gravity"] = gravity
    return record


def face_records(bearing: LIRBearing) -> tuple[Records, Records]:
    """Return the sliders' faces as discs or contact points, and their state undeformed."""
    if bearing.contact_points is None:
        return _discs(bearing)
    points = point_records(bearing, bearing.contact_points)
    return points, initial_touches(bearing, points)


def point_records(bearing: LIRBearing, count: int) -> Records:
    """Return `count` contact points a face of a bearing, a record array of shape (1, 3 n)."""
    plan, share = ring_points(count, bearing.slider_radius)
    sliders = slider_record(bearing)
    count = len(plan)
    points = np.zeros((1, INTERFACES * count), dtype=POINT)
    square = np.sum(plan**2, axis=1)
    first, second = bearing.radii
    caps = (
        sliders["vertex"][0, 0] + first - np.sqrt(first**2 - square),
        np.full(count, sliders["plane"][0, 1]),
        sliders["vertex"][0, 1] - second + np.sqrt(second**2 - square),
    )
    for pair, height in enumerate(caps):
        part = slice(pair * count, (pair + 1) * count)
        points["pair"][0, part] = pair
        points["arm"][0, part, :2] = plan
        points["arm"][0, part, 2] = height
        points["share"][0, part] = share
    return points


def _discs(bearing: LIRBearing) -> tuple[Records, Records]:
    # A disc has the friction coefficient of its surface: no correction by (7.7).
    sliders = slider_record(bearing)
    discs = np.zeros((1, INTERFACES), dtype=POINT)
    discs["pair"][0] = range(INTERFACES)
    discs["share"], discs["disc"] = 1.0, bearing.slider_radius
    vertex, plane = sliders["vertex"][0], sliders["plane"][0]
    discs["arm"][0, :, 2] = vertex[0], plane[1], vertex[1]
    touches = np.zeros((1, INTERFACES), dtype=TOUCH)
    touches["spot"][0, :, 2] = -bearing.radii[0], 0.0, bearing.radii[1]
    touches["axes"][0, :] = np.eye(2, 3)
    return discs, touches


def initial_bodies(count: int) -> Records:
    """Return the state (count,) of undisplaced bodies at rest."""
    bodies = np.zeros(count, dtype=BODIES)
    bodies["turn"][:, :, 0] = 1.0
    return bodies


def initial_touches(bearing: LIRBearing, points: Records) -> Records:
    """Return the state (1, 3 n) of the contact points of an undeformed bearing."""
    sliders = slider_record(bearing)
    touches = np.zeros(points.shape, dtype=TOUCH)
    arm = points["arm"][0]
    place = sliders["place"][0]
    centres: Sequence[float] = (0.0, 0.0, -bearing.effective_radius)
    for pair, body in enumerate((1, 2, 2)):
        chosen = points["pair"][0] == pair
        spot = arm[chosen].copy()
        if pair == 1:
            spot[:, 2] = 0.0
        else:
            spot[:, 2] += place[body, 2] - centres[pair]
            spot /= np.linalg.norm(spot, axis=1)[:, None]
        touches["spot"][0, chosen] = spot
    return touches
