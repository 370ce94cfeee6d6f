"""A proposed bearing under one mass and the motions of a project: sized until it passes."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr

from frames.batch.runs import BOUND, HAZARD, Runs, tagged
from frames.batch.time_histories import time_histories
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.registry import code_named
from frames.design.hazard.motion_measures import pair_spectrum
from frames.design.histories.suite import peaks_of_runs, suite_of
from frames.design.sizing.fitting import Asked
from frames.library.models import lumped_mass
from lir_element import DesignWarning
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames.batch.cases import BatchProgress
    from frames.design.codes.bounds import BoundName, PropertyBounds
    from frames.design.codes.history_rules import HistoryRules
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.hazard.motion_set import MotionSet
    from frames.design.hazard.spectrum import Spectrum
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.proposal import Design
    from frames.frame import Frame
    from lir_element import LIRBearing

MARGIN = 1.1
"""Factor on the motions under which no run may fail [-]: a choice, because the model has one mass.
"""

FACTORS = (1.0, MARGIN)
"""Factors on the motions at which bearings with rims are run [-]."""

GROWTH = 1.1
"""Factor on the required displacement if a run still fails [-]."""

ROUNDS = 8
"""Largest number of times that a bearing is made larger."""


class Place(NamedTuple):
    """Place of a suite of runs: level of the seismic action, factor on it, bound."""

    level: str
    factor: float
    bound: BoundName


class OneMass(NamedTuple):
    """Trial of a candidate: a rigid building, its motions and its bounds."""

    # motions scaled for an equivalent-linear analysis, whose periods make the range
    motions: Callable[[EquivalentLinear], MotionSet]
    spectrum: Spectrum  # the target of their scaling
    rules: HistoryRules  # levels of the seismic action, and how runs count
    bounds: PropertyBounds  # lower and upper bound friction properties
    at: Sequence[BoundName]  # bounds that are run
    progress: Callable[[BatchProgress], None] | bool | None = None  # as for `frames.time_histories`


class Excess(NamedTuple):
    """Mean spectrum of the motions over the target, at the effective period."""

    period: float  # effective period at the bound with the largest displacement [s]
    ratio: float  # mean over target, and its least value by the rule of scaling [-]
    asked: float

    def __str__(self) -> str:
        """Return it in words."""
        return (
            f"the mean spectrum of the motions is {self.ratio:.2f} times the target at "
            f"{self.period:.2f} s, and the rule requires {self.asked:.2f}"
        )


class Trial(NamedTuple):
    """A candidate that was tried on one mass."""

    tried: Candidate  # by the formula, and as it was made larger
    sized: Candidate
    runs: Runs  # of the sized one, with its rims; tags as in `Place`
    free: float  # displacement without rims for design, torsion and the code's factor included [m]
    failed: dict[Place, int]  # number of runs that failed
    excess: Excess  # of the motions
    # reason that it was made no larger, though a run fails or goes farther; empty if none does
    larger_lacks: tuple[str, ...]
    asked: Asked  # demands of the sized one

    def failures(self, factor: float) -> int:
        """Return how many runs fail under the motions times a factor of `FACTORS`."""
        return sum(count for place, count in self.failed.items() if place.factor == factor)

    @property
    def passed(self) -> bool:
        """True if it is as large as the motions need, and no run fails, with the margin."""
        return not self.larger_lacks and not any(self.failed.values())

    @property
    def outcome(self) -> str:
        """Result of the trial, in words."""
        if self.failures(1.0):
            return "fails"
        return "passes" if self.passed else "passes without the margin"

    def rows(self) -> list[dict[str, object]]:
        """Return a row for each level and bound, numbers in SI units."""
        slip = min(each.resolved()["slip_capacity"] for each in self.sized.bearings)
        return [
            {
                "radius [m]": self.sized.radius,
                "friction [-]": self.sized.friction.f_max,
                "outcome": self.outcome,
                "level": place.level,
                "factor on the motions [-]": place.factor,
                "bound": place.bound,
                "runs": data.sizes["run"],
                "failed runs": self.failed[place],
                "largest displacement [m]": float(peaks_of_runs(data, "displacement").max()),
                "capacity [m]": self.sized.trace.value("U_cap"),
                "largest slip [m]": float(peaks_of_runs(data, "slip").max()),
                "slip capacity [m]": slip,
                "displacement, formula [m]": self.tried.displacement,
                "displacement, one mass [m]": self.free,
                "period [s]": self.excess.period,
                "mean spectrum over target [-]": self.excess.ratio,
                "least by the rule [-]": self.excess.asked,
            }
            for place, data in _by_place(self.runs)
        ]

    def __str__(self) -> str:
        """Return the outcome in words."""
        said = (
            f"displacement without rims {1e3 * self.free:.0f} mm with torsion, by the formula "
            f"{1e3 * self.tried.displacement:.0f} mm; {self.excess}\n"
        )
        if self.sized is not self.tried:
            ways = {"capacity": "U_cap", "slip": "s", "slider radius": "a"}
            each = [
                f"{name} {self.tried.trace.value(symbol) * 1e3:.0f} to "
                f"{self.sized.trace.value(symbol) * 1e3:.0f} mm"
                for name, symbol in ways.items()
            ]
            said += f"made larger: {', '.join(each)}\n"
        for factor in FACTORS:
            runs, failed = len(self.runs.where(factor=factor)), self.failures(factor)
            said += f"{failed} of {runs} runs fail at {factor:g} times the motions; "
        said = said.removesuffix("; ")
        if self.larger_lacks:
            said += f"\na larger one is rejected: {'; '.join(self.larger_lacks)}"
        return said


def tried_on_one_mass(found: Design, candidate: Candidate, how: OneMass) -> Trial:
    """Try a candidate on one mass, and make it larger until no run fails.

    The mass is the mean load of the bearings, its bearing the one with the smallest slider, at the
    level "pendulum". Runs without rims give the displacement to size for. Runs with rims give the
    slip, and none of them may fail, also under the motions times `MARGIN`.
    """
    mass = found.system.seismic_weight / len(found.system.loads) / found.system.gravity
    motions = how.motions(candidate.analysis)
    excess = excess_of(candidate.analysis, motions, how.spectrum)
    free = _runs(candidate.bearings[0].as_dcfp(rims=False), mass, motions, how, (1.0,))
    factor = _torsion(candidate) * how.rules.displacement_factor
    needed = factor * _for_design(free, "displacement", how.rules)
    asked, sized, runs, kept = Asked(needed), candidate, Runs(), Asked()
    for _ in range(ROUNDS):
        larger = candidate
        if asked.displacement > candidate.displacement or asked.slip > 0.0:
            larger = found.fit(candidate.radius, candidate.friction, asked)
        if not larger.lacks:
            sized, kept = larger, asked
            motions = how.motions(sized.analysis)
        if not larger.lacks or not len(runs):
            runs = _runs(sized.bearings[0], mass, motions, how, FACTORS)
        slip = _for_design(runs, "slip", how.rules)
        fails = any(_failed(runs, how.rules).values())
        if larger.lacks or (not fails and slip <= sized.trace.value("s")):
            break
        asked = Asked(sized.displacement * (GROWTH if fails else 1.0), max(slip, asked.slip))
    failed = _failed(runs, how.rules)
    return Trial(candidate, sized, runs, needed, failed, excess, larger.lacks, kept)


def _runs(
    bearing: LIRBearing, mass: float, motions: MotionSet, how: OneMass, factors: tuple[float, ...]
) -> Runs:
    # Runs at each level, factor and bound; the caller counts failures.
    frame = lumped_mass(bearing, mass)
    rows = [
        (level, factor, bound, motion)
        for level in how.rules.levels
        for factor in factors
        for bound in how.at
        for motion in motions
    ]
    cases = [(bound, motion, factor * level.factor) for level, factor, bound, motion in rows]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", AnalysisWarning)
        warnings.simplefilter("ignore", DesignWarning)  # the stable slip is among the checks
        models: dict[str, Frame] = {
            bound: with_property_bounds(frame, bound, how.bounds) for bound in how.at
        }
        data = time_histories(models, motions, cases=cases, progress=how.progress)
    levels, tried, bounds, _ = zip(*rows, strict=True)
    tags = {HAZARD: [level.name for level in levels], "factor": tried, BOUND: bounds}
    return Runs(tagged(data, **tags))


def _by_place(runs: Runs) -> list[tuple[Place, xr.Dataset]]:
    return [(Place(*key), own.data) for key, own in runs.by(HAZARD, "factor", BOUND).items()]


def _failed(runs: Runs, rules: HistoryRules) -> dict[Place, int]:
    return {place: sum(suite_of(data, rules).failed) for place, data in _by_place(runs)}


def _for_design(runs: Runs, name: str, rules: HistoryRules) -> float:
    # The largest design value of the motions over all levels and bounds, times 1.
    return max(
        suite_of(data, rules).value(peaks_of_runs(data, name).max(axis=1))
        for place, data in _by_place(runs)
        if place.factor < MARGIN
    )


def _torsion(candidate: Candidate) -> float:
    # Total over central displacement in the formula.
    each = candidate.analysis.bounds.values()
    return max(one.total_displacement / one.displacement for one in each)


def excess_of(analysis: EquivalentLinear, motions: MotionSet, spectrum: Spectrum) -> Excess:
    """Return how far the mean spectrum of motions is above the target at the effective period."""
    each = analysis.bounds.values()
    period = max(each, key=lambda one: one.allowed_displacement).period
    rule = code_named(analysis.code).scaling[0]
    of_pairs = [pair_spectrum(one, [period], 0.05, rule.measure)[0] for one in motions.values()]
    target = float(spectrum.acceleration(period, 0.05))
    return Excess(period, float(np.mean(of_pairs)) / target, rule.part)
