"""Reads an ETABS model: its text file (.e2k, .$et)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from frames.exchange.account import Account
from frames.exchange.building import Building
from frames.exchange.e2k_text import NAMES, read_e2k
from frames.exchange.etabs_groups import read_groups
from frames.exchange.etabs_links import EtabsLinks
from frames.exchange.etabs_loads import read_loads
from frames.exchange.etabs_objects import Objects
from frames.exchange.etabs_properties import read_properties, read_stories
from frames.exchange.section_library import read_libraries
from frames.exchange.tables import Decimal, Tables, require_space
from frames.exchange.units import FORCES, LENGTHS, Units, units_of

if TYPE_CHECKING:
    from frames.model.sections import Section

REFUSED = {
    "HINGEASSIGN": ("hinges", "plastic hinges of frames, which stay elastic"),
    "AREAHINGEASSIGN": ("hinges", "plastic hinges of walls, which stay elastic"),
    "TENDONASSIGN": ("tendons", "tendons"),
    "LINESPRING": ("line and area springs", "springs along lines"),
    "AREASPRING": ("line and area springs", "springs under areas"),
    "AREAJOINTOFFSETDATA": ("area overwrites", "offsets of corners of areas"),
    "AREATHICKNESSOVERWRITE": ("area overwrites", "thickness of single areas"),
    "AREAEDGERELEASE": ("edge releases", "releases along edges of areas"),
    "LINECURVEDATA": ("curved frames", "curved lines, taken as straight ones"),
    "AREACURVEDATA": ("curved areas", "curved edges of areas, taken as straight ones"),
    "STAGE": ("staged construction", "stages of construction, taken as built at once"),
    "SEQUENTIAL": ("staged construction", "stages of construction, taken as built at once"),
}
"""Beginnings of first words whose loss would change the answer: key of `allow`, what it is."""

KNOWN = {
    "": " ".join(
        ["GUID NOTES COLOR Name Area Kind Ends", *(n for ns in NAMES.values() for n in ns)]
    ),
    "AREAASSIGN": "ADDRESTRAINT CARDINALPOINT DIAPHRAGMTOFLOOR LINECONSTRAINT MAXMESHSIZE MESHAT "
    "OBJMESHTYPE PIER SPANDREL TRANSFORMSTIFFNESSFOROFFSETS=NO",
    "COMBO": "*",
    "CONCRETESECTION": "*",
    "FRAMESECTION": "FILE INCLUDEAUTORIGIDZONEAREA NOTIONALUSERVALUE NOTIONALSIZE R22 R33 S22NEG "
    "S22POS S33NEG S33POS Z22 Z33",
    "LINEASSIGN": "AUTOMESH FLOORMESH MAXSTASPC MESH MESHATINTERSECTIONS MINNUMSTA PIER "
    "SELFWEIGHTOPTION SPANDREL",
    "LINKPROP": "*",
    "LOADCASE": "*",
    "MASSSOURCE": "INCLUDELATERALMASS=YES INCLUDEMOVE=NO INCLUDEVERTICALMASS",
    "MATERIAL": "A CPCOMPRESSION CPTENSION DESIGNTYPE EFFFU EFFFY ENERGYDEGFACT FC FINALSLOPE FU "
    "FUE FY FYE FYS GRADE HYSTYPE IGNORETENSIONACCEPTANCE IOCOMPRESSION IOTENSION LSCOMPRESSION "
    "LSTENSION POINTID PRICE SSTYPE STRAIN STRAINATFC STRAINATHARDENING STRAINATMAXSTRESS "
    "STRAINATRUPTURE STRAINATULTIMATE STRESS SYMTYPE=ISOTROPIC SYMTYPE=UNIAXIAL TIMEDEPCONCCODE "
    "TYPE",
    "POINTASSIGN": "USERJOINT",
    "POINTSPRING": "STIFFNESSOPTION",
    "PROGRAM": "*",
    "SHELLPROP": "DECKMATERIAL DECKSHEARTHICKNESS DECKTYPE PLATETYPE SHEARSTUDDIAM SHEARSTUDFU "
    "SHEARSTUDHEIGHT",
    "STORY": "MASTERSTORY SIMILARTO SPLICEABOVE SPLICEHEIGHT",
}
"""Words without effect on the frame, as `Tables.unknown` takes them."""


def read_etabs(
    path: str | Path,
    *,
    allow: Collection[str] = (),
    decimal: Decimal = ".",
    sections: Mapping[str, Section] | None = None,
    library: str | Path | Sequence[str | Path] = (),
) -> Building:
    """Read an ETABS model."""
    file = Path(path)
    tables = read_e2k(file, decimal)
    account = Account(file.name, allow)
    program = tables.rows("PROGRAM")
    version = program[0].text("VERSION", "") if program else ""
    building = Building(file.stem, "ETABS", version, _units(tables), account)
    for row in tables.rows("ACTIVEDOF"):
        require_space(row, row.text("Name", "").upper().split())
    read_stories(tables, building)
    read_properties(tables, building, sections, read_libraries(library))
    objects = Objects(tables, building)
    objects.read()
    EtabsLinks(tables, building, objects).read()
    read_groups(tables, building)
    read_loads(tables, building)
    _refuse_stages(tables, account)
    for name, count in tables.unread().items():
        key, what = next((v for start, v in REFUSED.items() if name.startswith(start)), ("", ""))
        if key:
            rows = tables.rows(name)
            first = next(iter(rows[0].values.values()), "")
            account.refuse(
                key, rows[0].table, f"{what}, {count} lines", [str(first)], rows[0].place
            )
    account.unknown(tables.unknown(KNOWN))
    rest = [f"{name} ({count})" for name, count in tables.unread().items()]
    account.left_out("other lines", "what the linear model does not need, by first word", rest)
    return building


def _refuse_stages(tables: Tables, account: Account) -> None:
    rows = tables.rows("LOADCASE")
    staged = [r for r in rows if r.has("STAGE") or "STAGED" in r.text("TYPE", "").upper()]
    if staged:
        key, what = REFUSED["STAGE"]
        names = list(dict.fromkeys(row.text("Case") for row in staged))
        account.refuse(key, staged[0].table, what, names, staged[0].place)


def _units(tables: Tables) -> Units:
    row = tables.needed("UNITS", "$ CONTROLS has the units; export it with the others")[0]
    found = units_of(row.text("Force"), row.text("Length"))
    if found is None:
        message = (
            f'UNITS "{row.text("Force")}" "{row.text("Length")}" must be a force of '
            f"{', '.join(FORCES)} and a length of {', '.join(LENGTHS)}"
        )
        raise row.error(message)
    return found
