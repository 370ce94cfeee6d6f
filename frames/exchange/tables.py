"""Tables of another program's file: rows of named values with their places; units."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal, TypeAlias

from frames._errors import ModelError, argument
from lir_element.units import STANDARD_GRAVITY

Value: TypeAlias = str | float | bool
"""A cell: text of a text file, or a value of a workbook."""

Decimal: TypeAlias = Literal[".", ","]
"""The decimal sign of a file, which is that of the Windows that wrote it."""

ACTIVE = ("UX", "UY", "UZ", "RX", "RY", "RZ")
"""Displacements of a joint that a model may have."""

_YES = {"yes": True, "true": True, "no": False, "false": False}


class Row:
    """One row of a table, at its line of a file or of a sheet."""

    __slots__ = ("decimal", "file", "line", "lines", "looked_at", "table", "values")

    refusal: ClassVar[type[ValueError]] = ModelError
    remedy: ClassVar[str] = "export the table with all its fields"

    def __init__(
        self, file: str, table: str, line: int, values: dict[str, Value], decimal: Decimal = "."
    ) -> None:
        self.file, self.table, self.line = file, table, line
        self.values, self.decimal = values, decimal
        self.looked_at: set[str] = set()  # fields that were read
        self.lines: dict[str, int] = {}  # of fields that are in other lines than `line`

    @property
    def place(self) -> str:
        """Place of the row: file, line and table."""
        return self.place_of("")

    def place_of(self, field: str) -> str:
        """Return the place of a field of the row."""
        table = f', table "{self.table}"' if self.table else ""
        return f"{self.file}, line {self.lines.get(field, self.line)}{table}"

    def error(self, message: str, field: str = "") -> ValueError:
        """Return an error that begins with the place of the row, or of one of its fields."""
        return self.refusal(f"{self.place_of(field)}: {message}")

    def has(self, *fields: str) -> bool:
        """Return whether every field has a value."""
        self.looked_at.update(fields)
        return all(self.values.get(field, "") != "" for field in fields)

    def text(self, field: str, default: str | None = None) -> str:
        """Return a value as text; without a default it must be there."""
        self.looked_at.add(field)
        value = self.values.get(field, "")
        if value == "":
            if default is None:
                message = f"{field} is empty, there are {', '.join(self.values)}: {self.remedy}"
                raise self.error(message)
            return default
        if isinstance(value, bool):
            return "Yes" if value else "No"
        if isinstance(value, float):
            return str(int(value)) if value.is_integer() else repr(value)
        return value

    def number(self, field: str, default: float | None = None) -> float:
        """Return a value as a finite number; without a default it must be there."""
        self.looked_at.add(field)
        value = self.values.get(field, "")
        if value == "" and default is not None:
            return default
        if isinstance(value, float) and math.isfinite(value):
            return value
        return as_number(self, field, self.text(field))

    def count(self, field: str, default: int | None = None) -> int:
        """Return a value as a whole number, as `number` does."""
        value = self.number(field, None if default is None else float(default))
        if not value.is_integer():
            msg = f"{field} = {value:g} must be a whole number"
            raise self.error(msg, field)
        return int(value)

    def yes(self, field: str, *, default: bool | None = None) -> bool:
        """Return True if a value is Yes; anything but Yes and No is refused."""
        text = self.text(field, None if default is None else "Yes" if default else "No")
        found = _YES.get(text.strip().lower())
        if found is None:
            msg = f'{field} = "{text}" must be Yes or No'
            raise self.error(msg, field)
        return found


def as_number(row: Row, field: str, text: str) -> float:
    """Return a text as a finite number in the decimal sign of the row's file, or raise."""
    sign = row.decimal
    try:
        if sign == "," and "." in text:
            raise ValueError(text)
        found = float(text.replace(",", ".") if sign == "," else text)
    except ValueError:
        other = "." if sign == "," else ","
        remedy = "give a number"
        if other in text:
            remedy = (
                "it was written with the other decimal sign: read the file with "
                f"{argument('decimal', other)}"
            )
        msg = f'{field} = "{text}" is not a number: {remedy}'
        raise row.error(msg, field) from None
    if not math.isfinite(found) or "_" in text:
        msg = f'{field} = "{text}" must be a finite number'
        raise row.error(msg, field)
    return found


class Tables:
    """The tables of a file by name, upper case."""

    def __init__(self, file: str) -> None:
        self.file = file
        self._rows: dict[str, list[Row]] = {}
        self._read: set[str] = set()

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of tables that have rows, in the order of the file."""
        return (name for name, rows in self._rows.items() if rows)

    def begin(self, name: str) -> list[Row]:
        """Return the rows of a table to add to, those that it has already included."""
        return self._rows.setdefault(name.upper(), [])

    def rows(self, name: str) -> list[Row]:
        """Return the rows of a table, none if it is not there, and note that it was read."""
        self._read.add(name.upper())
        return self._rows.get(name.upper(), [])

    def starting(self, beginning: str) -> list[Row]:
        """Return the rows of all tables whose names begin so."""
        names = [name for name in self._rows if name.startswith(beginning.upper())]
        return [row for name in names for row in self.rows(name)]

    def needed(self, name: str, remedy: str) -> list[Row]:
        """Return the rows of a table that must be there, or raise with the remedy."""
        found = self.rows(name)
        if not found:
            msg = f'{self.file}: table "{name}" is missing or empty: {remedy}'
            raise ModelError(msg)
        return found

    def unread(self) -> dict[str, int]:
        """Return the unread tables, and their numbers of rows."""
        return {name: len(self._rows[name]) for name in self if name not in self._read}

    def unknown(self, known: Mapping[str, str]) -> list[tuple[str, str, Row, int]]:
        """Return fields that have a value, but were not read and are unknown."""
        found: dict[tuple[str, str], tuple[Row, int]] = {}
        for name in self:
            if name not in self._read:
                continue
            given = " ".join(text for start, text in known.items() if name.startswith(start))
            fields = set(given.upper().split())
            if "*" in fields:
                continue
            for row in self._rows[name]:
                for field in row.values.keys() - row.looked_at if row.looked_at else ():
                    text = "".join(str(row.values[field]).upper().split())
                    if text and not fields & {field.upper(), f"{field.upper()}={text}"}:
                        first, count = found.get((name, field), (row, 0))
                        found[name, field] = (first, count + 1)
        return [(*key, row, count) for key, (row, count) in sorted(found.items())]


def by_name(rows: Sequence[Row], field: str) -> dict[str, Row]:
    """Return rows by the text of a field; a name that comes twice is refused."""
    found: dict[str, Row] = {}
    for row in rows:
        name = row.text(field)
        row.looked_at.discard(field)  # a row of which the name alone is read is not looked at
        if name in found:
            message = (
                f'{field} "{name}" already occurs in line {found[name].line}: keep one of the two'
            )
            raise row.error(message)
        found[name] = row
    return found


def of_objects(
    rows: Sequence[Row], field: str, names: Collection[str]
) -> Iterator[tuple[str, Row]]:
    """Yield rows and the objects that they are of; one that is not there is refused."""
    for name, row in by_name(rows, field).items():
        yield known(row, field, name, names), row


def merged(
    rows: Sequence[Row], *fields: str, adding: Collection[str] = ()
) -> dict[tuple[str, ...], Row]:
    """Return one row for each object: its lines add up, a value that comes again replaces.

    Of the fields that add, it is put behind the value before.
    """
    found: dict[tuple[str, ...], Row] = {}
    for row in rows:
        key = tuple(row.text(field) for field in fields)
        values: dict[str, Value] = dict(row.values)
        one = found.setdefault(key, Row(row.file, row.table, row.line, {}, row.decimal))
        for field in one.values.keys() & values.keys() & set(adding):
            values[field] = f"{one.values[field]} {values[field]}"
        one.values |= values
        if row.line != one.line:
            one.lines |= dict.fromkeys(values, row.line)
        row.looked_at = one.looked_at
    return found


def known(row: Row, field: str, name: str, names: Collection[str], of: str = "") -> str:
    """Return a name that a row refers to, or raise if nothing has it."""
    if name not in names:
        some = ", ".join(list(names)[:6]) or "none"
        msg = f'{field} "{name}"{of} is not defined: there are {some}'
        raise row.error(msg, field)
    return name


def require_space(row: Row, active: Collection[str]) -> None:
    """Raise unless all displacements are active in a model, "UX" to "RZ"."""
    idle = [dof for dof in ACTIVE if dof not in active]
    if idle:
        message = (
            f"{', '.join(idle)} is not active: bearings move in all directions; make the model "
            "one in space (Analyze > Set Analysis Options)"
        )
        raise row.error(message)


_POUND = 0.45359237 * STANDARD_GRAVITY

FORCES = {
    "N": 1.0,
    "KN": 1e3,
    "MN": 1e6,
    "KGF": STANDARD_GRAVITY,
    "TONF": 1e3 * STANDARD_GRAVITY,
    "TON": 1e3 * STANDARD_GRAVITY,  # metric, of ETABS 8 and 9: steel of 7.83 ton/m3
    "LB": _POUND,
    "KIP": 1e3 * _POUND,
}
"""Forces [N] by word."""

LENGTHS = {"MM": 1e-3, "CM": 1e-2, "M": 1.0, "IN": 0.0254, "FT": 0.3048}
"""Lengths [m] by word."""


@dataclass(frozen=True)
class Units:
    """Units of a file: force [N] and length [m]; time is in seconds, angles are in degrees."""

    force: float
    length: float

    one: ClassVar[float] = 1.0  # of values without a unit

    @cached_property
    def per_length(self) -> float:
        """Reciprocal of a length [1/m]."""
        return 1.0 / self.length

    @cached_property
    def area(self) -> float:
        """Area [m2]."""
        return self.length**2

    @cached_property
    def inertia(self) -> float:
        """Second moment of an area [m4]."""
        return self.length**4

    @cached_property
    def rotary(self) -> float:
        """Mass times length squared [kg m2]."""
        return self.mass * self.length**2

    @cached_property
    def moment(self) -> float:
        """Moment [N m]."""
        return self.force * self.length

    @cached_property
    def line(self) -> float:
        """Force per length, and stiffness [N/m]."""
        return self.force / self.length

    @cached_property
    def stress(self) -> float:
        """Force per area [Pa]."""
        return self.force / self.length**2

    @cached_property
    def weight(self) -> float:
        """Force per volume [N/m3]."""
        return self.force / self.length**3

    @cached_property
    def mass(self) -> float:
        """Mass: force over acceleration [kg]."""
        return self.force / self.length

    @cached_property
    def density(self) -> float:
        """Mass per volume [kg/m3]."""
        return self.mass / self.length**3


def units_of(words: str, name: str, error: Callable[[str], ValueError]) -> Units:
    """Return the units of a force and a length, "KN, m", or raise an error."""
    force, length, *_ = [*(word.strip().upper() for word in words.split(",")), ""]
    if force not in FORCES or length not in LENGTHS:
        message = (
            f'{name} = "{words}" must be a force of {", ".join(FORCES)} and a length of '
            f'{", ".join(LENGTHS)}, such as "KN, m, C"'
        )
        raise error(message)
    return Units(FORCES[force], LENGTHS[length])
