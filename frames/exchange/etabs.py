"""Reads an ETABS model: its text file (.e2k, .$et)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from frames.exchange.account import Account
from frames.exchange.building import Building
from frames.exchange.e2k_text import read_e2k
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
}
"""First words whose loss would change the answer: key of `allow`, what it is."""


def read_etabs(
    path: str | Path,
    *,
    allow: Collection[str] = (),
    decimal: Decimal = ".",
    sections: Mapping[str, Section] | None = None,
    library: str | Path | Sequence[str | Path] = (),
) -> Building:
    """Read an ETABS model.

    Parameters
    ----------
    path : str or Path
        A .e2k or .$et text file.
    allow : collection of str
        What may be left out although it changes the answer; the message of a refusal has the key.
    decimal : {".", ","}
        Decimal sign of the file: that of the Windows that wrote it.
    sections : mapping of str to Section, optional
        Constants of sections that the file has by the name of a catalogue alone.
    library : str, Path or sequence of them
        Property files of the program that have such sections by their names, AISC14.xml.

    Returns
    -------
    Building
        All that was read, in SI; `Building.account` says what became of the rest.

    Raises
    ------
    ModelError
        If the file cannot be used: the message has line, section and remedy.
    """
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
    for name, count in tables.unread().items():
        if name in REFUSED:
            rows = tables.rows(name)
            first = next(iter(rows[0].values.values()), "")
            key, what = REFUSED[name]
            account.refuse(
                key, rows[0].table, f"{what}, {count} lines", [str(first)], rows[0].place
            )
    rest = [f"{name} ({count})" for name, count in tables.unread().items()]
    account.left_out("other lines", "what the linear model does not need, by first word", rest)
    return building


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
