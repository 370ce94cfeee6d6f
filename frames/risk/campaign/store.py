"""The results database of a campaign: whole chunks first, then a mark that they are there."""

from __future__ import annotations

import json
import shutil
import uuid
from collections import Counter
from collections.abc import Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.results.storage import write_whole
from frames.risk._errors import CampaignError
from frames.risk.campaign.layout import EVERY_CHUNK, digest_of, lay_out, run_table
from frames.risk.campaign.opened_store import damaged, locked, opened, readable, results_of
from frames.risk.campaign.plan import listed
from frames.risk.campaign.plan_description import FORMAT, READABLE, SOURCES, TAKEN_OVER, unlike

if TYPE_CHECKING:
    from collections.abc import Generator

    import pandas as pd
    import xarray as xr

    from frames.risk.campaign.batches import Batch
    from frames.risk.campaign.plan import Plan

_PLAN, _RUNS, _HISTORIES, _DONE, _LOCK = "plan.json", "runs.zarr", "histories", "done", "lock"
_MARK = ("runs", "statuses", "doubtful", "warnings", "digest")


class CampaignStatus(NamedTuple):
    """How far a campaign is.

    Attributes
    ----------
    done, total : int
        Runs.
    statuses : dict of str to int
        Number of runs done by their status.
    doubtful : int
        Runs in which the assumption check marks something.
    warnings : tuple of str
        What was warned of while batches were computed.
    reused : int
        Runs that were taken over from other results databases, or from an equal run of their batch:
        parameters that change nothing of a model, such as the interface of a plain DCFP.

    Examples
    --------
    In the gallery: "A campaign over friction" (docs/gallery/research/e_campaign.py).
    """

    done: int
    total: int
    statuses: dict[str, int]
    doubtful: int
    warnings: tuple[str, ...]
    reused: int = 0

    def __str__(self) -> str:
        """Return it on one line."""
        parts = ", ".join(f"{count} {name}" for name, count in self.statuses.items())
        doubts = (
            f"; the assumption check marks something in {self.doubtful}" if self.doubtful else ""
        )
        taken = f" ({self.reused} of them taken over)" if self.reused else ""
        return (
            f"{self.done} of {self.total} runs done{taken}{f': {parts}' if parts else ''}{doubts}"
        )


class CampaignStore:
    """A campaign's folder: its plan, results of the batches that are done, and their marks.

    Parameters
    ----------
    path : str or path
        The folder.

    Examples
    --------
    In the gallery: "A campaign over friction" (docs/gallery/research/e_campaign.py).
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)

    def __repr__(self) -> str:
        """Return where it is."""
        return f"CampaignStore({str(self.path)!r})"

    @property
    def exists(self) -> bool:
        """Whether there is a results database."""
        return (self.path / _PLAN).is_file()

    def plan(self) -> dict[str, Any]:
        """Return what the results database was planned with.

        Returns
        -------
        dict
            As it stands in plan.json: digests of models and motions, scales, parameters, options.

        Raises
        ------
        CampaignError
            If there is no results database, or one of another format.
        """
        try:
            found = json.loads((self.path / _PLAN).read_text(encoding="utf-8"))
        except FileNotFoundError as cause:
            msg = f"{self.path} holds no campaign: name the folder that one was run in"
            raise CampaignError(msg) from cause
        except ValueError as cause:
            msg = (
                f"{self.path / _PLAN} is damaged ({cause}): restore it from a copy, or name "
                "another store and run again"
            )
            raise CampaignError(msg) from cause
        if not isinstance(found, dict) or found.get("format") not in READABLE:
            given = found.get("format") if isinstance(found, dict) else "of no campaign"
            msg = (
                f"{self.path} has format {given}, this program reads "
                f"{' and '.join(map(str, READABLE))}: open it with the version that wrote it"
            )
            raise CampaignError(msg)
        return dict(found)

    def create(self, plan: Plan, described: Mapping[str, Any], layout: xr.Dataset) -> None:
        """Make the results database, in one move: there is a whole one, or none.

        Parameters
        ----------
        plan : Plan
            The rows.
        described : mapping
            What it is planned with.
        layout : xarray.Dataset
            Variables and labels.

        Raises
        ------
        CampaignError
            If something else stands there, or a parameter has the name of a result.
        OSError
            If it cannot be written.
        """
        if self.path.exists():
            msg = f"{self.path} is there and holds no campaign: name another folder"
            raise CampaignError(msg)
        beside = self.path.with_name(f".{self.path.name}.{uuid.uuid4().hex}.part")
        try:
            (beside / _DONE).mkdir(parents=True)
            lay_out(beside / _RUNS, plan, layout)
            (beside / _PLAN).write_text(json.dumps(described, indent=1), encoding="utf-8")
            beside.rename(self.path)
        except OSError as cause:
            if self.exists:
                msg = f"{self.path} was made by another process just now: run again to resume it"
                raise CampaignError(msg) from cause
            msg = f"{self.path} could not be written: {cause.strerror or cause}: make room"
            raise OSError(cause.errno, msg) from cause
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def require_plan(
        self, described: Mapping[str, Any], *, accept_other_sources: bool = False
    ) -> None:
        """Refuse to go on with another plan than that of the results database.

        Parameters
        ----------
        described : mapping
            What is given now.
        accept_other_sources : bool
            Whether the version of the package and its sources may be others than those that began
            the results database; plan.json keeps which ones took over, and after how many runs.

        Raises
        ------
        CampaignError
            With a line for each difference.
        """
        stored, given = self.plan(), json.loads(json.dumps(described))
        if stored["format"] != FORMAT:
            msg = (
                f"{self.path} has format {stored['format']}, this program writes {FORMAT}: "
                "open_campaign reads it; to run, name another store"
            )
            raise CampaignError(msg)
        found, sources = unlike(stored, given)
        if found:
            msg = (
                f"{self.path} was planned otherwise: name another store, or give what it was "
                f"planned with\n{listed(found)}"
            )
            raise CampaignError(msg)
        if sources and not accept_other_sources:
            msg = (
                f"{self.path} was computed by other sources of the package: its runs and new ones "
                "might not belong together. Name another store; or, if the change does not touch "
                "the numbers, run(accept_other_sources=True), which the results database keeps\n"
                f"{listed(sources)}"
            )
            raise CampaignError(msg)
        if sources:
            taken = {"after runs": self.status().done, "provenance": given["provenance"]}
            stored.setdefault(TAKEN_OVER, []).append(taken | {k: given[k] for k in SOURCES})
            write_whole(self.path / _PLAN, json.dumps(stored, indent=1).encode())

    @contextmanager
    def owned(self) -> Generator[None, None, None]:
        """Hold the results database alone.

        Yields
        ------
        None
            While it is held.

        Raises
        ------
        CampaignError
            If another process works on it.
        """
        with locked(self.path / _LOCK):
            yield

    def batches_done(self) -> list[int]:
        """Return the batches that are complete, in order."""
        return sorted(int(mark.stem) for mark in (self.path / _DONE).glob("*.json"))

    def write(self, plan: Plan, number: int, batch: Batch) -> None:
        """Write a batch: its chunks, then its mark.

        Parameters
        ----------
        plan : Plan
            The rows.
        number : int
            Which batch.
        batch : Batch
            What it gave.

        Raises
        ------
        CampaignError
            If the results database was laid out for other results.
        OSError
            If it cannot be written. The batch has no mark then, and is run again.
        """
        unknown = [name for name in batch.arrays if name not in self._arrays]
        if unknown:
            msg = (
                f"{self.path} has no room for {', '.join(unknown)}: another version of the package "
                "began it; name another store"
            )
            raise CampaignError(msg)
        rows = plan.rows(number)
        try:
            for name, values in batch.arrays.items():
                self._arrays[name][rows.start : rows.stop] = values
            where = self.path / _HISTORIES / f"{number:06d}"
            shutil.rmtree(where, ignore_errors=True)
            for k, histories in enumerate(batch.histories):
                histories.to_zarr(
                    where / f"{k}.zarr", mode="w", consolidated=False, write_empty_chunks=True
                )
            mark = {
                "runs": len(rows),
                "statuses": dict(Counter(batch.arrays["status"].tolist())),
                "doubtful": int((batch.arrays["doubts"] != "").sum()),
                "warnings": batch.warnings,
                "digest": digest_of([batch.arrays]),
            } | ({"reused": batch.reused} if batch.reused else {})
            write_whole(self.path / _DONE / f"{number:06d}.json", json.dumps(mark).encode())
        except OSError as cause:
            done = len(self.batches_done())
            msg = (
                f"{self.path}: batch {number} could not be written: {cause.strerror or cause}. "
                f"The {done} batches before it are kept: make room, and run again to go on"
            )
            raise OSError(cause.errno, msg) from cause

    def status(self) -> CampaignStatus:
        """Return how far the campaign is, also while it runs.

        Returns
        -------
        CampaignStatus
            Numbers of runs.

        Raises
        ------
        CampaignError
            If there is no store.
        """
        total, done, doubtful, reused = int(self.plan()["runs"]), 0, 0, 0
        statuses: Counter[str] = Counter()
        said: dict[str, None] = {}
        for number in self.batches_done():
            mark = self._mark(number)
            done += mark["runs"]
            doubtful += mark["doubtful"]
            reused += mark.get("reused", 0)
            statuses.update(mark["statuses"])
            said.update(dict.fromkeys(mark["warnings"]))
        counts = dict(statuses.most_common())
        return CampaignStatus(done, total, counts, doubtful, tuple(said), reused)

    def results(self) -> xr.Dataset:
        """Return what the runs reached, read from the disk where it is used; also while it runs.

        Returns
        -------
        xarray.Dataset
            As `time_histories` gives it, a row a planned run; the parameters are coordinates
            along `run`, and `done` says which rows are there: others are NaN and "".

        Raises
        ------
        CampaignError
            If there is no store.
        """
        plan = self.plan()
        done = np.zeros(plan["runs"], dtype=bool)
        for number in self.batches_done():
            done[number * plan["batch"] : (number + 1) * plan["batch"]] = True
        return results_of(self.path / _RUNS, plan, done)

    def to_dataframe(self) -> pd.DataFrame:
        """Return the runs that are done as a table, also while the campaign runs.

        Returns
        -------
        pandas.DataFrame
            A row a run that is done, by its number: model, parameter_set, motion, scale, the
            parameters; outcome (as `IntensityRuns` has it), status, message, doubts, seconds_loop;
            and a column a quantity of `frames.peaks`, SI, NaN where a structure has none or the run
            reached nothing. `attrs["units"]` has the units by column, but for parameters, which are
            what the bearing's fields or the function take; the other attributes are those of
            `results()`.

        Raises
        ------
        CampaignError
            If there is no store.
        """
        return run_table(self.results(), list(self.plan()["parameters"]))

    def histories(self, run: int) -> xr.Dataset:
        """Return the recorded histories of a run.

        Parameters
        ----------
        run : int
            Its row.

        Returns
        -------
        xarray.Dataset
            Over `time` or `step`, read where it is used.

        Raises
        ------
        CampaignError
            If the campaign keeps none, or this run is not done.
        """
        number = run // self.plan()["batch"]
        if number in self.batches_done():
            for part in (self.path / _HISTORIES / f"{number:06d}").glob("*.zarr"):
                try:
                    data = opened(part, self.plan())
                except (RuntimeError, ValueError, LookupError, FileNotFoundError) as cause:
                    raise CampaignError(damaged(self.path / _RUNS, number, cause)) from cause
                if run in data["run"].to_numpy():
                    return data.sel(run=run)
        msg = (
            f"no histories of run {run}: it is not done, its model could not be built (see its "
            "message), or the campaign keeps none (record=Recording() does)"
        )
        raise CampaignError(msg)

    def digest(self) -> str:
        """Return a digest of what the runs reached, bit by bit, times of computation left out.

        Returns
        -------
        str
            64 hexadecimal digits, the same for one plan whatever computed it, and in which order.

        Raises
        ------
        CampaignError
            If runs are missing, or a batch is not as it was written.
        """
        plan, done = self.plan(), self.batches_done()
        if len(done) * plan["batch"] < plan["runs"]:
            msg = f"{self.path}: {self.status()}: run it to its end first"
            raise CampaignError(msg)
        return digest_of(self._read(number) for number in done)

    def _read(self, number: int) -> dict[str, Any]:
        size = self.plan()["batch"]
        rows = slice(number * size, (number + 1) * size)
        whole = self._arrays
        try:
            arrays = {name: array[rows] for name, array in whole.items()}
        except (RuntimeError, ValueError) as cause:
            raise CampaignError(damaged(self.path / _RUNS, number, cause)) from cause
        if digest_of([arrays]) != self._mark(number)["digest"]:
            raise CampaignError(damaged(self.path / _RUNS, number))
        return arrays

    @cached_property
    def _arrays(self) -> dict[str, Any]:
        import zarr

        with readable(self.path / _RUNS):
            group: Any = zarr.open_group(self.path / _RUNS, mode="r+")
            with zarr.config.set({f"array.{key}": value for key, value in EVERY_CHUNK.items()}):
                return {name: group[name] for name in group.attrs["results"]}

    def _mark(self, number: int) -> dict[str, Any]:
        path = self.path / _DONE / f"{number:06d}.json"
        try:
            found = json.loads(path.read_text(encoding="utf-8"))
            mark: dict[str, Any] = {name: found[name] for name in _MARK} | found
            return mark
        except (ValueError, LookupError, TypeError) as cause:
            raise CampaignError(damaged(self.path / _RUNS, number, cause)) from cause


def open_campaign(path: str | Path) -> CampaignStore:
    """Return the results database of a campaign, to look at, also while the campaign runs.

    Parameters
    ----------
    path : str or path
        The folder that it is run in.

    Returns
    -------
    CampaignStore
        With `results()`, `to_dataframe()`, `status()`, `histories(run)` and `digest()`.

    Raises
    ------
    CampaignError
        If there is none.

    Examples
    --------
    >>> import tempfile
    >>> import numpy as np
    >>> from frames import GroundMotion, lumped_mass
    >>> from frames.demo import bearing_for
    >>> from frames.risk import Campaign, open_campaign
    >>> pulse = GroundMotion(x=np.sin(np.linspace(0.0, 6.28, 101)), dt=0.016, name="pulse")
    >>> frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     data = Campaign(frame, pulse, store=f"{folder}/runs").run(workers=1)
    ...     print(open_campaign(f"{folder}/runs").status())
    1 of 1 runs done: 1 ok
    """
    store = CampaignStore(path)
    store.plan()
    return store
