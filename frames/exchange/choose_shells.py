"""Which areas of a building are shells, and which are loads and masses alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.building import Constraint
from frames.exchange.enclosed import FLAT, Levels, level_of
from frames.exchange.interior import joints_within
from frames.exchange.shares import Shares

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.building import AreaObject, Building
    from frames.exchange.interior import Inside
    from frames.exchange.stations import Points

_MESHED = "ETABS"
"""The program that divides areas at the joints within them."""


def choose_shells(building: Building) -> list[AreaObject]:
    """Return the areas whose stiffness counts: all but level ones in rigid diaphragms and decks."""
    sets = [set(c.joints) for c in building.constraints.values() if c.kind == "diaphragm"]
    found, flat, loose = [], [], []
    for area in building.areas.values():
        section = building.area_sections.get(area.section)
        if section is None or section.kind == "none":
            continue
        level = float(np.ptp(_corners(building, area)[:, 2])) < FLAT
        if level and any(set(area.joints) <= joints for joints in sets):
            flat.append(area.name)
        elif level and section.kind == "membrane" and section.one_way:
            loose.append(area)
        else:
            found.append(area)
    what = "slabs in rigid diaphragms, by their loads and masses alone: their bending is not stiff"
    shares = Shares(building)
    building.account.read_as("areas", what, flat, *shares.of(flat))
    if loose:
        what = "one-way decks in no rigid diaphragm, taken as rigid in their plane"
        names = [area.name for area in loose]
        building.account.refuse("loose decks", "areas", what, names, loose[0].place)
        _tie(building, loose)
    return found


def meet_joints(building: Building, shells: list[AreaObject], points: Points) -> Inside:
    """Return the joints within shells that their mesh has to meet."""
    inside = joints_within([area for area in shells if len(area.joints) <= 4], points)
    names = list(dict.fromkeys(joint for joints in inside.values() for joint in joints))
    if building.program == _MESHED:
        building.account.read_as("areas", "joints within shells, met by their mesh", names)
        return inside
    what = "joints within shells that do not touch them, as in the program"
    building.account.read_as("areas", what, names)
    return {}


def _corners(building: Building, area: AreaObject) -> FloatArray:
    return np.array([building.joints[name].position for name in area.joints])


def _tie(building: Building, decks: list[AreaObject]) -> None:
    # A diaphragm for the decks of each level, of all joints that they enclose.
    held = {j for c in building.constraints.values() if c.kind == "diaphragm" for j in c.joints}
    levels = Levels({name: joint.position for name, joint in building.joints.items()})
    joints: dict[int, dict[str, None]] = {}
    for area in decks:
        corners = _corners(building, area)
        here = joints.setdefault(level_of(float(corners[0, 2])), {})
        here.update(dict.fromkeys(name for name in levels.within(corners) if name not in held))
    for k, names in enumerate(joints.values(), start=1):
        label = f"decks-{k}"
        building.constraints[label] = Constraint(label, "diaphragm", tuple(names))
