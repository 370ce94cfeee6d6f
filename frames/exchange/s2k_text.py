"""Reads the text of SAP2000's tables: `TABLE: "..."`, then rows of Key=Value.

Sources of the format: docs/exchange.md.
"""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

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
