"""The results database of a campaign: its plan, and a chunk of runs for each batch that is done."""

from __future__ import annotations

import json
import os
import shutil
import uuid
from collections import Counter
from collections.abc import Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from frames.results.chunks import ENDING, Rows, digest_of, load_chunk, marks_of, write_chunk
from frames.results.storage import make_folder, write_whole
from frames.risk._errors import CampaignError
from frames.risk.campaign.lock import locked
from frames.risk.campaign.plan import listed, run_table
from frames.risk.campaign.plan_description import FORMAT, OLD, SOURCES, TAKEN_OVER, unlike

if TYPE_CHECKING:
    from collections.abc import Generator

    import pandas as pd

    from frames.risk.campaign.batches import Batch

_PLAN, _RUNS, _HISTORIES, _LOCK = "plan.json", "runs", "histories", "lock"
_ROWS, _LAYOUT = f"rows{ENDING}", f"layout{ENDING}"


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
        given = found.get("format") if isinstance(found, dict) else "of no campaign"
        if given != FORMAT:
            remedy = (
                f'frames.risk.convert_campaign("{self.path}", "another folder") writes it anew'
                if given in OLD
                else "open it with the version that wrote it"
            )
            msg = f"{self.path} has format {given}, this program reads {FORMAT}: {remedy}"
            raise CampaignError(msg)
        return dict(found)

    def create(self, described: Mapping[str, Any], rows: xr.Dataset, layout: xr.Dataset) -> None:
        """Make the results database, in one move: there is a whole one, or none.

        Parameters
        ----------
        described : mapping
            What it is planned with.
        rows : xarray.Dataset
            What is planned of each run, along `run`.
        layout : xarray.Dataset
            Variables and labels of results.

        Raises
        ------
        CampaignError
            If something else stands there.
        OSError
            If it cannot be written.
        """
        if self.path.exists():
            msg = f"{self.path} is there and holds no campaign: name another folder"
            raise CampaignError(msg)
        beside = self.path.with_name(f".{self.path.name}.{uuid.uuid4().hex}.part")
        of_run = [name for name in layout.coords if "run" in layout[name].dims]
        try:
            (beside / _RUNS).mkdir(parents=True)
            write_chunk(beside / _ROWS, rows, compress=True)
            write_chunk(beside / _LAYOUT, layout.drop_vars(of_run).isel(run=slice(0)))
            (beside / _PLAN).write_text(json.dumps(described, indent=1), encoding="utf-8")
            beside.rename(self.path)
        except OSError as cause:
            if self.exists:
                msg = f"{self.path} was made by another process just now: run again to resume it"
                raise CampaignError(msg) from cause
            why = os.strerror(cause.errno) if cause.errno else cause
            msg = f"{self.path} could not be written: {why}: make room"
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
            for cut in self.path.glob("*/.*.part"):  # of a process that was killed
                cut.unlink(missing_ok=True)
            yield

    def batches_done(self) -> list[int]:
        """Return the batches that are complete, in order."""
        return list(self._chunks())

    def _chunks(self) -> dict[int, Path]:
        paths = (self.path / _RUNS).glob(f"*{ENDING}")
        return dict(sorted((int(path.stem), path) for path in paths if path.stem.isdecimal()))

    def write(self, number: int, batch: Batch) -> None:
        """Write a batch: the histories that it keeps, then its chunk in one move.

        Parameters
        ----------
        number : int
            Which batch.
        batch : Batch
            What it gave.

        Raises
        ------
        CampaignError
            If the results database was laid out for other results.
        OSError
            If it cannot be written. The batch has no chunk then, and is run again.
        """
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
                where = make_folder(self.path / _HISTORIES) / f"{number:06d}-{k}{ENDING}"
                write_chunk(where, histories, compress=True)
            path = self.path / _RUNS / f"{number:06d}{ENDING}"
            write_chunk(path, runs, compress=True, **marks)
        except OSError as cause:
            done = len(self.batches_done())
            why = os.strerror(cause.errno) if cause.errno else cause
            msg = (
                f"{self.path}: batch {number} could not be written: {why}. "
                f"The {done} batches before it are kept: make room, and run again to go on"
            )
            raise OSError(cause.errno, msg) from cause

    def _histories(self, number: int) -> list[Path]:
        return sorted((self.path / _HISTORIES).glob(f"{number:06d}-*{ENDING}"))

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
        for path in self._chunks().values():
            mark = marks_of(path, CampaignError)
            done += mark["runs"]
            doubtful += mark["doubtful"]
            reused += mark["reused"]
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
        plan, layout, chunks = self.plan(), self._layout, self._chunks()
        rows = self._description(_ROWS)
        count = rows.sizes["run"]
        shown = {}
        for name, own in layout.data_vars.items():
            shape = (count, *own.shape[1:])
            whole = Rows(chunks, str(name), plan["batch"], shape, own.dtype.kind, CampaignError)
            shown[name] = own.dims, whole.unread(), own.attrs
        digests = np.array([plan["motions"][str(n)] for n in rows["motion"].to_numpy()])
        done = np.isin(np.arange(count) // plan["batch"], list(chunks))
        coordinates = {"done": ("run", done), "motion_digest": ("run", digests)}
        data = xr.Dataset(shown, {**rows.coords, **layout.coords} | coordinates)
        return data.assign_attrs(_origin(plan))

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
            for part in self._histories(number):
                data = load_chunk(part, lazy=True, error=CampaignError)
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
        plan, chunks = self.plan(), self._chunks()
        if len(chunks) * plan["batch"] < plan["runs"]:
            msg = f"{self.path}: {self.status()}: run it to its end first"
            raise CampaignError(msg)
        return digest_of(map(self._read, chunks.values()))

    def _read(self, path: Path) -> dict[str, Any]:
        # The arrays of a chunk, which are as they were written.
        found = load_chunk(path, error=CampaignError)
        arrays = {str(name): own.to_numpy() for name, own in found.data_vars.items()}
        if digest_of([arrays]) != found.encoding["digest"]:
            msg = f"{path} is not as it was written: remove it, and run again"
            raise CampaignError(msg)
        return arrays

    @cached_property
    def _layout(self) -> xr.Dataset:
        return self._description(_LAYOUT)

    def _description(self, name: str) -> xr.Dataset:
        try:
            return load_chunk(self.path / name)
        except ValueError as cause:
            msg = (
                f"{self.path / name} is damaged ({cause.__cause__}): restore it from a copy, or "
                "name another store and run again"
            )
            raise CampaignError(msg) from cause


def _origin(plan: Mapping[str, Any]) -> dict[str, str]:
    # Attributes: what was planned, where it comes from, and what took over.
    found = {key: str(plan[key]) for key in ("program", "options", "record")}
    found |= plan.get("provenance", {})
    taken = [
        f"after {each['after runs']} runs: {each['provenance']['source']}"
        for each in plan.get(TAKEN_OVER, [])
    ]
    return found | ({"sources_accepted": "; ".join(taken)} if taken else {})


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
    >>> from frames.demo import example
    >>> from frames.risk import Campaign, open_campaign
    >>> frame, pulse = example(1.0)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     data = Campaign(frame, pulse, store=f"{folder}/runs").run(workers=1)
    ...     print(open_campaign(f"{folder}/runs").status())
    1 of 1 runs done: 1 ok
    """
    store = CampaignStore(path)
    store.plan()
    return store
