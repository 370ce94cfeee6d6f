"""Points, lines, areas and their assignments of an ETABS text file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames.exchange import etabs_fields as dialect
from frames.exchange.building import (
    RELEASES,
    AreaObject,
    Building,
    Constraint,
    FrameObject,
    Joint,
    Modifiers,
)
from frames.exchange.fields import refused, values
from frames.exchange.geometry import Levels
from frames.exchange.properties import offsets_of, released, shell_factors
from frames.exchange.tables import known, merged
from lir_element.elevations import SAME_PLACE

if TYPE_CHECKING:
    from frames.exchange.tables import Row, Tables

_NONE = {"", "NONE", "NULL"}
_ENDS = {f"{word}{end}" for word in RELEASES for end in "IJ"}
_PINNED = ["M2I", "M3I", "M2J", "M3J"]


class Objects:
    """Reader of the objects of an ETABS file into a building with stories and properties.

    A joint is a point at a story, "12-Story2"; an object is a line or an area at a story.
    `on_links` has the springs that are links, by their upper joint; `bare` the joints of lines
    without a section.
    """

    def __init__(self, tables: Tables, building: Building) -> None:
        self.tables, self.building = tables, building
        self.stories = dict(building.stories)
        self._points: dict[str, tuple[float, float, float]] = {}
        self._diaphragms = Diaphragms(tables, building)
        self.on_links: dict[str, Row] = {}
        self.bare: dict[str, tuple[str, str]] = {}
        self._clear: list[str] = []

    def read(self) -> None:
        """Read everything."""
        for row in self.tables.needed("POINT", "export the whole model"):
            name = row.text("Point")
            if name in self._points:
                msg = f'point "{name}" occurs twice: keep one of the two'
                raise row.error(msg)
            x, y, below = values(row, dialect.POINT, self.building).values()
            self._points[name] = (x, y, below)
        self._read_lines()
        self._read_areas()
        self._read_points()
        self._diaphragms.add()
        account, building = self.building.account, self.building
        account.read("POINT COORDINATES", "joints", len(building.joints))
        account.read("LINE CONNECTIVITIES", "frame objects by story", len(building.frames))
        what = "own weight along the whole length, where the file has it between end zones"
        account.read_as("LINE ASSIGNS", what, self._clear)
        account.read("AREA CONNECTIVITIES", "areas by story", len(building.areas))
        account.read("POINT ASSIGNS", "supports", len(building.restraints))
        account.read("POINT ASSIGNS", "joint springs", len(building.springs))

    def joint(self, row: Row, point: str, story: str) -> str:
        """Return the name of the joint that a point is at a story; it is made if it is new."""
        known(row, "point", point, self._points)
        name = f"{point}-{story}"
        if name not in self.building.joints:
            x, y, below = self._points[point]
            z = self.stories[story] - below
            self.building.joints[name] = Joint(name, x, y, z, row.place)
        return name

    def is_place(self, point: str, story: str) -> bool:
        """Return True if the point and the story exist."""
        return point in self._points and story in self.stories

    def _below(self, row: Row, story: str, count: int) -> str:
        # The story that is a number of stories below another.
        names = list(self.stories)
        place = names.index(known(row, "story", story, names)) - count
        if count < 0 or place < 0:
            message = f'there are no {count} stories below "{story}"'
            raise row.error(message)
        return names[place]

    def _read_lines(self) -> None:
        lines = {name: row for (name,), row in merged(self.tables.rows("LINE"), "Line").items()}
        for (name, story), row in merged(self.tables.rows("LINEASSIGN"), "Line", "Story").items():
            with self.building.account.noting():
                line = lines[known(row, "line", name, lines)]
                self._read_line(name, story, row, line)
        self.building.account.left_out("LINE ASSIGNS", "lines without a section", list(self.bare))

    def _read_line(self, name: str, story: str, row: Row, line: Row) -> None:
        low = self._below(row, story, line.count("Stories", 0))
        i, j = self.joint(line, line.text("I"), low), self.joint(line, line.text("J"), story)
        label = f"{name}-{story}"
        section = row.text("SECTION", "")
        if section.upper() in _NONE:
            self.bare[label] = (i, j)
            row.looked_at.clear()
            return
        known(row, "SECTION", section, self.building.sections, f' of line "{name}"')
        if i == j:
            msg = f'line "{name}" begins and ends at one joint of story "{story}"'
            raise line.error(msg)
        frame = FrameObject(label, i, j, section, row.place, story=story)
        self.building.frames[label] = self._assigned(frame, row)

    def _assigned(self, frame: FrameObject, row: Row) -> FrameObject:
        building = self.building
        refused(row, frame.name, building.account, dialect.FRAME_WORDS)
        of = f' of line "{frame.name}"'
        material = row.text("MATERIALOVERWRITE", "")
        if material:
            known(row, "MATERIALOVERWRITE", material, building.materials, of)
        zones = values(row, dialect.END_ZONES, building, of)
        is_clear = row.text("SELFWEIGHTOPTION", "").upper() == "CLEAR LENGTH"
        if is_clear and (zones["end_i"] or zones["end_j"]):
            self._clear.append(frame.name)
        cardinal = row.count("CARDINALPT", 10)
        if not 1 <= cardinal <= 11:
            message = f"CARDINALPT = {cardinal}{of} must be from 1 to 11"
            raise row.error(message, "CARDINALPT")
        words = row.text("RELEASE", "").upper().split()
        words = _PINNED if words == ["PINNED"] else words
        wrong = [word for word in words if word not in _ENDS]
        if wrong:
            msg = f'RELEASE "{wrong[0]}" must be PINNED, or of {", ".join(sorted(_ENDS))}'
            raise row.error(msg, "RELEASE")
        first, last = offsets_of(row, dialect.OFFSETS, building)
        return replace(
            frame,
            material=material,
            angle=row.number("ANG", 0.0),
            releases=released(row, frame.name, words, building),
            cardinal=cardinal,
            offset_i=first,
            offset_j=last,
            transforms=row.yes("TRANSFORMSTIFF", default=False),
            modifiers=Modifiers(**values(row, dialect.FRAME_MODIFIERS, building)),
            meshed=row.text("AUTOMESH", "YES").upper() != "NO",
            **zones,
        )

    def _read_areas(self) -> None:
        building = self.building
        areas = {row.text("Area"): row for row in self.tables.rows("AREA")}
        for (name, story), row in merged(self.tables.rows("AREAASSIGN"), "Area", "Story").items():
            with building.account.noting():
                self._read_area(name, story, row, areas[known(row, "area", name, areas)])

    def _read_area(self, name: str, story: str, row: Row, area: Row) -> None:
        building = self.building
        points, downs = area.text("Corners").split("\n"), area.text("Stories").split("\n")
        joints = []
        for point, down in zip(points, downs, strict=True):
            if not down.isdigit():
                msg = f'stories down of a corner = "{down}" must be a whole number'
                raise area.error(msg)
            joints.append(self.joint(area, point, self._below(row, story, int(down))))
        label = f"{name}-{story}"
        if len(set(joints)) < len(joints):
            msg = f'area "{name}" has a corner twice: remove it'
            raise area.error(msg)
        if refused(row, label, building.account, dialect.AREA_WORDS):
            return
        refused(row, label, building.account, dialect.AREA_SPRINGS)
        section = row.text("SECTION", "")
        section = "" if section.upper() in _NONE else section
        if section:
            known(row, "SECTION", section, building.area_sections, f' of area "{name}"')
        self._diaphragms.of_area(row, joints, story)
        building.areas[label] = AreaObject(
            label,
            tuple(joints),
            section,
            row.place,
            angle=row.number("ANG", 0.0),
            story=story,
            **shell_factors(row, dialect.AREA_MODIFIERS, building),
        )

    def _read_points(self) -> None:
        building = self.building
        springs = {k[0]: r for k, r in merged(self.tables.rows("POINTSPRING"), "Spring").items()}
        rows = merged(self.tables.rows("POINTASSIGN"), "Point", "Story")
        for (point, story), row in rows.items():
            joint = self.joint(row, point, self._below(row, story, 0))
            words = row.text("RESTRAINT", "").upper().split()
            wrong = [word for word in words if word not in dialect.DOFS]
            if wrong:
                msg = f'RESTRAINT "{wrong[0]}" must be of {", ".join(dialect.DOFS)}'
                raise row.error(msg, "RESTRAINT")
            if words:
                building.restraints[joint] = tuple(word.lower() for word in words)
            self._diaphragms.of_point(row, joint, story)
            name = row.text("SPRINGPROP", "")
            if name.upper() not in _NONE:
                given = springs[known(row, "SPRINGPROP", name, springs)]
                if given.has("LINKPROP"):
                    self.on_links[joint] = given
                stiffness = tuple(values(given, dialect.SUPPORT, building).values())
                if any(stiffness):
                    building.springs[joint] = stiffness
            plan, *others = values(row, dialect.MASS, building, f' of point "{joint}"').values()
            if plan or any(others):
                building.masses[joint] = (plan, plan, *others)


class Diaphragms:
    """Collects which joints belong to which diaphragm, and adds the rigid ones to a building.

    Assigned to an area a diaphragm has its corners and every joint within and on its edges.
    Source: ETABS tutorial, "Rigid, Semi-Rigid and Flexible Floor Diaphragms".
    """

    TABLE = "DIAPHRAGM NAMES"
    _APART = "DISCONNECTED"
    _NONE = frozenset({"", "FROMSHELLOBJECT", "NONE"})

    def __init__(self, tables: Tables, building: Building) -> None:
        self.building = building
        kinds = {row.text("Diaphragm"): row for row in tables.rows("DIAPHRAGM")}
        self._soft = {
            name: "SEMI" in row.text("TYPE", "RIGID").upper() for name, row in kinds.items()
        }
        self._joints: dict[tuple[str, str], list[str]] = {}
        self._areas: list[tuple[tuple[str, str], list[str]]] = []
        self._apart: set[str] = set()

    def of_area(self, row: Row, joints: list[str], story: str) -> None:
        """Record the diaphragm that a line assigns to an area with these corners."""
        name = self._name(row)
        if name and name.upper() != self._APART:
            self._areas.append(((name, story), joints))
            self._joints.setdefault((name, story), [])

    def of_point(self, row: Row, joint: str, story: str) -> None:
        """Record the diaphragm that a line assigns to a joint, or that it belongs to none."""
        name = self._name(row)
        if name.upper() == self._APART:
            self._apart.add(joint)
        elif name:
            self._joints.setdefault((name, story), []).append(joint)

    def _name(self, row: Row) -> str:
        name = row.text("DIAPH", row.text("DIAPHRAGM", ""))
        return "" if name.upper() in self._NONE else name

    def add(self) -> None:
        """Add the rigid diaphragms to the building, whose joints are complete."""
        building = self.building
        rigid = [key for key in self._joints if self._soft.get(key[0]) is False]
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
            if key in found and np.ptp(points[:, 2]) <= SAME_PLACE:
                inside = [joint for joint in levels.within(points) if joint not in taken]
                found[key] += inside
                taken.update(inside)
        for (name, story), joints in found.items():
            label = f"{name}-{story}"
            kept = tuple(dict.fromkeys(joints))
            building.constraints[label] = Constraint(label, "diaphragm", kept)
        account = building.account
        account.read(self.TABLE, "rigid diaphragms by story", len(building.constraints))
        used = sorted({name for name, _ in self._joints if self._soft.get(name)})
        account.read_as(self.TABLE, "semi-rigid diaphragms, by their shells", used)
