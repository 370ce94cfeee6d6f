"""Fragility fitted to clouds: a line through the logarithms of demands, and collapse apart."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import CollapseFragility, Fragility
from frames.risk.fragility.fitting import RESAMPLES, checked_runs, no_fit, resampled
from frames.risk.fragility.intensity import IntensityMeasure, unit_of
from frames.risk.fragility.likelihood import binomial
from lir_element.argument_checks import require_positive

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from frames._types import FloatArray


def fit_cloud(
    im: npt.ArrayLike,
    demand: npt.ArrayLike,
    limit: float,
    records: Sequence[str],
    *,
    name: str = "",
    unit: str | None = None,
    intensity: IntensityMeasure | None = None,
    resamples: int = RESAMPLES,
    seed: int = 1,
) -> Fragility | CollapseFragility:
    """Fit a curve to a cloud: a line through the logarithms of demand and intensity.

    Parameters
    ----------
    im, demand : array_like, shape (n,)
        Intensity and demand [SI] of each run, both positive; an infinite demand is collapse, NaN
        is left out.
    limit : float
        Limit of the demand [SI].
    records : sequence of str
        Record of each run.
    name, unit : str
        The limit state, and the unit of the intensity: "m/s2", or that of the measure.
    intensity : IntensityMeasure, optional
        The measure, so that the curve is compared with its like alone.
    resamples, seed : int
        Resamples of the records, and their seed.

    Returns
    -------
    Fragility or CollapseFragility
        A lognormal curve if nothing collapsed, else one of five parameters.

    Raises
    ------
    FragilityError
        If the runs do not determine a curve.
    ImportError
        If runs collapsed and the package `pyFragility` is not installed.

    Notes
    -----
    Source: Jalayer, Ebrahimian, Miano, Manfredi and Sezen (2017), Earthquake Eng. Struct. Dyn.
    46:2639-2663: the standard deviation is that of n - 2, collapse a logistic regression.

    Examples
    --------
    >>> import numpy as np
    >>> from frames.risk import fit_cloud
    >>> im = np.geomspace(0.5, 4.0, 12)
    >>> demand = 0.004 * im**1.2 * np.tile([0.9, 1.1], 6)
    >>> curve = fit_cloud(im, demand, 0.01, [str(k) for k in range(12)], resamples=20)
    >>> round(curve.median, 2), round((0.01 / 0.004) ** (1.0 / 1.2), 2)
    (2.14, 2.15)
    """
    at, found = checked_runs(im, demand, records)
    bound = require_positive("limit", limit, error=FragilityError)
    known = ~np.isnan(found)
    at, found = at[known], found[known]
    if (found <= 0.0).any():
        msg = f"demand = {found.min():g} must be positive: leave such runs out of the cloud"
        raise FragilityError(msg)
    names, of = np.unique(np.array(records, dtype=str)[known], return_inverse=True)
    fell = np.isinf(found)
    x, y = np.log(at), np.log(np.where(fell, 1.0, found))
    line = _line(x[~fell], y[~fell], np.ones(int((~fell).sum())))
    if line is None:
        msg = f"{(~fell).sum()} runs without collapse determine no rising line: run more motions"
        raise FragilityError(msg)
    common: dict[str, Any] = {
        "name": name,
        "unit": unit_of(unit, intensity),
        "intensity": intensity,
        "records": tuple(names),
        "seed": seed,
        "data": pd.DataFrame({"im": at, "demand": found, "collapsed": fell}),
    }
    goal = math.log(bound)
    if not fell.any():

        def plain(weights: FloatArray) -> FloatArray | None:
            again = _line(x, y, weights[of])
            return None if again is None else _of_line(again, goal)

        median, dispersion = _of_line(line, goal)
        return Fragility(
            method="cloud (Jalayer et al. 2017)",
            median=float(median),
            dispersion=float(dispersion),
            covariance=_cloud_covariance(x, line, goal),
            parameters=resampled(len(names), plain, 2, resamples, seed),
            **common,
        )
    fitted = binomial(at, fell.astype(np.float64), np.ones(len(at)), "logit")
    if fitted is None:
        raise FragilityError(no_fit(at, fell.astype(np.float64)))
    start = fitted.parameters

    def both(weights: FloatArray) -> FloatArray | None:
        own = weights[of]
        some = own > 0.0
        again = _line(x[~fell], y[~fell], own[~fell])
        falls = binomial(at[some], (own * fell)[some], own[some], "logit", start=start)
        return None if again is None or falls is None else np.array([*again, *falls.parameters])

    return CollapseFragility(
        method="cloud with collapse (Jalayer et al. 2017)",
        limit=bound,
        values=(float(line[0]), float(line[1]), float(line[2]), float(start[0]), float(start[1])),
        parameters=resampled(len(names), both, 5, resamples, seed),
        **common,
    )


def _line(x: FloatArray, y: FloatArray, weights: FloatArray) -> FloatArray | None:
    # Intercept, slope and standard deviation (of n - 2) of a line; None if it does not rise.
    total = weights.sum()
    if total < 3.0 or len(np.unique(x[weights > 0.0])) < 3:
        return None
    mean_x, mean_y = np.average(x, weights=weights), np.average(y, weights=weights)
    slope = (weights * (x - mean_x) * (y - mean_y)).sum() / (weights * (x - mean_x) ** 2).sum()
    start = mean_y - slope * mean_x
    square = (weights * (y - start - slope * x) ** 2).sum() / (total - 2.0)
    return np.array([start, slope, math.sqrt(square)]) if slope > 0.0 and square > 0.0 else None


def _of_line(line: FloatArray, goal: float) -> FloatArray:
    # Median and dispersion of the intensity at which a line reaches a logarithm.
    start, slope, spread = line
    return np.array([math.exp((goal - start) / slope), spread / slope])


def _cloud_covariance(x: FloatArray, line: FloatArray, goal: float) -> FloatArray:
    # Start of ln median and dispersion, from least squares.
    start, slope, spread = line
    design = np.column_stack([np.ones_like(x), x])
    whole = np.zeros((3, 3))
    whole[:2, :2] = spread**2 * np.linalg.inv(design.T @ design)
    whole[2, 2] = 0.5 * spread**2 / (len(x) - 2.0)
    log_median = (goal - start) / slope
    jacobian = np.array(
        [
            [-1.0 / slope, -log_median / slope, 0.0],
            [0.0, -spread / slope**2, 1.0 / slope],
        ]
    )
    return np.asarray(jacobian @ whole @ jacobian.T)
