"""Prototype tests of bearings in codes: the kinds of tests, their input, and usual ones."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from lir_element.argument_checks import require_positive
from lir_element.fields import check_numbers, number
from lir_element.texts import joined

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.codes.code_values import CodeValue
    from frames.design.codes.outcome import BoundResult
    from frames.design.codes.pendulum import FrictionPendulum
    from lir_element import LIRBearing


class AcceptanceRule(NamedTuple):
    """Acceptance of measured loops in a code, for some tests of its programme.

    Attributes
    ----------
    tests : tuple of str
        Beginning of the names of these tests.
    value : CodeValue
        Criterion, its clause, and its source.

    Examples
    --------
    >>> from frames.design import code_named
    >>> rule = code_named("ASCE 7-22").accepted[-2]
    >>> rule.tests, rule.value.clause
    (('static',), 'ASCE 7-22 17.8.4')
    """

    tests: tuple[str, ...]
    value: CodeValue

    def holds_for(self, test: str) -> bool:
        """Return whether it is of a test of the programme, by its name."""
        return test.startswith(self.tests)


def accepted_of(rules: Iterable[AcceptanceRule], test: str) -> str:
    """Return the acceptance criteria of a test, with clauses and stars, joined by "; "."""
    return "; ".join(
        f"{rule.value.what} ({rule.value.standing.cited(rule.value.clause)})"
        for rule in rules
        if rule.holds_for(test)
    )


def ordered_loads(loads: tuple[float, float]) -> tuple[float, float]:
    """Return a least and a largest axial force [N], or raise a CheckError."""
    least, most = (require_positive("axial load", load, "N", error=CheckError) for load in loads)
    if least > most:
        msg = f"loads = {loads}: give the least first, then the largest [N]"
        raise CheckError(msg)
    return least, most


class PlannedTest(NamedTuple):
    """A test of the programme; NaN for a number that is not given or has no meaning."""

    name: str
    displacement: float  # m
    load: float  # N
    cycles: float
    speed: float  # m/s, the largest of a cycle
    shows: str
    clause: str
    lateral: float = math.nan  # N, if the test is force-controlled
    alone: bool = False  # the interface between the sliders, without the concave surfaces


@dataclass(frozen=True, kw_only=True)
class ProgrammeDemands:
    """Demands of a programme of tests, besides the equivalent-linear analysis.

    Parameters
    ----------
    loads : (float, float), optional
        Least and maximum axial force of a bearing with the earthquake [N]: of time histories or
        load combinations. None: the least and the largest of the system's combinations.
    wind : float, optional
        Lateral force of the design wind on one bearing [N].
    service : float, optional
        Displacement without an earthquake, of temperature for instance [m].
    slip : float, optional
        Interface slip of time histories [m]. The test slip is at least the needed displacement
        capacity beyond the rims, and a quarter of the stable limit of interface slip.
    impact_speed : float, optional
        Speed at rim contact [m/s]. None: that of a harmonic motion with the design's period and the
        needed displacement capacity; its largest speed if it does not reach a rim.
    slow_speed : float
        Peak speed of tests that are not dynamic [m/s]; EN 15129 has 50 mm/s.

    Raises
    ------
    CheckError
        If a number is out of bounds.

    Examples
    --------
    >>> from frames.design import IsolationSystem, ProgrammeDemands, PropertyBounds, Spectrum
    >>> from frames.design import PropertyModificationFactors, equivalent_linear, prototype_tests
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> target = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
    >>> linear = equivalent_linear(system, target, bounds=bounds)
    >>> demands = ProgrammeDemands(loads=(0.4e6, 2.6e6), slip=0.06, wind=25e3)
    >>> tests = prototype_tests(linear, system, demands)
    >>> float(tests.set_index("what").loc["wind", "largest force [N]"])
    25000.0
    """

    loads: tuple[float, float] | None = None
    wind: float | None = field(default=None, metadata=number("N", "(0, inf)"))
    service: float | None = field(default=None, metadata=number("m", "(0, inf)"))
    slip: float | None = field(default=None, metadata=number("m", "[0, inf)"))
    impact_speed: float | None = field(default=None, metadata=number("m/s", "(0, inf)"))
    slow_speed: float = field(default=0.05, metadata=number("m/s", "(0, inf)"))

    def __post_init__(self) -> None:
        check_numbers(self, error=CheckError)
        if self.loads is not None:
            ordered_loads(self.loads)


@dataclass(frozen=True)
class DesignToTest:
    """Design values of one kind of bearing for its tests."""

    result: BoundResult  # equivalent-linear analysis at the bound of the largest displacement
    bearing: LIRBearing | FrictionPendulum  # the bearing, friction nominal
    ends: list[LIRBearing | FrictionPendulum]  # it at the lower and at the upper bound
    average: float  # axial load [N]
    least: float  # axial load [N]
    largest: float  # axial load [N]
    demands: ProgrammeDemands  # further demands

    def speed_at(self, displacement: float, period: float | None = None) -> float:
        """Return the peak speed of harmonic motion [m/s], with the effective period by default."""
        return 2.0 * math.pi * displacement / (period or self.result.period)


def wind_test(d: DesignToTest, clause: str) -> PlannedTest:
    """Return the test that the bearing holds under wind."""
    force = math.nan if d.demands.wind is None else d.demands.wind
    return PlannedTest(
        "wind", math.nan, d.average, 20.0, math.nan, "holds under wind", clause, force
    )


def increments(
    d: DesignToTest, steps: Iterable[tuple[str, float, float]], clause: str
) -> Iterable[PlannedTest]:
    """Yield steps of displacement [m] by name with their speed [m/s], at each of three loads."""
    loads = {"average load": d.average, "largest load": d.largest, "least load": d.least}
    for words, load in loads.items():
        for name, at, speed in steps:
            yield PlannedTest(
                joined("increments", words, name, by=", "),
                at,
                load,
                3.0,
                speed,
                "stiffness and energy at each displacement",
                clause,
            )


def stable_test(d: DesignToTest, name: str, displacement: float, clause: str) -> PlannedTest:
    """Return the test of stability at a displacement [m]."""
    return PlannedTest(
        joined("maximum displacement", name, by=", "),
        displacement,
        d.average,
        3.0,
        d.speed_at(displacement),
        f"stable at {name}",
        clause,
    )


def many_cycles(
    d: DesignToTest, at: tuple[str, float, float], cycles: float, clause: str
) -> PlannedTest:
    """Return the test of many cycles at a displacement [m] by name with its speed [m/s]."""
    name, displacement, speed = at
    return PlannedTest(
        joined("many cycles", name, by=", "),
        displacement,
        d.average,
        cycles,
        speed,
        "heat and wear over an earthquake",
        clause,
    )


def static_tests(d: DesignToTest, clause: str) -> Iterable[PlannedTest]:
    """Yield slow tests at the total displacement under the largest and the least load."""
    for words, load in (("largest load", d.largest), ("least load", d.least)):
        yield PlannedTest(
            joined("static", words, "D_TM", by=", "),
            d.result.total_displacement,
            load,
            1.0,
            d.demands.slow_speed,
            "carries its load at D_TM",
            clause,
        )


def no_tests(design: DesignToTest) -> Iterable[PlannedTest]:
    """Return none: of a code without tests of its own."""
    return ()
