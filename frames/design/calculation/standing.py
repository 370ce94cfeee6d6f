"""How well a value is known: read in the standard, agreeing with a public text, or from memory."""

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
"""Stands behind clauses whose standing is "from memory", and only behind those."""


@dataclass(frozen=True)
class Standing:
    """How well a value, or the limit of a check, is known.

    Parameters
    ----------
    kind : {"read", "agrees", "memory", "own"}
        Read in the text of the standard; agrees with a public text that has the same value; from
        memory, to be confirmed against the standard; or no value of a code: of mechanics, of this
        package or of the project.
    source : str
        Edition and clause where it was read, or the public text, with article or section, that it
        agrees with; empty of the other two.

    Raises
    ------
    CheckError, TypeError
        If there is no such kind, or it has no source where it needs one, or has one that it must
        not have.

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
            msg = f"a standing {self.kind!r} has no source: name {what}"
            raise CheckError(msg)
        if not needed and self.source:
            msg = f"a standing {self.kind!r} has no source, {self.source!r} was given: leave it out"
            raise CheckError(msg)

    @property
    def starred(self) -> bool:
        """Whether clauses have a star: what is from memory alone."""
        return self.kind == "memory"

    @property
    def words(self) -> str:
        """What it says without its source."""
        return _WORDS[self.kind]

    def cited(self, clause: str) -> str:
        """Return a clause as tables show it: with a star where it is from memory."""
        return f"{clause} {STAR}" if self.starred else clause

    def __str__(self) -> str:
        """Return it in words, as tables and files have it."""
        return f"{self.words} {self.source}".strip()


FROM_MEMORY = Standing("memory")
"""The weakest: of all that nobody said more of."""

PROJECT = Standing("own")
"""Of what no code has: mechanics, proposals of this package, limits of the project."""

LEGEND = f"clauses, formulas and factors with a star: {FROM_MEMORY}"
"""What the star means, under tables."""


def standing_of(text: str) -> Standing:
    """Return the standing that a table has in words."""
    for kind, words in _WORDS.items():
        if text == words or text.startswith(f"{words} "):
            return Standing(kind, text.removeprefix(words).strip())
    msg = f"standing {text!r} must begin with one of {tuple(_WORDS.values())}"
    raise CheckError(msg)
