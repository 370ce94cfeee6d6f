"""What the account of an import says of members and areas once the frame is made."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.exchange.members import LEAST_FACTOR
from frames.exchange.shares import Shares
from frames.exchange.stations import is_offset

if TYPE_CHECKING:
    from frames.exchange.building import Building
    from frames.exchange.members import Sections
    from frames.exchange.mesh import Mesh
    from frames.exchange.slabs import Slabs
    from frames.exchange.stations import Divided


def note_members(building: Building, sections: Sections, divided: list[Divided]) -> None:
    """Note frame objects that became something else: softened, divided, offset, cut."""
    account = building.account
    account.read_as(
        "sections",
        f"with a stiffness of none, taken as {LEAST_FACTOR:g} of it",
        sorted(sections.softened),
    )
    shares = Shares(building)
    cases = {
        "divided at joints on their line or under point loads": [
            one for one in divided if len(one.nodes) > 2
        ],
        "stiff end zones that reach beyond the next joint or leave no length, cut before it": [
            one for one in divided if one.cut
        ],
        "insertion points that do not transform the stiffness, as the file says": [
            one
            for one in divided
            if not one.frame.transforms and (one.frame.cardinal < 10 or any(one.frame.offset_i))
        ],
        "insertion points, as rigid offsets": [one for one in divided if is_offset(one.frame)],
    }
    for what, found in cases.items():
        names = [one.frame.name for one in found]
        account.read_as("frames", what, names, *shares.of(names))


def note_areas(building: Building, slabs: Slabs, mesh: Mesh) -> None:
    """Note loads of areas that went to their corners, and in which directions masses act."""
    account = building.account
    shells = {area for area, _ in mesh.elements}
    loaded = [name for name in slabs.at_corners if name not in shells]
    account.read_as("areas", "loads on areas, at their corners: no members around them", loaded)
    if building.patterns:
        account.read_as("masses", "of loads and elements, in all three directions", ["all"])
