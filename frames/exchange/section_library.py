"""Reads the files in which ETABS and SAP2000 keep rolled shapes by name, AISC14.xml and others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple
from xml.parsers import expat

from frames._errors import ModelError
from frames.exchange.tables import Row
from frames.exchange.units import LENGTHS

if TYPE_CHECKING:
    from collections.abc import Sequence

ROOT = "PROPERTY_FILE"
FIELDS = {"A": "AREA", "J": "TORSION", "HT": "D", "OD": "D", "BF": "B"}
"""Words of these files that ETABS' text has otherwise."""


class Shape(NamedTuple):
    """Constants of a shape, in the words of ETABS' text, and their unit of length [m]."""

    row: Row
    length: float


def read_libraries(paths: str | Path | Sequence[str | Path]) -> dict[str, Shape]:
    """Return the shapes of property files by their labels, in capitals."""
    given = [paths] if isinstance(paths, str | Path) else list(paths)
    found: dict[str, Shape] = {}
    for path in given:
        for label, shape in _read(Path(path)).items():
            found.setdefault(label, shape)
    return found


def _read(path: Path) -> dict[str, Shape]:
    try:
        content = path.read_bytes()
    except OSError as cause:
        message = f"{path} cannot be read: {cause.strerror}; name the property file of the program"
        raise ModelError(message) from cause
    rows = _Entries(path.name)
    try:
        rows.parse(content)
    except (expat.ExpatError, LookupError, ValueError) as cause:  # of these, encodings
        where = f", line {cause.lineno}" if isinstance(cause, expat.ExpatError) else ""
        message = (
            f"{path.name}{where}: {cause}; it must be whole, as XML: name a property file of ETABS "
            "or SAP2000, AISC14.xml"
        )
        raise ModelError(message) from cause
    words = rows.control.text("LENGTH_UNITS", "") if rows.control else ""
    if rows.root != ROOT or words.upper() not in LENGTHS:
        message = (
            f"{path.name} is no property file of ETABS or SAP2000: it begins with {ROOT} and has "
            f"LENGTH_UNITS of {', '.join(LENGTHS)} under CONTROL"
        )
        raise ModelError(message)
    one = LENGTHS[words.upper()]
    return {row.text("LABEL").strip().upper(): Shape(row, one) for row in rows.shapes}


class _Entries:
    # The entries of a file: elements under its root, their texts by name.
    def __init__(self, file: str) -> None:
        self.file, self.root = file, ""
        self.control: Row | None = None
        self.shapes: list[Row] = []
        self._open: list[str] = []
        self._text: list[str] = []
        self._row = Row(file, "", 0, {})

    def parse(self, content: bytes) -> None:
        parser = expat.ParserCreate(namespace_separator=" ")

        def start(tag: str, _: object) -> None:
            name = tag.rsplit(" ", 1)[-1].upper()
            self._open.append(name)
            self._text = []
            if len(self._open) == 1:
                self.root = name
            elif len(self._open) == 2:
                self._row = Row(self.file, name, parser.CurrentLineNumber, {})

        parser.StartElementHandler = start
        parser.CharacterDataHandler = self._text_of
        parser.EndElementHandler = self._end
        parser.Parse(content, True)

    def _text_of(self, data: str) -> None:
        self._text.append(data)

    def _end(self, _: str) -> None:
        name = self._open.pop()
        if len(self._open) == 2:
            self._row.values[FIELDS.get(name, name)] = "".join(self._text).strip()
        elif len(self._open) == 1 and name == "CONTROL":
            self.control = self._row
        elif len(self._open) == 1 and self._row.has("LABEL", "AREA", "I33", "I22"):
            self.shapes.append(self._row)
        self._text = []
