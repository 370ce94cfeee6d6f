"""The tests by which a manufacturer proves the properties that a design counts on, by code."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.standing import PROJECT, Standing
from frames.design.codes.bounds import ENDS
from frames.design.codes.code_values import CodeValue, weakest
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.pendulum import FrictionPendulum
from frames.design.codes.prototype_programme import (
    AcceptanceRule,
    DesignToTest,
    PlannedTest,
    ProgrammeDemands,
    accepted_of,
)
from frames.design.codes.registry import code_named
from frames.design.devices.limits import PROPOSED_LIMIT
from frames.design.testing.expected import LOOPS, lateral_force, loop_numbers
from lir_element import LIRBearing
from lir_element.argument_checks import require_positive
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pandas as pd

    from frames.design.codes.bounds import PropertyBounds
    from frames.design.codes.isolation import IsolationSystem
    from frames.design.codes.outcome import BoundResult, EquivalentLinear


SPECIMENS = 2
"""Full-size prototypes of each kind; the value "number of specimens" of a code has the clause."""

OWN_SPECIMENS = CodeValue(PROPOSED_LIMIT, "two full-size specimens of each type and size", PROJECT)
"""The same of a code without that value."""

OWN_RULES = (
    AcceptanceRule(
        ("each bearing produced",),
        CodeValue(
            PROPOSED_LIMIT,
            "effective stiffness and EDC within the factors of the specification",
            PROJECT,
        ),
    ),
    AcceptanceRule(
        ("interface alone",),
        CodeValue(
            PROPOSED_LIMIT,
            "friction of the interface within the bounds that the design counts on",
            PROJECT,
        ),
    ),
    AcceptanceRule(
        ("impact and return",),
        CodeValue(PROPOSED_LIMIT, "rims, liner and welds whole; the slider comes back", PROJECT),
    ),
    AcceptanceRule(
        ("after the impacts",),
        CodeValue(
            PROPOSED_LIMIT, "the interface does not slip; EDC as before the impacts", PROJECT
        ),
    ),
)
"""Proposed acceptance of the tests that no code has."""

_ALIKE = 1e-6  # of displacements at two bounds
_LEAST_SLIP = 0.25  # of the stable limit of interface slip: tested though runs slip less
_STEPS = (0.25, 0.50, 0.67, 1.00)


def prototype_tests(
    equivalent: EquivalentLinear,
    system: IsolationSystem,
    demands: ProgrammeDemands | None = None,
    *,
    bounds: PropertyBounds | None = None,
) -> pd.DataFrame:
    """Return the tests of a design's bearings: imposed motion, and the expected forces.

    Parameters
    ----------
    equivalent : EquivalentLinear
        The analysis: its code, and its displacement, period and damping factor at the bound of the
        largest displacement.
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
        A row a test, numbered from 1. Kind of bearing, test, displacement [m], vertical load [N],
        fully reversed cycles, period [s] and peak speed [m/s] of harmonic motion, least and largest
        expected lateral force with friction of high speed at its bounds [N], purpose of the test,
        clause, its source, acceptance with the clauses, a note. Expected k_eff [N/m], energy per
        cycle (EDC) [J] and friction [-] at each bound by the path's mean friction without heating,
        and their accepted least and largest values: nominal values times the factors of tests, of
        the production those of the specification, all factors together if these are not given. NaN:
        not given, or without meaning. An LIR-DCFP has further tests that no code has: the interface
        alone, and impacts. If the system's loads are unknown (`IsolationSystem.unknown_loads`) and
        `demands` gives none, the largest and the least load are NaN, with the reason in a note.

    Raises
    ------
    CheckError
        If the code of the analysis is not known, or least and largest load are not above
        zero.

    Examples
    --------
    >>> from frames.design import IsolationSystem, PropertyBounds, PropertyModificationFactors
    >>> from frames.design import Spectrum, equivalent_linear, prototype_tests
    >>> from lir_element import LIRBearing
    >>> bearing = LIRBearing(radius=1.5, slider_height=0.3, slider_radius=0.2, capacity=0.45,
    ...                      friction=0.06, interface_friction=0.25)
    >>> system = IsolationSystem(bearings=(bearing,) * 4, loads=(1.5e6,) * 4, plan=(9.0, 9.0),
    ...                          positions=((-4, -4), (4, -4), (4, 4), (-4, 4)))
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.2))
    >>> target = Spectrum.asce7(s_ms=1.2, s_m1=0.6)
    >>> linear = equivalent_linear(system, target, bounds=bounds)
    >>> tests = prototype_tests(linear, system, bounds=bounds)
    >>> len(tests), tests["what"].iloc[0]
    (26, 'production, each bearing')
    """
    import pandas as pd

    asked = ProgrammeDemands() if demands is None else demands
    code = code_named(equivalent.code)
    known = weakest((code.standing("tests"), code.standing("cycles")))
    result = _governing(equivalent)
    ends = [system if bounds is None else with_property_bounds(system, end, bounds) for end in ENDS]
    rows = []
    for title, bearing, places in _kinds(system):
        at_ends = [end.bearings[places[0]] for end in ends]
        design = DesignToTest(result, bearing, at_ends, *_loads(system, places, asked), asked)
        planned = list(code.tests(design))
        own = [*_production(design, planned), *_of_interface(design)]
        rows += [_row(title, test, design, known, code.accepted, bounds) for test in planned]
        rows += [_row(title, test, design, PROJECT, OWN_RULES, bounds) for test in own]
    table = pd.DataFrame(rows, index=pd.RangeIndex(1, len(rows) + 1, name="test"))
    return _without_loads(table, "" if asked.loads is not None else system.unknown_loads)


def _governing(equivalent: EquivalentLinear) -> BoundResult:
    # Bound of the largest displacement; of equal ones, for example if the spectrum needs the same
    # displacement at any period, the one of the shorter period: its tests are faster.
    least = (1.0 - _ALIKE) * equivalent.total_displacement
    found = [each for each in equivalent.bounds.values() if each.total_displacement >= least]
    return min(found, key=lambda each: each.period)


def _without_loads(table: pd.DataFrame, why: str) -> pd.DataFrame:
    # The load is NaN in tests at the largest or the least load if it is unknown.
    if why:
        of_load = table["what"].str.contains("(?:largest|least) load", regex=True)
        of_it = ["vertical load [N]", "least force [N]", "largest force [N]", *LOOPS]
        table.loc[of_load, of_it] = math.nan
        table.loc[of_load, "note"] = worded("not evaluated: {why}", why=why)
    return table


def _kinds(
    system: IsolationSystem,
) -> list[tuple[str, LIRBearing | FrictionPendulum, list[int]]]:
    # Equal bearings: title, the bearing, their places.
    unlike: list[LIRBearing | FrictionPendulum] = []
    for bearing in system.bearings:
        if bearing not in unlike:
            unlike.append(bearing)
    found = []
    for n, bearing in enumerate(unlike, start=1):
        places = [k for k, other in enumerate(system.bearings) if other == bearing]
        found.append(
            (
                worded(
                    "kind {n}, {count} of {all}", n=n, count=len(places), all=len(system.bearings)
                ),
                bearing,
                places,
            )
        )
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


def _production(d: DesignToTest, planned: Iterable[PlannedTest]) -> Iterable[PlannedTest]:
    # A code without a test of each bearing produced has that of ASCE 7-22.
    if not any(test.name.startswith("production") for test in planned):
        yield PlannedTest(
            "each bearing produced",
            0.67 * d.result.displacement,
            d.average,
            3.0,
            d.demands.slow_speed,
            "each bearing is as the prototypes",
            PROPOSED_LIMIT,
        )


def _of_interface(d: DesignToTest) -> Iterable[PlannedTest]:
    # Tests of an LIR-DCFP: its interface alone, and impacts.
    bearing = d.bearing
    if not isinstance(bearing, LIRBearing) or bearing.is_dcfp:
        return
    rim, total = bearing.lateral_capacity, d.result.allowed_displacement
    if not math.isfinite(rim):
        return
    holds = min(bearing.resolved()["slip_capacity"], max(bearing.slip_stability, 0.0))
    slip = max(total - rim, d.demands.slip or 0.0, _LEAST_SLIP * holds)
    speed = d.demands.impact_speed
    if speed is None:  # harmonic: at the rim, of the amplitude
        speed = d.speed_at(math.sqrt(total**2 - rim**2) if total > rim else total)
    slow = d.demands.slow_speed
    for words, load in (("largest load", d.largest), ("least load", d.least)):
        for pace, at in (("slow", slow), ("fast", speed)):
            yield PlannedTest(
                joined("interface alone", words, pace, by=", "),
                slip,
                load,
                3.0,
                at,
                "friction of the interface: prevents slip before rim contact, and limits the "
                "impact force",
                PROPOSED_LIMIT,
                alone=True,
            )
    for words, load in (("average load", d.average), ("largest load", d.largest)):
        yield PlannedTest(
            joined("impact and return", words, by=", "),
            rim + slip,
            load,
            3.0,
            speed,
            "rim contact, interface slips and comes back; residual slip, liner and rims inspected",
            PROPOSED_LIMIT,
        )
    moved = min(d.result.displacement, 0.9 * rim)
    yield PlannedTest(
        "after the impacts",
        moved,
        d.average,
        3.0,
        slow,
        "the interface does not slip: loop as before",
        PROPOSED_LIMIT,
    )


def _row(
    kind: str,
    test: PlannedTest,
    design: DesignToTest,
    standing: Standing,
    rules: Iterable[AcceptanceRule],
    bounds: PropertyBounds | None,
) -> dict[str, object]:
    least, most = (lateral_force(test, bearing) for bearing in design.ends)
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
        "standing": str(standing),
        "accepted if": accepted_of(rules, test.name),
        "note": "",
    } | dict(zip(LOOPS, loop_numbers(test, design.bearing, design.ends, bounds), strict=True))
