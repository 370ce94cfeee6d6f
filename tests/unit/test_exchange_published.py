"""Results that CSI publishes of SAP2000, of models written after its verification manual.

Source: SAP2000 Software Verification, Computers and Structures, Inc.: Examples 1-004 (turned local
axes) and 1-022 (a plane frame of seven storeys), in kip and inches.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.sparse.linalg import spsolve

from frames import Frame
from frames.assembly.assemble import assemble
from frames.model.axes import to_local
from tests import sap2000_models as models

INCH, KIP = 0.0254, 4448.2216152605


def read(tmp_path: Path, tables: models.Rows, pattern: str) -> tuple[Frame, np.ndarray]:
    path = tmp_path / "model.s2k"
    path.write_text(models.text(tables), encoding="utf-8")
    frame = Frame.from_sap2000(path, loads={pattern: 1.0})
    system = assemble(frame)
    moved = system.transform @ spsolve(system.stiffness.tocsc(), system.load)
    return frame, np.asarray(moved).reshape(-1, 6)


def steel(modulus: float) -> models.Rows:
    return {
        "PROGRAM CONTROL": [{"ProgramName": "SAP2000", "CurrUnits": "Kip, in, F"}],
        "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES": [
            {"Material": "STEEL", "UnitWeight": 0, "UnitMass": 7.3e-7, "E1": modulus, "U12": 0.3}
        ],
        "MASS SOURCE": [{"MassSource": "M", "Elements": True, "Masses": True, "Loads": False}],
    }


def joint(name: int, x: float, z: float) -> dict[str, object]:
    place = {"XorR": x, "Y": 0.0, "Z": z}
    return {"Joint": name, "CoordSys": "GLOBAL", "CoordType": "Cartesian"} | place


def held(name: int, *words: str) -> dict[str, object]:
    return {"Joint": name} | {w: w in words for w in ("U1", "U2", "U3", "R1", "R2", "R3")}


@pytest.mark.parametrize(
    ("pattern", "published"),
    [("LC1", (-0.01806, -0.03029)), ("LC2", (-0.03345, -0.0561)), ("LC3", (-0.08361, -0.14024))],
)
def test_a_cantilever_whose_axis_2_is_turned(tmp_path, pattern, published):
    section = {"SectionName": "W12X106", "Material": "STEEL", "Shape": "I/Wide Flange"}
    section |= {"t3": 12.9, "t2": 12.2, "Area": 31.2, "TorsConst": 9.13, "I33": 933, "I22": 301}
    along = {"Frame": 1, "LoadPat": "LC1", "Type": "Force", "Dir": "Gravity"}
    along |= {"DistType": "RelDist", "RelDistA": 0, "RelDistB": 1, "FOverLA": 0.01, "FOverLB": 0.01}
    tables = steel(29000.0) | {
        "FRAME SECTION PROPERTIES 01 - GENERAL": [section],
        "JOINT COORDINATES": [joint(1, 0.0, 0.0), joint(2, 144.0, 0.0)],
        "CONNECTIVITY - FRAME": [{"Frame": 1, "JointI": 1, "JointJ": 2}],
        "FRAME SECTION ASSIGNMENTS": [{"Frame": 1, "AnalSect": "W12X106", "MatProp": "Default"}],
        "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL": [{"Frame": 1, "Angle": 30}],
        "JOINT RESTRAINT ASSIGNMENTS": [held(1, "U1", "U2", "U3", "R1", "R2", "R3")],
        "LOAD PATTERN DEFINITIONS": [
            {"LoadPat": name, "DesignType": "OTHER", "SelfWtMult": 0}
            for name in ("LC1", "LC2", "LC3")
        ],
        "FRAME LOADS - DISTRIBUTED": [along],
        "JOINT LOADS - FORCE": [
            {"Joint": 2, "LoadPat": "LC2", "F3": -1},
            {"Joint": 2, "LoadPat": "LC3", "M2": 240},
        ],
    }
    _, moved = read(tmp_path, tables, pattern)
    assert_allclose(moved[1, 1:3] / INCH, published, atol=6e-6)


def test_a_frame_of_seven_storeys(tmp_path: Path) -> None:
    shapes = {
        "W14X176": (51.7, 2150),
        "W14X211": (62.1, 2670),
        "W14X246": (72.3, 3230),
        "W14X287": (84.4, 3910),
        "W24X110": (32.5, 3330),
        "W24X130": (38.3, 4020),
        "W24X160": (47.1, 5120),
    }
    sides = ["W14X246"] * 3 + ["W14X211"] * 2 + ["W14X176"] * 2
    middle = ["W14X287"] * 3 + ["W14X246"] * 2 + ["W14X211"] * 2
    beams = ["W24X160"] * 2 + ["W24X130"] * 2 + ["W24X110"] * 3
    heights = [0, 162, 324, 480, 636, 792, 948, 1104]
    members = [
        (3 * k + c + 1, 3 * (k + 1) + c + 1, column[k])
        for c, column in enumerate((sides, middle, sides))
        for k in range(7)
    ]
    members += [(3 * k + v + 1, 3 * k + v + 2, beams[k - 1]) for v in (0, 1) for k in range(1, 8)]
    joints = [
        joint(3 * k + c + 1, 360.0 * c, float(z)) for k, z in enumerate(heights) for c in range(3)
    ]
    plane = [held(name, "U2", "R1", "R3") for name in range(4, 25)]
    foot = [held(name, "U1", "U2", "U3", "R1", "R2", "R3") for name in (1, 2, 3)]
    tables = steel(29500.0) | {
        "FRAME SECTION PROPERTIES 01 - GENERAL": [
            {"SectionName": name, "Material": "STEEL", "Shape": "General", "Area": area}
            | {"I33": inertia, "I22": inertia / 3, "TorsConst": 10}
            for name, (area, inertia) in shapes.items()
        ],
        "JOINT COORDINATES": joints,
        "CONNECTIVITY - FRAME": [
            {"Frame": k + 1, "JointI": i, "JointJ": j} for k, (i, j, _) in enumerate(members)
        ],
        "FRAME SECTION ASSIGNMENTS": [
            {"Frame": k + 1, "AnalSect": name} for k, (_, _, name) in enumerate(members)
        ],
        "JOINT RESTRAINT ASSIGNMENTS": foot + plane,
        "CONSTRAINT DEFINITIONS - DIAPHRAGM": [{"Name": f"D{k}", "Axis": "Z"} for k in range(1, 8)],
        "JOINT CONSTRAINT ASSIGNMENTS": [
            {"Joint": 3 * k + c + 1, "Constraint": f"D{k}", "Type": "Diaphragm"}
            for k in range(1, 8)
            for c in range(3)
        ],
        "LOAD PATTERN DEFINITIONS": [{"LoadPat": "LAT", "DesignType": "Other", "SelfWtMult": 0}],
        "JOINT LOADS - FORCE": [
            {"Joint": 3 * (k + 1) + 1, "LoadPat": "LAT", "F1": force}
            for k, force in enumerate((2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 20.0))
        ],
    }
    frame, moved = read(tmp_path, tables, "LAT")
    system = assemble(frame)
    place = system.node_names.index("22")
    assert_allclose(moved[place, 0] / INCH, 1.45076, atol=6e-6)
    table = system.members
    local = to_local(moved.reshape(-1)[table.dofs], table.arrays.axes)
    ends = np.einsum("nij,nj->ni", table.stiffness, local)[table.names.index("1")]
    # of the section at end i: P = -N, M3 = My of the force on the end
    assert_allclose(-ends[0] / KIP, 69.99, atol=6e-3)
    assert_allclose(ends[4] / (KIP * INCH), 2324.68, atol=6e-3)
