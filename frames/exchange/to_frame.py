"""From a building of another program to a frame on bearings."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from frames._errors import ModelError, ModelWarning, argument
from frames.exchange.building import MassSource
from frames.exchange.doubts import doubt_base, doubt_weights, note_areas, note_members
from frames.exchange.etabs import read_etabs
from frames.exchange.geometry import divide, under_loads
from frames.exchange.import_report import Options
from frames.exchange.links import Links, yield_displacements
from frames.exchange.loads import OWN_MASS, Sizes
from frames.exchange.members import (
    Places,
    Sections,
    add_constraints,
    add_members,
    add_supports,
    levels_of,
)
from frames.exchange.mesh import Mesh, mesh_areas
from frames.exchange.sap2000 import read_sap2000
from frames.exchange.shells import add_shells, choose_shells, meet_joints, with_quadrilaterals
from frames.exchange.slabs import Loading, Slabs
from frames.frame import Frame
from frames.model.load_combinations import applied_loads, load_masses
from lir_element._compile.front_end import gc_paused
from lir_element.elevations import SAME_PLACE
from lir_element.texts import worded

if TYPE_CHECKING:
    from pathlib import Path

    from frames.exchange.building import AreaObject, Building
    from frames.exchange.geometry import Points, SplitMember
    from lir_element import LIRBearing

_KINDS = (
    ("D", ("dead", "super dead", "superdead", "superimposed dead")),
    ("L", ("live", "reducible live", "reduce live", "roof live", "reducelive", "rooflive")),
    ("S", ("snow",)),
)
"""Load cases of the frame, and the kinds of patterns that belong to them."""


F = TypeVar("F", bound=Frame)

READERS = {"SAP2000": read_sap2000, "ETABS": read_etabs}
"""Readers of files by program."""


def imported(
    kind: type[F], program: str, path: str | Path, options: Options, name: str | None
) -> F:
    """Return a program's model as a frame on bearings, and warn of probable mistakes."""
    building = READERS[program](path, options)
    building.account.doing(f"{len(building.frames)} frame objects, {len(building.areas)} areas")
    frame = kind(building.name if name is None else name)
    try:
        with gc_paused():  # loads by the hundred thousand: a third of the time
            devices = fill(frame, building, options)
    finally:
        building.account.doing(f"{len(frame.nodes)} nodes, {len(frame.members)} members", ends=True)
    frame = frame.with_bearings(devices) if devices else frame
    building.account.groups = {
        name: tuple(label for kind, label in members if kind in {"joint", "link"})
        for name, members in building.groups.items()
    }
    frame._imported = building.account
    for doubt in building.account.doubts:
        warnings.warn(doubt, ModelWarning, stacklevel=3)
    return frame


def fill(frame: Frame, building: Building, options: Options) -> dict[str, LIRBearing]:
    """Add all of a building to an empty frame, on bearings."""
    with building.account.together():
        return _filled(frame, building, options)


def judged(building: Building, options: Options) -> Judged:
    """Return the input of the frame; all reasons against the building are one error."""
    with building.account.together():
        source = _source(building, options)
        shells = with_quadrilaterals(building, choose_shells(building), options.mesh)
        found = Judged(source, shells, permanent(building, options), Places(building, options))
        building.account.settle()
        return found


class Judged(NamedTuple):
    """Masses of a building, shells, permanent loads, and places of bearings."""

    source: MassSource
    shells: list[AreaObject]
    factors: dict[str, tuple[float, str]]
    places: Places


def _filled(frame: Frame, building: Building, options: Options) -> dict[str, LIRBearing]:
    source, shells, factors, places = judged(building, options)
    points = _points(building)
    if not points:
        message = (
            f"{building.account.file} has no frame, area or link, and nothing on a joint: export "
            "the whole model"
        )
        raise ModelError(message)
    building.account.doing(f"mesh of {len(shells)} walls and slabs")
    inside = meet_joints(building, shells, points)
    mesh = mesh_areas(shells, points, options.mesh, inside)
    at_loads: dict[str, list[float]] = {}
    for load in building.line_loads:
        if load.point and (load.pattern in factors or load.pattern in source.patterns):
            at_loads.setdefault(load.frame, []).append(load.a)
    joints = dict(points)
    divided = divide(building, points, at_loads)
    _add_nodes(frame, building, points, mesh, divided)
    sections = Sections(building)
    add_members(frame, divided, sections)
    turned = add_supports(frame, building, places, options)
    _hold_edges(frame, building, places, mesh)
    _hold_pins(frame, building, divided, mesh)
    links = Links(frame, building, places)
    links.add()
    add_constraints(frame, building, places, options)
    loading = Loading(building, {one.frame.name: one for one in divided}, mesh)
    slabs = Slabs(frame, building)
    _add_masses(frame, building, loading, slabs, source, under_loads(divided, joints))
    building.account.settle()  # before the slow part
    _add_shells(frame, building, mesh)
    loading.put(frame, slabs, factors, own=False)
    _add_levels(frame, building, places)
    if options.loads is None or options.loads == "all":  # others are the choice of the user
        shares = permanent_shares(building, replace(options, loads=None))
        doubt_weights(building, shares, source, frame.gravity)
    doubt_base(frame, building, places, options, turned)
    note_members(building, sections, divided)
    note_areas(building, slabs, mesh)
    building.account.finish()
    return yield_displacements(frame, links.stiffness) if links.stiffness else {}


def permanent(building: Building, options: Options) -> dict[str, tuple[float, str]]:
    """Return factor and case of the load patterns that are permanent loads of the frame."""
    shares, account = permanent_shares(building, options), building.account
    account.left_out(
        "load patterns",
        "which are no permanent loads here",
        [name for name in building.patterns if not shares.get(name)],
    )
    part = [
        worded("{name} by {share:g}", name=name, share=share)
        for name, share in shares.items()
        if share not in {0.0, 1.0}
    ]
    account.read_as("load patterns", "permanent loads by a factor", part)
    return {
        name: (share, case_of(building.patterns[name].kind) or "D")
        for name, share in shares.items()
        if share and name in building.patterns
    }


def permanent_shares(building: Building, options: Options) -> dict[str, float]:
    """Return the factors of the load patterns that are permanent loads of the frame."""
    given = options.loads
    if given == "all":
        given = {name: 1.0 for name, part in building.patterns.items() if case_of(part.kind)}
    if isinstance(given, str):
        if given not in building.combinations:
            some = ", ".join(building.combinations) or "none"
            message = (
                f'loads = "{given}" is not a combination of {building.account.file}: it has {some}'
            )
            raise ModelError(message)
        given = building.combinations[given]
    shares: dict[str, float] = {}
    if given is not None:
        for name, factor in given.items():
            if name not in building.patterns:
                some = ", ".join(building.patterns) or "none"
                message = (
                    f'loads: "{name}" is not a load pattern of {building.account.file}: {some}'
                )
                raise ModelError(message)
            shares[name] = float(factor)
    else:
        source = building.mass_source.patterns if building.mass_source else {}
        shares = dict(options.mass if options.mass is not None else source)
        for name, pattern in building.patterns.items():
            if case_of(pattern.kind) == "D":
                shares.setdefault(name, 1.0)
    return shares


def case_of(kind: str) -> str:
    """Return the load case of a kind of pattern: "D", "L", "S", or none."""
    word = kind.strip().lower()
    return next((case for case, words in _KINDS if word in words), "")


def _source(building: Building, options: Options) -> MassSource:
    if options.mass is None:
        if building.mass_source is None:
            live = [name for name, p in building.patterns.items() if case_of(p.kind) == "L"]
            dead = [name for name, p in building.patterns.items() if case_of(p.kind) == "D"]
            shares = dict.fromkeys(dead or ["DEAD"], 1.0) | dict.fromkeys(live, 0.25)
            building.account.fault(
                f"{building.account.file} has no mass source: define it (Define > Mass "
                "Source) and export the file again, or set shares of load patterns as mass, "
                f"{argument('mass', shares)}"
            )
        return building.mass_source or MassSource(elements=False, added=False, patterns={})
    unknown = [name for name in options.mass if name not in building.patterns]
    if unknown:
        some = ", ".join(building.patterns) or "none"
        message = f'mass: "{unknown[0]}" is not a load pattern of {building.account.file}: {some}'
        raise ModelError(message)
    return MassSource(elements=False, added=False, patterns=dict(options.mass))


def _points(building: Building) -> Points:
    # Joints that something needs.
    used = {joint for frame in building.frames.values() for joint in (frame.i, frame.j)}
    used |= {joint for area in building.areas.values() for joint in area.joints}
    used |= {link.i for link in building.links.values()}
    used |= {link.j for link in building.links.values() if link.j is not None}
    idle = [name for name in building.joints if name not in used]
    needed = set(building.springs) | set(building.masses)
    needed |= {load.joint for load in building.joint_loads}
    needed |= {joint for part in building.constraints.values() for joint in part.joints}
    plain = [name for name in idle if name not in needed]
    building.account.left_out("joints", "which nothing needs", plain)
    for name in plain:
        building.restraints.pop(name, None)
    kept = used | needed
    return {name: joint.position for name, joint in building.joints.items() if name in kept}


def _add_nodes(
    frame: Frame, building: Building, points: Points, mesh: Mesh, divided: list[SplitMember]
) -> None:
    for name, place in points.items():
        frame.add_node(name, *place)
    # nodes without stiffness of their own cannot move by themselves
    stiff = {node for one in divided for node in one.nodes}
    stiff |= {node for _, nodes in mesh.elements for node in nodes}
    stiff |= {j for link in building.links.values() for j in (link.i, link.j) if j is not None}
    tied = {j for part in building.constraints.values() for j in part.joints}
    for name in points:
        if name in stiff:
            continue
        spring = building.springs.get(name, (0.0,) * 6)
        held = ["ux", "uy", "uz", "rx", "ry", "rz"]
        kind = {c.kind for c in building.constraints.values() if name in c.joints}
        if "body" in kind or "equal" in kind:
            continue
        if name in tied:
            held = ["uz", "rx", "ry"]
        free = [
            dof for dof, k in zip(("ux", "uy", "uz", "rx", "ry", "rz"), spring, strict=True) if k
        ]
        frame.fix(name, *(dof for dof in held if dof not in free))


def _add_shells(frame: Frame, building: Building, mesh: Mesh) -> None:
    if mesh.elements:
        add_shells(frame, building, mesh)
        areas = list(dict.fromkeys(area for area, _ in mesh.elements))
        what = worded("shells, in {count} elements of OpenSees", count=len(mesh.elements))
        building.account.read_as("areas", what, areas, *Sizes(building).shares(areas))


def _hold_edges(frame: Frame, building: Building, places: Places, mesh: Mesh) -> None:
    # Nodes of a mesh along an edge whose corners are both held: held as they are.
    fixed, free = [], []
    for node, (one, two) in mesh.between.items():
        both = set(building.restraints.get(one, ())) & set(building.restraints.get(two, ()))
        if not both:
            continue
        if one in places.joints or two in places.joints:
            free.append(node)
        else:
            frame.fix(node, *sorted(both))
            fixed.append(node)
    what = "nodes of the mesh along edges whose corners are supports, held as these"
    building.account.read_as("supports", what, fixed)
    what = "nodes of the mesh along edges whose corners stand on bearings, free between these"
    building.account.read_as("supports", what, free)


def _hold_pins(frame: Frame, building: Building, divided: list[SplitMember], mesh: Mesh) -> None:
    # Nodes at which every member is hinged: nothing holds their rotations.
    ends: dict[str, list[bool]] = {}
    for one in divided:
        last = len(one.nodes) - 1
        for place, node in enumerate(one.nodes):
            words = one.frame.releases[0] if place == 0 else one.frame.releases[1]
            pinned = place in {0, last} and {"M2", "M3"} <= words
            ends.setdefault(node, []).append(pinned)
    shells = {node for _, nodes in mesh.elements for node in nodes}
    others = {j for link in building.links.values() for j in (link.i, link.j)} | shells
    others |= set(building.springs)
    free = [node for node, pins in ends.items() if all(pins) and node not in others]
    for node in free:
        frame.fix(node, "rx", "ry", "rz")
    building.account.read_as("joints", "with hinges alone, whose rotations are held", free)


def _add_masses(
    frame: Frame,
    building: Building,
    loading: Loading,
    slabs: Slabs,
    source: MassSource,
    between: dict[str, list[tuple[str, float]]],
) -> None:
    # As the programs lump them: at joints, those of nodes under point loads by the lever.
    scratch = frame.copy()
    shares = {name: 1.0 for name, share in source.patterns.items() if share}
    loading.put(
        scratch,
        slabs.onto(scratch),
        {name: (1.0, name) for name in shares},
        own=source.elements,
    )
    scratch.set_mass_source({**source.patterns, OWN_MASS: 1.0})
    for node, mass in load_masses(scratch, applied_loads(scratch)).items():
        for joint, share in between.get(node, [(node, 1.0)]):
            frame.add_mass(joint, share * mass, weighs=False)
    if not source.added:
        building.account.left_out(
            "masses",
            "masses added to joints, which the mass source leaves out",
            list(building.masses),
        )
        return
    vertical = []
    for joint, values in building.masses.items():
        if abs(values[0] - values[1]) > 1e-9 * max(values):
            what = "masses that differ between X and Y, taken by their mean"
            building.account.refuse("directional masses", "masses", what, [joint])
        if abs(values[2] - values[0]) > 1e-9 * max(values):
            vertical.append(joint)
        inertia = [float(v) for v in values[3:]]
        frame.add_mass(joint, 0.5 * (values[0] + values[1]), inertia, weighs=False)
    building.account.read_as("masses", "masses in plan, which act vertically as well", vertical)


def _add_levels(frame: Frame, building: Building, places: Places) -> None:
    nodes = frame.nodes
    joints = [name for name in building.joints if name in nodes]
    groups = {nodes[group[0]].z: group for group in levels_of(frame, joints)}
    stories = sorted(building.stories, key=lambda story: story[1])
    if not stories:
        flat = (m for m in frame.members.values() if abs(nodes[m.i].z - nodes[m.j].z) < SAME_PLACE)
        own = [node for part in frame.diaphragms.values() for node in part.nodes]
        found = levels_of(frame, [*(own or (m.i for m in flat)), *places.joints])
        stories = [(f"level-{k}", nodes[group[0]].z) for k, group in enumerate(found)]
    for name, z in stories:
        near = min(groups, key=lambda other: abs(other - z))
        if abs(near - z) < 2.0 * SAME_PLACE:
            frame.add_level(name, groups[near])
