"""Areas that are shells, and their stiffness by the elements of OpenSees, as a superelement."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from frames.exchange.building import AreaObject, AreaSection, Constraint, Joint, Material
from frames.exchange.geometry import Levels, area_normal
from frames.exchange.loads import Sizes
from frames.exchange.mesh import edges_of, joints_within
from frames.model.superelement import ShellElement, WithoutForces, no_elements
from frames.opensees.model import read_initial
from lir_element.argument_checks import listed
from lir_element.elevations import SAME_PLACE
from lir_element.opensees.library import opensees

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray
    from frames.exchange.building import Building
    from frames.exchange.geometry import Points
    from frames.exchange.import_report import ImportReport
    from frames.exchange.mesh import Inside, Mesh
    from frames.frame import Frame
    from frames.model.frame_data import FrameData
    from frames.model.superelement import Superelement


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
        level = float(np.ptp(_corners(building, area)[:, 2])) < SAME_PLACE
        if level and any(set(area.joints) <= joints for joints in sets):
            flat.append(area.name)
        elif level and section.kind == "membrane" and section.one_way:
            loose.append(area)
        else:
            found.append(area)
    what = "slabs in rigid diaphragms, by their loads and masses alone: their bending is not stiff"
    building.account.read_as("areas", what, flat, *Sizes(building).shares(flat))
    if loose:
        what = "one-way decks in no rigid diaphragm, taken as rigid in their plane"
        names = [area.name for area in loose]
        building.account.refuse("loose decks", "areas", what, names, loose[0].place)
        _tie(building, loose)
    return found


def with_quadrilaterals(
    building: Building, shells: list[AreaObject], mesh: float
) -> list[AreaObject]:
    """Return shells, and the parts of those of more than four corners, or of triangles to divide.

    Each corner of these areas has one part: to the middles of its edges and to their centre, which
    must see all edges. The building has the parts, their joints and their loads.
    """
    many = [area for area in shells if len(area.joints) > 4]
    three = [area for area in shells if len(area.joints) == 3 and building.program == _MESHED]
    if three:  # by joints on them, or by their size
        points = {name: joint.position for name, joint in building.joints.items()}
        met = joints_within(three, points, edges=True)
        many += [
            area
            for area in three
            if area.name in met
            or max(math.dist(points[a], points[b]) for a, b in edges_of(area)) > mesh
        ]
    if not many:
        return shells
    at = {_rounded(joint.position): name for name, joint in building.joints.items()}

    def joint(name: str, place: FloatArray, of: AreaObject) -> str:
        x, y, z = place.tolist()
        found = at.setdefault(_rounded((x, y, z)), name)
        building.joints.setdefault(found, Joint(found, x, y, z, of.place))
        return found

    parts: dict[str, list[AreaObject]] = {}
    for area in many:
        corners = _corners(building, area)
        middle = corners.mean(axis=0)
        normal, _ = area_normal(corners)
        turns = np.cross(corners - middle, np.roll(corners, -1, axis=0) - middle) @ normal
        if turns.min() <= 0.0:
            message = (
                f'{area.place}: area "{area.name}" is a shell of {len(corners)} corners with '
                "a reentrant corner: divide it, or assign a rigid diaphragm"
            )
            building.account.fault(message)
            continue
        ring = [
            joint(f"{a}~{b}~", 0.5 * (one + two), area)
            for (a, b), one, two in zip(
                edges_of(area), corners, np.roll(corners, -1, axis=0), strict=True
            )
        ]
        centre = joint(f"{area.name}~", middle, area)
        parts[area.name] = [
            replace(
                area, name=f"{area.name}/{k + 1}", joints=(corner, ring[k], centre, ring[k - 1])
            )
            for k, corner in enumerate(area.joints)
        ]
    what = "polygons, by quadrilaterals around their centres"
    building.account.read_as("areas", what, list(parts))
    building.areas = {
        part.name: part for name, area in building.areas.items() for part in parts.get(name, [area])
    }
    building.area_loads = [
        replace(load, area=name)
        for load in building.area_loads
        for name in ([part.name for part in parts.get(load.area, ())] or [load.area])
    ]
    return [part for area in shells for part in parts.get(area.name, [area])]


def _rounded(place: tuple[float, float, float]) -> tuple[float, ...]:
    return tuple(round(value, 3) for value in place)


def meet_joints(building: Building, shells: list[AreaObject], points: Points) -> Inside:
    """Return the joints within shells that must be nodes of their mesh."""
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
        here = joints.setdefault(levels.level(float(corners[0, 2])), {})
        here.update(dict.fromkeys(name for name in levels.within(corners) if name not in held))
    for k, names in enumerate(joints.values(), start=1):
        label = f"decks-{k}"
        building.constraints[label] = Constraint(label, "diaphragm", tuple(names))


AT_ONCE = 8
"""Elements whose matrices are read together, in a full one."""

_ALIKE = 9  # decimals of the sides of equal elements [m]


_PLUMB = 1e-6  # cosine of a normal, below which an area is vertical

NONE = 1e-6
"""Factor that replaces zero on a stiffness [-]."""

QUAD, TRIANGLE = "ShellMITC4", "ShellDKGT"
"""Elements of OpenSees: Dvorkin & Bathe (1984); discrete Kirchhoff triangle with a membrane."""


def add_shells(frame: Frame, building: Building, mesh: Mesh) -> None:
    """Add the stiffness of all shells to a frame that has their nodes."""
    if not mesh.elements:
        return
    ops = opensees()
    if ops.getNodeTags():
        message = (
            "walls and slabs are read through OpenSees, which has another model: call "
            "openseespy.opensees.wipe() first, or import in a separate process"
        )
        raise ModelError(message)
    names = list(dict.fromkeys(node for _, nodes in mesh.elements for node in nodes))
    index = {name: k for k, name in enumerate(names)}
    points = np.array([frame.nodes[name].position for name in names])
    kinds: dict[tuple[object, ...], list[IntArray]] = {}  # nodes of equal elements
    for area, nodes in mesh.elements:
        numbers = np.array([index[node] for node in nodes])
        sides = points[numbers[1:]] - points[numbers[0]]
        key = (shell_numbers(building, building.areas[area]), *sides.round(_ALIKE).ravel().tolist())
        kinds.setdefault(key, []).append(numbers)
    corners = [points[alike[0]] for alike in kinds.values()]
    found = _matrices(ops, list(kinds), corners, building.account)
    rows, columns, values = [], [], []
    for matrix, alike in zip(found, kinds.values(), strict=True):
        dofs = (6 * np.array(alike)[:, :, None] + np.arange(6)).reshape(len(alike), -1)
        rows.append(np.repeat(dofs, dofs.shape[1], axis=1).ravel())
        columns.append(np.tile(dofs, dofs.shape[1]).ravel())
        values.append(np.tile(matrix.ravel(), len(alike)))
    every = (np.concatenate(rows), np.concatenate(columns))
    size = 6 * len(names)
    stiffness = sparse.csr_array((np.concatenate(values), every), shape=(size, size))
    shells = [
        ShellElement(area, nodes, *shell_numbers(building, building.areas[area]))
        for area, nodes in mesh.elements
    ]
    frame.add_superelement(
        "shells",
        names,
        stiffness,
        sparse.csr_array(stiffness.shape),
        elements=no_elements(_told(mesh), shells),
    )


def _told(mesh: Mesh) -> list[WithoutForces]:
    # Elements by kind, with the areas that they are of.
    found = []
    for kind, corners in ((QUAD, 4), (TRIANGLE, 3)):
        of = [area for area, nodes in mesh.elements if len(nodes) == corners]
        if of:
            areas = list(dict.fromkeys(of))
            some = f"areas {listed(areas)}"
            found.append(WithoutForces(kind, len(of), some, "shells of walls and slabs"))
    return found


def _matrices(
    ops: Any, keys: list[tuple[Any, ...]], corners: list[FloatArray], account: ImportReport
) -> list[FloatArray]:
    # Stiffness of single elements, some of them in one model, each with nodes of its own.
    found: list[FloatArray] = []
    try:
        for start in range(0, len(keys), AT_ONCE):
            account.doing(f"stiffness of {start} of {len(keys)} shapes of walls and slabs")
            ops.wipe()
            ops.model("basic", "-ndm", 3, "-ndf", 6)
            tags: list[int] = []
            blocks = []
            for k in range(start, min(start + AT_ONCE, len(keys))):
                modulus, poisson, thickness, bending = keys[k][0]
                own = [len(tags) + n + 1 for n in range(len(corners[k]))]
                for tag, place in zip(own, corners[k].tolist(), strict=True):
                    ops.node(tag, *place)
                plate = (modulus, poisson, thickness, 0.0, bending)
                ops.section("ElasticMembranePlateSection", k + 1, *plate)
                ops.element(QUAD if len(own) == 4 else TRIANGLE, k + 1, *own, k + 1)
                blocks.append(slice(6 * len(tags), 6 * (len(tags) + len(own))))
                tags += own
            whole = read_initial(tags).toarray()
            found += [whole[block, block] for block in blocks]
    finally:
        ops.wipe()
    return found


def shell_numbers(building: Building, area: AreaObject) -> tuple[float, float, float, float]:
    """Return the properties of a shell's section."""
    section = building.area_sections[area.section]
    matter = building.materials[section.material]
    plane = section.in_plane * area.in_plane
    plate = section.bending * area.bending
    plane = NONE if section.kind == "plate" else max(plane, NONE)
    plate = NONE if section.kind == "membrane" else max(plate, NONE)
    plate *= (section.bending_thickness / section.thickness) ** 3
    return (
        plane * matter.elastic_modulus,
        matter.poisson_ratio,
        section.thickness,
        plate / plane,
    )


def shell_parts(frame: FrameData) -> list[Superelement]:
    """Return the superelements that are shells and nothing else."""
    return [
        part
        for part in frame.superelements.values()
        if part.elements.shells
        and not part.load.any()
        and not any(m.count_nonzero() for m in (part.mass, part.damping, part.equations))
    ]


def shells_of(frame: FrameData, building: Building) -> None:
    """Add the shells of a frame to a building: each element an area, of a section without mass.

    The modulus of the stiffer of membrane and plate is that of the material; a factor of the
    section makes the other one.
    """
    diaphragms = [(part.name, set(part.nodes)) for part in frame.diaphragms.values()]
    materials: dict[tuple[float, float], str] = {}
    sections: dict[object, str] = {}
    count: dict[str, int] = defaultdict(int)
    for shell in (shell for part in shell_parts(frame) for shell in part.elements.shells):
        within = [name for name, nodes in diaphragms if nodes.issuperset(shell.nodes)]
        if within:
            message = (
                f'a shell of area "{shell.area}" lies within the rigid diaphragm '
                f'"{within[0]}", and {building.program} would import it as a slab: remove '
                "the shell or the diaphragm"
            )
            raise ModelError(message)
        stiffest = shell.elastic_modulus * max(shell.bending, 1.0)
        matter = (stiffest, shell.poisson_ratio)
        if matter not in materials:
            materials[matter] = name = f"SM{len(materials) + 1}"
            shear = 0.5 * stiffest / (1.0 + shell.poisson_ratio)
            building.materials[name] = Material(name, stiffest, shear, matter[1], 0.0, 0.0)
        kind = "WALL" if area_kind(building, shell.nodes) == "PANEL" else "SLAB"
        key = (kind, *shell[2:])
        if key not in sections:
            sections[key] = name = f"{kind}{len(sections) + 1}"
            building.area_sections[name] = _area_section(name, materials[matter], shell)
        count[shell.area] += 1
        name = f"{shell.area}/{count[shell.area]}"
        building.areas[name] = AreaObject(name, tuple(shell.nodes), sections[key], place="")


def _area_section(name: str, material: str, shell: ShellElement) -> AreaSection:
    return AreaSection(
        name,
        material,
        "shell",
        thickness=shell.thickness,
        bending_thickness=shell.thickness,
        in_plane=1.0 / max(shell.bending, 1.0),
        bending=min(shell.bending, 1.0),
    )


def area_kind(building: Building, joints: tuple[str, ...]) -> str:
    """Return ETABS' kind of an area: by its normal."""
    normal, _ = area_normal(np.array([building.joints[name].position for name in joints]))
    if abs(normal[2]) > 1.0 - _PLUMB:
        return "FLOOR"
    return "PANEL" if abs(normal[2]) < _PLUMB else "RAMP"
