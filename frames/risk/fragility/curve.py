"""Fragility curves: probabilities that a limit state is exceeded, with their confidence."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from frames.risk.fragility.intensity import IntensityMeasure, unit_of
from lir_element.argument_checks import require_between, require_non_negative, require_positive
from lir_element.texts import Shown

if TYPE_CHECKING:
    import numpy.typing as npt


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Estimate(Shown):
    """Fit of a curve: the common part of both kinds of curves.

    Attributes
    ----------
    name : str
        The limit state.
    unit : str
        Unit of the intensity.
    intensity : IntensityMeasure or None
        Intensity measure; None if it was not given.
    method : str
        Method of the fit, with its source.
    records : tuple of str
        Names of the records that were resampled.
    seed : int
        Seed of the resampling: curves of the same records and seed are paired.
    parameters : ndarray, shape (resamples, p)
        Parameters of each resample; NaN if it allowed no fit.
    data : pandas.DataFrame
        Fitted data: "im", and "exceeded" out of "total" for stripes, "capacity" and "censored" for
        an IDA, "demand" and "collapsed" for a cloud.
    """

    name: str
    unit: str
    method: str
    records: tuple[str, ...]
    seed: int
    parameters: FloatArray
    data: pd.DataFrame
    intensity: IntensityMeasure | None = None

    @property
    def lost(self) -> int:
        """Number of resamples that allowed no fit; bands are of the others."""
        return int(np.isnan(self.parameters).any(axis=1).sum())

    def _rows(self) -> list[tuple[str, str]]:
        measure = "" if self.intensity is None else self.intensity.label
        found = [
            ("limit state", self.name),
            ("intensity", measure),
            *self._numbers(),
            ("method", self.method),
            ("records", str(len(self.records))),
        ]
        lost = f"{self.lost} of {len(self.parameters)}" if self.lost else ""
        return [*found, ("resamples without a fit", lost)]

    @abstractmethod
    def _numbers(self) -> list[tuple[str, str]]:
        """Return its parameters for display."""

    @abstractmethod
    def probability(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities, in their shape.

        Parameters
        ----------
        im : array_like
            Intensities, at least 0.

        Returns
        -------
        ndarray
            Probabilities of exceedance.
        """

    @abstractmethod
    def resampled(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities (m,) for each resample, (resamples, m)."""

    def band(self, im: npt.ArrayLike, confidence: float = 0.9) -> tuple[FloatArray, FloatArray]:
        """Return a pointwise confidence band of the curve by resampling the records.

        Parameters
        ----------
        im : array_like, shape (m,)
            Intensities.
        confidence : float
            Confidence of the band at each intensity [-].

        Returns
        -------
        tuple of ndarray, shape (m,)
            Lower and upper probabilities: percentiles of the resamples. They are too narrow below
            some 20 records (docs/fragility.md); of a lognormal curve there is `delta_band`.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        tail = 0.5 * (1.0 - checked_confidence(confidence))
        low, high = np.nanquantile(self.resampled(im), [tail, 1.0 - tail], axis=0)
        return np.asarray(low), np.asarray(high)

    def to_dataframe(
        self, im: npt.ArrayLike | None = None, confidence: float = 0.9
    ) -> pd.DataFrame:
        """Return the curve with its band.

        Parameters
        ----------
        im : array_like, optional
            Intensities; 50 about those of the data if None.
        confidence : float
            Confidence of the band [-].

        Returns
        -------
        pandas.DataFrame
            Columns "probability", "low", "high" over the intensity.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        at = self.grid(50) if im is None else np.atleast_1d(np.asarray(im, dtype=np.float64))
        low, high = self.band(at, confidence)
        columns = {"probability": self.probability(at), "low": low, "high": high}
        return pd.DataFrame(columns, index=pd.Index(at, name=f"im [{self.unit}]"))

    def grid(self, count: int) -> FloatArray:
        """Return intensities from near zero to well above those of the data, shape (count,)."""
        column = "capacity" if "capacity" in self.data else "im"
        return np.linspace(0.0, 1.3 * float(self.data[column].max()), count + 1)[1:]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Fragility(Estimate):
    """A lognormal fragility curve.

    Attributes
    ----------
    median : float
        Intensity of a probability of one half.
    dispersion : float
        Standard deviation of the logarithm of the capacity [-].
    covariance : ndarray, shape (2, 2)
        Covariance of the estimates of ``ln median`` and the dispersion.
    added : float
        Added dispersion for uncertainty besides the records [-]; part of `dispersion`.

    Examples
    --------
    >>> from frames.risk import fit_capacities
    >>> curve = fit_capacities([1.9, 2.1, 2.6, 2.2, 1.7], ["a", "b", "c", "d", "e"])
    >>> round(curve.median, 2), round(float(curve.probability(2.6)), 2)
    (2.08, 0.92)
    """

    median: float
    dispersion: float
    covariance: FloatArray
    added: float = 0.0

    def _numbers(self) -> list[tuple[str, str]]:
        added = f" ({self.added:.3g} of it added)" if self.added else ""
        return [
            ("median", f"{self.median:.4g} {self.unit}"),
            ("dispersion", f"{self.dispersion:.3g}{added}"),
        ]

    def probability(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities, in their shape."""
        return _normal(_distance(im, self.median, self.dispersion))

    def resampled(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities (m,) for each resample, (resamples, m)."""
        median, dispersion = self.parameters.T[:, :, None]
        return _normal(_distance(im, median, dispersion))

    def delta_band(
        self, im: npt.ArrayLike, confidence: float = 0.9
    ) -> tuple[FloatArray, FloatArray]:
        """Return the band by the delta method, from the covariance of the estimates.

        Parameters
        ----------
        im : array_like, shape (m,)
            Intensities, above 0.
        confidence : float
            Confidence of the band at each intensity [-].

        Returns
        -------
        tuple of ndarray, shape (m,)
            Lower and upper probabilities: normal about ``(ln im - ln median) / dispersion``.

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        from scipy.special import ndtri  # as below: not while `frames` is imported

        factor = float(ndtri(0.5 + 0.5 * checked_confidence(confidence)))
        z = np.atleast_1d(_distance(im, self.median, self.dispersion))
        own = math.sqrt(self.dispersion**2 - self.added**2)  # the one that was fitted
        slope = np.stack([-np.ones_like(z), -z * own / self.dispersion]) / self.dispersion
        inside = np.isfinite(z)
        spread = np.zeros_like(z)
        part = slope[:, inside]
        spread[inside] = np.sqrt(np.einsum("im,ij,jm->m", part, self.covariance, part))
        return _normal(z - factor * spread), _normal(z + factor * spread)

    def interval(self, confidence: float = 0.9) -> pd.DataFrame:
        """Return median and dispersion with their confidence intervals by resampling.

        Parameters
        ----------
        confidence : float
            Confidence [-].

        Returns
        -------
        pandas.DataFrame
            Rows "median" and "dispersion", columns "value", "low", "high".

        Raises
        ------
        FragilityError
            If the confidence is out of its bounds.
        """
        tail = 0.5 * (1.0 - checked_confidence(confidence))
        low, high = np.nanquantile(self.parameters, [tail, 1.0 - tail], axis=0)
        columns = {"value": [self.median, self.dispersion], "low": low, "high": high}
        return pd.DataFrame(columns, index=["median", "dispersion"])

    def with_dispersion(self, added: float) -> Fragility:
        """Return the curve with added uncertainty of model, materials and knowledge.

        Parameters
        ----------
        added : float
            Dispersion, instead of any added before [-]; FEMA P695 (chapter 7) combines 0.10 to 0.50
            each by the root of the sum of squares (to be confirmed).

        Returns
        -------
        Fragility
            The flatter curve, of the same median.

        Raises
        ------
        FragilityError
            If it is negative.
        """
        more = require_non_negative("added", added, "-", error=FragilityError)
        spread = np.sqrt(self.parameters[:, 1] ** 2 - self.added**2 + more**2)
        return replace(
            self,
            dispersion=math.sqrt(self.dispersion**2 - self.added**2 + more**2),
            parameters=np.column_stack([self.parameters[:, 0], spread]),
            added=more,
        )


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class CollapseFragility(Estimate):
    """The curve of a cloud in which some runs collapsed: five parameters.

    ``P = p + (1 - p) Phi((ln(a im^b) - ln limit) / dispersion)`` with the probability of collapse
    ``p = 1 / (1 + exp(-(c0 + c1 ln im)))``.

    Attributes
    ----------
    values : tuple of float
        ln a, b, dispersion, c0, c1.
    limit : float
        Limit of the demand [SI].

    Examples
    --------
    >>> from frames.risk import fit_cloud
    >>> import numpy as np
    >>> im = np.geomspace(0.5, 4.0, 12)
    >>> demand = 0.004 * im**1.2 * np.tile([0.9, 1.1], 6)
    >>> demand[[7, 9, 11]] = np.inf  # collapse
    >>> curve = fit_cloud(im, demand, 0.01, [str(k) for k in range(12)], resamples=20)
    >>> type(curve).__name__, len(curve.values)
    ('CollapseFragility', 5)
    """

    values: tuple[float, float, float, float, float]
    limit: float

    def _numbers(self) -> list[tuple[str, str]]:
        return [("median", f"{self.median:.4g} {self.unit}")]

    def probability(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities, in their shape."""
        return _of_cloud(im, self.limit, np.asarray(self.values))

    def resampled(self, im: npt.ArrayLike) -> FloatArray:
        """Return probabilities at intensities (m,) for each resample, (resamples, m)."""
        return _of_cloud(im, self.limit, self.parameters.T[:, :, None])

    @property
    def median(self) -> float:
        """Intensity of a probability of one half."""
        return self._half(np.asarray(self.values))

    def resampled_medians(self) -> FloatArray:
        """Return the median of each resample, (resamples,); NaN if it allowed no fit."""
        rows = self.parameters
        return np.array([self._half(row) if np.isfinite(row).all() else np.nan for row in rows])

    def _half(self, values: FloatArray) -> float:
        # Both parts increase: at the first bracket of the median one of them is one half.
        from scipy.optimize import brentq

        log_a, b, _, c0, c1 = values
        top = min((math.log(self.limit) - log_a) / b, -c0 / c1)

        def excess(log_im: float) -> float:
            return float(_of_cloud(math.exp(log_im), self.limit, values)) - 0.5

        low = top - 1.0
        while excess(low) > 0.0:
            low -= 1.0
        return math.exp(float(brentq(excess, low, top)))


def lognormal_fragility(
    median: float,
    dispersion: float,
    *,
    name: str = "",
    unit: str | None = None,
    intensity: IntensityMeasure | None = None,
) -> Fragility:
    """Return a lognormal curve that is given, not fitted.

    Parameters
    ----------
    median : float
        Median, in `unit`.
    dispersion : float
        Standard deviation of the logarithm [-].
    name, unit : str
        The limit state, and the unit of the intensity: "m/s2", or that of the measure.
    intensity : IntensityMeasure, optional
        The measure.

    Returns
    -------
    Fragility
        The curve; its parameters count as known.

    Raises
    ------
    FragilityError
        If a number is not positive.

    Examples
    --------
    >>> curve = lognormal_fragility(2.0, 0.4)
    >>> curve.probability([2.0, 4.0]).round(3).tolist()
    [0.5, 0.958]
    """
    own = unit_of(unit, intensity)
    middle = require_positive("median", median, own, error=FragilityError)
    spread = require_positive("dispersion", dispersion, "-", error=FragilityError)
    return Fragility(
        name=name,
        unit=own,
        intensity=intensity,
        method="given",
        records=(),
        seed=0,
        parameters=np.array([[middle, spread]]),
        data=pd.DataFrame({"im": [2.0 * middle]}),
        median=middle,
        dispersion=spread,
        covariance=np.zeros((2, 2)),
    )


def checked_confidence(confidence: float) -> float:
    """Return a confidence between 0 and 1, or raise a FragilityError."""
    require_positive("confidence", confidence, "-", error=FragilityError)
    return require_between("confidence", confidence, 0.0, 1.0, "-", error=FragilityError)


def _distance(
    im: npt.ArrayLike, median: float | FloatArray, dispersion: float | FloatArray
) -> FloatArray:
    # Standard deviations of the logarithm above the median; minus infinity at 0.
    at = np.asarray(im, dtype=np.float64)
    if (at < 0.0).any():
        msg = f"im = {at.min():g} must be at least 0"
        raise FragilityError(msg)
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(at / median) / dispersion)


def _normal(z: FloatArray) -> FloatArray:
    from scipy.special import ndtr  # a good part of the time of `import frames`

    return np.asarray(ndtr(z))


def _of_cloud(im: npt.ArrayLike, limit: float, values: FloatArray) -> FloatArray:
    from scipy.special import expit

    log_a, b, dispersion, c0, c1 = values
    x = _distance(im, 1.0, 1.0)
    collapse = expit(c0 + c1 * x)
    return np.asarray(
        collapse + (1.0 - collapse) * _normal((log_a + b * x - math.log(limit)) / dispersion)
    )
