"""Campaigns: models, motions, scales and parameters, run in batches into a database on disk."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from frames._errors import ModelWarning
from frames.batch.cases import BatchProgress, grid, named_models, named_motions, tell
from frames.batch.processes import crew_of
from frames.design.hazard.motion_set import MotionSet, facts_of
from frames.frame import Frame
from frames.recording.recording import Recording
from frames.risk._errors import CampaignError
from frames.risk.campaign.batches import DIGEST, CampaignJob, compute
from frames.risk.campaign.cluster import over_cluster
from frames.risk.campaign.measures import Measure, checked_measures
from frames.risk.campaign.other_databases import known_runs, rows_by_digest
from frames.risk.campaign.plan import Plan, planned_rows
from frames.risk.campaign.plan_description import described
from frames.risk.campaign.sampling import ParameterSample, whole
from frames.risk.campaign.store import CampaignStatus, CampaignStore
from frames.risk.campaign.store_writing import StoreWriter, lacking_packages
from frames.risk.fragility.intensity import OWN, IntensityMeasure
from frames.risk.fragility.scaled_motions import at_one
from lir_element.argument_checks import require_positive, require_type
from lir_element.errors import AnalysisWarning
from lir_element.texts import html_table

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    import pandas as pd
    import xarray as xr

    from frames.motion.ground_motion import GroundMotion
    from frames.risk.campaign.batches import Batch, Builder, Known, Told
    from lir_element.device.features import Features

FEWEST, MOST, PARTS = 16, 512, 8
"""Default number of runs of a batch: a part of all, within bounds; with histories the fewest."""

BATCHES = 512
"""Largest number of batches, as each has files: campaigns with more runs have larger batches."""


def usual_batch(runs: int) -> int:
    """Return the default number of runs of a batch in a campaign of `runs`."""
    return min(max(runs // PARTS, FEWEST), max(MOST, math.ceil(runs / BATCHES)))


class Campaign:
    """Many time histories in a database on disk, to be stopped at any moment and resumed.

    Parameters
    ----------
    models : Frame, mapping of str to Frame, or callable
        The structures; or functions, alone or in a mapping by name, that return a Frame for a set
        of parameters, a dict of str to float. The models of one function have the same names of
        nodes, bearings and levels.
    motions : GroundMotion, or a sequence or mapping of them
        As for `time_histories`.
    store : str or path
        Folder of the results, made by the first run.
    sample : ParameterSample, optional
        Sets of parameters (`full_grid`, `latin_hypercube`, `sobol_sample`); of a Frame they are
        fields of its bearings (docs/campaigns.md).
    scales : float or sequence of float, optional
        Factors on the motions [-]; 1 if None.
    intensity : IntensityMeasure, optional
        The measure of `intensities`.
    intensities : sequence of float, optional
        Intensities that each motion is scaled to, in place of `scales`, in the unit of the measure.
        The attribute `motions`, the factors "scale" of the results and their digests are of motions
        at an intensity of 1.
    record : Recording, optional
        Histories to be kept besides the peaks.
    measures : dict of str to Measure, optional
        User-defined numbers of each run by name: functions of its histories, added to the
        quantities of the results. NaN if a run stopped early.
    batch : int, optional
        Runs of a batch, the least that is computed and written at once. None: an eighth of all,
        at least 16 and at most 512, or 512 batches; with histories or own measures 16; of a
        results database that is there, its own.
    duration, dt, level, integrator, spectral_radius, tolerance, features
        As for `time_histories`, the same for all runs.

    Raises
    ------
    ValueError, TypeError
        If an argument cannot be.
    ImportError
        If filelock is not installed.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Campaign, full_grid
    >>> frame, pulse = example(1.0)
    >>> sample = full_grid({"friction": [0.05, 0.06]})
    >>> Campaign(frame, pulse, store="runs", scales=[1.0, 2.0], sample=sample)
    Campaign('runs': 4 runs = 1 models x 2 sets of parameters x 1 motions x 2 scales)
    """

    def __init__(
        self,
        models: Frame | Builder | Mapping[str, Frame | Builder],
        motions: GroundMotion | Sequence[GroundMotion] | Mapping[str, GroundMotion],
        *,
        store: str | Path,
        sample: ParameterSample | None = None,
        scales: float | Sequence[float] | None = None,
        intensity: IntensityMeasure | None = None,
        intensities: Sequence[float] | None = None,
        record: Recording | None = None,
        measures: dict[str, Measure] | None = None,
        batch: int | None = None,
        duration: float | None = None,
        dt: float | None = None,
        level: str | Mapping[str, str] = "pendulum",
        integrator: str | None = None,
        spectral_radius: float = 0.8,
        tolerance: float | None = None,
        features: Features | None = None,
    ) -> None:
        lacking = lacking_packages()
        if lacking:
            raise ImportError(lacking)
        require_type("sample", sample, (ParameterSample, type(None)), "a ParameterSample")
        require_type("record", record, (Recording, type(None)), "a Recording, or None")
        own = checked_measures(measures)
        structures, grounds = _named(models), named_motions(motions)
        self._facts = facts_of(motions)
        if intensity is not None or intensities is not None:
            grounds, scales = _at_intensities(grounds, scales, intensity, intensities)
        one = {name: None for name in (next(iter(structures)),)}
        first = next(iter(grounds))
        factors = tuple(c.scale for c in grid(one, {first: None}, scales, None))
        self._writer = StoreWriter(store)
        self.store: CampaignStore = self._writer
        options = {
            "duration": duration,
            "dt": dt,
            "level": level,
            "integrator": integrator,
            "spectral_radius": spectral_radius,
            "tolerance": tolerance,
            "features": features,
        }
        plan = Plan(tuple(structures), tuple(grounds), factors, sample, FEWEST)
        if batch is not None:
            plan = replace(plan, batch=whole("batch", batch, 1))
        elif self.store.exists:
            plan = replace(plan, batch=int(self.store.plan()["batch"]))
        elif record is None and not own:
            plan = replace(plan, batch=usual_batch(plan.runs))
        self._work = CampaignJob(plan, structures, grounds, options, record, own)

    def __repr__(self) -> str:
        """Return the results database and the number of runs."""
        plan = self._work.plan
        sets = "" if plan.sample is None else f"{plan.sets} sets of parameters x "
        return (
            f"Campaign({str(self.store.path)!r}: {plan.runs} runs = {len(plan.models)} models x "
            f"{sets}{len(plan.motions)} motions x {len(plan.scales)} scales)"
        )

    def _repr_html_(self) -> str:
        """Return a table for notebooks."""
        plan = self._work.plan
        rows = [
            ("results database", str(self.store.path)),
            ("models", ", ".join(plan.models)),
            ("sets of parameters", str(plan.sets)),
            ("motions", str(len(plan.motions))),
            ("scales", ", ".join(f"{scale:g}" for scale in plan.scales)),
            ("state", str(self.status()) if self.store.exists else f"{plan.runs} runs, none done"),
        ]
        return html_table("Campaign", rows)

    def run(
        self,
        *,
        workers: int | None = None,
        client: Any = None,
        progress: Told | bool | None = None,
        accept_other_sources: bool = False,
        reuse: str | Path | Sequence[str | Path] | None = None,
    ) -> xr.Dataset:
        """Run the remaining runs, and return the results.

        Parameters
        ----------
        workers : int, optional
            Runs at a time, as for `time_histories`; with a client, those of each worker.
        client : distributed.Client, optional
            A Dask cluster that computes the batches; they are written here.
        progress : callable or bool, optional
            Called with a `BatchProgress` of the runs of this call; True writes it to the standard
            error.
        accept_other_sources : bool
            True to continue a results database that other sources or another version of the package
            began, if the change does not affect the numbers. The database keeps the run at which
            they changed. Everything else must be as planned, properties of the bearings included.
        reuse : str, path or sequence of them, optional
            Folders of other campaigns whose runs are copied instead of computed: those of the same
            model, motion, scale and parameters, by the same sources and options.

        Returns
        -------
        xarray.Dataset
            `results()`.

        Raises
        ------
        CampaignError
            If the results database was planned otherwise, was begun by other sources of the package
            (each difference is named), or is in use. If no model can be set up, a user-defined
            measure fails, the cluster is lost, or runs of `reuse` were computed otherwise.
        OSError
            If the results database cannot be written. Complete runs stay.
        KeyboardInterrupt
            After Ctrl-C; the batches done are in the results database.

        Warns
        -----
        AnalysisWarning
            If runs stopped early or have warnings, with their number.
        ModelWarning
            If building or setting up a model gave warnings.
        """
        told = tell(progress)
        frames, layout = self._work.reference()
        plan = described(self._work, frames)
        stores = [reuse] if isinstance(reuse, (str, Path)) else list(reuse or ())
        known = known_runs(stores, self._work, plan)
        if not self.store.exists:
            self._writer.create(plan, planned_rows(self._work.plan, layout), layout)
        with self._writer.owned():
            self._writer.require_plan(plan, accept_other_sources=accept_other_sources)
            done = set(self.store.batches_done())
            todo = [k for k in range(self._work.plan.batches) if k not in done]
            computed = _Counting(self._work.plan, todo, told)
            with closing(self._computed(layout, computed, client, workers, known)) as batches:
                for number, batch in batches:
                    self._writer.write(number, batch)
        _warn(self.store.status())
        return self.results()

    def _computed(
        self,
        layout: xr.Dataset,
        counting: _Counting,
        client: Any,
        workers: int | None,
        known: Known,
    ) -> Generator[tuple[int, Batch]]:
        # A cluster computes the batches with missing runs. Here, runs of the batches before are
        # reused as well, but without their histories.
        work, todo = self._work, counting.todo
        here = [
            batch
            for batch in todo
            if client is None or (known and {*work.digests(work.plan.rows(batch))} <= known.keys())
        ]
        before = rows_by_digest(self.results()) if here and work.record is None else {}
        with crew_of(workers, sum(len(work.plan.rows(number)) for number in here)) as crew:
            for number in here:
                data = self.results()
                there = {**known, **{digest: (data, row) for digest, row in before.items()}}
                batch = compute(work, layout, number, crew, counting.of_batch(), there)
                counting.add(batch)
                if batch.reused:
                    counting.tell()
                yield number, batch
                if work.record is None:
                    own = zip(batch.arrays[DIGEST].tolist(), work.plan.rows(number), strict=True)
                    before |= {digest: row for digest, row in own if digest}
        if client is None:
            return
        todo = [number for number in todo if number not in set(here)]
        for number, batch in over_cluster(client, self._work, layout, todo, workers):
            counting.add(batch)
            counting.tell()
            yield number, batch

    @property
    def motions(self) -> Mapping[str, GroundMotion]:
        """GroundMotion by name, before the scales; a MotionSet with the facts of a given one."""
        found = dict(self._work.motions)
        return MotionSet(found, self._facts) if self._facts else found

    @property
    def sets(self) -> int:
        """Number of sets of parameters."""
        return self._work.plan.sets

    def results(self) -> xr.Dataset:
        """Return the results so far: `CampaignStore.results`."""
        return self.store.results()

    def to_dataframe(self) -> pd.DataFrame:
        """Return the runs that are done as a table: `CampaignStore.to_dataframe`."""
        return self.store.to_dataframe()

    def status(self) -> CampaignStatus:
        """Return how far the campaign is: `CampaignStore.status`."""
        return self.store.status()

    def digest(self) -> str:
        """Return a digest of the results: `CampaignStore.digest`."""
        return self.store.digest()


def _at_intensities(
    motions: Mapping[str, GroundMotion],
    scales: object,
    intensity: IntensityMeasure | None,
    intensities: Sequence[float] | None,
) -> tuple[dict[str, GroundMotion], list[float]]:
    # Motions at an intensity of 1, and the factors on them.
    if intensity is None or intensities is None or scales is not None:
        msg = (
            'intensities go with their measure and without scales: intensity=Intensity(kind="PGV"),'
            " intensities=[0.2, 0.4]"
        )
        raise CampaignError(msg)
    require_type("intensity", intensity, IntensityMeasure, OWN)
    levels = [require_positive("intensities", each, intensity.unit) for each in intensities]
    grounds, power = at_one(intensity, motions)
    return grounds, [level ** (1.0 / power) for level in levels]


class _Counting:
    # Progress of the batches of one call, for the listener.

    def __init__(self, plan: Plan, todo: list[int], told: Told | None) -> None:
        self.todo, self._told = todo, told
        self._total = sum(len(plan.rows(number)) for number in todo)
        self._done, self._failed, self._reused, self._began = 0, 0, 0, perf_counter()

    def of_batch(self) -> Callable[[BatchProgress], None] | None:
        return None if self._told is None else self._within

    def _within(self, progress: BatchProgress) -> None:
        self.tell(progress.done, progress.failed)

    def tell(self, done: int = 0, failed: int = 0) -> None:
        if self._told is not None:
            elapsed = perf_counter() - self._began
            now = min(self._done + done, self._total)
            failed += self._failed
            self._told(BatchProgress(now, self._total, elapsed, failed, reused=self._reused))

    def add(self, batch: Batch) -> None:
        status = batch.arrays["status"]
        self._done += len(status)
        self._failed += int((status != "ok").sum())
        self._reused += batch.reused


def _warn(status: CampaignStatus) -> None:
    ill = status.done - status.statuses.get("ok", 0)
    if ill:
        warnings.warn(f"{ill} runs are not ok: {status}", AnalysisWarning, stacklevel=3)
    if status.warnings:
        more = len(status.warnings) - 1
        others = f" (and {more} more, see status())" if more else ""
        warnings.warn(f"{status.warnings[0]}{others}", ModelWarning, stacklevel=3)


def _named(models: object) -> dict[str, Frame | Builder]:
    # Structures and functions by name.
    if not isinstance(models, Frame) and callable(models):
        return {str(getattr(models, "__name__", "model")): models}
    if not isinstance(models, Mapping):
        found: dict[str, Any] = dict(named_models(models))
        return found
    functions = {n: m for n, m in models.items() if not isinstance(m, Frame) and callable(m)}
    frames = {name: model for name, model in models.items() if name not in functions}
    checked: dict[str, Any] = named_models(frames) if frames else {}
    if not checked and not functions:
        msg = "models is empty: give a Frame, a function, or a mapping of them by name"
        raise CampaignError(msg)
    both = checked | functions
    return {name: both[name] for name in models}
