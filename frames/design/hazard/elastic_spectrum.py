"""An elastic spectrum as a value: its parameters and its ordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Self, TypeVar, cast

import numpy as np
import pandas as pd

from frames._errors import MotionError
from frames._types import FloatArray
from frames.design.hazard import spectral_shapes as sh
from frames.design.hazard.code_rules import damping_factor, known_names
from lir_element.argument_checks import require_between, require_positive
from lir_element.texts import html_table, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames.design.calculation.standing import Standing

Values = TypeVar("Values", float, FloatArray)
"""One number, or an array (n,)."""

TABLE_PERIODS = (0.0, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
"""Default periods of `Spectrum.table` [s]."""


LAST_OF_ASCE = 10.0
"""Longest period of the multi-period spectra of ASCE/SEI 7-22 [s]."""


@dataclass(frozen=True, repr=False, slots=True)
class ElasticSpectrum:
    """Common part of all spectra; parameters as in `Spectrum`."""

    code: str
    name: str
    shape: str
    damping_code: str
    constants: tuple[tuple[str, float], ...]
    points: sh.Points = ()
    site: sh.Site = ()

    @property
    def parameters(self) -> Mapping[str, float]:
        """Parameters by symbol; accelerations S_MS, S_M1, A and A_0 in g, all others in SI."""
        return MappingProxyType(dict(self.constants))

    @property
    def corner_periods(self) -> Mapping[str, float]:
        """Periods at which the formula changes [s], by symbol."""
        corners = sh.SHAPES[self.shape].corners
        return MappingProxyType({key: self.parameters[key] for key in corners})

    @property
    def reach(self) -> tuple[float, float]:
        """Shortest and longest period at which the spectrum is defined [s]."""
        return (self.points[0][0], self.points[-1][0]) if self.shape == "given" else (0.0, np.inf)

    @property
    def source(self) -> str:
        """Clause of the formula."""
        return sh.SHAPES[self.shape].source

    @property
    def standing(self) -> Standing:
        """Source of the formula and its values."""
        return sh.SHAPES[self.shape].standing

    def damping_factor(self, damping: float) -> float:
        """Return B [-], by which the code divides the spectrum of 5 % damping.

        Parameters
        ----------
        damping : float
            Part of the critical damping [-], in [0, 1).

        Returns
        -------
        float
            The factor; 1 at 5 %.

        Raises
        ------
        MotionError
            If the damping is out of its bounds, or not 5 % in a spectrum that names no code.
        """
        if self.damping_code:
            return damping_factor(self.damping_code, damping)
        ratio = require_between(
            "damping", damping, 0.0, 1.0, remedy="5 % is 0.05", error=MotionError
        )
        if abs(ratio - 0.05) > 1e-9:
            codes = ", ".join(known_names())
            msg = (
                f"{self.name}: damping = {ratio:g} needs a rule: make the spectrum with code=, one "
                f"of {codes}"
            )
            raise MotionError(msg)
        return 1.0

    def acceleration(self, period: Values, damping: float = 0.05) -> Values:
        """Return pseudo-accelerations.

        The 5 % spectrum is divided by `damping_factor`; in EN 1998-1 the acceleration at T = 0 is
        that of the ground for any damping.

        Parameters
        ----------
        period : float or array_like
            Natural periods [s], >= 0.
        damping : float
            Part of the critical damping [-], in [0, 1).

        Returns
        -------
        float or ndarray
            Pseudo-accelerations [m/s2], of the shape of `period`.

        Raises
        ------
        MotionError
            If a period or the damping is out of its bounds.
        """
        periods = self._checked_periods(period)
        b = self.damping_factor(damping)
        found = sh.SHAPES[self.shape].curve(periods, b, self.parameters, self.points)
        return cast("Values", found if found.ndim else float(found))

    def displacement(self, period: Values, damping: float = 0.05) -> Values:
        """Return spectral displacements, pseudo-accelerations times (T / 2 pi)^2.

        Parameters
        ----------
        period : float or array_like
            Natural periods [s], >= 0.
        damping : float
            Part of the critical damping [-], in [0, 1).

        Returns
        -------
        float or ndarray
            Displacements [m], of the shape of `period`.

        Raises
        ------
        MotionError
            If a period or the damping is out of its bounds.
        """
        periods = self._checked_periods(period)
        found = self.acceleration(periods, damping) * (periods / (2.0 * np.pi)) ** 2
        return cast("Values", found if periods.ndim else float(found))

    def beyond_points(self, period: float) -> str:
        """Return a doubt if a period [s] is beyond the points of a multi-period spectrum.

        Parameters
        ----------
        period : float
            The longest period of interest [s].

        Returns
        -------
        str
            A sentence; empty if the points reach it, or 10 s, the end of the points of ASCE/SEI
            7-22.
        """
        last = self.points[-1][0] if self.points else np.inf
        if self.shape != "asce7_multi_period" or last >= min(period, LAST_OF_ASCE):
            return ""
        return worded(
            "{name} is extrapolated as 1/T from its last point, {last:g} s, to T = {period:.3g} "
            "s; ASCE/SEI 7-22 does so only beyond 10 s. Give points to {ceil} s or more",
            name=self.name,
            period=period,
            last=last,
            ceil=math.ceil(period),
        )

    def scaled(self, factor: float, *, name: str = "") -> Self:
        """Return the spectrum times a factor, its parameters as well; no longer that of a site.

        Parameters
        ----------
        factor : float
            Factor [-], > 0.
        name : str
            Name; the old one with the factor if left out.

        Returns
        -------
        Spectrum
            The scaled spectrum.

        Raises
        ------
        MotionError
            If the factor is not positive.
        """
        times = require_positive("factor", factor, error=MotionError)
        growing = sh.SHAPES[self.shape].amplitudes
        return replace(
            self,
            name=name or worded("{factor:.4g} x {spectrum}", factor=times, spectrum=self.name),
            constants=tuple(
                (key, times * value if key in growing else value) for key, value in self.constants
            ),
            points=tuple((period, times * level) for period, level in self.points),
            site=self.site if math.isclose(times, 1.0) else (),
        )

    def table(self, periods: npt.ArrayLike = TABLE_PERIODS, damping: float = 0.05) -> pd.DataFrame:
        """Return accelerations and displacements as a table.

        Parameters
        ----------
        periods : array_like, shape (n,)
            Natural periods [s].
        damping : float
            Part of the critical damping [-].

        Returns
        -------
        pandas.DataFrame
            Columns "Sa [m/s2]", "Sa [g]" and "Sd [m]" by period.
        """
        period = np.atleast_1d(np.asarray(periods, dtype=np.float64))
        level = self.acceleration(period, damping)
        columns = {
            "Sa [m/s2]": level,
            "Sa [g]": level / STANDARD_GRAVITY,
            "Sd [m]": self.displacement(period, damping),
        }
        return pd.DataFrame(columns, index=pd.Index(period, name="period [s]"))

    def _checked_periods(self, period: npt.ArrayLike) -> FloatArray:
        """Return periods as an array; raise if the spectrum is not defined at one."""
        periods = np.asarray(period, dtype=np.float64)
        low, high = self.reach
        bad = periods[~(np.isfinite(periods) & (periods >= low) & (periods <= high))]
        if bad.size:
            bound = f"from {low:g} s to {high:g} s" if self.shape == "given" else ">= 0"
            msg = f"period = {bad.flat[0]:g} s: {self.name} is defined for finite periods {bound}"
            raise MotionError(msg)
        return periods

    def _facts(self) -> dict[str, str]:
        found = {key.replace("_", " "): str(value) for key, value in self.site}
        found |= {key: f"{value:.6g}" for key, value in self.constants}
        if self.points:
            found["points"] = (
                f"{len(self.points)}, from {self.points[0][0]:g} s to {self.points[-1][0]:g} s"
            )
        return {"code": self.code, **found, "source": f"{self.source}; {self.standing}"}

    def _repr_html_(self) -> str:
        return html_table(self.name, list(self._facts().items()))

    def __repr__(self) -> str:
        """Name and parameters on one line."""
        facts = ", ".join(f"{k} = {v}" for k, v in self._facts().items() if k != "source")
        return f"Spectrum {self.name!r}: {facts}"
