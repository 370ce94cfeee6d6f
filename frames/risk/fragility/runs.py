"""Runs at known intensities: their outcome and demands, for fragility and loss."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.batch.cases import NOT_BUILT
from frames.batch.runs import Rows
from frames.design.hazard.motion_set import facts_of
from frames.risk._errors import FragilityError
from frames.risk.fragility.intensity import OWN, IntensityMeasure, is_same
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.reading import Sets, motions_of, rows_of
from frames.risk.fragility.scaled_motions import values_of
from lir_element.argument_checks import require_choice, require_type
from lir_element.errors import RunStatus
from lir_element.texts import Shown

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray, FloatArray

COMPLETE, FAILURE, UNKNOWN = "complete", "bearing failure", "numerical failure"
UNBUILT = "not built"
"""Outcomes. The run is complete; a bearing failed (`RunStatus.is_bearing_failure`), which is
collapse; the analysis failed, without a result for the structure; a set of parameters makes no
structure, so that nothing was analysed.
"""

STRIPES, CLOUD, HUNT, GIVEN = "stripes", "cloud", "hunt", "given"
"""Plans of runs: intensities that are common to the motions; factors on them; intensities that
followed from the outcomes of the runs before; and others, of which nothing is known. The column
"plan" holds them, so that every part of a table keeps its own."""

FIXED = ("motion", "scale", "im", "outcome", "status", "message")
"""Columns of the table before those of the demands."""


def outcome_of(status: str) -> str:
    """Return the outcome for a limit state of a status of `time_histories`."""
    if status == NOT_BUILT:
        return UNBUILT
    require_choice("status", status, [s.name.lower() for s in RunStatus], error=FragilityError)
    found = RunStatus[status.upper()]
    if found.is_complete:
        return COMPLETE
    return FAILURE if found.is_bearing_failure else UNKNOWN


@dataclass(frozen=True, eq=False, repr=False)
class IntensityRuns(Rows, Shown):
    """Runs of one structure under motions of known intensity.

    Parameters
    ----------
    table : pandas.DataFrame
        A row a run: "motion", "scale" [-], "im" (in `intensity.unit`), "outcome", "status",
        "message", a column a quantity of `frames.peaks` (SI). "plan" is the choice of the
        intensity: "stripes", "cloud", "hunt" (by the outcome of earlier runs) or "given", the
        default without the column.
    intensity : IntensityMeasure
        Intensity measure of "im".
    units : mapping of str to str
        Units of the quantities.

    Raises
    ------
    FragilityError
        If a column is missing, there is no run, or an intensity is not positive.

    Examples
    --------
    >>> from frames.demo import example
    >>> from frames.risk import Intensity, multiple_stripes
    >>> frame, pulse = example(1.0)
    >>> intensity = Intensity(kind="PGA", measure="x")
    >>> runs = multiple_stripes(frame, pulse, [0.5, 1.0], intensity=intensity, workers=1)
    >>> len(runs.table), runs.motions, len(runs.failed)
    (2, ('pulse',), 0)
    """

    table: pd.DataFrame
    intensity: IntensityMeasure
    units: Mapping[str, str]

    def __post_init__(self) -> None:
        """Check."""
        require_type("table", self.table, pd.DataFrame, "a pandas DataFrame")
        require_type("intensity", self.intensity, IntensityMeasure, OWN)
        missing = [name for name in FIXED if name not in self.table.columns]
        if missing or self.table.empty:
            msg = f"table has no column {missing[0]!r}" if missing else "table has no run"
            raise FragilityError(f"{msg}: take IntensityRuns.from_dataset")  # noqa: EM102
        im = self.table["im"].to_numpy(dtype=np.float64)
        if not (np.isfinite(im) & (im > 0.0)).all():
            msg = f"im = {im.min():g} {self.intensity.unit} must be positive: scale upwards from 0"
            raise FragilityError(msg)
        unknown = sorted({*map(str, self.of("plan"))} - {STRIPES, CLOUD, HUNT, GIVEN})
        if unknown:
            msg = f"plan = {unknown[0]!r}: choose one of {STRIPES}, {CLOUD}, {HUNT}, {GIVEN}"
            raise FragilityError(msg)

    def of(self, name: str) -> np.ndarray[Any, Any]:
        """Return a column of the table, (n,); of "plan" without one "given"."""
        if name == "plan":
            without = pd.Series(GIVEN, self.table.index)
            return np.asarray(self.table.get(name, without).fillna(GIVEN), dtype=object)
        return np.asarray(self.table[name])

    def those(self, mask: BoolArray) -> IntensityRuns:
        """Return rows by a mask, (n,)."""
        return replace(self, table=self.table[mask])

    def _rows(self) -> list[tuple[str, str]]:
        counts = Counter(self.table["outcome"]).most_common()
        return [
            ("runs", str(len(self.table))),
            ("motions", str(len(self.motions))),
            ("intensity", self.intensity.label),
            ("outcomes", "; ".join(f"{count} {name}" for name, count in counts)),
            ("intensities chosen by", "; ".join(dict.fromkeys(self.of("plan")))),
        ]

    @classmethod
    def from_dataset(
        cls,
        data: xr.Dataset,
        motions: object,
        intensity: IntensityMeasure,
        model: str | None = None,
        *,
        parameters: Sets = None,
        plan: str = GIVEN,
    ) -> IntensityRuns:
        """Read the runs of one structure from `time_histories` or a campaign.

        Parameters
        ----------
        data : xarray.Dataset
            Results of `time_histories` or of a campaign; incomplete runs are left out.
        motions : GroundMotion, or a sequence or mapping of them
            The motions that were run, before the scales of `data`, by the names of `data`. Their
            digests must be those of the coordinate "motion_digest".
        intensity : IntensityMeasure
            The measure.
        model : str, optional
            Name of the structure; needed if there are several.
        parameters : int, mapping of str to float, or "all", optional
            Set of parameters of a campaign, by its number or its values; needed if there are
            several. "all" pools them: their scatter is then part of the dispersion.
        plan : {"given", "stripes", "cloud", "hunt"}
            Choice of the intensities: "hunt" if they followed from outcomes of earlier runs.

        Returns
        -------
        IntensityRuns
            The runs, in the order of `data`.

        Raises
        ------
        FragilityError
            If there are several structures or sets of parameters, a motion is missing or not the
            one that was run, or no run is done.

        Warns
        -----
        AnalysisWarning
            If runs of a campaign are not done.
        """
        require_type("intensity", intensity, IntensityMeasure, OWN)
        own = rows_of(data, model, parameters)
        grounds = motions_of(own, motions)
        used = [str(name) for name in own["motion"].to_numpy()]
        scale = own["scale"].to_numpy()
        runs = list(zip(used, np.abs(scale).tolist(), strict=True))
        factors: dict[str, list[float]] = {}
        for name, factor in dict.fromkeys(runs):
            factors.setdefault(name, []).append(factor)
        im = {
            (name, factor): value
            for name, each in factors.items()
            for factor, value in zip(each, values_of(intensity, grounds[name], each), strict=True)
        }
        status = [str(s) for s in own["status"].to_numpy()]
        quantities = [str(q) for q in own["quantity"].to_numpy()]
        facts = facts_of(motions)
        table = pd.DataFrame(
            {
                "motion": used,
                "record": [str(facts.get(name, {}).get("made_from", name)) for name in used],
                "scale": scale,
                "im": [float(f"{im[run]:.10g}") for run in runs],  # one of all runs of a stripe
                "outcome": [outcome_of(s) for s in status],
                "status": status,
                "message": [str(m) for m in own["message"].to_numpy()],
                "plan": plan,
            }
            | {q: own["peak"].sel(quantity=q).to_numpy() for q in quantities}
        )
        units = dict(zip(quantities, (str(u) for u in own["unit"].to_numpy()), strict=True))
        return cls(table, intensity, units)

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the motions, in the order of their first runs."""
        return tuple(dict.fromkeys(self.table["motion"]))

    @property
    def records(self) -> list[str]:
        """Name of the record of each run: motions that are made of one record count as one."""
        return [str(name) for name in self.table.get("record", self.table["motion"])]

    @property
    def failed(self) -> pd.DataFrame:
        """Runs that failed numerically: nothing is known of them."""
        return self.table[self.table["outcome"] == UNKNOWN].loc[:, list(FIXED)]

    def demand(self, quantity: str) -> FloatArray:
        """Return the demand of each run.

        Parameters
        ----------
        quantity : str
            A quantity of `frames.peaks`.

        Returns
        -------
        ndarray, shape (n,)
            Demands [SI]; infinite if a bearing failed, NaN if the analysis failed.

        Raises
        ------
        FragilityError
            If the structure does not have the quantity.
        """
        require_choice("quantity", quantity, tuple(self.units), error=FragilityError)
        found = self.table[quantity].to_numpy(dtype=np.float64)
        outcome = self.of("outcome")
        return np.where(outcome == COMPLETE, found, np.where(outcome == FAILURE, np.inf, np.nan))

    def exceeded(self, limit: LimitState) -> FloatArray:
        """Return the exceedance of a limit state in each run.

        Parameters
        ----------
        limit : LimitState
            The limit state.

        Returns
        -------
        ndarray, shape (n,)
            1 or 0, NaN if the analysis failed or nothing was built.

        Raises
        ------
        FragilityError
            If the structure does not have its quantity, or a complete run has no value of it.
        """
        require_type("limit", limit, LimitState, "a LimitState")
        outcome = self.of("outcome")
        if limit.quantity is None or limit.limit is None:
            lost = self.of("status") == RunStatus.BEARING_LOST.name.lower()
            found = ((outcome == FAILURE) | lost).astype(np.float64)
        else:
            demand = self.demand(limit.quantity)
            if np.isnan(demand[outcome == COMPLETE]).any():
                msg = f"{limit.name}: complete runs have no {limit.quantity!r}: take another limit"
                raise FragilityError(msg)
            found = (demand > limit.limit).astype(np.float64)
        return np.where(np.isin(outcome, (COMPLETE, FAILURE)), found, np.nan)

    def joined(self, other: IntensityRuns) -> IntensityRuns:
        """Return these runs and others of the same structure and measure.

        Parameters
        ----------
        other : IntensityRuns
            The others.

        Returns
        -------
        IntensityRuns
            All of them.

        Raises
        ------
        FragilityError
            If the measures differ.
        """
        if not is_same(other.intensity, self.intensity):
            msg = f"{other.intensity.label} is not {self.intensity.label}: take one measure"
            raise FragilityError(msg)
        tables = [each.table.assign(plan=each.of("plan")) for each in (self, other)]
        table = pd.concat(tables, ignore_index=True)
        return IntensityRuns(table, self.intensity, {**self.units, **other.units})

    def to_dataframe(self) -> pd.DataFrame:
        """Return a copy of the table."""
        return self.table.copy()
