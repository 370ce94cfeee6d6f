"""Checks of time histories at one bound of the bearings' properties."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from frames.design._errors import CheckError
from frames.design.calculation.check import Check
from frames.design.calculation.not_evaluated import OF_AXIAL_FORCES, not_evaluated
from frames.design.calculation.standing import FROM_MEMORY, PROJECT, Standing
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import HISTORY_RULES, standing_in
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.capacity import engagement_checks
from frames.design.histories.bearing_demands import BearingDemands, devices_of
from frames.design.histories.eccentricity import Case, named_by_way
from frames.design.histories.force_demands import LEAST, raise_of, shear_checks
from frames.design.histories.storey_checks import (
    second_order_of,
    stability_checks,
    torsion_checks,
)
from frames.design.histories.suite import parted, peaks_of_runs, stopped_runs
from frames.design.histories.suite_notes import (
    audit_notes,
    contact_notes,
    left_out_checks,
    note_of_impacts,
)
from frames.design.histories.uplift import Uplift, suite_of_uplift
from frames.results.quantities import JUDGED
from frames.statics.overturning import unknown_axial_forces
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.design.codes.history_rules import ActionLevel
    from frames.design.codes.outcome import EquivalentLinear
    from frames.design.devices.limits import DesignLimits
    from frames.frame import Frame

_DRIFTS = {
    "drift": "mean of the storey, size in plan",
    "line_drift": "line of nodes over one another, size in plan",
}


@dataclass(frozen=True)
class BoundChecks:
    """Makes the checks of the runs at one bound."""

    case: Case  # the runs, and those with moved masses; of uplift the worst of all counts
    frame: Frame  # the structure at that bound
    limits: DesignLimits  # limits of bearings and structure
    equivalent: EquivalentLinear | None  # analysis that has least values
    level: ActionLevel  # level of the seismic action, and its checked parts

    def checks(self) -> list[Check]:
        """Return all of them."""
        found = [self._motions(), self._failed(), *self._moved_failed()]
        data, bound = self.case.data, self.case.bound
        found += left_out_checks(data, bound, stopped_runs(data))
        if self.level.judges_bearings:
            found += self._of_bearings()
        if self.level.judges_structure:
            found += [*self._base_shear(), *self._least_shears]
            found += [*self._drift(), *self._storeys()]
            found += self._bearings.against("floor_plan") if self.frame.levels else []
        return [replace(check, level=self.level.name) for check in found]

    def _of_bearings(self) -> list[Check]:
        rules, bearings = self.case.rules, self._bearings
        clause = self._clause(rules.displacement_clause)
        moved = bearings.displacement(clause, FROM_MEMORY, self._least("D_TM_dyn"))
        found = [
            *moved,
            *self._engagement(moved),
            *bearings.slips(),
            *bearings.forces(),
            *self._uplift(),
        ]
        return [*not_evaluated(found, unknown_axial_forces(self.frame), OF_AXIAL_FORCES)]

    @cached_property
    def _audit(self) -> str:
        return audit_notes(self.case.data)

    @cached_property
    def _small_gaps(self) -> str:
        allowed = self.case.rules.uplift_allowed
        return "" if allowed else contact_notes(self.case.data, self.case.rules.least_gap)

    @property
    def _note(self) -> str:
        # With each check: which runs failed if they may, or that there is more to read.
        marked = int((self.case.data["doubts"].to_numpy() != "").sum())
        more = (
            worded("assumption checks of {n} runs have findings: see the check of runs", n=marked)
            if marked
            else ""
        )
        failed = sum(self.case.suite.failed)
        allowed = (
            ""
            if self.case.suite.void or not failed
            else worded("{n} runs failed, as many as may fail", n=failed)
        )
        return joined(allowed, more)

    @cached_property
    def _bearings(self) -> BearingDemands:
        devices = devices_of(self.case.data, self.frame)
        case, factor = self.case, self.case.rules.displacement_factor
        return BearingDemands(
            case.data, case.suite, devices, self.limits, case.bound, self._note, factor
        )

    def _motions(self) -> Check:
        t = Trace()
        t.given("n", float(self.case.data.sizes["run"]), note="motions")
        t.given("n_least", float(self.case.rules.least))
        clause = self._clause(self.case.rules.statistic_clause)
        judge = CheckBuilder(t, self.case.bound, self._known("number of motions", "least"))
        counts = worded("{statistic} of the motions counts", statistic=self.case.suite.statistic)
        note = joined(counts, self._eccentricity)
        return judge(clause, "number of motions", "n", ">=", "n_least", note=note)

    @property
    def _eccentricity(self) -> str:
        # Treatment of accidental eccentricity.
        if self.case.moved is not None:
            share = 100.0 * self.case.rules.accidental_eccentricity
            return worded(
                "masses moved by {share:g} % of the plan in each direction raise the demands",
                share=share,
            )
        code = HISTORY_RULES.get(self.case.rules.code)
        asked = self.case.rules if code is None else code
        if not asked.accidental_eccentricity:
            return "without accidental eccentricity"
        share = 100.0 * asked.accidental_eccentricity
        clause = self._clause(asked.eccentricity_clause)
        return worded(
            "without accidental eccentricity; {clause} requires {share:g} %",
            clause=clause,
            share=share,
        )

    def _failed(self) -> Check:
        t = Trace()
        t.given("n_failed", float(sum(self.case.suite.failed)), note="runs that failed")
        allowed = self.case.rules.unacceptable_allowed if self.case.suite.statistic == "mean" else 0
        t.given("n_allowed", float(allowed))
        clause = self._clause(self.case.rules.statistic_clause)
        judge = CheckBuilder(t, self.case.bound, FROM_MEMORY)
        note = joined(self.case.suite.reason, self._small_gaps, self._audit)
        return judge(clause, "runs that failed", "n_failed", "<=", "n_allowed", note=note)

    def _moved_failed(self) -> list[Check]:
        # Runs with the masses moved: none may fail, because each represents all motions.
        if self.case.moved is None:
            return []
        t = Trace()
        beside = self.case.failures[self.case.data.sizes["run"] :]
        count = float(sum(one is not None for one in beside))
        t.given("n_failed", count, note=worded("of {n} runs", n=self.case.moved.sizes["run"]))
        t.given("n_allowed", 0.0)
        audit = audit_notes(named_by_way(self.case.moved))
        note = joined(self.case.suite.moved_failed, audit)
        clause = self._clause(self.case.rules.eccentricity_clause)
        judge = CheckBuilder(
            t, self.case.bound, self._known("moved masses", "accidental_eccentricity")
        )
        title = "runs with moved masses that failed"
        return [judge(clause, title, "n_failed", "<=", "n_allowed", note=note)]

    def _engagement(self, moved: list[Check]) -> list[Check]:
        # At the needed displacement capacity of the runs, by the code's rule for rims.
        code, least = self.case.rules.code, self.case.rules.engagement
        if code not in HISTORY_RULES or not moved or moved[0].void:
            return []  # the check of the displacement has the reason
        bearing = self.frame.bearings[moved[0].subject].bearing
        found = engagement_checks(
            bearing,
            {self.case.bound: moved[0].demand},
            least=least,
            code=code,
            agreed=self.limits.rim_engagement,
        )
        named = (replace(c, subject=joined(moved[0].subject, c.subject, by=", ")) for c in found)
        return [replace(c, title=worded("{check} of histories", check=c.title)) for c in named]

    def _uplift(self) -> list[Check]:
        found = []
        if not self.case.rules.uplift_allowed:
            t, gap = Trace(), f"{1e3 * self.case.rules.least_gap:g} mm"
            every = self.case.every
            lasts = np.nan_to_num(peaks_of_runs(every, "time_lifted"), nan=math.inf)
            open_ = parted(every, self.case.rules.least_gap) | np.isinf(lasts)
            longest = float(np.where(open_, lasts, 0.0).max())
            t.given(
                "t_up",
                longest,
                "s",
                note=worded("longest of a bearing in a run, gap above {gap}", gap=gap),
            )
            t.given("t_allowed", 0.0, "s")
            stopped = stopped_runs(every)  # also if the code accepts the others
            void = stopped and (self.case.suite.void or stopped)
            judge = CheckBuilder(
                t, self.case.bound, self._known("uplift", "uplift_allowed"), void=void
            )
            clause = self._clause(self.case.rules.force_clause)
            title = worded("uplift duration above {gap}", gap=gap)
            note = self._small_gaps
            found.append(judge(clause, title, "t_up", "<=", "t_allowed", note=note))
        rules = self.case.rules
        clause = self._clause(rules.uplift_clause) if rules.uplift_clause else ""
        devices, every = self._bearings.bearings, self.case.every
        more = "" if clause else self._uplift_by_the_project
        reason = joined(self.case.suite.reason, self.case.suite.moved_failed)
        suite = suite_of_uplift(every, reason)
        made = Uplift(every, suite, devices, self.limits, self.case.bound, more, clause=clause)
        return [*found, *made.rims(), *made.gaps(), *made.landings()]

    @property
    def _uplift_by_the_project(self) -> str:
        code = HISTORY_RULES.get(self.case.rules.code)
        if code is None or code.uplift_allowed or not self.case.rules.uplift_allowed:
            return ""
        return worded(
            "runs with uplift count by the project, not by {code}: to be agreed", code=code.cited
        )

    def _base_shear(self) -> list[Check]:
        least = self._least("V_b_dyn")

        def enter(t: Trace, values: FloatArray) -> str:
            self.case.suite.enter(t, "V", values, "N", of="base_shear")
            if not least > 0.0:
                return "V"
            t.given("V_least", least, "N", note=LEAST)
            self.case.suite.form(t, "V_d", "max(V, V_least)", "N", of="V")
            return "V_d"

        impacts = note_of_impacts(self.case.data, self._bearings.bearings)
        return self._bearings.against("base_shear", enter, note=impacts)

    @cached_property
    def _least_shears(self) -> list[Check]:
        # Less than the least is not a failure of the run: forces are raised to it.
        if self.equivalent is None or not self._least("V_s_dyn"):
            return []
        storey = self.frame.levels[1].name if len(self.frame.levels) > 1 else ""
        known = self.equivalent.bounds[self.case.bound]
        return shear_checks(self.case, known, storey, self._note)

    def _drift(self) -> list[Check]:
        # The check of the code, and that of the project beside it.
        if len(self.frame.levels) < 2:
            return []
        code, found = self.case.rules.drift, list[Check]()
        for limit in (None,) if code is None else (code, None):
            for check in self._drift_within(limit):
                more = [self._beside()] if limit is None else [self._gravity(check), self._elements]
                note = joined(check.note, *more)
                found.append(replace(check, note=note))
        return found

    def _gravity(self, check: Check) -> str:
        # Need of P-Delta in the analysis by the drift, and whether it is there.
        known = None if self.equivalent is None else self.equivalent.bounds.get(self.case.bound)
        if self.case.rules.second_order is None or known is None or "R_I" not in known.trace:
            return ""
        least = self.case.rules.second_order / known.trace.value("R_I")
        if not check.demand > least:
            return ""
        clause = self._clause(self.case.rules.drift_clause)
        return worded(
            "above {least:.3g} % P-Delta must be in the analysis ({clause}): {there}",
            least=100.0 * least,
            clause=clause,
            there=second_order_of(self.frame),
        )

    @property
    def _elements(self) -> str:
        # Class of non-structural elements of the code's limit, if it has several.
        limits = dict(self.case.rules.drift_classes)
        kinds = [kind for kind, limit in limits.items() if limit == self.case.rules.drift]
        if not kinds:
            return ""
        others = (
            worded("{kind} {limit:g} %", kind=kind, limit=100.0 * limit)
            for kind, limit in limits.items()
            if kind not in kinds
        )
        return worded(
            "limit of {kind} non-structural elements, of others: {others}",
            kind=kinds[0],
            others=joined(*others, by=", "),
        )

    def _beside(self) -> str:
        # Comparison of the project's limit of drifts with that of the code.
        own, code = self.limits.drift, self.case.rules.drift
        if own is None or code is None:
            return ""
        code /= self.case.rules.drift_factor
        word = "laxer" if own > code else "not laxer"
        clause = self._clause(self.case.rules.drift_clause)
        return worded(
            "{word} than {limit:g} % of {clause}, which is checked separately",
            word=word,
            limit=100.0 * code,
            clause=clause,
        )

    def _drift_within(self, limit: float | None) -> list[Check]:
        # Within the limit of the code, or that of the project.
        least, suite = self._least_shears, self.case.suite
        nu = 1.0 if limit is None else self.case.rules.drift_factor

        def enter(t: Trace, values: FloatArray, of: str) -> str:
            suite.enter(t, "theta", values, "-", "%", of=of)
            if least:
                more = "least shear over that of the runs, from its check; at least 1"
                t.given("f_V", raise_of(least).above, note=more)
                suite.form(t, "theta_d", "f_V * theta", "-", "%", of="theta")
            if nu < 1.0:
                t.given("nu", nu, note="of the earthquake of damage limitation")
                suite.form(t, "theta_nu", "nu * theta", "-", "%", of="theta")
            return "theta_d" if least else "theta_nu" if nu < 1.0 else "theta"

        found: list[Check] = []
        for name, of in _DRIFTS.items():
            if self.case.keeps(name):
                found += self._bearings.against(
                    name,
                    partial(enter, of=name),
                    limit=limit,
                    clause=self._clause(self.case.rules.drift_clause),
                    standing=PROJECT if limit is None else self._known("history drift", "drift"),
                    title=JUDGED["drift"].demand,
                    note=of,
                )
        return [max(found, key=lambda check: check.compared)] if found else []

    def _storeys(self) -> list[Check]:
        if len(self.frame.levels) < 2:
            return []
        rules, makes = self.case.rules, self._bearings
        clause, known = self._clause(rules.torsion_clause), self._known("drift of lines", "torsion")
        found = torsion_checks(self.case, makes, self.frame, clause, known)
        clause, known = self._clause(rules.stability_clause), self._known("stability", "stability")
        return [*found, *stability_checks(self.case, makes, self.frame, clause, known)]

    def _least(self, symbol: str) -> float:
        # A minimum of the equivalent-linear analysis at this bound, 0 if there is none.
        if self.equivalent is None or self.case.bound not in self.equivalent.bounds:
            return 0.0
        trace = self.equivalent.bounds[self.case.bound].trace
        if not self.case.rules.has_minima or symbol not in trace:
            msg = (
                f"equivalent has no minima for time histories ({symbol}): use a code that has "
                "them, for example ASCE 7-22, with a superstructure, or leave equivalent out"
            )
            raise CheckError(msg)
        return trace.value(symbol)

    def _known(self, value: str, field: str) -> Standing:
        # Source of a value of the code; none if the project changed it.
        own = HISTORY_RULES.get(self.case.rules.code)
        same = own is not None and getattr(self.case.rules, field) == getattr(own, field)
        return standing_in(self.case.rules.code, value) if same else FROM_MEMORY

    def _clause(self, clause: str) -> str:
        return f"{self.case.rules.cited} {clause}".strip()
