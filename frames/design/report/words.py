"""The language of a report and its decimal sign: texts, tables, formulas and figures."""

from __future__ import annotations

import re
import textwrap
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from markupsafe import Markup
from matplotlib.ticker import Formatter, NullFormatter

from frames.design._errors import ProjectError
from frames.design.report.tables import Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.figure import Figure

LANGUAGES = ("en", "es")
"""Languages of reports; English is that of the sources."""

_PLACE = re.compile(r"\{(\w+)\}")
_CITED = r"(?:NCh ?\d+|EN \d[\d:-]*|ASCE(?:/SEI)? \d+-\d+|NTC \d+),? \d[\d.]*"  # clauses stay
_DECIMAL = re.compile(rf"({_CITED})|(?<![\w.,])(-?\d+)\.(\d+(?:e[+-]\d+)?)(?![\w.]|-\d)")
_LISTED = re.compile(r"(?<=[\d…]), (?=[-\d…])")
_UNITS = r"mm|MPa|GPa|kN/m|kN/mm|s/m|m/s2?²?|kg|kg/m[23²³]"
_WORDLESS = "|".join(
    (
        r"\S*\d\S*",
        r"\S*_\S*",
        r"[^a-zA-Z\s]+",
        r"[a-zA-Z]{1,2}",
        r"[A-Z-]{2,}\S*",
        r"[+-][xyz]|[xyz][+-]",
        r"\S+\.md",
        r'"[^"]*"',  # a name of the user's
        r"\w+ ?= ?(?:\"[^\"]*\"|\{[^}]*\})",  # a key with its value
        r"\[[^\]]*\](?: [a-z_]+(?= |$))?",  # a section, and its key
        _UNITS,
    )
)
_NAME = re.compile(rf"(?:{_WORDLESS})(?: (?:{_WORDLESS}))*")
_MORE = 8  # letters that a line of a figure may have more than in English
_SENTENCES = 3  # of a message of the catalogue, at most; trying patterns on more takes long
_HEAD = re.compile(r"(.*?)( \[[^]]*\])$")
_COUNTED = re.compile(r"(\d+) (\D.*)")
_IN_MATH = re.compile(r"(?<=<mn>)[^<]*|(?<=<mtext>)[^<]*")


class Words:
    """Says texts of a report in a language.

    Raises
    ------
    ProjectError
        If there is no such language.
    """

    def __init__(self, language: str = "en", decimal: str = ".", names: Iterable[str] = ()) -> None:
        if language not in LANGUAGES:
            msg = f"language = {language!r} is not one of reports: choose one of {LANGUAGES}"
            raise ProjectError(msg)
        self.language, self.decimal = language, decimal
        self.missing: set[str] = set()
        self._names = frozenset(names)
        self._texts, self._patterns = ({}, ()) if language == "en" else catalogue(language)

    def gettext(self, message: str) -> str:
        """Return a message of a template in the language."""
        found = self._texts.get(" ".join(message.split()))
        if found is None and self.language != "en":
            self.missing.add(message)
        return found or message

    def ngettext(self, one: str, several: str, count: int) -> str:
        """Return a message of a template by number."""
        return self.gettext(one if count == 1 else several)

    def say(self, text: str) -> str:
        """Return a text that another part of the program made."""
        return self.number(self._said(text)) if text else text

    def number(self, text: str) -> str:
        """Return a text with the decimal sign; clauses, versions and names stay as they are."""
        return _DECIMAL.sub(_with_comma, text) if self.decimal == "," else text

    def formula(self, mathml: str) -> Markup:
        """Return a formula with the decimal sign; lists of numbers then have semicolons."""
        if self.decimal == ",":
            mathml = _IN_MATH.sub(lambda found: self.number(_LISTED.sub("; ", found[0])), mathml)
        return Markup(mathml)  # noqa: S704  (of MathML that escapes what is in it)

    def cited(self, clause: str) -> str:
        """Return a clause: that of a standard as it is, in words where no code has it."""
        return self._said(clause) if clause.startswith("no code") else clause

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
        return Table([self._said(title) for title in table.head], rows, table.left)

    def figure(self, figure: Figure) -> Figure:
        """Say the texts of a figure in the language, in place; return the figure."""
        if self.language == "en" and self.decimal == ".":
            return figure
        from matplotlib.text import Text

        for text in figure.findobj(Text):
            if words := text.get_text().strip():
                text.set_text(self._lines(words))
        for axes in figure.axes:
            third = getattr(axes, "zaxis", None)
            for axis in (axes.xaxis, axes.yaxis, *([third] if third else [])):
                axis.set_major_formatter(self._ticks(axis.get_major_formatter()))
                axis.set_minor_formatter(self._ticks(axis.get_minor_formatter()))
        return figure

    def _ticks(self, inner: Formatter) -> Formatter:
        return inner if isinstance(inner, NullFormatter) else _Said(inner, self)

    def _listed(self, cell: str) -> str:
        return _LISTED.sub("; ", cell) if self.decimal == "," else cell

    def _lines(self, text: str) -> str:
        # A text of a figure, which may have been broken into lines; else line by line.
        whole, lines = " ".join(text.split()), text.split("\n")
        each = [self._known(line.strip()) for line in lines]
        said = None if None not in each else self._known(whole)
        if said is None:
            return "\n".join(self.number(self._said(line.strip())) for line in lines)
        width = max(map(len, lines)) + _MORE
        return self.number("\n".join(textwrap.wrap(said, width)) if len(lines) > 1 else said)

    def _said(self, text: str) -> str:
        sentences = text.split("; ")
        if len(sentences) > _SENTENCES:
            return "; ".join(self._said(part) for part in sentences)
        found = self._known(text)
        if found is not None:
            return found
        if len(sentences) > 1:
            return "; ".join(self._said(part) for part in sentences)
        self.missing.add(text)
        return text

    def _known(self, text: str) -> str | None:
        # A text in the language, None where it is not known.
        if self.language == "en" or text in self._names:
            return text
        if text in self._texts:
            return self._texts[text]
        if not text or _NAME.fullmatch(text):
            return text
        for pattern, translated in self._patterns:
            if found := pattern.fullmatch(text):
                parts = {key: self._known(part) for key, part in found.groupdict().items()}
                if None not in parts.values():
                    return translated.format(**parts)
        if found := _HEAD.fullmatch(text):
            name = self._known(found[1])
            return None if name is None else f"{name}{found[2]}"
        found = _COUNTED.fullmatch(text)
        if found and (rest := self._known(found[2])) is not None:
            return f"{found[1]} {rest}"
        for sign in ("; ", ", "):
            if sign in text:
                several = [self._known(part) for part in text.split(sign)]
                return None if None in several else sign.join(map(str, several))
        return None


def _with_comma(found: re.Match[str]) -> str:
    return found[1] or f"{found[2]},{found[3]}"


class _Said(Formatter):
    """Labels of an axis in the language."""

    def __init__(self, inner: Formatter, words: Words) -> None:
        super().__init__()
        self._inner, self._words = inner, words

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self._inner.set_axis(axis)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._words.say(str(self._inner(x, pos)))

    def format_ticks(self, values: Any) -> list[str]:
        return [self._words.say(text) for text in self._inner.format_ticks(values)]

    def set_locs(self, locs: Any) -> None:
        self._inner.set_locs(locs)

    def get_offset(self) -> str:
        return self._words.say(str(self._inner.get_offset()))


@cache
def catalogue(
    language: str,
) -> tuple[dict[str, str], tuple[tuple[re.Pattern[str], str], ...]]:
    """Return the messages of a language."""
    try:
        from babel.messages.pofile import read_po
    except ImportError as cause:
        msg = f'a report in {language!r} needs babel: pip install "lir-dcfp[cli]"'
        raise ProjectError(msg) from cause
    file = resources.files("frames.design.report") / "locale" / f"{language}.po"
    with file.open("rb") as opened:
        messages = read_po(opened, locale=language)
    texts, patterns = {}, []
    for message in messages:
        source, said = str(message.id), str(message.string)
        if not source or not said:
            continue
        if _PLACE.search(source):
            parts = _PLACE.split(source)
            made = "".join(
                f"(?P<{part}>.+?)" if k % 2 else re.escape(part) for k, part in enumerate(parts)
            )
            order = bool(parts[0]), len("".join(parts[::2]))
            patterns.append((order, re.compile(made), said))
        else:
            texts[source] = said
    patterns.sort(key=lambda each: each[0], reverse=True)
    return texts, tuple((pattern, said) for _, pattern, said in patterns)
