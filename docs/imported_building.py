"""Writes the ETABS text of the building of imported_building.md.

python docs/imported_building.py model.e2k: five storeys of concrete, 18 x 12 m in plan, a wall of
shells along each side, on a grid of base beams over twelve supports. Units are kN and m; the lines
are those that ETABS writes.
"""

from __future__ import annotations

import sys
from pathlib import Path

STOREYS, HEIGHT = 5, 3.3
X, Y = (0.0, 6.0, 12.0, 18.0), (0.0, 6.0, 12.0)
WALLS = (((1, 0), (2, 0)), ((1, 2), (2, 2)), ((0, 0), (0, 1)), ((3, 1), (3, 2)))
"""Walls by the places of their ends in the grid."""
SIZES = {"C50": (0.5, 0.5), "B60": (0.6, 0.3), "B90": (0.9, 0.4)}
"""Depth and width of sections [m]."""
PRESSURES = {"SDL": 2.0, "Live": 3.0}
"""Loads on all slabs [kN/m2]."""


def model() -> str:
    """Return the text of the file."""
    names = [f"Story{k}" for k in range(1, STOREYS + 1)]
    grid = {(i, j): str(1 + i + len(X) * j) for j in range(len(Y)) for i in range(len(X))}
    pairs = [
        (here, there)
        for here in grid
        for there in ((here[0] + 1, here[1]), (here[0], here[1] + 1))
        if there in grid
    ]
    panels = [place for place in grid if (place[0] + 1, place[1] + 1) in grid]
    lines, beams = [], []
    for k, (here, there) in enumerate(pairs, start=1):
        lines.append(f'LINE  "B{k}"  BEAM  "{grid[here]}"  "{grid[there]}"  0')
        beams.append(f'LINEASSIGN  "B{k}"  "Base"  SECTION "B90"  AUTOMESH "YES"')
        beams += [f'LINEASSIGN  "B{k}"  "{s}"  SECTION "B60"  AUTOMESH "YES"' for s in names]
    columns = []
    for name in grid.values():
        lines.append(f'LINE  "C{name}"  COLUMN  "{name}"  "{name}"  1')
        columns += [f'LINEASSIGN  "C{name}"  "{s}"  SECTION "C50"  AUTOMESH "YES"' for s in names]
    areas, slabs, loads = [], [], []
    for k, (i, j) in enumerate(panels, start=1):
        ring = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
        corners = "  ".join(f'"{grid[place]}"' for place in ring)
        areas.append(f'AREA "F{k}"  FLOOR  4  {corners}  0  0  0  0')
        for s in ["Base", *names]:
            slabs.append(f'AREAASSIGN  "F{k}"  "{s}"  SECTION "SLAB"  DIAPH "D1"')
            head = f'AREALOAD  "F{k}"  "{s}"  TYPE "UNIFF"  DIR "GRAV"'
            loads += [f'{head}  LC "{lc}"  FVAL {q}' for lc, q in PRESSURES.items()]
    for k, (here, there) in enumerate(WALLS, start=1):
        one, two = grid[here], grid[there]
        areas.append(f'AREA "W{k}"  PANEL  4  "{one}"  "{two}"  "{two}"  "{one}"  1  1  0  0')
        slabs += [f'AREAASSIGN  "W{k}"  "{s}"  SECTION "WALL"' for s in names]
    material = 'MATERIAL  "C30"'
    shell = 'PROPTYPE  "{}"  MATERIAL "C30"  MODELINGTYPE "ShellThin"  {} {}'
    sections = {
        "PROGRAM INFORMATION": ['PROGRAM  "ETABS"  VERSION "21.0.0"'],
        "CONTROLS": ['UNITS  "KN"  "M"  "C"'],
        "STORIES - IN SEQUENCE FROM TOP": [
            *(f'STORY "{name}"  HEIGHT {HEIGHT}' for name in reversed(names)),
            'STORY "Base"  ELEV 0',
        ],
        "DIAPHRAGM NAMES": ['DIAPHRAGM "D1"    TYPE RIGID'],
        "MATERIAL PROPERTIES": [
            f'{material}    TYPE "Concrete"    WEIGHTPERVOLUME 25',
            f'{material}    SYMTYPE "Isotropic"  E 30000000  U 0.2',
        ],
        "FRAME SECTIONS": [
            f'FRAMESECTION  "{k}"  MATERIAL "C30"  SHAPE "Concrete Rectangular"  D {d} B {b}'
            for k, (d, b) in SIZES.items()
        ],
        "SLAB PROPERTIES": [f'SHELLPROP  "SLAB"  {shell.format("Slab", "SLABTHICKNESS", 0.18)}'],
        "WALL PROPERTIES": [f'SHELLPROP  "WALL"  {shell.format("Wall", "WALLTHICKNESS", 0.25)}'],
        "POINT COORDINATES": [f'POINT "{n}"  {X[i]} {Y[j]}' for (i, j), n in grid.items()],
        "LINE CONNECTIVITIES": lines,
        "AREA CONNECTIVITIES": areas,
        "POINT ASSIGNS": [
            f'POINTASSIGN  "{name}"  "Base"  RESTRAINT "UX UY UZ"' for name in grid.values()
        ],
        "LINE ASSIGNS": [*beams, *columns],
        "AREA ASSIGNS": slabs,
        "LOAD PATTERNS": [
            'LOADPATTERN "Dead"  TYPE  "Dead"  SELFWEIGHT  1',
            'LOADPATTERN "SDL"  TYPE  "Super Dead"  SELFWEIGHT  0',
            'LOADPATTERN "Live"  TYPE  "Live"  SELFWEIGHT  0',
        ],
        "SHELL OBJECT LOADS": loads,
        "MASS SOURCE": [
            'MASSSOURCE  "MsSrc1"  INCLUDEELEMENTS "Yes"  INCLUDEADDEDMASS "Yes"'
            '  INCLUDELOADS "Yes"  LUMPATSTORIES "No"  ISDEFAULT "Yes"',
            'MASSSOURCELOAD  "MsSrc1"  "SDL"  1',
        ],
    }
    out = []
    for section, rows in sections.items():
        out += [f"$ {section}", *(f"  {row}" for row in rows), ""]
    return "\n".join([*out, "  END", "$ END OF MODEL FILE", ""])


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(model(), encoding="utf-8")
