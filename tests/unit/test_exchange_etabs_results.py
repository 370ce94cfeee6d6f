"""A table of four columns and a filled tube against the results of ETABS 19.1 itself.

Models and results: hekatan-struct-lineal on GitHub (MIT licence), mesa_torsion.e2k with the forces
and periods beside it, and "Columna CFT Cantilivier.e2k" with etabs_cantilever_results.json; here
are the lines of those files that the linear model needs. Tonf and metres.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError, ModelWarning
from frames.assembly.assemble import assemble
from lir_element.opensees import opensees
from tests.fixed_base import periods, reactions
from tests.refusals import refused

TONF = 9806.65
CORNERS = {"1": "0 6", "2": "0 0", "3": "6 0", "4": "6 6"}
BEAMS = {"B1": ("2", "3"), "B2": ("2", "1"), "B3": ("3", "4"), "B4": ("1", "4")}
COLUMNS = {"C1": "2", "C2": "1", "C3": "4", "C4": "3"}
BEGINNING = """$ PROGRAM INFORMATION
  PROGRAM  "ETABS"  VERSION "19.1.0"
$ CONTROLS
  UNITS  "TONF"  "M"  "C"
$ STORIES - IN SEQUENCE FROM TOP
  STORY "Story1"  HEIGHT {} MASTERSTORY "Yes"
  STORY "Base"  ELEV 0
$ MATERIAL PROPERTIES
  MATERIAL  "4000Psi"    TYPE "Concrete"    WEIGHTPERVOLUME 2.40277
  MATERIAL  "4000Psi"    SYMTYPE "Isotropic"  E 2534564  U 0.2  A 9.89999989542412E-06
"""
HEAD = f"""{BEGINNING.format(4)}$ FRAME SECTIONS
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


PERIODS = [0.343367, 0.343367, 0.287556, 0.00923334, 0.00847178, 0.00847178]
PERIODS += [0.00842291, 0.00689769, 0.00516804, 0.00516804, 0.00427224, 0.0036782]


def test_periods_are_those_of_etabs_with_the_mass_of_beams_at_their_ends(tmp_path: Path) -> None:
    # ETABS has the mass of a beam at the joints of its line, here it is at the nodes of the mesh
    with pytest.warns(ModelWarning, match=r"60.6 % of the permanent loads have no mass"):
        frame = read(tmp_path)
    found = periods(frame, 3)
    assert_allclose(found[:2], PERIODS[:2], rtol=0.012)
    assert_allclose(found[2] / PERIODS[2], 1.0 - 0.083, atol=1e-3)
    top = [node for node in frame.masses if frame.nodes[node].z > 3.9]
    beam = 0.3 * 0.5 * 2.40277e3  # kg/m
    mass = {node: frame.masses[node][0] for node in top}
    for node in top:
        x, y, _ = frame.nodes[node].position
        along = sum(v in {0.0, 6.0} for v in (x, y))
        mass[node] -= along * beam * (0.6 if along == 2 else 1.2)  # of parts of 1.2 m
        if along == 2:
            mass[node] += 2 * 0.5 * beam * (6.0 - 0.4)  # between the faces of columns
    system = assemble(frame)
    labels = [str(label).rsplit(" ", 1) for label in system.dof_labels]
    plan = np.array([mass.get(node, 0.0) if dof in {"ux", "uy"} else 0.0 for node, dof in labels])
    heavy = plan > 0.0
    flexible = np.linalg.inv(system.stiffness.toarray())[heavy][:, heavy]
    root = np.sqrt(plan[heavy])
    squares = np.linalg.eigvalsh(root[:, None] * flexible * root)[::-1]
    found = 2 * np.pi * np.sqrt(squares[:12])
    assert_allclose(found[:4], PERIODS[:4], rtol=4e-3)  # sway twice, torsion, the slab in its plane
    assert_allclose(found, PERIODS, rtol=0.017)


TUBE = f"""{BEGINNING.format(3)}  MATERIAL  "A572Gr50"    TYPE "Steel"    WEIGHTPERVOLUME 7.849048
  MATERIAL  "A572Gr50"    SYMTYPE "Isotropic"  E 2.038902E+07  U 0.3  A 1.16999999590917E-05
$ FRAME SECTIONS
  FRAMESECTION  "CFT"  MATERIAL "A572Gr50"  SHAPE "Filled Steel Tube"  D 0.3 B 0.3 TF 0.012 TW 0.012 FILLMATERIAL "4000Psi"
$ POINT COORDINATES
  POINT "1"  0 0
$ LINE CONNECTIVITIES
  LINE  "C1"  COLUMN  "1"  "1"  1
$ POINT ASSIGNS
  POINTASSIGN  "1"  "Base"  RESTRAINT "UX UY UZ RX RY RZ"
$ LINE ASSIGNS
  LINEASSIGN  "C1"  "Story1"  SECTION "CFT"  RIGIDZONE 0.5 MINNUMSTA 2 AUTOMESH "YES"
$ LOAD PATTERNS
  LOADPATTERN "DEAD"  TYPE  "Dead"  SELFWEIGHT  1
$ MASS SOURCE
  MASSSOURCE  "MsSrc1"    INCLUDEELEMENTS "Yes"    INCLUDELOADS "No"    ISDEFAULT "Yes"
$ END OF MODEL FILE
"""  # noqa: E501


def test_a_filled_tube_is_that_of_etabs(tmp_path: Path) -> None:
    path = tmp_path / "tube.e2k"
    path.write_text(TUBE, encoding="utf-8")
    frame = Frame.from_etabs(path)
    section = frame.members["C1-Story1"].section
    assert_allclose(section.area, 0.023293456955949816, rtol=1e-9)
    assert_allclose(section.inertia_y, 0.00025154686475636955, rtol=1e-9)
    assert_allclose(section.inertia_z, section.inertia_y)
    # ETABS' are larger: those of wall and core as one
    assert_allclose(section.shear_area_z, 0.016343240629987318, rtol=0.055)
    assert_allclose(section.torsion_constant, 417845187e-12, rtol=0.055)
    assert_allclose(reactions(frame)["1-Base"][2], 8577.052594504929, rtol=1e-6)
    system = assemble(frame)
    down = np.linalg.solve(system.stiffness.toarray(), system.load)
    assert_allclose(down[[str(d) for d in system.dof_labels].index("1-Story1 uz")], -2.762348e-6)
    assert_allclose(frame.masses["1-Story1"][0], 0.5 * 8577.05 / 9.80665, rtol=1e-5)
    assert "with the weight of both materials: CFT" in str(frame.imported)


def test_filled_sections_that_cannot_be_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "tube.e2k"
    for old, new, message in (
        ('FILLMATERIAL "4000Psi"', 'FILLMATERIAL "C99"', r'FILLMATERIAL "C99" of section "CFT" is'),
        ("TF 0.012", "TF 0.02", r"TF = 0.02 m and TW = 0.012 m differ.*sections="),
        ("TF 0.012 TW 0.012", "TF 0.16 TW 0.16", r'section "CFT": Section\.(box|rectangle)'),
        ("WEIGHTPERVOLUME 7.849048", "WEIGHTPERVOLUME 0", r'its steel "A572Gr50" has no'),
    ):
        assert old in TUBE
        path.write_text(TUBE.replace(old, new), encoding="utf-8")
        refused(ModelError, message, Frame.from_etabs, path)


def test_a_filled_pipe_counts_its_core_by_moduli(tmp_path: Path) -> None:
    path = tmp_path / "pipe.e2k"
    old = 'SHAPE "Filled Steel Tube"  D 0.3 B 0.3 TF 0.012'
    path.write_text(TUBE.replace(old, 'SHAPE "Filled Steel Pipe"  D 0.3'), encoding="utf-8")
    section = Frame.from_etabs(path).members["C1-Story1"].section
    n = 2534564 / 2.038902e7
    wall, core = np.pi / 4 * (0.3**2 - 0.276**2), np.pi / 4 * 0.276**2
    assert_allclose(section.area, wall + n * core)
    assert_allclose(section.inertia_y, np.pi / 64 * (0.3**4 - (1.0 - n) * 0.276**4))
    turned = np.pi / 32 * (0.3**4 - (1.0 - n * 1.3 / 1.2) * 0.276**4)
    assert_allclose(section.torsion_constant, turned)
