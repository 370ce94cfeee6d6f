"""One campaign at a time on a database: a lock that the system lets go of when its process ends."""

from __future__ import annotations

import json
import os
import socket
import sys
from contextlib import contextmanager
from datetime import UTC, datetime
from typing import IO, TYPE_CHECKING

from frames.risk._errors import CampaignError

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

_BYTE = 1 << 30  # that Windows locks: far behind the text, which others may read


@contextmanager
def locked(path: Path) -> Generator[None, None, None]:
    """Hold a lock file; that of a process that has died is seized.

    Parameters
    ----------
    path : Path
        The file, which stays.

    Yields
    ------
    None
        While it is held.

    Raises
    ------
    CampaignError
        If another process, or another part of this one, holds it.
    """
    with path.open("a+", encoding="utf-8") as file:
        try:
            _take(file)
        except OSError as cause:
            file.seek(0)
            msg = (
                f"{path.parent} is in use by {_holder(file.read())}: wait until it has ended, or "
                "name another folder"
            )
            raise CampaignError(msg) from cause
        file.truncate(0)
        began = datetime.now(UTC).isoformat(timespec="seconds")
        json.dump({"pid": os.getpid(), "host": socket.gethostname(), "since": began}, file)
        file.flush()
        try:
            yield
        finally:
            file.truncate(0)


def _holder(text: str) -> str:
    try:
        known = json.loads(text)
    except json.JSONDecodeError:
        return "another process"
    return f"process {known['pid']} on {known['host']} since {known['since']}"


if sys.platform == "win32":
    import msvcrt

    def _take(file: IO[str]) -> None:
        file.seek(_BYTE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _take(file: IO[str]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
