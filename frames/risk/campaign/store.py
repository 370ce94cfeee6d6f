"""The results database of a campaign: its plan, and a chunk of runs for each batch that is done."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from frames.results.chunks import ENDING, Rows, digest_of, load_chunk, marks_of
from frames.risk._errors import CampaignError
from frames.risk.campaign.plan import run_table
from frames.risk.campaign.plan_description import FORMAT, OLD, TAKEN_OVER

if TYPE_CHECKING:
    import pandas as pd


PLAN, RUNS, HISTORIES = "plan.json", "runs", "histories"
ROWS, LAYOUT = f"rows{ENDING}", f"layout{ENDING}"


class CampaignStatus(NamedTuple):
    """Progress of a campaign.

    Attributes
    ----------
    done, total : int
        Runs.
    statuses : dict of str to int
        Number of runs done by their status.
    doubtful : int
        Runs in which the assumption check marks something.
    warnings : tuple of str
        Warnings while batches were computed.
    reused : int
        Runs copied from other results databases, or from an equal run of this one: some parameters
        do not change a model, for example the interface of a plain DCFP.

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
        computed = f"{self.done - self.reused} computed, {self.reused} taken over"
        taken = f" ({computed})" if self.reused else ""
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
        """Return its path."""
        return f"CampaignStore({str(self.path)!r})"

    @property
    def exists(self) -> bool:
        """True if there is a results database."""
        return (self.path / PLAN).is_file()

    def plan(self) -> dict[str, Any]:
        """Return the plan of the results database.

        Returns
        -------
        dict
            The content of plan.json: digests of models and motions, scales, parameters, options.

        Raises
        ------
        CampaignError
            If there is no results database, or one of another format.
        """
        try:
            found = json.loads((self.path / PLAN).read_text(encoding="utf-8"))
        except (FileNotFoundError, NotADirectoryError) as cause:
            msg = f"{self.path} holds no campaign: name the folder that one was run in"
            raise CampaignError(msg) from cause
        except ValueError as cause:
            msg = (
                f"{self.path / PLAN} is damaged ({cause}): restore it from a copy, or name "
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

    def batches_done(self) -> list[int]:
        """Return the batches that are complete, in order."""
        return list(self._chunks())

    def _chunks(self) -> dict[int, Path]:
        paths = (self.path / RUNS).glob(f"*{ENDING}")
        return dict(sorted((int(path.stem), path) for path in paths if path.stem.isdecimal()))

    def _histories(self, number: int) -> list[Path]:
        return sorted((self.path / HISTORIES).glob(f"{number:06d}-*{ENDING}"))

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
        """Return the results of the runs, read from the disk on use; also while it runs.

        Returns
        -------
        xarray.Dataset
            As for `time_histories`, a row a planned run; the parameters are coordinates along
            `run`, and `done` marks the complete rows: others are NaN and "".

        Raises
        ------
        CampaignError
            If there is no store.
        """
        plan, layout, chunks = self.plan(), self._layout, self._chunks()
        rows = self._description(ROWS)
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
        """Return the complete runs as a table, also while the campaign runs.

        Returns
        -------
        pandas.DataFrame
            A row a complete run, by its number: model, parameter_set, motion, scale, the
            parameters; outcome (as in `IntensityRuns`), status, message, doubts, seconds_loop; and
            a column a quantity of `frames.peaks`, SI, NaN if a structure has none or the run has no
            value. `attrs["units"]` has the units by column, except for parameters, whose units are
            those of the bearing's fields or of the function; the other attributes are those of
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
            Row of the run.

        Returns
        -------
        xarray.Dataset
            Histories over `time` or `step`, read on use.

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
            f"run {run} has no histories: it is not done or could not be built (see its message), "
            "or the campaign needs record=Recording()"
        )
        raise CampaignError(msg)

    def digest(self) -> str:
        """Return a digest of the results, bit by bit, times of computation left out.

        Returns
        -------
        str
            64 hexadecimal digits, the same for one plan on any machine and in any order.

        Raises
        ------
        CampaignError
            If runs are missing, or a batch is not as it was written.
        """
        plan, chunks = self.plan(), self._chunks()
        if len(chunks) * plan["batch"] < plan["runs"]:
            msg = f"{self.path}: {self.status()}: run the campaign to its end"
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
        return self._description(LAYOUT)

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
    # Attributes: the plan, its origin, and other sources that continued it.
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
        The results, with `results()`, `to_dataframe()`, `status()`, `histories(run)` and
        `digest()`.

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
