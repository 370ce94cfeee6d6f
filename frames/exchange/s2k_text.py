"""Reads SAP2000's tables: text, `TABLE: "..."` and rows of Key=Value, or a workbook's sheets.

Sources of the format: docs/exchange.md.
"""

from __future__ import annotations

import contextlib
import re
import zipfile
import zlib
from pathlib import Path
from typing import Any

from frames._errors import ModelError
from frames.exchange.tables import Decimal, Row, Tables, Value

_HEAD = re.compile(r'\s*TABLE:\s*"([^"]*)"\s*$', re.IGNORECASE)
_PAIR = re.compile(r'([^\s="]+)\s*=\s*(?:"((?:[^"]|"")*)"(?=\s|$)|([^\s"]*)(?=\s|$))')
END = "END TABLE DATA"


def read_text(path: Path) -> str:
    """Return the text of a file, whichever of the usual codes it is written in."""
    try:
        data = path.read_bytes()
    except OSError as cause:
        message = f"{path} cannot be read ({cause.strerror}): give the path of the exported file"
        raise ModelError(message) from cause
    for code in ("utf-16",) if data[:2] in _MARKS else _CODES:
        with contextlib.suppress(UnicodeDecodeError):
            text = data.decode(code)
            if "\0" not in text:
                return text
    message = (
        f"{path.name} is no text file: export the model as text (File > Export), a binary "
        "model cannot be read"
    )
    raise ModelError(message)


_MARKS = (b"\xff\xfe", b"\xfe\xff")
_CODES = ("utf-8-sig", "cp1252", "latin-1")


def read_s2k(path: Path, decimal: Decimal = ".") -> Tables:
    """Read the tables of a .s2k or .$2k file."""
    name = path.name
    tables = Tables(name)
    rows: list[Row] = []
    table, begun, start, ended = "", "", 0, False
    for line, given in enumerate(read_text(path).splitlines(), start=1):
        text = given.strip()
        if not text or (not table and not text.upper().startswith("TABLE:")):
            ended = ended or text.upper() == END
            continue
        if text.upper() == END:
            ended = True
            break
        if text.upper().startswith("TABLE:") and not begun:
            head = _HEAD.match(text)
            if head is None:
                message = f'{name}, line {line}: "{text[:60]}" must be TABLE:  "NAME OF THE TABLE"'
                raise ModelError(message)
            table = head[1].strip().upper()
            rows = tables.begin(table)
            continue
        start = start if begun else line
        whole = f"{begun} {text}" if begun else text
        if text.endswith(" _") or text == "_":
            begun = whole[:-1].rstrip()
            continue
        begun = ""
        rows.append(Row(name, table, start, _pairs(whole, name, table, start), decimal))
    _refuse_end(name, tables, ended=ended and not begun, table=table)
    return tables


def _refuse_end(name: str, tables: Tables, *, ended: bool, table: str) -> None:
    if not list(tables):
        message = (
            f'{name} holds no tables of SAP2000: a line TABLE:  "..." begins each; export the '
            "model as text with File > Export > SAP2000 .s2k Text File"
        )
        raise ModelError(message)
    if not ended:
        message = (
            f'{name} ends in table "{table}" without the line {END}: it is cut off, export it '
            "again; where it is whole, add that line at its end"
        )
        raise ModelError(message)


def _pairs(text: str, file: str, table: str, line: int) -> dict[str, Value]:
    found: dict[str, Value] = {}
    at = 0
    for match in _PAIR.finditer(text):
        if text[at : match.start()].strip(" _"):
            break
        key = match[1]
        if key in found:
            message = f'{file}, line {line}, table "{table}": {key} stands twice in the row'
            raise ModelError(message)
        found[key] = match[2].replace('""', '"') if match[2] is not None else match[3]
        at = match.end()
    rest = text[at:].strip(" _")
    if rest:
        message = (
            f'{file}, line {line}, table "{table}": "{rest[:60]}" is not of the form Key=Value: '
            "export the file again, or correct the line (text with spaces stands in quotes)"
        )
        raise ModelError(message)
    return found


_DAMAGED = (
    OSError,
    EOFError,
    LookupError,
    TypeError,
    AttributeError,
    ValueError,
    SyntaxError,  # of XML
    zipfile.BadZipFile,
    zlib.error,
)
"""What a file that is no workbook makes openpyxl raise."""


def read_excel(path: Path) -> Tables:
    """Read the tables of an .xlsx workbook.

    Each sheet begins with "TABLE:  Name", the names of the fields, and their units.
    """
    try:
        import openpyxl
    except ImportError as cause:
        message = 'workbooks need openpyxl: pip install "lir-dcfp[excel]"'
        raise ImportError(message) from cause
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    except _DAMAGED as cause:
        message = f"{path.name} is no workbook that can be read ({cause}): export it as .xlsx"
        raise ModelError(message) from cause
    tables = Tables(path.name)
    try:
        for sheet in book.worksheets:
            _read_sheet(sheet, tables)
    finally:
        book.close()
    if not list(tables):
        message = (
            f'{path.name} holds no tables of SAP2000: the first cell of a sheet is "TABLE:  ...", '
            "the second row has the names of the fields, the third their units"
        )
        raise ModelError(message)
    return tables


def _read_sheet(sheet: Any, tables: Tables) -> None:
    lines = sheet.iter_rows(values_only=True)
    first = next(lines, ())
    head = str(first[0]) if first and first[0] is not None else ""
    if not head.strip().upper().startswith("TABLE:"):
        return
    table = head.split(":", 1)[1].strip().strip('"').upper()
    rows = tables.begin(table)
    fields = [None if cell is None else str(cell).strip() for cell in next(lines, ())]
    next(lines, None)  # units
    for number, cells in enumerate(lines, start=4):
        values = {
            field: _value(cell)
            for field, cell in zip(fields, cells, strict=False)
            if field is not None and cell is not None
        }
        if values:
            rows.append(Row(tables.file, table, number, values))


def _value(cell: object) -> Value:
    if isinstance(cell, bool):
        return cell
    return float(cell) if isinstance(cell, (int, float)) else str(cell).strip()
