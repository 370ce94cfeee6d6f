"""Source of a value: read in the standard, agreeing with a public text, or from memory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from frames.design._errors import CheckError
from lir_element.argument_checks import require_choice, require_type

Kind = Literal["read", "agrees", "memory", "own"]

_WORDS: dict[Kind, str] = {
    "read": "read in the standard:",
    "agrees": "agrees with",
    "memory": "from memory, to be confirmed against the standard",
    "own": "no value of a code",
}
STAR = "*"
"""Mark behind clauses whose source is "from memory", and only behind those."""


@dataclass(frozen=True)
class Standing:
    """Source of a value, or of the limit of a check.

    Parameters
    ----------
    kind : {"read", "agrees", "memory", "own"}
        Kind of source: read in the text of the standard; agreement with a public text that has the
        same value; from memory, to be confirmed against the standard; or no code (mechanics, this
        package or the project).
    source : str
        Edition and clause of the standard, or the public text with article or section; empty for
        the other two kinds.

    Raises
    ------
    CheckError, TypeError
        If the kind is unknown, or its source is missing or not allowed.

    Examples
    --------
    >>> from frames.design import Standing
    >>> print(Standing("agrees", "UFC 3-310-03A"))
    agrees with UFC 3-310-03A
    >>> Standing("memory").cited("ASCE 7-22 17.8.4")
    'ASCE 7-22 17.8.4 *'
    """

    kind: Kind
    source: str = ""

    def __post_init__(self) -> None:
        require_choice("standing", self.kind, get_args(Kind), error=CheckError)
        require_type("source", self.source, str, "a text")
        needed = self.kind in {"read", "agrees"}
        if needed and not self.source.strip():
            what = "edition and clause" if self.kind == "read" else "the public text"
            msg = f"a standing {self.kind!r} needs a source: name {what}"
            raise CheckError(msg)
        if not needed and self.source:
            msg = (
                f"a standing {self.kind!r} must have no source, not {self.source!r}: leave "
                "source out"
            )
            raise CheckError(msg)

    @property
    def starred(self) -> bool:
        """True if clauses have a star: the value is from memory alone."""
        return self.kind == "memory"

    @property
    def words(self) -> str:
        """Kind of source in words."""
        return _WORDS[self.kind]

    def cited(self, clause: str) -> str:
        """Return a clause as tables show it: with a star if it is from memory."""
        return f"{clause} {STAR}" if self.starred else clause

    def __str__(self) -> str:
        """Return it in words, as tables and files have it."""
        return f"{self.words} {self.source}".strip()


FROM_MEMORY = Standing("memory")
"""The weakest source: the default."""

PROJECT = Standing("own")
"""Source of values without a code: mechanics, proposals of this package, limits of the project."""

LEGEND = f"clauses, formulas and factors with a star: {FROM_MEMORY}"
"""Meaning of the star, under tables."""


def standing_of(text: str) -> Standing:
    """Return the standing that a table has in words."""
    for kind, words in _WORDS.items():
        if text == words or text.startswith(f"{words} "):
            return Standing(kind, text.removeprefix(words).strip())
    msg = f"standing {text!r} must begin with one of {tuple(_WORDS.values())}"
    raise CheckError(msg)
