"""Checks of a set of motions against the target spectrum, by the rules for time histories."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError
from frames.design._errors import CheckError
from frames.design.calculation.check import Check, Checks
from frames.design.calculation.standing import FROM_MEMORY, Standing
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import code_named, standing_in
from frames.design.codes.secant import CheckBuilder
from frames.design.hazard.code_rules import ScalingRule, scaling_named
from frames.design.hazard.motion_measures import pair_spectrum
from frames.design.hazard.motion_set import angle_of
from frames.design.hazard.scaling import POINTS
from frames.motion.ground_motion import GroundMotion
from lir_element.texts import worded

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.hazard.spectrum import Spectrum

_TURNED = 1.0  # degrees


def period_range(equivalent: EquivalentLinear, rule: str = "") -> tuple[float, float]:
    """Return the range of periods in which motions are compared with a target spectrum.

    Parameters
    ----------
    equivalent : EquivalentLinear
        The analysis, with its effective periods at all its bounds; of NCh2745, which has two
        levels, the shortest is T_D and the longest T_M.
    rule : str
        Rule of a code, or "ASCE 7-16"; that of the analysis' code if empty.

    Returns
    -------
    (float, float)
        Shortest and longest period [s]: of ASCE 7-22 0.75 T_M of the upper bound and 1.25 T_M of
        the lower one.

    Raises
    ------
    CheckError
        If the rule is not known.

    Examples
    --------
    >>> from frames.design import IsolationSystem, PropertyBounds, PropertyModificationFactors
    >>> from frames.design import Spectrum, equivalent_linear, period_range
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> target = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
    >>> linear = equivalent_linear(system, target, bounds=bounds)
    >>> [round(period, 2) for period in period_range(linear)]
    [1.69, 3.28]
    """
    low, high = _rule(equivalent, rule).periods
    each = equivalent.bounds.values()
    design = [e.trace.value("T_D") if "T_D" in e.trace else e.period for e in each]
    return low * min(design), high * max(e.period for e in each)


def motion_checks(
    motions: MotionSet, spectrum: Spectrum, equivalent: EquivalentLinear, *, rule: str = ""
) -> Checks:
    """Check a set of motions: number of pairs, mean spectrum, fault axes.

    Parameters
    ----------
    motions : MotionSet
        The motions, scaled. A horizontal component that is missing counts as no motion.
    spectrum : Spectrum
        The target.
    equivalent : EquivalentLinear
        The analysis, whose effective periods give the range.
    rule : str
        Rule of a code; that of the analysis' code if empty. "ASCE 7-16" needs SRSS in ASCE 7-22's
        range. The number of pairs is that of the analysis' code.

    Returns
    -------
    Checks
        Checks of the number of pairs; of the mean spectrum over the required share of the target,
        at the worst period; of the same at the period 0 by EN 1998-1; by ASCE 7, if motions are
        marked "near_fault", of the number of them that are not turned to the fault's axes, or lack
        the orientation.

    Raises
    ------
    CheckError
        If the rule is not known.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion
    >>> from frames.design import IsolationSystem, MotionSet, Spectrum, equivalent_linear
    >>> from frames.design import PropertyBounds, PropertyModificationFactors
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=CoulombFriction(0.06), interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> target = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> linear = equivalent_linear(system, target, bounds=bounds)
    >>> pulse = np.sin(np.linspace(0.0, 2.0 * np.pi, 101))
    >>> motions = MotionSet({"a": GroundMotion(x=pulse, y=0.5 * pulse, dt=0.02)})
    >>> print(motion_checks(motions, target, linear)[0])
    pairs of motions: 1 >= 7, ratio 7, FAILED [ASCE 7-22 17.3.3]
    """
    asked = _rule(equivalent, rule)
    low, high = period_range(equivalent, asked.name)
    both = [_pair(motion) for motion in motions.values()]
    grid = np.geomspace(low, high, POINTS)
    clause = asked.clause
    least = code_named(equivalent.code).histories.least
    known = standing_in(equivalent.code, "number of motions")
    found = [_number(motions, least, clause, known), _mean(both, spectrum, grid, asked)]
    if asked.at_zero:
        found.append(_mean(both, spectrum, np.zeros(1), asked))
    return Checks([*found, *(_turned(motions, clause) if asked.fault_axes else [])])


def _rule(equivalent: EquivalentLinear, rule: str) -> ScalingRule:
    return scaling_named(rule or equivalent.code, CheckError)


def _pair(motion: GroundMotion) -> GroundMotion:
    x, y, _ = motion.components.T  # zeros if one is missing
    return GroundMotion(x=x, y=y, dt=motion.dt, name=motion.name)


def _number(motions: MotionSet, least: int, clause: str, known: Standing) -> Check:
    t = Trace()
    pairs = sum(m.x is not None and m.y is not None for m in motions.values())
    t.given("n", float(pairs), note="with both horizontal components")
    t.given("n_least", float(least))
    up = sum(m.z is not None for m in motions.values())
    note = worded("{n} of {all} have a vertical component", n=up, all=len(motions))
    judge = CheckBuilder(t, "", known)
    return judge(clause, "pairs of motions", "n", ">=", "n_least", note=note)


def _mean(
    motions: list[GroundMotion], spectrum: Spectrum, grid: FloatArray, asked: ScalingRule
) -> Check:
    # At the period of the smallest ratio of the mean to the target.
    target = np.asarray(spectrum.acceleration(grid, 0.05), dtype=np.float64)
    each = np.array([pair_spectrum(motion, grid, 0.05, asked.measure) for motion in motions])
    k = int(np.argmin(each.mean(axis=0) / target))
    t, at_zero = Trace(), not grid.any()
    t.given_each(
        "S_i",
        each[:, k].tolist(),
        "m/s2",
        note=worded("{measure} of each pair, 5 %", measure=asked.measure),
    )
    t.given("n", float(len(motions)))
    t("S_mean", "sum(S_i) / n", "m/s2", note=worded("at T = {period:.4g} s", period=grid[k]))
    t.given(
        "S_target",
        float(target[k]),
        "m/s2",
        note=worded("of {spectrum}", spectrum=spectrum.name or spectrum.code),
    )
    t.given("a_S", asked.at_zero if at_zero else asked.part)
    t("S_least", "a_S * S_target", "m/s2")
    title = "mean spectrum of the motions" + (" at the period 0" if at_zero else "")
    note = "" if at_zero else worded("least from {a:.4g} to {b:.4g} s", a=grid[0], b=grid[-1])
    judge = CheckBuilder(t, "", asked.standing)
    return judge(asked.clause, title, "S_mean", ">=", "S_least", note=note)


def _turned(motions: MotionSet, clause: str) -> list[Check]:
    near = [name for name in motions if motions.facts[name].get("near_fault")]
    if not near:
        return []
    odd = [name for name in near if not _is_turned(name, motions)]
    t = Trace()
    t.given("n_odd", float(len(odd)), note=worded("of {n} near-fault pairs", n=len(near)))
    t.given("n_allowed", 0.0)
    note = worded(
        "MotionSet.fault_normal turns those whose strike and azimuths are known: {names}",
        names=", ".join(odd),
    )
    title = "near-fault pairs that are not turned to the fault"
    judge = CheckBuilder(t, "", FROM_MEMORY)
    return [judge(clause, title, "n_odd", "<=", "n_allowed", note=note if odd else "")]


def _is_turned(name: str, motions: MotionSet) -> bool:
    known = motions.facts[name]
    try:
        strike, x, y = (angle_of(name, known, key) for key in ("strike", "azimuth_x", "azimuth_y"))
    except MotionError:  # an unknown orientation is not turned
        return False
    off = (abs((azimuth - strike + 45.0) % 90.0 - 45.0) for azimuth in (x, y))  # in both senses
    return max(off) <= _TURNED
