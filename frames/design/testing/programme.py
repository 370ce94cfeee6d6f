"""The tests by which a manufacturer proves the properties that a design counts on, by code."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from frames.design._errors import CheckError
from frames.design.calculation.check import TO_BE_CONFIRMED
from frames.design.calculation.unevaluated import NOT_EVALUATED
from frames.design.codes.bounds import ENDS, with_property_bounds
from frames.design.codes.pendulum import FrictionPendulum
from frames.design.devices.bearing_numbers import ordered_loads
from lir_element import LIRBearing
from lir_element.argument_checks import require_non_negative, require_positive

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    import pandas as pd

    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import BoundResult, EquivalentLinear

PROPOSAL = "no code: a proposal"
"""Clause of tests that no code has."""

_ALIKE = 1e-6  # of displacements at two bounds
_LEAST_SLIP = 0.25  # of the stable limit of interface slip: tested though runs slip less
_STEPS = (0.25, 0.50, 0.67, 1.00)
_TESTS = {"ASCE 7-22": "ASCE 7-22 17.8.2.2", "EN 1998": "EN 15129 8.3.4", "NCh2745": "NCh2745 14"}


class PlannedTest(NamedTuple):
    """A test of the programme; NaN where a number is not given or has no meaning."""

    name: str
    displacement: float  # m
    load: float  # N
    cycles: float
    speed: float  # m/s, the largest of a cycle
    shows: str
    clause: str
    lateral: float = math.nan  # N, where the test goes to a force
    alone: bool = False  # the interface between the sliders, without the concave surfaces


@dataclass(frozen=True, kw_only=True)
class ProgrammeDemands:
    """What a programme of tests asks for besides the equivalent-linear analysis.

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
        Interface slip of time histories [m]. What the design displacement with torsion is beyond
        the rims, and a quarter of the stable limit of interface slip, are tested at least.
    impact_speed : float, optional
        Speed at which a rim is met [m/s]. None: of a harmonic motion with the design's period and
        displacement with torsion; its largest, where that does not reach a rim.
    slow_speed : float
        Peak speed of tests that are not dynamic [m/s]; EN 15129 has 50 mm/s.

    Raises
    ------
    CheckError
        If a number is out of bounds.
    """

    loads: tuple[float, float] | None = None
    wind: float | None = None
    service: float | None = None
    slip: float | None = None
    impact_speed: float | None = None
    slow_speed: float = 0.05

    def __post_init__(self) -> None:
        for name, unit in (("wind", "N"), ("service", "m"), ("impact_speed", "m/s")):
            if getattr(self, name) is not None:
                require_positive(name, getattr(self, name), unit, error=CheckError)
        if self.slip is not None:
            require_non_negative("slip", self.slip, "m", error=CheckError)
        require_positive("slow_speed", self.slow_speed, "m/s", error=CheckError)
        if self.loads is not None:
            ordered_loads(self.loads)


@dataclass(frozen=True)
class _Design:
    # What the tests of one kind of bearing are made of.
    result: BoundResult  # at the bound of the largest displacement
    bearing: LIRBearing | FrictionPendulum
    ends: list[LIRBearing | FrictionPendulum]  # it at the lower and at the upper bound
    average: float  # N
    least: float  # N
    largest: float  # N
    demands: ProgrammeDemands

    def speed_at(self, displacement: float, period: float | None = None) -> float:
        """Peak speed of harmonic motion, with the effective period unless another is given."""
        return 2.0 * math.pi * displacement / (period or self.result.period)


def prototype_tests(
    equivalent: EquivalentLinear,
    system: IsolationSystem,
    demands: ProgrammeDemands | None = None,
    *,
    bounds: PropertyBounds | None = None,
) -> pd.DataFrame:
    """Return the tests of a design's bearings: what is imposed, and the forces to expect.

    Parameters
    ----------
    equivalent : EquivalentLinear
        Analysis by ASCE 7-22, EN 1998 or NCh2745: its code decides, and its displacement, period
        and damping factor at the bound of the largest displacement count.
    system : IsolationSystem
        The bearings with nominal friction, their average loads and combinations. Equal bearings
        are one kind, which is tested at the mean of its average loads.
    demands : ProgrammeDemands, optional
        Loads with the earthquake, wind, slip, speeds.
    bounds : PropertyBounds, optional
        Factors of friction; the forces expected are nominal if None.

    Returns
    -------
    pandas.DataFrame
        A row a test, numbered from 1: kind of bearing, test, displacement [m], vertical load [N],
        fully reversed cycles, period [s] and peak speed [m/s] of harmonic motion, least and
        largest lateral force to expect with friction of high speed at its bounds [N], what the
        test shows, clause and its standing. NaN: not given, or without meaning. Of an LIR-DCFP
        there are tests besides that no code has: the interface alone, and impacts. Where the
        system's loads are not known (`IsolationSystem.unknown_loads`) and `demands` gives none,
        tests at the largest and the least load have NaN for it, and say why in their standing.

    Raises
    ------
    CheckError
        If the analysis is not of one of the three codes, or least and largest load are not above
        zero.
    """
    import pandas as pd

    asked = ProgrammeDemands() if demands is None else demands
    if equivalent.code not in _TESTS:
        msg = f"code of the analysis {equivalent.code!r}: there are tests of {', '.join(_TESTS)}"
        raise CheckError(msg)
    result = _governing(equivalent)
    ends = [system if bounds is None else with_property_bounds(system, end, bounds) for end in ENDS]
    rows = []
    for title, bearing, places in _kinds(system):
        at_ends = [end.bearings[places[0]] for end in ends]
        design = _Design(result, bearing, at_ends, *_loads(system, places, asked), asked)
        own = _TESTS_OF[equivalent.code](design)
        rows += [_row(title, test, design) for test in (*own, *_of_interface(design))]
    table = pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="test"))
    return _without_loads(table, "" if asked.loads is not None else system.unknown_loads)


def _governing(equivalent: EquivalentLinear) -> BoundResult:
    # At the bound of the largest displacement; of alike ones, as where the spectrum asks for the
    # same displacement whatever the period, the one of the shorter period: its tests are faster.
    least = (1.0 - _ALIKE) * equivalent.total_displacement
    found = [each for each in equivalent.bounds.values() if each.total_displacement >= least]
    return min(found, key=lambda each: each.period)


def _without_loads(table: pd.DataFrame, why: str) -> pd.DataFrame:
    # Tests at the largest or the least load have none where it is not known.
    if why:
        of_load = table["what"].str.contains("(?:largest|least) load", regex=True)
        table.loc[of_load, ["vertical load [N]", "least force [N]", "largest force [N]"]] = math.nan
        table.loc[of_load, "standing"] = f"{NOT_EVALUATED}: {why}"
    return table


def _kinds(
    system: IsolationSystem,
) -> list[tuple[str, LIRBearing | FrictionPendulum, list[int]]]:
    # Equal bearings: title, the bearing, where they are.
    unlike: list[LIRBearing | FrictionPendulum] = []
    for bearing in system.bearings:
        if bearing not in unlike:
            unlike.append(bearing)
    found = []
    for n, bearing in enumerate(unlike, start=1):
        places = [k for k, other in enumerate(system.bearings) if other == bearing]
        found.append((f"kind {n}, {len(places)} of {len(system.bearings)}", bearing, places))
    return found


def _loads(
    system: IsolationSystem, places: list[int], asked: ProgrammeDemands
) -> tuple[float, float, float]:
    # Average, least and largest load of a kind.
    average = sum(system.loads[k] for k in places) / len(places)
    if asked.loads is not None:
        return average, *asked.loads
    groups = (system.loads, *system.combinations.values())
    every = [loads[k] for loads in groups for k in places]
    remedy = "give the loads with the earthquake, ProgrammeDemands(loads=(least, largest))"
    least = require_positive(
        "least axial load of the combinations", min(every), "N", remedy=remedy, error=CheckError
    )
    return average, least, max(every)


def _wind(d: _Design, clause: str) -> PlannedTest:
    force = math.nan if d.demands.wind is None else d.demands.wind
    return PlannedTest(
        "wind", math.nan, d.average, 20.0, math.nan, "holds under wind", clause, force
    )


def _increments(
    d: _Design, steps: Iterable[tuple[str, float, float]], clause: str
) -> Iterable[PlannedTest]:
    # Steps of displacement [m] by name with their speed [m/s], at each of three loads.
    for words, load in (("average", d.average), ("largest", d.largest), ("least", d.least)):
        for name, at, speed in steps:
            yield PlannedTest(
                f"increments, {words} load, {name}",
                at,
                load,
                3.0,
                speed,
                "stiffness and energy at each displacement",
                clause,
            )


def _stable(d: _Design, name: str, displacement: float, clause: str) -> PlannedTest:
    return PlannedTest(
        f"maximum displacement, {name}",
        displacement,
        d.average,
        3.0,
        d.speed_at(displacement),
        f"stable at {name}",
        clause,
    )


def _many(d: _Design, at: tuple[str, float, float], cycles: float, clause: str) -> PlannedTest:
    name, displacement, speed = at
    return PlannedTest(
        f"many cycles, {name}",
        displacement,
        d.average,
        cycles,
        speed,
        "heat and wear over an earthquake",
        clause,
    )


def _static(d: _Design, clause: str) -> Iterable[PlannedTest]:
    for words, load in (("largest", d.largest), ("least", d.least)):
        yield PlannedTest(
            f"static, {words} load, D_TM",
            d.result.total_displacement,
            load,
            1.0,
            d.demands.slow_speed,
            "carries its load at D_TM",
            clause,
        )


def _asce7(d: _Design) -> Iterable[PlannedTest]:
    clause, t, moved = _TESTS["ASCE 7-22"], d.result.trace, d.result.displacement
    yield PlannedTest(
        "production, each bearing",
        0.67 * moved,
        d.average,
        3.0,
        d.demands.slow_speed,
        "each bearing is as the prototypes",
        "ASCE 7-22 17.8.5",
    )
    yield _wind(d, f"{clause} (1)")
    steps = [(f"{share:g} D_M", share * moved, d.speed_at(share * moved)) for share in _STEPS]
    yield from _increments(d, steps, f"{clause} (2)")
    yield _stable(d, "D_M", moved, f"{clause} (3)")
    yield _stable(d, "D_TM", d.result.total_displacement, f"{clause} (3)")
    count = max(10.0, 30.0 * t.value("S_M1") / (t.value("S_MS") * t.value("B_M")))
    at = "0.75 D_M", 0.75 * moved, d.speed_at(0.75 * moved)
    yield _many(d, at, float(math.ceil(count - 1e-9)), f"{clause} (4)")
    yield from _static(d, "ASCE 7-22 17.8.2.5")


def _en15129(d: _Design) -> Iterable[PlannedTest]:
    clause, total, slow = _TESTS["EN 1998"], d.result.total_displacement, d.demands.slow_speed
    fast = d.speed_at(total)
    service = math.nan if d.demands.service is None else d.demands.service
    for name, share, load, cycles, speed, shows in (
        ("S, service", service / total, d.average, 20.0, 0.1 * slow, "moves with temperature"),
        ("P1, benchmark", 1.0, d.average, 3.0, slow, "what later tests are compared with"),
        ("D1, dynamic", 0.25, d.average, 3.0, fast, "friction and stiffness"),
        ("D2, dynamic", 0.50, d.average, 3.0, fast, "friction and stiffness"),
        ("D3, dynamic", 1.00, d.average, 3.0, fast, "friction and stiffness"),
        ("P2, integrity of the liner", 1.0, d.average, 3.0, slow, "as P1 after the dynamic tests"),
        ("D4, seismic, largest load", 1.0, d.largest, 3.0, fast, "friction and stability"),
        ("D5, seismic, least load", 1.0, d.least, 3.0, fast, "friction and stability"),
        ("B, both directions", 1.0, d.average, 3.0, fast, "clover-leaf path: friction in plan"),
    ):
        yield PlannedTest(name, share * total, load, cycles, speed, shows, clause)


def _nch2745(d: _Design) -> Iterable[PlannedTest]:
    # Each displacement with the period of its level: D_D with T_D, D_M with T_M.
    clause, t = _TESTS["NCh2745"], d.result.trace

    def at_design(name: str, displacement: float) -> tuple[str, float, float]:
        return name, displacement, d.speed_at(displacement, t.value("T_D"))

    design, most = t.value("D_D"), t.value("D_M")
    yield _wind(d, clause)
    steps = (
        at_design("0.2 D_D", 0.2 * design),
        at_design("0.5 D_D", 0.5 * design),
        at_design("D_D", design),
        ("D_M", most, d.speed_at(most)),
    )
    yield from _increments(d, steps, clause)
    yield _stable(d, "D_TM", d.result.total_displacement, clause)
    yield _many(d, at_design("D_TD", t.value("D_TD")), 10.0, clause)
    yield from _static(d, clause)


_TESTS_OF: dict[str, Callable[[_Design], Iterable[PlannedTest]]] = {
    "ASCE 7-22": _asce7,
    "EN 1998": _en15129,
    "NCh2745": _nch2745,
}


def _of_interface(d: _Design) -> Iterable[PlannedTest]:
    # Of an LIR-DCFP: its interface alone, and impacts.
    bearing = d.bearing
    if not isinstance(bearing, LIRBearing) or bearing.is_dcfp:
        return
    rim, total = bearing.lateral_capacity, d.result.total_displacement
    if not math.isfinite(rim):
        return
    holds = min(bearing.resolved()["slip_capacity"], max(bearing.slip_stability, 0.0))
    slip = max(total - rim, d.demands.slip or 0.0, _LEAST_SLIP * holds)
    speed = d.demands.impact_speed
    if speed is None:  # harmonic: at the rim, of the amplitude
        speed = d.speed_at(math.sqrt(total**2 - rim**2) if total > rim else total)
    slow = d.demands.slow_speed
    for words, load in (("largest", d.largest), ("least", d.least)):
        for pace, at in (("slow", slow), ("fast", speed)):
            yield PlannedTest(
                f"interface alone, {words} load, {pace}",
                slip,
                load,
                3.0,
                at,
                "friction of the interface: what holds it, and limits the impact",
                PROPOSAL,
                alone=True,
            )
    for words, load in (("average", d.average), ("largest", d.largest)):
        yield PlannedTest(
            f"impact and return, {words} load",
            rim + slip,
            load,
            3.0,
            speed,
            "rims met, interface slips and comes back; residual slip, liner and rims looked at",
            PROPOSAL,
        )
    moved = min(d.result.displacement, 0.9 * rim)
    yield PlannedTest(
        "after the impacts",
        moved,
        d.average,
        3.0,
        slow,
        "the interface holds again: loop as before",
        PROPOSAL,
    )


def _row(kind: str, test: PlannedTest, design: _Design) -> dict[str, object]:
    least, most = (_force(test, bearing) for bearing in design.ends)
    period = 2.0 * math.pi * test.displacement / test.speed if test.speed > 0.0 else math.nan
    return {
        "bearings": kind,
        "what": test.name,
        "displacement [m]": test.displacement,
        "vertical load [N]": test.load,
        "cycles": test.cycles,
        "period [s]": period,
        "peak speed [m/s]": test.speed,
        "least force [N]": least,
        "largest force [N]": most,
        "shows": test.shows,
        "clause": test.clause,
        "standing": "a proposal" if test.clause == PROPOSAL else TO_BE_CONFIRMED,
    }


def pressure_factor(bearing: LIRBearing | FrictionPendulum, load: float) -> float:
    """Return what the pressure under a load [N] makes of the surfaces' nominal friction [-]."""
    if not isinstance(bearing, LIRBearing) or bearing.pressure_dependence is None:
        return 1.0
    area = math.pi * bearing.slider_radius**2
    reference = bearing.resolved()["design_load"] / area
    return bearing.pressure_dependence.factor(load / area, reference)


def _force(test: PlannedTest, bearing: LIRBearing | FrictionPendulum) -> float:
    # Lateral force at the displacement, as design formulas have it.
    if math.isfinite(test.lateral) or math.isnan(test.displacement):
        return test.lateral
    own = FrictionPendulum.of(bearing)
    if test.alone and isinstance(bearing, LIRBearing):
        return bearing.interface_friction * test.load
    if own.corner <= test.displacement <= own.capacity:
        more = (pressure_factor(bearing, test.load) - 1.0) * own.effective_friction
        return own.force(test.displacement, test.load) + more * test.load
    limit = bearing.force_limit(test.load) if isinstance(bearing, LIRBearing) else math.inf
    return limit if math.isfinite(limit) else math.nan
