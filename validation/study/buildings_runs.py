"""Frames and walled frames of 3, 6 and 9 storeys: their members, bearings and loads.

From the top, each three storeys have the members of one step of `STEPS`: the light frame of
`yielding_runs`, the demo's, and a heavier one, so that the strength over the weight stays alike.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames import Frame, Section, gravity, modes, moment_frame
from frames.demo import bearing_for
from frames.laws import PlasticHinge
from validation.measurements.yielding_runs import (
    Structure,
    box_modulus,
    i_moduli,
    structures,
)

if TYPE_CHECKING:
    from frames import GroundMotion
    from lir_element import LIRBearing

    Place = tuple[int, int]

SLIDERS = {3: 0.12, 6: 0.16, 9: 0.21}
"""Height of the sliders by number of storeys [m]: about 0.8 of their radius under the centre."""

STOREYS = tuple(SLIDERS)
FRAMES, WALLS = "frames", "walls"
SYSTEMS = (FRAMES, WALLS)
SPAN, HEIGHT = 6.0, 3.5
"""Of a bay and of a storey [m]."""

BOX, SHAPE = (0.50, 0.030), (0.65, 0.25, 0.022, 0.013)
"""Columns and beams of the lowest three of nine storeys [m]."""

SCALES = (1.2, 1.6, 2.0, 2.6, 3.3, 4.2)
"""Intensities of the stripes [m/s2]."""

ALL_RECORDS = ((3, FRAMES), (3, WALLS), (6, FRAMES))
"""Buildings that are run under all records; the others, which cost most, under every second."""

LENGTH, THICKNESS = 3.0, 0.30
"""Of a wall [m]."""

STEEL, BAR_STRESS = 0.01, 420e6
"""Share of vertical bars in a wall, and their yield stress [Pa]."""

CRACKED, CONCRETE = 0.5, {"elastic_modulus": 30e9, "poisson_ratio": 0.2, "density": 2500.0}
WALL_YIELDS = 0.0025
"""Rotation [rad] that counts as ductility 1 of a wall's foot: ductility 9 is 0.02 rad plastic."""

WALLED = {(1, 0): "x", (1, 2): "x", (0, 1): "y", (2, 1): "y"}
"""Places of the walls, one in the middle of each facade, and the axis that each is along."""


class Building(NamedTuple):
    """A building of the study."""

    storeys: int
    system: str

    @property
    def name(self) -> str:
        """How the page calls it."""
        return f"{self.storeys} storeys, {self.system}"


BUILDINGS = tuple(Building(n, system) for system in SYSTEMS for n in STOREYS)


def steps() -> tuple[Structure, ...]:
    """Return the members of the highest three storeys, of the next three, of the lowest."""
    strong, weak = i_moduli(*SHAPE)
    heavy = Structure(
        "heavy",
        Section.box(BOX[0], BOX[0], BOX[1]),
        Section.i_shape(*SHAPE),
        (box_modulus(*BOX), strong),
        weak,
    )
    return structures()["light"], structures()["demo"], heavy


def records_for(one: Building, motions: Mapping[str, GroundMotion]) -> dict[str, GroundMotion]:
    """Return the records under which a building is run: all, or every second."""
    return dict(list(motions.items())[:: 1 if one in ALL_RECORDS else 2])


def step_of(storey: int, storeys: int) -> Structure:
    """Return the members of a storey, counted from 1 at the bottom."""
    return steps()[(storeys - storey) // 3]


@cache
def building(one: Building) -> Frame:
    """Return a building on LIR-DCFPs of the smaller plan, one pressure under its loads."""
    first = _walled(one, _framed(one, bearing_of(one, 1000e3)))
    loads = dict(zip(_places(), gravity(first).axial_forces, strict=True))
    mirrored = {
        place: float(np.mean([loads[each] for each in _alike(*place)])) for place in _places()
    }
    frame = _framed(one, {place: bearing_of(one, load) for place, load in mirrored.items()})
    return _walled(one, frame, mirrored)


def bearing_of(one: Building, load: float) -> LIRBearing:
    """Return the study's bearing for a load [N], its slider as high as the building asks.

    Plates of wide sliders would touch at their edges with low ones. Radii grow along, so that
    period and capacity are the same in all buildings.
    """
    own, height = bearing_for(load), SLIDERS[one.storeys]
    more = 0.5 * (height - own.slider_height)
    return replace(own, slider_height=height, radius=own.radius + more)


def yield_rotations(one: Building) -> dict[str, float]:
    """Return the rotation at which each member with hinges yields [rad]: M_p L / (6 E I)."""
    found, frame = {}, building(one)
    for name in frame.hinges:
        if name.startswith("column") and _place(name) in WALLED and one.system == WALLS:
            found[name] = WALL_YIELDS
        else:
            kind = name.split("-")[0]
            whole = step_of(_storey(name), one.storeys).yield_rotations()[kind]
            ends = sum(float(np.abs(offset).max()) for offset in frame.members[name].offsets)
            found[name] = whole * (1.0 - ends / SPAN)  # of what is between faces of walls
    return found


def strength(one: Building) -> float:
    """Return the base shear of a beam mechanism over the weight [-]: equal forces at all floors.

    Beams turn at both ends at every floor, columns and walls at their feet alone.
    """
    frame, total, both = building(one), 0.0, ("i", "j")
    for name, pair in frame.hinges.items():
        hinges = dict(zip(both, pair, strict=True))
        if name.startswith("beam-x"):
            total += sum(hinge.moment_y for hinge in hinges.values() if hinge is not None)
        elif name.startswith("column-1-"):
            foot = hinges["i"]
            assert foot is not None
            total += _along_x(one, name, foot)
    arm = 0.5 * (one.storeys + 1) * HEIGHT
    weight = sum(each.bearing.resolved()["design_load"] for each in frame.bearings.values())
    return float(total / arm / weight)


def period(one: Building) -> float:
    """Return the first period of a building that is fixed under its base [s]."""
    return float(modes(building(one), 1, bearings="fixed").periods[0])


def _along_x(one: Building, name: str, hinge: PlasticHinge) -> float:
    # Moment of a foot that resists a sway along x; weak axes of walls carry none.
    if one.system == WALLS and _place(name) in WALLED:
        return hinge.moment_y if WALLED[_place(name)] == "x" else 0.0
    return hinge.moment_y


def _framed(one: Building, bearing: LIRBearing | Mapping[Place, LIRBearing]) -> Frame:
    # The frame with the members of its storeys, and their hinges.
    last = step_of(one.storeys, one.storeys)
    frame = moment_frame(
        storeys=one.storeys,
        bearing=bearing,
        bay_width=SPAN,
        storey_height=HEIGHT,
        column=last.column,
        beam=last.beam,
        hinges=last.hinges,
        name=one.name,
    )
    for name in [name for name in frame.hinges if step_of(_storey(name), one.storeys) != last]:
        step, member = step_of(_storey(name), one.storeys), frame.members[name]
        kind = name.split("-")[0]
        frame.remove("member", name)
        frame.add_member(
            name, member.i, member.j, step.column if kind == "column" else step.beam, member.up
        )
        frame.add_hinges(name, step.hinges[kind])
    return frame


def _walled(one: Building, frame: Frame, loads: Mapping[Place, float] | None = None) -> Frame:
    # Middle columns of the facades become walls; beams beside them end at their faces.
    if one.system == FRAMES:
        return frame
    section = Section.rectangle(THICKNESS, LENGTH, **CONCRETE).cracked(CRACKED)
    for name in [n for n in frame.members if n.startswith("column") and _place(n) in WALLED]:
        member, place = frame.members[name], _place(name)
        frame.remove("member", name)
        up = (1.0, 0.0, 0.0) if WALLED[place] == "x" else (0.0, 1.0, 0.0)  # local z: the length
        frame.add_member(name, member.i, member.j, section, up)
        if loads is not None and _storey(name) == 1:
            frame.add_hinges(name, {"i": wall_hinge(loads[place])})
    for name in [n for n in frame.members if n.startswith("beam")]:
        _end_at_faces(frame, name)
    return frame


def wall_hinge(load: float) -> PlasticHinge:
    """Return the hinge at the foot of a wall under an axial load [N], about its strong axis.

    M = 0.5 L (A_s f_y + N)(1 - c / L), bars spread over the length (Cardenas and Magura 1973), with
    a compressed zone c of a fifth of the length; the load is that at rest.
    """
    bars = STEEL * LENGTH * THICKNESS * BAR_STRESS
    return PlasticHinge(moment_y=0.4 * LENGTH * (bars + load), hardening=0.02)


def _end_at_faces(frame: Frame, name: str) -> None:
    # Beams along a wall's length end at its face.
    member, axis = frame.members[name], name.split("-")[1]
    offsets = {}
    for end, node, side in (("i", member.i, 1.0), ("j", member.j, -1.0)):
        if WALLED.get(_place(node)) == axis:
            half = side * 0.5 * LENGTH
            offsets[end] = (half, 0.0, 0.0) if axis == "x" else (0.0, half, 0.0)
    if offsets:
        hinges = frame.hinges.get(name)
        frame.remove("member", name)
        frame.add_member(name, member.i, member.j, member.section, member.up, offsets=offsets)
        if hinges:
            frame.add_hinges(
                name, {end: h for end, h in zip("ij", hinges, strict=True) if h is not None}
            )


def _places() -> list[Place]:
    return [(ix, iy) for ix in range(3) for iy in range(3)]


def _alike(ix: int, iy: int) -> set[Place]:
    # Places that are one by the symmetry of plan and walls.
    found = {(i, j) for i in (ix, 2 - ix) for j in (iy, 2 - iy)}
    return found | {(j, i) for i, j in found}


def _place(name: str) -> Place:
    ix, iy = name.split("-")[-2:]
    return int(ix), int(iy)


def _storey(name: str) -> int:
    # Of "column-<storey>-..." and of "beam-x-floor-<storey>-...".
    parts = name.split("-")
    return int(parts[1] if parts[0] == "column" else parts[3])
