"""Ready-made models: a mass on one bearing, a storey stick on bearings, a steel moment frame."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from frames._errors import ModelError
from frames.frame import Frame
from frames.library.grid import bearing_grid, pair
from frames.library.moment_frames import DEFAULT_DAMPING
from frames.library.moment_frames import moment_frame as moment_frame
from frames.model.damping import Damping
from frames.model.laws import Bilinear, BoucWen
from frames.model.parts import bearing_axial_stiffness
from lir_element.door import require_between, require_positive, require_type
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.library.grid import Bearings
    from lir_element import LIRBearing

    Storeys: TypeAlias = float | Sequence[float] | FloatArray
    """One number for every storey, or one for each from below."""

    StoreyLaws: TypeAlias = Callable[[float], Bilinear | BoucWen] | Sequence[Bilinear | BoucWen]
    """A function that makes a storey's law of its stiffness, or a law each from below."""

    Plan: TypeAlias = tuple[int | tuple[int, int], float | tuple[float, float]]
    """Numbers of bays and bay widths [m], each one number or a pair for x and y."""

VERTICAL_PERIOD = 0.05
"""Period that fixes the default axial stiffness of a stick's storeys [s]."""

RIGID_RATIO = 1e3
"""Stiffness of the base slab's vertical ties over that of a bearing [-]."""


def lumped_mass(
    bearing: LIRBearing,
    mass: float,
    *,
    inertia: tuple[float, float, float] | None = None,
    gravity: float = STANDARD_GRAVITY,
    name: str = "lumped mass",
) -> Frame:
    """Build a mass on one bearing.

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    mass : float
        Mass above the bearing [kg], > 0.
    inertia : (float, float, float), optional
        Rotational inertia of the mass about x, y, z through the top node [kg m2], > 0: it is then
        free to rotate, for the levels "contact" and "rigid_body" (at the level "pendulum" a
        bearing does not hold its plate's tilt). None: the plates stay parallel.
    gravity : float
        Acceleration of gravity [m/s2].
    name : str
        Name of the model.

    Returns
    -------
    Frame
        Nodes "ground" (fixed) and "mass" (ux, uy, uz free), bearing "bearing", no damping.
    """
    frame = Frame(name, gravity)
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("mass", 0.0, 0.0, bearing.height)
    frame.fix("ground", "all")
    checked = require_positive(
        "lumped_mass: mass [kg]", mass, remedy="give the isolated mass", error=ModelError
    )
    if inertia is None:
        frame.fix("mass", "rx", "ry", "rz")
        frame.add_mass("mass", checked)
    else:
        moments = [
            require_positive("lumped_mass: inertia [kg m2]", value, error=ModelError)
            for value in inertia
        ]
        frame.add_mass("mass", checked, moments)
    frame.add_bearing("bearing", "ground", "mass", bearing)
    return frame


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
    damping: Damping | None = DEFAULT_DAMPING,
    gravity: float = STANDARD_GRAVITY,
    name: str = "shear building",
) -> Frame:
    """Build a stick of storeys whose floors stay horizontal, on one bearing or a grid of them.

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
        the sides of the plan [-]; codes ask for 0.05 (ASCE/SEI 7-22, 12.8.4.2). They stand on nodes
        "base-mass", "floor-1-mass", ...
    storey_law : callable or sequence of Bilinear or BoucWen, optional
        Storeys that yield, the same along x and y: a law each from below, whose stiffness then is
        the storey's, or a function that makes a law of a stiffness. They are the links
        "storey-1-x", "storey-1-y", ...
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
        "ground", or "bearing-0-0", ... between "ground-0-0" and "base-0-0", ...

    Notes
    -----
    Limits: floors and base do not tilt, hence no overturning: bearings alike carry equal vertical
    loads. Use `moment_frame` where overturning matters.
    """
    chains = _storeys(storey_mass, storey_stiffness, axial_stiffness, storeys)
    height = require_positive("shear_building: storey_height [m]", storey_height, error=ModelError)
    base = chains[0][0] if base_mass is None else base_mass
    base = require_positive(
        "shear_building: base_mass [kg]",
        base,
        remedy="give the mass of the base slab",
        error=ModelError,
    )
    frame = Frame(name, gravity)
    if plan is None:
        held: tuple[str, ...] = ("rx", "ry", "rz")
        tied: tuple[str, ...] = ()
        polar, side = 0.0, (0.0, 0.0)
        level = _one_bearing(frame, bearing)
    else:
        held = ("rx", "ry")
        polar, side, level = _base_grid(frame, bearing, plan)
        tied = tuple(link.j for link in frame.bearings.values())
    off = _offset(side, eccentricity)
    gyration = (side[0] ** 2 + side[1] ** 2) / 12.0
    frame.fix("base", *held)
    _add_mass(frame, "base", base, gyration, off, tied)
    frame.add_level("base", ["base"])
    laws = _laws(storey_law, chains[1])
    for k, values in enumerate(zip(*chains, strict=True), start=1):
        law = laws[k - 1] if laws else None
        _add_storey(frame, k, level + k * height, values, polar, held, law)
        _add_mass(frame, f"floor-{k}", values[0], gyration, off)
    frame.set_damping(damping)
    return frame


def _laws(given: StoreyLaws | None, stiffness: list[float]) -> list[Bilinear | BoucWen]:
    # Laws of the storeys from below; none of a linear building.
    if given is None:
        return []
    laws = [given(k) for k in stiffness] if callable(given) else list(given)
    if len(laws) != len(stiffness):
        message = (
            f"shear_building: storey_law has {len(laws)} laws for {len(stiffness)} storeys: give "
            "one each, or a function of the storey's stiffness"
        )
        raise ModelError(message)
    for k, law in enumerate(laws, start=1):
        require_type(
            f"shear_building: storey_law of storey {k}", law, (Bilinear, BoucWen),
            "a Bilinear or BoucWen law",
        )  # fmt: skip
    return laws


def _add_storey(
    frame: Frame,
    number: int,
    z: float,
    values: tuple[float, float, float],
    polar: float,
    held: tuple[str, ...],
    law: Bilinear | BoucWen | None,
) -> None:
    # Floor `number` at elevation z on the storey below it, of lateral and axial stiffness; with a
    # law links take the place of the lateral springs.
    _, lateral, axial = values
    if law is not None:
        lateral = law.stiffness
    floor, below = f"floor-{number}", f"floor-{number - 1}" if number > 1 else "base"
    frame.add_node(floor, 0.0, 0.0, z)
    frame.fix(floor, *held)
    along = lateral if law is None else 0.0
    stiffness = (along, along, axial, 0.0, 0.0, lateral * polar)
    frame.add_spring(f"storey-{number}", below, floor, stiffness)
    if law is not None:
        for axis in "xy":
            frame.add_link(f"storey-{number}-{axis}", below, floor, law, f"u{axis}")
    frame.add_level(floor, [floor])


def _offset(side: tuple[float, float], eccentricity: tuple[float, float]) -> tuple[float, float]:
    # Of the masses from the middle of a plan of sides [m], which are 0 where there is none.
    shares = [
        require_between(
            "shear_building: eccentricity [-]", share, -0.5, 0.5,
            remedy="0.05 is a twentieth of the side", error=ModelError,
        )
        for share in eccentricity
    ]  # fmt: skip
    if any(shares) and not any(side):
        message = (
            f"shear_building: eccentricity = {eccentricity} without a plan: its floors do not "
            "rotate, give plan=(bays, bay_width)"
        )
        raise ModelError(message)
    return shares[0] * side[0], shares[1] * side[1]


def _add_mass(
    frame: Frame,
    floor: str,
    mass: float,
    gyration: float,
    off: tuple[float, float],
    tied: tuple[str, ...] = (),
) -> None:
    # Mass of a floor: on its node, or on a node beside it. That goes with the floor, as do `tied`.
    node = floor
    if any(off):
        node = f"{floor}-mass"
        frame.add_node(node, *off, frame.nodes[floor].z)
        frame.fix(node, "rx", "ry")
        tie = RIGID_RATIO * mass * (2.0 * math.pi / VERTICAL_PERIOD) ** 2
        frame.add_spring(f"tie-{node}", floor, node, (0.0, 0.0, tie, 0.0, 0.0, 0.0))
        tied = (*tied, node)
    if tied:
        frame.add_diaphragm(floor, [floor, *tied])
    frame.add_mass(node, mass, (0.0, 0.0, mass * gyration))


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
    frame.add_node("base", 0.0, 0.0, bearing.height)
    frame.add_bearing("bearing", "ground", "base", bearing)
    return bearing.height


def _base_grid(
    frame: Frame, bearing: Bearings, plan: Plan
) -> tuple[float, tuple[float, float], float]:
    # Node "base" held level over a grid of bearings around it. Returns the mean of x^2 + y^2 over
    # the grid points [m2], the plan's sides [m], and z of the base.
    bays = tuple(int(n) for n in pair(plan[0], "shear_building: bays", count=True))
    width = pair(plan[1], "shear_building: bay width [m]")
    side = (bays[0] * width[0], bays[1] * width[1])
    places = [(ix, iy) for ix in range(bays[0] + 1) for iy in range(bays[1] + 1)]
    level = bearing_grid(frame, bearing, places, width, (-0.5 * side[0], -0.5 * side[1]))
    frame.add_node("base", 0.0, 0.0, level)
    stiffest = max(bearing_axial_stiffness(link.bearing) for link in frame.bearings.values())
    tie = (0.0, 0.0, RIGID_RATIO * stiffest, 0.0, 0.0, 0.0)
    nodes = [f"base-{ix}-{iy}" for ix, iy in places]
    for node in nodes:
        frame.fix(node, "rx", "ry")
        frame.add_spring(f"tie-{node}", "base", node, tie)
    squares = [frame.nodes[node].x ** 2 + frame.nodes[node].y ** 2 for node in nodes]
    return sum(squares) / len(squares), side, level


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
            f"shear_building: the numbers of storeys differ or are 0: {sizes}: "
            "give sequences of one length, or single numbers and storeys=n"
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
