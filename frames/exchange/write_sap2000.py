"""Writes a frame as SAP2000's text tables, its bearings as friction isolator links."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.geometry import frame_axes
from frames.exchange.units import units_of
from frames.exchange.write_links import LinkWriter
from frames.exchange.write_loads import LoadWriter
from frames.exchange.write_materials import MATERIALS, material_row
from frames.exchange.write_s2k_text import text_of as text_of
from frames.exchange.write_shells import shell_parts, shell_tables
from frames.model.axes import default_up
from frames.model.components import DOFS

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.exchange.write_s2k_text import Tables, Value
    from frames.model.components import Member
    from frames.model.frame_data import FrameData
    from frames.model.sections import Section

_HELD = ("U1", "U2", "U3", "R1", "R2", "R3")
_WORDS = {"T": "T", "My": "M3", "Mz": "M2"}


class Writer:
    """The tables of a frame.

    Parameters
    ----------
    frame : Frame
        The model.
    displacement : float or None
        Of the equivalent-linear analysis, for links [m].
    words : str
        Units of the file, "KN, m, C".
    program : str
        For messages.
    """

    def __init__(
        self,
        frame: FrameData,
        displacement: float | None,
        words: str,
        *,
        program: str = "SAP2000",
    ) -> None:
        self.frame, self.displacement, self.program = frame, displacement, program
        parts = words.split(",")
        found = units_of(parts[0], parts[1]) if len(parts) > 1 else None
        if found is None:
            message = f'units = "{words}" must be such as "KN, m, C" or "Kip, in, F"'
            raise ModelError(message)
        self.words, self.units = words, found
        self._refuse()

    def _refuse(self) -> None:
        frame, shells = self.frame, {part.name for part in shell_parts(self.frame)}
        for word, group in (
            ("superelements", [name for name in frame.superelements if name not in shells]),
            ("nonlinear links", frame.links),
            ("plastic hinges", frame.hinges),
        ):
            if group:
                message = (
                    f'frame "{frame.name}" has {word} ("{next(iter(group))}"), which are not '
                    f"written for {self.program}: take them out of a copy, or model them there"
                )
                raise ModelError(message)
        if frame.bearings and self.displacement is None:
            message = (
                "bearings are written as friction isolator links, whose effective stiffness and "
                "damping are those at a displacement: give displacement=0.25, in metres"
            )
            raise ModelError(message)
        shared = [p.name for p in frame.floor_loads.values() if p.mass is not None]
        if shared:
            message = (
                f'floor load "{shared[0]}" has a share of mass of its own: give it by the mass '
                "source of its case"
            )
            raise ModelError(message)

    def tables(self) -> Tables:
        """Return all tables."""
        found: Tables = {
            "PROGRAM CONTROL": [
                {"ProgramName": "SAP2000", "Version": "20.0.0", "CurrUnits": self.words}
            ],
        }
        loads = LoadWriter(self.frame, self.units, self._true)
        links = LinkWriter(self.frame, self.displacement, self.units)
        shells = shell_tables(self.frame, self.units, self.program)
        for part in (self._joints(), self._members(), shells, loads.tables(), links.tables()):
            for name, rows in part.items():
                found.setdefault(name, []).extend(rows)
        return {name: rows for name, rows in found.items() if rows}

    def _joints(self) -> Tables:
        frame, one = self.frame, self.units.length
        joints: list[dict[str, Value]] = [
            {
                "Joint": node.name,
                "CoordSys": "GLOBAL",
                "CoordType": "Cartesian",
                "XorR": node.x / one,
                "Y": node.y / one,
                "Z": node.z / one,
                "SpecialJt": True,
            }
            for node in frame.nodes.values()
        ]
        held: list[dict[str, Value]] = [
            {"Joint": node} | {h: dof in dofs for h, dof in zip(_HELD, DOFS, strict=True)}
            for node, dofs in frame.fixed_dofs.items()
        ]
        masses: list[dict[str, Value]] = []
        for node, values in frame.masses.items():
            row: dict[str, Value] = {"Joint": node, "CoordSys": "Local"}
            row |= {f"Mass{k + 1}": float(values[k]) / self.units.mass for k in range(3)}
            inertia = self.units.mass * one**2
            row |= {f"MMI{k + 1}": float(values[3 + k]) / inertia for k in range(3)}
            masses.append(row)
        kinds: list[dict[str, Value]] = []
        ties: list[dict[str, Value]] = []
        for part in frame.diaphragms.values():
            kinds.append({"Name": part.name, "CoordSys": "GLOBAL", "Axis": "Z"})
            ties += [{"Joint": n, "Constraint": part.name, "Type": "Diaphragm"} for n in part.nodes]
        return {
            "JOINT COORDINATES": joints,
            "JOINT RESTRAINT ASSIGNMENTS": held,
            "JOINT ADDED MASS ASSIGNMENTS": masses,
            "CONSTRAINT DEFINITIONS - DIAPHRAGM": kinds,
            "JOINT CONSTRAINT ASSIGNMENTS": ties,
        }

    def _members(self) -> Tables:
        found: Tables = {
            name: []
            for name in (
                MATERIALS,
                "FRAME SECTION PROPERTIES 01 - GENERAL",
                "CONNECTIVITY - FRAME",
                "FRAME SECTION ASSIGNMENTS",
                "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL",
                "FRAME RELEASE ASSIGNMENTS 1 - GENERAL",
                "FRAME INSERTION POINT ASSIGNMENTS",
                "FRAME PROPERTY MODIFIERS",
                "FRAME AUTO MESH ASSIGNMENTS",
            )
        }
        materials: dict[tuple[float, float, float], str] = {}
        sections: dict[Section, str] = {}
        for member in self.frame.members.values():
            section = member.section
            key = (section.elastic_modulus, section.shear_modulus, section.density)
            if key not in materials:
                materials[key] = f"M{len(materials) + 1}"
                rows = found[MATERIALS]
                rows.append(self._material(materials[key], key, member.name))
            if section not in sections:
                sections[section] = f"S{len(sections) + 1}"
                rows = found["FRAME SECTION PROPERTIES 01 - GENERAL"]
                rows.append(self._section(sections[section], materials[key], section))
            self._member(member, sections[section], found)
        return found

    def _material(
        self, name: str, key: tuple[float, float, float], member: str
    ) -> dict[str, Value]:
        modulus, shear, density = key
        poisson = 0.5 * modulus / shear - 1.0
        if not -1.0 < poisson <= 0.5:
            message = (
                f'member "{member}": moduli {modulus:g} and {shear:g} Pa have Poisson\'s ratio '
                f"{poisson:g}, {self.program} needs one in (-1, 0.5]: give another shear_modulus"
            )
            raise ModelError(message)
        return material_row(name, modulus, poisson, density, self.units)

    def _section(self, name: str, material: str, section: Section) -> dict[str, Value]:
        one = self.units.length

        def shear(area: float) -> float:
            return 0.0 if math.isinf(area) else area / one**2

        return {
            "SectionName": name,
            "Material": material,
            "Shape": "General",
            "t3": math.sqrt(12.0 * section.inertia_y / section.area) / one,
            "t2": math.sqrt(12.0 * section.inertia_z / section.area) / one,
            "Area": section.area / one**2,
            "TorsConst": section.torsion_constant / one**4,
            "I33": section.inertia_y / one**4,
            "I22": section.inertia_z / one**4,
            "I23": 0,
            "AS2": shear(section.shear_area_z),
            "AS3": shear(section.shear_area_y),
        }

    def _member(self, member: Member, section: str, found: Tables) -> None:
        name = member.name
        start, end = (np.array(self.frame.nodes[n].position) for n in (member.i, member.j))
        found["CONNECTIVITY - FRAME"].append(
            {"Frame": name, "JointI": member.i, "JointJ": member.j, "IsCurved": False}
        )
        found["FRAME SECTION ASSIGNMENTS"].append(
            {"Frame": name, "AutoSelect": "N.A.", "AnalSect": section, "MatProp": "Default"}
        )
        found["FRAME AUTO MESH ASSIGNMENTS"].append({"Frame": name, "AutoMesh": False})
        angle = self._angle(member, start, end)
        if angle:
            table = "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL"
            found[table].append({"Frame": name, "Angle": angle, "AdvanceAxes": False})
        if any(member.releases):
            row: dict[str, Value] = {"Frame": name}
            for mark, words in zip("IJ", member.releases, strict=True):
                free = {_WORDS[word] for word in words}
                row |= {f"{w}{mark}": w in free for w in ("P", "V2", "V3", "T", "M2", "M3")}
            found["FRAME RELEASE ASSIGNMENTS 1 - GENERAL"].append(row | {"PartialFix": False})
        if member.has_offsets:
            row = {"Frame": name, "CardinalPt": "10 (centroid)", "CoordSys": "GLOBAL"}
            for mark, offset in zip("IJ", member.offsets, strict=True):
                parts = zip("XYZ", offset, strict=True)
                row |= {f"JtOffset{axis}{mark}": value / self.units.length for axis, value in parts}
            found["FRAME INSERTION POINT ASSIGNMENTS"].append(row | {"Transform": True})
            ratio = self._true(member) / float(np.linalg.norm(end - start))
            found["FRAME PROPERTY MODIFIERS"].append({"Frame": name, "MassMod": ratio})

    def _true(self, member: Member) -> float:
        # Length between the ends of a member.
        first, last = (
            np.add(self.frame.nodes[node].position, offset)
            for node, offset in zip((member.i, member.j), member.offsets, strict=True)
        )
        return float(np.linalg.norm(last - first))

    def _angle(self, member: Member, start: FloatArray, end: FloatArray) -> float:
        first, last = start + member.offsets[0], end + member.offsets[1]
        along = (last - first) / np.linalg.norm(last - first)
        axes = frame_axes(start, end)
        if float(along @ axes[0]) < 1.0 - 1e-12:
            message = (
                f'member "{member.name}": its offsets turn it against the line between its nodes, '
                f"which {self.program}'s local axes do not follow: give both ends the same offset "
                "across it"
            )
            raise ModelError(message)
        up = default_up(first[None], last[None])[0] if member.up is None else np.array(member.up)
        second = up - (up @ axes[0]) * axes[0]
        turned = math.degrees(math.atan2(float(second @ axes[2]), float(second @ axes[1])))
        return turned if abs(turned) > 1e-9 else 0.0
