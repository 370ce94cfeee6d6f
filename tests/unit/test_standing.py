"""The standing of values: three kinds of a code's, and what no code has; its star in all tables."""

from __future__ import annotations

from dataclasses import replace

import pytest

from frames.design import Check, CheckError, Checks
from frames.design.calculation.standing import FROM_MEMORY, LEGEND, PROJECT, Standing, standing_of

READ = Standing("read", "EN 1998-1:2004, 3.2.2.2")
AGREES = Standing("agrees", "UFC 3-310-03A")
DRIFT = Check(clause="EN 1998 10.7", title="storey drift", demand=1.0, limit=2.0)


@pytest.mark.parametrize(
    ("standing", "words"),
    [
        (READ, "read in the standard: EN 1998-1:2004, 3.2.2.2"),
        (AGREES, "agrees with UFC 3-310-03A"),
        (FROM_MEMORY, "from memory, to be confirmed against the standard"),
        (PROJECT, "no value of a code"),
    ],
)
def test_words_are_read_again(standing: Standing, words: str) -> None:
    assert str(standing) == words
    assert standing_of(words) == standing
    assert standing.starred == (standing == FROM_MEMORY)


def test_the_star_means_what_is_from_memory() -> None:
    assert LEGEND.endswith(str(FROM_MEMORY))


@pytest.mark.parametrize(
    ("kind", "source", "said"),
    [
        ("sure", "", "standing = 'sure'"),
        ("read", "", "name edition and clause"),
        ("agrees", " ", "name the public text"),
        ("memory", "a book", "not 'a book': leave source out"),
        ("own", "a book", "leave source out"),
    ],
)
def test_a_standing_that_says_nothing_is_refused(kind: str, source: str, said: str) -> None:
    with pytest.raises(CheckError, match=said):
        Standing(kind, source)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["confirmed", "", "agreeswith UFC", "memory"])
def test_words_of_none_are_refused(text: str) -> None:
    with pytest.raises(CheckError, match=r"begin with one of|has no source"):
        standing_of(text)


def test_a_check_of_which_nothing_is_said_is_from_memory() -> None:
    assert DRIFT.standing == FROM_MEMORY
    with pytest.raises(TypeError, match="a Standing"):
        replace(DRIFT, standing="confirmed")  # type: ignore[arg-type]


@pytest.mark.parametrize("standing", [READ, AGREES, FROM_MEMORY, PROJECT])
def test_tables_of_checks_have_star_and_words(standing: Standing) -> None:
    checks = Checks([replace(DRIFT, standing=standing)])
    stars = standing == FROM_MEMORY
    assert ("EN 1998 10.7 *" in str(checks)) == stars
    assert ("EN 1998 10.7 *" in checks._repr_html_()) == stars
    assert checks.to_dataframe()["standing"].tolist() == [str(standing)]
