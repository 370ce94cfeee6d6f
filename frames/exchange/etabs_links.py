"""Links of an ETABS text file: between points, and under points as their springs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.exchange.building import LINK_DOFS, Building, LinkDof, LinkObject, LinkProperty
from frames.exchange.units import link_scales

if TYPE_CHECKING:
    from frames.exchange.etabs_objects import Objects
    from frames.exchange.tables import Row, Tables

PROPERTIES, PLACES = "LINK PROPERTIES", "LINK CONNECTIVITIES"
VALUES = {
    "K": "stiffness",
    "YIELD": "yield",
    "KRATIO": "ratio",
    "OPEN": "open",
    "CSLOW": "slow",
    "CFAST": "fast",
    "RATE": "rate",
    "RADIUS": "radius",
    "DJ": "place",
}
"""Nonlinear numbers of a deformation by the word that follows its name, U2RADIUS."""

_LINEAR = {"STIFF", "KE", "CE", "NONLIN", "FIXED", "EXP"}
_HARMLESS = ("Link", "TYPE", "MASS", "WEIGHT", "RMASS", "PDM", "STIFF", "GUID", "COLOR", "NOTE")


class EtabsLinks:
    """Reads the links of an ETABS file into a building that has its objects.

    Parameters
    ----------
    tables : Tables
        Of the file.
    building : Building
        It is added to.
    objects : Objects
        Which makes joints of points, and has noted which points stand on links.
    """

    def __init__(self, tables: Tables, building: Building, objects: Objects) -> None:
        self.tables, self.building, self.objects = tables, building, objects
        self._rows: dict[str, list[Row]] = {}
        for row in tables.rows("LINKPROP"):
            self._rows.setdefault(row.text("Link"), []).append(row)

    def read(self) -> None:
        """Read links, and the properties that they have."""
        self._read_between()
        self._read_springs()
        building = self.building
        building.account.read(PLACES, "links", len(building.links))
        used = {link.property for link in building.links.values()}
        for name in self._rows:
            if name in used:
                building.link_properties[name] = self._property(name)
        building.account.read(PROPERTIES, "link properties in use", len(used))
        idle = [name for name in self._rows if name not in used]
        building.account.left_out(PROPERTIES, "which nothing has", idle)

    def _read_between(self) -> None:
        assigned = {row.text("Link"): row for row in self.tables.rows("LINKASSIGN")}
        refused = []
        for row in self.tables.rows("LINK"):
            name = row.text("Link")
            joints, given = self._ends(row), assigned.get(name)
            words = {} if given is None else {k: v for k, v in given.values.items() if k != "Link"}
            pairs = [(k, v) for k, value in words.items() for v in str(value).split("\n")]
            found = [value for _, value in pairs if value in self._rows]
            if not joints or given is None or not found:
                refused.append((name, row))
                continue
            given.looked_at.update(word for word, value in pairs if value in self._rows)
            other = joints[1] if len(joints) > 1 else None
            angle = given.number("ANG", 0.0)
            if name in self.building.links:
                msg = f'link "{name}" is there already: keep one of the two'
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
        # Joints of the pairs of story and point; none where the line is no such thing.
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
            name = row.text("LINKPROP")
            if name not in self._rows:
                msg = f'LINKPROP "{name}" is not defined in {PROPERTIES}'
                raise row.error(msg)
            axis = row.text("AXIALDIR", "Z").upper()
            if "Z" not in axis:
                what = f"springs of points by links along {axis}"
                self.building.account.refuse("links", row.table, what, [joint], row.place)
                continue
            label = f"link-{joint}"
            link = LinkObject(label, joint, None, name, row.place, row.number("ANGLE", 0.0))
            self.building.links[label] = link

    def _property(self, name: str) -> LinkProperty:
        rows, units = self._rows[name], self.building.units
        words: dict[str, Row] = {}
        active: dict[str, list[str]] = {word: [] for word in ("DOF", "FIXED", "NONLIN")}
        for row in rows:
            for word in row.values:
                if word in active:
                    active[word] += row.text(word).upper().replace(",", " ").split()
                else:
                    words[word] = row
        wrong = [dof for given in active.values() for dof in given if dof not in LINK_DOFS]
        if wrong:
            msg = f'"{wrong[0]}" of link property "{name}" must be of {", ".join(LINK_DOFS)}'
            raise rows[0].error(msg)
        parts = {word for dof in active["DOF"] for word in words if word.startswith(dof)}
        unknown = [word for word in words if word not in parts and not word.startswith(_HARMLESS)]
        unknown += [w for w in parts if w[2:] not in VALUES and w[2:] not in _LINEAR]
        return LinkProperty(
            name,
            next((row.text("TYPE") for row in rows if row.has("TYPE")), ""),
            {dof: self._dof(dof, words, active) for dof in active["DOF"]},
            words["MASS"].number("MASS") * units.mass if "MASS" in words else 0.0,
            words["WEIGHT"].number("WEIGHT") * units.force if "WEIGHT" in words else 0.0,
            tuple(unknown),
        )

    def _dof(self, dof: str, words: dict[str, Row], active: dict[str, list[str]]) -> LinkDof:
        scales = link_scales(self.building.units, turns=dof.startswith("R"))
        factor = scales["stiffness"]

        def number(word: str) -> float:
            row = words.get(dof + word)
            return 0.0 if row is None else row.number(dof + word)

        def says(word: str) -> bool:
            row = words.get(dof + word)
            return dof in active[word] or (row is not None and row.yes(dof + word))

        return LinkDof(
            fixed=says("FIXED"),
            stiffness=(number("STIFF") or number("KE")) * factor,
            damping=number("CE") * factor,
            nonlinear=says("NONLIN"),
            values={
                ours: number(word) * scales.get(ours, 1.0)
                for word, ours in VALUES.items()
                if dof + word in words
            },
        )
