"""The block that a guard and its thread of compiled code share."""

from __future__ import annotations

from typing import Any, TypeAlias

from lir_element.layout import Field, dtype_of
from lir_element.opensees.block.layout import MOST_DOFS

MOST_CHANNELS = 1024
"""Bearings that can be served at a time by out-of-process coupling."""

GUARD_FIELDS = (
    Field("pipe", "-", "", "file descriptor of the pipe to the server; -1: none", (), "i8"),
    Field("stop", "-", "", "file descriptor that ends the thread when written to", (), "i8"),
    Field("channels", "-", "", "descriptors, and words of an answer", (MOST_CHANNELS, 2), "i8"),
    Field("polled", "-", "", "what `poll` reads and writes", (MOST_CHANNELS + 1,), "i8"),
    Field("answer", "-", "", "an answer: not a number", (MOST_DOFS * MOST_DOFS,)),
    Field("inbox", "-", "", "what is thrown away", (MOST_DOFS * MOST_DOFS,)),
    Field("message", "", "", "address of what the user is told", (), "i8"),
    Field("message_size", "-", "", "its length", (), "i8"),
    Field(
        "hinted", "", "", "address of a word: 1 keeps a failed step from being explained", (), "i8"
    ),
    Field("receive_flags", "-", "", "of `recv`: do not wait", (), "i8"),
    Field("send_flags", "-", "", "of `send`: do not wait, no signal", (), "i8"),
    Field("poll", "", "", "addresses of the system's functions", (), "i8"),
    Field("recv", "", "", "", (), "i8"),
    Field("send", "", "", "", (), "i8"),
    Field("write", "", "", "", (), "i8"),
)

GUARD = dtype_of(GUARD_FIELDS)

GuardBlock: TypeAlias = Any
"""One record of dtype GUARD."""
