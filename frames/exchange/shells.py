"""Stiffness of meshed areas, by the shell elements of OpenSees, as superelements of a frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from frames.model.part_elements import ShellElement, WithoutForces, no_elements
from frames.opensees.model import read_model
from lir_element.argument_checks import listed
from lir_element.opensees import opensees

if TYPE_CHECKING:
    from frames._types import SparseMatrix
    from frames.exchange.building import AreaObject, Building
    from frames.exchange.mesh import Mesh
    from frames.exchange.stations import Points
    from frames.model.editing import FrameEditor

AT_ONCE = 60
"""Elements whose matrices are read together: they are full ones."""


NONE = 1e-6
"""Factor on a stiffness that stands for none [-]."""

QUAD, TRIANGLE = "ShellMITC4", "ShellDKGT"
"""Elements of OpenSees: Dvorkin & Bathe (1984); discrete Kirchhoff triangle with a membrane."""


def add_shells(frame: FrameEditor, building: Building, mesh: Mesh) -> None:
    """Add the stiffness of all shells to a frame that has their nodes."""
    if not mesh.elements:
        return
    ops = opensees()
    if ops.getNodeTags():
        message = (
            "walls and slabs are read through OpenSees, which holds a model of yours: call "
            "openseespy.opensees.wipe() first, or import in a process of its own"
        )
        raise ModelError(message)
    names = list(dict.fromkeys(node for _, nodes in mesh.elements for node in nodes))
    index = {name: k for k, name in enumerate(names)}
    points = {name: frame.nodes[name].position for name in names}
    stiffness = sparse.csr_array((6 * len(names), 6 * len(names)), dtype=np.float64)
    try:
        for start in range(0, len(mesh.elements), AT_ONCE):
            part = mesh.elements[start : start + AT_ONCE]
            stiffness = sparse.csr_array(stiffness + _part(ops, building, part, points, index))
    finally:
        ops.wipe()
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


def _part(
    ops: Any,
    building: Building,
    part: list[tuple[str, tuple[str, ...]]],
    points: Points,
    index: dict[str, int],
) -> SparseMatrix:
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    used = sorted({index[node] for _, nodes in part for node in nodes})
    places = {k: name for name, k in index.items()}
    for k in used:
        ops.node(k + 1, *points[places[k]])
    sections: dict[tuple[float, ...], int] = {}
    for tag, (area, nodes) in enumerate(part, start=1):
        numbers = shell_numbers(building, building.areas[area])
        if numbers not in sections:
            sections[numbers] = len(sections) + 1
            modulus, poisson, thickness, bending = numbers
            ops.section(
                "ElasticMembranePlateSection",
                sections[numbers],
                modulus,
                poisson,
                thickness,
                0.0,
                bending,
            )
        kind = QUAD if len(nodes) == 4 else TRIANGLE
        ops.element(kind, tag, *(index[node] + 1 for node in nodes), sections[numbers])
    model = read_model()
    dofs = (6 * (np.array(model.tags) - 1)[:, None] + np.arange(6)).ravel()
    size = 6 * len(index)
    put = sparse.csr_array(
        (np.ones(len(dofs)), (dofs, np.arange(len(dofs)))), shape=(size, len(dofs))
    )
    return sparse.csr_array(put @ model.initial @ put.T)


def shell_numbers(building: Building, area: AreaObject) -> tuple[float, float, float, float]:
    """Return what a shell's section is made of."""
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
