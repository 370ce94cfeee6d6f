"""Checks of bearings that lift off: whether rims still hold the slider, and how hard they land."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frames.design.calculation.check import Check
from frames.design.calculation.standing import FROM_MEMORY, PROJECT
from frames.design.calculation.trace import Trace
from frames.design.devices.bearing_numbers import enter_geometry, overlap_area, pressure
from frames.design.devices.limits import LANDING_PRESSURE, PROJECT_LIMIT, PROPOSED_LIMIT
from frames.design.histories.bearing_demands import BearingDemands, DemandOverLimit
from frames.design.histories.suite import RunSet, motion_of, peaks_of_runs, stopped_in
from frames.results.bearing_geometry import RIM_SHARE
from lir_element.device.sliders import interface_height
from lir_element.texts import worded

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames._types import BoolArray
    from lir_element import LIRBearing


def suite_of_uplift(data: xr.Dataset, reason: str = "") -> RunSet:
    """Return the statistics of lift-offs: the largest; no value if a run failed or keeps no gap."""
    stopped, lifted = stopped_in(data), _lifted_in(data)
    unknown = (np.isnan(peaks_of_runs(data, "gap")) & lifted).any(axis=1)
    if not stopped.any():
        reason = "a bearing lifted off by a gap that was not recorded"
    failed = tuple((stopped | unknown).tolist())
    return RunSet(statistic="largest", failed=failed, reason=reason)


@dataclass(frozen=True)
class Uplift(BearingDemands):
    """Makes the checks of bearings that lift off: the worst run counts, never a mean."""

    clause: str = ""  # clause of the code on stability after uplift; empty if it has none

    def rims(self) -> list[Check]:
        """Return the check of the gap over the height of the rims; none without rims."""
        own = self.limits.rim_height
        each = {}
        for k, name in enumerate(self._names):
            bearing = self.bearings[name]
            if own is None and not all(map(math.isfinite, bearing.rim_displacement)):
                continue
            if own is None:
                t = _enter_rim(bearing)
            else:
                t = Trace()
                t.given("h_rim", own, "m", shown="mm", note="height of the rims, as given")
            each[name] = DemandOverLimit(self._with_gap(t, k), "g", "h_rim")
        known, clause = (FROM_MEMORY, self.clause) if self.clause else (PROJECT, PROPOSED_LIMIT)
        return self.worst(known, clause, "maximum uplift over the rim height", each, self._told)

    def gaps(self) -> list[Check]:
        """Return the check of the gap over `uplift_gap`; none if it is not given."""
        each = {
            name: self.within(self._with_gap(Trace(), k), "g", "gap")
            for k, name in enumerate(self._names)
            if self.limit("gap") is not None
        }
        return self.worst(PROJECT, PROJECT_LIMIT, "maximum uplift", each, self._told)

    def landings(self) -> list[Check]:
        """Return the check of the landing's force or pressure; none if nothing lifted off."""
        limits, lifted = self.limits, self._lifted
        each = {}
        for k, name in enumerate(self._names):
            runs = [int(run) for run in np.flatnonzero(lifted[:, k])]
            if runs:
                each[name] = self._landing(k, self.bearings[name], runs)
        clause, title = PROJECT_LIMIT, "pressure of a landing on the sliders"
        if limits.axial_force is not None:
            title = "axial force with a landing"
        elif limits.interface_pressure is None:
            clause = PROPOSED_LIMIT
        return self.worst(PROJECT, clause, title, each, self._told)

    def _landing(self, k: int, bearing: LIRBearing, runs: Sequence[int]) -> DemandOverLimit:
        # The run with the largest pressure, of the runs in which the bearing lifts off.
        force, slip = (
            peaks_of_runs(self.data, "axial_force")[:, k],
            peaks_of_runs(self.data, "slip")[:, k],
        )
        slip = np.zeros_like(force) if bearing.is_dcfp else slip
        area = np.array([overlap_area(bearing.slider_radius, float(s)) for s in slip])
        with np.errstate(divide="ignore"):
            run = int(max(runs, key=lambda i: force[i] / area[i]))
        if self.limits.axial_force is not None:
            run = int(max(runs, key=lambda i: force[i]))
        t = Trace()
        note = worded(
            "largest of the run, {motion}; upper bound for the landing", motion=self._run(run)
        )
        t.given("N_land", float(force[run]), "N", note=note)
        symbol, limit = self._enter_resistance(t)
        if symbol == "p_land":
            t.given("a", bearing.slider_radius, "m", shown="mm")
            t.given("s", float(slip[run]), "m", shown="mm", note="largest slip of that run")
            pressure(t, symbol, "N_land", "s")
        return DemandOverLimit(t, symbol, limit)

    def _enter_resistance(self, t: Trace) -> tuple[str, str]:
        # Symbols of demand and limit of a landing.
        if self.limits.axial_force is not None:
            t.given("N_R", self.limits.axial_force, "N", note="as given")
            return "N_land", "N_R"
        own = self.limits.interface_pressure
        note = "a proposal: set axial_force or interface_pressure" if own is None else "as given"
        t.given("p_lim", LANDING_PRESSURE if own is None else own, "Pa", note=note)
        return "p_land", "p_lim"

    def _with_gap(self, t: Trace, k: int) -> Trace:
        gap = np.where(self._lifted[:, k], peaks_of_runs(self.data, "gap")[:, k], 0.0)
        self.suite.enter(t, "g", gap, "m", "mm")
        return t

    @property
    def _told(self) -> str:
        # Numbers, durations and gaps of lift-offs of a bearing in the runs; then the force.
        runs = np.flatnonzero(self._lifted.any(axis=1))
        if not len(runs):
            return "no bearing lifts off"
        gap, force = peaks_of_runs(self.data, "gap"), peaks_of_runs(self.data, "axial_force")
        lasts, count = peaks_of_runs(self.data, "time_lifted"), peaks_of_runs(self.data, "uplifts")
        wide = np.where(self._lifted, np.nan_to_num(gap, nan=math.inf), 0.0)
        run, k = np.unravel_index(int(np.argmax(wide)), wide.shape)
        return worded(
            "bearings lift off in {n} of {all} runs, {times:.0f} times; largest gap {gap:.3g} mm "
            "({motion}, {where}, lifted for {time:.3g} s), axial force up to {force:.4g} kN",
            n=len(runs),
            all=len(wide),
            times=count.sum(),
            gap=1e3 * wide[run, k],
            motion=self._run(int(run)),
            where=self._names[k],
            time=lasts[run, k],
            force=1e-3 * force[run, k],
        )

    def _run(self, k: int) -> str:
        return motion_of(self.data, k) if "run" in self.data.dims else "this one"

    @property
    def _lifted(self) -> BoolArray:
        return _lifted_in(self.data)


def _lifted_in(data: xr.Dataset) -> BoolArray:
    return np.asarray(peaks_of_runs(data, "time_lifted") > 0.0)


def _enter_rim(bearing: LIRBearing) -> Trace:
    # Half of the largest height of rims that leaves the sliders' edges and the other plate free.
    t = enter_geometry(bearing)
    t.given("a", bearing.slider_radius, "m", shown="mm")
    height = float(interface_height(bearing.radii, bearing.slider_radius, bearing.slider_height))
    t.given("h_1", height, "m", shown="mm", note="interface above the bottom vertex")
    t("h_2", "h - h_1", "m", shown="mm")
    for k in (1, 2):
        face = f"(d_rim_{k} * sqrt(R_{k}**2 - a**2) + a * sqrt(R_{k}**2 - d_rim_{k}**2)) / R_{k}"
        t(f"r_{k}", face, "m", shown="mm", note="the rim's face, from the plate's axis")
        t(f"z_{k}", f"R_{k} - sqrt(R_{k}**2 - r_{k}**2)", "m", shown="mm", note="the plate there")
        t(
            f"c_{k}",
            f"h_{k} - (R_{k} - sqrt(R_{k}**2 - a**2))",
            "m",
            shown="mm",
            note="edge of the slider",
        )
    t.given("a_h", RIM_SHARE, note="a proposal: set rim_height")
    t(
        "h_rim",
        "a_h * max(min((h - z_1 - z_2) / 2, c_1, c_2), 0)",
        "m",
        shown="mm",
        note="rims that have place between the plates",
    )
    return t
