"""Equivalent-linear analysis, common part of all codes: the order of its steps."""

from __future__ import annotations

import abc
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check, Checks
from frames.design.calculation.not_evaluated import not_evaluated
from frames.design.calculation.standing import FROM_MEMORY
from frames.design.codes.code_values import CodeValue
from frames.design.codes.outcome import BoundResult, Iteration, Symbols
from frames.design.codes.secant import CheckBuilder, held_by, iterate_displacement
from lir_element.device.bearing import LIRBearing
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames.design.calculation.trace import Trace
    from frames.design.codes.isolation import Extremes, IsolationSystem
    from frames.design.codes.superstructure import Superstructure
    from frames.design.hazard.spectrum import Spectrum

_SAME_CENTRE = 1e-3
"""Distance of two centres over the side of the plan, below which they are one."""


@dataclass(frozen=True, kw_only=True)
class LinearAnalysis(abc.ABC):
    """An equivalent-linear analysis: steps in the order of all codes, formulas of each code.

    A code's class gives the abstract methods; class variables name its symbols and clauses. Its
    factors are fields of a frozen dataclass (docs/extending.md).
    """

    name: ClassVar[str]
    symbols: ClassVar[Symbols]
    each: ClassVar[str]
    """Symbol of the displacement of each bearing, torsion included."""
    sliding: ClassVar[str] = ""
    """Symbol of the displacement at which all must slide, if not the central one."""
    level: ClassVar[str] = ""
    """Level of the seismic action of the checks."""
    loads_level: ClassVar[str] = ""
    """The same of overturning and vertical loads, if another."""
    values: ClassVar[Mapping[str, CodeValue]] = {}
    reduced_by: ClassVar[str] = ""
    """Symbol of the factor that forces above the bearings are reduced by."""
    shear_clause: ClassVar[str] = ""
    overturning_clause: ClassVar[str] = ""
    vertical_clause: ClassVar[str] = ""

    accidental_eccentricity: float = 0.05
    restoring: float = 0.025
    orthogonal: float = 0.3
    pressure_limit: float | None = None

    def analyse(
        self,
        system: IsolationSystem,
        spectrum: Spectrum,
        bound: Bound,
        superstructure: Superstructure | None,
        extremes: Extremes,
    ) -> BoundResult:
        """Return analysis and checks at one bound.

        Parameters
        ----------
        system : IsolationSystem
            The system with properties at that bound.
        spectrum : Spectrum
            Spectrum of the level of the code's analysis.
        bound : {"lower", "nominal", "upper"}
            The bound.
        superstructure : Superstructure, optional
            Structure above.
        extremes : Extremes
            The system with nominal and with upper properties.

        Returns
        -------
        BoundResult
            The analysis.

        Raises
        ------
        CheckError
            If the spectrum or the superstructure lacks an input of the code, or no displacement is
            found.
        """
        self.require(spectrum, superstructure)
        t, rounds = self.settled(system, spectrum)
        for pendulum in system.pendulums:
            pendulum.require_sliding(t.value(self.sliding or self.symbols.displacement))
        self.totals(t, system, spectrum)
        self.base_shear(t, spectrum, extremes)
        judge = CheckBuilder(
            t, bound, FROM_MEMORY, level=self.level, values=self.values, analysis=self
        )
        checks, forces = self.device_checks(t, system, judge), tuple[float, ...]()
        if superstructure is not None:
            self.shears(t, superstructure, spectrum, extremes)
            checks += self.structure_checks(t, superstructure, judge)
            loads = judge.at(self.loads_level or self.level)
            overturning(t, "M_o", "o")
            known = loads.resting_on("overturning")
            checks += overturning_check(t, known, self.overturning_clause)
            found = self.vertical_checks(t, system, loads)
            why = system.unknown_loads
            if not why and len(system.loads) == 1 and t.value("M_o") > 0.0:
                why = "one bearing has no lever against the overturning moment M_o"
            checks += not_evaluated(found, why)
            checks += self.further_checks(t, superstructure, judge)
            forces = (t.value("F_1"), *t.values("F_x"))
        return BoundResult(bound, t, self.symbols, rounds, t.values(self.each), forces, checks)

    def require(  # noqa: B027  # most codes need nothing
        self, spectrum: Spectrum, above: Superstructure | None
    ) -> None:
        """Raise a CheckError if something that the analysis needs is not given."""

    def settled(
        self, system: IsolationSystem, spectrum: Spectrum
    ) -> tuple[Trace, tuple[Iteration, ...]]:
        """Return the calculation whose assumed and found displacements agree, and its rounds."""

        def step(displacement: float) -> Trace:
            return self.step(system, spectrum, displacement)

        first, held = self.first_displacement(system, spectrum), held_by(system, spectrum)
        return iterate_displacement(step, first, self.symbols, held)

    def first_displacement(self, system: IsolationSystem, spectrum: Spectrum) -> float:
        """Return the displacement at which the search begins [m]."""
        return 0.1

    @abc.abstractmethod
    def step(self, system: IsolationSystem, spectrum: Spectrum, displacement: float) -> Trace:
        """Return the displacement that stiffness and damping at an assumed one give [m]."""

    @abc.abstractmethod
    def totals(self, t: Trace, system: IsolationSystem, spectrum: Spectrum) -> None:
        """Enter torsion, and the displacement of each bearing."""

    def base_shear(self, t: Trace, spectrum: Spectrum, extremes: Extremes) -> None:
        """Enter the shear of the isolation system."""
        k, d = self.symbols.stiffness, self.symbols.displacement
        t(self.symbols.base_shear, f"{k} * {d}", "N", source=self.shear_clause)

    @abc.abstractmethod
    def device_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks of the bearings and of the procedure."""

    def shears(
        self, t: Trace, above: Superstructure, spectrum: Spectrum, extremes: Extremes
    ) -> None:
        """Enter the forces F_1 and F_x, the moment M_o, and o, the other direction's share."""
        msg = f"{self.name} has no forces above the bearings: leave the superstructure out"
        raise CheckError(msg)

    def structure_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return the checks of the structure above."""
        return Checks()

    def vertical_checks(self, t: Trace, system: IsolationSystem, judge: CheckBuilder) -> Checks:
        """Return the checks of axial loads by the combinations."""
        known = judge.resting_on("vertical loads")
        return vertical_checks(t, system, known, self.vertical_clause, self.pressure_limit)

    def further_checks(self, t: Trace, above: Superstructure, judge: CheckBuilder) -> Checks:
        """Return checks that come last."""
        return Checks()


def enter_activation(t: Trace, extremes: Extremes, activation: float) -> None:
    """Enter Q_nom and Q_up, the forces that start sliding, and a_Q, the factor on the former."""
    t.given("Q_nom", extremes.nominal.strength, "N", note="starts sliding, nominal properties")
    t.given("Q_up", extremes.upper.strength, "N", note="starts sliding, upper properties")
    t.given("a_Q", activation)


def eccentricities(
    t: Trace, system: IsolationSystem, accidental: str, source: str, *, by_direction: bool
) -> None:
    """Enter plan, distances from the centres, and eccentricities e_x and e_y."""
    t.given("b", system.plan[0], "m", note="side of the plan along x")
    t.given("d", system.plan[1], "m", note="side of the plan along y")
    for k, axis in enumerate("xy"):
        t.given_each(axis, [place[k] for place in system.positions], "m")
        t(f"{axis}_R", f"sum(F * {axis}) / sum(F)", "m", note="centre of stiffness")
        if system.eccentricity is not None:
            t.given(f"e_{axis}0", system.eccentricity[k], "m", note="as given")
            t(f"{axis}_M", f"{axis}_R + e_{axis}0", "m", note="centre of mass")
        elif system.centre_of_mass is not None:
            t.given(f"{axis}_M", system.centre_of_mass[k], "m", note=_of_masses(system, k))
        else:
            t(f"{axis}_M", f"sum(P * {axis}) / sum(P)", "m", note="centre of mass, by the loads")
    sides = {"x": "b", "y": "d"} if by_direction else dict.fromkeys("xy", "max(b, d)")
    for axis, side in sides.items():
        t(f"e_{axis}", f"abs({axis}_M - {axis}_R) + {accidental} * {side}", "m", source=source)


def _of_masses(system: IsolationSystem, k: int) -> str:
    # Source of the centre of mass, and reason that the centre of the loads differs.
    pairs = zip(system.loads, system.positions, strict=True)
    centre = sum(load * place[k] for load, place in pairs) / sum(system.loads)
    given = 0.0 if system.centre_of_mass is None else system.centre_of_mass[k]
    if abs(centre - given) <= _SAME_CENTRE * system.plan[k]:
        return "centre of mass, of the model's masses"
    why = "the model restrains the tilt" if system.unknown_loads else "loads that are not masses"
    of_loads = worded(
        "that of the bearings' loads: {place:.3f} m, {why}", place=round(centre, 3) + 0.0, why=why
    )
    return joined("centre of mass, of the model's masses", of_loads)


def enter_storeys(t: Trace, above: Superstructure) -> None:
    """Enter w_x and h_x, weights and elevations of the floors."""
    t.given_each("w_x", above.storey_weights, "N", note="floors, lowest first")
    t.given_each("h_x", above.elevations, "m", note="above the base level")


def enter_restoring(t: Trace, displacement: str, share: float) -> None:
    """Enter Delta_F, the force that the second half of a displacement adds, and its limit."""
    d = displacement
    t.given("a_R", share)
    t("Delta_F", f"sum(P * ({d} / L + mu)) - sum(P * ({d} / (2 * L) + mu))", "N")
    t("Delta_F_lim", "a_R * W", "N")


def overturning(t: Trace, moment: str, share: str) -> None:
    """Enter N_E, axial loads of the bearings from an overturning moment in any direction.

    The base is rigid: loads are proportional to the distance from the bearings' centre; a `share`
    of the other direction's loads adds. A direction in which all bearings are in one line has no
    lever and is left out.
    """
    t.given("n_b", float(len(t.values("x"))), note="bearings")
    loads: list[str] = []
    for axis in "xy":
        t.each(f"l_{axis}", f"{axis} - sum({axis}) / n_b", "m", note="levers")
        if t(f"I_{axis}", f"sum(l_{axis}**2)", "m2") > 0.0:
            loads.append(f"N_E{axis}")
            t.each(loads[-1], f"{moment} * abs(l_{axis}) / I_{axis}", "N")
    if len(loads) == 2:
        one, two = loads
        formula = f"max({one} + {share} * {two}, {share} * {one} + {two})"
    else:
        formula = loads[0] if loads else f"0 * {moment} * x"
    t.each("N_E", formula, "N", note="axial loads from overturning, rigid base")


def overturning_check(t: Trace, judge: CheckBuilder, clause: str) -> Checks:
    """Return the check that the structure as a whole does not overturn on its bearings."""
    if not all(t.value(f"I_{axis}") > 0.0 for axis in "xy"):
        return Checks()
    for axis in "xy":
        formula = f"min({axis}_M - min({axis}), max({axis}) - {axis}_M)"
        t(f"a_{axis}", formula, "m", note="centre of mass to the outer bearings")
    t("M_W", "W * min(a_x, a_y)", "N m", note="of the weight, safety 1.0")
    return Checks([judge(clause, "overturning of the whole structure", "M_o", "<=", "M_W")])


def vertical_checks(
    t: Trace,
    system: IsolationSystem,
    judge: CheckBuilder,
    clause: str,
    pressure_limit: float | None,
) -> Checks:
    """Return the checks of axial loads: no uplift, and pressure on the sliders."""
    found: list[Check] = []
    sliders = [b.slider_radius for b in system.bearings if isinstance(b, LIRBearing)]
    if pressure_limit is not None and system.combinations:
        if len(sliders) < len(system.bearings):
            msg = "pressure_limit needs the slider_radius of each bearing: give LIRBearing for all"
            raise CheckError(msg)
        t.given_each("r_s", sliders, "m", note="radius of the sliders")
        t.given("p_lim", pressure_limit, "Pa")
    for name, loads in system.combinations.items():
        word = name if name.isidentifier() else f"c{len(found)}"
        t.given_each(
            f"N_{word}",
            loads,
            "N",
            note=worded("combination {name}, without earthquake", name=name),
        )
        found.append(
            judge.of("procedure").worst(
                clause,
                worded("no uplift, {name}", name=name),
                "N_E",
                "<=",
                f"N_{word}",
                subjects=system.labels,
            )
        )
        if "p_lim" in t:
            t.each(f"p_{word}", f"(N_{word} + N_E) / (pi * r_s**2)", "Pa")
            found.append(
                judge.of("demand").worst(
                    clause,
                    worded("pressure on the slider, {name}", name=name),
                    f"p_{word}",
                    "<=",
                    "p_lim",
                    subjects=system.labels,
                )
            )
    return Checks(found)


def capacity_check(
    t: Trace,
    system: IsolationSystem,
    judge: CheckBuilder,
    clause: str,
    demand: str,
    words: str = "the total displacement",
) -> Check:
    """Return the check of the rims' displacement against the demand, for the worst bearing.

    Parameters
    ----------
    t : Trace
        Calculation with the demand of each bearing.
    system : IsolationSystem
        The system.
    judge : CheckBuilder
        Makes the check.
    clause, demand : str
        Clause, and symbol of the demand.
    words : str
        Name of the demand in the code, for the title.

    Returns
    -------
    Check
        The check; its note gives the place of rim contact.
    """
    t.given_each(
        "d_rim",
        [p.capacity for p in system.pendulums],
        "m",
        shown="mm",
        note="displacement at the first rim contact",
    )
    title = worded("no restrainer contact at {symbol}", symbol=words)
    limit = judge.of("procedure")
    check = limit.worst(clause, title, demand, "<=", "d_rim", subjects=system.labels)
    if check.passed:
        return check
    note = worded(
        "rim contact occurs at {share:.0f} % of the displacement, so that equivalent-linear "
        "analysis is not valid: run a time history with rims",
        share=100.0 / check.ratio,
    )
    return replace(check, note=note)


def drift_checks(
    t: Trace, above: Superstructure, judge: CheckBuilder, clause: str, *, limit: float, factor: str
) -> Checks:
    """Return the check of storey drifts under the floors' forces F_x, for the worst storey."""
    if above.storey_stiffness is None:
        return Checks()
    t.given_each("k_x", above.storey_stiffness, "N/m")
    t.given_each("h_s", above.storey_heights, "m")
    t.given("a_d", limit)
    note = "above: sum over the storey and those above it"
    t.each("Delta", f"{factor} * above(F_x) / k_x", "m", shown="mm", note=note)
    t.each("Delta_a", "a_d * h_s", "m", shown="mm")
    names = tuple(worded("storey {number}", number=k + 1) for k in range(len(above.storey_weights)))
    found = judge.of("demand")
    return Checks([found.worst(clause, "storey drift", "Delta", "<=", "Delta_a", subjects=names)])
