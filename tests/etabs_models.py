"""The building of `sap2000_models` as an ETABS text file; sources: docs/exchange.md."""

from __future__ import annotations

UNITS = {"KN": 1e3, "KIP": 4448.2216152605, "N": 1.0, "M": 1.0, "IN": 0.0254, "MM": 1e-3}


def building(
    units: tuple[str, str] = ("KN", "M"),
    *,
    storeys: int = 2,
    bays: tuple[int, int] = (2, 1),
    width: tuple[float, float] = (6.0, 5.0),
    height: float = 3.0,
    walls: bool = False,
    end: str = "$ END OF MODEL FILE",
) -> str:
    """Return the text; walls stand along the sides in x, in the first bay."""
    force, one = UNITS[units[0]], UNITS[units[1]]
    stress, weight, surface = force / one**2, force / one**3, force / one**2
    names = ["Base", *(f"Story{k}" for k in range(1, storeys + 1))]
    out = [
        '$ File "model.e2k" saved 1/2/2025 9:00:00',
        "",
        "$ PROGRAM INFORMATION",
        '  PROGRAM  "ETABS"  VERSION "21.0.0"',
        "",
        "$ CONTROLS",
        f'  UNITS  "{units[0]}"  "{units[1]}"  "C"  ',
        '  TITLE1  "a building"  ',
        "  PREFERENCE  MERGETOL 0.001",
        "",
        "$ STORIES - IN SEQUENCE FROM TOP",
    ]
    out += [f'  STORY "{name}"  HEIGHT {height / one!r} ' for name in names[:0:-1]]
    out += [
        '  STORY "Base"  ELEV 0 ',
        "",
        "$ DIAPHRAGM NAMES",
        '  DIAPHRAGM "D1"    TYPE RIGID',
        "",
    ]
    out += [
        "$ MATERIAL PROPERTIES",
        f'  MATERIAL  "C30"    TYPE "Concrete"    WEIGHTPERVOLUME {25e3 / weight!r}'
        f"  MASSPERVOLUME {2500.0 / (force / one**4)!r}",
        f'  MATERIAL  "C30"    SYMTYPE "Isotropic"  E {30e9 / stress!r}  U 0.2  A 9.9E-06',
        f'  MATERIAL  "C30"    FC {30e6 / stress!r}',
        "",
        "$ FRAME SECTIONS",
    ]
    for name, depth, wide in (("COL", 0.5, 0.4), ("BEAM", 0.6, 0.3)):
        constants = rectangle(depth, wide, one)
        head = f'  FRAMESECTION  "{name}"  MATERIAL "C30"  SHAPE "General"'
        out.append(f"{head}  D {depth / one!r}  B {wide / one!r} {constants}")
    out += ['  FRAMESECTION  "A-GravBm"  MATERIAL "A992Fy50"  SHAPE "Auto Select List"', ""]
    slab = f"SLABTHICKNESS {0.15 / one!r}"
    out += [
        "$ SLAB PROPERTIES",
        f'  SHELLPROP  "SLAB"  PROPTYPE  "Slab"  MATERIAL "C30"  MODELINGTYPE "ShellThin"  {slab}',
        "$ WALL PROPERTIES",
        '  SHELLPROP  "WALL"  PROPTYPE  "Wall"  MATERIAL "C30"  MODELINGTYPE "ShellThin"'
        f"  WALLTHICKNESS {0.25 / one!r}",
        "",
        "$ POINT COORDINATES",
    ]
    nx, ny = bays[0] + 1, bays[1] + 1
    plan = {(i, j): str(1 + i + nx * j) for j in range(ny) for i in range(nx)}
    for (i, j), name in plan.items():
        out.append(f'  POINT "{name}"  {i * width[0] / one!r} {j * width[1] / one!r} ')
    lines, line_assigns, areas, area_assigns, loads = [], [], [], [], []
    for name in plan.values():
        lines.append(f'  LINE  "C{name}"  COLUMN  "{name}"  "{name}"  1')
        line_assigns += [_line(f"C{name}", story, "COL") for story in names[1:]]
    for (i, j), name in plan.items():
        if i < bays[0]:
            other = plan[i + 1, j]
            if walls and j in {0, bays[1]} and i == 0:
                corners = f'4  "{name}"  "{other}"  "{other}"  "{name}"  1  1  0  0'
                areas.append(f'  AREA "W{name}"  PANEL  {corners}')
                area_assigns += [_area(f"W{name}", story, "WALL") for story in names[1:]]
            else:
                lines.append(f'  LINE  "X{name}"  BEAM  "{name}"  "{other}"  0')
                line_assigns += [_line(f"X{name}", story, "BEAM") for story in names[1:]]
        if j < bays[1]:
            lines.append(f'  LINE  "Y{name}"  BEAM  "{name}"  "{plan[i, j + 1]}"  0')
            line_assigns += [_line(f"Y{name}", story, "BEAM") for story in names[1:]]
        if i < bays[0] and j < bays[1]:
            ring = (name, plan[i + 1, j], plan[i + 1, j + 1], plan[i, j + 1])
            corners = "  ".join(f'"{point}"' for point in ring)
            areas.append(f'  AREA "F{name}"  FLOOR  4  {corners}  0  0  0  0')
            for story in names[1:]:
                area_assigns.append(_area(f"F{name}", story, "SLAB", 'DIAPH "D1"'))
                load = f'  AREALOAD  "F{name}"  "{story}"  TYPE "UNIFF"  DIR "GRAV"  LC "Live"'
                loads.append(f"{load}  FVAL {3e3 / surface!r}")
    out += ["", "$ LINE CONNECTIVITIES", *lines, "", "$ AREA CONNECTIVITIES", *areas]
    out += ["", "$ POINT ASSIGNS"]
    out += [
        f'  POINTASSIGN  "{name}"  "Base"  RESTRAINT "UX UY UZ RX RY RZ"' for name in plan.values()
    ]
    out += ["", "$ LINE ASSIGNS", *line_assigns, "", "$ AREA ASSIGNS", *area_assigns]
    out += [
        "",
        "$ LOAD PATTERNS",
        '  LOADPATTERN "Dead"  TYPE  "Dead"  SELFWEIGHT  1',
        '  LOADPATTERN "Live"  TYPE  "Live"  SELFWEIGHT  0',
        "",
        "$ SHELL OBJECT LOADS",
        *loads,
        "",
        "$ MASS SOURCE",
        '  MASSSOURCE  "MsSrc1"    INCLUDEELEMENTS "Yes"    INCLUDEADDEDMASS "Yes"'
        '    INCLUDELOADS "Yes"  LUMPATSTORIES "No"    ISDEFAULT "Yes"  ',
        '  MASSSOURCELOAD  "MsSrc1"  "Live"  0.3 ',
        "",
        "$ LOAD CASES",
        '  LOADCASE "Dead"  TYPE  "Linear Static"  INITCOND  "PRESET"  ',
        '  LOADCASE "Dead"  LOADPAT  "Dead"  SF  1 ',
        "",
        "$ LOAD COMBINATIONS",
        '  COMBO "G"  TYPE "Linear Add"  ',
        '  COMBO "G"  LOADCASE "Dead"  SF 1 ',
        '  COMBO "G"  LOADCASE "Live"  SF 0.7 ',
        "",
        end,
        "",
    ]
    return "\n".join(out)


def rectangle(depth: float, width: float, one: float) -> str:
    """Return the constants of `sap2000_models.rectangle`, without shear areas."""
    short, long = sorted((depth, width))
    torsion = long * short**3 / 3.0 * (1.0 - 0.63 * short / long)
    values = {
        "AREA": depth * width / one**2,
        "I33": width * depth**3 / 12.0 / one**4,
        "I22": depth * width**3 / 12.0 / one**4,
        "TORSION": torsion / one**4,
    }
    return "  ".join(f"{word} {value!r}" for word, value in values.items())


def _line(name: str, story: str, section: str) -> str:
    return f'  LINEASSIGN  "{name}"  "{story}"  SECTION "{section}"  MINNUMSTA 3 AUTOMESH "YES"'


def _area(name: str, story: str, section: str, more: str = "") -> str:
    return f'  AREAASSIGN  "{name}"  "{story}"  SECTION "{section}"  {more} OBJMESHTYPE "DEFAULT"'
