"""Fragility fitted to stripes and to capacities, with records resampled.

Likelihoods of stripes and of censored capacities are those of the package pyFragility (Dahal,
Burton and Onyambu 2022, Structural Safety 96:102185), the optional extra "fragility".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import Fragility
from frames.risk.fragility.intensity import IntensityMeasure, unit_of
from frames.risk.fragility.likelihood import Likely, binomial, censored_lognormal
from lir_element.argument_checks import require_choice, require_positive, require_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

RESAMPLES = 500
"""Default number of resamples of a confidence band."""

LEAST_FITS = 0.5
"""Share of resamples that must allow a fit."""

SPAN = 1.2
"""Least ratio of the largest to the smallest intensity of a curve [-]."""

Fit = Callable[[FloatArray], FloatArray | None]
"""Fit from the weights of the records (n,) to parameters, None if they allow no fit."""


def checked_runs(
    im: npt.ArrayLike, values: npt.ArrayLike, records: Sequence[str]
) -> tuple[FloatArray, FloatArray]:
    """Return intensities and values of runs as arrays (n,), or raise.

    Shapes: im, values (n,), result (n,).
    """
    at, found = np.asarray(im, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if at.ndim != 1 or at.shape != found.shape or len(records) != len(at):
        msg = f"shapes {at.shape}, {found.shape}, {len(records)} records: give lists of one length"
        raise FragilityError(msg)
    if not (np.isfinite(at) & (at > 0.0)).all():
        msg = f"intensity {at[~(at > 0.0)][:1].tolist()} must be positive and finite"
        raise FragilityError(msg)
    return at, found


def resampled(count: int, fit: Fit, size: int, resamples: int, seed: int) -> FloatArray:
    """Return the parameters of fits to records that are drawn with replacement.

    Shapes: result (resamples, size).
    """
    require_type("seed", seed, int, "a whole number")
    require_type("resamples", resamples, int, "a whole number")
    require_positive("resamples", resamples, error=FragilityError)
    rng = np.random.default_rng(seed)
    drawn = rng.multinomial(count, np.full(count, 1.0 / count), resamples).astype(np.float64)
    unlike, of = np.unique(drawn, axis=0, return_inverse=True)  # few records are soon drawn again
    fitted = [fit(weights) for weights in unlike]
    found = np.array([np.full(size, np.nan) if one is None else one for one in fitted])[of.ravel()]
    fits = int(np.isfinite(found).all(axis=1).sum())
    if fits < LEAST_FITS * resamples:
        msg = f"{fits} of {resamples} resamples allow a fit: run more records or intensities"
        raise FragilityError(msg)
    return found


def no_fit(at: FloatArray, over: FloatArray) -> str:
    """Return the reason that outcomes (n,) at intensities (n,) determine no curve."""
    if not over.any() or over.all():
        what = "no run exceeds" if not over.any() else "all runs exceed"
        return f"{what} the limit state: run {'higher' if not over.any() else 'lower'} intensities"
    return (
        f"no fit: exceeded from {at[over > 0.5].min():.4g}, not exceeded up to "
        f"{at[over < 0.5].max():.4g}; the outcomes must overlap and exceedance grow with the "
        "intensity: run more records, or intensities between"
    )


def fit_stripes(
    im: npt.ArrayLike,
    exceeded: npt.ArrayLike,
    records: Sequence[str],
    *,
    name: str = "",
    unit: str | None = None,
    intensity: IntensityMeasure | None = None,
    resamples: int = RESAMPLES,
    seed: int = 1,
) -> Fragility:
    """Fit a lognormal curve to runs that exceed a limit state or do not, by maximum likelihood.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity of each run.
    exceeded : array_like, shape (n,)
        1 if the limit state was exceeded, 0 if not; NaN is left out.
    records : sequence of str
        Record of each run: runs of one record are resampled together.
    name, unit : str
        The limit state, and the unit of the intensity: "m/s2", or that of the measure.
    intensity : IntensityMeasure, optional
        The measure, so that the curve is compared with its like alone.
    resamples : int
        Resamples of the records for the band.
    seed : int
        Seed of the resampling.

    Returns
    -------
    Fragility
        The curve; its covariance is robust, of records as clusters.

    Raises
    ------
    FragilityError
        If the runs do not determine a curve.
    ImportError
        If the package `pyFragility` is not installed.

    Notes
    -----
    Source: Baker (2015), Earthquake Spectra 31:579-599; the same as a regression of probits.

    Examples
    --------
    >>> from frames.risk import fit_stripes
    >>> im = [1.0] * 4 + [2.0] * 4 + [3.0] * 4
    >>> exceeded = [0, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 0]
    >>> curve = fit_stripes(im, exceeded, list("abcd") * 3, resamples=20)
    >>> 1.0 < curve.median < 3.0
    True
    """
    at, over = checked_runs(im, exceeded, records)
    known = ~np.isnan(over)
    at, over = at[known], over[known]
    labels = np.array(records, dtype=object)[known]
    names, of = np.unique(labels.astype(str), return_inverse=True)
    fitted = binomial(at, over, np.ones(len(at)), "probit", clusters=of)
    if fitted is None:
        raise FragilityError(no_fit(at, over))
    if at.max() < SPAN * at.min():
        msg = (
            f"intensities from {at.min():.4g} to {at.max():.4g} are one stripe, which gives no "
            f"median: run two or more, at least {SPAN:g} times apart"
        )
        raise FragilityError(msg)
    start = fitted.parameters
    levels, level = np.unique(at, return_inverse=True)

    def again(weights: FloatArray) -> FloatArray | None:
        own = weights[of]
        total = np.bincount(level, own, len(levels))
        count = np.bincount(level, own * over, len(levels))
        some = total > 0.0
        found = binomial(
            levels[some],
            count[some].astype(np.float64),
            total[some].astype(np.float64),
            "probit",
            start=start,
        )
        return None if found is None else _lognormal(found.parameters)

    median, dispersion = _lognormal(start)
    b0, b1 = start
    jacobian = np.array([[-1.0 / b1, b0 / b1**2], [0.0, -1.0 / b1**2]])
    data = pd.DataFrame(
        {
            "im": levels,
            "exceeded": np.bincount(level, over),
            "total": np.bincount(level),
        }
    )
    return Fragility(
        name=name,
        unit=unit_of(unit, intensity),
        intensity=intensity,
        method="maximum likelihood (Baker 2015)",
        records=tuple(names),
        seed=seed,
        parameters=resampled(len(names), again, 2, resamples, seed),
        data=data,
        median=float(median),
        dispersion=float(dispersion),
        covariance=jacobian @ fitted.covariance @ jacobian.T,
    )


def fit_capacities(
    capacity: npt.ArrayLike,
    records: Sequence[str],
    *,
    censored: npt.ArrayLike | None = None,
    method: Literal["moments", "likelihood"] | None = None,
    name: str = "",
    unit: str | None = None,
    intensity: IntensityMeasure | None = None,
    resamples: int = RESAMPLES,
    seed: int = 1,
) -> Fragility:
    """Fit a lognormal curve to the intensities at which records reach a limit state.

    Parameters
    ----------
    capacity : array_like, shape (n,)
        Intensity of each record, once a record.
    records : sequence of str
        The records.
    censored : array_like of bool, shape (n,), optional
        True if the limit state was not reached up to `capacity`.
    method : {"moments", "likelihood"}, optional
        Mean and standard deviation of the logarithms (of n - 1), or maximum likelihood, which
        includes censored ones; by default the one that the data need.
    name, unit : str
        The limit state, and the unit of the intensity: "m/s2", or that of the measure.
    intensity : IntensityMeasure, optional
        The measure, so that the curve is compared with its like alone.
    resamples, seed : int
        Resamples of the records, and their seed.

    Returns
    -------
    Fragility
        The curve.

    Raises
    ------
    FragilityError
        If there are fewer than three capacities, or they are the same or not positive.
    ImportError
        If capacities are censored and the package `pyFragility` is not installed.

    Notes
    -----
    Source: Ibarra and Krawinkler (2005), PEER 2005/06; Baker (2015), Earthquake Spectra 31:579.

    Examples
    --------
    >>> curve = fit_capacities([1.0, 2.0, 4.0], ["a", "b", "c"])
    >>> round(curve.median, 3), round(curve.dispersion, 3)
    (2.0, 0.693)
    """
    at, _ = checked_runs(capacity, np.ones(np.shape(capacity)), records)
    open_ = np.zeros(len(at), dtype=bool) if censored is None else np.asarray(censored, dtype=bool)
    if open_.shape != at.shape or len(set(records)) != len(at):
        msg = "capacity, censored and records must be lists of one length, a record once"
        raise FragilityError(msg)
    chosen = method or ("likelihood" if open_.any() else "moments")
    require_choice("method", chosen, ("moments", "likelihood"), error=FragilityError)
    if chosen == "moments" and open_.any():
        msg = f"{open_.sum()} capacities are censored: use method='likelihood', or run higher"
        raise FragilityError(msg)
    order = np.argsort(np.array(records, dtype=str), kind="stable")  # as the resamples go
    at, open_ = at[order], open_[order]
    if (~open_).sum() < 3 or not np.ptp(at[~open_]) > 0.0:
        msg = f"{(~open_).sum()} capacities were reached: give at least 3 that are not all equal"
        raise FragilityError(msg)
    logs = np.log(at)

    def moments(weights: FloatArray) -> FloatArray | None:
        mean = np.average(logs, weights=weights)
        square = (weights * (logs - mean) ** 2).sum() / (weights.sum() - 1.0)
        return np.array([math.exp(mean), math.sqrt(square)]) if square > 1e-12 else None

    def likely(weights: FloatArray) -> FloatArray | None:
        own = np.repeat(np.arange(len(at)), weights.astype(np.int64))
        found = censored_lognormal(at[own], open_[own])
        return None if found is None else found.parameters

    if chosen == "moments":
        whole, fit = moments(np.ones(len(at))), moments
        beta = math.nan if whole is None else float(whole[1])
        covariance = beta**2 * np.diag([1.0 / len(at), 0.5 / (len(at) - 1.0)])
    else:
        found, fit = censored_lognormal(at, open_), likely
        whole = None if found is None else found.parameters
        covariance = np.zeros((2, 2)) if found is None else _of_log(found)
    if whole is None:
        msg = f"capacities {at.tolist()} determine no curve: run more records, or higher"
        raise FragilityError(msg)
    return Fragility(
        name=name,
        unit=unit_of(unit, intensity),
        intensity=intensity,
        method=f"IDA, {chosen} (Baker 2015)",
        records=tuple(sorted(map(str, records))),
        seed=seed,
        parameters=resampled(len(at), fit, 2, resamples, seed),
        data=pd.DataFrame({"capacity": at, "censored": open_}),
        median=float(whole[0]),
        dispersion=float(whole[1]),
        covariance=covariance,
    )


def _lognormal(parameters: FloatArray) -> FloatArray:
    # Median and dispersion of a line of probits over logarithms.
    b0, b1 = parameters
    return np.array([math.exp(-b0 / b1), 1.0 / b1])


def _of_log(found: Likely) -> FloatArray:
    # Covariance of ln median and dispersion, from that of both themselves.
    change = np.diag([1.0 / found.parameters[0], 1.0])
    return np.asarray(change @ found.covariance @ change)
