"""Calls that must fail: the kind of the error, and words of its message; texts with errors."""

import random
from collections.abc import Callable, Sequence

import pytest


def refused(kind: type[Exception], words: str, call: Callable[..., object], /, *args, **options):
    """Return the error of a call, whose message holds the words (a regular expression)."""
    with pytest.raises(kind, match=words) as caught:
        call(*args, **options)
    return caught.value


def mutated(seed: int, text: str, junk: Sequence[str]) -> str:
    """Return a text with one to three random errors: in lines, or in letters by junk."""
    rng = random.Random(seed)  # noqa: S311
    lines = text.splitlines()
    for _ in range(rng.randint(1, 3)):
        k = rng.randrange(len(lines))
        how = rng.randrange(7)
        if how == 0:
            del lines[k]
        elif how == 1:
            lines.insert(k, lines[rng.randrange(len(lines))])
        elif how == 2:
            lines[k] = lines[k][: rng.randint(0, len(lines[k]))]
        elif how == 3:
            lines = lines[: k + 1]
        elif lines[k]:
            at = rng.randrange(len(lines[k]))
            lines[k] = lines[k][:at] + rng.choice(junk) + lines[k][at + (how > 4) :]
    return "\n".join(lines)
