"""Shapes of the codes' elastic spectra, and the tables of values that belong to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from frames._types import FloatArray
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from lir_element.units import STANDARD_GRAVITY

Parameters = Mapping[str, float]
Points = tuple[tuple[float, float], ...]
Site = tuple[tuple[str, str | int], ...]
"""Soil, zone and the like by the names of the arguments that a spectrum was made with."""

EN1998_GROUND = {
    1: {
        "A": (1.0, 0.15, 0.4, 2.0),
        "B": (1.2, 0.15, 0.5, 2.0),
        "C": (1.15, 0.2, 0.6, 2.0),
        "D": (1.35, 0.2, 0.8, 2.0),
        "E": (1.4, 0.15, 0.5, 2.0),
    },
    2: {
        "A": (1.0, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.5, 0.1, 0.25, 1.2),
        "D": (1.8, 0.1, 0.3, 1.2),
        "E": (1.6, 0.05, 0.25, 1.2),
    },
}
"""S [-], T_B, T_C, T_D [s] by kind of spectrum and ground type: EN 1998-1:2004, tables 3.2, 3.3."""

EN1998_TABLES = Standing("agrees", "EzGM, a public program, for EN 1998-1:2004, and others alike")
"""Source of these tables, the shape and eta."""

NCH2745_SOIL = {
    "I": (0.40, 0.03, 0.110, 0.29, 2.51, 10.85, 0.50, 0.20),
    "II": (0.41, 0.03, 0.20, 0.54, 2.00, 11.00, 0.94, 0.30),
    "III": (0.45, 0.03, 0.375, 0.68, 1.58, 12.12, 1.31, 0.33),
}
"""A [g], T_a, T_b, T_c, T_d [s], alpha_A [m/s2], alpha_V [m/s], alpha_D [m] by soil: NCh2745."""

NCH2745_TABLES = Standing("agrees", "a public program of seismic hazard, by its name that of 2003")
"""Source of this table, Z, the shape and B by the damping."""

NCH2745_ZONE = {1: 0.75, 2: 1.0, 3: 1.25}
"""Factor Z [-] by seismic zone: NCh2745."""

NCH433_SOIL = {
    "A": (0.90, 0.15, 2.0),
    "B": (1.00, 0.30, 1.5),
    "C": (1.05, 0.40, 1.6),
    "D": (1.20, 0.75, 1.0),
    "E": (1.30, 1.20, 1.0),
}
"""S [-], T_0 [s], p [-] by soil class: NCh433 with the decree 61 of 2011."""

NCH433_SHEAR = {"I": (0.90, 0.20, 1.00), "II": (1.00, 0.35, 1.33), "III": (1.20, 0.85, 1.80)}
"""S [-], T' [s], n [-] of the seismic coefficient by soil of NCh2745: NCh433, 6.2.3, with S of the
decree 61; from memory."""

NCH433_ZONE = {1: 0.20, 2: 0.30, 3: 0.40}
"""Effective acceleration A_0 [g] by seismic zone: NCh433."""


class Shape(NamedTuple):
    """Formula of a family of spectra."""

    # pseudo-accelerations [m/s2] of periods (n,) [s], a damping factor B, parameters, points
    curve: Callable[[FloatArray, float, Parameters, Points], FloatArray]
    amplitudes: tuple[str, ...]  # parameters that grow with the spectrum
    corners: tuple[str, ...]  # parameters that are periods at which the formula changes
    source: str  # clause of the code
    standing: Standing = FROM_MEMORY  # how well it is known


def _where(period: FloatArray, limit: float) -> FloatArray:
    """Return the periods, those below `limit` raised to it: that branch is not used there."""
    return np.maximum(period, limit)


def _asce7(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    rise = p["S_MS"] * (0.4 + 0.6 * period / p["T_0"])
    fall = p["S_M1"] / _where(period, p["T_S"])
    late = fall * p["T_L"] / _where(period, p["T_L"])
    chosen = np.select(
        [period < p["T_0"], period <= p["T_S"], period <= p["T_L"]], [rise, p["S_MS"], fall], late
    )
    return np.asarray(STANDARD_GRAVITY / b * chosen, dtype=np.float64)


def _asce7_points(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    last, level = points[-1]
    after = _where(period, last)
    tail = level * last / after * np.minimum(1.0, max(p["T_L"], last) / after)
    inside = np.interp(period, *np.array(points).T)
    return np.asarray(np.where(period > last, tail, inside) / b, dtype=np.float64)


def _en1998(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    top = 2.5 / b
    rise = 1.0 + period / p["T_B"] * (top - 1.0)
    fall = top * p["T_C"] / _where(period, p["T_C"])
    late = fall * p["T_D"] / _where(period, p["T_D"])
    chosen = np.select(
        [period < p["T_B"], period <= p["T_C"], period <= p["T_D"]], [rise, top, fall], late
    )
    return np.asarray(p["a_g"] * p["S"] * chosen, dtype=np.float64)


def _nch2745(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    start, top = p["A"] * STANDARD_GRAVITY, p["alpha_A"]
    rise = start + (top - start) * (period - p["T_a"]) / (p["T_b"] - p["T_a"])
    fall = 2.0 * np.pi * p["alpha_V"] / _where(period, p["T_c"])
    late = 4.0 * np.pi**2 * p["alpha_D"] / _where(period, p["T_d"]) ** 2
    chosen = np.select(
        [period < p["T_a"], period < p["T_b"], period < p["T_c"], period < p["T_d"]],
        [start, rise, top, fall],
        late,
    )
    return np.asarray(p["Z"] / b * chosen, dtype=np.float64)


def _nch433(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    ratio = period / p["T_0"]
    alpha = (1.0 + 4.5 * ratio ** p["p"]) / (1.0 + ratio**3)
    return np.asarray(p["I"] * p["S"] * p["A_0"] * STANDARD_GRAVITY / b * alpha, dtype=np.float64)


def _given(period: FloatArray, b: float, p: Parameters, points: Points) -> FloatArray:
    return np.asarray(np.interp(period, *np.array(points).T) / b, dtype=np.float64)


_DS61 = Standing("agrees", "decree 61 of 2011 of Chile (MINVU) and the consolidated NCh433")

SHAPES = {
    "asce7": Shape(
        _asce7, ("S_MS", "S_M1", "S_1"), ("T_0", "T_S", "T_L"), "ASCE/SEI 7-22, 11.4.5.2"
    ),
    "asce7_multi_period": Shape(
        _asce7_points, ("S_MS", "S_M1", "S_1"), ("T_S", "T_L"), "ASCE/SEI 7-22, 11.4.5.1, 21.4"
    ),
    "en1998": Shape(
        _en1998, ("a_gR", "a_g"), ("T_B", "T_C", "T_D"), "EN 1998-1:2004, 3.2.2.2", EN1998_TABLES
    ),
    "nch2745": Shape(
        _nch2745, ("Z",), ("T_a", "T_b", "T_c", "T_d"), "NCh2745 Of.2003", NCH2745_TABLES
    ),
    "nch433": Shape(_nch433, ("A_0",), ("T_0",), "NCh433 with decree 61 of 2011", _DS61),
    "given": Shape(_given, (), (), "as given", PROJECT),
}
"""Families of spectra by name."""


def smooth_parameters(points: Points, largest: float) -> tuple[float, float]:
    """Return S_MS and S_M1 of a multi-period spectrum (ASCE/SEI 7-22, 21.4; to be confirmed)."""
    part = 0.9
    period, level = np.array(points).T
    plateau = level[(period >= 0.2) & (period <= 5.0)]
    moving = (period >= 1.0) & (period <= largest)
    at_one = float(np.interp(1.0, period, level))
    s_m1 = max(part * float((period * level)[moving].max(initial=at_one)), at_one)
    return part * float(plateau.max()), s_m1
