"""Builders of common models: one mass on one bearing, and a regular frame of beams and columns."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.io import Frame
from frames.library.building import DEFAULT_DAMPING, bearings_at, build, pair, require_device
from frames.library.building_plan import DEFAULT_BASE_DEPTH, level_name, regular_plan
from frames.model.damping import Damping
from frames.model.laws import PlasticHinge
from frames.model.sections import Section
from lir_element.argument_checks import (
    require_choice,
    require_finite,
    require_non_negative,
    require_positive,
)
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.library.building import Bearings
    from lir_element import LIRBearing


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
        Rotational inertia of the mass about x, y, z through the top node [kg m2], > 0. The mass is
        then free to rotate, for the levels "contact" and "rigid_body" (at the level "pendulum" a
        bearing does not hold its plate's tilt). None: the plates stay parallel.
    gravity : float
        Acceleration of gravity [m/s2].
    name : str
        Name of the model.

    Returns
    -------
    Frame
        Nodes "ground" (fixed) and "mass" (ux, uy, uz free), bearing "bearing", no damping.

    Raises
    ------
    TypeError
        If the device is no bearing.
    ModelError
        If mass, inertia or gravity is not positive.

    Examples
    --------
    >>> from frames import lumped_mass
    >>> from frames.demo import bearing_for
    >>> lumped_mass(bearing_for(2000e3), mass=204e3)
    Frame("lumped mass": 2 nodes, 0 members, 0 springs, 0 diaphragms, 1 bearings)
    """
    require_device("bearing", bearing)
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


DEFAULT_FLOOR_LOAD = 1450.0
"""Mass of a floor besides its steel [kg/m2]: slab, finishes, cladding, part of the live load."""

DEFAULT_COLUMN = Section.box(0.40, 0.40, 0.025)
DEFAULT_BEAM = Section.i_shape(0.55, 0.22, 0.020, 0.012)
DEFAULT_BASE_BEAM = Section.i_shape(0.80, 0.30, 0.030, 0.016)


KINDS = ("column", "beam", "base_beam")
"""Kinds of members of a moment frame."""


def moment_frame(
    bays: tuple[int, int] = (2, 2),
    storeys: int = 3,
    *,
    bearing: Bearings,
    bay_width: float | tuple[float, float] = 6.0,
    storey_height: float = 3.5,
    floor_mass: float | None = None,
    floor_load: float | None = None,
    column: Section | None = None,
    beam: Section | None = None,
    base_beam: Section | None = None,
    hinges: Mapping[str, PlasticHinge] | None = None,
    eccentricity: tuple[float, float] = (0.0, 0.0),
    base_depth: float = DEFAULT_BASE_DEPTH,
    damping: Damping | None = DEFAULT_DAMPING,
    gravity: float = STANDARD_GRAVITY,
    name: str = "moment frame",
) -> Frame:
    """Build a regular 3-D steel moment frame with a bearing under every column.

    Parameters
    ----------
    bays : tuple of two ints
        Numbers of bays along x and y, >= 1.
    storeys : int
        Number of storeys above the base, >= 1.
    bearing : LIRBearing or mapping
        One bearing for every column, or one for each place (ix, iy).
    bay_width : float or tuple of two floats
        Bay widths along x and y [m].
    storey_height : float
        Height of each storey [m].
    floor_mass : float, optional
        Mass of every level, the base among them, besides its steel [kg].
    floor_load : float, optional
        The same by area [kg/m2]; default 1450. Give one of the two. The mass goes to the nodes by
        tributary area.
    column, beam, base_beam : Section, optional
        Sections; default a box 400 x 25 mm, an I of 550 mm and, above the bearings, an I of
        800 mm. Their density adds the mass of the steel: set it to 0 to leave that out.
    hinges : mapping, optional
        Plastic hinges at both ends of all members of a kind: "column", "beam", "base_beam".
    eccentricity : tuple of two floats
        Distance of the floors' centre of mass from the middle of the plan along x and y, over the
        sides of the plan [-]; codes require 0.05 (ASCE/SEI 7-22, 12.8.4.2). The masses of the nodes
        rise linearly towards it; the steel's own is not moved.
    base_depth : float
        Depth of the mass cast with the nodes over the bearings [m]: about x and y they get the
        inertia m depth^2 / 12 of their mass m. With 0 the moment of a hard rim contact may have no
        equilibrium, and the run stops there.
    damping : RayleighDamping, ModalDamping or None
        Damping of the structure; default 2 per cent in every mode.
    gravity : float
        Acceleration of gravity [m/s2].
    name : str
        Name of the model.

    Returns
    -------
    Frame
        Levels "base", "floor-1", ..., each with a diaphragm of its name and nodes
        "<level>-<ix>-<iy>"; fixed nodes "ground-<ix>-<iy>", bearings "bearing-<ix>-<iy>", members
        "column-<storey>-<ix>-<iy>", "beam-x-<level>-<ix>-<iy>" and "beam-y-...".

    Notes
    -----
    Refused with a `ModelError` if both `floor_mass` and `floor_load` are given, or a number is
    out of bounds. The members are rigidly joined; the steel's mass is at the nodes.

    Examples
    --------
    >>> from frames import moment_frame
    >>> from frames.demo import bearing_for
    >>> moment_frame(bays=(2, 1), storeys=3, bearing=bearing_for(600e3), bay_width=(6.0, 5.0))
    Frame("moment frame": 30 nodes, 46 members, 0 springs, 4 diaphragms, 6 bearings)
    """
    n_x, n_y = (int(number) for number in pair(bays, "moment_frame: bays", count=True))
    levels = int(pair(storeys, "moment_frame: storeys", count=True)[0])
    width = pair(bay_width, "moment_frame: bay_width [m]")
    height = require_positive("moment_frame: storey_height [m]", storey_height, error=ModelError)
    depth = require_non_negative("moment_frame: base_depth [m]", base_depth, error=ModelError)
    per_area = _mass_per_area(floor_mass, floor_load, n_x * width[0] * n_y * width[1])
    masses = tributary_masses((n_x, n_y), width, per_area, eccentricity)
    floors = [base_beam or DEFAULT_BASE_BEAM, *[beam or DEFAULT_BEAM] * levels]
    plan = regular_plan(
        (n_x, n_y),
        width,
        (height,) * levels,
        [(column or DEFAULT_COLUMN, None)] * levels,
        {"x": floors, "y": floors},
    )
    devices = {f"{ix}-{iy}": one for (ix, iy), one in bearings_at(list(masses), bearing).items()}
    frame = build(plan, devices, name=name, damping=damping, gravity=gravity)
    add_floor_masses(frame, levels, masses, depth)
    _add_hinges(frame, hinges or {})
    return frame


def _add_hinges(frame: Frame, hinges: Mapping[str, PlasticHinge]) -> None:
    # Hinges at the ends of all members of a kind.
    for kind, hinge in hinges.items():
        require_choice("moment_frame: kind of member with hinges", kind, KINDS, error=ModelError)
        for name in frame.members:
            own = "column" if name.startswith("column") else "beam"
            if own == "beam" and name[len("beam-x-") :].startswith("base"):
                own = "base_beam"
            if own == kind:
                frame.add_hinges(name, hinge)


def tributary_masses(
    bays: tuple[int, ...],
    width: tuple[float, float],
    per_area: float,
    eccentricity: tuple[float, float],
) -> dict[tuple[int, int], float]:
    """Return the masses of the nodes of a floor, by tributary area."""
    shares, places = [], []  # of each direction: masses of its lines, and lines from the middle
    for n, span, off in zip(bays, width, eccentricity, strict=True):
        ratio = require_finite("moment_frame: eccentricity [-]", off, error=ModelError)
        share = np.array([0.5, *[1.0] * (n - 1), 0.5])
        place = span * (np.arange(n + 1) - 0.5 * n)
        side, square = n * span, float((share * place**2).sum() / share.sum())
        tilt = ratio * side / square
        if not abs(tilt) * 0.5 * side < 1.0:
            bound = 2.0 * square / side**2
            message = (
                f"moment_frame: eccentricity = {ratio:g} of the side must be below {bound:.3g}, "
                "or columns at one edge have no mass: reduce it (codes require 0.05)"
            )
            raise ModelError(message)
        shares.append(share)
        places.append(tilt * place)
    found = {}
    for ix, iy in product(range(bays[0] + 1), range(bays[1] + 1)):
        tributary = per_area * shares[0][ix] * shares[1][iy] * width[0] * width[1]
        found[ix, iy] = float(tributary * (1.0 + places[0][ix] + places[1][iy]))
    if min(found.values()) < 0.0:
        message = (
            f"moment_frame: eccentricity = {eccentricity} along both sides leaves a corner "
            "without mass: reduce it, or use one direction at a time"
        )
        raise ModelError(message)
    return found


def add_floor_masses(
    frame: Frame, storeys: int, masses: Mapping[tuple[int, int], float], base_depth: float
) -> None:
    """Add the masses of a floor to every level, and the inertia of their depth to the base."""
    for level in range(storeys + 1):
        for (ix, iy), mass in masses.items():
            frame.add_mass(f"{level_name(level)}-{ix}-{iy}", mass)
    for (ix, iy), mass in masses.items():
        inertia = mass * base_depth**2 / 12.0
        frame.add_mass(f"base-{ix}-{iy}", 0.0, (inertia, inertia, 0.0))


def _mass_per_area(floor_mass: float | None, floor_load: float | None, area: float) -> float:
    if floor_mass is not None and floor_load is not None:
        message = (
            f"moment_frame: floor_mass = {floor_mass!r} kg and floor_load = {floor_load!r} "
            "kg/m2 both give the mass of the floors: use one of them"
        )
        raise ModelError(message)
    if floor_mass is not None:
        return (
            require_non_negative("moment_frame: floor_mass [kg]", floor_mass, error=ModelError)
            / area
        )
    chosen = DEFAULT_FLOOR_LOAD if floor_load is None else floor_load
    return require_non_negative("moment_frame: floor_load [kg/m2]", chosen, error=ModelError)
