"""Risk: how often a limit state is exceeded, and which intensities contribute to it."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import CollapseFragility, Estimate, Fragility, checked_confidence
from frames.risk.fragility.hazard_curve import HazardCurve
from frames.risk.fragility.intensity import IntensityMeasure, require_one_measure
from lir_element.argument_checks import require_non_negative, require_positive, require_type
from lir_element.texts import Shown

POINTS = 2000
"""Intensities of the integration, equally spaced in their logarithms; and those of the hazard."""

MISSING = 0.05
"""Share of the rate that may come from beyond the ends of the hazard curve without a warning."""


class RiskWarning(UserWarning):
    """A rate or a Sobol' index that is not known well.

    Examples
    --------
    >>> import warnings
    >>> from frames.risk import HazardCurve, lognormal_fragility, mean_annual_frequency
    >>> hazard = HazardCurve([1.0, 4.0], [1e-2, 1e-4])
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     risk = mean_annual_frequency(lognormal_fragility(5.0, 0.4), hazard)
    >>> told[0].category.__name__
    'RiskWarning'
    """


@dataclass(frozen=True, eq=False, repr=False)
class Risk(Shown):
    """Annual rate of exceedance of a limit state.

    Attributes
    ----------
    name : str
        The limit state.
    unit : str
        Unit of the intensity.
    intensity : IntensityMeasure or None
        Intensity measure, of the curve or of the hazard; None if neither has one.
    rate : float
        Mean annual frequency of exceedance [1/year], of intensities within the hazard curve.
    resampled : ndarray, shape (resamples,)
        The same for each resample of the records; NaN if it allowed no fit.
    above : float
        Most that intensities above the hazard curve could add [1/year]: its rate there.
    im, contribution : ndarray, shape (m,)
        Deaggregation: intensities, and the rate's derivative by the intensity's logarithm.

    Examples
    --------
    >>> from frames.risk import HazardCurve, lognormal_fragility, mean_annual_frequency
    >>> hazard = HazardCurve.power(1e-3, 2.5, 0.05, 500.0)
    >>> risk = mean_annual_frequency(lognormal_fragility(5.0, 0.4), hazard)
    >>> round(100.0 * float(risk.probability(50.0)), 2)  # per cent in 50 years
    0.15
    """

    name: str
    unit: str
    rate: float
    resampled: FloatArray
    above: float
    im: FloatArray
    contribution: FloatArray
    intensity: IntensityMeasure | None = None

    def _rows(self) -> list[tuple[str, str]]:
        measure = "" if self.intensity is None else self.intensity.label
        return [
            ("limit state", self.name),
            ("intensity", measure),
            ("rate", f"{self.rate:.3g} 1/year"),
            ("in 50 years", f"{100.0 * self.probability(50.0):.3g} %"),
        ]

    def probability(self, years: float = 50.0) -> float:
        """Return the probability of at least one exceedance.

        Parameters
        ----------
        years : float
            Time [years].

        Returns
        -------
        float
            ``1 - exp(-rate years)``: exceedances as a Poisson process.

        Raises
        ------
        FragilityError
            If the time is negative.
        """
        time = require_non_negative("years", years, "years", error=FragilityError)
        return -math.expm1(-self.rate * time)

    def interval(self, confidence: float = 0.9) -> tuple[float, float]:
        """Return the confidence interval of the rate by resampling the records [1/year].

        Parameters
        ----------
        confidence : float
            Confidence [-].

        Returns
        -------
        tuple of float
            Lower and upper rate.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        tail = 0.5 * (1.0 - checked_confidence(confidence))
        low, high = np.nanquantile(self.resampled, [tail, 1.0 - tail])
        return float(low), float(high)

    def to_dataframe(self) -> pd.DataFrame:
        """Return the deaggregation: "contribution" by the logarithm, "share" up to an intensity."""
        steps = _steps(self.contribution, np.log(self.im))
        share = np.concatenate([[0.0], np.cumsum(steps)]) / max(float(steps.sum()), 1e-300)
        index = pd.Index(self.im, name=f"im [{self.unit}]")
        return pd.DataFrame({"contribution": self.contribution, "share": share}, index=index)


def mean_annual_frequency(curve: Estimate, hazard: HazardCurve) -> Risk:
    """Integrate a fragility curve over a hazard curve.

    Parameters
    ----------
    curve : Fragility or CollapseFragility
        The fragility.
    hazard : HazardCurve
        The hazard, of the same intensity measure; you must ensure that if it has no measure.

    Returns
    -------
    Risk
        ``rate = integral of P(im) |d hazard|``, its interval and its deaggregation.

    Raises
    ------
    FragilityError
        If measures or units differ.

    Warns
    -----
    RiskWarning
        If intensities beyond the ends of the hazard curve could add more than 5 % to the rate.

    Notes
    -----
    Source: Cornell and Krawinkler (2000), PEER Center News 3(2). For ``k0 im**-k`` and a lognormal
    curve it is ``k0 median**-k exp(k**2 dispersion**2 / 2)`` (Cornell 1996).

    Examples
    --------
    >>> import math
    >>> from frames.risk.fragility.curve import lognormal_fragility
    >>> hazard = HazardCurve.power(1e-3, 2.5, 0.05, 500.0)
    >>> found = mean_annual_frequency(lognormal_fragility(5.0, 0.4), hazard)
    >>> round(found.rate / (1e-3 * 5.0**-2.5 * math.exp(0.5 * (2.5 * 0.4) ** 2)), 4)
    1.0
    """
    require_type("curve", curve, (Fragility, CollapseFragility), "a fragility curve")
    require_type("hazard", hazard, HazardCurve, "a HazardCurve")
    require_one_measure(curve, hazard, ("the curve", "the hazard"))
    low, high = hazard.ends
    known = np.asarray(hazard.im, dtype=np.float64)
    im = np.union1d(np.geomspace(low, high, POINTS)[1:-1], known)
    log_im, rates = np.log(im), hazard.rates(im)
    probability, drops = curve.probability(im), -np.diff(rates)
    rate = float(_weighted(probability, drops))
    resampled = _weighted(curve.resampled(im), drops)
    slopes = drops / np.diff(log_im)
    density = np.interp(log_im, 0.5 * (log_im[1:] + log_im[:-1]), slopes)
    beyond = max(float(probability[0] * rates[0]), float(probability[-1] * rates[-1]))
    if beyond > MISSING * rate:
        warnings.warn(
            f"{curve.name or 'the limit state'}: the rate {rate:.3g} 1/year may be too low: "
            f"intensities beyond the ends of the hazard curve, {low:g} to {high:g} {hazard.unit}, "
            "contribute: give more of the curve",
            RiskWarning,
            stacklevel=2,
        )
    return Risk(
        curve.name,
        curve.unit,
        rate,
        np.asarray(resampled),
        float(rates[-1]),
        im,
        np.asarray(probability * density),
        curve.intensity or hazard.intensity,
    )


def _weighted(probability: FloatArray, drops: FloatArray) -> FloatArray:
    # Sum over the steps of the hazard, of the mean of both ends.
    return np.asarray(0.5 * (probability[..., 1:] + probability[..., :-1]) @ drops)


def _steps(values: FloatArray, at: FloatArray) -> FloatArray:
    return np.asarray(0.5 * (values[1:] + values[:-1]) * np.diff(at))


def collapse_margin_ratio(
    median: float, maximum_considered: float, spectral_shape_factor: float = 1.0
) -> float:
    """Return the adjusted collapse margin ratio of FEMA P695.

    Parameters
    ----------
    median : float
        Median collapse intensity, spectral acceleration at the fundamental period.
    maximum_considered : float
        Spectral acceleration of the maximum considered earthquake there, in the same unit.
    spectral_shape_factor : float
        SSF of its table 7-1 [-], by period, ductility and seismic design category; 1 leaves the
        ratio as it is.

    Returns
    -------
    float
        ``ACMR = SSF median / S_MT`` [-] (FEMA P695, 2009, chapter 7; to be confirmed against the
        guideline).

    Raises
    ------
    FragilityError
        If a number is not positive.

    Examples
    --------
    >>> round(collapse_margin_ratio(9.0, 6.0, 1.2), 9)
    1.8
    """
    given = {
        "median": median,
        "maximum_considered": maximum_considered,
        "spectral_shape_factor": spectral_shape_factor,
    }
    a, b, c = (require_positive(n, v, error=FragilityError) for n, v in given.items())
    return c * a / b
