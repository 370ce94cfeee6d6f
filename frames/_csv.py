"""Tables of text as spreadsheets save them: commas, semicolons or tabs, decimal commas, marks."""

from __future__ import annotations

import csv
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?(?:\s*[^\d\s,;][^,;]*)?\s*")
_THOUSANDS = re.compile(r"\s*[-+]?\d{1,3}(?:[.,]\d{3})+[.,]\d+(?:\s*[^\d\s,;][^,;]*)?\s*")

CsvLines = list[tuple[int, list[str]]]
"""Rows with their line in the file, empty ones left out."""


def csv_lines(path: Path) -> CsvLines:
    """Return the rows of a table that a spreadsheet saved."""
    raw = path.read_bytes()
    wide = raw[:2] in {b"\xff\xfe", b"\xfe\xff"}
    try:
        text = raw.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as cause:
        msg = f"is no text in UTF-8 ({cause.reason}): save it as UTF-8"
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


def _cell(line: int, cell: str, separator: str) -> str:
    """Return a cell, a decimal comma as a point."""
    if _THOUSANDS.fullmatch(cell) and "," in cell:
        msg = f"line {line}: {cell.strip()} has signs of thousands: write it without them"
        raise ValueError(msg)
    if not _COMMA.fullmatch(cell):
        return cell
    if separator == ",":
        msg = (
            f"line {line}: {cell.strip()} has a decimal comma, and commas separate the cells: "
            "write a point, or separate the cells by semicolons"
        )
        raise ValueError(msg)
    return cell.replace(",", ".")
