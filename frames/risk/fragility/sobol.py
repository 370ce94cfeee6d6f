"""Sobol' indices: shares of the variance of a result, of one sample or conditional on records."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import checked_confidence
from frames.risk.fragility.record_table import of_campaign
from frames.risk.fragility.risk import RiskWarning
from frames.risk.fragility.sensitivity import Batch
from lir_element.argument_checks import require_positive, require_type

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import BoolArray, FloatArray
    from frames.risk.fragility.record_table import HasResults, Quantity

WIDEST = 0.2
"""Width of the confidence interval of a Sobol' index beyond which it is no result [-]."""

INTERVAL_RESAMPLES = 200
"""Resamples of the confidence intervals of Sobol' indices."""

FEWEST = 8
"""Samples of a record that indices need, those left out not counted."""


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Shares of the variance of a result.

    Attributes
    ----------
    table : pandas.DataFrame
        A row a parameter: "first" index, its own share, and "total" index, its share with all
        interactions; each with "low" and "high" of its confidence interval. NaN if the interval is
        too wide. With results by record they are conditional on the record: shares of the variance
        within records.
    mean, deviation : float
        Variance of the result, of all records together.
    runs : int
        Results that were formed.
    groups : pandas.DataFrame or None
        With results by record: the same of "record" and of all "parameters" together, shares of the
        whole variance.
    left_out : int
        Samples left out, of all records together, because a result of them is not known.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import sobol_indices
    >>> def results(sets):
    ...     return [each["a"] + 0.1 * each["b"] for each in sets]
    ...
    >>> inputs = {"a": uniform(), "b": uniform()}
    >>> found = sobol_indices(results, inputs, samples=1024)
    >>> bool(found.table.loc["a", "total"] > 0.9)
    True
    """

    table: pd.DataFrame
    mean: float
    deviation: float
    runs: int
    groups: pd.DataFrame | None = None
    left_out: int = 0

    def to_dataframe(self) -> pd.DataFrame:
        """Return a copy of the table."""
        return self.table.copy()


def sobol_indices(
    results_of: Batch | npt.ArrayLike | HasResults | xr.Dataset,
    distributions: Mapping[str, Any],
    *,
    samples: int = 256,
    seed: int = 1,
    confidence: float = 0.9,
    widest: float = WIDEST,
    quantity: Quantity = "bearing displacement",
    at_most: float | None = None,
    model: str | None = None,
    scale: float | None = None,
) -> SobolIndices:
    """Return Sobol' indices of a result.

    Parameters
    ----------
    results_of : callable, array_like, Campaign, CampaignStore or xarray.Dataset
        As for `tornado`; called once with all sets. Or existing results, one for each set of
        `saltelli_sample` of the same distributions, samples and seed, of the shape (sets,) or, by
        record, (sets, records); NaN for an unknown one. Or a campaign of that sample.
    distributions : mapping of str to distribution
        Independent distributions of the parameters: frozen ones of `scipy.stats`, such as
        ``scipy.stats.uniform(0.05, 0.02)``, or others that have a method `ppf`.
    samples : int
        Samples, a power of 2.
    seed : int
        Seed of the samples and of the intervals.
    confidence : float
        Confidence of the intervals [-].
    widest : float
        Width of the interval beyond which an index is no result [-].
    quantity : str or callable
        Quantity of a campaign: one of `frames.peaks`, or a function that returns one number for
        each run of the Dataset of one structure.
    at_most : float, optional
        Upper limit of the values of a campaign [SI]; larger ones and those of failed bearings count
        as this.
    model : str, optional
        Structure of a campaign; needed if there are several.
    scale : float, optional
        Factor on the motions of a campaign; needed if there are several.

    Returns
    -------
    SobolIndices
        First and total indices, between 0 and 1.

    Raises
    ------
    FragilityError
        If an argument is out of its bounds, results are all the same, too few samples are known, or
        the campaign is of another sample.

    Warns
    -----
    RiskWarning
        If the confidence interval of an index is wider than `widest`: the index is NaN then.

    Notes
    -----
    Source: Saltelli et al. (2010), Comput. Phys. Commun. 181:259-270. By record: the variances of
    each record are averaged before they are divided, and intervals are of resampled records and
    samples. The shares of records and parameters are of the analysis of variance of both, crossed,
    with random effects (Searle, Casella and McCulloch 1992, Variance Components, 4.3). A
    conditional total index times the total of "parameters" is the index in the whole variance.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import sobol_indices
    >>> def results(sets):
    ...     return [each["a"] + 0.1 * each["b"] for each in sets]
    ...
    >>> inputs = {"a": uniform(), "b": uniform()}
    >>> found = sobol_indices(results, inputs, samples=1024)
    >>> found.table["total"].idxmax()
    'a'
    """
    sets = saltelli_sets(distributions, samples, seed)
    names = list(distributions)
    tail = 0.5 * (1.0 - checked_confidence(confidence))
    limit = require_positive("widest", widest, error=FragilityError)
    given: Any = results_of
    if hasattr(given, "results") or isinstance(given, xr.Dataset):
        given = of_campaign(given, sets, quantity, at_most, model, scale)
    table = _blocks(given(sets) if callable(given) else given, sets, samples)
    known: BoolArray = np.asarray(~np.isnan(table).any(axis=0))  # (records, samples)
    _require_enough(table, known)
    rng = np.random.default_rng(seed)
    rng.random(2 * len(names))  # those of the points
    again = [_resampled(table, known, rng) for _ in range(INTERVAL_RESAMPLES)]
    whole = _parts(table, known)
    several = table.shape[1] > 1
    indices = _Ends(names, *_with_ends([each.indices for each in again], whole.indices, tail))
    groups = None
    if several:
        of_groups = _with_ends([each.groups for each in again], whole.groups, tail)
        groups = _Ends(["record", "parameters"], *of_groups)
    _warn_of_width([each for each in (indices, groups) if each], limit, samples)
    both = table[:2][:, known]
    return SobolIndices(
        indices.frame(limit),
        float(both.mean()),
        float(both.std(ddof=1)),
        int((~np.isnan(table)).sum()),
        None if groups is None else groups.frame(limit),
        int((~known).sum()),
    )


class _Parts(NamedTuple):
    indices: FloatArray  # first and total, (2, parameters)
    groups: FloatArray  # the same of the records and of all parameters, (2, 2)


class _Ends(NamedTuple):
    names: list[str]
    values: FloatArray  # first and total, (2, names)
    low: FloatArray
    high: FloatArray

    def frame(self, widest: float) -> pd.DataFrame:
        """Return the table; values are NaN if their interval is too wide."""
        shown = np.where(self.high - self.low <= widest, np.clip(self.values, 0.0, 1.0), np.nan)
        columns = {
            f"{kind}{end}": np.clip(found[k], 0.0, 1.0)
            for k, kind in enumerate(("first", "total"))
            for end, found in (("", shown), (", low", self.low), (", high", self.high))
        }
        return pd.DataFrame(columns, index=pd.Index(self.names, name="parameter"))


def _with_ends(
    again: list[FloatArray], whole: FloatArray, tail: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    low, high = np.nanquantile(np.array(again), [tail, 1.0 - tail], axis=0)
    return whole, low, high


def _resampled(table: FloatArray, known: BoolArray, rng: np.random.Generator) -> _Parts:
    # Samples drawn anew, and records if there are several.
    _, records, samples = table.shape
    drawn = rng.integers(0, samples, samples)
    rows = rng.integers(0, records, records) if records > 1 else np.zeros(1, dtype=int)
    return _parts(table[:, rows][:, :, drawn], known[rows][:, drawn])


def _parts(table: FloatArray, known: BoolArray) -> _Parts:
    # Results (parameters + 2, records, samples), of which some are known.
    shares = np.zeros((2, len(table) - 2))
    variance = 0.0
    for k, kept in enumerate(known):
        own = table[:, k, kept]
        if own.shape[1] > 1 and np.ptp(own[:2]) > 0.0:
            size = float(own[:2].var())
            shares += size * indices_of(own)
            variance += size
    shares = shares / variance if variance > 0.0 else np.full_like(shares, np.nan)
    return _Parts(shares, _crossed(table[:2]))


def _crossed(blocks: FloatArray) -> FloatArray:
    # Shares of records and of parameters in the whole variance, first and total, by the analysis of
    # variance of both, crossed. Resampled records are fewer: their variance is divided by all.
    values = np.concatenate(blocks, axis=1)  # (records, sets)
    values = values[:, ~np.isnan(values).any(axis=0)]
    records, sets = values.shape
    if records < 2 or sets < 2:
        return np.full((2, 2), np.nan)
    by_record, by_set, mean = values.mean(axis=1), values.mean(axis=0), values.mean()
    rest = values - by_record[:, None] - by_set + mean
    both = float((rest**2).sum()) / ((records - 1) * (sets - 1))
    of_records = max(float(by_record.var(ddof=1)) - both / sets, 0.0)
    of_sets = max(float(by_set.var(ddof=1)) - both / records, 0.0)
    first = np.array([of_records, of_sets])
    whole = of_records + of_sets + both
    return np.array([first, first + both]) / whole if whole > 0.0 else np.full((2, 2), np.nan)


def _blocks(given: npt.ArrayLike, sets: list[dict[str, float]], samples: int) -> FloatArray:
    # Results as (parameters + 2, records, samples).
    found = np.asarray(given, dtype=np.float64)
    if found.ndim not in {1, 2} or len(found) != len(sets):
        msg = (
            f"results have the shape {found.shape}: return one number for each of {len(sets)} "
            "sets, or a row of numbers by record"
        )
        raise FragilityError(msg)
    if np.isinf(found).any():
        k = int(np.flatnonzero(np.isinf(found).reshape(len(sets), -1).any(axis=1))[0])
        msg = f"the result for {sets[k]} is infinite: results must be finite; at_most= bounds them"
        raise FragilityError(msg)
    return found.reshape(-1, samples, found.size // len(sets)).transpose(0, 2, 1)


def _require_enough(table: FloatArray, known: BoolArray) -> None:
    counts = known.sum(axis=1)
    least, samples = min(FEWEST, known.shape[1]), known.shape[1]
    if counts.min() < least:
        msg = (
            f"{counts.min()} of {samples} samples of record {int(counts.argmin())} are known, at "
            f"least {least} must be: take more samples, or distributions whose models can be built"
        )
        raise FragilityError(msg)
    values = table[:, known]
    if not np.ptp(values) > 0.0:
        msg = f"all {values.size} results are {values.flat[0]:g}: vary parameters that matter"
        raise FragilityError(msg)


def _warn_of_width(found: list[_Ends], widest: float, samples: int) -> None:
    # The widest interval; widths decrease with the square root of the samples.
    width, kind, k, ends = max(
        (
            (float(each.high[kind, k] - each.low[kind, k]), kind, k, each)
            for each in found
            for kind in range(2)
            for k in range(len(each.names))
        ),
        key=lambda row: row[0],
    )
    if width <= widest:
        return
    enough = 2 ** math.ceil(math.log2(2.0 * samples * (width / widest) ** 2))
    more = " If records are few, take more records, too" if len(found) > 1 else ""
    warnings.warn(
        f"the {('first', 'total')[kind]} index of {ends.names[k]} is no result: its interval of "
        f"{width:.2f} ({ends.low[kind, k]:.2f} to {ends.high[kind, k]:.2f}) exceeds {widest:g}. "
        f"Take samples={enough}, also in saltelli_sample." + more,
        RiskWarning,
        stacklevel=3,
    )


def saltelli_sets(
    distributions: Mapping[str, Any], samples: int, seed: int
) -> list[dict[str, float]]:
    """Return the sets of parameters of which Sobol' indices are made."""
    require_type("samples", samples, int, "a whole number")
    if samples < 2 or samples & (samples - 1):
        msg = f"samples = {samples} must be a power of 2, such as 256"
        raise FragilityError(msg)
    names = list(distributions)
    bad = [name for name in names if not hasattr(distributions[name], "ppf")]
    if bad or not names:
        what = f"{bad[0]} = {distributions[bad[0]]!r}" if bad else "no parameter"
        msg = f"{what}: give distributions by name, such as scipy.stats.uniform(0.05, 0.02)"
        raise FragilityError(msg)
    from scipy.stats import qmc  # slower than all of `import frames`

    d, rng = len(names), np.random.default_rng(seed)
    points = ((qmc.Sobol(2 * d, scramble=False).random(samples) + rng.random(2 * d)) % 1.0).T
    a, b = (
        np.array([distributions[name].ppf(row) for name, row in zip(names, half, strict=True)])
        for half in (points[:d], points[d:])
    )
    mixed = np.repeat(a[None], d, axis=0)
    mixed[np.arange(d), np.arange(d)] = b
    columns = np.concatenate([a, b, *mixed], axis=1).T
    return [dict(zip(names, map(float, column), strict=True)) for column in columns]


def indices_of(table: FloatArray) -> FloatArray:
    """Return first and total indices of the results of `saltelli_sets`, of any number of samples.

    Shapes: table (d + 2, n), result (2, d). `scipy.stats.sobol_indices` has them for powers of 2.
    """
    a, b, mixed = table[0], table[1], table[2:]
    both = table[:2]
    first = ((b - both.mean()) * (mixed - a)).mean(axis=1)
    total = 0.5 * ((a - mixed) ** 2).mean(axis=1)
    return np.asarray(np.array([first, total]) / both.var())
