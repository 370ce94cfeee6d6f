"""Equivalent-linear analysis: the common steps of the codes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check, Scope
from frames.design.calculation.standing import FROM_MEMORY, Standing
from frames.design.calculation.trace import Trace
from frames.design.codes.code_values import CodeValue, standing_by
from frames.design.codes.outcome import Iteration, Symbols
from lir_element.texts import worded

if TYPE_CHECKING:
    from typing import Literal

    from frames.design.codes.isolation import IsolationSystem
    from frames.design.hazard.spectrum import Spectrum

_MOST_ROUNDS = 500
_SETTLED = 1e-12
_NOTHING = 1e-5  # m
_ALIKE = 1e-9  # ratios of checks that differ by round-off alone


def enter_system(system: IsolationSystem) -> Trace:
    """Return a calculation with a system's bearings, loads and weight."""
    t = Trace()
    t.given("g", system.gravity, "m/s2")
    t.given("W", system.seismic_weight, "N", note="seismic weight above the isolation interface")
    t.given_each(
        "P", system.loads, "N", note=worded("loads of the {n} bearings", n=len(system.loads))
    )
    pendulums = system.pendulums
    t.given_each("L", [p.effective_radius for p in pendulums], "m", note="effective radii")
    t.given_each("mu", [p.effective_friction for p in pendulums], note="effective friction")
    loss = [p.corner_loss for p in pendulums]
    if any(loss):
        t.given_each("c", loss, "m", note="corners of the loop, over the load")
    return t


def secant(t: Trace, displacement: str, symbols: Symbols, source: str, level: str = "") -> None:
    """Enter effective stiffness, damping and period of a system at a displacement.

    Parameters
    ----------
    t : Trace
        Calculation of `enter_system`, with the displacement.
    displacement : str
        Symbol of the displacement.
    symbols : Symbols
        Symbols of the code.
    source : str
        Clause.
    level : str
        Suffix of the symbols F and E of force and energy, if there are several levels.
    """
    k, beta, d = symbols.stiffness, symbols.damping, displacement
    t.each(f"F{level}", f"P * ({d} / L + mu)", "N", note="force of each bearing")
    t(k, f"sum(F{level}) / {d}", "N/m", source=source)
    loss = " - c" if "c" in t else ""
    t.each(f"E{level}", f"P * (4 * mu * {d}{loss})", "J", note="energy of each bearing's cycle")
    t(beta, f"sum(E{level}) / (2 * pi * {k} * {d}**2)", source=source, shown="%")
    t(symbols.period, f"2 * pi * sqrt(W / ({k} * g))", "s", source=source)


def held_by(system: IsolationSystem, spectrum: Spectrum) -> str:
    """Return peak acceleration and friction in words, for the message of `iterate_displacement`."""
    peak = float(spectrum.acceleration(spectrum.reach[0])) / system.gravity
    friction = system.strength / system.seismic_weight
    return f" (peak acceleration {peak:.3g} g, friction {friction:.3g} of the weight)"


def iterate_displacement(
    step: Callable[[float], Trace], start: float, symbols: Symbols, held: str = ""
) -> tuple[Trace, tuple[Iteration, ...]]:
    """Find the displacement at which stiffness and damping give that displacement, in rounds.

    `step` is the calculation from an assumed displacement [m], `start` the first one; `held` gives
    peak acceleration and friction in words, for the message if nothing slides.
    """
    rounds: list[Iteration] = []
    assumed = start
    for _ in range(_MOST_ROUNDS):
        t = step(assumed)
        k, beta, period = (
            t.value(name) for name in (symbols.stiffness, symbols.damping, symbols.period)
        )
        found = t.value(symbols.displacement)
        rounds.append(Iteration(assumed, k, beta, period, found))
        if abs(found - assumed) <= _SETTLED * found:
            return t, tuple(rounds)
        if found < _NOTHING:
            msg = (
                "the bearings do not slide under this spectrum: its short-period demand is "
                f"below the friction (displacement under {_NOTHING:g} m){held}: check the "
                "unit (0.25 g = 2.45 m/s2), or reduce the friction"
            )
            raise CheckError(msg)
        assumed = found
    msg = (
        f"the displacement does not converge: {assumed:.4g} m after {_MOST_ROUNDS} iterations. The "
        "equivalent-linear analysis is not suitable here: check the friction and the spectrum"
    )
    raise CheckError(msg)


def _alike(one: Check, other: Check) -> bool:
    pairs = ((one.ratio, other.ratio), (one.demand, other.demand), (one.limit, other.limit))
    return all(math.isclose(a, b, rel_tol=_ALIKE) for a, b in pairs)


@dataclass(frozen=True)
class CheckBuilder:
    """Builder of checks from the values of a calculation."""

    t: Trace  # the calculation
    bound: Bound  # properties of the bearings that it is for
    standing: Standing = FROM_MEMORY  # of its checks
    scope: Scope = "any"  # of its checks
    void: str = ""  # why its demands are no values for design
    level: str = ""  # level of the seismic action of its checks
    # of the code, which `resting_on` and `limit` name
    values: Mapping[str, CodeValue] = field(default_factory=dict)
    analysis: object = None  # analysis of the code, with its factors

    def of(self, scope: Scope) -> CheckBuilder:
        """Return one that makes checks of this scope."""
        return replace(self, scope=scope)

    def resting_on(self, *names: str) -> CheckBuilder:
        """Return a builder whose checks have the weakest source of these values of the code."""
        return replace(self, standing=standing_by(self.values, *names, analysis=self.analysis))

    def limit(self, *names: str) -> CheckBuilder:
        """Return one for limits of the procedure that rest on these values of the code."""
        return self.resting_on(*names).of("procedure")

    def at(self, level: str) -> CheckBuilder:
        """Return one that makes checks at this level of the seismic action."""
        return replace(self, level=level)

    def __call__(
        self,
        clause: str,
        title: str,
        symbol: str,
        relation: Literal["<=", ">="],
        limit: str,
        *,
        note: str = "",
    ) -> Check:
        """Return the check of one symbol against another."""
        return self._made(clause, title, (symbol, limit), relation, note=note)

    def worst(
        self,
        clause: str,
        title: str,
        symbol: str,
        relation: Literal["<=", ">="],
        limit: str,
        *,
        subjects: tuple[str, ...],
        note: str = "",
    ) -> Check:
        """Return the check of largest ratio of those for each of several, named by `subjects`."""
        pair = (symbol, limit)
        found = [
            self._made(clause, title, pair, relation, note=note, k=k, subject=subject)
            for k, subject in enumerate(subjects)
        ]
        worst = max(found, key=lambda c: (c.ratio, abs(c.limit) - abs(c.demand)))
        # of those that differ by round-off alone the first: the processor decides no names
        return next(c for c in found if c is worst or _alike(c, worst))

    def _made(
        self,
        clause: str,
        title: str,
        pair: tuple[str, str],
        relation: Literal["<=", ">="],
        *,
        note: str,
        k: int = 0,
        subject: str = "",
    ) -> Check:
        steps = [self.t[name] for name in pair]
        demand, limit = (s.value[k] if isinstance(s.value, tuple) else s.value for s in steps)
        return Check(
            clause=clause,
            title=title,
            symbol=pair[0],
            demand=demand,
            limit=limit,
            unit=steps[0].unit,
            shown=steps[0].result.shown,
            relation=relation,
            trace=self.t.of(*pair),
            standing=self.standing,
            bound=self.bound,
            subject=subject,
            note=note,
            scope=self.scope,
            void=self.void,
            level=self.level,
        )


def procedure_limit(
    judge: CheckBuilder,
    name: str,
    title: str,
    symbol: str,
    relation: Literal["<=", ">="],
    limit: str,
    unit: str = "-",
    *,
    shown: str = "",
    of: tuple[str, str] = ("", ""),
    also: tuple[str, ...] = (),
) -> Check:
    """Enter a value of the code as a limit of the procedure, and return the check against it.

    `of` has the symbols of a value that is a share, and of its whole; the check rests on the
    values `also` as well.
    """
    value, (share, whole) = judge.values[name], of
    found = getattr(judge.analysis, value.field)
    judge.t.given(share or limit, found, "-" if whole else unit, shown=shown)
    if whole:
        judge.t(limit, f"{share} * {whole}", unit)
    return judge.limit(name, *also)(value.clause, title, symbol, relation, limit)
