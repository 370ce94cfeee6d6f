"""Common part of all pages: templates, the language and its decimal sign, tables, figures."""

from __future__ import annotations

import base64
import re
import sys
import textwrap
from copy import copy
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import jinja2
import numpy as np
from markupsafe import Markup
from pandas.api.types import is_string_dtype

from frames.design._errors import ProjectError
from frames.design.report.tables import Table as Table
from frames.design.report.tables import rows_of
from lir_element.texts import Text

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import CodeType

    import pandas as pd
    from matplotlib.figure import Figure


LANGUAGES = ("en", "es")
"""Languages of reports; English is that of the sources."""

_CITED = r"(?:NCh ?\d+|EN \d[\d:-]*|ASCE(?:/SEI)? \d+-\d+|NTC \d+),? \d[\d.]*"  # clauses stay
_DECIMAL = re.compile(rf"({_CITED})|(?<![\w.,])(-?\d+)\.(\d+(?:e[+-]\d+)?)(?![\w.]|-\d)")
_LISTED = re.compile(r"(?<=[\d…]), (?=[-\d…])")
_HEAD = re.compile(r"(.*?)( \[[^]]*\])")
_MORE = 8  # letters that a line of a figure may have more than in English
_IN_MATH = re.compile(r"(?<=<mn>)[^<]*|(?<=<mtext>)[^<]*")


class Words:
    """Texts of a report in a language; a missing one raises a ProjectError."""

    def __init__(self, language: str = "en", decimal: str = ".", names: Iterable[str] = ()) -> None:
        if language not in LANGUAGES:
            msg = f"language = {language!r} is not a language of reports: choose one of {LANGUAGES}"
            raise ProjectError(msg)
        self.language, self.decimal = language, decimal
        self.missing: set[str] = set()
        self._names = frozenset(names)
        self._texts = {} if language == "en" else catalogue(language)

    def gettext(self, message: str) -> str:
        """Return a message in the language; one without a translation is noted and stays."""
        found = self._texts.get(" ".join(message.split()))
        if found is None and self.language != "en":
            self.missing.add(message)
        return found or message

    def ngettext(self, one: str, several: str, count: int) -> str:
        """Return a message of a template by number."""
        return self.gettext(one if count == 1 else several)

    def say(self, text: str) -> str:
        """Return a text of the program: its template with its values, each in the language."""
        if not isinstance(text, Text):
            return text if text in self._names else self.number(self._word(text))
        template = self.number(self.gettext(text.template))
        values = {
            name: value if f'"{{{name}}}"' in template else self._value(value)  # a name in quotes
            for name, value in text.values.items()
        }
        return template.format_map(values) if values else template

    def _value(self, value: str | float) -> object:
        return self.say(value) if isinstance(value, str) else _Number(value, self)

    def number(self, text: str) -> str:
        """Return a text with the decimal sign; clauses, versions and names stay as they are."""
        return _DECIMAL.sub(_with_comma, text) if self.decimal == "," else text

    def formula(self, mathml: str) -> Markup:
        """Return a formula with the decimal sign; lists of numbers then have semicolons."""
        if self.decimal == ",":
            mathml = _IN_MATH.sub(lambda found: self.number(_LISTED.sub("; ", found[0])), mathml)
        return Markup(mathml)  # noqa: S704  (of MathML that escapes what is in it)

    def cited(self, clause: str) -> str:
        """Return a clause: that of a standard with its points, in words if no code has it."""
        if not clause.startswith("no code"):
            return self._texts.get(clause, clause)
        as_it_is = copy(self)
        as_it_is.decimal = "."
        return as_it_is.say(clause)

    def table(self, table: Table, *, plain: Sequence[str] = ("clause",)) -> Table:
        """Return a table in the language."""
        kept = {k for k, title in enumerate(table.head) if title in plain}
        rows = [
            [
                self.cited(cell) if k in kept else self.say(self._listed(cell))
                for k, cell in enumerate(row)
            ]
            for row in table.rows
        ]
        return Table([self._word(title) for title in table.head], rows, table.left)

    def figure(self, figure: Figure) -> Figure:
        """Translate the texts of a figure into the language, in place; return the figure."""
        if self.language == "en" and self.decimal == ".":
            return figure
        from matplotlib.text import Text

        from frames.plots.plot_style import say_ticks

        for text in figure.findobj(Text):
            text.set_text(self._lines(text.get_text()))
        say_ticks(figure, self.say)
        return figure

    def _listed(self, cell: str) -> str:
        listed = self.decimal == "," and not isinstance(cell, Text)
        return _LISTED.sub("; ", cell) if listed else cell

    def _lines(self, text: str) -> str:
        # A text of a figure, which may have been broken into lines.
        lines = text.split("\n")
        if not isinstance(text, Text):
            whole = " ".join(lines)
            if whole not in self._texts:
                return "\n".join(self.say(line.strip()) for line in lines)
            text = whole
        width = max(map(len, lines)) + _MORE if len(lines) > 1 else sys.maxsize
        said = self.say(text).split("\n")
        return "\n".join(part for line in said for part in textwrap.wrap(line, width) or [""])

    def _word(self, text: str) -> str:
        # A text without values; of the head of a column all but its unit; names stay.
        if text in self._names:
            return text
        head = None if text in self._texts else _HEAD.fullmatch(text)
        return f"{self.gettext(head[1])}{head[2]}" if head else self.gettext(text)


def _with_comma(found: re.Match[str]) -> str:
    return found[1] or f"{found[2]},{found[3]}"


class _Number:
    """A number of a text, which is formatted with the decimal sign."""

    def __init__(self, value: float, words: Words) -> None:
        self._value, self._words = value, words

    def __format__(self, spec: str) -> str:
        return self._words.number(format(self._value, spec))


@cache
def catalogue(language: str) -> dict[str, str]:
    """Return the messages of a language by their English."""
    try:
        from babel.messages.pofile import read_po
    except ImportError as cause:
        msg = f'a report in {language!r} needs babel: pip install "lir-dcfp[cli]"'
        raise ProjectError(msg) from cause
    file = resources.files("frames.design.report") / "locale" / f"{language}.po"
    with file.open("rb") as opened:
        found = read_po(opened, locale=language)
    return {str(one.id): str(one.string) for one in found if one.id}


_DOTS = 110  # per inch


class Picture(NamedTuple):
    """A figure of a page."""

    title: str  # its contents
    source: str  # a data URI of a PNG file


class _Compiled(jinja2.BytecodeCache):
    # Templates that this process has compiled: the code is the same in each language.
    kept: ClassVar[dict[tuple[str, str], CodeType | None]] = {}

    def load_bytecode(self, bucket: jinja2.bccache.Bucket) -> None:
        bucket.code = self.kept.get((bucket.key, bucket.checksum))

    def dump_bytecode(self, bucket: jinja2.bccache.Bucket) -> None:
        self.kept[bucket.key, bucket.checksum] = bucket.code


def page_template(
    name: str, package: str = "frames.design.report", words: Words | None = None
) -> jinja2.Template:
    """Return the template of a page."""
    rooms = dict.fromkeys((package, "frames.design.report"))
    room = jinja2.Environment(
        loader=jinja2.ChoiceLoader([jinja2.PackageLoader(room, ".") for room in rooms]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        extensions=["jinja2.ext.i18n"],
        optimized=False,  # which would keep what filters make of constant texts
        bytecode_cache=_Compiled(),
    )
    room.policies["ext.i18n.trimmed"] = True
    said = words or Words()
    room.install_gettext_callables(said.gettext, said.ngettext, newstyle=True)  # type: ignore[attr-defined]  # of the extension
    room.filters |= {"said": said.say, "cited": said.cited}
    room.filters |= {"number": said.number, "formula": said.formula}
    return room.get_template(name)


def page_table(frame: pd.DataFrame, index: str) -> Table:
    """Return a table with its numbers as `rows_of` writes them; columns of words to the left."""
    words = [k for k, kind in enumerate(frame.dtypes, start=1) if is_string_dtype(kind)]
    return Table((index, *map(str, frame.columns)), rows_of(frame, _word), frozenset(words))


def picture(title: str, figure: Figure, words: Words | None = None) -> Picture:
    """Return a figure with its title, drawn, in a language; the figure is closed."""
    import matplotlib.pyplot as plt

    from frames.plots.plot_style import png_of

    if words is not None:
        title, figure = words.say(title), words.figure(figure)
    drawn = base64.b64encode(png_of(figure, _DOTS, tight=True)).decode("ascii")
    plt.close(figure)
    return Picture(title, f"data:image/png;base64,{drawn}")


def _word(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return "" if value is None else str(value)
