"""Links of an ETABS text file: between points and under points; groups of both."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.exchange import etabs_fields as dialect
from frames.exchange.building import LINK_DOFS, Building, LinkDof, LinkObject, LinkProperty
from frames.exchange.fields import refused, values
from frames.exchange.reading import TEXT
from frames.exchange.tables import known, merged

if TYPE_CHECKING:
    from frames.exchange.etabs_objects import Objects
    from frames.exchange.tables import Row, Tables

PROPERTIES, PLACES = "LINK PROPERTIES", "LINK CONNECTIVITIES"
_LISTS = ("DOF", "FIXED", "NONLIN")
_OF_DOF = {"FIXED", "NONLIN", "EXP"} | {
    field.names
    for map_ in (*dialect.LINEAR.values(), *dialect.NONLINEAR.values())
    for field in map_
}
_HARMLESS = ("Link", "TYPE", "MASS", "WEIGHT", "RMASS", "PDM", "STIFF", "GUID", "COLOR", "NOTE")
_AT_STORIES = {"POINT": "joint", "LINE": "frame", "AREA": "area"}


class EtabsLinks:
    """Reads the links of an ETABS file into a building that has its objects."""

    def __init__(self, tables: Tables, building: Building, objects: Objects) -> None:
        self.tables, self.building, self.objects = tables, building, objects
        rows = merged(tables.rows("LINKPROP"), "Link", adding=_LISTS)
        self._properties = {name: row for (name,), row in rows.items()}

    def read(self) -> None:
        """Read links, and the properties that they have."""
        self._read_between()
        self._read_springs()
        building = self.building
        building.account.read(PLACES, "links", len(building.links))
        used = {link.property for link in building.links.values()}
        for name, row in self._properties.items():
            if name in used:
                building.link_properties[name] = _property(row, name, building)
        building.account.read(PROPERTIES, "link properties in use", len(used))
        idle = [name for name in self._properties if name not in used]
        building.account.left_out(PROPERTIES, "which nothing has", idle)

    def _read_between(self) -> None:
        assigned = {row.text("Link"): row for row in self.tables.rows("LINKASSIGN")}
        refused = []
        for row in self.tables.rows("LINK"):
            name = row.text("Link")
            joints, given = self._ends(row), assigned.get(name)
            words = {} if given is None else {k: v for k, v in given.values.items() if k != "Link"}
            pairs = [(k, v) for k, value in words.items() for v in str(value).split("\n")]
            found = [value for _, value in pairs if value in self._properties]
            if not joints or given is None or not found:
                refused.append((name, row))
                continue
            given.looked_at.update(word for word, value in pairs if value in self._properties)
            other = joints[1] if len(joints) > 1 else None
            angle = given.number("ANG", 0.0)
            if name in self.building.links:
                msg = f'link "{name}" occurs twice: keep one of the two'
                raise row.error(msg)
            link = LinkObject(name, joints[0], other, found[0], row.place, angle)
            self.building.links[name] = link
        if refused:
            what = (
                'links whose lines are not LINK "K1" POINT "Story1" "1" POINT "Story2" "1" with a '
                "LINKASSIGN of a LINKPROP"
            )
            place = refused[0][1].place
            self.building.account.refuse("links", PLACES, what, [n for n, _ in refused], place)

    def _ends(self, row: Row) -> list[str]:
        # Joints of the pairs of story and point; none for another kind of line.
        words = row.text("Ends", "").split("\n")
        if len(words) not in {2, 4}:
            return []
        found = []
        for first, last in zip(words[::2], words[1::2], strict=True):
            pair = (first, last) if self.objects.is_place(last, first) else (last, first)
            story, point = pair
            if not self.objects.is_place(point, story):
                return []
            found.append(self.objects.joint(row, point, story))
        return found if len(set(found)) == len(found) else []

    def _read_springs(self) -> None:
        for joint, row in self.objects.on_links.items():
            name = known(row, "LINKPROP", row.text("LINKPROP"), self._properties)
            if refused(row, joint, self.building.account, dialect.SPRING_WORDS):
                continue
            label = f"link-{joint}"
            link = LinkObject(label, joint, None, name, row.place, row.number("ANGLE", 0.0))
            self.building.links[label] = link


def _property(row: Row, name: str, building: Building) -> LinkProperty:
    active = {word: row.text(word, "").upper().replace(",", " ").split() for word in _LISTS}
    wrong = [dof for given in active.values() for dof in given if dof not in LINK_DOFS]
    if wrong:
        msg = f'"{wrong[0]}" of link property "{name}" must be of {", ".join(LINK_DOFS)}'
        raise row.error(msg)
    words = [word for word in row.values if word not in _LISTS]
    parts = [word for word in words if word.startswith(tuple(active["DOF"])) and row.text(word)]
    unknown = [w for w in words if w not in parts and not w.startswith(_HARMLESS)]
    unknown += [word for word in parts if word[2:] not in _OF_DOF]
    dofs = {dof: _dof(row, dof, active, building) for dof in active["DOF"]}
    given = values(row, dialect.LINK, building)
    return LinkProperty(name, dofs=dofs, unknown=tuple(unknown), **given)


def _dof(row: Row, dof: str, active: dict[str, list[str]], building: Building) -> LinkDof:
    turns = dof.startswith("R")
    linear = values(row, dialect.LINEAR[turns], building, prefix=dof)

    def says(word: str) -> bool:
        return dof in active[word] or row.yes(dof + word, default=False)

    return LinkDof(
        fixed=says("FIXED"),
        stiffness=linear["own"] or linear["stiffness"],
        damping=linear["damping"],
        nonlinear=says("NONLIN"),
        values=values(row, dialect.NONLINEAR[turns], building, prefix=dof, only_given=True),
    )


def read_groups(tables: Tables, building: Building) -> None:
    """Read the groups, by which bearings are placed, into a building that has its links.

    A line names a group and an object of it: GROUP "ISO" POINT "12" "Base", GROUP "ISO" LINK "K1".
    A point at the upper end of a link brings this link along.
    """
    odd = []
    for row in tables.rows("GROUP"):
        name = row.text("Group")
        members = building.groups.setdefault(name, [])
        found = _members(row, building)
        if found is None:
            odd.append(name)
        else:
            members += found
    building.account.read("GROUPS", "groups", len(building.groups))
    what = "objects of groups on lines of another form: bearings are not placed by them"
    building.account.left_out("GROUPS", what, list(dict.fromkeys(odd)))


def _members(row: Row, building: Building) -> list[tuple[str, str]] | None:
    # Objects of a line by kind; none of a line that only defines a group, None of another form.
    kinds = [word for word in (*_AT_STORIES, "LINK") if row.has(word)]
    if not kinds:
        return []
    if len(kinds) > 1:
        return None
    names = row.text(kinds[0]).split("\n")
    if kinds[0] == "LINK":
        is_known = all(name in building.links for name in names)
        return [("link", name) for name in names] if is_known else None
    stories = row.text(TEXT, "").split("\n")
    if len(stories) != len(names) or "" in stories:
        return None
    labels = [f"{name}-{story}" for name, story in zip(names, stories, strict=True)]
    found = [(_AT_STORIES[kinds[0]], label) for label in labels]
    under = [f"link-{label}" for label in labels if kinds[0] == "POINT"]
    return found + [("link", link) for link in under if link in building.links]
