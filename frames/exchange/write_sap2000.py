"""Writes a frame as SAP2000's text tables, its bearings as friction isolator links."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.geometry import frame_axes
from frames.exchange.pendulum_link import pendulum_link
from frames.exchange.units import units_of
from frames.model.axes import default_up
from frames.model.components import DOFS
from frames.model.floors import members_at, panel_loads
from frames.statics.gravity import gravity

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.components import BearingLink, Member
    from frames.model.frame_data import FrameData
    from frames.model.sections import Section

Value = str | float | int | bool
Tables = dict[str, list[dict[str, Value]]]

_HELD = ("U1", "U2", "U3", "R1", "R2", "R3")
_WORDS = {"T": "T", "My": "M3", "Mz": "M2"}
_FORCES = ("F1", "F2", "F3", "M1", "M2", "M3")
_KINDS = {"D": "Dead", "L": "Live", "S": "Snow"}
_DEAD = "D"


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
    """

    def __init__(self, frame: FrameData, displacement: float | None, words: str) -> None:
        self.frame, self.displacement = frame, displacement
        parts = words.split(",")
        found = units_of(parts[0], parts[1]) if len(parts) > 1 else None
        if found is None:
            message = f'units = "{words}" must be such as "KN, m, C" or "Kip, in, F"'
            raise ModelError(message)
        self.words, self.units = words, found
        self._refuse()

    def _refuse(self) -> None:
        frame = self.frame
        for word, group in (
            ("superelements", frame.superelements),
            ("nonlinear links", frame.links),
            ("plastic hinges", frame.hinges),
        ):
            if group:
                message = (
                    f'frame "{frame.name}" has {word} ("{next(iter(group))}"), which are not '
                    "written to SAP2000's tables: take them out of a copy, or model them there"
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
        for part in (self._joints(), self._members(), self._loads(), self._links()):
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
                "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES",
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
                rows = found["MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"]
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
                f"{poisson:g}, SAP2000 needs one in (-1, 0.5]: give another shear_modulus"
            )
            raise ModelError(message)
        units = self.units
        return {
            "Material": name,
            "UnitWeight": 0.0,  # weights are loads of joints, as here
            "UnitMass": density / units.density,
            "E1": modulus / units.stress,
            "G12": shear / units.stress,
            "U12": poisson,
        }

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
                "which SAP2000's local axes do not follow: give both ends the same offset across it"
            )
            raise ModelError(message)
        up = default_up(first[None], last[None])[0] if member.up is None else np.array(member.up)
        second = up - (up @ axes[0]) * axes[0]
        turned = math.degrees(math.atan2(float(second @ axes[2]), float(second @ axes[1])))
        return turned if abs(turned) > 1e-9 else 0.0

    def _loads(self) -> Tables:
        frame, units = self.frame, self.units
        names = sorted({_DEAD, *frame.load_cases, *frame.mass_source})
        patterns: list[dict[str, Value]] = [
            {
                "LoadPat": name,
                "DesignType": _KINDS.get(name, "Other"),
                "SelfWtMult": 0,
            }
            for name in names
        ]
        head: dict[str, Value] = {"MassSource": "MSSSRC1", "Elements": True, "Masses": True}
        head["IsDefault"] = True
        shares = {k: v for k, v in frame.mass_source.items() if v}
        source: list[dict[str, Value]] = [
            head | {"Loads": True, "LoadPat": name, "Multiplier": share}
            for name, share in shares.items()
        ] or [head | {"Loads": False}]
        at = self._weights()
        if shares.get(_DEAD) and at:
            message = (
                "masses and members that weigh cannot be written where dead loads are masses as "
                "well: give add_mass(..., weighs=False), sections of density 0, and their weights "
                "as loads"
            )
            raise ModelError(message)
        for node, cases in frame.loads_by_case.items():
            for case, forces in cases.items():
                at[node, case] = at.get((node, case), np.zeros(6)) + forces
        lines = self._lines(at)
        scale = np.array([units.force] * 3 + [units.moment] * 3)
        joints: list[dict[str, Value]] = [
            {"Joint": node, "LoadPat": case, "CoordSys": "GLOBAL"}
            | {word: float(v) for word, v in zip(_FORCES, forces / scale, strict=True)}
            for (node, case), forces in at.items()
        ]
        return {
            "LOAD PATTERN DEFINITIONS": patterns,
            "MASS SOURCE": source,
            "JOINT LOADS - FORCE": joints,
            "FRAME LOADS - DISTRIBUTED": lines,
        }

    def _weights(self) -> dict[tuple[str, str], FloatArray]:
        # What masses and members weigh, at the nodes where their mass is.
        frame = self.frame
        weight: dict[str, float] = {}
        for node, values in frame.masses.items():
            none = frame.weightless_masses.get(node, np.zeros(6))
            weight[node] = float(values[2] - none[2])
        for member in frame.members.values():
            half = 0.5 * member.section.density * member.section.area * self._true(member)
            for node in (member.i, member.j):
                weight[node] = weight.get(node, 0.0) + half
        scale = frame.gravity * frame.weight_factor
        return {
            (node, _DEAD): np.array([0.0, 0.0, -scale * mass, 0.0, 0.0, 0.0])
            for node, mass in weight.items()
            if mass
        }

    def _lines(self, at: dict[tuple[str, str], FloatArray]) -> list[dict[str, Value]]:
        frame = self.frame
        found: list[dict[str, Value]] = []
        for name, cases in frame.uniform_loads_by_case.items():
            for case, load in cases.items():
                found += self._line(name, case, (0.0, 1.0), load, load)
        spans = [(name, x) for name, loads in frame.tapered_loads.items() for x in loads]
        around = members_at(frame.members) if frame.floor_loads else {}
        for panel in frame.floor_loads.values():
            parts = panel_loads(frame.nodes, around, panel)
            spans += parts.members
            for node, forces in parts.nodes:
                key = (node, panel.case)
                at[key] = at.get(key, np.zeros(6)) + forces
        for name, part in spans:
            length = self._true(frame.members[name])
            where = (part.a / length, part.b / length)
            start, end = np.array(part.start), np.array(part.end)
            found += self._line(name, part.case, where, start, end)
        return found

    def _line(
        self,
        name: str,
        case: str,
        where: tuple[float, float],
        start: FloatArray,
        end: FloatArray,
    ) -> list[dict[str, Value]]:
        # A row for each direction; per length between the joints, as SAP2000 counts it.
        member = self.frame.members[name]
        whole = math.dist(*(self.frame.nodes[n].position for n in (member.i, member.j)))
        scale = self._true(member) / whole / self.units.line
        return [
            {
                "Frame": name,
                "LoadPat": case,
                "CoordSys": "GLOBAL",
                "Type": "Force",
                "Dir": word,
                "DistType": "RelDist",
                "RelDistA": where[0],
                "RelDistB": where[1],
                "FOverLA": float(start[axis]) * scale,
                "FOverLB": float(end[axis]) * scale,
            }
            for axis, word in enumerate("XYZ")
            if start[axis] or end[axis]
        ]

    def _links(self) -> Tables:
        found: Tables = {
            name: []
            for name in (
                "LINK PROPERTY DEFINITIONS 01 - GENERAL",
                "LINK PROPERTY DEFINITIONS 02 - LINEAR",
                "LINK PROPERTY DEFINITIONS 08 - SLIDING ISOLATOR",
                "CONNECTIVITY - LINK",
                "LINK PROPERTY ASSIGNMENTS",
            )
        }
        for spring in self.frame.springs.values():
            kind, prop = "Linear", f"K-{spring.name}"
            self._connect(found, spring.name, (spring.i, spring.j), kind, prop)
            self._spring(found, prop, spring.i, spring.j, spring.stiffness)
        if self.frame.bearings:
            state = gravity(self.frame)
            loads = dict(
                zip((b.name for b in state.system.bearings), state.axial_forces, strict=True)
            )
            for part in self.frame.bearings.values():
                self._bearing(found, part, float(loads[part.name]))
        return found

    def _connect(
        self, found: Tables, name: str, ends: tuple[str, str], kind: str, prop: str
    ) -> None:
        found["LINK PROPERTY DEFINITIONS 01 - GENERAL"].append(
            {"Link": prop, "LinkType": kind, "Mass": 0, "Weight": 0}
        )
        found["CONNECTIVITY - LINK"].append({"Link": name, "JointI": ends[0], "JointJ": ends[1]})
        row: dict[str, Value] = {"Link": name, "LinkType": kind, "LinkJoints": "TwoJoint"}
        found["LINK PROPERTY ASSIGNMENTS"].append(row | {"LinkProp": prop})

    def _spring(
        self, found: Tables, prop: str, i: str, j: str, stiffness: tuple[float, ...]
    ) -> None:
        ends = [np.array(self.frame.nodes[n].position) for n in (i, j)]
        upright = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        apart = float(np.linalg.norm(ends[1] - ends[0])) > 1e-6
        axes = frame_axes(ends[0], ends[1]) if apart else upright
        if float(np.abs(axes).max(axis=1).min()) < 1.0 - 1e-9:
            message = (
                f'spring "{prop.removeprefix("K-")}" joins nodes that are apart across global '
                "axes, which a link in its own axes cannot be: join nodes along X, Y or Z"
            )
            raise ModelError(message)
        for k in range(6):
            axis = int(np.abs(axes[k % 3]).argmax())
            value = stiffness[axis + (3 if k >= 3 else 0)]
            word, unit = ("Trans", self.units.line) if k < 3 else ("Rot", self.units.moment)
            if value:
                row: dict[str, Value] = {"Link": prop, "DOF": _HELD[k], "Fixed": False}
                row |= {f"{word}KE": value / unit, f"{word}CE": 0}
                found["LINK PROPERTY DEFINITIONS 02 - LINEAR"].append(row)

    def _bearing(self, found: Tables, part: BearingLink, load: float) -> None:
        assert self.displacement is not None  # noqa: S101  # refused before
        if load <= 0.0:
            message = (
                f'bearing "{part.name}" carries {load:g} N under the permanent loads: a link has '
                "no effective stiffness without a compression"
            )
            raise ModelError(message)
        link, units = pendulum_link(part.bearing, load, self.displacement), self.units
        prop = f"FP-{part.name}"
        self._connect(found, part.name, (part.i, part.j), "Friction Isolator", prop)
        rows = found["LINK PROPERTY DEFINITIONS 08 - SLIDING ISOLATOR"]
        rows.append(
            {
                "Link": prop,
                "DOF": "U1",
                "Fixed": False,
                "NonLinear": True,
                "TransKE": link.vertical / units.line,
                "TransCE": 0,
                "TransK": link.vertical / units.line,
                "TransC": 0,
            }
        )
        rows += [
            {
                "Link": prop,
                "DOF": dof,
                "Fixed": False,
                "NonLinear": True,
                "TransKE": link.effective / units.line,
                "TransCE": link.damping / units.line,
                "DJ": 0,
                "TransK": link.elastic / units.line,
                "Slow": link.slow,
                "Fast": link.fast,
                "Rate": link.rate * units.length,
                "Radius": link.radius / units.length,
            }
            for dof in ("U2", "U3")
        ]


def text_of(tables: Tables) -> str:
    """Return tables as the text that SAP2000 imports.

    Parameters
    ----------
    tables : dict of str to list of dict
        Rows by table.

    Returns
    -------
    str
        The text.
    """
    lines = ["File written by lir-dcfp", " "]
    for name, rows in tables.items():
        lines.append(f'TABLE:  "{name}"')
        lines += ["   " + "   ".join(f"{k}={_text(v)}" for k, v in row.items()) for row in rows]
        lines.append(" ")
    return "\r\n".join([*lines, "END TABLE DATA", ""])


def _text(value: Value) -> str:
    if isinstance(value, bool):
        return "Yes" if value else "No"
    if isinstance(value, float):
        return repr(float(value))
    words = str(value)
    if '"' in words:
        message = f"the name {words!r} has a quotation mark, which SAP2000's text cannot hold"
        raise ModelError(message)
    return f'"{words}"' if not words or " " in words or "=" in words else words
