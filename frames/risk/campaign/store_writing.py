"""Writing of a campaign's results database: whole or not at all, one process at a time."""

from __future__ import annotations

import json
import os
import shutil
import socket
import uuid
from collections import Counter
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import xarray as xr

from frames.results.chunks import ENDING, digest_of, write_chunk
from frames.results.storage import make_folder, write_whole
from frames.risk._errors import CampaignError
from frames.risk.campaign.plan import listed
from frames.risk.campaign.plan_description import SOURCES, TAKEN_OVER, unlike
from frames.risk.campaign.store import HISTORIES, LAYOUT, PLAN, ROWS, RUNS, CampaignStore

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping
    from pathlib import Path

    from frames.risk.campaign.batches import Batch


def lacking_packages(*needed: str) -> str:
    """Return the missing packages and their installation, in a sentence; nothing if all exist."""
    missing = [name for name in needed or ("filelock",) if find_spec(name) is None]
    if not missing:
        return ""
    return f"campaigns need {' and '.join(missing)}: pip install 'lir-dcfp[campaign]'"


@contextmanager
def locked(path: Path) -> Generator[None, None, None]:
    """Hold a lock file; that of a process that has died is replaced.

    The system releases it when its process ends. The holder's name is in a file beside it, which
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


_LOCK = "lock"


class StoreWriter(CampaignStore):
    """A results database that is made, held and written."""

    def create(self, described: Mapping[str, Any], rows: xr.Dataset, layout: xr.Dataset) -> None:
        """Make the results database, in one move: there is a whole one, or none."""
        if self.path.exists():
            msg = f"{self.path} exists and holds no campaign: name another folder"
            raise CampaignError(msg)
        beside = self.path.with_name(f".{self.path.name}.{uuid.uuid4().hex}.part")
        of_run = [name for name in layout.coords if "run" in layout[name].dims]
        try:
            (beside / RUNS).mkdir(parents=True)
            write_chunk(beside / ROWS, rows, compress=True)
            write_chunk(beside / LAYOUT, layout.drop_vars(of_run).isel(run=slice(0)))
            (beside / PLAN).write_text(json.dumps(described, indent=1), encoding="utf-8")
            beside.rename(self.path)
        except OSError as cause:
            if self.exists:
                msg = f"{self.path} was made by another process just now: run again to resume it"
                raise CampaignError(msg) from cause
            why = os.strerror(cause.errno) if cause.errno else cause
            msg = f"{self.path} could not be written: {why}: make room, or name another store"
            raise OSError(cause.errno, msg) from cause
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def require_plan(
        self, described: Mapping[str, Any], *, accept_other_sources: bool = False
    ) -> None:
        """Refuse to go on with another plan than that of the results database."""
        stored, given = self.plan(), json.loads(json.dumps(described))
        found, sources = unlike(stored, given)
        if found:
            msg = (
                f"{self.path} was planned otherwise: name another store, or give the plan that it "
                f"has\n{listed(found)}"
            )
            raise CampaignError(msg)
        if sources and not accept_other_sources:
            msg = (
                f"{self.path} was computed by other sources of the package: name another store. If "
                "the change leaves all numbers equal, call run(accept_other_sources=True)\n"
                f"{listed(sources)}"
            )
            raise CampaignError(msg)
        if sources:
            taken = {"after runs": self.status().done, "provenance": given["provenance"]}
            stored.setdefault(TAKEN_OVER, []).append(taken | {k: given[k] for k in SOURCES})
            write_whole(self.path / PLAN, json.dumps(stored, indent=1).encode())

    @contextmanager
    def owned(self) -> Generator[None, None, None]:
        """Hold the results database exclusively."""
        with locked(self.path / _LOCK):
            for cut in self.path.glob("*/.*.part"):  # of a process that was killed
                cut.unlink(missing_ok=True)
            yield

    def write(self, number: int, batch: Batch) -> None:
        """Write a batch: the histories that it keeps, then its chunk in one move."""
        dims = {str(name): variable.dims for name, variable in self._layout.data_vars.items()}
        unknown = [name for name in batch.arrays if name not in dims]
        if unknown:
            msg = (
                f"{self.path} has no room for {', '.join(unknown)}: another version of the package "
                "began it; name another store"
            )
            raise CampaignError(msg)
        runs = xr.Dataset({name: (dims[name], own) for name, own in batch.arrays.items()})
        marks = {
            "runs": runs.sizes["run"],
            "statuses": dict(Counter(batch.arrays["status"].tolist())),
            "doubtful": int((batch.arrays["doubts"] != "").sum()),
            "warnings": batch.warnings,
            "digest": digest_of([batch.arrays]),
            "reused": batch.reused,
        }
        try:
            for old in self._histories(number):
                old.unlink()
            for k, histories in enumerate(batch.histories):
                where = make_folder(self.path / HISTORIES) / f"{number:06d}-{k}{ENDING}"
                write_chunk(where, histories, compress=True)
            path = self.path / RUNS / f"{number:06d}{ENDING}"
            write_chunk(path, runs, compress=True, **marks)
        except OSError as cause:
            done = len(self.batches_done())
            why = os.strerror(cause.errno) if cause.errno else cause
            msg = (
                f"{self.path}: batch {number} could not be written: {why}. "
                f"The {done} batches before it are kept: make room, and run again to go on"
            )
            raise OSError(cause.errno, msg) from cause
