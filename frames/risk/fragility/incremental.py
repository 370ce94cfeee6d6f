"""Results of an incremental dynamic analysis: curves, capacities, fractiles."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.risk._errors import FragilityError
from frames.risk.fragility.hunt_fill import HuntFill
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.runs import GIVEN, HUNT, IntensityRuns
from lir_element.texts import Shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from frames._types import BoolArray, FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class IDA(Shown):
    """An incremental dynamic analysis: runs of each motion from low intensities to the limit.

    Parameters
    ----------
    runs : IntensityRuns
        All runs.
    limit : LimitState
        Limit state of the search.
    rules : HuntFill
        Rules for the next intensities.

    Notes
    -----
    Between runs demands are linear in the intensity, from zero at zero.

    Examples
    --------
    In the gallery: "Incremental dynamic analysis" (docs/gallery/research/a_ida.py).
    """

    runs: IntensityRuns
    limit: LimitState
    rules: HuntFill

    def __post_init__(self) -> None:
        # the runs keep that the rules chose the intensities
        plans = self.runs.of("plan")
        table = self.runs.table.assign(plan=np.where(plans == GIVEN, HUNT, plans))
        object.__setattr__(self, "runs", replace(self.runs, table=table))

    def _rows(self) -> list[tuple[str, str]]:
        return [("limit state", self.limit.name), *self.runs._rows()]

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
            Rising intensities "im" and demands "demand": infinite if a bearing failed; runs that
            failed numerically are left out.

        Raises
        ------
        FragilityError
            If motion or quantity are not known.
        """
        if motion not in self.runs.motions:
            msg = f"motion = {motion!r}: choose one of {', '.join(self.runs.motions)}"
            raise FragilityError(msg)
        own = self.runs.where(motion=motion)
        found = pd.DataFrame({"im": own.of("im"), "demand": own.demand(quantity)})
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
            A row a motion. "capacity": intensity at which the demand reaches the limit, on the line
            between two runs, or their geometric mean if a bearing failed at the upper one (also if
            the limit is zero; half of the upper one if no run is below the limit). "lower" and
            "upper": these runs. "censored": no run exceeds the limit, and the capacity is that of
            the highest run. "resurrects": a run above one that exceeds does not exceed. "failed":
            number of failed runs.

        Raises
        ------
        FragilityError
            If the structure does not have the limit's quantity, or no run of a motion succeeded.
        """
        return capacities_of(self.runs, self.limit if limit is None else limit)

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
        ndarray, shape (n_motions, m)
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
            Fractiles [%]; by default those of plus and minus a standard deviation.

        Returns
        -------
        pandas.DataFrame
            A row an intensity, a column a fractile: infinite if that share of the motions fails a
            bearing, NaN if a motion was not run as high. No value is interpolated between motions
            of which one fails.

        Raises
        ------
        FragilityError
            If the quantity is not known.
        """
        highest = float(self.runs.of("im").max())
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


def capacities_of(runs: IntensityRuns, limit: LimitState) -> pd.DataFrame:
    """Return the intensity at which each motion first reaches a limit state: `IDA.capacities`."""
    rows = []
    for (motion,), own in runs.by("motion").items():
        over, im = own.exceeded(limit), own.of("im")
        order = np.argsort(im, kind="stable")
        known = order[~np.isnan(over[order])]
        if not len(known):
            msg = f"{motion}: no run succeeded, so its capacity is unknown: leave it out"
            raise FragilityError(msg)
        values = None if limit.quantity is None else own.demand(limit.quantity)[known]
        found = _first_crossing(im[known], over[known] > 0.5, values, limit.limit)
        rows.append({**found, "failed": len(order) - len(known)})
    return pd.DataFrame(rows, index=pd.Index(runs.motions, name="motion"))


def _first_crossing(
    im: FloatArray, exceeds: BoolArray, values: FloatArray | None, limit: float | None
) -> dict[str, float | bool]:
    # Runs of one motion in rising order.
    if not exceeds.any():
        top = float(im[-1])
        return {
            "capacity": top,
            "lower": top,
            "upper": math.nan,
            "censored": True,
            "resurrects": False,
        }
    k = int(np.argmax(exceeds))
    lower, upper = (float(im[k - 1]) if k else 0.0), float(im[k])
    before = 0.0 if k == 0 or values is None else float(values[k - 1])
    if values is not None and limit and math.isfinite(values[k]):
        capacity = lower + (upper - lower) * (limit - before) / (float(values[k]) - before)
    else:
        capacity = math.sqrt(lower * upper) if lower > 0.0 else 0.5 * upper
    return {
        "capacity": capacity,
        "lower": lower,
        "upper": upper,
        "censored": False,
        "resurrects": bool((~exceeds[k:]).any()),
    }
