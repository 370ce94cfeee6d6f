"""Writes a building as ETABS' text: points in plan at stories, lines and areas at stories."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from frames._errors import ModelError
from frames.exchange import etabs_fields as dialect
from frames.exchange.building import RELEASES
from frames.exchange.fields import written
from frames.exchange.shells import area_kind
from frames.exchange.write_sap2000 import along_axes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.exchange.building import Building, FrameObject, Joint, LinkDof
    from frames.exchange.write_sap2000 import Value

HEAD = (
    "$ File written by lir-dcfp. Not confirmed by any file of ETABS itself: LINKPROP of friction "
    "isolators, LINK, LINKASSIGN; check these links after the import"
)
LEAST_STORY = 0.01
"""Least height of a story; a level that is closer to the one below has none of its own [m]."""


_STATIC = 'TYPE  "Linear Static"  INITCOND  "PRESET"'
_HALVES = (dialect.MATERIAL[:2], dialect.MATERIAL[2:])  # a line of the file each


class Places:
    """Stories and points: each joint is a point in plan at a story, or hangs below the next one.

    Stories are the building's, and always the lowest and the highest joint. `at` has point and
    story by joint.
    """

    def __init__(self, building: Building) -> None:
        self._one = building.units.length
        heights = sorted({joint.z for joint in building.joints.values()})
        chosen = {z for _, z in building.stories}
        self._z = [heights[0]]
        for z in heights[1:]:
            if z in chosen and z - self._z[-1] > LEAST_STORY:
                self._z.append(z)
        if heights[-1] > self._z[-1]:
            self._z.append(heights[-1])
        self._names = ["Base", *(f"Story{k}" for k in range(1, len(self._z)))]
        self._points: dict[tuple[float, float, float], str] = {}
        self.at: dict[str, tuple[str, str]] = {}
        taken: dict[tuple[str, str], str] = {}
        for joint in building.joints.values():
            place = self._place(joint)
            if place in taken:
                message = (
                    f'nodes "{taken[place]}" and "{joint.name}" coincide, and ETABS would '
                    "merge them: move one, or join them in the frame"
                )
                raise ModelError(message)
            taken[place] = joint.name
            self.at[joint.name] = place

    def _place(self, joint: Joint) -> tuple[str, str]:
        k = bisect_left(self._z, joint.z)
        key = (joint.x, joint.y, self._z[k] - joint.z)
        return self._points.setdefault(key, str(len(self._points) + 1)), self._names[k]

    def level(self, joint: str) -> int:
        """Return the number of the story at which a joint is, 0 for the base."""
        return self._names.index(self.at[joint][1])

    def stories(self) -> list[str]:
        """Return the lines of stories, from the top."""
        lines = [
            f'STORY "{name}"  HEIGHT {(z - low) / self._one!r}  MASTERSTORY "Yes"'
            for name, z, low in zip(self._names[1:], self._z[1:], self._z[:-1], strict=True)
        ]
        return [*lines[::-1], f'STORY "Base"  ELEV {self._z[0] / self._one!r}']

    def points(self) -> list[str]:
        """Return the lines of points: x, y, and how far below the story."""
        return [
            f'POINT "{name}"  '
            + " ".join(repr(v / self._one) for v in (place if place[2] else place[:2]))
            for place, name in self._points.items()
        ]


class EtabsWriter:
    """The text of a building, whose `version` has the words of the units.

    `names` has the names of nodes ("12-Story2") and, once the text is made, of members
    ("C1-Story2").
    """

    def __init__(self, building: Building) -> None:
        self.building, self.units = building, building.units
        self.places = Places(building)
        self.names = {node: f"{p}-{s}" for node, (p, s) in self.places.at.items()}
        self._lines: dict[str, tuple[str, str, bool]] = {}
        self._springs = {joint: f"S{k}" for k, joint in enumerate(building.springs, start=1)}

    def text(self) -> str:
        """Return the text."""
        words = f"{self.building.version}, C".split(",")[:3]
        units = "  ".join(_quoted(word.strip().upper()) for word in words)
        area_sections = self._area_sections()
        places, assigns = self._areas()
        parts: dict[str, list[str]] = {
            "PROGRAM INFORMATION": ['PROGRAM  "ETABS"  VERSION "20.2.0"'],
            "CONTROLS": [f"UNITS  {units}", "PREFERENCE  MERGETOL 0.0001"],
            "STORIES - IN SEQUENCE FROM TOP": self.places.stories(),
            "DIAPHRAGM NAMES": [
                f"DIAPHRAGM {_quoted(name)}  TYPE RIGID" for name in self.building.constraints
            ],
            "MATERIAL PROPERTIES": self._materials(),
            "FRAME SECTIONS": self._sections(),
            "SLAB PROPERTIES": [line for line in area_sections if '"Slab"' in line],
            "WALL PROPERTIES": [line for line in area_sections if '"Wall"' in line],
            "LINK PROPERTIES": self._link_properties(),
            "POINT SPRING PROPERTIES": self._point_springs(),
            "POINT COORDINATES": self.places.points(),
            "LINE CONNECTIVITIES": self._connectivities(),
            "AREA CONNECTIVITIES": places,
            "LINK CONNECTIVITIES": self._links(),
            "POINT ASSIGNS": self._point_assigns(),
            "LINE ASSIGNS": [self._line_assign(one) for one in self.building.frames.values()],
            "AREA ASSIGNS": assigns,
            "LINK ASSIGNS": [
                f"LINKASSIGN  {_quoted(name)}  PROPERTY  {_quoted(link.property)}"
                for name, link in self.building.links.items()
            ],
            **self._loads(),
        }
        out = [HEAD, ""]
        for section, lines in parts.items():
            if lines:
                out += [f"$ {section}", *(f"  {line}  " for line in lines), ""]
        return "\r\n".join([*out, "  END", "$ END OF MODEL FILE", ""])

    def _materials(self) -> list[str]:
        lines = []
        for name, matter in self.building.materials.items():
            own = (_words(written(part, matter, self.units)) for part in _HALVES)
            kinds = ('TYPE "Other"', 'SYMTYPE "Isotropic"  A 0')
            lines += [
                f"MATERIAL  {_quoted(name)}  {kind}  {numbers}"
                for kind, numbers in zip(kinds, own, strict=True)
            ]
        return lines

    def _sections(self) -> list[str]:
        return [
            f"FRAMESECTION  {_quoted(name)}  " + _words(written(dialect.SECTION, one, self.units))
            for name, one in self.building.sections.items()
        ]

    def _area_sections(self) -> list[str]:
        lines = []
        for name, section in self.building.area_sections.items():
            what = "SLAB" if name.startswith("SLAB") else "WALL"
            thickness = {f"{what}THICKNESS": section.thickness / self.units.length}
            factors = written(dialect.SHELL[:6], section.factors, self.units)
            lines.append(
                f'SHELLPROP  "{name}"  PROPTYPE  "{what.title()}"  MATERIAL '
                f'"{section.material}"  MODELINGTYPE "ShellThin"  {_words(thickness | factors)}'
            )
        return lines

    def _areas(self) -> tuple[list[str], list[str]]:
        # Lines of places, and of assignments.
        places, assigns = [], []
        for k, area in enumerate(self.building.areas.values(), start=1):
            levels = [self.places.level(joint) for joint in area.joints]
            story = self.places.at[area.joints[levels.index(max(levels))]][1]
            points = "  ".join(f'"{self.places.at[joint][0]}"' for joint in area.joints)
            downs = "  ".join(str(max(levels) - level) for level in levels)
            kind = area_kind(self.building, area.joints)
            places.append(f'AREA  "A{k}"  {kind}  {len(area.joints)}  {points}  {downs}')
            assigns.append(
                f'AREAASSIGN  "A{k}"  "{story}"  SECTION "{area.section}"  OBJMESHTYPE "NOAUTOMESH"'
            )
        return places, assigns

    def _connectivities(self) -> list[str]:
        lines = []
        count = {"COLUMN": 0, "BEAM": 0, "BRACE": 0}
        for one in self.building.frames.values():
            low, high = one.i, one.j
            turned = self.places.level(low) > self.places.level(high)
            if turned:
                low, high = high, low
            first, last = self.building.joints[low], self.building.joints[high]
            apart = self.places.level(high) - self.places.level(low)
            plumb = (first.x, first.y) == (last.x, last.y)
            kind = "COLUMN" if plumb else "BRACE" if apart else "BEAM"
            count[kind] += 1
            letter = {"COLUMN": "C", "BEAM": "B", "BRACE": "D"}[kind]
            (point, _), (other, story) = self.places.at[low], self.places.at[high]
            label = f"{letter}{count[kind]}"
            lines.append(f'LINE  "{label}"  {kind}  "{point}"  "{other}"  {apart}')
            self._lines[one.name] = (label, story, turned)
            self.names[one.name] = f"{label}-{story}"
        return lines

    def _line_assign(self, one: FrameObject) -> str:
        label, story, turned = self._lines[one.name]
        words = [f"SECTION {_quoted(one.section)}"]
        if one.angle:  # of a line that is turned, axis 2 stays, 1 and 3 turn round
            words.append(f"ANG {-one.angle if turned else one.angle!r}")
        releases, offsets = one.releases, (one.offset_i, one.offset_j)
        if turned:
            releases, offsets = releases[::-1], offsets[::-1]
        if any(releases):
            ends = zip("IJ", releases, strict=True)
            free = [f"{word}{end}" for end, found in ends for word in RELEASES if word in found]
            words.append(f'RELEASE "{" ".join(free)}"')
        if any(offsets[0]) or any(offsets[1]):
            numbers = written(dialect.OFFSETS, (*offsets[0], *offsets[1]), self.units)
            words.append(f'CARDINALPT 10  {_words(numbers)}  TRANSFORMSTIFF "Yes"')
        factors = written(dialect.FRAME_MODIFIERS, one.modifiers, self.units)
        words += [f"{word} {factor!r}" for word, factor in factors.items() if factor not in {1.0}]
        return f'LINEASSIGN  "{label}"  "{story}"  {"  ".join(words)}  AUTOMESH "NO"'

    def _link_properties(self) -> list[str]:
        lines = []
        for name, prop in self.building.link_properties.items():
            head = f"LINKPROP  {_quoted(name)}"
            lines.append(f'{head}  TYPE "{prop.kind.upper()}"')
            lines.append(f'{head}  DOF "{" ".join(prop.dofs)}"')
            lines += [f"{head}  {_words(self._dof(*item))}" for item in prop.dofs.items()]
        return lines

    def _dof(self, dof: str, given: LinkDof) -> dict[str, Value]:
        # Words of a deformation: of linear links STIFF, of isolators KE, CE and nonlinear numbers.
        turns = dof.startswith("R")
        linear = dialect.LINEAR[turns]
        if not given.nonlinear:
            values = written(linear, {"own": given.stiffness}, self.units)
        else:
            values = {"NONLIN": True} | written(linear[1:], given, self.units)
            values |= written(dialect.NONLINEAR[turns], given.values, self.units)
        return {f"{dof}{word}": value for word, value in values.items()}

    def _point_springs(self) -> list[str]:
        lines = []
        for joint, name in self._springs.items():
            values = _words(written(dialect.SUPPORT, self.building.springs[joint], self.units))
            lines.append(f'POINTSPRING  {_quoted(name)}  STIFFNESSOPTION "USERDEFINED"  {values}')
        return lines

    def _links(self) -> list[str]:
        lines = []
        for name, link in self.building.links.items():
            ends = (self.places.at[joint] for joint in (link.i, link.j) if joint is not None)
            places = "  ".join(f'POINT  "{story}"  "{point}"' for point, story in ends)
            lines.append(f"LINK  {_quoted(name)}  {places}")
        return lines

    def _point_assigns(self) -> list[str]:
        building = self.building
        found: dict[str, list[str]] = {joint: [] for joint in self.places.at}
        for joint, held in building.restraints.items():
            found[joint].append(f'RESTRAINT "{" ".join(dof.upper() for dof in held)}"')
        for part in building.constraints.values():
            for joint in part.joints:
                found[joint].append(f"DIAPH {_quoted(part.name)}")
        for joint, name in self._springs.items():
            found[joint].append(f"SPRINGPROP {_quoted(name)}")
        for joint, (x, y, z, *turns) in building.masses.items():
            if x != y:
                message = (
                    f'masses of node "{joint}" differ between x and y, which ETABS does not '
                    "support: use equal masses in plan"
                )
                raise ModelError(message)
            found[joint].append(_words(written(dialect.MASS, (x, z, *turns), self.units)))
        for load in building.joint_loads:
            if not found[load.joint]:
                found[load.joint].append('DIAPH "DISCONNECTED"')
        return [
            f'POINTASSIGN  "{point}"  "{story}"  {"  ".join(words)}'
            for joint, words in found.items()
            if words
            for point, story in (self.places.at[joint],)
        ]

    def _loads(self) -> dict[str, list[str]]:
        building, points, lines = self.building, [], []
        for load in building.joint_loads:
            point, story = self.places.at[load.joint]
            parts = _words(written(dialect.FORCES, load.forces, self.units))
            lc = _quoted(load.pattern)
            points.append(f'POINTLOAD  "{point}"  "{story}"  TYPE "FORCE"  LC {lc}  {parts}')
        for line in building.line_loads:
            label, story, turned = self._lines[line.frame]
            for given in along_axes(line):
                ends = {"a": line.a, "b": line.b}
                if turned:
                    ends = {"a": 1.0 - line.b, "b": 1.0 - line.a}
                    given["start"], given["end"] = given["end"], given["start"]
                way = given.pop("way")
                parts = _words(written(dialect.LINE_LOAD["TRAPF"], given | ends, self.units))
                head = f'LINELOAD  "{label}"  "{story}"  TYPE "TRAPF"  DIR "{way}"'
                lines.append(f"{head}  LC {_quoted(line.pattern)}  {parts}")
        patterns = {
            _quoted(name): _words(written(dialect.PATTERN, pattern, self.units))
            for name, pattern in building.patterns.items()
        }
        return {
            "LOAD PATTERNS": [f"LOADPATTERN {name}  {words}" for name, words in patterns.items()],
            "POINT OBJECT LOADS": points,
            "FRAME OBJECT LOADS": lines,
            "MASS SOURCE": self._mass_source(),
            "LOAD CASES": [
                f"LOADCASE {name}  {words}"
                for name in patterns
                for words in (_STATIC, f"LOADPAT  {name}  SF  1")
            ],
        }

    def _mass_source(self) -> list[str]:
        source = self.building.mass_source
        shares = {} if source is None else source.patterns
        said = {"elements": True, "added": True, "loads": bool(shares), "lumped": False}
        head = _words(written(dialect.MASS_SOURCE, said | {"default": True}, self.units))
        more = 'INCLUDEMOVE "No"  INCLUDELATERALMASS "Yes"  INCLUDEVERTICALMASS "Yes"'
        loads = (f"{_quoted(name)}  {share!r}" for name, share in shares.items())
        return [
            f'MASSSOURCE  "MSSSRC1"  {head}  {more}',
            *(f'MASSSOURCELOAD  "MSSSRC1"  {load}' for load in loads),
        ]


def _quoted(value: Value) -> str:
    words = str(value)
    if '"' in words:
        message = (
            f"the name {words!r} has a quotation mark, which ETABS does not support: remove it"
        )
        raise ModelError(message)
    return f'"{words}"'


def _words(values: Mapping[str, Value]) -> str:
    # Words with their values, texts in quotation marks.
    texts = {k: ("No", "Yes")[v] if isinstance(v, bool) else v for k, v in values.items()}
    return "  ".join(
        f"{word} {_quoted(value) if isinstance(value, str) else repr(float(value))}"
        for word, value in texts.items()
    )
