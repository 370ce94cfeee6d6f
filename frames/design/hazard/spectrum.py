"""Elastic spectra a structure is designed for: of codes, or given point by point."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames.design.hazard import spectral_shapes as sh
from frames.design.hazard.code_rules import rules_named
from frames.design.hazard.elastic_spectrum import ElasticSpectrum
from lir_element.argument_checks import require_between, require_choice, require_positive, unreal
from lir_element.texts import worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import numpy.typing as npt

LARGEST_IN_G = 10.0
"""Largest spectral acceleration of a code [g]: a larger one is probably in another unit."""

LARGEST_PARAMETER = 5.0
"""S_MS and S_M1 that no site has [g]."""

LONGEST_CORNER = 1.3
"""Largest plausible S_M1 / S_MS, the softest sites included [s]."""


@dataclass(frozen=True, repr=False, slots=True)
class Spectrum(ElasticSpectrum):
    """An elastic response spectrum; make one with `asce7`, `en1998`, `nch2745` and so on.

    Parameters
    ----------
    code : str
        Code of the spectrum, as plots and reports show it.
    name : str
        Name for plots and messages.
    shape : str
        Family of formulas (`frames.design.hazard.spectral_shapes.SHAPES`).
    damping_code : str
        Code of the damping factors by which it is divided; empty: it is for 5 % alone.
    constants : tuple of (str, float)
        Parameters by symbol.
    points : tuple of (float, float)
        Periods [s] and pseudo-accelerations [m/s2], of spectra that are given so.
    site : tuple of (str, str or int)
        Soil, zone and other inputs of the code's tables; empty without tables, and once the
        spectrum is scaled.

    Examples
    --------
    >>> spectrum = Spectrum.asce7(s_ms=1.5, s_m1=0.9)
    >>> round(spectrum.displacement(3.0, damping=0.20), 4)  # m
    0.4471
    >>> spectrum.parameters["T_S"]
    0.6
    """

    @classmethod
    def asce7(
        cls,
        s_ms: float,
        s_m1: float,
        t_l: float = 8.0,
        *,
        s_1: float | None = None,
        name: str = "",
    ) -> Spectrum:
        """Return the two-parameter MCE_R spectrum of ASCE/SEI 7-22, 11.4.

        Parameters
        ----------
        s_ms, s_m1 : float
            Spectral accelerations at short periods and at 1 s, site effects included [g].
        t_l : float
            Long-period transition period [s].
        s_1 : float, optional
            Mapped acceleration at 1 s, without the site [g], for the least shears of a fixed base;
            s_m1 if left out.
        name : str
            Name; made of the parameters if left out.

        Returns
        -------
        Spectrum
            The spectrum. For the design earthquake, use ``.scaled(2 / 3)``.

        Raises
        ------
        MotionError
            If a parameter is out of its bounds.

        Warns
        -----
        MotionWarning
            If s_m1 / s_ms is above 1.3 s, for example because they are exchanged.
        """
        short, long = _in_g("s_ms", s_ms), _in_g("s_m1", s_m1)
        late = require_positive("t_l", t_l, "s", error=MotionError)
        corner = long / short
        if not corner < late:
            msg = (
                f"T_S = s_m1 / s_ms = {corner:g} s must be below t_l = {late:g} s: check the "
                "order of s_ms and s_m1, both in g"
            )
            raise MotionError(msg)
        if corner > LONGEST_CORNER:
            msg = worded(
                "s_m1 / s_ms = {long:g} / {short:g} = {period:.3g} s is outside 0.3 to 1.2 s: "
                "check whether s_ms and s_m1 are exchanged, which changes long-period "
                "displacements by a factor of {factor:.3g}",
                long=long,
                short=short,
                period=corner,
                factor=corner,
            )
            warnings.warn(msg, MotionWarning, stacklevel=2)
        constants = {"S_MS": short, "S_M1": long, "T_0": 0.2 * corner, "T_S": corner, "T_L": late}
        constants |= _mapped(s_1)
        label = name or worded(
            "ASCE 7 MCE_R, S_MS = {s_ms:g} g, S_M1 = {s_m1:g} g", s_ms=short, s_m1=long
        )
        return cls("ASCE 7-22", label, "asce7", "ASCE 7-22", tuple(constants.items()))

    @classmethod
    def asce7_multi_period(
        cls,
        periods: npt.ArrayLike,
        accelerations_in_g: npt.ArrayLike,
        *,
        s_ms: float | None = None,
        s_m1: float | None = None,
        s_1: float | None = None,
        t_l: float = 8.0,
        v_s30: float | None = None,
        name: str = "",
    ) -> Spectrum:
        """Return a multi-period or site-specific MCE_R spectrum of ASCE/SEI 7-22.

        Between the periods the acceleration is linear; after the last one it falls with 1/T up to
        T_L, and with 1/T^2 after it. Analyses and scaling warn if they use that part below 10 s.

        Parameters
        ----------
        periods : array_like, shape (n,)
            Rising periods [s]; the first one 0 or at most 0.01, the last one at least 2.
        accelerations_in_g : array_like, shape (n,)
            Spectral accelerations for 5 % damping [g].
        s_ms, s_m1 : float, optional
            Parameters [g]. Default: 90 % of the largest acceleration between 0.2 s and 5 s; 90 % of
            the largest T x acceleration from 1 s to 2 s (to 5 s if `v_s30` is at most 442 m/s or
            unknown), at least the acceleration at 1 s (21.4, to be confirmed).
        s_1 : float, optional
            As for `asce7`.
        t_l : float
            Long-period transition period [s].
        v_s30 : float, optional
            Shear wave velocity of the upper 30 m [m/s].
        name : str
            Name; made of the parameters if left out.

        Returns
        -------
        Spectrum
            The spectrum.

        Raises
        ------
        MotionError
            If the points or a parameter are out of their bounds.
        """
        points = _checked_points(periods, accelerations_in_g, "accelerations_in_g", LARGEST_IN_G)
        if points[0][0] > 0.01 or points[-1][0] < 2.0:
            msg = (
                f"periods reach from {points[0][0]:g} s to {points[-1][0]:g} s: they must begin "
                "at 0 (at most 0.01 s) and reach 2 s or more"
            )
            raise MotionError(msg)
        stiff = v_s30 is not None and require_positive("v_s30", v_s30, "m/s") > 442.0
        found = sh.smooth_parameters(points, 2.0 if stiff else 5.0)
        short = found[0] if s_ms is None else _in_g("s_ms", s_ms)
        long = found[1] if s_m1 is None else _in_g("s_m1", s_m1)
        late = require_positive("t_l", t_l, "s", error=MotionError)
        constants = {"S_MS": short, "S_M1": long, "T_S": long / short, "T_L": late}
        constants |= _mapped(s_1)
        label = name or worded(
            "ASCE 7 multi-period MCE_R, S_MS = {s_ms:.3g} g, S_M1 = {s_m1:.3g} g",
            s_ms=short,
            s_m1=long,
        )
        in_si = tuple((period, level * STANDARD_GRAVITY) for period, level in points)
        kept = tuple(constants.items())
        return cls("ASCE 7-22", label, "asce7_multi_period", "ASCE 7-22", kept, in_si)

    @classmethod
    def en1998(
        cls,
        a_g: float,
        ground_type: str = "B",
        kind: int = 1,
        importance: float = 1.0,
        *,
        name: str = "",
    ) -> Spectrum:
        """Return the horizontal elastic spectrum of EN 1998-1:2004, 3.2.2.2.

        After T_D the displacement stays constant, also beyond 4 s, although annex A lets it fall to
        that of the ground. The national annexes may change the tables.

        Parameters
        ----------
        a_g : float
            Reference peak acceleration on ground of type A, a_gR [m/s2].
        ground_type : {"A", "B", "C", "D", "E"}
            Ground type.
        kind : {1, 2}
            Kind of the spectrum, 2 if no magnitude above 5.5 matters.
        importance : float
            Importance factor gamma_I [-]: a_g = gamma_I a_gR.
        name : str
            Name; made of the parameters if left out.

        Returns
        -------
        Spectrum
            The spectrum.

        Raises
        ------
        MotionError
            If a parameter is out of its bounds.
        """
        require_choice("kind", kind, tuple(sh.EN1998_GROUND), error=MotionError)
        grounds = sh.EN1998_GROUND[kind]
        require_choice("ground_type", ground_type, tuple(grounds), error=MotionError)
        peak = require_positive("a_g", a_g, "m/s2", error=MotionError)
        gamma = require_positive("importance", importance, error=MotionError)
        if peak > STANDARD_GRAVITY * 3.0:
            msg = f"a_g = {peak:g} m/s2 exceeds 3 g: give a_g in m/s2 (0.25 g are 2.45 m/s2)"
            raise MotionError(msg)
        constants = {"a_gR": peak, "gamma_I": gamma, "a_g": gamma * peak}
        constants |= zip(("S", "T_B", "T_C", "T_D"), grounds[ground_type], strict=True)
        label = name or (
            worded(
                "EN 1998-1 type {kind}, ground {ground}, a_g = {a:.3g} m/s2",
                kind=kind,
                ground=ground_type,
                a=gamma * peak,
            )
        )
        site = (("ground_type", ground_type), ("kind", kind))
        return cls("EN 1998", label, "en1998", "EN 1998", tuple(constants.items()), site=site)

    @classmethod
    def nch2745(cls, soil: str = "II", zone: int = 3, *, name: str = "") -> Spectrum:
        """Return the design spectrum of NCh2745 (Chile, isolated buildings).

        Parameters
        ----------
        soil : {"I", "II", "III"}
            Soil type.
        zone : {1, 2, 3}
            Seismic zone, for Z = 3/4, 1 and 5/4.
        name : str
            Name; made of the parameters if left out.

        Returns
        -------
        Spectrum
            The spectrum of the design earthquake; for the maximum possible one, ``.scaled(1.2)``
            (M_M, to be confirmed).

        Raises
        ------
        MotionError
            If soil or zone is not known.
        """
        require_choice("soil", soil, tuple(sh.NCH2745_SOIL), error=MotionError)
        require_choice("zone", zone, tuple(sh.NCH2745_ZONE), error=MotionError)
        symbols = ("A", "T_a", "T_b", "T_c", "T_d", "alpha_A", "alpha_V", "alpha_D")
        constants = {"Z": sh.NCH2745_ZONE[zone]}
        constants |= zip(symbols, sh.NCH2745_SOIL[soil], strict=True)
        label = name or worded("NCh2745, soil {soil}, zone {zone}", soil=soil, zone=zone)
        site = (("soil", soil), ("zone", zone))
        return cls("NCh2745", label, "nch2745", "NCh2745", tuple(constants.items()), site=site)

    @classmethod
    def nch433(
        cls, soil: str = "C", zone: int = 3, importance: float = 1.0, *, name: str = ""
    ) -> Spectrum:
        """Return the elastic spectrum (R* = 1) of NCh433 with the decree 61 (Chile, buildings).

        The code is for 5 % damping; other values use the factors of NCh2745.

        Parameters
        ----------
        soil : {"A", "B", "C", "D", "E"}
            Soil class.
        zone : {1, 2, 3}
            Seismic zone, for A_0 = 0.20 g, 0.30 g and 0.40 g.
        importance : float
            Importance factor I [-]: 0.6, 1.0 or 1.2.
        name : str
            Name; made of the parameters if left out.

        Returns
        -------
        Spectrum
            The spectrum.

        Raises
        ------
        MotionError
            If soil or zone is not known, or the importance not positive.
        """
        require_choice("soil", soil, tuple(sh.NCH433_SOIL), error=MotionError)
        require_choice("zone", zone, tuple(sh.NCH433_ZONE), error=MotionError)
        factor = require_positive("importance", importance, error=MotionError)
        constants = {"A_0": sh.NCH433_ZONE[zone], "I": factor}
        constants |= zip(("S", "T_0", "p"), sh.NCH433_SOIL[soil], strict=True)
        label = name or worded("NCh433, soil {soil}, zone {zone}", soil=soil, zone=zone)
        site = (("soil", soil), ("zone", zone))
        return cls("NCh433", label, "nch433", "NCh2745", tuple(constants.items()), site=site)

    @classmethod
    def given(
        cls,
        periods: npt.ArrayLike,
        accelerations: npt.ArrayLike,
        *,
        code: str | None = None,
        name: str = "",
    ) -> Spectrum:
        """Return a spectrum through points, linear between them.

        Parameters
        ----------
        periods : array_like, shape (n,)
            Rising periods [s], n >= 2.
        accelerations : array_like, shape (n,)
            Pseudo-accelerations for 5 % damping [m/s2].
        code : str, optional
            Code of the damping factors, for instance "ASCE 7-22"; left out, the spectrum is for 5 %
            alone.
        name : str
            Name.

        Returns
        -------
        Spectrum
            Defined from the first to the last period.

        Raises
        ------
        MotionError
            If the points are no spectrum, or the code is not known.
        """
        if code is not None:
            code = rules_named(code).name
        points = _checked_points(
            periods, accelerations, "accelerations", LARGEST_IN_G * STANDARD_GRAVITY
        )
        return cls(code or "given", name or "given spectrum", "given", code or "", (), points)


def _in_g(name: str, value: float) -> float:
    """Return a spectral acceleration in g; raise if it is impossible."""
    return require_between(
        name,
        require_positive(name, value, "g", remedy="give it in g", error=MotionError),
        0.0,
        LARGEST_PARAMETER,
        "g",
        remedy=f"give it in g ({value:g} m/s2 are {value / STANDARD_GRAVITY:.3g} g)",
        error=MotionError,
    )


def _mapped(s_1: float | None) -> dict[str, float]:
    """Return S_1 as a parameter if it is given."""
    return {} if s_1 is None else {"S_1": _in_g("s_1", s_1)}


def _checked_points(
    periods: npt.ArrayLike, levels: npt.ArrayLike, name: str, largest: float
) -> sh.Points:
    """Return the points of a spectrum, checked."""
    for which, values in (("periods", periods), (name, levels)):
        if odd := unreal(values):
            msg = f"{which} {odd}"
            raise MotionError(msg)
    period, level = (np.array(values, dtype=np.float64) for values in (periods, levels))
    if period.ndim != 1 or period.shape != level.shape or len(period) < 2:
        msg = (
            f"periods have shape {period.shape} and {name} {level.shape}: give two sequences of "
            "one length, 2 or more"
        )
        raise MotionError(msg)
    if not (np.isfinite(period).all() and period[0] >= 0.0 and (np.diff(period) > 0.0).all()):
        msg = f"periods = {period.tolist()} s must be finite, at least 0 and rising: sort them"
        raise MotionError(msg)
    bad = level[~((level > 0.0) & (level <= largest))]
    if bad.size:
        msg = f"{name} have {bad[0]:g}: give positive values, at most {largest:g}; check the unit"
        raise MotionError(msg)
    return tuple(zip(period.tolist(), level.tolist(), strict=True))
