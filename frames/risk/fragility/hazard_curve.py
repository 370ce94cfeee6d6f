"""Hazard curves: mean annual frequencies at which intensities are exceeded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.risk._errors import FragilityError
from frames.risk.fragility.intensity import IntensityMeasure, unit_of
from lir_element.argument_checks import require_positive
from lir_element.texts import Shown

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class HazardCurve(Shown):
    """Mean annual frequency of exceedance over the intensity, straight between logarithms.

    Parameters
    ----------
    im : array_like, shape (n,)
        Rising intensities, of the measure that the fragility is of.
    rate : array_like, shape (n,)
        Falling mean annual frequencies [1/year].
    unit : str, optional
        Unit of the intensities: "m/s2", or that of the measure.
    intensity : IntensityMeasure, optional
        The measure. A fragility curve of another one is refused then; without it units alone are
        compared.

    Raises
    ------
    FragilityError
        If there are fewer than two points, they do not rise and fall, or the unit is not that of
        the measure.

    Examples
    --------
    >>> hazard = HazardCurve([1.0, 10.0], [1e-2, 1e-4])
    >>> round(float(hazard.rates(3.162278)), 7)
    0.001
    """

    im: npt.ArrayLike
    rate: npt.ArrayLike
    unit: str = ""
    intensity: IntensityMeasure | None = None

    def __post_init__(self) -> None:
        """Check and copy."""
        object.__setattr__(self, "unit", unit_of(self.unit or None, self.intensity))
        im, rate = np.array(self.im, dtype=np.float64), np.array(self.rate, dtype=np.float64)
        if im.ndim != 1 or im.shape != rate.shape or len(im) < 2:
            msg = f"im {im.shape} and rate {rate.shape} must be lists of one length, 2 at least"
            raise FragilityError(msg)
        if not (np.isfinite(im).all() and (im > 0.0).all() and (np.diff(im) > 0.0).all()):
            msg = f"im = {im.tolist()} {self.unit} must be positive and rise"
            raise FragilityError(msg)
        if not (np.isfinite(rate).all() and (rate > 0.0).all() and (np.diff(rate) < 0.0).all()):
            msg = f"rate = {rate.tolist()} 1/year must be positive and fall: one for each intensity"
            raise FragilityError(msg)
        for name, values in (("im", im), ("rate", rate)):
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def _rows(self) -> list[tuple[str, str]]:
        (low, high), rate = self.ends, np.asarray(self.rate, dtype=np.float64)
        measure = "not stated" if self.intensity is None else self.intensity.label
        return [
            ("intensity", measure),
            ("from", f"{low:g} to {high:g} {self.unit}"),
            ("rates", f"{rate[0]:.3g} to {rate[-1]:.3g} 1/year"),
        ]

    @classmethod
    def power(
        cls,
        k0: float,
        k: float,
        low: float,
        high: float,
        unit: str = "",
        intensity: IntensityMeasure | None = None,
    ) -> HazardCurve:
        """Return ``rate = k0 im**-k`` between two intensities (Cornell 1996).

        Parameters
        ----------
        k0, k : float
            Rate at an intensity of 1 [1/year], and slope [-].
        low, high : float
            Ends of the curve.
        unit : str, optional
            Unit of the intensities: "m/s2", or that of the measure.
        intensity : IntensityMeasure, optional
            The measure.

        Returns
        -------
        HazardCurve
            The curve, exact between its ends.

        Raises
        ------
        FragilityError
            If a number is not positive.
        """
        numbers = {"k0": k0, "k": k, "low": low, "high": high}
        a, b, c, d = (require_positive(n, v, error=FragilityError) for n, v in numbers.items())
        ends = np.array([c, d])
        return cls(ends, a * ends**-b, unit, intensity)

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest intensity."""
        im = np.asarray(self.im, dtype=np.float64)
        return float(im[0]), float(im[-1])

    def rates(self, im: npt.ArrayLike) -> FloatArray:
        """Return mean annual frequencies at intensities.

        Parameters
        ----------
        im : array_like
            Intensities within the curve's ends.

        Returns
        -------
        ndarray
            Frequencies [1/year], in the shape of `im`.

        Raises
        ------
        FragilityError
            If one is out of the ends: nothing is extrapolated.
        """
        at, (low, high) = np.asarray(im, dtype=np.float64), self.ends
        if (at < low * (1.0 - 1e-12)).any() or (at > high * (1.0 + 1e-12)).any():
            msg = (
                f"im from {at.min():g} to {at.max():g} {self.unit} is out of the hazard curve, "
                f"{low:g} to {high:g}: give the curve for more intensities"
            )
            raise FragilityError(msg)
        known = np.log(np.asarray(self.im)), np.log(np.asarray(self.rate))
        return np.asarray(np.exp(np.interp(np.log(at), *known)))

    def to_dataframe(self) -> pd.DataFrame:
        """Return the points: "rate" [1/year] and "return period" [years] over the intensity."""
        rate = np.asarray(self.rate, dtype=np.float64)
        index = pd.Index(np.asarray(self.im), name=f"im [{self.unit}]")
        return pd.DataFrame({"rate": rate, "return period": 1.0 / rate}, index=index)
