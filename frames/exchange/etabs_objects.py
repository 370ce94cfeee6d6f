"""Points, lines, areas and their assignments of an ETABS text file."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from frames.exchange.building import (
    RELEASES,
    AreaObject,
    Building,
    FrameObject,
    Joint,
    Vector,
)
from frames.exchange.etabs_diaphragms import Diaphragms
from frames.exchange.etabs_properties import (
    OBJECT_FACTORS,
    StoryIndex,
    factors,
    merged,
    shell_factors,
)

if TYPE_CHECKING:
    from frames.exchange.tables import Row, Tables

_DOFS = ("UX", "UY", "UZ", "RX", "RY", "RZ")
_NONE = {"", "NONE", "NULL"}


class Objects:
    """Reads the objects of an ETABS file into a building.

    A joint is a point at a story, "12-Story2"; an object is a line or an area at a story.

    Parameters
    ----------
    tables : Tables
        Of the file.
    building : Building
        With stories and properties; it is added to.

    Attributes
    ----------
    on_links : dict of str to Row
        Springs that are links, by the joint that stands on them.
    """

    def __init__(self, tables: Tables, building: Building) -> None:
        self.tables, self.building = tables, building
        self.stories = StoryIndex(building)
        self._points: dict[str, tuple[float, float, float]] = {}
        self._diaphragms = Diaphragms(tables, building)
        self.on_links: dict[str, Row] = {}
        self._clear: list[str] = []

    def read(self) -> None:
        """Read everything."""
        one = self.building.units.length
        for row in self.tables.needed("POINT", "export the whole model"):
            name = row.text("Point")
            if name in self._points:
                msg = f'point "{name}" is there already: keep one of the two'
                raise row.error(msg)
            place = (row.number("X"), row.number("Y"), row.number("Below", 0.0))
            x, y, below = (one * value for value in place)
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

    def joint(self, row: Row, point: str, story: str) -> str:
        """Return the name of the joint that a point is at a story; it is made if it is new."""
        if point not in self._points:
            msg = f'point "{point}" is not defined: it is not in POINT COORDINATES'
            raise row.error(msg)
        name = f"{point}-{story}"
        if name not in self.building.joints:
            x, y, below = self._points[point]
            z = self.stories.elevation(story) - below
            self.building.joints[name] = Joint(name, x, y, z, row.place)
        return name

    def is_place(self, point: str, story: str) -> bool:
        """Return whether there are such a point and such a story."""
        return point in self._points and story in self.stories.names

    def _read_lines(self) -> None:
        lines = {name: row for (name,), row in merged(self.tables.rows("LINE"), "Line").items()}
        bare = []
        for (name, story), row in merged(self.tables.rows("LINEASSIGN"), "Line", "Story").items():
            if name not in lines:
                msg = f'line "{name}" is not defined: it is not in LINE CONNECTIVITIES'
                raise row.error(msg)
            line = lines[name]
            low = self.stories.below(row, story, line.count("Stories", 0))
            i, j = self.joint(line, line.text("I"), low), self.joint(line, line.text("J"), story)
            label = f"{name}-{story}"
            section = row.text("SECTION", "")
            if section.upper() in _NONE:
                bare.append(label)
                row.looked_at.clear()
                continue
            if section not in self.building.sections:
                message = f'SECTION "{section}" of line "{name}" is not defined as a FRAMESECTION'
                raise row.error(message)
            if i == j:
                msg = f'line "{name}" begins and ends at one joint of story "{story}"'
                raise line.error(msg)
            frame = FrameObject(label, i, j, section, row.place, story=story)
            self.building.frames[label] = self._assigned(frame, row)
        self.building.account.left_out("LINE ASSIGNS", "lines without a section", bare)

    def _assigned(self, frame: FrameObject, row: Row) -> FrameObject:
        account, one = self.building.account, self.building.units.length
        for word in ("LIMITTENSION", "LIMITCOMPRESSION"):
            if row.has(word):
                what = "limits of axial force, without"
                account.refuse("tension limits", row.table, what, [frame.name], row.place)
        if row.has("HINGE"):
            what = "plastic hinges of frames, which stay elastic"
            account.refuse("hinges", row.table, what, [frame.name], row.place)
        material = row.text("MATERIALOVERWRITE", "")
        if material and material not in self.building.materials:
            msg = f'MATERIALOVERWRITE "{material}" is not defined'
            raise row.error(msg)
        lengths = [one * row.number(f"LENGTHOFF{end}", 0.0) for end in "IJ"]
        if row.text("SELFWEIGHTOPTION", "").upper() == "CLEAR LENGTH" and any(lengths):
            self._clear.append(frame.name)
        rigid = row.number("RIGIDZONE", 0.0)
        cardinal = row.count("CARDINALPT", 10)
        if min(lengths) < 0.0 or not 0.0 <= rigid <= 1.0 or not 1 <= cardinal <= 11:
            message = "LENGTHOFFI and LENGTHOFFJ must be 0 or longer, RIGIDZONE in [0, 1], "
            raise row.error(message + "CARDINALPT from 1 to 11")
        offsets: list[Vector] = []
        for end in "IJ":
            x, y, z = (one * row.number(f"OFFSET{axis}{end}", 0.0) for axis in "XYZ")
            offsets.append((x, y, z))
        return replace(
            frame,
            material=material,
            angle=row.number("ANG", 0.0),
            releases=self._releases(frame, row),
            end_i=lengths[0],
            end_j=lengths[1],
            rigid=rigid,
            cardinal=cardinal,
            offset_i=offsets[0],
            offset_j=offsets[1],
            transforms=row.text("TRANSFORMSTIFF", "No").upper() == "YES",
            modifiers=factors(row, OBJECT_FACTORS),
            meshed=row.text("AUTOMESH", "YES").upper() != "NO",
        )

    def _releases(self, frame: FrameObject, row: Row) -> tuple[frozenset[str], frozenset[str]]:
        words = row.text("RELEASE", "").upper().split()
        if words == ["PINNED"]:
            words = ["M2I", "M3I", "M2J", "M3J"]
        known = {f"{word}{end}" for word in RELEASES for end in "IJ"}
        wrong = [word for word in words if word not in known]
        if wrong:
            msg = f'RELEASE "{wrong[0]}" must be PINNED, or of {", ".join(sorted(known))}'
            raise row.error(msg)
        forces = {"P", "V2", "V3"}
        ends = [frozenset(w[:-1] for w in words if w.endswith(end)) for end in "IJ"]
        if (ends[0] | ends[1]) & forces:
            what = "releases of axial and shear forces, which are passed on"
            account = self.building.account
            account.refuse("force releases", row.table, what, [frame.name], row.place)
        return ends[0] - forces, ends[1] - forces

    def _read_areas(self) -> None:
        areas = {row.text("Area"): row for row in self.tables.rows("AREA")}
        for (name, story), row in merged(self.tables.rows("AREAASSIGN"), "Area", "Story").items():
            if name not in areas:
                msg = f'area "{name}" is not defined: it is not in AREA CONNECTIVITIES'
                raise row.error(msg)
            area = areas[name]
            points, downs = area.text("Corners").split("\n"), area.text("Stories").split("\n")
            joints = []
            for point, down in zip(points, downs, strict=True):
                if not down.isdigit():
                    msg = f'stories down of a corner = "{down}" must be a whole number'
                    raise area.error(msg)
                joints.append(self.joint(area, point, self.stories.below(row, story, int(down))))
            label = f"{name}-{story}"
            if len(set(joints)) < len(joints):
                msg = f'area "{name}" has one corner twice'
                raise area.error(msg)
            if row.has("OPENING") and row.text("OPENING").upper() not in {"NO", "NONE"}:
                what = "openings in slabs, whose loads are not taken away"
                account = self.building.account
                account.refuse("openings", row.table, what, [label], row.place)
                continue
            section = row.text("SECTION", "")
            section = "" if section.upper() in _NONE else section
            if section and section not in self.building.area_sections:
                msg = f'SECTION "{section}" of area "{name}" is not defined as SHELLPROP'
                raise row.error(msg)
            self._diaphragms.of_area(row, joints, story)
            in_plane, bending = shell_factors(row, "PROPMOD{}{}", self.building)
            self.building.areas[label] = AreaObject(
                label,
                tuple(joints),
                section,
                row.place,
                angle=row.number("ANG", 0.0),
                in_plane=in_plane,
                bending=bending,
                mass=row.number("PROPMODM", 1.0),
                weight=row.number("PROPMODW", 1.0),
                story=story,
            )

    def _read_points(self) -> None:
        units, building = self.building.units, self.building
        springs = {k[0]: r for k, r in merged(self.tables.rows("POINTSPRING"), "Spring").items()}
        rows = merged(self.tables.rows("POINTASSIGN"), "Point", "Story")
        for (point, story), row in rows.items():
            joint = self.joint(row, point, self.stories.below(row, story, 0))
            words = row.text("RESTRAINT", "").upper().split()
            wrong = [word for word in words if word not in _DOFS]
            if wrong:
                msg = f'RESTRAINT "{wrong[0]}" must be of {", ".join(_DOFS)}'
                raise row.error(msg)
            if words:
                building.restraints[joint] = tuple(word.lower() for word in words)
            self._diaphragms.of_point(row, joint, story)
            name = row.text("SPRINGPROP", "")
            if name and name.upper() != "NONE":
                stiffness = self._spring(row, springs, name, joint)
                if any(stiffness):
                    building.springs[joint] = stiffness
            plan = row.number("MASSUXUY", 0.0) * units.mass
            up = row.number("MASSUZ", 0.0) * units.mass
            turns = [row.number(f"MASSR{c}", 0.0) * units.mass * units.length**2 for c in "XYZ"]
            if plan or up or any(turns):
                building.masses[joint] = (plan, plan, up, *turns)

    def _spring(
        self, row: Row, springs: dict[str, Row], name: str, joint: str
    ) -> tuple[float, ...]:
        if name not in springs:
            msg = f'SPRINGPROP "{name}" is not defined as POINTSPRING'
            raise row.error(msg)
        given, units = springs[name], self.building.units
        if given.has("LINKPROP"):
            self.on_links[joint] = given
        scale = [units.line] * 3 + [units.moment] * 3
        return tuple(given.number(dof, 0.0) * s for dof, s in zip(_DOFS, scale, strict=True))
