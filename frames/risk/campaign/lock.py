"""One campaign at a time on each results database: a lock of the extra `campaign`."""

from __future__ import annotations

import json
import os
import socket
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib.util import find_spec
from typing import TYPE_CHECKING

from frames.results.storage import write_whole
from frames.risk._errors import CampaignError

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path


def lacking_packages(*needed: str) -> str:
    """Return what is missing and how to install it, in a sentence; nothing where all is there."""
    missing = [name for name in needed or ("filelock",) if find_spec(name) is None]
    if not missing:
        return ""
    return f"campaigns need {' and '.join(missing)}: pip install 'lir-dcfp[campaign]'"


@contextmanager
def locked(path: Path) -> Generator[None, None, None]:
    """Hold a lock file; that of a process that has died is seized.

    The system lets go of it when its process ends. Who holds it stands in a file beside it, which
    others can read on every system.
    """
    from filelock import FileLock, Timeout

    lock, note = FileLock(path), path.with_name(f"{path.name}-holder.json")
    try:
        lock.acquire(timeout=0)
    except Timeout as cause:
        msg = (
            f"{path.parent} is in use by {_holder(note)}: wait until it has ended, or name another "
            "folder"
        )
        raise CampaignError(msg) from cause
    try:
        began = datetime.now(UTC).isoformat(timespec="seconds")
        known = {"pid": os.getpid(), "host": socket.gethostname(), "since": began}
        write_whole(note, json.dumps(known).encode())
        yield
    finally:
        note.unlink(missing_ok=True)
        lock.release()


def _holder(note: Path) -> str:
    try:
        known = json.loads(note.read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError):  # it has just begun, or just ended
        return "another process"
    return f"process {known['pid']} on {known['host']} since {known['since']}"
