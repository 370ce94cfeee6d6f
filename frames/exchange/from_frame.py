"""From a frame to a building of another program, its bearings as friction isolator links."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.building import (
    LINK_DOFS,
    Building,
    Constraint,
    FrameObject,
    Joint,
    JointLoad,
    LineLoad,
    LinkDof,
    LinkObject,
    LinkProperty,
    MassSource,
    Material,
    Modifiers,
    Pattern,
)
from frames.exchange.geometry import frame_axes
from frames.exchange.import_report import ImportReport
from frames.exchange.links import COINCIDENT, UPRIGHT
from frames.exchange.members import MOMENTS
from frames.exchange.pendulum_link import pendulum_link
from frames.exchange.properties import with_constants
from frames.exchange.shells import shell_parts, shells_of
from frames.exchange.tables import units_of
from frames.model.axes import default_up
from frames.model.components import DOFS
from frames.model.floors import members_at, panel_loads
from frames.statics.gravity import gravity

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.building import Vector
    from frames.model.components import BearingLink, Member
    from frames.model.frame_data import FrameData

_DEAD = "D"
_KINDS = {_DEAD: "Dead", "L": "Live", "S": "Snow"}


def building_of(
    frame: FrameData, displacement: float | None, words: str, program: str = "SAP2000"
) -> Building:
    """Return a frame as a building for a program, in the units of its file."""
    units = units_of(words, "units", ModelError)
    _refuse(frame, displacement, program)
    building = Building(frame.name, program, words, units, ImportReport(frame.name))
    _add_joints(frame, building)
    _add_members(frame, building)
    shells_of(frame, building)
    _add_loads(frame, building)
    _add_springs(frame, building)
    if frame.bearings:
        assert displacement is not None  # noqa: S101  # refused before
        _add_bearings(frame, building, displacement)
    return building


def _refuse(frame: FrameData, displacement: float | None, program: str) -> None:
    shells = {part.name for part in shell_parts(frame)}
    for word, group in (
        ("superelements", [name for name in frame.superelements if name not in shells]),
        ("nonlinear links", frame.links),
        ("plastic hinges", frame.hinges),
    ):
        if group:
            message = (
                f'frame "{frame.name}" has {word} ("{next(iter(group))}"), which cannot be '
                f"written for {program}: remove them from a copy, or model them there"
            )
            raise ModelError(message)
    if frame.bearings and displacement is None:
        message = (
            "bearings are written as friction isolator links with effective stiffness and "
            "damping at a displacement: set it, displacement=0.25 [m]"
        )
        raise ModelError(message)
    shared = [p.name for p in frame.floor_loads.values() if p.mass is not None]
    if shared:
        message = (
            f'floor load "{shared[0]}" has its own mass share, which cannot be written: use '
            "the mass source of its case"
        )
        raise ModelError(message)


def _add_joints(frame: FrameData, building: Building) -> None:
    for node in frame.nodes.values():
        building.joints[node.name] = Joint(node.name, *node.position, place="")
    building.restraints = {
        node: tuple(dof for dof in DOFS if dof in held) for node, held in frame.fixed_dofs.items()
    }
    building.masses = {node: tuple(values.tolist()) for node, values in frame.masses.items()}
    for part in frame.diaphragms.values():
        building.constraints[part.name] = Constraint(part.name, "diaphragm", tuple(part.nodes))
    flat = [level.nodes[0] for level in frame.levels]
    flat += [part.nodes[0] for part in frame.diaphragms.values()]
    building.stories = [(node, frame.nodes[node].z) for node in flat]


def _add_members(frame: FrameData, building: Building) -> None:
    materials: dict[tuple[float, float, float], str] = {}
    sections: dict[object, str] = {}
    for member in frame.members.values():
        section = member.section
        key = (section.elastic_modulus, section.shear_modulus, section.density)
        if key not in materials:
            materials[key] = name = f"M{len(materials) + 1}"
            building.materials[name] = _material(name, key, member.name, building.program)
        if section not in sections:
            sections[section] = name = f"S{len(sections) + 1}"
            width = math.sqrt(12.0 * section.inertia_z / section.area)
            found = with_constants(name, materials[key], "General", section)
            building.sections[name] = replace(found, width=width)
        start, end = (np.array(frame.nodes[n].position) for n in (member.i, member.j))
        words = {ours: theirs for theirs, ours in MOMENTS.items()}
        first, last = (frozenset(words[word] for word in end) for end in member.releases)
        ratio = _true(frame, member) / float(np.linalg.norm(end - start))
        building.frames[member.name] = FrameObject(
            member.name,
            member.i,
            member.j,
            sections[section],
            place="",
            angle=_angle(member, start, end, building.program),
            releases=(first, last),
            offset_i=member.offsets[0],
            offset_j=member.offsets[1],
            modifiers=Modifiers(mass=ratio) if member.has_offsets else Modifiers(),
            meshed=False,
        )


def _material(name: str, key: tuple[float, float, float], member: str, program: str) -> Material:
    # Without weight: weights are loads of joints, as in a frame.
    modulus, shear, density = key
    poisson = 0.5 * modulus / shear - 1.0
    if not -1.0 < poisson <= 0.5:
        message = (
            f'member "{member}": moduli {modulus:g} and {shear:g} Pa give a Poisson\'s ratio '
            f"of {poisson:g}, but {program} needs (-1, 0.5]: change shear_modulus"
        )
        raise ModelError(message)
    return Material(name, modulus, shear, poisson, density, 0.0)


def _true(frame: FrameData, member: Member) -> float:
    # Length between the ends of a member.
    first, last = (
        np.add(frame.nodes[node].position, offset)
        for node, offset in zip((member.i, member.j), member.offsets, strict=True)
    )
    return float(np.linalg.norm(last - first))


def _angle(member: Member, start: FloatArray, end: FloatArray, program: str) -> float:
    first, last = start + member.offsets[0], end + member.offsets[1]
    along = (last - first) / np.linalg.norm(last - first)
    axes = frame_axes(start, end)
    if float(along @ axes[0]) < 1.0 - 1e-12:
        message = (
            f'member "{member.name}": its offsets rotate its axis, but local axes in '
            f"{program} follow the line between nodes: use the same transverse offset at "
            "both ends"
        )
        raise ModelError(message)
    up = default_up(first[None], last[None])[0] if member.up is None else np.array(member.up)
    second = up - (up @ axes[0]) * axes[0]
    turned = math.degrees(math.atan2(float(second @ axes[2]), float(second @ axes[1])))
    return turned if abs(turned) > 1e-9 else 0.0


def _add_loads(frame: FrameData, building: Building) -> None:
    names = sorted({_DEAD, *frame.load_cases, *frame.mass_source})
    building.patterns = {name: Pattern(name, _KINDS.get(name, "Other"), 0.0) for name in names}
    shares = {name: share for name, share in frame.mass_source.items() if share}
    building.mass_source = MassSource(elements=True, added=True, patterns=shares)
    at: dict[tuple[str, str], FloatArray] = defaultdict(lambda: np.zeros(6))
    for node, weight in _weights(frame).items():
        at[node, _DEAD] = np.array([0.0, 0.0, -weight, 0.0, 0.0, 0.0])
    if shares.get(_DEAD) and at:
        message = (
            "masses with weight cannot be written if dead loads are also masses: use "
            "add_mass(..., weighs=False), sections with density 0, and loads for their "
            "weights"
        )
        raise ModelError(message)
    for node, cases in frame.loads_by_case.items():
        for case, forces in cases.items():
            at[node, case] = at[node, case] + forces
    for name, by_case in frame.uniform_loads_by_case.items():
        for case, load in by_case.items():
            _add_line(frame, building, name, case, (0.0, 1.0), load, load)
    spans = [(name, x) for name, loads in frame.tapered_loads.items() for x in loads]
    around = members_at(frame.members) if frame.floor_loads else {}
    for panel in frame.floor_loads.values():
        parts = panel_loads(frame.nodes, around, panel)
        spans += parts.members
        for node, forces in parts.nodes:
            at[node, panel.case] = at[node, panel.case] + forces
    for name, part in spans:
        length = _true(frame, frame.members[name])
        where = (part.a / length, part.b / length)
        _add_line(frame, building, name, part.case, where, part.start, part.end)
    building.joint_loads = [
        JointLoad(node, case, tuple(forces.tolist())) for (node, case), forces in at.items()
    ]


def _weights(frame: FrameData) -> dict[str, float]:
    # Weight of masses and members, at the nodes of their mass.
    mass: dict[str, float] = defaultdict(float)
    for node, values in frame.masses.items():
        none = frame.weightless_masses.get(node, np.zeros(6))
        mass[node] = float(values[2] - none[2])
    for member in frame.members.values():
        half = 0.5 * member.section.density * member.section.area * _true(frame, member)
        for node in (member.i, member.j):
            mass[node] += half
    scale = frame.gravity * frame.weight_factor
    return {node: scale * value for node, value in mass.items() if value}


def _add_line(
    frame: FrameData,
    building: Building,
    name: str,
    case: str,
    where: tuple[float, float],
    start: FloatArray | Vector,
    end: FloatArray | Vector,
) -> None:
    # Per length between the joints, as in the programs.
    member = frame.members[name]
    whole = math.dist(*(frame.nodes[n].position for n in (member.i, member.j)))
    scale = _true(frame, member) / whole
    (a, b, c), (d, e, f) = (np.multiply(scale, size).tolist() for size in (start, end))
    building.line_loads.append(LineLoad(name, case, *where, (a, b, c), (d, e, f)))


def _add_springs(frame: FrameData, building: Building) -> None:
    used = {n for m in frame.members.values() for n in (m.i, m.j)}
    used |= {n for part in frame.bearings.values() for n in (part.i, part.j)}
    for spring in frame.springs.values():
        ends = (spring.i, spring.j)
        first, last = (np.array(frame.nodes[n].position) for n in ends)
        held = [n for n in ends if len(frame.fixed_dofs.get(n, ())) == 6 and n not in used]
        apart = float(np.linalg.norm(last - first))
        if building.program == "ETABS" and held and apart < COINCIDENT:
            # ETABS merges joints at one place, and has springs of points for them
            joint = spring.i if spring.j == held[0] else spring.j
            others = building.springs.get(joint, (0.0,) * 6)
            building.springs[joint] = tuple(np.add(others, spring.stiffness).tolist())
            del building.joints[held[0]], building.restraints[held[0]]
            continue
        axes = frame_axes(first, last) if apart > COINCIDENT else UPRIGHT
        if float(np.abs(axes).max(axis=1).min()) < 1.0 - 1e-9:
            message = (
                f'spring "{spring.name}" joins nodes that do not lie along a global axis, '
                "which a link does not support: join nodes along X, Y or Z"
            )
            raise ModelError(message)
        dofs = {}
        for k, dof in enumerate(LINK_DOFS):
            value = spring.stiffness[int(np.abs(axes[k % 3]).argmax()) + (3 if k >= 3 else 0)]
            if value:
                dofs[dof] = LinkDof(False, value, 0.0, False, {})
        _add_link(building, spring.name, ends, LinkProperty(f"K-{spring.name}", "Linear", dofs))


def _add_link(building: Building, name: str, ends: tuple[str, str], prop: LinkProperty) -> None:
    building.link_properties[prop.name] = prop
    building.links[name] = LinkObject(name, *ends, property=prop.name, place="")


def _add_bearings(frame: FrameData, building: Building, displacement: float) -> None:
    state = gravity(frame)
    loads = dict(zip((b.name for b in state.system.bearings), state.axial_forces, strict=True))
    for part in frame.bearings.values():
        prop = _isolator(part, float(loads[part.name]), displacement)
        _add_link(building, part.name, (part.i, part.j), prop)


def _isolator(part: BearingLink, load: float, displacement: float) -> LinkProperty:
    if load <= 0.0:
        message = (
            f'bearing "{part.name}" carries {load:g} N under the permanent loads, but a link '
            "needs compression: add load on it"
        )
        raise ModelError(message)
    link = pendulum_link(part.bearing, load, displacement)
    shear = LinkDof(
        False,
        link.effective,
        link.damping,
        nonlinear=True,
        values={
            "place": 0.0,
            "stiffness": link.elastic,
            "slow": link.slow,
            "fast": link.fast,
            "rate": link.rate,
            "radius": link.radius,
        },
    )
    axial = {"stiffness": link.vertical, "damping": 0.0}
    dofs = {"U1": LinkDof(False, link.vertical, 0.0, nonlinear=True, values=axial)}
    return LinkProperty(f"FP-{part.name}", "Friction Isolator", dofs | {"U2": shear, "U3": shear})
