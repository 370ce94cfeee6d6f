"""Reads the tables of files: SAP2000's text and workbooks, and ETABS' text.

SAP2000: `TABLE: "..."` and rows of Key=Value, or a sheet for each table. ETABS: sections that begin
with $, and lines of words: a word, its positional values, then words with values. Sources of the
formats: docs/exchange.md.
"""

from __future__ import annotations

import contextlib
import re
from pathlib import Path
from typing import Any

from frames._csv import open_book
from frames._errors import ModelError
from frames.exchange.etabs_fields import ALIASES, NAMES
from frames.exchange.tables import Decimal, Row, Tables, Value

_HEAD = re.compile(r'\s*TABLE:\s*"([^"]*)"\s*$', re.IGNORECASE)
_PAIR = re.compile(r'([^\s="]+)\s*=\s*(?:"((?:[^"]|"")*)"(?=\s|$)|([^\s"]*)(?=\s|$))')
_END = "END TABLE DATA"


def read_text(path: Path) -> str:
    """Return the text of a file in any of the usual encodings."""
    try:
        data = path.read_bytes()
    except OSError as cause:
        message = f"{path} cannot be read ({cause.strerror}): give the path of the exported file"
        raise ModelError(message) from cause
    for code in ("utf-16",) if data[:2] in _MARKS else _CODES:
        with contextlib.suppress(UnicodeDecodeError):
            text = data.decode(code)
            if text.count("\0") * _FEW <= len(text):  # ETABS ends a comment of its log by one
                return text.replace("\0", "")
    message = f"{path.name} is a binary file: export the model as text (File > Export)"
    raise ModelError(message)


_FEW = 1000  # characters for each NUL of a file that is text
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
            ended = ended or text.upper() == _END
            continue
        if text.upper() == _END:
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
            f'{name} ends in table "{table}" without the line {_END}, so it may be cut off: '
            "export it again, or add that line if the file is complete"
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
            message = f'{file}, line {line}, table "{table}": {key} occurs twice in the row'
            raise ModelError(message)
        found[key] = match[2].replace('""', '"') if match[2] is not None else match[3]
        at = match.end()
    rest = text[at:].strip(" _")
    if rest:
        message = (
            f'{file}, line {line}, table "{table}": "{rest[:60]}" must have the form '
            "Key=Value: export the file again, or correct the line (text with spaces needs "
            "quotes)"
        )
        raise ModelError(message)
    return found


def read_excel(path: Path) -> Tables:
    """Read the tables of an .xlsx workbook.

    Each sheet begins with "TABLE:  Name", the names of the fields, and their units.
    """
    try:
        book = open_book(path)
    except ValueError as cause:
        message = f"{path.name} {cause}"
        raise ModelError(message) from cause
    except OSError as cause:
        message = f"{path} cannot be read ({cause.strerror}): give the path of the workbook"
        raise ModelError(message) from cause
    tables = Tables(path.name)
    try:
        for sheet in book.worksheets:
            _read_sheet(sheet, tables)
    finally:
        book.close()
    if not list(tables):
        message = (
            f'{path.name} has no tables of SAP2000: export sheets with "TABLE:  ..." in the '
            "first cell, names of fields in the second row and units in the third"
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


_TOKEN = re.compile(r'"([^"]*)"|([^\s"]+)')
_E2K_END = "$ END OF MODEL FILE"
TEXT = "Text"
"""Field of text in quotation marks that follows no word."""

_ALL_POSITIONAL = {"POINT", "LINE", "UNITS", "MASSSOURCELOAD"}


def read_e2k(path: Path, decimal: Decimal = ".") -> Tables:
    """Read the lines of an ETABS text file, by their first word."""
    name = path.name
    tables = Tables(name)
    section, ended, begun = "", False, False
    for line, given in enumerate(read_text(path).splitlines(), start=1):
        text = given.strip()
        if not text:
            continue
        if text.startswith("$"):
            section = text[1:].strip()
            ended = ended or text.upper().startswith(_E2K_END)
            begun = begun or section.upper().startswith("PROGRAM INFORMATION")
            continue
        if section.upper().startswith(("LOG", "END OF MODEL FILE")) or not section:
            continue
        if text.upper() == "END":  # before the last line
            continue
        _add(tables, _row(name, section, line, text, decimal))
    if not begun:
        message = (
            f"{name} is not an ETABS text file (no section $ PROGRAM INFORMATION): export "
            "the model with File > Export > ETABS Text File"
        )
        raise ModelError(message)
    if not ended:
        message = (
            f'{name} ends in section "{section}" without the line {_E2K_END}, so it may be '
            "cut off: export it again, or add that line if the file is complete"
        )
        raise ModelError(message)
    return tables


def _add(tables: Tables, row: Row) -> None:
    tables.begin(str(row.values.pop("")).upper()).append(row)


def _row(file: str, section: str, line: int, text: str, decimal: Decimal) -> Row:
    if text.count('"') % 2:
        message = (
            f'{file}, line {line}, section "{section}": a quotation mark is not closed in '
            f'"{text[:60]}"'
        )
        raise ModelError(message)
    tokens = [(m[1], True) if m[1] is not None else (m[2], False) for m in _TOKEN.finditer(text)]
    word = tokens[0][0].upper()
    values: dict[str, Value] = {"": word}
    row = Row(file, section, line, values, decimal)
    if word == "AREA":
        _corners(row, [token for token, _ in tokens[1:]])
        return row
    if word == "LINK":
        quoted = [token for token, is_quoted in tokens[1:] if is_quoted]
        row.values |= {"Link": quoted[0] if quoted else "", "Ends": "\n".join(quoted[1:])}
        return row
    names = NAMES.get(word, ("Name",))
    rest = tokens[1:]
    if word in _ALL_POSITIONAL or (rest and (rest[0][1] or word in NAMES)):
        for field, (token, _) in zip(names, rest, strict=False):
            values[field] = token
        rest = rest[len(names) :]
    _words(row, rest)
    return row


def _words(row: Row, tokens: list[tuple[str, bool]]) -> None:
    # A word without quotes, and the value after it; a repeated word adds to a list, and text in the
    # place of a word is kept by itself.
    at, aliases = 0, ALIASES.get(str(row.values[""]), {})
    while at < len(tokens):
        word, quoted = tokens[at]
        if quoted:
            word, value = TEXT, word
            at -= 1
        else:
            word = aliases.get(word.upper(), word.upper())
            value = tokens[at + 1][0] if at + 1 < len(tokens) else ""
        if word in row.values:
            row.values[word] = f"{row.values[word]}\n{value}"
        else:
            row.values[word] = value
        at += 2


def _corners(row: Row, tokens: list[str]) -> None:
    # AREA "F1" FLOOR 4 "1" "2" "3" "4" 0 0 0 0
    try:
        count = int(tokens[2])
        points, stories = tokens[3 : 3 + count], tokens[3 + count : 3 + 2 * count]
        if count < 3 or len(points) < count or len(stories) < count:
            raise ValueError
    except (IndexError, ValueError):
        message = (
            'an area needs its name, kind, number of corners (3 or more), corners and "stories '
            'down" of each: AREA "F1" FLOOR 4 "1" "2" "3" "4" 0 0 0 0'
        )
        raise row.error(message) from None
    row.values |= {"Area": tokens[0], "Kind": tokens[1]}
    row.values |= {"Corners": "\n".join(points), "Stories": "\n".join(stories)}
