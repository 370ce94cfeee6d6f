"""The ready-made stick of storeys with rigid floors, on one bearing or a grid of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from frames._errors import ModelError
from frames.io import Frame
from frames.library.building import DEFAULT_DAMPING, add_bearings, bearings_at, pair, require_device
from frames.library.tilting_base import VERTICAL_PERIOD, GridPlan, add_tilting_base
from frames.model.components import bearing_axial_stiffness
from frames.model.damping import Damping
from frames.model.laws import Bilinear, BoucWen
from lir_element.argument_checks import require_between, require_positive, require_type
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.library.building import Bearings

    Storeys: TypeAlias = float | Sequence[float] | FloatArray
    """One number for every storey, or one for each from below."""

    StoreyLaws: TypeAlias = Callable[[float], Bilinear | BoucWen] | Sequence[Bilinear | BoucWen]
    """A function that makes a storey's law of its stiffness, or a law each from below."""

    Plan: TypeAlias = tuple[int | tuple[int, int], float | tuple[float, float]]
    """Numbers of bays and bay widths [m], each one number or a pair for x and y."""

RIGID_RATIO = 1e3
"""Stiffness of the vertical ties of a base that does not tilt, over that of a bearing [-]."""


def shear_building(
    bearing: Bearings,
    storey_mass: Storeys,
    storey_stiffness: Storeys,
    *,
    storeys: int | None = None,
    storey_height: float = 3.0,
    base_mass: float | None = None,
    axial_stiffness: Storeys | None = None,
    plan: Plan | None = None,
    eccentricity: tuple[float, float] = (0.0, 0.0),
    storey_law: StoreyLaws | None = None,
    overturning: bool = True,
    base_stiffness: float | tuple[float, float] | None = None,
    damping: Damping | None = DEFAULT_DAMPING,
    gravity: float = STANDARD_GRAVITY,
    name: str = "shear building",
) -> Frame:
    """Build a stick of storeys with rigid floors, on one bearing or a grid of them.

    Parameters
    ----------
    bearing : LIRBearing or mapping
        One bearing for every place, or with a plan one for each place (ix, iy).
    storey_mass : float or sequence of floats
        Mass of each floor from below [kg], > 0.
    storey_stiffness : float or sequence of floats
        Lateral stiffness of each storey from below, the same along x and y [N/m], > 0.
    storeys : int, optional
        Number of storeys; default the length of the sequences, 1 without any.
    storey_height : float
        Height of each storey [m].
    base_mass : float, optional
        Mass of the slab on the bearings [kg]; default that of the first floor.
    axial_stiffness : float or sequence of floats, optional
        Vertical stiffness of each storey [N/m]; default so that the floors it carries, alone on
        it, vibrate with a period of 0.05 s.
    plan : (bays, bay width), optional
        Numbers of bays along x and y and their widths [m], one number for both or a pair. Puts a
        bearing under every grid point, distributes the mass over the plan and the storey stiffness
        over columns at the grid points, and frees the floors' rotation about z. Without it there
        is one bearing and no rotation.
    eccentricity : tuple of two floats
        Distance of the masses of base and floors from the middle of the plan along x and y, over
        the sides of the plan [-]; codes require 0.05 (ASCE/SEI 7-22, 12.8.4.2). They are at nodes
        "base-mass", "floor-1-mass", ...
    storey_law : callable or sequence of Bilinear or BoucWen, optional
        Storeys that yield, the same along x and y: a law each from below, whose stiffness then is
        the storey's, or a function that makes a law of a stiffness. They are the links
        "storey-1-x", "storey-1-y", ...
    overturning : bool
        With a plan, True if base and floors tilt together: storey shears times heights, eccentric
        masses and the end moments of the bearings then change their axial forces. False holds the
        base level. Equal bearings then carry equal loads under gravity, their axial forces change
        by the differences of their rise alone, and checks that need axial forces are not evaluated;
        for comparisons with models without overturning.
    base_stiffness : float or tuple of two floats, optional
        Bending stiffness E I of the beams on one grid line along x and y, those of all levels
        together [N m2], > 0. The beams resist the rise of one bearing above the plane of the
        others. The columns of the first storey resist it, too: they hold the beams' ends as columns
        of its stiffness that are fixed in the floors. Default: a span, held at both ends, vibrates
        with a period of 0.05 s under its share of all masses.
    damping : RayleighDamping, ModalDamping or None
        Damping of the structure; default 2 per cent in every mode.
    gravity : float
        Acceleration of gravity [m/s2].
    name : str
        Name of the model.

    Returns
    -------
    Frame
        Nodes "base", "floor-1", ... with ux, uy, uz (and rz) free; bearing "bearing" on node
        "ground", or "bearing-0-0", ... between "ground-0-0" and "base-0-0", ...; with overturning
        rx and ry are free as well, and the superelement "base-beams" holds base and floors in one
        plane each.

    Raises
    ------
    ModelError
        If a number is out of bounds, or an option has no effect on this building.

    Notes
    -----
    The stick does not bend: its floors tilt with its foot, and a storey deforms by its shear alone,
    so that periods on a held base are those of the storeys' stiffness. The foot follows the plane
    that fits the bearings best; an overturning moment M gives the forces ``M x_i / sum(x_i^2)`` as
    far as the base is rigid. Limits: every grid point carries the same weight, not that of its
    tributary area; the weight of floors displaced from the base (P-Delta of the storeys) adds no
    moment. With overturning, nodes over the bearings have the rotary inertia of their share of the
    base's mass over a depth of 0.8 m, about x and y. This length is fixed: it does not follow the
    scale of the building. `moment_frame` has it as `base_depth`. Without a plan one bearing
    represents all: only the sum of their axial forces is known, and checks that need them are not
    evaluated.

    Examples
    --------
    >>> from frames import shear_building
    >>> from frames.demo import bearing_for
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6)
    >>> frame
    Frame("shear building": 4 nodes, 0 members, 2 springs, 0 diaphragms, 1 bearings)
    """
    chains = _storeys(storey_mass, storey_stiffness, axial_stiffness, storeys)
    height = require_positive("shear_building: storey_height [m]", storey_height, error=ModelError)
    base = chains[0][0] if base_mass is None else base_mass
    base = require_positive(
        "shear_building: base_mass [kg]",
        base,
        remedy="use the mass of the base slab",
        error=ModelError,
    )
    frame = Frame(name, gravity)
    grid = None
    if plan is None:
        level = _one_bearing(frame, bearing)
    else:
        grid, level = _base_grid(frame, bearing, plan)
    tilts = grid is not None and overturning
    if base_stiffness is not None and not tilts:
        message = (
            f"shear_building: base_stiffness = {base_stiffness} has no effect without a plan, or "
            "with overturning=False: give plan=(bays, bay_width) or leave it out"
        )
        raise ModelError(message)
    stick = _Stick(frame, grid, tilts, _offset(grid, eccentricity))
    _add_base(stick, base)
    laws = _laws(storey_law, chains[1])
    for k, values in enumerate(zip(*chains, strict=True), start=1):
        law = laws[k - 1] if laws else None
        _add_storey(stick, k, level + k * height, values, law)
    if grid is not None and tilts:
        first = chains[1][0] if not laws else laws[0].stiffness
        add_tilting_base(
            frame,
            grid,
            base_stiffness,
            base,
            column=first * height**2 / (3.0 * len(grid.nodes)),  # 12 E I / h^3 each of the storey
            floors=[f"floor-{k + 1}" for k in range(len(chains[0]))],
        )
    frame.set_damping(damping)
    return frame


class _Stick(NamedTuple):
    # The frame under construction, its grid of bearings, tilting or not, and places of masses.
    frame: Frame
    grid: GridPlan | None
    tilts: bool
    off: tuple[float, float]

    @property
    def held(self) -> tuple[str, ...]:
        if self.tilts:
            return ()
        return ("rx", "ry", "rz") if self.grid is None else ("rx", "ry")

    @property
    def polar(self) -> float:
        # Mean of x^2 + y^2 over the grid points [m2].
        if self.grid is None:
            return 0.0
        points = [self.frame.nodes[node] for node in self.grid.nodes.values()]
        return sum(point.x**2 + point.y**2 for point in points) / len(points)


def _laws(given: StoreyLaws | None, stiffness: list[float]) -> list[Bilinear | BoucWen]:
    # Laws of the storeys from below; none of a linear building.
    if given is None:
        return []
    laws = [given(k) for k in stiffness] if callable(given) else list(given)
    if len(laws) != len(stiffness):
        message = (
            f"shear_building: storey_law has {len(laws)} laws for {len(stiffness)} storeys: "
            "pass one for each, or a function of the storey's stiffness"
        )
        raise ModelError(message)
    for k, law in enumerate(laws, start=1):
        require_type(
            f"shear_building: storey_law of storey {k}",
            law,
            (Bilinear, BoucWen),
            "a Bilinear or BoucWen law",
        )
    return laws


def _add_base(stick: _Stick, mass: float) -> None:
    # Node "base" with its mass; without tilt the nodes over the bearings are tied to it level.
    frame, over = stick.frame, () if stick.grid is None else tuple(stick.grid.nodes.values())
    if stick.held:
        frame.fix("base", *stick.held)
    if over and not stick.tilts:
        stiffest = max(bearing_axial_stiffness(link.bearing) for link in frame.bearings.values())
        tie = (0.0, 0.0, RIGID_RATIO * stiffest, 0.0, 0.0, 0.0)
        for node in over:
            frame.fix(node, "rx", "ry")
            frame.add_spring(f"tie-{node}", "base", node, tie)
    _add_mass(stick, "base", mass, over)
    frame.add_level("base", ["base"])


def _add_storey(
    stick: _Stick,
    number: int,
    z: float,
    values: tuple[float, float, float],
    law: Bilinear | BoucWen | None,
) -> None:
    # Floor `number` at elevation z on the storey below it, of lateral and axial stiffness; with a
    # law links take the place of the lateral springs.
    frame = stick.frame
    mass, lateral, axial = values
    if law is not None:
        lateral = law.stiffness
    floor, below = f"floor-{number}", f"floor-{number - 1}" if number > 1 else "base"
    frame.add_node(floor, 0.0, 0.0, z)
    if stick.held:
        frame.fix(floor, *stick.held)
    along = lateral if law is None else 0.0
    stiffness = (along, along, axial, 0.0, 0.0, lateral * stick.polar)
    frame.add_spring(f"storey-{number}", below, floor, stiffness)
    if law is not None:
        for axis in "xy":
            frame.add_link(f"storey-{number}-{axis}", below, floor, law, f"u{axis}")
    frame.add_level(floor, [floor])
    _add_mass(stick, floor, mass)


def _offset(grid: GridPlan | None, eccentricity: tuple[float, float]) -> tuple[float, float]:
    # Distance of the masses from the middle of a plan [m].
    shares = [
        require_between(
            "shear_building: eccentricity [-]",
            share,
            -0.5,
            0.5,
            remedy="0.05 is 5 % of the side",
            error=ModelError,
        )
        for share in eccentricity
    ]
    if grid is not None:
        return shares[0] * grid.side[0], shares[1] * grid.side[1]
    if any(shares):
        message = (
            f"shear_building: eccentricity = {eccentricity} needs a plan, because floors "
            "without a plan do not rotate: set plan=(bays, bay_width)"
        )
        raise ModelError(message)
    return 0.0, 0.0


def _add_mass(stick: _Stick, floor: str, mass: float, tied: tuple[str, ...] = ()) -> None:
    # Mass of a floor: on its node, or on a node beside it. That goes with the floor, as do `tied`.
    frame, node = stick.frame, floor
    if any(stick.off):
        node = f"{floor}-mass"
        frame.add_node(node, *stick.off, frame.nodes[floor].z)
        if not stick.tilts:
            frame.fix(node, "rx", "ry")
            tie = RIGID_RATIO * mass * (2.0 * math.pi / VERTICAL_PERIOD) ** 2
            frame.add_spring(f"tie-{node}", floor, node, (0.0, 0.0, tie, 0.0, 0.0, 0.0))
        tied = (*tied, node)
    if tied:
        frame.add_diaphragm(floor, [floor, *tied])
    a, b = (0.0, 0.0) if stick.grid is None else stick.grid.side
    about = (mass * b**2 / 12.0, mass * a**2 / 12.0) if stick.tilts else (0.0, 0.0)
    gyration = (a**2 + b**2) / 12.0
    frame.add_mass(node, mass, (*about, mass * gyration))


def _one_bearing(frame: Frame, bearing: Bearings) -> float:
    # Nodes "ground" and "base" with a bearing between; returns z of the base.
    if isinstance(bearing, Mapping):
        message = (
            f"shear_building: bearing is a mapping of {len(bearing)} places, without a plan it "
            "must be one LIRBearing: give plan=(bays, bay_width)"
        )
        raise ModelError(message)
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.fix("ground", "all")
    require_device("bearing", bearing)
    frame.add_node("base", 0.0, 0.0, bearing.height)
    frame.add_bearing("bearing", "ground", "base", bearing)
    return bearing.height


def _base_grid(frame: Frame, bearing: Bearings, plan: Plan) -> tuple[GridPlan, float]:
    # Bearings on a grid around the origin, and z of the base.
    count = pair(plan[0], "shear_building: bays", count=True)
    bays = (int(count[0]), int(count[1]))
    width = pair(plan[1], "shear_building: bay width [m]")
    places = [(ix, iy) for ix in range(bays[0] + 1) for iy in range(bays[1] + 1)]
    grid = GridPlan(bays, width, {(ix, iy): f"base-{ix}-{iy}" for ix, iy in places})
    corner = (-0.5 * grid.side[0], -0.5 * grid.side[1])
    at = bearings_at(places, bearing)
    points = {f"{ix}-{iy}": (corner[0] + ix * width[0], corner[1] + iy * width[1]) for ix, iy in at}
    level = add_bearings(frame, dict(zip(points, at.values(), strict=True)), points)
    frame.add_node("base", 0.0, 0.0, level)
    return grid, level


def _storeys(
    mass: Storeys,
    stiffness: Storeys,
    axial: Storeys | None,
    storeys: int | None,
) -> tuple[list[float], list[float], list[float]]:
    given = {"storey_mass": mass, "storey_stiffness": stiffness, "axial_stiffness": axial}
    sizes = {
        key: np.size(value) for key, value in given.items() if value is not None and np.ndim(value)
    }
    if storeys is not None:
        sizes["storeys"] = int(pair(storeys, "shear_building: storeys", count=True)[0])
    if len(set(sizes.values())) > 1 or 0 in sizes.values():
        message = (
            f"shear_building: the numbers of storeys differ or are 0 ({sizes}): pass "
            "sequences of one length, or single numbers and storeys=n"
        )
        raise ModelError(message)
    count = next(iter(sizes.values()), 1)
    masses = _storey_values(mass, count, "storey_mass [kg]")
    if axial is None:
        square = (2.0 * math.pi / VERTICAL_PERIOD) ** 2
        axials = [square * sum(masses[k:]) for k in range(count)]
    else:
        axials = _storey_values(axial, count, "axial_stiffness [N/m]")
    return masses, _storey_values(stiffness, count, "storey_stiffness [N/m]"), axials


def _storey_values(value: Storeys, count: int, what: str) -> list[float]:
    values = np.broadcast_to(np.asarray(value, dtype=np.float64), (count,))
    return [
        require_positive(f"shear_building: {what}", number, error=ModelError)
        for number in values.tolist()
    ]
