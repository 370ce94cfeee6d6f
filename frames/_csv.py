"""Tables as spreadsheets save them: workbooks, and text with its separators, commas and marks."""

from __future__ import annotations

import csv
import datetime
import re
import zipfile
import zlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

BOOKS = (".xlsx", ".xlsm")
"""Endings of workbooks."""

_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s,;][^,;]*)?\s*")
_THOUSANDS = re.compile(r"\s*[-+]?\d{1,3}(?:[.,]\d{3})+[.,]\d+(?:\s*[^\d\s,;][^,;]*)?\s*")

CsvLines = list[tuple[int, list[str]]]
"""Rows with their line in the file, empty ones left out."""


def csv_lines(path: Path) -> CsvLines:
    """Return the rows of a table that a spreadsheet saved; of a workbook, of its first sheet."""
    if path.suffix.lower() in BOOKS:
        return book_lines(path)
    raw = path.read_bytes()
    if raw[:4] in _PACKED:
        msg = f"is a workbook: save it as {BOOKS[0]}, or as CSV in UTF-8"
        raise ValueError(msg)
    wide = raw[:2] in {b"\xff\xfe", b"\xfe\xff"}
    try:
        text = raw.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as cause:
        msg = f"is not text in UTF-8 ({cause.reason}): save it as UTF-8"
        raise ValueError(msg) from cause
    lines = [(k, line) for k, line in enumerate(text.splitlines(), start=1)]
    lines = [(k, line) for k, line in lines if line.strip() and not line.lstrip().startswith("#")]
    head = re.sub(r'"[^"]*"', "", lines[0][1]) if lines else ""
    separator = next((each for each in ";\t" if each in head), ",")
    rows = csv.reader((line for _, line in lines), delimiter=separator)
    found = zip((k for k, _ in lines), rows, strict=False)
    return [
        (k, [_cell(k, cell, separator) for cell in row])
        for k, row in found
        if any(cell.strip() for cell in row)
    ]


_PACKED = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")  # how .xlsx and .xls begin
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
"""Errors of openpyxl at a file that is no workbook."""


def open_book(path: Path) -> Any:
    """Open a workbook to read the values of its cells; raise a ValueError if it is none."""
    try:
        import openpyxl
    except ImportError as cause:
        message = 'workbooks need openpyxl: pip install "lir-dcfp[excel]"'
        raise ImportError(message) from cause
    with path.open("rb"):  # a file that is not there is no damaged one
        pass
    try:
        return openpyxl.load_workbook(path, read_only=True, data_only=True)
    except _DAMAGED as cause:
        message = f"is not a readable workbook ({cause}): save it as {BOOKS[0]}"
        raise ValueError(message) from cause


def book_lines(path: Path) -> CsvLines:
    """Return the rows of the first sheet of a workbook as texts."""
    book = open_book(path)
    try:
        rows = list(book.worksheets[0].iter_rows(values_only=True))
    finally:
        book.close()
    lines = [(k, [_text(k, cell) for cell in row]) for k, row in enumerate(rows, start=1)]
    return [
        (k, row) for k, row in lines if any(row) and not next(filter(None, row)).startswith("#")
    ]


def _text(row: int, cell: object) -> str:
    if isinstance(cell, datetime.date | datetime.time):
        msg = (
            f"row {row}: {cell} is a date: format the column as text, because spreadsheets "
            "change 1-3 into a date"
        )
        raise ValueError(msg)
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, float) and cell.is_integer():
        return str(int(cell))
    return "" if cell is None else str(cell).strip()


def _cell(line: int, cell: str, separator: str) -> str:
    """Return a cell, a decimal comma as a point."""
    if _THOUSANDS.fullmatch(cell) and "," in cell:
        msg = f"line {line}: {cell.strip()} has thousands separators: remove them"
        raise ValueError(msg)
    if not _COMMA.fullmatch(cell):
        return cell
    if separator == ",":
        msg = (
            f"line {line}: {cell.strip()} has a decimal comma, but commas separate the "
            "cells: use decimal points, or separate the cells by semicolons"
        )
        raise ValueError(msg)
    return cell.replace(",", ".")
