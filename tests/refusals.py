"""Calls that must fail: the kind of the error, and words of its message."""

from collections.abc import Callable

import pytest


def refused(kind: type[Exception], words: str, call: Callable[..., object], /, *args, **options):
    """Return the error of a call, whose message holds the words (a regular expression)."""
    with pytest.raises(kind, match=words) as caught:
        call(*args, **options)
    return caught.value
