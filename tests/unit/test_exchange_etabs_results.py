"""A table of four columns against the results of ETABS 19.1 itself.

Model and results: hekatan-struct-lineal on GitHub (MIT licence), mesa_torsion.e2k with the forces
and periods beside it; here are the lines of that file that the linear model needs. Tonf and metres.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose

from frames import Frame
from lir_element.opensees import opensees
from tests.fixed_base import periods, reactions

TONF = 9806.65
CORNERS = {"1": "0 6", "2": "0 0", "3": "6 0", "4": "6 6"}
BEAMS = {"B1": ("2", "3"), "B2": ("2", "1"), "B3": ("3", "4"), "B4": ("1", "4")}
COLUMNS = {"C1": "2", "C2": "1", "C3": "4", "C4": "3"}
HEAD = """$ PROGRAM INFORMATION
  PROGRAM  "ETABS"  VERSION "19.1.0"
$ CONTROLS
  UNITS  "TONF"  "M"  "C"
$ STORIES - IN SEQUENCE FROM TOP
  STORY "Story1"  HEIGHT 4 MASTERSTORY "Yes"
  STORY "Base"  ELEV 0
$ MATERIAL PROPERTIES
  MATERIAL  "4000Psi"    TYPE "Concrete"    WEIGHTPERVOLUME 2.40277
  MATERIAL  "4000Psi"    SYMTYPE "Isotropic"  E 2534564  U 0.2  A 9.89999989542412E-06
$ FRAME SECTIONS
  FRAMESECTION  "W14X500"  MATERIAL "A992Fy50"  SHAPE "W14X500"  FILE "AISC14"
  FRAMESECTION  "C40x40"  MATERIAL "4000Psi"  SHAPE "Concrete Rectangular"  D 0.4 B 0.4
  FRAMESECTION  "V30x50"  MATERIAL "4000Psi"  SHAPE "Concrete Rectangular"  D 0.5 B 0.3
$ SLAB PROPERTIES
  SHELLPROP  "Slab1"  PROPTYPE  "Slab"  MATERIAL "4000Psi"
  SHELLPROP  "Slab1"  MODELINGTYPE "ShellThin"  SLABTHICKNESS 0.1
$ LINK PROPERTIES
  LINKPROP  "Link1"  TYPE "LINEAR"
  LINKPROP  "Link1"  DOF "U1"
  LINKPROP  "Link1"  U1STIFF 0.1019716
"""
TAIL = """$ LOAD PATTERNS
  LOADPATTERN "Dead"  TYPE  "Dead"  SELFWEIGHT  1
  LOADPATTERN "Live"  TYPE  "Live"  SELFWEIGHT  0
  LOADPATTERN "SCP"  TYPE  "Super Dead"  SELFWEIGHT  0
$ SHELL UNIFORM LOAD SETS
  SHELLUNIFORMLOADSET "ULoadSet1"  LOADPAT "SCP"  VALUE 1
  SHELLUNIFORMLOADSET "ULoadSet1"  LOADPAT "Live"  VALUE 0.5
$ SHELL OBJECT LOADS
  AREALOAD  "F1"  "Story1"  TYPE "UNIFLOADSET"  "ULoadSet1"
$ MASS SOURCE
  MASSSOURCE  "MsSrc1"    INCLUDEELEMENTS "Yes"    INCLUDELOADS "No"    ISDEFAULT "Yes"
  END
$ END OF MODEL FILE
"""


def read(tmp_path: Path, **options: object) -> Frame:
    lines = ["$ POINT COORDINATES", *(f'  POINT "{k}"  {xy}' for k, xy in CORNERS.items())]
    lines.append("$ LINE CONNECTIVITIES")
    lines += [f'  LINE  "{k}"  COLUMN  "{p}"  "{p}"  1' for k, p in COLUMNS.items()]
    lines += [f'  LINE  "{k}"  BEAM  "{i}"  "{j}"  0' for k, (i, j) in BEAMS.items()]
    lines += ["$ AREA CONNECTIVITIES", '  AREA "F1"  FLOOR  4  "2"  "3"  "4"  "1"  0  0  0  0']
    lines.append("$ POINT ASSIGNS")
    lines += [f'  POINTASSIGN  "{k}"  "Base"  RESTRAINT "UX UY UZ"' for k in CORNERS]
    lines.append("$ LINE ASSIGNS")
    lines += [f'  LINEASSIGN  "{k}"  "Story1"  SECTION "C40x40"  MINNUMSTA 3' for k in COLUMNS]
    beam = 'SECTION "V30x50"  CARDINALPT 8  MAXSTASPC 0.5 AUTOMESH "YES"  FLOORMESH "Yes"'
    lines += [f'  LINEASSIGN  "{k}"  "Story1"  {beam}' for k in BEAMS]
    lines += [
        "$ AREA ASSIGNS",
        '  AREAASSIGN  "F1"  "Story1"  SECTION "Slab1"  CARDINALPOINT "TOP"',
    ]
    path = tmp_path / "table.e2k"
    path.write_text("\n".join([HEAD, *lines, TAIL]), encoding="utf-8")
    opensees().wipe()
    return Frame.from_etabs(path, mesh=1.25, **options)  # type: ignore[arg-type]


def test_reactions_are_those_of_etabs(tmp_path: Path) -> None:
    # P and V2 = V3 at the foot of a column [tonf]; the thrust within 0.1 %
    for pattern, axial, thrust in (("Live", 4.5, 0.608495), ("SCP", 9.0, 1.216991)):
        found = reactions(read(tmp_path, loads={pattern: 1.0}))
        for corner, (x, y) in {"2": (1, 1), "3": (-1, 1), "4": (-1, -1), "1": (1, -1)}.items():
            force = found[f"{corner}-Base"] / TONF
            assert_allclose(force[2], axial, rtol=1e-9)
            assert_allclose(force[:2], (x * thrust, y * thrust), rtol=1e-3)


def test_own_weight_counts_what_etabs_takes_off_within_columns(tmp_path: Path) -> None:
    force = reactions(read(tmp_path, loads={"Dead": 1.0}))["2-Base"] / TONF
    within = 0.3 * 0.5 * 0.4 * 2.40277  # of a beam, 0.2 m at each end
    assert_allclose(force[2], 5.7185926 + within, rtol=1e-6)
    assert_allclose(force[0], 0.4487168, rtol=2e-3)


def test_sway_period_is_that_of_etabs(tmp_path: Path) -> None:
    frame = read(tmp_path)
    top = sum(m[0] for node, m in frame.masses.items() if node.endswith("Story1") or "~" in node)
    within = 4 * 0.3 * 0.5 * 0.4 * 2.40277 * 1e3  # kg, which ETABS takes off
    found = periods(frame, 3)
    assert_allclose(found[:2], 0.343367, rtol=0.012)
    assert_allclose(found[:2] * np.sqrt(1.0 - within / top), 0.343367, rtol=4e-3)
