"""Friction that depends on pressure and temperature, as an engineer specifies it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Literal

import numpy as np

from lir_element.argument_checks import require_choice
from lir_element.fields import check_numbers, number
from lir_element.layout import HEAT_PARTS

if TYPE_CHECKING:
    from lir_element.layout import Floats

_FALLS = {"half": (0.02, 0.40), "third": (0.029, 0.22), "two-thirds": (0.0085, 0.25)}
"""Rate [1/K] and rest of 0.7^(rate T) + rest, by the share of friction left at 200 C."""

_TEMPERATURE = number("C", "[-100, 400)", remedy="give it in C")

_SHORTEST, _LONGEST = 1e-3, 200.0  # s, between which the sum of exponentials holds
_FASTEST, _SLOWEST = 2e3, 3e-3  # 1/s, of its rates: both bounds are well covered


@dataclass(frozen=True, slots=True, kw_only=True)
class PressureDependence:
    r"""Low friction that falls as the pressure on the slider rises.

    .. math:: k_p = e^{-r (p - p_0)}

    multiplies the friction coefficient of both concave surfaces; p is the axial force over the
    slider's area in plan. By default it is :math:`0.7^{0.02 (p - p_0)}` with p in MPa.

    Parameters
    ----------
    reference_pressure : float, optional
        Pressure p_0 [Pa] at which the friction coefficients were measured. Default: that of the
        design load.
    rate : float
        Rate r [1/Pa], at least 0.

    Raises
    ------
    ValueError, TypeError
        If a value is out of bounds: the message names value, bound and remedy.

    Notes
    -----
    Source: the factor of the bearing elements FPBearingPTV and TripleFrictionPendulumX of OpenSees.

    Examples
    --------
    >>> round(PressureDependence(reference_pressure=20e6).factor(70e6), 3)
    0.7
    """

    reference_pressure: float | None = field(
        default=None, metadata=number("Pa", "[1e5, 3e9)", usual=(1e6, 3e8))
    )
    rate: float = field(
        default=-0.02e-6 * math.log(0.7),
        metadata=number("1/Pa", "[0, 1e-6)", remedy="give 1/Pa (0.0071 1/MPa are 7.1e-9 1/Pa)"),
    )

    def __post_init__(self) -> None:
        check_numbers(self)

    def __str__(self) -> str:
        """Return it in words, for tables."""
        p_0 = self.reference_pressure
        at = "the design load" if p_0 is None else f"{1e-6 * p_0:.4g} MPa"
        return f"{1e8 * self.rate:.3g} % less a MPa, from {at} on"

    def factor(self, pressure: float, reference: float | None = None) -> float:
        """Return k_p [-] at `pressure`; `reference` [Pa] is used if the bearing's is not set."""
        p_0 = self.reference_pressure if self.reference_pressure is not None else reference
        if p_0 is None:
            msg = "reference_pressure is not set: set it, or `reference`, the design pressure [Pa]"
            raise ValueError(msg)
        return math.exp(-self.rate * (pressure - p_0))


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionHeating:
    r"""Low friction that falls as sliding heats the plates.

    .. math:: k_T = \frac{0.7^{r T} + c}{0.7^{r T_r} + c}

    multiplies the friction coefficient of both concave surfaces; T is the temperature of the plate
    at the middle of its surface [C]. The dissipated heat enters there while the slider covers that
    place (docs/theory.md, section 11). Slip heats the interface, too; its temperature is recorded,
    but its friction does not depend on it.

    Parameters
    ----------
    variant : {"half", "third", "two-thirds"}
        Share of friction left at 200 C: (r, c) = (0.02, 0.40), (0.029, 0.22), (0.0085, 0.25).
    conductivity : float
        Thermal conductivity of the plates [W/(m K)]. Default: stainless steel.
    diffusivity : float
        Thermal diffusivity of the plates [m2/s]. Default: stainless steel.
    initial_temperature : float
        Temperature of the bearing before the analysis [C].
    reference_temperature : float
        Temperature T_r at which the friction coefficients were measured [C].
    thickness : float, optional
        Thickness of the heated plate [m], insulated at its back. Default: a half-space.
    share : float
        Share of the heat that enters the plate [-], above 0 and at most 1; the rest goes to the
        slider's liner. The usual assumption is 1.

    Raises
    ------
    ValueError, TypeError
        If a value is out of bounds: the message names value, bound and remedy.

    Notes
    -----
    Source: the factors and defaults of TripleFrictionPendulumX of OpenSees; Constantinou et al.
    (2007), MCEER-07-0012, for the heating.

    Examples
    --------
    >>> round(FrictionHeating().factor(200.0), 2)
    0.51
    """

    variant: Literal["half", "third", "two-thirds"] = "half"
    conductivity: float = field(default=18.0, metadata=number("W/(m K)", "[0.1, 1e4)"))
    diffusivity: float = field(
        default=4.44e-6,
        metadata=number("m2/s", "[1e-8, 1e-2)", remedy="give m2/s (4.44 mm2/s are 4.44e-6 m2/s)"),
    )
    initial_temperature: float = field(default=20.0, metadata=_TEMPERATURE)
    reference_temperature: float = field(default=20.0, metadata=_TEMPERATURE)
    thickness: float | None = field(
        default=None, metadata=number("m", "[1e-3, 2)", usual=(2e-3, 0.5))
    )
    share: float = field(default=1.0, metadata=number("-", "(0, 1]", remedy="1 for all of it"))

    def __post_init__(self) -> None:
        require_choice("variant", self.variant, tuple(_FALLS))
        check_numbers(self)

    def __str__(self) -> str:
        """Return it in words, for tables."""
        plate = "half-space" if self.thickness is None else f"{1e3 * self.thickness:.4g} mm"
        return f"{self.variant} at 200 C, {plate}, from {self.initial_temperature:g} C on"

    def factor(self, temperature: float) -> float:
        """Return k_T [-] at `temperature` [C]."""
        scale, rate, rest = self.law
        return scale * (rest + math.exp(-rate * temperature))

    @property
    def law(self) -> tuple[float, float, float]:
        """Scale, rate [1/K] and rest of k_T = scale (rest + exp(-rate T))."""
        rate, rest = _FALLS[self.variant]
        rate *= -math.log(0.7)
        return 1.0 / (rest + math.exp(-rate * self.reference_temperature)), rate, rest

    def parts(self) -> tuple[Floats, Floats, float]:
        """Return the response of the temperature to heat, as a sum of parts that decay.

        Returns
        -------
        rate : ndarray, (HEAT_PARTS,)
            Rates of decay [1/s].
        gain : ndarray, (HEAT_PARTS,)
            Rise of each part per heat that enters [K m2/J].
        skin : float
            Immediate rise per flux [K m2/W], of the parts that decay faster.
        """
        path = math.inf if self.thickness is None else self.thickness**2 / self.diffusivity
        rate, weight, skin = _exponentials(path)
        scale = self.share * math.sqrt(self.diffusivity / math.pi) / self.conductivity
        return rate, scale * weight, scale * skin


def response(time: Floats, path: float) -> Floats:
    """Return a plate's temperature after a unit of heat, over ``sqrt(D / pi) / k`` [1/s^(1/2)]."""
    squares = np.arange(1, 6)[:, None] ** 2
    early = time < 0.3 * path
    found = 1.0 / np.sqrt(time)
    found[early] *= 1.0 + 2.0 * np.exp(-squares * path / time[early]).sum(axis=0)
    late = time[~early]
    if len(late):
        modes = np.exp(-squares * math.pi**2 * late / path).sum(axis=0)
        found[~early] = math.sqrt(math.pi / path) * (1.0 + 2.0 * modes)
    return np.asarray(found)


@cache
def _exponentials(path: float) -> tuple[Floats, Floats, float]:
    # Rates, weights and the integral of the rest before the shortest time: `response` as a sum of
    # exponentials whose rates are in proportion, one of them constant. Least squares of the
    # relative error, no weight below zero.
    from scipy.optimize import nnls  # as long to import as numba, for bearings that are heated

    slowest = max(math.pi**2 / path, _SLOWEST)
    rate = np.append(np.geomspace(slowest, max(_FASTEST, 50.0 * slowest), HEAT_PARTS - 1), 0.0)
    time = np.geomspace(_SHORTEST, _LONGEST, 500)
    weight, _ = nnls(np.exp(-np.outer(time, rate)) / response(time, path)[:, None], np.ones(500))
    done = np.where(rate > 0.0, -np.expm1(-rate * _SHORTEST) / np.maximum(rate, 1e-300), _SHORTEST)
    whole = 2.0 * math.sqrt(_SHORTEST)
    return rate, weight, whole - float(weight @ done)
