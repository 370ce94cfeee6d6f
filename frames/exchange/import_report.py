"""An import: its options, and the account of objects read, read otherwise and left out."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Generator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Literal, TypeAlias

from frames._errors import ModelError, argument
from frames._progress_line import ProgressLine
from lir_element._compile.progress import quiet
from lir_element.argument_checks import require_choice, require_positive, require_type
from lir_element.texts import joined, text_table, worded

if TYPE_CHECKING:
    from pathlib import Path

    from frames.exchange.tables import Decimal, Row, Tables
    from frames.model.sections import Section
    from lir_element import LIRBearing

BaseRotations: TypeAlias = Literal["kept", "free", "fixed"]
"""Rotations of joints on bearings about horizontal axes."""

Bearings: TypeAlias = "LIRBearing | Mapping[str, LIRBearing] | None"
"""One device, devices by group, joint, link or link property, or supports as they are."""


@dataclass(frozen=True)
class Options:
    """Options of an import, as in `Frame.from_sap2000` and `Frame.from_etabs`."""

    bearing: Bearings = None
    at: Sequence[str] | None = None
    loads: Mapping[str, float] | str | None = None
    mass: Mapping[str, float] | None = None
    mesh: float = 1.25
    base_rotations: BaseRotations = "kept"
    base_diaphragm: bool = True
    allow: Collection[str] = ()
    decimal: Decimal = "."
    sections: Mapping[str, Section] | None = None
    library: str | Path | Sequence[str | Path] = ()

    def __post_init__(self) -> None:
        """Check the options that do not depend on the file."""
        choices = ("kept", "free", "fixed")
        require_choice("base_rotations", self.base_rotations, choices, error=ModelError)
        require_positive("mesh [m]", self.mesh, remedy="give metres", error=ModelError)
        kinds = (Mapping, str, type(None))
        require_type(
            "loads", self.loads, kinds, "factors by load pattern, or the name of one combination"
        )
        require_type("mass", self.mass, (Mapping, type(None)), "shares by load pattern")
        if isinstance(self.at, str):
            message = f'at = "{self.at}" must be a list of names: write ["{self.at}"]'
            raise TypeError(message)
        if self.at is not None and (self.bearing is None or isinstance(self.bearing, Mapping)):
            message = "at needs one bearing: pass one LIRBearing, or a mapping without at"
            raise ModelError(message)


READ, READ_AS, LEFT_OUT = "read", "read as something else", "left out"
"""Treatment of objects of a file."""


@dataclass(frozen=True)
class Entry:
    """Objects of one table with the same treatment."""

    fate: str  # READ, READ_AS or LEFT_OUT
    table: str
    what: str  # the objects, and their treatment
    count: int
    names: tuple[str, ...] = ()  # some of them
    weight: float | None = None  # represented share of the own weight [-]
    stiffness: float | None = None  # the same of modulus times volume of all elements [-]


class ImportReport:
    """Treatment of all objects of a file; `allow` has keys of objects that may be left out."""

    SHOWN = 6
    REASONS = 12

    def __init__(self, file: str, allow: Collection[str] = ()) -> None:
        if isinstance(allow, str):
            message = f'allow = "{allow}" must be a list of names: write ["{allow}"]'
            raise TypeError(message)
        self.file, self.allow = file, frozenset(allow)
        self.entries: list[Entry] = []
        self.groups: dict[str, tuple[str, ...]] = {}  # joints and links by group
        self.doubts: list[str] = []  # probable mistakes, for warnings
        self._line, self._began = ProgressLine(), perf_counter()
        self._used: set[str] = set()
        self._faults: dict[str, None] = {}  # unreadable objects, in words
        # places and names of objects that `allow` could accept, by its key and their kind
        self._refused: dict[tuple[str, str], tuple[str, list[str]]] = {}

    def __str__(self) -> str:
        """Return the account as a table, for people."""
        return self.text()

    def doing(self, what: str, *, ends: bool = False) -> None:
        """Report the present step of a long import on the standard error."""
        elapsed = perf_counter() - self._began
        if not quiet() and not (ends and not self._line.is_open):
            text = f"{self.file}: {what}" + (f", {elapsed:.0f} s" if ends else "")
            self._line.write(text, elapsed, ends=ends)

    def read(self, table: str, what: str, count: int) -> None:
        """Record objects read as they are; no entry for zero."""
        if count:
            self.entries.append(Entry(READ, table, what, count))

    def read_as(self, table: str, what: str, names: Collection[str], *shares: float | None) -> None:
        """Record objects read as something else; no entry for zero.

        `shares` are those of the weight and of the stiffness [-].
        """
        self._add(READ_AS, table, what, names, *shares)

    def left_out(self, table: str, what: str, names: Collection[str]) -> None:
        """Record objects left out without effect on the answer; no entry for zero."""
        self._add(LEFT_OUT, table, what, names)

    def unknown(self, fields: Collection[tuple[str, str, Row, int]]) -> None:
        """Warn of unknown fields of known tables, once for each table."""
        for table in dict.fromkeys(table for table, *_ in fields):
            found = {
                _of_line(f'{field} = "{row.values[field]}"', row.line, count): row
                for name, field, row, count in fields
                if name == table
            }
            self.left_out(table, "words that are not known here", list(found))
            self.doubts.append(
                worded(
                    "{file}, {table}: unknown words were not read: {words}. Check in that "
                    "program if they change the model; if so, model it without them",
                    file=self.file,
                    table=table,
                    words=self.some(found),
                )
            )

    def refuse(
        self, key: str, table: str, what: str, names: Collection[str], place: str = ""
    ) -> None:
        """Record objects whose loss would change the answer; `settle` raises unless allowed."""
        if not names:
            return
        if key not in self.allow:
            where = place or f'{self.file}, table "{table}"'
            self._refused.setdefault((key, what), (where, []))[1].extend(names)
            return
        self._used.add(key)
        self._add(
            LEFT_OUT,
            table,
            worded('{what}; accepted by allow = "{key}"', what=what, key=key),
            names,
        )

    def fault(self, message: str) -> None:
        """Record an unreadable object in words; `settle` raises it with the others."""
        self._faults.setdefault(message)

    @contextlib.contextmanager
    def noting(self) -> Generator[None, None, None]:
        """Record an error of one object, and go on."""
        try:
            yield
        except ModelError as error:
            self.fault(str(error))

    @contextlib.contextmanager
    def together(self) -> Generator[None, None, None]:
        """Raise an error with all that was noted before."""
        try:
            yield
        except ModelError as error:
            if not self._faults and not self._refused:
                raise
            self.fault(str(error))
            self.settle()

    def settle(self) -> None:
        """Raise all that was noted and refused, in one message."""
        found = list(self._faults)
        for (_, what), (place, names) in self._refused.items():
            found.append(f"{place}: {what} ({self.some(dict.fromkeys(names))})")
        keys = dict.fromkeys(key for key, _ in self._refused)
        self._faults.clear()
        self._refused.clear()
        if not found:
            return
        accept = f"or accept it by {argument('allow', sorted({*self.allow, *keys}))}"
        if len(found) == 1:
            out = f" would change the answer if left out: take it out of the model, {accept}"
            raise ModelError(found[0] + (out if keys else ""))
        lines = [f"{self.file} cannot be read, for {len(found)} reasons:"]
        lines += [f"({k}) {reason}" for k, reason in enumerate(found[: self.REASONS], start=1)]
        if len(found) > self.REASONS:
            lines.append(f"and {len(found) - self.REASONS} more")
        if keys:
            lines.append(
                f"If left out, {joined(*keys, by=', ')} would change the answer: take them out of "
                f"the model, {accept}"
            )
        raise ModelError("\n".join(lines))

    def finish(self) -> None:
        """Raise if `allow` names an object that the file does not have."""
        self.settle()
        idle = sorted(self.allow - self._used)
        if idle:
            message = f'{self.file}: allow has "{idle[0]}", but the file has none of it: remove it'
            raise ModelError(message)

    def some(self, names: Collection[str], count: int | None = None) -> str:
        """Return the first names of many, and how many more there are."""
        shown = [str(name) for name in list(names)[: self.SHOWN]]
        more = (len(names) if count is None else count) - len(shown)
        first = joined(*shown, by=", ")
        return worded("{names} and {count} more", names=first, count=more) if more else first

    def rows(self) -> list[tuple[str, str, str, str, str, str]]:
        """Return rows of text: treatment, table, objects, count, weight share, stiffness share."""
        order = (LEFT_OUT, READ_AS, READ)
        return [
            (
                entry.fate,
                entry.table,
                worded(
                    "{what}: {names}", what=entry.what, names=self.some(entry.names, entry.count)
                )
                if entry.names
                else entry.what,
                str(entry.count),
                _share(entry.weight),
                _share(entry.stiffness),
            )
            for fate in order
            for entry in self.entries
            if entry.fate == fate
        ]

    def text(self) -> str:
        """Return the account as a table, for people."""
        head = ("", "table", "what", "count", "of weight", "of stiffness")
        return f"import of {self.file}\n" + text_table([head, *self.rows()], left=3)

    def _add(
        self, fate: str, table: str, what: str, names: Collection[str], *shares: float | None
    ) -> None:
        if not names:
            return
        first, count = tuple(map(str, names)), len(names)
        before = self.entries[-1] if self.entries else None
        if before is not None and (fate, table, what) == (before.fate, before.table, before.what):
            first, count = before.names + first, before.count + count
            self.entries.pop()
        self.entries.append(Entry(fate, table, what, count, first[: self.SHOWN], *shares))


def judge_rest(
    tables: Tables,
    account: ImportReport,
    refused: Collection[tuple[str, str, str]],
    known: Mapping[str, str],
    objects: tuple[str, ...] = (),
    harmless: tuple[str, ...] = (),
    row_word: str = "rows",
) -> None:
    """Refuse or note the tables of a file that nobody read, by the beginnings of their names."""
    other = [(start, "other tables", "a table that is not known here") for start in objects]
    for name, count in tables.unread().items():
        which = refused if name.startswith(harmless) else [*refused, *other]
        found = next((each for each in which if name.startswith(each[0])), None)
        if found is not None:
            row, (_, key, what) = tables.rows(name)[0], found
            first = str(next(iter(row.values.values()), ""))
            account.refuse(
                key, row.table, joined(what, f"{count} {row_word}", by=", "), [first], row.place
            )
    account.unknown(tables.unknown(known))
    rest = [f"{name} ({count})" for name, count in tables.unread().items()]
    table = "other lines" if row_word == "lines" else "other tables"
    what = worded("what the linear model does not need, with their {rows}", rows=row_word)
    account.left_out(table, what, rest)


def _of_line(word: str, line: int, count: int) -> str:
    if count > 1:
        return worded(
            "{word} (line {line} and {count} more)", word=word, line=line, count=count - 1
        )
    return worded("{word} (line {line})", word=word, line=line)


def _share(value: float | None) -> str:
    return "" if value is None else f"{value:.1%}"
