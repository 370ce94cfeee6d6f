"""Shells of a frame as SAP2000's tables and as lines of ETABS' text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.geometry import area_normal
from frames.exchange.write_materials import MATERIALS, material_row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.exchange.etabs_places import EtabsPlaces
    from frames.exchange.units import Units
    from frames.exchange.write_s2k_text import Tables, Value
    from frames.model.frame_data import FrameData
    from frames.model.part_elements import ShellElement
    from frames.model.superelement import Superelement

SECTIONS, AREAS = "AREA SECTION PROPERTIES", "CONNECTIVITY - AREA"
ASSIGNED = "AREA SECTION ASSIGNMENTS"
_DIRECTIONS = ("11", "22", "12")
_PLUMB = 1e-6


def shell_parts(frame: FrameData) -> list[Superelement]:
    """Return the superelements of a frame that are shells and nothing else."""
    return [
        part
        for part in frame.superelements.values()
        if part.elements.shells
        and not part.load.any()
        and not any(m.count_nonzero() for m in (part.mass, part.damping, part.equations))
    ]


def shell_tables(frame: FrameData, units: Units, program: str) -> Tables:
    """Return the tables of shells: each element an area, of sections without mass.

    The modulus of the stiffer of membrane and plate is that of the material; a factor of the
    section makes the other one.
    """
    elements = [shell for part in shell_parts(frame) for shell in part.elements.shells]
    diaphragms = [(part.name, set(part.nodes)) for part in frame.diaphragms.values()]
    found: Tables = {MATERIALS: [], SECTIONS: [], AREAS: [], ASSIGNED: []}
    materials: dict[tuple[float, float], str] = {}
    sections: dict[tuple[str | float, ...], str] = {}
    count: dict[str, int] = {}
    for shell in elements:
        within = [name for name, nodes in diaphragms if nodes.issuperset(shell.nodes)]
        if within:
            message = (
                f'a shell of area "{shell.area}" lies within the rigid diaphragm "{within[0]}", '
                f"where {program} has it as a slab: take it out, or the diaphragm"
            )
            raise ModelError(message)
        kind = "WALL" if _kind(frame, shell.nodes) == "PANEL" else "SLAB"
        numbers = (kind, *shell[2:])
        stiffest = shell.elastic_modulus * max(shell.bending, 1.0)
        matter = (stiffest, shell.poisson_ratio)
        if matter not in materials:
            materials[matter] = f"SM{len(materials) + 1}"
            row = material_row(materials[matter], *matter, 0.0, units)
            found[MATERIALS].append(row)
        if numbers not in sections:
            sections[numbers] = f"{kind}{len(sections) + 1}"
            found[SECTIONS].append(_section(sections[numbers], materials[matter], shell, units))
        count[shell.area] = count.get(shell.area, 0) + 1
        name = f"{shell.area}/{count[shell.area]}"
        row = {"Area": name, "NumJoints": len(shell.nodes)}
        row |= {f"Joint{k}": node for k, node in enumerate(shell.nodes, start=1)}
        found[AREAS].append(row)
        found[ASSIGNED].append({"Area": name, "Section": sections[numbers]})
    return found


def shell_lines(frame: FrameData, tables: Tables, places: EtabsPlaces) -> dict[str, list[str]]:
    """Return the lines of shells of an ETABS text, by section of the text."""
    found: dict[str, list[str]] = {f"{what} PROPERTIES": [] for what in ("SLAB", "WALL")}
    areas, assigns = [], []
    for row in tables.get(SECTIONS, []):
        name = str(row["Section"])
        what = "SLAB" if name.startswith("SLAB") else "WALL"
        head = f'SHELLPROP  "{name}"  PROPTYPE  "{what.title()}"  MATERIAL "{row["Material"]}"'
        thickness = f'MODELINGTYPE "ShellThin"  {what}THICKNESS {row["Thickness"]!r}'
        factors = [f"{m}{d}MOD {row[f'{m}{d}Mod']!r}" for m in "FM" for d in _DIRECTIONS]
        found[f"{what} PROPERTIES"].append(f"{head}  {thickness}  {'  '.join(factors)}")
    sections = {str(row["Area"]): str(row["Section"]) for row in tables.get(ASSIGNED, [])}
    for k, row in enumerate(tables.get(AREAS, []), start=1):
        nodes = [str(row[f"Joint{c}"]) for c in range(1, int(row["NumJoints"]) + 1)]
        top = max(places.level(node) for node in nodes)
        story = next(places.at[node][1] for node in nodes if places.level(node) == top)
        points = "  ".join(f'"{places.at[node][0]}"' for node in nodes)
        downs = "  ".join(str(top - places.level(node)) for node in nodes)
        kind = _kind(frame, nodes)
        areas.append(f'AREA  "A{k}"  {kind}  {len(nodes)}  {points}  {downs}')
        section = sections[str(row["Area"])]
        assigns.append(
            f'AREAASSIGN  "A{k}"  "{story}"  SECTION "{section}"  OBJMESHTYPE "NOAUTOMESH"'
        )
    return found | {"AREA CONNECTIVITIES": areas, "AREA ASSIGNS": assigns}


def _kind(frame: FrameData, nodes: Sequence[str]) -> str:
    # What ETABS calls an area: by its normal.
    normal, _ = area_normal(np.array([frame.nodes[node].position for node in nodes]))
    if abs(normal[2]) > 1.0 - _PLUMB:
        return "FLOOR"
    return "PANEL" if abs(normal[2]) < _PLUMB else "RAMP"


def _section(name: str, material: str, shell: ShellElement, units: Units) -> dict[str, Value]:
    thickness = shell.thickness / units.length
    plane, bending = 1.0 / max(shell.bending, 1.0), min(shell.bending, 1.0)
    row: dict[str, Value] = {
        "Section": name,
        "Material": material,
        "MatAngle": 0.0,
        "AreaType": "Shell",
        "Type": "Shell-Thin",
        "Thickness": thickness,
        "BendThick": thickness,
    }
    for letter, factor in (("F", plane), ("M", bending)):
        row |= {f"{letter}{d}Mod": factor for d in _DIRECTIONS}
    return row
