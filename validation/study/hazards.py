"""Hazard of Sa(3 s) at three sites, from what public sources say of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frames.design import Spectrum
from frames.risk import HazardCurve, Intensity
from lir_element.units import STANDARD_GRAVITY

INTENSITY = Intensity(kind="Sa", period=3.0)
SHORTEST, HIGH = 30.0, 60.0
"""Ends of all curves, a return period [years] and an intensity [m/s2].

What is beyond the given points goes on as a power law; motions that come more often than the
shortest return period are left out.
"""

CONSIDERED_PERIOD = 2475.0
"""Return period that stands for the maximum considered earthquake [years]."""

RETURN_PERIODS = (30.0, 50.0, 72.0, 101.0, 140.0, 201.0, 475.0, 975.0, 2475.0)
"""Of the hazard of the Italian code [years]."""

L_AQUILA = (
    (0.78911, 2.3995, 0.27228),
    (1.0405, 2.3321, 0.28125),
    (1.2258, 2.318, 0.28932),
    (1.4242, 2.3043, 0.29671),
    (1.6403, 2.3015, 0.30931),
    (1.9075, 2.3152, 0.31802),
    (2.6099, 2.364, 0.34696),
    (3.3433, 2.4001, 0.36415),
    (4.5255, 2.4576, 0.38472),
)
"""a_g [m/s2], F_0 [-] and T*_C [s] at node 26528 (42.335 N, 13.423 E) of the hazard of NTC 2008."""

CALIFORNIA = (
    (43.0, 144.0, 289.0, 475.0, 949.0, 1485.0, 2475.0, 3899.0, 7462.0, 10000.0),
    (0.04, 0.10, 0.17, 0.24, 0.35, 0.42, 0.50, 0.57, 0.69, 0.75),
)
"""Return periods [years] and Sa(2.99 s) [g] of a site in California (Kitayama and Cilsalar 2022)."""

LOS_ANGELES_SM1 = 1.054
"""S_M1 [g] of Century City, 34.05 N 118.40 W, site class C (ASCE 7-16; USGS)."""

SANTIAGO_PGA = (475.0, 0.55), (1950.0, 0.72)
"""Return period [years] and PGA [g] in urban Santiago (Leyton, Ruiz and Sepulveda 2010)."""


@dataclass(frozen=True)
class Site:
    """A site: its curve, and where it comes from."""

    name: str
    curve: HazardCurve
    source: str

    def at(self, years: float) -> float:
        """Return the intensity of a return period [m/s2]."""
        im, rate = np.asarray(self.curve.im), np.asarray(self.curve.rate)
        return float(np.exp(np.interp(-np.log(1.0 / years), -np.log(rate), np.log(im))))

    def moved(self, intensity: float) -> HazardCurve:
        """Return the curve with all intensities times one factor, so that 2,475 years have one."""
        factor = intensity / self.at(CONSIDERED_PERIOD)
        return HazardCurve(factor * np.asarray(self.curve.im), self.curve.rate, intensity=INTENSITY)

    def slope(self) -> float:
        """Return -d ln rate / d ln intensity between 475 and 2,475 years."""
        return float(
            np.log(CONSIDERED_PERIOD / 475.0) / np.log(self.at(CONSIDERED_PERIOD) / self.at(475.0))
        )


def italian(a_g: float, f_0: float, t_star: float, period: float) -> float:
    """Return Sa of the Italian code on ground C from its hazard [m/s2]."""
    share = a_g / STANDARD_GRAVITY
    soil = float(np.clip(1.70 - 0.60 * f_0 * share, 1.0, 1.5))
    t_c, t_d = 1.05 * t_star**-0.33 * t_star, 4.0 * share + 1.6
    plateau = a_g * soil * f_0
    return float(plateau * t_c / period * min(1.0, t_d / period))


def beyond(im: list[float], rate: list[float]) -> HazardCurve:
    """Return a curve through points, its end pieces drawn on to `SHORTEST` and `HIGH`."""
    at, told = np.log(im), np.log(rate)
    first, last = (np.diff(told)[k] / np.diff(at)[k] for k in (0, -1))
    often, points = -np.log(SHORTEST), list(zip(at, told, strict=True))
    if often > told[0] + 1e-9:
        points.insert(0, (at[0] + (often - told[0]) / first, often))
    points.append((np.log(HIGH), told[-1] + last * (np.log(HIGH) - at[-1])))
    ends = np.exp(np.array(points))
    return HazardCurve(ends[:, 0], ends[:, 1], intensity=INTENSITY)


def sites() -> tuple[Site, ...]:
    """Return the sites."""
    period = INTENSITY.period
    assert period is not None
    aquila = [italian(*values, period) for values in L_AQUILA]
    years, values = CALIFORNIA
    considered = STANDARD_GRAVITY * LOS_ANGELES_SM1 / period
    factor = considered / values[years.index(CONSIDERED_PERIOD)]
    angeles = [factor * value for value in values]
    (first, low), (second, high) = SANTIAGO_PGA
    slope = np.log(second / first) / np.log(high / low)
    design = float(Spectrum.nch2745("II", 2).acceleration(period))
    santiago = [design, design * (second / first) ** (1.0 / slope)]
    return (
        Site(
            "Santiago",
            beyond(santiago, [1.0 / first, 1.0 / second]),
            "spectrum of NCh2745, soil II, zone 2, at 475 years; slope of the hazard of PGA in urban "
            "Santiago, 0.55 g in 475 and 0.72 g in 1,950 years (Leyton, Ruiz and Sepulveda 2010, "
            "Andean Geology 37:455-472): an assumption for 3 s",
        ),
        Site(
            "Los Angeles",
            beyond(angeles, [1.0 / t for t in years]),
            "S_M1 / T of Century City, 34.05 N 118.40 W, site class C, 1.054 g / 3 (ASCE 7-16; tests "
            "of the USGS design service), taken as of 2,475 years; shape of the hazard of Sa(2.99 s) "
            "at a site in California, 43 to 10,000 years (Kitayama and Cilsalar 2022, Bull. Earthq. "
            "Eng. 20:1143-1168, repository shkma/LossAssessment)",
        ),
        Site(
            "L'Aquila",
            beyond(aquila, [1.0 / t for t in RETURN_PERIODS]),
            "a_g, F_0 and T*_C of node 26528 (42.335 N, 13.423 E) for nine return periods, 30 to "
            "2,475 years (annex B of NTC 2008), spectrum of NTC 2018 on ground C",
        ),
    )
