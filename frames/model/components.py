"""Records of a frame's parts; `frames.frame.Frame` checks and creates them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from frames._errors import ModelError
from frames.model.laws import Law, PlasticHinge
from frames.model.sections import Section
from lir_element.argument_checks import require_non_negative, require_positive

if TYPE_CHECKING:
    from lir_element import LIRBearing

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
"""Names of a node's degrees of freedom: translations along and rotations about global x, y, z."""

DEFAULT_CASE = "D"
"""Default case of permanent loads, and of the weight of masses: dead load."""

Vector: TypeAlias = tuple[float, float, float]
"""Components along global x, y, z."""

Hinges: TypeAlias = Mapping[str, tuple[PlasticHinge | None, PlasticHinge | None]]
"""Plastic hinges at ends i and j by member."""

RELEASABLE = ("T", "My", "Mz")
"""Moments about a member's local axes that its ends may be free of."""


@dataclass(frozen=True)
class Node:
    """A point of the structure: name and coordinates [m], z up."""

    name: str
    x: float
    y: float
    z: float

    @property
    def position(self) -> tuple[float, float, float]:
        """Coordinates (x, y, z) [m]."""
        return (self.x, self.y, self.z)


@dataclass(frozen=True)
class Member:
    """A beam-column from node `i` to node `j`; `up` fixes its local axes, None the default.

    `releases` are the released moments of `RELEASABLE` at end i and at end j, `offsets` the rigid
    vectors from its nodes to its ends, in global axes [m].
    """

    name: str
    i: str
    j: str
    section: Section
    up: tuple[float, float, float] | None
    releases: tuple[tuple[str, ...], tuple[str, ...]] = ((), ())
    offsets: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    @property
    def has_offsets(self) -> bool:
        """True if an end is away from its node."""
        return any(any(offset) for offset in self.offsets)


@dataclass(frozen=True)
class TaperedLoad:
    """A load along a member, linear from `start` to `end` [N/m], global axes.

    It reaches from `a` to `b`, distances from the member's end i along its axis [m].
    """

    a: float
    b: float
    start: Vector
    end: Vector
    case: str

    def scaled(self, factor: float, case: str) -> TaperedLoad:
        """Return the load times a factor, of another case."""
        (u, v, w), (x, y, z) = self.start, self.end
        start, end = (factor * u, factor * v, factor * w), (factor * x, factor * y, factor * z)
        return TaperedLoad(self.a, self.b, start, end, case)


@dataclass(frozen=True)
class FloorLoad:
    """A load on a horizontal panel, carried by the members along its edges.

    `nodes` are its corners in order, `q` acts downwards [N/m2]. `span` is the unit vector in plan
    of a panel that carries one way, None for all edges. `mass` is the share of the load that is
    mass, None for that of the frame's mass source for `case`.
    """

    name: str
    nodes: tuple[str, ...]
    q: float
    span: tuple[float, float] | None
    mass: float | None
    case: str


@dataclass(frozen=True)
class Spring:
    """A linear spring from node `i` to node `j`: 3 x N/m and 3 x N m/rad in global axes."""

    name: str
    i: str
    j: str
    stiffness: tuple[float, ...]


@dataclass(frozen=True)
class Link:
    """A nonlinear part of one deformation between nodes `i` and `j`.

    `direction` is a unit vector in global axes; with `turns` it is an axis of rotation.
    """

    name: str
    i: str
    j: str
    law: Law
    direction: tuple[float, ...]
    turns: bool = False


class HingedEnd(NamedTuple):
    """A plastic hinge and its place: its name, its member and the end, 0 for i and 1 for j."""

    name: str
    member: str
    end: int
    hinge: PlasticHinge


def hinge_name(member: str, end: int) -> str:
    """Return the name of the hinge at an end (0, 1) of a member: "member:i", "member:j"."""
    return f"{member}:{'ij'[end]}"


def hinged_ends(hinges: Hinges) -> list[HingedEnd]:
    """Return the plastic hinges of members, in their order."""
    return [
        HingedEnd(hinge_name(member, end), member, end, hinge)
        for member, pair in hinges.items()
        for end, hinge in enumerate(pair)
        if hinge is not None
    ]


@dataclass(frozen=True)
class Diaphragm:
    """Nodes that move in their horizontal plane as one rigid body."""

    name: str
    nodes: tuple[str, ...]


@dataclass(frozen=True)
class BearingLink:
    """A bearing between node `i` below and node `j` above."""

    name: str
    i: str
    j: str
    bearing: LIRBearing


@dataclass(frozen=True)
class Level:
    """A storey level for drifts: name, elevation [m] and its nodes."""

    name: str
    z: float
    nodes: tuple[str, ...]


def bearing_axial_stiffness(bearing: LIRBearing) -> float:
    """Return the axial stiffness of a bearing, by default its own [N/m]."""
    given = bearing.axial_stiffness
    return float(bearing.resolved()["axial_stiffness"] if given is None else given)


def bearing_rocking_stiffness(bearing: LIRBearing) -> float:
    """Return a measure of how contact points resist the tilt of a plate, full disc [N m/rad]."""
    return 0.25 * bearing_axial_stiffness(bearing) * float(bearing.slider_radius) ** 2


def bearing_height(name: str, bearing: LIRBearing) -> float:
    """Check that a device can be placed, and return its height."""
    if isinstance(bearing, type):
        message = f'bearing "{name}" is the class {bearing.__name__}: pass an instance'
        raise TypeError(message)
    missing = [word for word in ("axial_stiffness", "height") if not hasattr(bearing, word)]
    if missing:
        message = (
            f'bearing "{name}" = {bearing!r} has no {" and no ".join(missing)}: '
            "pass a lir_element.LIRBearing"
        )
        raise TypeError(message)
    require_positive(
        f'axial_stiffness [N/m] of bearing "{name}"',
        bearing_axial_stiffness(bearing),
        error=ModelError,
    )
    return require_non_negative(f'height [m] of bearing "{name}"', bearing.height, error=ModelError)
