"""Reads the text of an ETABS model (.e2k, .$et): sections that begin with $, lines of words.

A line is a word, its positional values, then words with values; lines of one object add up.
Sources of the format: docs/exchange.md.
"""

from __future__ import annotations

import re
from pathlib import Path

from frames._errors import ModelError
from frames.exchange.etabs_fields import ALIASES, NAMES
from frames.exchange.s2k_text import read_text
from frames.exchange.tables import Decimal, Row, Tables, Value

_TOKEN = re.compile(r'"([^"]*)"|([^\s"]+)')
END = "$ END OF MODEL FILE"
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
            ended = ended or text.upper().startswith(END)
            begun = begun or section.upper().startswith("PROGRAM INFORMATION")
            continue
        if section.upper().startswith(("LOG", "END OF MODEL FILE")) or not section:
            continue
        if text.upper() == "END":  # before the last line
            continue
        _add(tables, _row(name, section, line, text, decimal))
    if not begun:
        message = (
            f"{name} is no ETABS text file: it has no section $ PROGRAM INFORMATION; export the "
            "model with File > Export > ETABS Text File"
        )
        raise ModelError(message)
    if not ended:
        message = (
            f'{name} ends in section "{section}" without the line {END}: it is cut off, export '
            "it again; where it is whole, add that line at its end"
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
    # A word without quotes, and the value after it; a word that comes again adds to a list, and
    # text where a word should be stands by itself.
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
