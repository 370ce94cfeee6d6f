"""Sensitivity: what of the assumptions decides a result, one at a time and all together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import checked_confidence
from lir_element.argument_checks import require_finite, require_type

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

INTERVAL_RESAMPLES = 200
"""Resamples of the confidence intervals of Sobol' indices."""

Batch = Callable[[list[dict[str, float]]], "Sequence[float]"]
"""Of many sets of parameters to a result each: one call for all, so that it can run a batch."""


@dataclass(frozen=True, eq=False)
class Tornado:
    """Results with one parameter at a time at its lower and upper value.

    Attributes
    ----------
    base : float
        Result with all parameters at their base values.
    table : pandas.DataFrame
        A row a parameter, the widest swing first: values "low", "high" of the parameter, results
        "at low", "at high", and "swing", the size of the difference of both results.

    Examples
    --------
    In the gallery: "Which property matters" (docs/gallery/research/d_tornado.py).
    """

    base: float
    table: pd.DataFrame

    def to_dataframe(self) -> pd.DataFrame:
        """Return a copy of the table."""
        return self.table.copy()


def tornado(results_of: Batch, parameters: Mapping[str, tuple[float, float, float]]) -> Tornado:
    """Change one parameter at a time.

    Parameters
    ----------
    results_of : callable
        Called once with a list of sets of parameters, dicts of numbers by name; returns a result
        each, such as a median displacement of a batch of time histories.
    parameters : mapping of str to (float, float, float)
        Low, base and high value by name.

    Returns
    -------
    Tornado
        Results, the widest swing first.

    Raises
    ------
    FragilityError
        If there is no parameter, values are not in order, or a result is not finite.

    Notes
    -----
    Take low and high as wide as what is not known: gradients by small differences are rough (by
    friction 7 % over a range of 0.4 %), as peaks with stick, slip and impacts are not smooth.

    Examples
    --------
    >>> def squares(sets):
    ...     return [10.0 * each["a"] ** 2 + each["b"] for each in sets]
    >>> found = tornado(squares, {"b": (0.0, 1.0, 3.0), "a": (1.0, 2.0, 3.0)})
    >>> found.base, list(found.table.index), found.table["swing"].tolist()
    (41.0, ['a', 'b'], [80.0, 3.0])
    """
    if not parameters:
        msg = "parameters is empty: name at least one with its low, base and high value"
        raise FragilityError(msg)
    for name, values in parameters.items():
        if np.shape(values) != (3,) or not values[0] <= values[1] <= values[2]:
            msg = f"{name} = {values!r}: give its low, base and high value, in this order"
            raise FragilityError(msg)
        for value in values:
            require_finite(name, value, error=FragilityError)
    base = {name: float(values[1]) for name, values in parameters.items()}
    sets = [dict(base)]
    for name, (low, _, high) in parameters.items():
        sets += [{**base, name: float(low)}, {**base, name: float(high)}]
    found = _results(results_of, sets)
    lows, highs = found[1::2], found[2::2]
    table = pd.DataFrame(
        {
            "low": [float(v[0]) for v in parameters.values()],
            "high": [float(v[2]) for v in parameters.values()],
            "at low": lows,
            "at high": highs,
            "swing": np.abs(highs - lows),
        },
        index=pd.Index(list(parameters), name="parameter"),
    )
    return Tornado(float(found[0]), table.sort_values("swing", ascending=False, kind="stable"))


@dataclass(frozen=True, eq=False)
class SobolIndices:
    """Shares of the variance of a result.

    Attributes
    ----------
    table : pandas.DataFrame
        A row a parameter: "first" index, what it explains alone, and "total" index, with all that
        it does together with others; each with "low" and "high" of its confidence interval.
    mean, deviation : float
        Of the result.
    runs : int
        Results that were formed.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import sobol_indices
    >>> def results(sets):
    ...     return [each["a"] + 0.1 * each["b"] for each in sets]
    ...
    >>> inputs = {"a": uniform(), "b": uniform()}
    >>> found = sobol_indices(results, inputs, samples=64)
    >>> bool(found.table.loc["a", "total"] > 0.9)
    True
    """

    table: pd.DataFrame
    mean: float
    deviation: float
    runs: int

    def to_dataframe(self) -> pd.DataFrame:
        """Return a copy of the table."""
        return self.table.copy()


def sobol_indices(
    results_of: Batch | npt.ArrayLike,
    distributions: Mapping[str, Any],
    *,
    samples: int = 256,
    seed: int = 1,
    confidence: float = 0.9,
) -> SobolIndices:
    """Return Sobol' indices of a result, by `scipy.stats.sobol_indices`.

    Parameters
    ----------
    results_of : callable, or array_like of shape (samples * (parameters + 2),)
        As for `tornado`; called once with all sets. Or results that are there, one for each set of
        `saltelli_sample` of the same distributions, samples and seed: those of a campaign.
    distributions : mapping of str to distribution
        Independent distributions of the parameters: frozen ones of `scipy.stats`, such as
        ``scipy.stats.uniform(0.05, 0.02)``, or whatever has a method `ppf`.
    samples : int
        Samples, a power of 2.
    seed : int
        Seed of the samples and of the intervals.
    confidence : float
        Confidence of the intervals [-].

    Returns
    -------
    SobolIndices
        First and total indices.

    Raises
    ------
    FragilityError
        If an argument is out of its bounds, or results are not finite or all the same.

    Notes
    -----
    Source: Saltelli et al. (2010), Comput. Phys. Commun. 181:259-270.

    Examples
    --------
    >>> from scipy.stats import uniform
    >>> from frames.risk import sobol_indices
    >>> def results(sets):
    ...     return [each["a"] + 0.1 * each["b"] for each in sets]
    ...
    >>> inputs = {"a": uniform(), "b": uniform()}
    >>> found = sobol_indices(results, inputs, samples=64)
    >>> found.table["first"].idxmax()
    'a'
    """
    sets = saltelli_sets(distributions, samples, seed)
    names, d = list(distributions), len(distributions)
    values = _results(results_of, sets)
    if not np.ptp(values) > 0.0:
        msg = f"all {len(values)} results are {values[0]:g}: nothing depends on the parameters"
        raise FragilityError(msg)
    table = values.reshape(d + 2, samples)
    whole = indices_of(table)
    rng = np.random.default_rng(seed)
    rng.random(2 * d)  # those of the points
    again = np.array(
        [indices_of(table[:, rng.integers(0, samples, samples)]) for _ in range(INTERVAL_RESAMPLES)]
    )
    tail = 0.5 * (1.0 - checked_confidence(confidence))
    low, high = np.quantile(again, [tail, 1.0 - tail], axis=0)
    shares = {
        f"{kind}{end}": found[k]
        for k, kind in enumerate(("first", "total"))
        for end, found in (("", whole), (", low", low), (", high", high))
    }
    return SobolIndices(
        pd.DataFrame(shares, index=pd.Index(names, name="parameter")),
        float(table[:2].mean()),
        float(table[:2].std(ddof=1)),
        len(values),
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
    from scipy.stats import qmc  # takes longer than all of `import frames`

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
    """Return first and total indices of the results of `saltelli_sets`.

    Shapes: result (2, d).
    """
    from scipy import stats

    found = stats.sobol_indices(
        func={"f_A": table[None, 0], "f_B": table[None, 1], "f_AB": table[2:, None]},
        n=table.shape[1],
    )
    return np.array([np.ravel(found.first_order), np.ravel(found.total_order)])


def _results(results_of: Batch | npt.ArrayLike, sets: list[dict[str, float]]) -> FloatArray:
    given = results_of(sets) if callable(results_of) else results_of
    found = np.asarray(given, dtype=np.float64)
    if found.shape != (len(sets),):
        msg = (
            f"results have the shape {found.shape}: return one number for each of {len(sets)} sets"
        )
        raise FragilityError(msg)
    if not np.isfinite(found).all():
        k = int(np.flatnonzero(~np.isfinite(found))[0])
        msg = f"the result for {sets[k]} is {found[k]}: results must be finite"
        raise FragilityError(msg)
    return found
