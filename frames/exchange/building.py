"""A building as other programs hold it: objects, properties and loads, in SI and global axes.

A file is read into it; `to_frame.fill` makes a `Frame` of it. Names are those of the file. Axes 1,
2, 3 of an object are those of the programs: 1 along a frame object, 2 in the vertical plane through
it (+X for a vertical one), rotated by its angle.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, field
from typing import TypeAlias

from frames.exchange.import_report import ImportReport
from frames.exchange.tables import Units

Vector: TypeAlias = tuple[float, float, float]
"""Components along global x, y, z."""

NOWHERE: Vector = (0.0, 0.0, 0.0)
"""No offset."""

RELEASES = ("P", "V2", "V3", "T", "M2", "M3")
"""Forces that an end of a frame object may be free of."""

LINK_DOFS = ("U1", "U2", "U3", "R1", "R2", "R3")
"""Deformations of a link, in its axes."""


@dataclass(frozen=True)
class Joint:
    """A point: name, coordinates [m], and its place in the file."""

    name: str
    x: float
    y: float
    z: float
    place: str

    @property
    def position(self) -> Vector:
        """Coordinates (x, y, z) [m]."""
        return (self.x, self.y, self.z)


@dataclass(frozen=True)
class Material:
    """Moduli [Pa], Poisson's ratio [-], mass [kg/m3] and weight [N/m3] of a volume."""

    name: str
    elastic_modulus: float
    shear_modulus: float
    poisson_ratio: float
    density: float
    weight: float


@dataclass(frozen=True)
class Modifiers:
    """Factors on the properties of a frame object [-]: stiffness, mass and weight."""

    area: float = 1.0
    shear_2: float = 1.0
    shear_3: float = 1.0
    torsion: float = 1.0
    inertia_22: float = 1.0
    inertia_33: float = 1.0
    mass: float = 1.0
    weight: float = 1.0

    def times(self, other: Modifiers) -> Modifiers:
        """Return the product of both."""
        return Modifiers(*(a * b for a, b in zip(self.all(), other.all(), strict=True)))

    def all(self) -> tuple[float, ...]:
        """Return the factors in the order of the programs: A, A2, A3, J, I22, I33, mass, weight."""
        return astuple(self)


@dataclass(frozen=True)
class FrameSection:
    """Constants of a cross-section [m2, m4], its outer depth (2) and width (3) [m], its factors."""

    name: str
    material: str
    shape: str
    area: float
    torsion: float
    inertia_33: float
    inertia_22: float
    shear_2: float
    shear_3: float
    depth: float
    width: float
    modifiers: Modifiers = Modifiers()


NO_SECTION = FrameSection("", "", "", 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0)
"""Substitute for an unreadable one, until all are reported together."""


@dataclass(frozen=True)
class FrameObject:
    """A frame object from joint i to joint j.

    `end_i`, `end_j` are the lengths of the end zones [m], of which the share `rigid` is stiff;
    `offset_i`, `offset_j` the vectors from joints to the axis of the section [m].
    """

    name: str
    i: str
    j: str
    section: str
    place: str
    material: str = ""
    angle: float = 0.0
    releases: tuple[frozenset[str], frozenset[str]] = (frozenset(), frozenset())
    end_i: float = 0.0
    end_j: float = 0.0
    rigid: float = 0.0
    cardinal: int = 10
    offset_i: Vector = NOWHERE
    offset_j: Vector = NOWHERE
    transforms: bool = True
    modifiers: Modifiers = Modifiers()
    meshed: bool = True
    story: str = ""


@dataclass(frozen=True)
class AreaSection:
    """A shell: thickness for its plane and for bending [m]; its stiff parts, and their factors.

    `kind` is "shell", "membrane", "plate" or "none" (loads alone); `in_plane`, `bending` the
    factors on its stiffness [-], `mass` and `weight` those on its own.
    """

    name: str
    material: str
    kind: str
    thickness: float
    bending_thickness: float
    in_plane: float = 1.0
    bending: float = 1.0
    mass: float = 1.0
    weight: float = 1.0
    one_way: bool = False
    extra_weight: float = 0.0

    @property
    def factors(self) -> tuple[float, ...]:
        """Factors by direction on the stiffness: 11, 22, 12 in plane, and of bending [-]."""
        return (self.in_plane,) * 3 + (self.bending,) * 3


NO_SHELL = AreaSection("", "", "none", 0.0, 0.0)
"""An area that has loads alone."""


@dataclass(frozen=True)
class AreaObject:
    """An area between joints in order; `section` is empty for one that only carries loads."""

    name: str
    joints: tuple[str, ...]
    section: str
    place: str
    angle: float = 0.0
    in_plane: float = 1.0
    bending: float = 1.0
    mass: float = 1.0
    weight: float = 1.0
    story: str = ""
    diaphragm: str = ""


@dataclass(frozen=True)
class LinkDof:
    """One deformation of a link: linear stiffness and damping, and its nonlinear numbers, in SI."""

    fixed: bool
    stiffness: float
    damping: float
    nonlinear: bool
    values: dict[str, float]


@dataclass(frozen=True)
class LinkProperty:
    """A link property: its kind as the program calls it, and its deformations by name.

    `unknown` has the words of the file that are not known here.
    """

    name: str
    kind: str
    dofs: dict[str, LinkDof]
    mass: float = 0.0
    weight: float = 0.0
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True)
class LinkObject:
    """A link from joint i to joint j; without j its other end is the ground."""

    name: str
    i: str
    j: str | None
    property: str
    place: str
    angle: float = 0.0
    story: str = ""


@dataclass(frozen=True)
class Constraint:
    """Joints that move together: "diaphragm", "body" or "equal", by the named displacements."""

    name: str
    kind: str
    joints: tuple[str, ...]
    dofs: tuple[str, ...] = ("ux", "uy", "uz", "rx", "ry", "rz")


@dataclass(frozen=True)
class Pattern:
    """A load pattern: its kind as the program calls it, and the factor on all self weight [-]."""

    name: str
    kind: str
    self_weight: float


@dataclass(frozen=True)
class JointLoad:
    """Forces and moments (6,) on a joint, global [N, N m]."""

    joint: str
    pattern: str
    forces: tuple[float, ...]


@dataclass(frozen=True)
class LineLoad:
    """A load along a frame object, linear between two distances from joint i as shares [-].

    `start`, `end` are in global axes [N/m]; `point` a force [N] at `a` if it is one.
    """

    frame: str
    pattern: str
    a: float
    b: float
    start: Vector
    end: Vector
    point: bool = False


@dataclass(frozen=True)
class AreaLoad:
    """A load on an area, per its own area, global axes [N/m2]."""

    area: str
    pattern: str
    load: Vector


@dataclass(frozen=True)
class MassSource:
    """Mass source of a building: its elements, masses added to joints, and shares of patterns."""

    elements: bool
    added: bool
    patterns: dict[str, float]


@dataclass
class Building:
    """All that was read of a file."""

    name: str  # of the file
    program: str  # of the file
    version: str  # of the file
    units: Units  # of the file
    account: ImportReport  # objects read, read as something else, and left out
    joints: dict[str, Joint] = field(default_factory=dict)
    materials: dict[str, Material] = field(default_factory=dict)
    sections: dict[str, FrameSection] = field(default_factory=dict)
    frames: dict[str, FrameObject] = field(default_factory=dict)
    area_sections: dict[str, AreaSection] = field(default_factory=dict)
    areas: dict[str, AreaObject] = field(default_factory=dict)
    link_properties: dict[str, LinkProperty] = field(default_factory=dict)
    links: dict[str, LinkObject] = field(default_factory=dict)
    restraints: dict[str, tuple[str, ...]] = field(default_factory=dict)
    springs: dict[str, tuple[float, ...]] = field(default_factory=dict)
    masses: dict[str, tuple[float, ...]] = field(default_factory=dict)
    constraints: dict[str, Constraint] = field(default_factory=dict)
    groups: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    patterns: dict[str, Pattern] = field(default_factory=dict)
    joint_loads: list[JointLoad] = field(default_factory=list)
    line_loads: list[LineLoad] = field(default_factory=list)
    area_loads: list[AreaLoad] = field(default_factory=list)
    mass_source: MassSource | None = None
    combinations: dict[str, dict[str, float]] = field(default_factory=dict)
    # names and elevations [m] from below
    stories: list[tuple[str, float]] = field(default_factory=list)
