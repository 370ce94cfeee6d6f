"""Writes a frame as ETABS' text, its bearings as friction isolator links: from SAP2000's tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.exchange.etabs_places import EtabsPlaces
from frames.exchange.write_materials import MATERIALS
from frames.exchange.write_sap2000 import Writer
from frames.exchange.write_shells import shell_lines

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.exchange.write_s2k_text import Value
    from frames.model.frame_data import FrameData

HEAD = (
    "$ File written by lir-dcfp. Not confirmed by any file of ETABS itself: LINKPROP of friction "
    "isolators, LINK, LINKASSIGN; check these links after the import"
)
_DOFS = ("UX", "UY", "UZ", "RX", "RY", "RZ")
_NUMBERED = ((1, "X"), (2, "Y"), (3, "Z"))
_NONLINEAR = {"TransK": "K", "Slow": "CSLOW", "Fast": "CFAST", "Rate": "RATE", "Radius": "RADIUS"}
_LINKS = "LINK PROPERTY DEFINITIONS"


class EtabsWriter:
    """The text of a frame.

    Parameters
    ----------
    frame : Frame
        The model.
    displacement : float or None
        Of the equivalent-linear analysis, for links [m].
    words : str
        Units of the file, "KN, m, C".

    Attributes
    ----------
    names : dict of str to str
        What nodes ("12-Story2") and members ("C1-Story2") are called in the file.
    """

    def __init__(self, frame: FrameData, displacement: float | None, words: str) -> None:
        self.frame, self.words = frame, words
        tables = Writer(frame, displacement, words, program="ETABS")
        self.units = tables.units
        self._rows = tables.tables()
        self._grounded = self._springs()
        self.places = EtabsPlaces(frame, self.units.length, set(self._grounded.values()))
        self.names = {node: f"{p}-{s}" for node, (p, s) in self.places.at.items()}
        self._lines: dict[str, tuple[str, str, bool]] = {}

    def text(self) -> str:
        """Return the text; `names` is complete then."""
        force, length, heat = (word.strip().upper() for word in f"{self.words}, C".split(",")[:3])
        shells = shell_lines(self.frame, self._rows, self.places)
        parts: dict[str, list[str]] = {
            "PROGRAM INFORMATION": ['PROGRAM  "ETABS"  VERSION "20.2.0"'],
            "CONTROLS": [f'UNITS  "{force}"  "{length}"  "{heat}"', "PREFERENCE  MERGETOL 0.0001"],
            "STORIES - IN SEQUENCE FROM TOP": self.places.stories(),
            "DIAPHRAGM NAMES": self._kinds(),
            "MATERIAL PROPERTIES": self._materials(),
            "FRAME SECTIONS": self._sections(),
            **{word: shells[word] for word in ("SLAB PROPERTIES", "WALL PROPERTIES")},
            "LINK PROPERTIES": self._link_properties(),
            "POINT SPRING PROPERTIES": self._point_springs(),
            "POINT COORDINATES": self.places.points(),
            "LINE CONNECTIVITIES": self._connectivities(),
            "AREA CONNECTIVITIES": shells["AREA CONNECTIVITIES"],
            "LINK CONNECTIVITIES": self._links(),
            "POINT ASSIGNS": self._point_assigns(),
            "LINE ASSIGNS": self._line_assigns(),
            "AREA ASSIGNS": shells["AREA ASSIGNS"],
            "LINK ASSIGNS": self._link_assigns(),
        }
        parts |= self._loads()
        out = [HEAD, ""]
        for section, lines in parts.items():
            if lines:
                out += [f"$ {section}", *(f"  {line}  " for line in lines), ""]
        return "\r\n".join([*out, "  END", "$ END OF MODEL FILE", ""])

    def _table(self, name: str) -> list[dict[str, Value]]:
        return self._rows.get(name, [])

    def _springs(self) -> dict[str, str]:
        # Springs between a node and a held one at the same place, by the held node: ETABS merges
        # joints at one place, and has springs of points for them.
        frame = self.frame
        used = {n for m in frame.members.values() for n in (m.i, m.j)}
        used |= {n for part in frame.bearings.values() for n in (part.i, part.j)}
        found = {}
        for spring in frame.springs.values():
            ends = (spring.i, spring.j)
            first, last = (frame.nodes[n].position for n in ends)
            held = [n for n in ends if len(frame.fixed_dofs.get(n, ())) == 6 and n not in used]
            if held and np.allclose(first, last, rtol=0.0, atol=1e-6):
                found[spring.name] = held[0]
        return found

    def _kinds(self) -> list[str]:
        rows = self._table("CONSTRAINT DEFINITIONS - DIAPHRAGM")
        return [f"DIAPHRAGM {_quoted(row['Name'])}  TYPE RIGID" for row in rows]

    def _materials(self) -> list[str]:
        lines = []
        for row in self._table(MATERIALS):
            head = f"MATERIAL  {_quoted(row['Material'])}"
            lines.append(
                f'{head}  TYPE "Other"  WEIGHTPERVOLUME 0  MASSPERVOLUME {row["UnitMass"]!r}'
            )
            lines.append(f'{head}  SYMTYPE "Isotropic"  E {row["E1"]!r}  U {row["U12"]!r}  A 0')
        return lines

    def _sections(self) -> list[str]:
        words = {
            "D": "t3",
            "B": "t2",
            "AREA": "Area",
            "AS2": "AS2",
            "AS3": "AS3",
            "I33": "I33",
            "I22": "I22",
            "TORSION": "TorsConst",
        }
        return [
            f"FRAMESECTION  {_quoted(row['SectionName'])}  MATERIAL {_quoted(row['Material'])}"
            f'  SHAPE "General"  {_numbers({w: row[k] for w, k in words.items()})}'
            for row in self._table("FRAME SECTION PROPERTIES 01 - GENERAL")
        ]

    def _connectivities(self) -> list[str]:
        lines = []
        count = {"COLUMN": 0, "BEAM": 0, "BRACE": 0}
        for row in self._table("CONNECTIVITY - FRAME"):
            name, low, high = (str(row[key]) for key in ("Frame", "JointI", "JointJ"))
            turned = self.places.level(low) > self.places.level(high)
            if turned:
                low, high = high, low
            first, last = self.frame.nodes[low], self.frame.nodes[high]
            apart = self.places.level(high) - self.places.level(low)
            plumb = (first.x, first.y) == (last.x, last.y)
            kind = "COLUMN" if plumb else "BRACE" if apart else "BEAM"
            count[kind] += 1
            letter = {"COLUMN": "C", "BEAM": "B", "BRACE": "D"}[kind]
            (point, _), (other, story) = self.places.at[low], self.places.at[high]
            label = f"{letter}{count[kind]}"
            lines.append(f'LINE  "{label}"  {kind}  "{point}"  "{other}"  {apart}')
            self._lines[name] = (label, story, turned)
            self.names[name] = f"{label}-{story}"
        return lines

    def _line_assigns(self) -> list[str]:
        found: dict[str, list[str]] = {}
        for row in self._table("FRAME SECTION ASSIGNMENTS"):
            found[str(row["Frame"])] = [f"SECTION {_quoted(row['AnalSect'])}"]
        for row in self._table("FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL"):
            name = str(row["Frame"])
            sign = -1.0 if self._lines[name][2] else 1.0  # axis 2 stays, 1 and 3 turn round
            found[name].append(f"ANG {sign * float(row['Angle'])!r}")
        for row in self._table("FRAME RELEASE ASSIGNMENTS 1 - GENERAL"):
            name = str(row["Frame"])
            ends = dict(zip("IJ", self._ends(name), strict=True))
            words = ("P", "V2", "V3", "T", "M2", "M3")
            free = [f"{w}{there}" for here, there in ends.items() for w in words if row[w + here]]
            found[name].append(f'RELEASE "{" ".join(free)}"')
        for row in self._table("FRAME INSERTION POINT ASSIGNMENTS"):
            name = str(row["Frame"])
            ends = dict(zip("IJ", self._ends(name), strict=True))
            numbers = {
                f"OFFSET{axis}{there}": row[f"JtOffset{axis}{here}"]
                for here, there in ends.items()
                for axis in "XYZ"
            }
            found[name].append(f'CARDINALPT 10  {_numbers(numbers)}  TRANSFORMSTIFF "Yes"')
        for row in self._table("FRAME PROPERTY MODIFIERS"):
            found[str(row["Frame"])].append(f"PROPMODM {row['MassMod']!r}")
        return [
            f'LINEASSIGN  "{self._lines[name][0]}"  "{self._lines[name][1]}"  {"  ".join(words)}'
            '  AUTOMESH "NO"'
            for name, words in found.items()
        ]

    def _ends(self, name: str) -> str:
        return "JI" if self._lines[name][2] else "IJ"

    def _link_properties(self) -> list[str]:
        kinds = {str(r["Link"]): str(r["LinkType"]) for r in self._table(f"{_LINKS} 01 - GENERAL")}
        lines = []
        for name, kind in kinds.items():
            if name.removeprefix("K-") in self._grounded:
                continue
            rows = [
                row
                for table in ("02 - LINEAR", "08 - SLIDING ISOLATOR")
                for row in self._table(f"{_LINKS} {table}")
                if row["Link"] == name
            ]
            head = f"LINKPROP  {_quoted(name)}"
            lines.append(f'{head}  TYPE "{kind.upper()}"')
            lines.append(f'{head}  DOF "{" ".join(str(row["DOF"]) for row in rows)}"')
            lines += [f"{head}  {_numbers(_dof(row))}" for row in rows]
        return lines

    def _point_springs(self) -> list[str]:
        lines = []
        for name in self._grounded:
            values = self.frame.springs[name].stiffness
            scale = [self.units.line] * 3 + [self.units.moment] * 3
            parts = {w: v / s for w, v, s in zip(_DOFS, values, scale, strict=True)}
            lines.append(
                f'POINTSPRING  {_quoted(name)}  STIFFNESSOPTION "USERDEFINED"  {_numbers(parts)}'
            )
        return lines

    def _links(self) -> list[str]:
        lines = []
        for row in self._table("CONNECTIVITY - LINK"):
            if row["Link"] not in self._grounded:
                ends = (self.places.at[str(row[key])] for key in ("JointI", "JointJ"))
                places = "  ".join(f'POINT  "{story}"  "{point}"' for point, story in ends)
                lines.append(f"LINK  {_quoted(row['Link'])}  {places}")
        return lines

    def _link_assigns(self) -> list[str]:
        return [
            f"LINKASSIGN  {_quoted(row['Link'])}  PROPERTY  {_quoted(row['LinkProp'])}"
            for row in self._table("LINK PROPERTY ASSIGNMENTS")
            if row["Link"] not in self._grounded
        ]

    def _point_assigns(self) -> list[str]:
        found: dict[str, list[str]] = {node: [] for node in self.places.at}
        for node, dofs in self.frame.fixed_dofs.items():
            if node in found:
                held = " ".join(dof for dof in _DOFS if dof.lower() in dofs)
                found[node].append(f'RESTRAINT "{held}"')
        for row in self._table("JOINT CONSTRAINT ASSIGNMENTS"):
            found[str(row["Joint"])].append(f"DIAPH {_quoted(row['Constraint'])}")
        for name, ground in self._grounded.items():
            spring = self.frame.springs[name]
            node = spring.i if spring.j == ground else spring.j
            found[node].append(f"SPRINGPROP {_quoted(name)}")
        for row in self._table("JOINT ADDED MASS ASSIGNMENTS"):
            if row["Mass1"] != row["Mass2"]:
                message = (
                    f'masses of node "{row["Joint"]}" differ between x and y, which ETABS\' text '
                    "cannot hold: give one mass in plan"
                )
                raise ModelError(message)
            parts = {"MASSUXUY": row["Mass1"], "MASSUZ": row["Mass3"]}
            parts |= {f"MASSR{axis}": row[f"MMI{k}"] for k, axis in enumerate("XYZ", start=1)}
            found[str(row["Joint"])].append(_numbers(parts))
        for row in self._table("JOINT LOADS - FORCE"):
            if not found[str(row["Joint"])]:
                found[str(row["Joint"])].append('DIAPH "DISCONNECTED"')
        lines = []
        for node, words in found.items():
            point, story = self.places.at[node]
            if words:
                lines.append(f'POINTASSIGN  "{point}"  "{story}"  {"  ".join(words)}')
        return lines

    def _loads(self) -> dict[str, list[str]]:
        patterns = self._table("LOAD PATTERN DEFINITIONS")
        points = []
        for row in self._table("JOINT LOADS - FORCE"):
            point, story = self.places.at[str(row["Joint"])]
            words = zip(
                ("FX", "FY", "FZ", "MX", "MY", "MZ"),
                ("F1", "F2", "F3", "M1", "M2", "M3"),
                strict=True,
            )
            parts = _numbers({word: row[field] for word, field in words})
            lc = _quoted(row["LoadPat"])
            points.append(f'POINTLOAD  "{point}"  "{story}"  TYPE "FORCE"  LC {lc}  {parts}')
        lines = []
        for row in self._table("FRAME LOADS - DISTRIBUTED"):
            label, story, turned = self._lines[str(row["Frame"])]
            a, b, start, end = (
                float(row[key]) for key in ("RelDistA", "RelDistB", "FOverLA", "FOverLB")
            )
            if turned:
                a, b, start, end = 1.0 - b, 1.0 - a, end, start
            parts = _numbers({"FSTART": start, "FEND": end, "RDSTART": a, "RDEND": b})
            lc = _quoted(row["LoadPat"])
            head = f'LINELOAD  "{label}"  "{story}"  TYPE "TRAPF"  DIR "{row["Dir"]}"  LC {lc}'
            lines.append(f"{head}  {parts}")
        source = self._table("MASS SOURCE")
        masses = [row for row in source if row["Loads"]]
        name = _quoted(source[0]["MassSource"])
        yes = "Yes" if masses else "No"
        return {
            "LOAD PATTERNS": [
                f'LOADPATTERN {_quoted(r["LoadPat"])}  TYPE  "{r["DesignType"]}"  SELFWEIGHT  0'
                for r in patterns
            ],
            "POINT OBJECT LOADS": points,
            "FRAME OBJECT LOADS": lines,
            "MASS SOURCE": [
                f'MASSSOURCE  {name}  INCLUDEELEMENTS "Yes"  INCLUDEADDEDMASS "Yes"'
                f'  INCLUDELOADS "{yes}"  INCLUDEMOVE "No"  INCLUDELATERALMASS "Yes"'
                '  INCLUDEVERTICALMASS "Yes"  LUMPATSTORIES "No"  ISDEFAULT "Yes"',
                *(
                    f"MASSSOURCELOAD  {name}  {_quoted(r['LoadPat'])}  {r['Multiplier']!r}"
                    for r in masses
                ),
            ],
            "LOAD CASES": [
                line
                for r in patterns
                for line in (
                    f'LOADCASE {_quoted(r["LoadPat"])}  TYPE  "Linear Static"  INITCOND  "PRESET"',
                    f"LOADCASE {_quoted(r['LoadPat'])}  LOADPAT  {_quoted(r['LoadPat'])}  SF  1",
                )
            ],
        }


def _dof(row: dict[str, Value]) -> dict[str, Value]:
    # Words of a deformation: of linear links STIFF, of isolators KE, CE and the nonlinear numbers.
    dof = str(row["DOF"])
    if "NonLinear" not in row:
        return {f"{dof}STIFF": row.get("TransKE", row.get("RotKE", 0.0))}
    found: dict[str, Value] = {f"{dof}NONLIN": row["NonLinear"]}
    found |= {f"{dof}KE": row["TransKE"], f"{dof}CE": row["TransCE"]}
    return found | {f"{dof}{word}": row[key] for key, word in _NONLINEAR.items() if key in row}


def _quoted(value: Value) -> str:
    words = str(value)
    if '"' in words:
        message = f"the name {words!r} has a quotation mark, which ETABS' text cannot hold"
        raise ModelError(message)
    return f'"{words}"'


def _numbers(values: Mapping[str, Value]) -> str:
    return "  ".join(
        f"{word} {_quoted('Yes' if value else 'No')}"
        if isinstance(value, bool)
        else f"{word} {float(value)!r}"
        for word, value in values.items()
    )
