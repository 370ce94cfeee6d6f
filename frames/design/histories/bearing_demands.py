"""Checks of bearings in runs: displacement, slip, rims, overlap, residual slip."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.bundles.peak_data import LOADED, PRESSED
from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check
from frames.design.calculation.standing import PROJECT, Standing
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.bearing_numbers import (
    by_equation,
    by_section,
    enter_bearing,
    liner_pressure,
    pressure,
)
from frames.design.histories.suite import names_of, peaks_of_runs
from frames.design.histories.suite_notes import doubted, level_errors, note_of_impacts
from frames.results.level_doubts import DOUBTED
from frames.results.quantities import JUDGED
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.design.devices.limits import DesignLimits
    from frames.design.histories.suite import RunSet
    from frames.frame import Frame
    from lir_element import LIRBearing

_ALONE = (
    "at the level 'pendulum' one rim may press alone: if this check governs, run at the level "
    "'contact', at which sliders rotate until both press"
)


class DemandOverLimit(NamedTuple):
    """A calculation with its symbols of demand and limit."""

    trace: Trace
    demand: str
    limit: str


Fill = Callable[[int], DemandOverLimit]
"""Returns the calculation of the bearing of a place."""


def devices_of(data: xr.Dataset, frame: Frame) -> dict[str, LIRBearing]:
    """Return the bearings of a frame by name."""
    devices = {name: link.bearing for name, link in frame.bearings.items()}
    odd = sorted(set(names_of(data, "displacement")) ^ set(devices))
    if odd:
        msg = (
            f"bearing {odd[0]!r} is not in both the runs and the frame: give the frame of the runs"
        )
        raise CheckError(msg)
    return devices


@dataclass(frozen=True)
class BearingDemands:
    """Builder of checks of the bearings' demands in runs."""

    data: xr.Dataset  # the runs
    suite: RunSet  # their statistics
    bearings: Mapping[str, LIRBearing]  # the bearings as they were in these runs
    limits: DesignLimits  # of the project
    bound: Bound  # properties of the bearings
    note: str = ""  # goes with each check
    # on the displacement [-]: if it is beyond the rims, the slip is at least the rest
    factor: float = 1.0

    def against(
        self,
        name: str,
        enter: Callable[[Trace, FloatArray], str] | None = None,
        *,
        limit: float | None = None,
        clause: str = "",
        standing: Standing = PROJECT,
        title: str = "",
        note: str = "",
    ) -> list[Check]:
        """Return the check of a quantity against a limit, without `limit` that of the project.

        `enter` enters the demand of a place by the values of the runs, and returns its symbol.
        """
        quantity, each, own = JUDGED[name], dict[str, DemandOverLimit](), limit is None
        if own:
            limit, clause = self.limit(name), self.limits.clause_of(quantity.limit)
        if limit is None:
            return []
        values = peaks_of_runs(self.data, name)
        values = values.reshape(len(values), -1)
        for k, place in enumerate(names_of(self.data, name)):
            t, symbol = Trace(), quantity.symbol
            if enter is None:
                unit, shown = quantity.pure_unit, quantity.in_checks
                self.suite.enter(t, symbol, values[:, k], unit, shown, of=name)
            else:
                symbol = enter(t, values[:, k])
            each[place] = self.within(t, symbol, name, None if own else limit)
        return self.worst(standing, clause, title or quantity.heading, each, note)

    def limit(self, name: str) -> float | None:
        """Return the limit of the project of a quantity."""
        found: float | None = getattr(self.limits, JUDGED[name].limit)
        return found

    def within(
        self,
        t: Trace,
        symbol: str,
        name: str,
        limit: float | None = None,
        *,
        value: float | None = None,
        note: str = "",
    ) -> DemandOverLimit:
        """Enter the limit of a quantity, that of the project if None, and its value if given."""
        unit, shown, end = JUDGED[name].pure_unit, JUDGED[name].in_checks, f"{symbol}_lim"
        if value is not None:
            t.given(symbol, float(value), unit, shown=shown, note=note)
        given = "as given" if limit is None else ""
        limit = self.limit(name) if limit is None else limit
        t.given(end, math.inf if limit is None else limit, unit, shown=shown, note=given)
        return DemandOverLimit(t, symbol, end)

    def worst(
        self,
        standing: Standing,
        clause: str,
        title: str,
        each: Mapping[str, DemandOverLimit],
        note: str = "",
    ) -> list[Check]:
        """Return the check of the largest ratio; none of nothing."""
        # without a finite value none is the worst
        known = any(math.isfinite(c.trace.value(c.demand)) for c in each.values())
        words = joined(note, self.note)
        found = [
            CheckBuilder(c.trace, self.bound, standing, void=self.suite.void).worst(
                clause,
                title,
                c.demand,
                "<=",
                c.limit,
                subjects=(name if known else "",),
                note=words,
            )
            for name, c in each.items()
        ]
        return [max(found, key=lambda check: check.compared)] if found else []

    def displacement(self, clause: str, standing: Standing, least: float = 0.0) -> list[Check]:
        """Return the check of the displacement against the limit of rims and overlap."""
        values = peaks_of_runs(self.data, "displacement")

        def fill(k: int) -> DemandOverLimit:
            bearing, t = self._at(k), Trace()
            if bearing.is_dcfp:
                t.given("U_max", bearing.lateral_capacity, "m", shown="mm", note="a rim is met")
            else:
                t = self._entered(k)
                t("U_max", "U_cap + s_lim", "m", shown="mm")
            self.suite.enter(t, "D", values[:, k], "m", "mm", of="displacement")
            formula = "D"
            if self.factor > 1.0:
                t.given("gamma_x", self.factor)
                formula = "gamma_x * D"
            if least > 0.0:
                note = "least one, of the equivalent-linear analysis"
                t.given("D_least", least, "m", shown="mm", note=note)
                formula = f"max({formula}, D_least)"
            if formula == "D":
                return DemandOverLimit(t, "D", "U_max")
            self.suite.form(t, "D_d", formula, "m", "mm", of="D")
            return DemandOverLimit(t, "D_d", "U_max")

        places = [k for k in self._all if math.isfinite(self._at(k).lateral_capacity)]
        found = self._of(clause, "isolator displacement", fill, places, standing)
        return self._doubted(found, "displacement")

    def slips(self) -> list[Check]:
        """Return the checks of slip over the overlap and its stable limit, and of residual slip."""
        most, left = peaks_of_runs(self.data, "slip"), peaks_of_runs(self.data, "slip_left")

        def of(symbol: str, values: FloatArray, limit: str) -> Fill:
            def fill(k: int) -> DemandOverLimit:
                t = self._entered(k)
                if symbol == "s":
                    self._enter_slip(t, k)
                else:
                    self.suite.enter(t, symbol, values[:, k], "m", "mm", of="slip_left")
                if limit not in t and self.limits.slip_left is not None:
                    t.given(limit, self.limits.slip_left, "m", shown="mm", note="as given")
                return DemandOverLimit(t, symbol, limit)

            return fill

        after = "s_star" if self.limits.slip_left is None else "s_allowed"
        holds = by_equation("2.7")
        overlap = of("s", most, "s_cap")
        found = [
            *self._of(by_section("2"), "slip over the overlap", overlap, self._lir),
            *self._of(holds, "slip over its stable limit s*", of("s", most, "s_star"), self._lir),
            *self._of(holds, "residual slip", of("s_left", left, after), self._lir),
        ]
        return self._doubted(found, "slip")

    def _enter_slip(self, t: Trace, k: int) -> None:
        # The largest slip; with a factor on the displacement at least the part beyond the rims.
        slip = peaks_of_runs(self.data, "slip")[:, k]
        if not self.factor > 1.0:
            self.suite.enter(t, "s", slip, "m", "mm", of="slip")
            return
        self.suite.enter(t, "s_run", slip, "m", "mm", of="slip")
        moved = peaks_of_runs(self.data, "displacement")[:, k]
        self.suite.enter(t, "D", moved, "m", "mm", of="displacement")
        t.given("gamma_x", self.factor)
        self.suite.form(t, "s", "max(s_run, gamma_x * D - U_cap)", "m", "mm", of="s_run")

    def forces(self) -> list[Check]:
        """Return the checks of rim force, eccentricity and pressures that have limits."""
        limits, impacts = self.limits, note_of_impacts(self.data, self.bearings)
        notes = {"force": impacts, "axial_force": impacts}
        notes["eccentricity_loaded"] = self._of_resultants
        found = self._bent_rims()
        for name, quantity in JUDGED.items():
            if quantity.limit and quantity.dims == ("bearing",) and name != "gap":
                checks = self.against(name, note=notes.get(name, ""))
                found += self._doubted(checks, name)
        title = "pressure on the sliders' overlap"
        found += self._pressure(title, limits.interface_pressure, self._on_overlap)
        title = "pressure on the liner around its resultant"
        return found + self._pressure(title, limits.liner_pressure, self._on_liners)

    def _bent_rims(self) -> list[Check]:
        # Plastic deformation of rims that yield, without the elastic part under their yield force.
        places = [k for k in self._all if math.isfinite(self._at(k).rim_yield_force)]
        if not places:
            return []
        values = peaks_of_runs(self.data, "rim_plastic")

        def fill(k: int) -> DemandOverLimit:
            options, bearing, t = self._at(k).resolved(), self._at(k), Trace()
            t.given("P_y", bearing.rim_yield_force, "N")
            t.given("k_r", options["rim_stiffness"], "N/m")
            t.given("g_u", options["rim_overrun"], "m", shown="mm", note="at which a rim breaks")
            self.suite.enter(t, "g_p", values[:, k], "m", "mm", of="rim_plastic")
            t("g_lim", "g_u - P_y / k_r", "m", shown="mm", source="docs/theory.md (3.11)")
            return DemandOverLimit(t, "g_p", "g_lim")

        return self._of(by_equation("3.11"), "plastic deformation of rims", fill, places)

    def _entered(self, k: int) -> Trace:
        # Properties of a bearing; if friction depends on pressure, at the forces of the runs.
        bearing = self._at(k)
        if bearing.pressure_dependence is None:
            return enter_bearing(bearing, None)
        least = float(-np.nanmax(peaks_of_runs(self.data, "axial_tension")[:, k]))
        most = float(np.nanmax(peaks_of_runs(self.data, "axial_force")[:, k]))
        return enter_bearing(bearing, None, (max(least, 0.0), most))

    def _pressure(
        self, title: str, limit: float | None, of: Callable[[Trace], None]
    ) -> list[Check]:
        if limit is None:
            return []
        load = peaks_of_runs(self.data, "axial_force")

        def fill(k: int) -> DemandOverLimit:
            t = self._entered(k)
            t.given("p_lim", limit, "Pa", note="as given")
            self.suite.enter(t, "N", load[:, k], "N", of="axial_force")
            self._enter_slip(t, k)
            of(t)
            return DemandOverLimit(t, "p", "p_lim")

        impacts = note_of_impacts(self.data, self.bearings)
        taken = "largest load and largest slip taken together"
        note = joined(taken, impacts)
        return self._of("no code: liner's maker", title, fill, self._lir, note=note)

    @staticmethod
    def _on_overlap(t: Trace) -> None:
        pressure(t, "p", "N", "s")

    @staticmethod
    def _on_liners(t: Trace) -> None:
        if math.isfinite(max(liner_pressure(t, k, "N") for k in (1, 2))):
            t("p", "max(p_1, p_2)", "Pa")
        else:
            t.given("p", math.inf, "Pa", note=t["p_1"].note or t["p_2"].note)

    def _doubted(self, checks: list[Check], quantity: str) -> list[Check]:
        # Checks that pass by less than the possible error of the runs' level have a note.
        if quantity not in DOUBTED or "pendulum" not in str(self.data.attrs["level"]):
            return checks
        errors = level_errors(self.data, [self._at(k) for k in self._all], quantity)
        return doubted(checks, dict(zip(self._names, errors.tolist(), strict=True)), quantity)

    @property
    def _of_resultants(self) -> str:
        # Definition of the offset of a resultant, and the limits of its level.
        counted = worded("counts while N > {share:g} of that at rest", share=LOADED)
        pressed, lighter = (
            np.nan_to_num(peaks_of_runs(self.data, name)).max(axis=0)
            for name in ("eccentricity_loaded", "eccentricity")
        )
        if lighter.max() > max(self.limits.eccentricity, pressed.max()):
            where = self._names[int(lighter.argmax())]
            less = worded(
                "under less, down to {share:g} of it, up to {value:.2f} ({bearing})",
                share=PRESSED,
                value=lighter.max(),
                bearing=where,
            )
            counted = joined(counted, less)
        if "pendulum" not in str(self.data.attrs["level"]):
            return counted
        return joined(counted, _ALONE)

    def _of(
        self,
        clause: str,
        title: str,
        fill: Fill,
        places: list[int],
        standing: Standing = PROJECT,
        note: str = "",
    ) -> list[Check]:
        each = {self._names[k]: fill(k) for k in places}
        return self.worst(standing, clause, title, each, note)

    def _at(self, k: int) -> LIRBearing:
        return self.bearings[self._names[k]]

    @property
    def _names(self) -> tuple[str, ...]:
        return names_of(self.data, "displacement")

    @property
    def _all(self) -> list[int]:
        return list(range(len(self._names)))

    @property
    def _lir(self) -> list[int]:
        # Bearings with an interface, and with rims.
        return [
            k
            for k in self._all
            if not self._at(k).is_dcfp and math.isfinite(self._at(k).lateral_capacity)
        ]
