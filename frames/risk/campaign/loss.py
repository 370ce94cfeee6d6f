"""Loss: repair of components after runs, over intensity and a year, device by device."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd
from scipy import special

from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import checked_confidence
from frames.risk.fragility.fitting import RESAMPLES
from frames.risk.fragility.hazard_curve import HazardCurve
from frames.risk.fragility.intensity import is_same
from lir_element.argument_checks import require_choice, require_positive

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.risk.fragility.limit_state import LimitState
    from frames.risk.fragility.runs import IntensityRuns

DRIFT, BELOW, ABOVE = "drift", "floor acceleration", "floor acceleration above"
"""Demands on a component of a storey: its drift, the acceleration of the floor below or above it.
"""

POINTS = 1000
"""Intensities of the integration over the hazard, equally spaced in their logarithms."""


@dataclass(frozen=True, kw_only=True)
class LossComponent:
    """A kind of component: its demand, fragility and repair cost.

    Parameters
    ----------
    name : str
        The component.
    damaged_by : {"drift", "floor acceleration", "floor acceleration above"}
        Demand of its storey; the acceleration is that of the floor below it, or above it, in plan.
    medians, dispersions : sequence of float, (damage states,)
        Lognormal curves of the damage states, which come one after the other: medians rise, drift
        [-] or acceleration [m/s2]; dispersions [-].
    costs : sequence of float, (damage states,)
        Cost of the repair of a unit at each damage state, in any currency.
    quantity : sequence of float
        Units in each storey from below, or one number for each of them.

    Raises
    ------
    FragilityError
        If numbers of damage states differ, or a number is out of its bounds.

    Examples
    --------
    >>> from frames.risk import LossComponent
    >>> walls = LossComponent(
    ...     name="partitions", damaged_by="drift", medians=[0.005, 0.02], dispersions=[0.4, 0.4],
    ...     costs=[100.0, 400.0], quantity=[10.0],
    ... )
    >>> float(walls.cost(0.005).round(1))  # half of them slightly damaged
    50.1
    """

    name: str
    damaged_by: str
    medians: Sequence[float]
    dispersions: Sequence[float]
    costs: Sequence[float]
    quantity: Sequence[float]

    def __post_init__(self) -> None:
        """Check."""
        where = f"component {self.name}"
        require_choice(
            f"{where}: damaged_by", self.damaged_by, (DRIFT, BELOW, ABOVE), error=FragilityError
        )
        sizes = {len(self.medians), len(self.dispersions), len(self.costs)}
        if len(sizes) > 1 or not len(self.medians):
            msg = (
                f"{where}: medians, dispersions and costs differ in length: give one a damage state"
            )
            raise FragilityError(msg)
        for name in ("medians", "dispersions", "quantity"):
            for value in getattr(self, name):
                require_positive(f"{where}: {name}", value, error=FragilityError)
        if (np.diff(self.medians) < 0.0).any() or min(self.costs) < 0.0:
            msg = (
                f"{where}: medians = {[*self.medians]} must rise from state to state, and costs = "
            )
            msg += f"{[*self.costs]} be at least 0"
            raise FragilityError(msg)

    def cost(self, demand: FloatArray | float) -> FloatArray:
        """Return the expected cost of a unit.

        Parameters
        ----------
        demand : array_like
            Drift [-] or acceleration [m/s2].

        Returns
        -------
        ndarray
            Cost, in the shape of the demand.
        """
        with np.errstate(divide="ignore"):
            at = np.log(np.asarray(demand, dtype=np.float64))[..., None]
        reached = special.ndtr((at - np.log(self.medians)) / np.asarray(self.dispersions))
        # states in sequence: none reaches one that has not reached the one before
        steps = np.diff(np.asarray(self.costs), prepend=0.0)
        return np.asarray(np.minimum.accumulate(reached, axis=-1) @ steps)

    def repair(self, data: xr.Dataset) -> FloatArray:
        """Return the expected cost of all units in each run of a Dataset, (runs,)."""
        name = "peak_drift" if self.damaged_by == DRIFT else "peak_floor_plan"
        if name not in data:
            msg = f"component {self.name}: the structure has no storeys: give it levels"
            raise FragilityError(msg)
        demand = data[name].to_numpy()
        if self.damaged_by != DRIFT:
            demand = demand[:, 1:] if self.damaged_by == ABOVE else demand[:, :-1]
        storeys = demand.shape[1]
        if len(self.quantity) not in {1, storeys}:
            msg = (
                f"component {self.name}: {len(self.quantity)} quantities for {storeys} storeys: "
                "give one for each storey, or one number for all"
            )
            raise FragilityError(msg)
        return np.asarray((self.cost(demand) * np.asarray(self.quantity)).sum(axis=1))


LOSS, COLLAPSE = "loss", "collapse"
"""The whole loss, and its part that is the whole building."""


class LossInput(NamedTuple):
    """Input on losses in a campaign's file."""

    components: tuple[LossComponent, ...]
    replacement: float  # cost of a new building, in the currency of the components
    hazard: HazardCurve | dict[str, HazardCurve]
    collapse: LimitState


@dataclass(frozen=True, eq=False)
class ExpectedLoss:
    """Expected losses of structures under the same records, over the cost of a new building.

    Attributes
    ----------
    curves : pandas.DataFrame
        A row a structure and intensity: "loss [-]" with "low" and "high" of its interval, its parts
        by component, that of collapse among them, "runs", and "unknown" ones that are left out.
    annual : pandas.DataFrame
        A row a structure, of each "hazard" if there are several: "loss [1/year]" with its interval
        and its parts; "ratio [-]", the loss of the first structure over it; "below [-]" and
        "above [-]", shares of the loss from intensities below the lowest and above the highest run.

    Examples
    --------
    "Campaigns from a file" (docs/campaigns_file.md), its section Loss.
    """

    curves: pd.DataFrame
    annual: pd.DataFrame


def expected_loss(
    data: xr.Dataset,
    runs: Mapping[str, IntensityRuns],
    components: Sequence[LossComponent],
    hazard: HazardCurve | Mapping[str, HazardCurve],
    *,
    replacement: float,
    collapse: LimitState,
    confidence: float = 0.9,
    resamples: int = RESAMPLES,
    seed: int = 1,
) -> ExpectedLoss:
    """Return expected losses of structures whose records were run at the same intensities.

    Parameters
    ----------
    data : xarray.Dataset
        Results of a campaign.
    runs : mapping of str to IntensityRuns
        Runs by structure, ``IntensityRuns.from_dataset(data, ..., parameters="all")``, over the
        measure of the hazard; the first is the reference of the others.
    components : sequence of LossComponent
        Repaired components.
    hazard : HazardCurve or mapping of str to HazardCurve
        Hazard of the site, or hazards by name, all of one measure.
    replacement : float
        Cost of a new building, in the currency of the components.
    collapse : LimitState
        Limit state for the loss of the building; a failed bearing always counts.
    confidence : float
        Confidence of the intervals [-].
    resamples, seed : int
        Resamples of the records, the same for all structures, and their seed.

    Returns
    -------
    ExpectedLoss
        Losses over intensity and a year, with intervals.

    Raises
    ------
    FragilityError
        If measures differ, records have not the same intensities, or a number cannot be.

    Notes
    -----
    The loss falls straight to 0 below the lowest intensity, and stays as it is above the highest.
    Repair that costs more than a new building is a new building. Runs whose analysis failed are
    left out. Source: the method of FEMA P-58 (2018) with expected values in place of realizations.

    Examples
    --------
    "Campaigns from a file" (docs/campaigns_file.md), its section Loss.
    """
    cost = require_positive("replacement", replacement, error=FragilityError)
    hazards = {"": hazard} if isinstance(hazard, HazardCurve) else dict(hazard)
    if not hazards:
        msg = "hazard is empty: give at least one HazardCurve"
        raise FragilityError(msg)
    tail = 0.5 * (1.0 - checked_confidence(confidence))
    records = sorted({name for each in runs.values() for name in each.records})
    drawn = np.random.default_rng(seed).integers(0, len(records), (resamples, len(records)))
    at, unit = _intensities(runs, hazards), next(iter(hazards.values())).unit
    rows, resampled = [], {}
    means: dict[str, dict[str, FloatArray]] = {}
    for name, own in runs.items():
        parts = {
            part: _by_record(values, own, records, at)
            for part, values in _parts(data, name, own, components, cost, collapse).items()
        }
        total = np.sum([*parts.values()], axis=0)
        with warnings.catch_warnings(action="ignore", category=RuntimeWarning):
            again = resampled[name] = np.nanmean(total[drawn], axis=1)  # NaN if all are unknown
        mean = np.nanmean(total, axis=0)
        curve = {part: np.nanmean(values, axis=0) for part, values in parts.items()}
        means[name] = {LOSS: mean, **curve}
        low, high = np.nanquantile(again, [tail, 1.0 - tail], axis=0)
        table = {"loss [-]": mean, "loss, low [-]": low, "loss, high [-]": high}
        table |= {f"{part} [-]": values for part, values in curve.items()}
        table |= {"runs": np.full(len(at), len(records)), "unknown": np.isnan(total).sum(axis=0)}
        rows.append(pd.DataFrame({"structure": name, f"im [{unit}]": at, **table}))
    yearly = []
    for label, each in hazards.items():
        yearly.append(pd.DataFrame(_annual(means, resampled, at, each, tail)))
        if each is not hazard:
            yearly[-1].insert(0, "hazard", label)
    return ExpectedLoss(pd.concat(rows, ignore_index=True), pd.concat(yearly, ignore_index=True))


def _annual(
    means: Mapping[str, Mapping[str, FloatArray]],
    resampled: Mapping[str, FloatArray],
    at: FloatArray,
    hazard: HazardCurve,
    tail: float,
) -> Iterator[dict[str, object]]:
    # A row a structure: loss, parts, shares from beyond the intensities, ratio of the first.
    curves = {name: np.array([*each.values()]) for name, each in means.items()}
    year = {name: annual_losses(each, at, hazard).tolist() for name, each in curves.items()}
    drawn = {name: annual_losses(each, at, hazard) for name, each in resampled.items()}
    first = next(iter(means))
    highest = float(hazard.rates(np.clip(at[-1], *hazard.ends)))
    for name, each in means.items():
        one, *parts = year[name]
        inside = float(annual_losses(each[LOSS], at, hazard, lowest=float(at[0])))
        low, high = _ends(drawn[name], tail)
        row: dict[str, object] = {"structure": name, "loss [1/year]": one}
        row |= {"loss, low [1/year]": low, "loss, high [1/year]": high}
        row |= {f"{part} [1/year]": v for part, v in zip(list(each)[1:], parts, strict=True)}
        row["below [-]"] = max(one - inside, 0.0) / one if one > 0.0 else 0.0
        row["above [-]"] = float(each[LOSS][-1]) * highest / one if one > 0.0 else 0.0
        if name != first:
            low, high = _ends(drawn[first] / drawn[name], tail)
            ratio = year[first][0] / one
            row |= {"ratio [-]": ratio, "ratio, low [-]": low, "ratio, high [-]": high}
        yield row


def _ends(values: FloatArray, tail: float) -> list[float]:
    return [float(v) for v in np.nanquantile(values, [tail, 1.0 - tail])]


def _intensities(
    runs: Mapping[str, IntensityRuns], hazards: Mapping[str, HazardCurve]
) -> FloatArray:
    # Intensities of every record, or an error: a mean over other records would differ.
    for each, hazard in itertools.product(runs.values(), hazards.values()):
        own, other = each.intensity, hazard.intensity
        if own.unit != hazard.unit or (other is not None and not is_same(own, other)):
            label = hazard.unit if other is None else other.label
            msg = (
                f"the runs are over {own.label}, the hazard over {label}: give it over {own.label}"
            )
            raise FragilityError(msg)
    sets = {
        (name, motion): tuple(sorted({*rows["im"].tolist()}))
        for name, each in runs.items()
        for motion, rows in each.table.groupby("motion")
    }
    if len({*sets.values()}) > 1:
        (_, motion), found = min(sets.items(), key=lambda row: len(row[1]))
        msg = (
            f"record {motion} was run at {len(found)} intensities, others at different ones: run "
            "all records at the same ones, by motions.intensities"
        )
        raise FragilityError(msg)
    return np.array(next(iter(sets.values())))


def _parts(
    data: xr.Dataset,
    name: str,
    runs: IntensityRuns,
    components: Sequence[LossComponent],
    replacement: float,
    collapse: LimitState,
) -> dict[str, FloatArray]:
    # Parts of the expected loss of each run, over the cost of a new building; NaN if unknown.
    done = (data["model"] == name).to_numpy() & (data["status"] != "").to_numpy()
    own = data.isel(run=np.flatnonzero(done))
    lost = runs.exceeded(collapse)
    repair = {each.name: each.repair(own) / replacement for each in components}
    whole = np.sum([*repair.values()], axis=0)
    share = 1.0 / np.maximum(whole, 1.0)
    found = {COLLAPSE: lost}
    return found | {
        part: np.where(lost > 0.0, 0.0, share * values) + 0.0 * lost
        for part, values in repair.items()
    }


def _by_record(
    values: FloatArray, runs: IntensityRuns, records: list[str], at: FloatArray
) -> FloatArray:
    # A table (records, intensities); the mean of sets of parameters and motions of one record.
    table = pd.DataFrame({"record": runs.records, "im": runs.of("im"), "value": values})
    wide = table.pivot_table(index="record", columns="im", values="value", dropna=False)
    return np.asarray(wide.reindex(index=records, columns=at).to_numpy())


def annual_losses(
    loss: FloatArray, at: FloatArray, hazard: HazardCurve, lowest: float = 0.0
) -> FloatArray:
    """Return annual losses of losses (..., n) at intensities (n,), those above a lowest one."""
    low, high = hazard.ends
    low = min(max(low, lowest), high)
    im = np.union1d(np.geomspace(low, high, POINTS), np.clip(at, low, high))
    rate = hazard.rates(im)
    flat = loss.reshape(-1, loss.shape[-1])
    known = np.concatenate([[0.0], at])
    lines = np.array([np.interp(im, known, [0.0, *row]) for row in flat])
    found = 0.5 * (lines[:, 1:] + lines[:, :-1]) @ -np.diff(rate) + lines[:, -1] * rate[-1]
    return np.asarray(found.reshape(loss.shape[:-1]))
