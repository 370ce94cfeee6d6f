"""Models of SAP2000 for tests, as its text tables; sources of the format: docs/exchange.md."""

from __future__ import annotations

Rows = dict[str, list[dict[str, object]]]

FILLED = (
    *("JOINT COORDINATES", "CONNECTIVITY - FRAME", "FRAME SECTION ASSIGNMENTS"),
    *("CONNECTIVITY - AREA", "AREA SECTION ASSIGNMENTS", "JOINT RESTRAINT ASSIGNMENTS"),
    *("CONSTRAINT DEFINITIONS - DIAPHRAGM", "JOINT CONSTRAINT ASSIGNMENTS"),
    "AREA LOADS - UNIFORM",
)
UNITS = {"KN, m, C": (1e3, 1.0), "Kip, in, F": (4448.2216152605, 0.0254), "N, mm, C": (1.0, 1e-3)}


def text(tables: Rows, end: str = "END TABLE DATA") -> str:
    """Return the tables as SAP2000 writes them, long rows broken by an underscore."""
    lines = ["File model.s2k was saved on 1/2/25 at 9:00:00", ""]
    for name, rows in tables.items():
        lines.append(f'TABLE:  "{name}"')
        for row in rows:
            parts = [f"{key}={_value(value)}" for key, value in row.items()]
            first, rest = parts[:9], parts[9:]
            lines.append("   " + "   ".join(first) + (" _" if rest else ""))
            if rest:
                lines.append("        " + "   ".join(rest))
        lines.append("")
    return "\n".join([*lines, end, ""])


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "Yes" if value else "No"
    if isinstance(value, float):
        return repr(value)
    words = str(value)
    return f'"{words}"' if " " in words else words


def concrete(units: str) -> list[dict[str, object]]:
    force, length = UNITS[units]
    stress, weight = force / length**2, force / length**3
    heavy = {"UnitWeight": 25e3 / weight, "UnitMass": 2500.0 / (weight / length)}
    return [{"Material": "C30"} | heavy | {"E1": 30e9 / stress, "G12": 12.5e9 / stress, "U12": 0.2}]


def rectangle(name: str, depth: float, width: float, one: float, shear: bool) -> dict[str, object]:
    """Return a row of sections, by dimensions [m] and the length unit [m]."""
    area = depth * width
    short, long = sorted((depth, width))
    torsion = long * short**3 / 3.0 * (1.0 - 0.63 * short / long)
    return {
        "SectionName": name,
        "Material": "C30",
        "Shape": "Rectangular",
        "t3": depth / one,
        "t2": width / one,
        "Area": area / one**2,
        "TorsConst": torsion / one**4,
        "I33": width * depth**3 / 12.0 / one**4,
        "I22": depth * width**3 / 12.0 / one**4,
        "I23": 0,
        "AS2": 5 / 6 * area / one**2 if shear else 0,
        "AS3": 5 / 6 * area / one**2 if shear else 0,
    }


def building(
    units: str = "KN, m, C",
    *,
    storeys: int = 2,
    bays: tuple[int, int] = (2, 1),
    width: tuple[float, float] = (6.0, 5.0),
    height: float = 3.0,
    walls: bool = False,
    slabs: bool = True,
    details: bool = False,
) -> Rows:
    """Return a regular concrete frame with slabs in rigid diaphragms; walls along its sides in x.

    With details: releases, end zones, insertion points, modifiers, turned columns, loads on frames
    and joints, added masses.
    """
    force, one = UNITS[units]
    floor = force / one**2
    tables: Rows = {
        "PROGRAM CONTROL": [{"ProgramName": "SAP2000", "Version": "22.0.0", "CurrUnits": units}],
        "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES": concrete(units),
        "FRAME SECTION PROPERTIES 01 - GENERAL": [
            rectangle("COL", 0.5, 0.4, one, shear=False),
            rectangle("BEAM", 0.6, 0.3, one, shear=False) | ({"I3Mod": 0.5} if details else {}),
        ],
        "LOAD PATTERN DEFINITIONS": [
            {"LoadPat": "DEAD", "DesignType": "Dead", "SelfWtMult": 1},
            {"LoadPat": "LIVE", "DesignType": "Live", "SelfWtMult": 0},
            {"LoadPat": "WIND", "DesignType": "Wind", "SelfWtMult": 0},
        ],
        "MASS SOURCE": [
            {"MassSource": "MSSSRC1"}
            | dict.fromkeys(("Elements", "Masses", "Loads", "IsDefault"), True)
            | {"LoadPat": "LIVE", "Multiplier": 0.3}
        ],
        "AREA SECTION PROPERTIES": [_shell("SLAB", 0.15, one), _shell("WALL", 0.25, one)],
    }
    tables |= {name: [] for name in FILLED}
    nx, ny = bays[0] + 1, bays[1] + 1

    def joint(i: int, j: int, k: int) -> int:
        return 1 + i + nx * (j + ny * k)

    for k in range(storeys + 1):
        for j in range(ny):
            for i in range(nx):
                place = {"XorR": i * width[0] / one, "Y": j * width[1] / one, "Z": k * height / one}
                row = {"Joint": joint(i, j, k), "CoordSys": "GLOBAL", "CoordType": "Cartesian"}
                tables["JOINT COORDINATES"].append(row | place)
                if k == 0:
                    held = dict.fromkeys(("U1", "U2", "U3", "R1", "R2", "R3"), True)
                    tables["JOINT RESTRAINT ASSIGNMENTS"].append({"Joint": joint(i, j, 0)} | held)
                else:
                    tie = {"Joint": joint(i, j, k), "Constraint": f"D{k}", "Type": "Diaphragm"}
                    tables["JOINT CONSTRAINT ASSIGNMENTS"].append(tie)
                    below, name = joint(i, j, k - 1), f"C{joint(i, j, k)}"
                    _frame(tables, name, below, joint(i, j, k), "COL")
    for k in range(1, storeys + 1):
        diaphragm = {"Name": f"D{k}", "CoordSys": "GLOBAL", "Axis": "Z", "MultiLevel": False}
        tables["CONSTRAINT DEFINITIONS - DIAPHRAGM"].append(diaphragm)
        for j in range(ny):
            for i in range(bays[0]):
                if not (walls and j in {0, bays[1]} and i == 0):
                    _frame(tables, f"X{joint(i, j, k)}", joint(i, j, k), joint(i + 1, j, k), "BEAM")
                else:
                    ends = [joint(i, j, k - 1), joint(i + 1, j, k - 1)]
                    corners = [*ends, joint(i + 1, j, k), joint(i, j, k)]
                    _area(tables, f"W{joint(i, j, k)}", corners, "WALL")
        for j in range(bays[1]):
            for i in range(nx):
                _frame(tables, f"Y{joint(i, j, k)}", joint(i, j, k), joint(i, j + 1, k), "BEAM")
        for j in range(bays[1] if slabs else 0):
            for i in range(bays[0]):
                corners = [joint(i, j, k), joint(i + 1, j, k)]
                corners += [joint(i + 1, j + 1, k), joint(i, j + 1, k)]
                name = f"S{joint(i, j, k)}"
                _area(tables, name, corners, "SLAB")
                load = {"Area": name, "LoadPat": "LIVE", "CoordSys": "GLOBAL", "Dir": "Gravity"}
                tables["AREA LOADS - UNIFORM"].append(load | {"UnifLoad": 3e3 / floor})
    if details:
        _add_details(tables, force, one, joint(0, 0, storeys))
    return {name: rows for name, rows in tables.items() if rows}


def _add_details(tables: Rows, force: float, one: float, top: int) -> None:
    frames = [str(row["Frame"]) for row in tables["CONNECTIVITY - FRAME"]]
    columns = [name for name in frames if name.startswith("C")]
    along = [name for name in frames if name.startswith("X")]
    across = [name for name in frames if name.startswith("Y")]
    tables["FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL"] = [
        {"Frame": name, "Angle": 90 if k % 2 else 30} for k, name in enumerate(columns)
    ]
    words = ("PI", "V2I", "V3I", "TI", "M2I", "M3I", "PJ", "V2J", "V3J", "TJ", "M2J", "M3J")
    tables["FRAME RELEASE ASSIGNMENTS 1 - GENERAL"] = [
        {"Frame": across[0]} | {word: word in {"M3I", "M2I", "M3J"} for word in words}
    ]
    stiff = {"LengthI": 0.25 / one, "LengthJ": 0.2 / one, "RigidFactor": 0.5}
    tables["FRAME OFFSET ALONG LENGTH ASSIGNMENTS"] = [
        {"Frame": name, "Type": "User"} | stiff for name in along
    ]
    shift = {
        "JtOffsetXI": 0.05 / one,
        "JtOffsetXJ": 0.05 / one,
        "Mirror2": False,
        "Transform": True,
    }
    place = {"CardinalPt": "8 (top center)", "CoordSys": "GLOBAL"}
    tables["FRAME INSERTION POINT ASSIGNMENTS"] = [{"Frame": across[-1]} | place | shift]
    tables["FRAME PROPERTY MODIFIERS"] = [
        {"Frame": columns[0], "AMod": 1, "JMod": 0.4, "I22Mod": 0.7, "I33Mod": 0.8, "MassMod": 0.9}
    ]
    tables["FRAME LOADS - DISTRIBUTED"] = [
        _line(across[1], "Gravity", (0.2, 0.7), (4e3, 9e3), force / one),
        _line(along[0], "Z", (0.0, 1.0), (-5e3, -5e3), force / one),
        _line(columns[2], "2", (0.0, 1.0), (700.0, 700.0), force / one),
    ]
    dead = {"LoadPat": "DEAD", "CoordSys": "GLOBAL"}
    where = {"Type": "Force", "Dir": "Gravity", "DistType": "AbsDist", "AbsDist": 2.0 / one}
    tables["FRAME LOADS - POINT"] = [{"Frame": along[-1]} | dead | where | {"Force": 30e3 / force}]
    tables["JOINT LOADS - FORCE"] = [
        {"Joint": top} | dead | {"F1": 8e3 / force, "F3": -2e4 / force}
    ]
    masses = {f"Mass{k}": 3000.0 / (force / one) for k in (1, 2, 3)}
    tables["JOINT ADDED MASS ASSIGNMENTS"] = [{"Joint": top} | masses]


def _shell(name: str, thickness: float, one: float) -> dict[str, object]:
    kind = {"Material": "C30", "AreaType": "Shell", "Type": "Shell-Thin"}
    size = thickness / one
    return {"Section": name} | kind | {"Thickness": size, "BendThick": size}


def _frame(tables: Rows, name: str, i: int, j: int, section: str) -> None:
    tables["CONNECTIVITY - FRAME"].append({"Frame": name, "JointI": i, "JointJ": j})
    row = {"Frame": name, "AutoSelect": "N.A.", "AnalSect": section, "MatProp": "Default"}
    tables["FRAME SECTION ASSIGNMENTS"].append(row)


def _area(tables: Rows, name: str, corners: list[int], section: str) -> None:
    row: dict[str, object] = {"Area": name, "NumJoints": len(corners)}
    row |= {f"Joint{k}": corner for k, corner in enumerate(corners, start=1)}
    tables["CONNECTIVITY - AREA"].append(row)
    tables["AREA SECTION ASSIGNMENTS"].append({"Area": name, "Section": section})


def _line(
    frame: str, way: str, at: tuple[float, float], size: tuple[float, float], unit: float
) -> dict[str, object]:
    system = "Local" if way == "2" else "GLOBAL"
    row: dict[str, object] = {"Frame": frame, "LoadPat": "DEAD", "CoordSys": system}
    row |= {"Type": "Force", "Dir": way, "DistType": "RelDist"}
    row |= {"RelDistA": at[0], "RelDistB": at[1]}
    return row | {"FOverLA": size[0] / unit, "FOverLB": size[1] / unit}
