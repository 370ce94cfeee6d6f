"""Account of an import: statements on the frame, and doubts about the intended model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames._errors import argument
from frames.exchange.building import AreaLoad, JointLoad
from frames.exchange.geometry import is_offset
from frames.exchange.loads import OWN_MASS, Sizes, own_loads
from frames.exchange.members import LEAST_FACTOR
from lir_element.elevations import SAME_PLACE
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames.exchange.building import Building, LineLoad, MassSource
    from frames.exchange.geometry import SplitMember
    from frames.exchange.import_report import Options
    from frames.exchange.members import Places, Sections
    from frames.exchange.mesh import Mesh
    from frames.exchange.slabs import Slabs
    from frames.model.frame_data import FrameData


LIGHT_BASE = 0.01
"""Share of the mass that the level on the bearings needs, below which it is doubted [-]."""

WEIGHTLESS = 0.05
"""Share of the volume of all elements that may have no weight [-]."""

MASS_OVER_WEIGHT = (0.5, 1.05)
"""Mass times gravity over the permanent loads that belong to it, which is not doubted [-]."""


def doubt_weights(
    building: Building, shares: Mapping[str, float], source: MassSource, gravity: float
) -> None:
    """Warn of materials without weight, and of a mass that does not fit the permanent loads."""
    account, size = building.account, Sizes(building)
    heavy = [name for name, pattern in building.patterns.items() if pattern.self_weight]
    known, volume = building.materials, sum(size.volumes.values())
    without = {k: v for k, v in size.volumes.items() if k in known and not known[k].weight}
    if heavy and sum(without.values()) > WEIGHTLESS * volume:
        part = 100.0 * sum(without.values()) / volume
        account.doubts.append(
            worded(
                "{file}: material {names} has no weight, so {part:.3g} % of the volume of "
                'all elements weighs nothing in pattern "{pattern}". Set the weight in that '
                "program, and export again",
                file=account.file,
                names=_quoted(without),
                pattern=heavy[0],
                part=part,
            )
        )
    loads: list[LineLoad | AreaLoad | JointLoad] = [
        *building.line_loads,
        *building.area_loads,
        *building.joint_loads,
    ]
    down = size.down(loads)
    for name in heavy:
        own = size.down(own_loads(building, name)).get(name, 0.0)
        down[name] = down.get(name, 0.0) + building.patterns[name].self_weight * own
    weight = sum(share * down.get(name, 0.0) for name, share in shares.items())
    parts = {
        "of load patterns": sum(s * down.get(name, 0.0) for name, s in source.patterns.items()),
        "of elements": sum(size.down(own_loads(building, OWN_MASS, gravity)).values())
        if source.elements
        else 0.0,
        "added to joints": gravity * sum(0.5 * (v[0] + v[1]) for v in building.masses.values())
        if source.added
        else 0.0,
    }
    mass = sum(parts.values())
    if mass <= 0.0 or weight <= 0.0:
        return
    low, high = MASS_OVER_WEIGHT
    if low <= mass / weight <= high:
        return
    masses = (
        worded("{mass:.4g} t {where}", mass=1e-3 * v / gravity, where=word)
        for word, v in parts.items()
        if v
    )
    what = (
        worded(
            "{part:.3g} % of the mass has no weight, so loads on the bearings are too low",
            part=100.0 * (1.0 - weight / mass),
        )
        if mass > weight
        else worded(
            "{part:.3g} % of the permanent loads have no mass", part=100.0 * (1.0 - mass / weight)
        )
    )
    same = {name: share for name, share in shares.items() if share and down.get(name, 0.0) > 0.0}
    account.doubts.append(
        worded(
            "{file}: the mass ({said}) corresponds to {mass:.4g} kN, but the permanent "
            "loads are {weight:.4g} kN: {what}. Correct the file, or take the mass from "
            "the loads, {remedy}",
            file=account.file,
            said=joined(*masses, by=", "),
            mass=1e-3 * mass,
            weight=1e-3 * weight,
            what=what,
            remedy=argument("mass", same),
        )
    )


def doubt_base(
    frame: FrameData, building: Building, places: Places, options: Options, turned: list[str]
) -> None:
    """Warn of supports that carry load besides the bearings, and of a light base."""
    account = building.account
    tops = {part.j for part in frame.bearings.values()}
    if not tops:
        return
    for part in building.constraints.values():
        tied = tops.intersection(part.joints)
        if part.kind in {"equal", "body"} and "uz" in part.dofs and len(tied) > 1:
            how = "settle by the same" if part.kind == "equal" else "settle as one rigid block"
            account.doubts.append(
                worded(
                    '{file}: constraint "{name}" ties uz of {count} joints on bearings, '
                    "which {how}, so bearing loads are wrong. Remove UZ, RX and RY from it, "
                    "unless the base is rigid",
                    file=account.file,
                    name=part.name,
                    count=len(tied),
                    how=how,
                )
            )
    beams = [m.name for m in frame.members.values() if {m.i, m.j} <= tops]
    held = sorted(set(turned) & tops)
    if options.base_rotations == "kept" and held and beams:
        account.doubts.append(
            worded(
                "{file}: supports fix the rotations of {count} joints on bearings ({some}), "
                'so column moments do not reach the beams ("{beam}"). Free the rotations, '
                "{remedy}",
                file=account.file,
                count=len(held),
                some=account.some(held),
                beam=beams[0],
                remedy=argument("base_rotations", "free"),
            )
        )
    level = {frame.nodes[node].z for node in tops}
    every = {node: float(values[0]) for node, values in frame.masses.items()}
    at_base = {n for n in every if any(abs(frame.nodes[n].z - z) < SAME_PLACE for z in level)}
    base = sum(every[node] for node in at_base)
    whole = sum(every.values())
    if base < LIGHT_BASE * whole:
        account.doubts.append(
            worded(
                "{file}: the level on the bearings has only {mass:.3g} t, {part:.2g} % of "
                "the mass, so its accelerations are not valid. Model the slab or the beams "
                "there, or add their mass",
                file=account.file,
                mass=1e-3 * base,
                part=100.0 * base / whole,
            )
        )


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f'"{name}"' for name in names)


def note_members(building: Building, sections: Sections, divided: list[SplitMember]) -> None:
    """Record frame objects that became something else: softened, divided, offset, cut."""
    account = building.account
    account.read_as(
        "sections",
        worded("with a stiffness factor of 0, read as {factor:g}", factor=LEAST_FACTOR),
        sorted(sections.softened),
    )
    sizes = Sizes(building)
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
        account.read_as("frames", what, names, *sizes.shares(names))


def note_areas(building: Building, slabs: Slabs, mesh: Mesh) -> None:
    """Record loads of areas that went to their corners, and the directions of masses."""
    account = building.account
    shells = {area for area, _ in mesh.elements}
    loaded = [name for name in slabs.at_corners if name not in shells]
    account.read_as("areas", "loads on areas, at their corners: no members around them", loaded)
    if building.patterns:
        account.read_as("masses", "of loads and elements, in all three directions", ["all"])
