"""Acceptance of measured loops by the properties of a design."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from frames.design._errors import CheckError
from frames.design.calculation.check import Check, Checks
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from frames.design.calculation.trace import Trace
from frames.design.codes.pendulum import FrictionPendulum
from frames.design.codes.registry import code_named
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.limits import PROPOSED_LIMIT
from frames.design.testing.acceptance_of_code import checks_of_code
from frames.design.testing.expected import pressure_factor
from lir_element import LIRBearing
from lir_element.fields import check_numbers, number
from lir_element.texts import joined

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.codes.bounds import PropertyBounds
    from frames.design.testing.loops import Cycle, PrototypeTest

_SEVERAL = 2  # cycles, of which one can be less than the first
_ALIKE = 1.1  # displacements of cycles that are checked together, largest over least


@dataclass(frozen=True, kw_only=True)
class AcceptanceLimits:
    """Tolerances of measured loops; defaults of ASCE 7-10, 17.8.4, to be confirmed.

    Parameters
    ----------
    spread : float
        Deviation of post-elastic stiffness and energy dissipated per cycle (EDC) from the mean of
        the set's cycles [-].
    drop : float
        Drop of effective stiffness and damping over the cycles of a test of many cycles [-]; for
        the interface alone of its energy, over the cycles of any test.
    many_cycles : int
        Least number of cycles of a test of many cycles, two at least; codes require ten or more.
    stiffness : (float, float)
        Range of the post-elastic stiffness over N / L [-].

    Raises
    ------
    CheckError
        If a number is out of bounds.

    Examples
    --------
    >>> limits = AcceptanceLimits(spread=0.10)
    >>> limits.spread, limits.drop
    (0.1, 0.2)
    """

    spread: float = field(default=0.15, metadata=number("-", "[0, 1)"))
    drop: float = field(default=0.20, metadata=number("-", "[0, 1)"))
    many_cycles: int = field(
        default=10, metadata=number("-", f"[{_SEVERAL}, inf)", remedy="10 is usual")
    )
    stiffness: tuple[float, float] = (0.85, 1.15)

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)
        least, most = self.stiffness
        if not 0.0 < least <= 1.0 <= most:
            msg = f"stiffness = {self.stiffness}: give a range around 1, usually (0.85, 1.15)"
            raise CheckError(msg)


def acceptance_checks(
    tests: Sequence[PrototypeTest],
    bearing: LIRBearing | FrictionPendulum,
    code: str,
    *,
    bounds: PropertyBounds,
    limits: AcceptanceLimits | None = None,
) -> Checks:
    """Check measured loops against the properties of a design.

    Parameters
    ----------
    tests : sequence of PrototypeTest
        Tests; those of one name and kind are a set, also of several specimens.
    bearing : LIRBearing or FrictionPendulum
        The design, friction nominal.
    code : str
        Code of the design, "ASCE 7-22", "EN 1998" or "NCh2745": specimens against one another
        (ASCE 7-22, NCh2745) and cycles against the third (EN 1998, by NTC 2018) are its own. The
        other limits are those of ASCE 7-10 unless others are given.
    bounds : PropertyBounds
        Factors of friction that the design was made with.
    limits : AcceptanceLimits, optional
        Tolerances of the loops.

    Returns
    -------
    Checks
        Checks of each set: least slope of loading, spread of post-elastic stiffness and energy,
        second stiffness and friction within their bounds, drops of effective stiffness and damping
        over the cycles of a test of many cycles; the code's requirements on specimens, or on each
        cycle against the third. Displacements beyond the rims have no post-elastic stiffness and no
        friction of the surfaces. For the interface alone: friction, spread and drop of the energy.

    Raises
    ------
    CheckError
        If there is no test, or the displacements of a set's cycles differ by more than a tenth. If
        the code is unknown, the bearing has no interface to test, or two surfaces of different
        friction do not both slide.

    Notes
    -----
    Nominal friction is that of high speed, at the pressure of the test if it depends on pressure.

    Examples
    --------
    >>> import numpy as np
    >>> from frames.design import PropertyBounds, PropertyModificationFactors, PrototypeTest
    >>> from frames.design import acceptance_checks
    >>> from lir_element import LIRBearing
    >>> turns = np.linspace(0.0, 3.0, 1501)
    >>> path = 0.2 * np.sin(2.0 * np.pi * turns)
    >>> force = 1e6 * (path / 2.7 + 0.06 * np.sign(np.cos(2.0 * np.pi * turns)))
    >>> test = PrototypeTest(name="1 D_M", displacement=path, force=force, load=1e6)
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> checks = acceptance_checks([test], bearing, "ASCE 7-22", bounds=bounds)
    >>> len(checks), checks.passed
    (7, True)
    """
    rules = code_named(code)
    if not tests:
        msg = "tests is empty: give at least one PrototypeTest"
        raise CheckError(msg)
    chosen, found = limits or AcceptanceLimits(), []
    sets: dict[tuple[str, str], list[PrototypeTest]] = {}
    for test in tests:
        sets.setdefault((test.name, test.kind), []).append(test)
    for (name, kind), group in sets.items():
        _require_alike(name, group)
        one = _Set(name, group, bearing, bounds, chosen, rules.acceptance)
        found += one.of_interface() if kind == "interface" else one.of_bearing()
        if kind != "interface":
            found += checks_of_code(rules, name, group, FrictionPendulum.of(bearing).capacity)
    return Checks(found)


def _require_alike(name: str, tests: Sequence[PrototypeTest]) -> None:
    ways = [cycle.travel for test in tests for cycle in test.cycles]
    if max(ways) > _ALIKE * min(ways):
        msg = (
            f"test {name!r} has cycles from {500.0 * min(ways):.4g} to "
            f"{500.0 * max(ways):.4g} mm: give the cycles of each displacement as a "
            "separate test"
        )
        raise CheckError(msg)


@dataclass(frozen=True)
class _Set:
    # Tests that are checked together.
    name: str
    tests: list[PrototypeTest]
    bearing: LIRBearing | FrictionPendulum
    bounds: PropertyBounds
    limits: AcceptanceLimits
    clause: str

    @property
    def _cycles(self) -> list[Cycle]:
        return [cycle for test in self.tests for cycle in test.cycles]

    @property
    def _labels(self) -> tuple[str, ...]:
        return tuple(
            joined(self.name, test.specimen, f"cycle {k}", by=", ")
            for test in self.tests
            for k in range(1, len(test.cycles) + 1)
        )

    def of_bearing(self) -> list[Check]:
        own = FrictionPendulum.of(self.bearing)
        reached = max(max(c.highest, -c.lowest) for c in self._cycles)
        t, judge = self._begin(FROM_MEMORY)
        found = [self._each(judge, "E", "energy dissipated per cycle (EDC)", "spread")]
        if reached <= own.capacity:
            t.given_each(
                "k_d",
                [sum(c.slopes) / 2.0 for c in self._cycles],
                "N/m",
                note="mean slope of loading",
            )
            t.given_each(
                "k_inc",
                [min(c.slopes) for c in self._cycles],
                "N/m",
                note="lesser slope of loading",
            )
            t.given("k_0", 0.0, "N/m")
            found.append(
                judge.worst(
                    self.clause, "slope of loading", "k_inc", ">=", "k_0", subjects=self._labels
                )
            )
            found.append(self._each(judge, "k_d", "post-elastic stiffness", "spread"))
            found += self._stiffness(judge, own) + self._friction(judge, own)
        return found + self._drops(judge, ("k_eff", "beta_eff"), self.limits.many_cycles)

    def of_interface(self) -> list[Check]:
        if not isinstance(self.bearing, LIRBearing) or self.bearing.is_dcfp:
            msg = (
                f"test {self.name!r} is of the interface, and the bearing has none: leave the "
                "test out"
            )
            raise CheckError(msg)
        _, judge = self._begin(PROJECT)
        factors = self.bounds.interface_factors
        mu, said = self.bearing.interface_friction, "friction of the interface"
        range_ = factors.lower, factors.upper
        return [
            self._each(judge, "E", "energy dissipated per cycle (EDC)", "spread"),
            *self._within(judge, "mu_h", mu, range_, said),
            *self._drops(judge, ("E",), _SEVERAL),
        ]

    def _begin(self, standing: Standing) -> tuple[Trace, CheckBuilder]:
        t = Trace()
        cycles = self._cycles
        t.given_each("E", [c.energy for c in cycles], "J", note="of each cycle")
        t.given_each("N", [c.load for c in cycles], "N", note="mean load of each cycle")
        t.given_each(
            "Delta",
            [c.travel / 2.0 for c in cycles],
            "m",
            shown="mm",
            note="half the way between both ends",
        )
        t.given("n", float(len(cycles)), note="cycles")
        t.given("spread", self.limits.spread, shown="%")
        t.given("drop", self.limits.drop, shown="%")
        return t, CheckBuilder(t, "", standing)

    def _each(self, judge: CheckBuilder, symbol: str, title: str, limit: str) -> Check:
        # Deviation of each cycle from the mean.
        judge.t(f"{symbol}_mean", f"sum({symbol}) / n", judge.t[symbol].unit)
        judge.t.each(f"dev_{symbol}", f"abs({symbol} / {symbol}_mean - 1)", shown="%")
        return judge.worst(
            self._cited(judge),
            f"{title}, off the set's mean",
            f"dev_{symbol}",
            "<=",
            limit,
            subjects=self._labels,
        )

    def _stiffness(self, judge: CheckBuilder, own: FrictionPendulum) -> list[Check]:
        t = judge.t
        t.given("L", own.effective_radius, "m")
        t("r_k", "sum(k_d * L / N) / n", note="post-elastic stiffness over N / L, mean")
        for name, value in zip(("low", "high"), self.limits.stiffness, strict=True):
            t.given(f"r_{name}", value)
        title = "post-elastic stiffness over N / L"
        return [
            judge.worst(self.clause, title, "r_k", relation, limit, subjects=(self.name,))
            for relation, limit in _range("r_low", "r_high")
        ]

    def _friction(self, judge: CheckBuilder, own: FrictionPendulum) -> list[Check]:
        factors, said = self.bounds.friction, "friction by the energy"
        count = len(self._cycles)
        amplitude = sum(c.travel for c in self._cycles) / (2.0 * count)
        load = sum(c.load for c in self._cycles) / count
        nominal = own.loop_energy(amplitude, 1.0) / (4.0 * amplitude)
        nominal *= pressure_factor(self.bearing, load)
        return self._within(judge, "mu", nominal, (factors.lower, factors.upper), said)

    def _within(
        self,
        judge: CheckBuilder,
        symbol: str,
        nominal: float,
        factors: tuple[float, float],
        title: str,
    ) -> list[Check]:
        # Mean friction of the set within its bounds.
        t = judge.t
        t.each(f"{symbol}_i", "E / (4 * N * Delta)")
        t(symbol, f"sum({symbol}_i) / n", note="mean of the cycles")
        t.given(f"{symbol}_nom", nominal, note="of the design")
        for name, factor in zip(("min", "max"), factors, strict=True):
            t.given(f"lambda_{name}", factor)
            t(f"{symbol}_{name}", f"lambda_{name} * {symbol}_nom")
        clause = self._cited(judge)
        return [
            judge.worst(clause, title, symbol, relation, limit, subjects=(self.name,))
            for relation, limit in _range(f"{symbol}_min", f"{symbol}_max")
        ]

    def _drops(self, judge: CheckBuilder, symbols: tuple[str, ...], least: int) -> list[Check]:
        # Largest drop against the first cycle, of the tests with so many cycles.
        several = [test for test in self.tests if len(test.cycles) >= least]
        names = tuple(joined(self.name, test.specimen, by=", ") for test in several)
        found = []
        for symbol in symbols if several else ():
            values = [[_VALUES[symbol](cycle) for cycle in test.cycles] for test in several]
            unit, t = _UNITS[symbol], judge.t
            t.given_each(f"{symbol}_1", [v[0] for v in values], unit, note="first cycle")
            t.given_each(f"{symbol}_least", [min(v) for v in values], unit, note="of its test")
            t.each(f"drop_{symbol}", f"1 - {symbol}_least / {symbol}_1", shown="%")
            found.append(
                judge.worst(
                    self._cited(judge),
                    f"{_TITLES[symbol]}: drop over the cycles",
                    f"drop_{symbol}",
                    "<=",
                    "drop",
                    subjects=names,
                )
            )
        return found

    def _cited(self, judge: CheckBuilder) -> str:
        return PROPOSED_LIMIT if judge.standing.kind == "own" else self.clause


def _range(low: str, high: str) -> tuple[tuple[Literal[">=", "<="], str], ...]:
    return (">=", low), ("<=", high)


_VALUES = {
    "k_eff": lambda cycle: cycle.stiffness,
    "beta_eff": lambda cycle: cycle.damping,
    "E": lambda cycle: cycle.energy,
}
_UNITS = {"k_eff": "N/m", "beta_eff": "-", "E": "J"}
_TITLES = {"k_eff": "effective stiffness", "beta_eff": "effective damping", "E": "energy"}
