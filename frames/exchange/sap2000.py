"""Reads a SAP2000 model: its text tables (.s2k, .$2k) or the workbook with the same tables."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from frames.exchange.account import Account
from frames.exchange.building import Building
from frames.exchange.excel_tables import read_excel
from frames.exchange.s2k_text import read_s2k
from frames.exchange.sap2000_loads import read_loads
from frames.exchange.sap2000_objects import read_objects
from frames.exchange.sap2000_properties import read_properties
from frames.exchange.tables import ACTIVE, Decimal, Tables, require_space
from frames.exchange.units import FORCES, LENGTHS, Units, units_of

_BOOKS = {".xlsx", ".xlsm"}

REFUSED = (
    ("FRAME HINGE ASSIGN", "hinges", "plastic hinges of frames, which stay elastic"),
    ("CONNECTIVITY - CABLE", "cables", "cables"),
    ("CONNECTIVITY - TENDON", "tendons", "tendons"),
    ("CONNECTIVITY - SOLID", "solids", "solids"),
    ("FRAME TENSION AND COMPRESSION LIMITS", "tension limits", "limits of axial force, without"),
    ("CASE - STATIC 5", "staged construction", "stages of construction, taken as built at once"),
    ("CASE - STATIC 6", "staged construction", "stages of construction, taken as built at once"),
    ("JOINT SPRING ASSIGNMENTS 2", "coupled springs", "coupled springs of joints"),
    ("FRAME SPRING ASSIGNMENTS", "line and area springs", "springs along frames"),
    ("AREA SPRING ASSIGNMENTS", "line and area springs", "springs under areas"),
    ("FRAME RELEASE ASSIGNMENTS 2", "partial fixity", "partial fixity, taken as full releases"),
    ("FRAME LOCAL AXES ASSIGNMENTS 2", "advanced axes", "advanced axes of frames"),
    ("AREA OVERWRITES", "area overwrites", "thickness and joint offsets of single areas"),
    ("AREA EDGE CONSTRAINT", "edge constraints", "constraints along edges of areas"),
    ("FRAME LOADS - TEMPERATURE", "imposed strains", "temperatures of frames"),
    ("FRAME LOADS - STRAIN", "imposed strains", "strains of frames"),
    ("FRAME LOADS - DEFORMATION", "imposed strains", "deformations of frames"),
    ("FRAME LOADS - TARGET", "imposed strains", "target forces of frames"),
    ("JOINT LOADS - GROUND DISPLACEMENT", "imposed strains", "displacements of supports"),
    ("AREA LOADS - TEMPERATURE", "imposed strains", "temperatures of areas"),
    ("AREA LOADS - STRAIN", "imposed strains", "strains of areas"),
    ("AREA LOADS - SURFACE PRESSURE", "surface pressures", "pressures on faces of areas"),
    ("AREA ADDED MASS", "added masses", "masses added to areas"),
    ("FRAME ADDED MASS", "added masses", "masses added to frames"),
    ("JOINT ADDED MASS BY", "added masses", "masses added to joints by weight or volume"),
)
"""Tables whose loss would change the answer: beginning of the name, key of `allow`, what it is."""

HARMLESS = (
    "AREA AUTO MESH",
    "AREA BRIDGE",
    "AREA LOCAL AXES",
    "AREA SECTION PROPERTY",
    "AREA VEHICLE",
    "FRAME BRIDGE",
    "FRAME DESIGN",
    "FRAME JOINT OFFSETS - BRIDGE",
    "FRAME LOAD TRANSFER",
    "FRAME LOADS - OPEN STRUCTURE",
    "FRAME OUTPUT STATION",
    "FRAME P-DELTA",
    "FRAME PROGRAM DETERMINED",
    "FRAME SECTION PROPERTIES",
    "FRAME VEHICLE",
    "JOINT BRIDGE",
    "JOINT MERGE",
    "JOINT PANEL ZONE",
    "JOINT PATTERN",
    "JOINT VEHICLE",
    "LINK BRIDGE",
    "LINK FREQUENCY",
    "LINK VEHICLE",
)
"""Tables of objects that the linear model does not need, by the beginning of the name."""

KNOWN = {
    "": "GUID Notes Color Joint Frame Area Link Name Material Section SectionName LoadPat "
    "Length CentroidX CentroidY CentroidZ",
    "AREA LOADS": "CoordSys=GLOBAL CoordSys=Local DistType=Twoway",
    "AREA SECTION PROPERTIES": "Arc CoordSys DrillDOF InComp MatAngle TotalMass TotalWt",
    "AREA SECTION ASSIGNMENTS": "MatProp=Default",
    "CASE - STATIC 1": "*",
    "COMBINATION DEFINITIONS": "*",
    "CONNECTIVITY - AREA": "AreaArea NumJoints Perimeter",
    "CONSTRAINT DEFINITIONS": "CoordSys=GLOBAL MultiLevel",
    "FRAME AUTO MESH": "AtFrames=No MaxDegrees MaxLength NumSegments",
    "FRAME INSERTION POINT": "CoordSys=GLOBAL Mirror2=No Mirror3=No",
    "FRAME LOADS": "AbsDist AbsDistA AbsDistB CoordSys=GLOBAL CoordSys=Local RelDist RelDistA "
    "RelDistB",
    "FRAME LOCAL AXES": "Angle",
    "FRAME OFFSET": "OffsetType Type",
    "FRAME SECTION ASSIGNMENTS": "AutoSelect DesignSect SectionType",
    "FRAME SECTION PROPERTIES": "ConcBeam ConcCol CGOffset2 CGOffset3 EccV2 EccV3 FileName "
    "FilletRadius FromFile I23 PNAOffset2 PNAOffset3 R22 R33 S22 S22Left S22Neg S22Pos S22Right "
    "S33 S33Bot S33Neg S33Pos S33Top SectInFile TotalMass TotalWt Z22 Z33",
    "GROUPS": "*",
    "JOINT ADDED MASS": "CoordSys=GLOBAL CoordSys=Local",
    "JOINT COORDINATES": "CoordSys CoordType SpecialJt T XorR Y Z",
    "JOINT CONSTRAINT": "Type",
    "JOINT LOCAL AXES": "AdvanceAxes=No AdvancedAxes=No",
    "LINK LOCAL AXES": "AdvanceAxes=No AdvancedAxes=No",
    "LINK PROPERTY ASSIGNMENTS": "LinkFDProp=None LinkType",
    "LINK PROPERTY DEFINITIONS 01": "DefArea DefLength PDM2I PDM2J PDM3I PDM3J RotInert1=0 "
    "RotInert2=0 RotInert3=0",
    "LOAD PATTERN": "AutoLoad",
    "MASS SOURCE": "Elements IsDefault LoadPat Loads MassSource Masses Multiplier",
    "MATERIAL PROPERTIES 01": "Grade SymType=Isotropic SymType=Uniaxial TempDepend=No Type",
    "MATERIAL PROPERTIES 02": "A1",
    "PROGRAM CONTROL": "*",
}
"""Fields without effect on the frame, as `Tables.unknown` takes them."""

_OBJECTS = ("CONNECTIVITY", "CONSTRAINT DEFINITIONS", "JOINT ", "FRAME ", "AREA ", "LINK ")


def read_sap2000(
    path: str | Path, *, allow: Collection[str] = (), decimal: Decimal = "."
) -> Building:
    """Read a SAP2000 model."""
    file = Path(path)
    tables = read_excel(file) if file.suffix.lower() in _BOOKS else read_s2k(file, decimal)
    account = Account(file.name, allow)
    units, version = _units(tables)
    building = Building(file.stem, "SAP2000", version, units, account)
    _refuse_plane(tables)
    read_properties(tables, building)
    read_objects(tables, building)
    read_loads(tables, building)
    _judge_rest(tables, account)
    return building


def _units(tables: Tables) -> tuple[Units, str]:
    row = tables.needed("PROGRAM CONTROL", "it has the units; export it with the others")[0]
    words = [word.strip() for word in row.text("CurrUnits").split(",")]
    found = units_of(words[0], words[1]) if len(words) >= 2 else None
    if found is None:
        message = (
            f'CurrUnits = "{row.text("CurrUnits")}" must be a force of {", ".join(FORCES)} and a '
            f'length of {", ".join(LENGTHS)}, such as "KN, m, C"'
        )
        raise row.error(message)
    return found, row.text("Version", "")


def _refuse_plane(tables: Tables) -> None:
    for row in tables.rows("ACTIVE DEGREES OF FREEDOM"):
        require_space(row, {name for name in ACTIVE if row.yes(name)})


def _judge_rest(tables: Tables, account: Account) -> None:
    # Tables that nobody read: refused, harmless, or noted.
    for name, count in tables.unread().items():
        refused = next((r for r in REFUSED if name.startswith(r[0])), None)
        if refused is not None:
            rows = tables.rows(name)
            what = f"{refused[2]}, {count} rows"
            account.refuse(refused[1], name, what, [_first(rows[0].values)], rows[0].place)
        elif name.startswith(_OBJECTS) and not name.startswith(HARMLESS):
            rows = tables.rows(name)
            what = f"a table that is not known here, {count} rows"
            account.refuse("other tables", name, what, [_first(rows[0].values)], rows[0].place)
    account.unknown(tables.unknown(KNOWN))
    rest = [f"{name} ({count})" for name, count in tables.unread().items()]
    account.left_out("other tables", "what the linear model does not need, with rows", rest)


def _first(values: dict[str, str | float | bool]) -> str:
    return str(next(iter(values.values()), ""))
