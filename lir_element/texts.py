"""Texts that keep their template and its values; small tables."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import reduce
from html import escape
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from typing import TypeAlias

    Value: TypeAlias = str | int | float


P = ParamSpec("P")
T = TypeVar("T")


class Text(str):
    """A finished text in English, with the template and the values that it is made of."""

    __slots__ = ("template", "values")

    template: str
    values: Mapping[str, Value]

    def __str__(self) -> Text:
        """Return it with its template and values: `str` would drop both."""
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _made, (self.template, self.values)

    def laid_out(self, finished: str) -> Text:
        """Return the same text with other spaces between its words: broken into lines."""
        text = Text(finished)
        text.template, text.values = self.template, self.values
        return text

    def plain(self) -> list[Any]:
        """Return template and values as JSON takes them: `text_from` reads it."""
        values = {k: v.plain() if isinstance(v, Text) else v for k, v in self.values.items()}
        return [self.template, values]


class TextWarning(UserWarning):
    """A warning whose `text` keeps template and values; its argument is the plain string."""

    def __init__(self, text: str) -> None:
        super().__init__(str.__str__(text))
        self.text = text


def worded(template: str, /, **values: object) -> str:
    """Return a text made of a template with places in braces, as of `str.format`."""
    return _made(template, {name: _value(value) for name, value in values.items()})


def joined(*parts: str, by: str = "; ") -> str:
    """Return the parts that are not empty, one after the other."""
    values = {f"part{k}": part for k, part in enumerate(filter(None, parts))}
    return worded(by.join(f"{{{name}}}" for name in values), **values)


def keeping_texts(make: Callable[P, T]) -> Callable[P, T]:
    """Keep texts with their templates in pandas tables of a function."""
    import pandas as pd

    made: Callable[P, T] = pd.option_context("mode.string_storage", "python")(make)
    return made


def text_from(plain: object) -> str:
    """Return a text from the output of `Text.plain`, through JSON or not; others unchanged."""
    if not isinstance(plain, list):
        return str(plain)
    template, values = plain
    return worded(
        template, **{k: text_from(v) if isinstance(v, list) else v for k, v in values.items()}
    )


def _made(template: str, values: Mapping[str, Value]) -> Text:
    text = Text(template.format_map(values) if values else template)
    text.template, text.values = template, values
    return text


def _value(value: object) -> Value:
    if isinstance(value, np.generic):
        value = value.item()
    return value if isinstance(value, (str, int, float)) else str(value)


def anded(parts: Iterable[str]) -> str:
    """Return names with "and" between each two."""
    return reduce(lambda one, other: worded("{one} and {other}", one=one, other=other), parts)


def first_of(text: str) -> str:
    """Return the first of the parts that `joined` put together."""
    return str(text.values.get("part0", text)) if isinstance(text, Text) else text


Rows = Sequence[Sequence[str]]


def text_table(rows: Rows, head: Sequence[str] = (), left: int = 1) -> str:
    """Return rows of cells as lines of text."""
    lines = [tuple(head), *map(tuple, rows)] if head else [tuple(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(
        "  ".join(
            f"{cell:<{wide}}" if k < left else f"{cell:>{wide}}"
            for k, (cell, wide) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


def html_table(title: str, rows: Rows, head: Sequence[str] = (), notes: Sequence[str] = ()) -> str:
    """Return a table as HTML, everything escaped."""

    def line(tag: str, cells: Sequence[str]) -> str:
        return (
            "<tr>"
            + "".join(f'<{tag} style="text-align: left">{escape(c)}</{tag}>' for c in cells)
            + "</tr>"
        )

    body = "".join(line("td", row) for row in rows)
    top = line("th", head) if head else ""
    below = "".join(f"<li>{escape(note)}</li>" for note in notes)
    listed = f"<ul>{below}</ul>" if notes else ""
    return f"<div><b>{escape(title)}</b><table>{top}{body}</table>{listed}</div>"


class Shown(ABC):
    """An object with a few rows to show."""

    @abstractmethod
    def _rows(self) -> list[tuple[str, str]]:
        """Return the rows: name and value."""

    def __repr__(self) -> str:
        """Return it on one line."""
        return f"{type(self).__name__}({', '.join(f'{k}: {v}' for k, v in self._rows() if v)})"

    def _repr_html_(self) -> str:
        """Return a table for notebooks."""
        return html_table(type(self).__name__, [row for row in self._rows() if row[1]])
