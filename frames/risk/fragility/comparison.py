"""Two structures, as with two devices, under the same records: which is better, how surely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import CollapseFragility, Fragility, checked_confidence
from frames.risk.fragility.hazard_curve import HazardCurve
from frames.risk.fragility.intensity import require_one_measure
from frames.risk.fragility.risk import mean_annual_frequency
from lir_element.argument_checks import require_type
from lir_element.texts import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Shown):
    """Ratio of a second fragility to a first one, for the same records.

    Attributes
    ----------
    unit : str
        Unit of the intensity.
    medians : tuple of float
        Medians of the first and the second curve.
    resampled_medians : ndarray, shape (2, resamples)
        The same of each resample; NaN if it allowed no fit.
    rates : tuple of float, or None
        Mean annual frequencies of both [1/year]; None without a hazard.
    resampled_rates : ndarray, shape (2, resamples), or None
        The same of each resample.

    Examples
    --------
    >>> from frames.risk import compare_fragility, fit_capacities
    >>> first = fit_capacities([1.9, 2.1, 2.6, 2.2], list("abcd"))
    >>> second = fit_capacities([2.1, 2.3, 3.0, 2.4], list("abcd"))
    >>> found = compare_fragility(first, second)
    >>> round(found.medians[1] / found.medians[0], 2)
    1.11
    """

    unit: str
    medians: tuple[float, float]
    resampled_medians: FloatArray
    rates: tuple[float, float] | None
    resampled_rates: FloatArray | None

    def _rows(self) -> list[tuple[str, str]]:
        return [
            (str(name), f"{row['value']:.3g} ({row['low']:.3g} to {row['high']:.3g})")
            for name, row in self.to_dataframe().iterrows()
        ]

    def to_dataframe(self, confidence: float = 0.9) -> pd.DataFrame:
        """Return ratio and difference of the second to the first curve, with their intervals.

        Parameters
        ----------
        confidence : float
            Confidence [-].

        Returns
        -------
        pandas.DataFrame
            Rows "median, ratio [-]", "median, difference [...]" and with a hazard the same of the
            rate; columns "value", "low", "high" and "second better", the share of resamples in
            which the second has the larger capacity, or is exceeded less often.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        tail = 0.5 * (1.0 - checked_confidence(confidence))
        rows = _rows("median", self.unit, self.medians, self.resampled_medians, tail, 1.0)
        if self.rates is not None and self.resampled_rates is not None:
            rows |= _rows("rate", "1/year", self.rates, self.resampled_rates, tail, -1.0)
        return pd.DataFrame.from_dict(
            rows, orient="index", columns=["value", "low", "high", "second better"]
        )


def _rows(
    name: str,
    unit: str,
    values: tuple[float, float],
    resampled: FloatArray,
    tail: float,
    better: float,
) -> dict[str, tuple[float, ...]]:
    # Ratio and difference; `better` is the sign of a difference that is good.
    first, second = resampled[:, np.isfinite(resampled).all(axis=0)]
    share = float((better * (second - first) > 0.0).mean())
    ends = [tail, 1.0 - tail]
    ratio, difference = np.quantile(second / first, ends), np.quantile(second - first, ends)
    return {
        f"{name}, ratio [-]": (values[1] / values[0], *map(float, ratio), share),
        f"{name}, difference [{unit}]": (values[1] - values[0], *map(float, difference), share),
    }


def compare_fragility(
    first: Fragility | CollapseFragility,
    second: Fragility | CollapseFragility,
    hazard: HazardCurve | None = None,
) -> Comparison:
    """Compare two curves that were fitted to runs under the same records.

    A common effect of the records does not count as uncertainty: each resample uses the same
    records for both (paired bootstrap).

    Parameters
    ----------
    first, second : Fragility or CollapseFragility
        The curves, fitted with the same records, seed and number of resamples.
    hazard : HazardCurve, optional
        Hazard for rates; without it medians alone are compared.

    Returns
    -------
    Comparison
        Ratios and differences, and the same of each resample.

    Raises
    ------
    FragilityError
        If the curves are not of the same records, resamples, intensity measure or unit.

    Notes
    -----
    Curves without a measure are compared by their units alone. Structures of different periods are
    compared by rates, each with the hazard of its own measure (`mean_annual_frequency`).

    Examples
    --------
    >>> from frames.risk import compare_fragility, fit_capacities
    >>> first = fit_capacities([1.9, 2.1, 2.6, 2.2], list("abcd"))
    >>> second = fit_capacities([2.1, 2.3, 3.0, 2.4], list("abcd"))
    >>> table = compare_fragility(first, second).to_dataframe()
    >>> round(float(table.loc["median, ratio [-]", "value"]), 2)
    1.11
    """
    for name, curve in (("first", first), ("second", second)):
        require_type(name, curve, (Fragility, CollapseFragility), "a fragility curve")
    require_one_measure(first, second, ("the first curve", "the second"))
    same = (first.records, first.seed, len(first.parameters)) == (
        second.records,
        second.seed,
        len(second.parameters),
    )
    if not same or not first.records:
        msg = (
            "the curves differ in records, seed or resamples: fit both to runs of the same motions "
            "with one seed"
        )
        raise FragilityError(msg)
    rates, resampled = None, None
    if hazard is not None:
        risks = [mean_annual_frequency(curve, hazard) for curve in (first, second)]
        rates = (risks[0].rate, risks[1].rate)
        resampled = np.array([each.resampled for each in risks])
    medians = np.array([_medians(curve) for curve in (first, second)])
    return Comparison(first.unit, (first.median, second.median), medians, rates, resampled)


def _medians(curve: Fragility | CollapseFragility) -> FloatArray:
    if isinstance(curve, Fragility):
        return curve.parameters[:, 0]
    return curve.resampled_medians()
