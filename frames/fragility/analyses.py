"""Multiple stripes, clouds and incremental dynamic analyses, run in batches."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames._errors import FragilityError
from frames.analysis.cases import named_motions
from frames.fragility.hunt_fill import HuntFill
from frames.fragility.intensity import Intensity
from frames.fragility.limit_state import LimitState
from frames.fragility.runs import IntensityRuns, run_at
from lir_element.door import require_positive, require_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from frames._types import FloatArray
    from frames.model.contents import FrameContents


@dataclass(frozen=True, eq=False)
class IDA:
    """An incremental dynamic analysis: runs of each motion from low intensities to the limit.

    Parameters
    ----------
    runs : IntensityRuns
        All runs.
    limit : LimitState
        What was hunted.
    rules : HuntFill
        How intensities were chosen.

    Notes
    -----
    Between runs demands are linear in the intensity, from zero at zero.
    """

    runs: IntensityRuns
    limit: LimitState
    rules: HuntFill

    def curve(self, motion: str, quantity: str) -> pd.DataFrame:
        """Return the curve of a motion.

        Parameters
        ----------
        motion : str
            The motion.
        quantity : str
            A quantity of `frames.peaks`.

        Returns
        -------
        pandas.DataFrame
            Rising intensities "im" and demands "demand": infinite where a bearing failed; runs
            that failed numerically are left out.

        Raises
        ------
        FragilityError
            If motion or quantity are not known.
        """
        if motion not in self.runs.motions:
            msg = f"motion = {motion!r}: choose one of {', '.join(self.runs.motions)}"
            raise FragilityError(msg)
        own = self.runs.table["motion"].to_numpy() == motion
        found = pd.DataFrame({
            "im": self.runs.table["im"].to_numpy()[own], "demand": self.runs.demand(quantity)[own],
        })  # fmt: skip
        return found.dropna().sort_values("im", ignore_index=True)

    def capacities(self, limit: LimitState | None = None) -> pd.DataFrame:
        """Return the intensity at which each motion first reaches a limit state.

        Parameters
        ----------
        limit : LimitState, optional
            The limit state; that of the hunt if None.

        Returns
        -------
        pandas.DataFrame
            A row a motion: "capacity" where the demand reaches the limit, on the line between two
            runs, or their geometric mean where a bearing failed at the upper one (the same where
            the limit is zero; half of the upper one where no run holds); "lower" and "upper" runs;
            "censored" where no run exceeds it, the capacity then being that of the highest run;
            "resurrects" where a run above one that exceeds does not; "failed" runs.

        Raises
        ------
        FragilityError
            If the structure does not have the limit's quantity, or no run of a motion succeeded.
        """
        state = self.limit if limit is None else limit
        over, table = self.runs.exceeded(state), self.runs.table
        demand = None if state.quantity is None else self.runs.demand(state.quantity)
        rows = []
        for motion in self.runs.motions:
            own = np.flatnonzero(table["motion"].to_numpy() == motion)
            own = own[np.argsort(table["im"].to_numpy()[own], kind="stable")]
            known = own[~np.isnan(over[own])]
            if not len(known):
                msg = f"{motion}: no run succeeded, its capacity is not known: leave it out"
                raise FragilityError(msg)
            im, exceeds = table["im"].to_numpy()[known], over[known] > 0.5
            values = None if demand is None else demand[known]
            found = _first_crossing(im, exceeds, values, state.limit)
            rows.append({**found, "failed": len(own) - len(known)})
        return pd.DataFrame(rows, index=pd.Index(self.runs.motions, name="motion"))

    def demands_at(self, im: npt.ArrayLike, quantity: str) -> FloatArray:
        """Return the demand of each motion at intensities.

        Parameters
        ----------
        im : array_like, shape (m,)
            Intensities.
        quantity : str
            A quantity of `frames.peaks`.

        Returns
        -------
        ndarray, shape (motions, m)
            Demands [SI]: infinite from the capacity against failure of a bearing on, NaN above the
            highest run.

        Raises
        ------
        FragilityError
            If the quantity is not known.
        """
        at = np.atleast_1d(np.asarray(im, dtype=np.float64))
        ends = self.capacities(LimitState.bearing_failure())
        found = np.empty((len(ends), len(at)))
        for row, (motion, end) in zip(found, ends.iterrows(), strict=True):
            curve = self.curve(str(motion), quantity)
            curve = curve[(curve["demand"] < np.inf) & (curve["im"] <= end["capacity"])]
            levels, values = ([0.0, *curve[name]] for name in ("im", "demand"))
            row[:] = np.interp(at, levels, values)
            row[at > end["capacity"]] = np.nan if end["censored"] else np.inf
        return found

    def fractiles(
        self,
        quantity: str,
        im: npt.ArrayLike | None = None,
        percent: Sequence[float] = (16.0, 50.0, 84.0),
    ) -> pd.DataFrame:
        """Return fractiles of the demand over all motions, at each intensity.

        Parameters
        ----------
        quantity : str
            A quantity of `frames.peaks`.
        im : array_like, optional
            Intensities; 60 up to the highest run if None.
        percent : sequence of float
            Which fractiles [%]; by default those of plus and minus a standard deviation.

        Returns
        -------
        pandas.DataFrame
            A row an intensity, a column a fractile: infinite where that part of the motions fails
            a bearing, NaN where a motion was not run as high. No value is interpolated between
            motions of which one fails.

        Raises
        ------
        FragilityError
            If the quantity is not known.
        """
        highest = float(self.runs.table["im"].max())
        at = np.linspace(0.0, highest, 61)[1:] if im is None else np.atleast_1d(im)
        table = np.sort(self.demands_at(at, quantity), axis=0)
        columns = {}
        for each in percent:
            place = (len(table) - 1) * each / 100.0
            low, high = table[math.floor(place)], table[math.ceil(place)]
            share, known = place - math.floor(place), np.isfinite(high)
            mixed = high.copy()
            mixed[known] = low[known] + share * (high[known] - low[known])
            columns[f"{each:g} %"] = np.where(np.isnan(table).any(axis=0), np.nan, mixed)
        return pd.DataFrame(columns, index=pd.Index(at, name=f"im [{self.runs.intensity.unit}]"))

    def to_dataframe(self) -> pd.DataFrame:
        """Return all runs, in the order in which they were made."""
        return self.runs.to_dataframe()


def _first_crossing(
    im: FloatArray, exceeds: np.ndarray, values: FloatArray | None, limit: float | None
) -> dict[str, float | bool]:
    # Of the runs of one motion in rising order.
    if not exceeds.any():
        top = float(im[-1])
        return {"capacity": top, "lower": top, "upper": math.nan, "censored": True,
                "resurrects": False}  # fmt: skip
    k = int(np.argmax(exceeds))
    lower, upper = (float(im[k - 1]) if k else 0.0), float(im[k])
    before = 0.0 if k == 0 or values is None else float(values[k - 1])
    if values is not None and limit and math.isfinite(values[k]):
        capacity = lower + (upper - lower) * (limit - before) / (float(values[k]) - before)
    else:
        capacity = math.sqrt(lower * upper) if lower > 0.0 else 0.5 * upper
    return {"capacity": capacity, "lower": lower, "upper": upper, "censored": False,
            "resurrects": bool((~exceeds[k:]).any())}  # fmt: skip


def ida(
    model: FrameContents,
    motions: object,
    *,
    intensity: Intensity,
    rules: HuntFill,
    limit: LimitState | None = None,
    **options: Any,
) -> IDA:
    """Analyse a structure under motions of rising intensity, up to a limit state.

    Each round is one call of `time_histories` with the next intensities of all motions.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions; they are scaled as a whole.
    intensity : Intensity
        The measure that rises.
    rules : HuntFill
        How intensities are chosen.
    limit : LimitState, optional
        What is hunted; failure of a bearing if None.
    **options
        Of `time_histories`: `level`, `dt`, `workers` and so on.

    Returns
    -------
    IDA
        Runs, curves and capacities.

    Raises
    ------
    FragilityError
        If an argument is of another kind, or an option is one that is decided here.

    Warns
    -----
    AnalysisWarning
        If runs failed numerically: they count as neither.
    """
    require_type("intensity", intensity, Intensity, "an Intensity")
    require_type("rules", rules, HuntFill, "a HuntFill")
    state = LimitState.bearing_failure() if limit is None else limit
    grounds = named_motions(motions)
    begin = [(motion, level) for motion in grounds for level in rules.next_intensities([], [])]
    runs = run_at(model, grounds, begin, intensity, options)
    while cases := _next_cases(runs, rules, state):
        runs = runs.joined(run_at(model, grounds, cases, intensity, options))
    return IDA(runs, state, rules)


def _next_cases(runs: IntensityRuns, rules: HuntFill, limit: LimitState) -> list[tuple[str, float]]:
    over, im = runs.exceeded(limit), runs.table["im"].to_numpy()
    cases = []
    for motion in runs.motions:
        own = runs.table["motion"].to_numpy() == motion
        cases += [(motion, level) for level in rules.next_intensities(im[own], over[own])]
    return cases


def multiple_stripes(
    model: FrameContents,
    motions: object,
    levels: Sequence[float],
    *,
    intensity: Intensity,
    **options: Any,
) -> IntensityRuns:
    """Analyse a structure under all motions, each scaled to each of some intensities.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions. Where each stripe has motions of its own, join the runs of several calls.
    levels : sequence of float
        Intensities of the stripes, in the unit of the measure.
    intensity : Intensity
        The measure.
    **options
        Of `time_histories`.

    Returns
    -------
    IntensityRuns
        A run a motion and stripe.

    Raises
    ------
    FragilityError
        If there is no level, or one is not positive.
    """
    require_type("intensity", intensity, Intensity, "an Intensity")
    if not len(levels):
        msg = "levels is empty: give the intensities of the stripes"
        raise FragilityError(msg)
    stripes = [require_positive("level", each, error=FragilityError) for each in levels]
    grounds = named_motions(motions)
    cases = [(motion, level) for motion in grounds for level in stripes]
    return run_at(model, grounds, cases, intensity, options)


def cloud_analysis(
    model: FrameContents,
    motions: object,
    *,
    intensity: Intensity,
    scales: Sequence[float] = (1.0,),
    **options: Any,
) -> IntensityRuns:
    """Analyse a structure under motions as they are, or times a few factors.

    Parameters
    ----------
    model : Frame
        The structure.
    motions : GroundMotion, or a sequence or mapping of them
        The motions.
    intensity : Intensity
        The measure that demands are regressed on.
    scales : sequence of float
        Factors on all motions [-], positive.
    **options
        Of `time_histories`.

    Returns
    -------
    IntensityRuns
        A run a motion and factor.

    Raises
    ------
    FragilityError
        If there is no factor, or one is not positive.
    """
    require_type("intensity", intensity, Intensity, "an Intensity")
    if not len(scales):
        msg = "scales is empty: give factors on the motions, 1 for as they are"
        raise FragilityError(msg)
    factors = [require_positive("scale", each, "-", error=FragilityError) for each in scales]
    grounds = named_motions(motions)
    own = {name: intensity.of(motion) for name, motion in grounds.items()}
    cases = [(name, factor * own[name]) for name in grounds for factor in factors]
    return run_at(model, grounds, cases, intensity, options)
