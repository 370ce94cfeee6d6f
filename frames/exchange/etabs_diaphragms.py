"""Diaphragms of an ETABS text file: of points, and of areas with all points that these enclose."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.exchange.building import Constraint
from frames.exchange.enclosed import FLAT, Levels

if TYPE_CHECKING:
    from frames.exchange.building import Building
    from frames.exchange.tables import Row, Tables

TABLE = "DIAPHRAGM NAMES"
_APART = "DISCONNECTED"
_NONE = {"", "FROMSHELLOBJECT", "NONE"}


class Diaphragms:
    """Collects which joints belong to which diaphragm, and adds the rigid ones to a building.

    Assigned to an area a diaphragm has its corners and every joint within and on its edges.
    Source: ETABS tutorial, "Rigid, Semi-Rigid and Flexible Floor Diaphragms".

    Parameters
    ----------
    tables : Tables
        Of the file.
    building : Building
        It is added to.
    """

    def __init__(self, tables: Tables, building: Building) -> None:
        self.building = building
        self._kinds = {row.text("Diaphragm"): row for row in tables.rows("DIAPHRAGM")}
        self._joints: dict[tuple[str, str], list[str]] = {}
        self._areas: list[tuple[tuple[str, str], list[str]]] = []
        self._apart: set[str] = set()

    def of_area(self, row: Row, joints: list[str], story: str) -> None:
        """Note the diaphragm that a line assigns to an area with these corners."""
        name = _name(row)
        if name and name.upper() != _APART:
            self._areas.append(((name, story), joints))
            self._joints.setdefault((name, story), [])

    def of_point(self, row: Row, joint: str, story: str) -> None:
        """Note the diaphragm that a line assigns to a joint, or that it belongs to none."""
        name = _name(row)
        if name.upper() == _APART:
            self._apart.add(joint)
        elif name:
            self._joints.setdefault((name, story), []).append(joint)

    def add(self) -> None:
        """Add the rigid diaphragms to the building, whose joints are complete."""
        building = self.building
        soft = {name for name, row in self._kinds.items() if _soft(row)}
        rigid = [key for key in self._joints if key[0] in self._kinds and key[0] not in soft]
        found: dict[tuple[str, str], list[str]] = {key: [] for key in rigid}
        for key, corners in self._areas:
            if key in found:
                found[key] += [joint for joint in corners if joint not in self._apart]
        for key in rigid:
            found[key] += self._joints[key]
        taken = {joint for joints in found.values() for joint in joints} | self._apart
        levels = Levels({name: joint.position for name, joint in building.joints.items()})
        for key, corners in self._areas:
            points = np.array([building.joints[name].position for name in corners])
            if key in found and np.ptp(points[:, 2]) <= FLAT:
                inside = [joint for joint in levels.within(points) if joint not in taken]
                found[key] += inside
                taken.update(inside)
        for (name, story), joints in found.items():
            label = f"{name}-{story}"
            kept = tuple(dict.fromkeys(joints))
            building.constraints[label] = Constraint(label, "diaphragm", kept)
        account = building.account
        account.read(TABLE, "rigid diaphragms by story", len(building.constraints))
        used = {name for name, _ in self._joints}
        what = "semi-rigid diaphragms, by their shells"
        account.read_as(TABLE, what, sorted(soft & used))


def _name(row: Row) -> str:
    name = row.text("DIAPH", row.text("DIAPHRAGM", ""))
    return "" if name.upper() in _NONE else name


def _soft(row: Row) -> bool:
    return "SEMI" in row.text("TYPE", "RIGID").upper()
