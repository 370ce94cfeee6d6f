"""Reads the same tables from the workbook that SAP2000 exports: a sheet for each table."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path
from typing import Any

from frames._errors import ModelError
from frames.exchange.tables import Row, Tables, Value

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
