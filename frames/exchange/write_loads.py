"""Loads, weights and mass source of a frame as SAP2000's tables."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.model.floors import members_at, panel_loads

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames._types import FloatArray
    from frames.exchange.units import Units
    from frames.exchange.write_s2k_text import Tables, Value
    from frames.model.components import Member
    from frames.model.frame_data import FrameData

_FORCES = ("F1", "F2", "F3", "M1", "M2", "M3")
_KINDS = {"D": "Dead", "L": "Live", "S": "Snow"}
_DEAD = "D"


class LoadWriter:
    """The tables of loads.

    Parameters
    ----------
    frame : Frame
        The model.
    units : Units
        Of the file.
    true_length : callable
        Length of a member between its ends [m].
    """

    def __init__(
        self, frame: FrameData, units: Units, true_length: Callable[[Member], float]
    ) -> None:
        self.frame, self.units, self._true = frame, units, true_length

    def tables(self) -> Tables:
        """Return patterns, mass source, loads of joints and of members."""
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
