"""Rows of a table of members in a CSV file: cells with their units, ranges of storeys."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from frames._csv import csv_lines
from frames.design._errors import ProjectError
from frames.design.project.quantities import si
from frames.exchange.tables import Row

if TYPE_CHECKING:
    from pathlib import Path

    from frames.exchange.tables import Value

_HEAD = re.compile(r"\s*([a-z_]+)\s*(?:\[\s*([^]]+?)\s*\])?\s*")  # x [m]
_RANGE = re.compile(r"(\d+)(?:\s*(?:-|to)\s*(\d+))?")


class CsvRow(Row):
    """A row of a table: texts by column, with the unit of the head where it has one."""

    __slots__ = ()

    refusal = ProjectError
    remedy = "give it"

    def length(self, key: str) -> float:
        """Return a cell that is a length [m], or raise a ProjectError."""
        given = self.text(key)
        try:
            return si(given, "m", "6.5 m")
        except ValueError as cause:
            msg = f'{key} = "{given}" {cause}, or head it "{key} [m]"'
            raise self.error(msg) from cause

    def choice(self, key: str, choices: Sequence[str]) -> str | None:
        """Return a cell that is one of some words, None if it is empty, or raise."""
        given = self.text(key, "") or None
        if given is not None and given not in choices:
            known = ", ".join(f'"{each}"' for each in choices)
            msg = f'{key} = "{given}" is not known: choose one of {known}'
            raise self.error(msg)
        return given

    def span(self, key: str, least: int, most: int) -> range:
        """Return a cell such as "2" or "1-3" as a range; empty is all from least to most."""
        given = self.text(key, "")
        if not given:
            return range(least, most + 1)
        found = _RANGE.fullmatch(given)
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (1, 0)
        if not least <= first <= last <= most:
            msg = (
                f'{key} = "{given}" must be a number or a range such as "{least}-{most}", from '
                f"the lower to the upper, within {least} to {most}"
            )
            raise self.error(msg)
        return range(first, last + 1)


def csv_rows(path: Path, needed: Sequence[str], other: Sequence[str] = ()) -> list[CsvRow]:
    """Return the rows of a table."""
    try:
        lines = csv_lines(path)
    except OSError as cause:
        msg = f"{path}: {cause.strerror or cause}: give a CSV file with {', '.join(needed)}"
        raise ProjectError(msg) from cause
    except ValueError as cause:
        msg = f"{path}: {cause}"
        raise ProjectError(msg) from cause
    heads = [_HEAD.fullmatch(head.lower()) for head in (lines[0][1] if lines else [])]
    names = [found[1] if found else "" for found in heads]
    units = [found[2] if found else None for found in heads]
    _require_heads(path, names, lines[0][1] if lines else [], needed, other)
    rows = []
    for number, line in lines[1:]:
        cells: dict[str, Value] = {
            name: f"{cell.strip()} {unit}" if unit else cell.strip()
            for name, unit, cell in zip(names, units, line, strict=False)
            if cell.strip()
        }
        if len(line) > len(names):
            msg = f"{path}, line {number}: has {len(line)} cells, its head {len(names)}"
            msg += ": look for a comma in a number, which needs semicolons between the cells"
            raise ProjectError(msg)
        if cells:
            rows.append(CsvRow(path.name, "", number, cells))
    if not rows:
        msg = f"{path} has no rows: give one for each member, with {', '.join(needed)}"
        raise ProjectError(msg)
    return rows


def _require_heads(
    path: Path, names: list[str], heads: list[str], needed: Sequence[str], other: Sequence[str]
) -> None:
    known = (*needed, *other)
    for name, head in zip(names, heads, strict=True):
        if name not in known:
            near = difflib.get_close_matches(head.lower(), known, n=1)
            meant = f'is "{near[0]}" meant?' if near else f"it has {', '.join(known)}"
            msg = f'{path}: column "{head}" is not known: {meant}'
            raise ProjectError(msg)
        if names.count(name) > 1:
            msg = f'{path}: column "{name}" is there twice: keep one of them'
            raise ProjectError(msg)
    for name in needed:
        if name not in names:
            msg = f'{path}: column "{name}" is missing: the head is {",".join(known)}'
            raise ProjectError(msg)
