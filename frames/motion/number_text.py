"""Numbers in text as files of records have them: in columns, row by row, in pairs, in widths.

A text without numbers is refused by its cause: numbers that touch, a line of text, decimal commas,
a short row, a binary file. Each message ends in the option that reads the file, or in the repair.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._csv import BOOKS, book_lines
from frames._errors import MotionError
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames._types import FloatArray

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
"""A number as Fortran and others print it."""

_TOUCHING = re.compile(rf"{NUMBER}(?:[-+](?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?)+")
_COMMA = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?;?")
_WIDTHS = range(4, 31)

_UNITS = {
    "g": STANDARD_GRAVITY,
    "g/10": 0.1 * STANDARD_GRAVITY,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "gal": 0.01,
    "gals": 0.01,
}

Lines = Sequence[tuple[int, str]]
"""Numbered lines of a file that hold numbers."""


class Writing(NamedTuple):
    """Notation of the numbers in a line."""

    # their separator; None for white space, or semicolons if there are some
    delimiter: str | None = None
    decimal: str = "."  # the decimal sign, "." or ","
    # characters of each number, of files without separators; None if they are separated
    width: int | None = None


def acceleration_unit(text: str) -> float | None:
    """Return the size of a unit of acceleration [m/s2], None if it is unknown."""
    plain = re.sub(r"[\s()\[\]{}*^'\"]|\.$", "", text.lower().replace("\u00b2", "2"))
    plain = plain.replace("sec", "s").replace("/s/s", "/s2")
    return _UNITS.get(plain)


def text_lines(path: Path) -> list[str]:
    """Return the lines of a file, or of a workbook's first sheet; refuse one that is binary."""
    try:
        if path.suffix.lower() in BOOKS:
            return ["\t".join(cells) for _, cells in book_lines(path)]
        raw = path.read_bytes()
    except OSError as cause:
        msg = f"{path} cannot be read ({cause.strerror}): give the path of a record's file"
        raise MotionError(msg) from cause
    except ValueError as cause:
        msg = f"{path.name} {cause}"
        raise MotionError(msg) from cause
    if raw[:2] in {b"\xff\xfe", b"\xfe\xff"}:
        return raw.decode("utf-16").splitlines()
    if b"\0" in raw[:4096]:
        msg = (
            f"{path.name} is binary, not text: export the record as text, or pass its "
            "samples, GroundMotion(x=..., dt=...)"
        )
        raise MotionError(msg)
    return raw.removeprefix(b"\xef\xbb\xbf").decode("latin-1").splitlines()


def fields(line: str, writing: Writing) -> list[str]:
    """Return the texts of the numbers of a line."""
    if writing.width is not None:
        plain = line.rstrip()
        cut = [plain[k : k + writing.width] for k in range(0, len(plain), writing.width)]
        return [part.strip() for part in cut]
    if writing.delimiter is None:
        return line.replace(";", " ").split() if ";" in line else line.split()
    parts = [part.strip() for part in line.split(writing.delimiter)]
    return parts[:-1] if parts and not parts[-1] else parts  # a separator may end a row


def number(text: str, writing: Writing) -> float:
    """Return a number, with an exponent D of Fortran too, or raise a ValueError."""
    plain = text.replace(",", ".") if writing.decimal == "," else text
    try:
        return float(plain)
    except ValueError:
        return float(re.sub(r"[dD]", "E", plain))


def rows_of(name: str, lines: Lines, writing: Writing) -> list[list[float]]:
    """Return the numbers of each line."""
    rows: list[list[float]] = []
    for at, (where, line) in enumerate(lines):
        try:
            rows.append([number(text, writing) for text in fields(line, writing)])
        except ValueError as cause:
            raise MotionError(_cause(name, lines, at, where, writing)) from cause
    return rows


def table_of(name: str, lines: Lines, writing: Writing) -> FloatArray:
    """Return lines of equally many numbers as an array (rows, columns), or raise a MotionError."""
    rows = rows_of(name, lines, writing)
    size = len(rows[0])
    odd = next((k for k, row in enumerate(rows) if len(row) != size), None)
    if odd is not None:
        where, last = lines[odd][0], odd == len(rows) - 1
        remedy = (
            'if it is a record row by row, use order="rows"'
            if last and 0 < len(rows[odd]) < size
            else f"repair line {where}, or skip the header (skip=)"
        )
        msg = (
            f"{name}, line {where} holds {len(rows[odd])} numbers, the lines before it {size}: "
            f"{remedy}"
        )
        raise MotionError(msg)
    return np.array(rows, dtype=np.float64)


def _cause(name: str, lines: Lines, at: int, where: int, writing: Writing) -> str:
    """Return the reason that a line is not numbers, and the option that reads the file."""
    line = lines[at][1]
    texts = fields(line, writing)
    bad = next((text for text in texts if not _is_number(text, writing)), line.strip())
    head = f"{name}, line {where}: {bad[:40]!r}"
    if writing.width is not None:
        return (
            f"{head} is not a number: set width = {writing.width} to the characters of a "
            "number with its leading blanks, or skip the header (skip=)"
        )
    if _TOUCHING.fullmatch(bad):
        found = _fitting_width([text for _, text in lines[at : at + 20]])
        give = f"width={found}" if found else "width=..."
        return f"{head} are numbers without separators: set their width, {give}"
    if _COMMA.fullmatch(bad) and writing.decimal == ".":
        return f'{head} has a decimal comma: set decimal=","'
    if "," in bad and all(_is_number(part.strip(), Writing()) for part in bad.split(",") if part):
        return f'{head} are numbers separated by commas: set delimiter=","'
    starts = next((k for k, (_, text) in enumerate(lines) if _numeric(text, writing)), None)
    if at == 0 and starts is not None and re.search(r"[A-Za-z]", line):
        return (
            f"{head} is text, the numbers begin {starts} lines later: skip the header, "
            f"skip={lines[starts][0] - 1}"
        )
    return f"{head} is not a number: repair the line, or remove it if it is a title or an end mark"


def _is_number(text: str, writing: Writing) -> bool:
    try:
        number(text, writing)
    except ValueError:
        return False
    return True


def _numeric(line: str, writing: Writing) -> bool:
    return all(
        _is_number(text, writing) or _TOUCHING.fullmatch(text) or _COMMA.fullmatch(text)
        for text in fields(line, writing)
    )


def _fitting_width(lines: Sequence[str]) -> int | None:
    """Return the width by which all lines are whole numbers of fields, each with its point."""
    for width in _WIDTHS:
        cut = [fields(line, Writing(width=width)) for line in lines]
        alike = all(len(line.rstrip()) % width == 0 for line in lines)
        pointed = all(text.count(".") == 1 for each in cut for text in each)
        if alike and pointed and all(_is_number(t, Writing()) for each in cut for t in each):
            return width
    return None


def likely_order(table: FloatArray) -> str:
    """Return the likely order of a table: columns, or one history written row by row.

    Along a history neighbours are close. If the numbers of a row follow one another, and the next
    row continues its end, steps along rows are small beside those down a column; for components in
    columns it is the opposite.

    Shapes: table (rows, columns).
    """
    count, size = table.shape
    if count < _LEAST_ROWS or size < 2:
        return ""
    along = [np.square(table[:, k + 1] - table[:, k]).mean() for k in range(size - 1)]
    along.append(np.square(table[1:, 0] - table[:-1, -1]).mean())
    down = np.square(np.diff(table, axis=0)).mean(axis=0)
    if max(along) < _ALIKE * down.min():
        return "rows"
    return "columns" if down.max() < _ALIKE * min(along) else ""


_LEAST_ROWS, _ALIKE = 20, 0.7
