"""Positions of a bearing's bodies: numbers for drawing its vertical section to scale.

The section is in one vertical plane through the bottom plate's axis; a point is (horizontal,
vertical), in m, from the vertex of the bottom concave surface. Displacements across that plane are
left out. Notation and signs: docs/conventions.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from lir_element.device.sliders import interface_height

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray


_ARC_POINTS = 121
RIM_SHARE = 0.5
"""Default height of the rims over the free height: a proposal."""
BODIES = ("bottom plate", "bottom slider", "top slider", "top plate")


class Geometry(Protocol):
    """A bearing, as far as it is drawn: a `Device`, or a LIRBearing (all lengths in m)."""

    @property
    def radii(self) -> tuple[float, float]:
        """Radius of the bottom and of the top surface."""

    @property
    def slider_height(self) -> float:
        """Height of the whole slider on its axis."""

    @property
    def slider_radius(self) -> float:
        """Radius of the slider in plan."""

    @property
    def rim_displacement(self) -> tuple[float, float]:
        """Sliding at rim contact."""

    @property
    def is_dcfp(self) -> bool:
        """True if the slider is rigid."""


@dataclass(frozen=True)
class Posture:
    """A bearing's bodies in the plane of the section."""

    axis: FloatArray  # (2,) unit vector n of the slider, upwards
    # (2,) unit vector of the top plate e_j, upwards; that of the bottom plate is (0, 1)
    plate_axis: FloatArray
    slip: float  # interface slip of the top slider on the bottom one, along `across` [m]
    # gap that has opened between the top slider and the top plate, along `axis` [m]
    lift: float = 0.0
    # how far the top plate of a bearing that has lifted has gone on without the slider, along
    # `across` [m]
    aside: float = 0.0

    @property
    def across(self) -> FloatArray:
        """Unit vector in the interface, to the right."""
        return np.array([self.axis[1], -self.axis[0]])


AT_REST = Posture(axis=np.array([0.0, 1.0]), plate_axis=np.array([0.0, 1.0]), slip=0.0)


def posture(
    data: xr.Dataset, bearing: Geometry, name: str, time: float, direction: FloatArray
) -> Posture:
    """Return the bodies at an instant, projected on a vertical plane.

    Shapes: direction (2,).
    """
    place = int(np.argmin(np.abs(data["time"].to_numpy() - time)))
    now = movement(data.isel(time=[place]), bearing, name)
    flat, slip = _in_plane(now.axis[0], direction), now.slip[0]
    across = np.array([flat[1], -flat[0]])
    inside = np.array([slip[:2] @ direction, slip[2]])
    plate, gone = _in_plane(now.plate_axis[0], direction), now.opening[0]
    apart = np.array([gone[:2] @ direction, gone[2]])
    lift, aside = max(0.0, float(apart @ flat)), float(apart @ across)
    return Posture(flat, plate, float(inside @ across), lift, aside)


def contact_points(bearing: Geometry, now: Posture) -> dict[str, FloatArray]:
    """Return the points that fix the bodies, shape (2,) each [m]."""
    r_1, r_2 = bearing.radii
    centre = np.array([0.0, r_1])
    bottom = centre - r_1 * now.axis
    middle = bottom + plane_height(bearing) * now.axis
    middle_top = middle + now.slip * now.across
    top = middle_top + (bearing.slider_height - plane_height(bearing)) * now.axis
    centre_top = top + (now.lift - r_2) * now.axis + now.aside * now.across
    return {
        "centre bottom": centre,
        "centre top": centre_top,
        "bottom": bottom,
        "top": top,
        "interface bottom": middle,
        "interface top": middle_top,
        "vertex": centre_top + r_2 * now.plate_axis,
    }


def plane_height(bearing: Geometry) -> float:
    """Return the height of the interface over the bottom contact, along the axis [m]."""
    return float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))


def rim_face(bearing: Geometry, surface: int) -> float:
    """Return the distance of a rim's inner face from the plate's axis [m].

    The slider's edge, `slider_radius` from its axis on the sphere, is there when the axis has slid
    by `rim_displacement`.
    """
    reach = bearing.rim_displacement[surface] / bearing.radii[surface]
    return slider_edge(bearing, surface, math.asin(reach)) if math.isfinite(reach) else math.inf


def slider_edge(bearing: Geometry, surface: int, turn: float) -> float:
    """Return the distance of the turned slider's edge from the plate's axis [m]."""
    radius = bearing.radii[surface]
    return radius * math.sin(turn + math.asin(bearing.slider_radius / radius))


def rim_gap(bearing: Geometry, now: Posture, surface: int) -> float:
    """Return the distance from the slider's edge to the nearer rim face [m]."""
    return rim_face(bearing, surface) - slider_edge(bearing, surface, abs(_turn(now, surface)))


def rim_height(bearing: Geometry) -> float:
    """Return a height of the rims over the plates' edges that leaves all bodies free [m].

    The model does not contain it: this one is a proposal.
    """
    faces = [rim_face(bearing, k) for k in (0, 1)]
    if not all(math.isfinite(face) for face in faces):
        return 0.0
    free = bearing.slider_height - sum(
        _sagitta(r, face) for r, face in zip(bearing.radii, faces, strict=True)
    )
    lower = plane_height(bearing)
    edges = (
        lower - _sagitta(bearing.radii[0], bearing.slider_radius),
        bearing.slider_height - lower - _sagitta(bearing.radii[1], bearing.slider_radius),
    )
    return RIM_SHARE * max(0.0, min(0.5 * free, *edges))


class Plates(NamedTuple):
    """Dimensions of the bottom and the top plate that a bearing's model does not depend on [m]."""

    thickness: tuple[float, float]  # at the vertex of the concave surface
    wall: float  # width of a rim in plan
    rim: float  # height of the rims over the edges of the concave surfaces


def pictured(bearing: Geometry) -> Plates:
    """Return plates for a picture, with default proportions."""
    height = bearing.slider_height
    return Plates((0.35 * height, 0.35 * height), 0.3 * height, rim_height(bearing))


def outlines(
    bearing: Geometry, now: Posture, reach: float | None = None, plates: Plates | None = None
) -> dict[str, FloatArray]:
    """Return the outlines of the four bodies, closed polygons of shape (n, 2) [m]."""
    made = plates or pictured(bearing)
    points = contact_points(bearing, now)
    lower = plane_height(bearing)
    upper = bearing.slider_height - lower
    half = [
        _half_slider(r, bearing.slider_radius, h)
        for r, h in zip(bearing.radii, (lower, upper), strict=True)
    ]
    sides = [_plate(bearing, now, k, reach, made) for k in (0, 1)]
    normal, plate = now.axis, now.plate_axis
    return {
        "bottom plate": sides[0],
        "bottom slider": points["bottom"] + _placed(half[0], normal),
        "top slider": points["top"] + _placed(half[1] * (1.0, -1.0), normal),
        "top plate": points["vertex"] + _placed(sides[1] * (1.0, -1.0), plate),
    }


def surface_reach(data: xr.Dataset, bearing: Geometry) -> float:
    """Return half the width of the concave surfaces as drawn [m], also without rims."""
    face = max(rim_face(bearing, 0), rim_face(bearing, 1))
    if math.isfinite(face):
        return face
    sliding = data["slider_displacement"].sel(axis=["x", "y"]).to_numpy()
    far = 1.05 * float(np.linalg.norm(sliding, axis=-1).max()) + bearing.slider_radius
    return min(far, 0.95 * min(bearing.radii))


def area_of(outline: FloatArray) -> float:
    """Return the area of a closed polygon of shape (n, 2) [m2]."""
    x, z = outline.T
    return 0.5 * abs(float(x @ np.roll(z, -1) - z @ np.roll(x, -1)))


def turned_volume(outline: FloatArray) -> float:
    """Return the volume that the right half of a section turned about its axis has [m3].

    Shapes: outline (n, 2), a closed polygon that is symmetric about the axis.
    """
    following = np.roll(outline, -1, axis=0)
    (a, low), (b, high) = outline.T, following.T
    # frustums between the axis and each edge, those of the left half counted against the right's
    parts = (high - low) * (a * np.abs(a) + 0.5 * (a * np.abs(b) + b * np.abs(a)) + b * np.abs(b))
    return 0.5 * math.pi / 3.0 * abs(float(parts.sum()))


def _in_plane(vector: FloatArray, direction: FloatArray) -> FloatArray:
    flat = np.array([vector[:2] @ direction, vector[2]])
    return np.asarray(flat / np.linalg.norm(flat))


def _sagitta(radius: float, half_width: float) -> float:
    return radius - math.sqrt(radius**2 - half_width**2)


def _turn(now: Posture, surface: int) -> float:
    # Angle of the slider's offset against the axis of a plate [rad], positive to the right in
    # that plate's own axes (those of the top plate hang downwards, mirrored at the horizontal).
    plate = np.array([0.0, 1.0]) if surface == 0 else now.plate_axis
    cross = plate[0] * now.axis[1] - plate[1] * now.axis[0]
    angle = math.atan2(cross, float(plate @ now.axis))
    return angle if surface == 0 else -angle


def _placed(points: FloatArray, up: FloatArray) -> FloatArray:
    # Points of a body whose own axis is `up`, turned with it.
    right = np.array([up[1], -up[0]])
    return np.asarray(points[:, :1] * right + points[:, 1:] * up)


def _half_slider(radius: float, half_width: float, height: float) -> FloatArray:
    # Cap downwards, contact at the origin, plane face at `height`.
    x = np.linspace(-half_width, half_width, _ARC_POINTS)
    arc = np.column_stack([x, radius - np.sqrt(radius**2 - x**2)])
    return np.vstack([arc, [[half_width, height], [-half_width, height]]])


def _plate(
    bearing: Geometry, now: Posture, surface: int, reach: float | None, made: Plates
) -> FloatArray:
    # Concave surface upwards, vertex at the origin.
    radius, face = bearing.radii[surface], rim_face(bearing, surface)
    has_rim = math.isfinite(face)
    if not has_rim:
        face = min(bearing.radii) / 3.0 if reach is None else reach
    pressed = max(0.0, -rim_gap(bearing, now, surface)) if has_rim else 0.0
    tilt = _turn(now, surface)
    left, right = face + pressed * (tilt < 0.0), face + pressed * (tilt > 0.0)
    x = np.linspace(-left, right, 2 * _ARC_POINTS)
    arc = np.column_stack([x, radius - np.sqrt(radius**2 - x**2)])
    rim = made.rim if has_rim else 0.0
    edge, below = _sagitta(radius, face), -made.thickness[surface]
    outer = face + made.wall
    crown = edge + rim
    body = [
        [right, crown],
        [outer, crown],
        [outer, below],
        [-outer, below],
        [-outer, crown],
        [-left, crown],
    ]
    return np.vstack([arc, body])


class Movement(NamedTuple):
    """A bearing's bodies over time, in space."""

    axis: FloatArray  # (n_steps, 3) unit vectors of the slider n and of the top plate e_j, upwards
    plate_axis: FloatArray  # (n_steps, 3)
    slip: FloatArray  # (n_steps, 3) interface slip of the top slider on the bottom one [m]
    # (n_steps, 3) place of the top plate of a bearing that has lifted, relative to its place on the
    # slider [m]; 0 if the contact is closed
    opening: FloatArray

    @property
    def lift(self) -> FloatArray:
        """Gap between the top slider and the top plate, along `axis`, shape (n_steps,) [m]."""
        along = np.einsum("ta,ta->t", self.opening, self.axis)
        return np.asarray(np.maximum(along, 0.0))


def slider_axis(data: xr.Dataset, bearing: Geometry, name: str) -> FloatArray:
    """Return the slider's axis of a bearing over time, from its sliding on the bottom plate.

    With ``d1 = -R1 (n - e_i)`` and a bottom plate that stays level, ``n = (0, 0, 1) - d1 / R1``.

    Shapes: result (n_steps, 3).
    """
    sliding = data["slider_displacement"].sel(bearing=name, surface="bottom").to_numpy()
    return np.array([0.0, 0.0, 1.0]) - sliding / bearing.radii[0]


def movement(data: xr.Dataset, bearing: Geometry, name: str) -> Movement:
    """Return the motion of a bearing's bodies.

    In contact the centres of the spheres are ``c = C2 - C1 = -L n + s`` apart (docs/theory.md,
    section 1). The opening of an unloaded bearing is the difference between that and the c of the
    nodes' displacements and rotations: the recorded sliding on its top surface is not between
    touching surfaces. If rotations of its nodes were not recorded, its plates count as parallel.
    """
    own = data.sel(bearing=name)
    axis = slider_axis(data, bearing, name)
    top = own["slider_displacement"].sel(surface="top").transpose("time", "axis").to_numpy()
    plate = axis + top / bearing.radii[1]  # d2 = -R2 (n - e_j)
    slip = own["interface_slip"].transpose("time", "axis").to_numpy()
    opening = np.zeros_like(axis)
    lifted = ~(own["axial_force"].to_numpy() > 0.0)
    if lifted.any():
        length = sum(bearing.radii) - bearing.slider_height
        up, (lower, upper) = np.array([0.0, 0.0, 1.0]), plate_tilts(data, name)
        u = own["bearing_displacement"].transpose("time", "axis").to_numpy()
        levers = own["lever"].sel(surface=["bottom", "top"]).to_numpy()
        centres = u - length * up - levers[0] * lower - levers[1] * upper
        closed = slip - length * (axis + lower)
        opening[lifted] = (centres - closed)[lifted]
        plate[lifted] = (up + upper - lower)[lifted]
    return Movement(axis, plate, slip, opening)


def plate_tilts(data: xr.Dataset, name: str) -> tuple[FloatArray, FloatArray]:
    """Return how rotations of the nodes change the axes of both plates, (n_steps, 3) each."""
    nodes = data["bearing_node"].sel(bearing=name).to_numpy() if "bearing_node" in data else (-1,)
    tilts = np.zeros((2, data.sizes["time"], 3))
    if "node_displacement" in data and min(nodes) >= 0:
        turns = data["node_displacement"].isel(node=nodes).sel(dof=["ry", "rx"])
        tilts[..., :2] = turns.transpose("node", "time", "dof").to_numpy() * (1.0, -1.0)
    return tilts[0], tilts[1]
