"""Two structures, as with two devices, under the same records: which is better, how surely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from frames._errors import FragilityError
from frames._types import FloatArray
from frames.fragility.curve import CollapseFragility, Fragility, checked_confidence
from frames.fragility.hazard_curve import HazardCurve
from frames.fragility.risk import mean_annual_frequency
from lir_element.door import require_type


@dataclass(frozen=True, eq=False)
class Comparison:
    """A second fragility over a first one, for the same records.

    Attributes
    ----------
    names : tuple of str
        Limit states of the first and the second curve.
    median_ratio : float
        Median of the second over that of the first [-]: above 1 the second holds more.
    median_ratios : ndarray, shape (resamples,)
        The same for each resample; NaN where one of both allowed no fit.
    rates : tuple of float, or None
        Mean annual frequencies of both [1/year]; None without a hazard.
    rate_ratios : ndarray, shape (resamples,), or None
        Rate of the second over that of the first for each resample [-].
    rate_differences : ndarray, shape (resamples,), or None
        Rate of the second less that of the first for each resample [1/year].
    """

    names: tuple[str, str]
    median_ratio: float
    median_ratios: FloatArray
    rates: tuple[float, float] | None
    rate_ratios: FloatArray | None
    rate_differences: FloatArray | None

    def to_dataframe(self, confidence: float = 0.9) -> pd.DataFrame:
        """Return ratios and differences with their intervals.

        Parameters
        ----------
        confidence : float
            Confidence [-].

        Returns
        -------
        pandas.DataFrame
            Rows "median, ratio [-]" and with a hazard "rate, ratio [-]" and "rate, difference
            [1/year]"; columns "value", "low", "high" and "second better", the share of resamples
            in which the second holds more, or is exceeded less often.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        tail = 0.5 * (1.0 - checked_confidence(confidence))
        rows = {"median, ratio [-]": (self.median_ratio, self.median_ratios, 1.0, 1.0)}
        if self.rates is not None and self.rate_ratios is not None:
            first, second = self.rates
            rows["rate, ratio [-]"] = (second / first, self.rate_ratios, 1.0, -1.0)
        if self.rates is not None and self.rate_differences is not None:
            first, second = self.rates
            rows["rate, difference [1/year]"] = (second - first, self.rate_differences, 0.0, -1.0)
        table = {}
        for name, (value, resampled, equal, sign) in rows.items():
            known = resampled[np.isfinite(resampled)]
            low, high = np.quantile(known, [tail, 1.0 - tail])
            table[name] = (value, low, high, float((sign * (known - equal) > 0.0).mean()))
        return pd.DataFrame.from_dict(
            table, orient="index", columns=["value", "low", "high", "second better"]
        )


def compare_fragility(
    first: Fragility | CollapseFragility,
    second: Fragility | CollapseFragility,
    hazard: HazardCurve | None = None,
) -> Comparison:
    """Compare two curves that were fitted to runs under the same records.

    What records do to both alike does not count as uncertainty: each resample takes the same
    records for both (paired bootstrap).

    Parameters
    ----------
    first, second : Fragility or CollapseFragility
        The curves, fitted with the same records, seed and number of resamples.
    hazard : HazardCurve, optional
        For rates; without it medians alone are compared.

    Returns
    -------
    Comparison
        Ratios and differences, and the same of each resample.

    Raises
    ------
    FragilityError
        If the curves are not of the same records, resamples or unit.

    Notes
    -----
    Both curves must be over the same intensity measure; structures of unlike periods are compared
    by rates.
    """
    for name, curve in (("first", first), ("second", second)):
        require_type(name, curve, (Fragility, CollapseFragility), "a fragility curve")
    if first.unit != second.unit:
        msg = f"the curves are in {first.unit} and {second.unit}: take one intensity measure"
        raise FragilityError(msg)
    same = (first.records, first.seed, len(first.parameters)) == (
        second.records, second.seed, len(second.parameters)
    )  # fmt: skip
    if not same or not first.records:
        msg = (
            "the curves are not of the same records, seed and resamples: fit both to runs under "
            "the same motions with one seed"
        )
        raise FragilityError(msg)
    medians = [_medians(curve) for curve in (first, second)]
    rates, ratios, differences = None, None, None
    if hazard is not None:
        risks = [mean_annual_frequency(curve, hazard) for curve in (first, second)]
        rates = (risks[0].rate, risks[1].rate)
        ratios = risks[1].resampled / risks[0].resampled
        differences = risks[1].resampled - risks[0].resampled
    return Comparison(
        (first.name, second.name), second.median / first.median, medians[1] / medians[0],
        rates, ratios, differences,
    )  # fmt: skip


def _medians(curve: Fragility | CollapseFragility) -> FloatArray:
    if isinstance(curve, Fragility):
        return curve.parameters[:, 0]
    return curve.resampled_medians()
