"""Checks of one time history: impact demands of bearings and structure; resultants."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.bundles.peak_data import PRESSED
from frames.design._errors import CheckError
from frames.design.calculation.check import Bound, Check, Checks
from frames.design.calculation.not_evaluated import OF_AXIAL_FORCES, not_evaluated
from frames.design.calculation.standing import PROJECT
from frames.design.calculation.trace import Trace
from frames.design.codes.registry import standing_in
from frames.design.codes.secant import CheckBuilder
from frames.design.devices.bearing_numbers import by_equation, by_section, enter_bearing
from frames.design.devices.limits import PROJECT_LIMIT, DesignLimits
from frames.design.histories.bearing_demands import BearingDemands, DemandOverLimit, devices_of
from frames.design.histories.impacts import (
    impact_demand,
    rim_engagement,
    slips_of_events,
    uplift_events,
)
from frames.design.histories.suite import RunSet
from frames.design.histories.suite_notes import left_out_checks
from frames.design.histories.uplift import Uplift, suite_of_uplift
from frames.results.findings import doubts_of
from frames.results.formulas import in_plan, of_bearings
from frames.results.quantities import JUDGED
from frames.results.recorded import require_recorded, require_steps
from frames.statics.overturning import unknown_axial_forces
from lir_element.argument_checks import require_between, require_positive

if TYPE_CHECKING:
    import xarray as xr

    from frames.frame import Frame
    from lir_element import LIRBearing


def impact_checks(
    data: xr.Dataset,
    frame: Frame,
    *,
    limits: DesignLimits | None = None,
    total_displacement: float | None = None,
    least_engagement: float = 0.60,
    bound: Bound = "",
) -> Checks:
    """Check the demands of one time history on its LIR-DCFP bearings and the structure above.

    Parameters
    ----------
    data : xarray.Dataset
        Result of `time_history`. Limits on the structure at an impact, on gaps and landings, and
        `total_displacement`, need its histories; the others need only its peaks.
    frame : Frame
        The structure as it was analysed.
    limits : DesignLimits, optional
        Limits of bearings and structure.
    total_displacement : float, optional
        D_TM of ASCE 7-22 [m], of which rims must not engage below a share; `engagement_checks` has
        the other codes.
    least_engagement : float
        The share of `total_displacement` [-]; the wording of ASCE 7-22 17.2.4.5 has to be read.
    bound : {"lower", "nominal", "upper", ""}
        Properties of the bearings in this run.

    Returns
    -------
    Checks
        Checks of the worst bearing, level or storey. If the run failed, all checks fail
        (`Check.void` has the reason), and their demands are its peaks until it stopped.

    Raises
    ------
    CheckError, ValueError
        If run and frame do not belong together, or a quantity with a limit was not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import impact_checks
    >>> frame, pulse = example(0.5)
    >>> impact_checks(time_history(frame, pulse), frame).passed
    True
    """
    limits = DesignLimits() if limits is None else limits
    failed = str(data.attrs["status"]) != "ok"
    reason = str(data.attrs["message"]) if failed else ""
    suite = RunSet(statistic="single", failed=(failed,), reason=reason)
    devices = devices_of(data, frame)
    bearings = BearingDemands(data, suite, devices, limits, bound, reason)
    found = [_complete(data, bound)]
    found += left_out_checks(data, bound)
    found += bearings.displacement(by_section("2"), PROJECT)
    found += [*bearings.slips(), *bearings.forces()]
    found += [*_structure(bearings), *_uplift(bearings)]
    landing = suite_of_uplift(data, reason)
    lifted = Uplift(data, landing, devices, limits, bound)
    found += [*lifted.rims(), *([] if limits.axial_force else lifted.landings())]
    if total_displacement is not None:
        require_positive("total_displacement", total_displacement, "m", error=CheckError)
        found += _engagement(data, total_displacement, least_engagement, bound)
    found = [replace(check, void=check.void or suite.void) for check in found]
    return not_evaluated(found, unknown_axial_forces(frame), OF_AXIAL_FORCES)


def event_checks(
    data: xr.Dataset,
    frame: Frame,
    ends: tuple[float, ...],
    *,
    limits: DesignLimits | None = None,
    bound: Bound = "",
) -> Checks:
    """Check largest and residual slip of each of several events in a row.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a `time_history` under `repeated_motion` motions, or other motions in a row.
    frame : Frame
        The structure as it was analysed.
    ends : tuple of float
        Times at which the events end, pauses included [s], rising.
    limits : DesignLimits, optional
        Limits; `slip_left` and `displacement_left` count.
    bound : {"lower", "nominal", "upper", ""}
        Properties of the bearings in this run.

    Returns
    -------
    Checks
        The check that the run is complete; for each event the worst bearing's slip over the smaller
        of overlap and s*, and its residual slip. If the run failed, all fail.

    Raises
    ------
    CheckError, ValueError
        If run and frame do not belong together, times do not rise, or slips were not recorded.

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import event_checks, repeated_motion
    >>> frame, pulse = example(1.5)
    >>> motion, ends = repeated_motion(pulse, 2, pause=3.0)
    >>> data = time_history(frame, motion)
    >>> checks = event_checks(data, frame, ends)
    >>> checks[0].title, checks[0].passed
    ('run is complete', True)
    """
    limits = DesignLimits() if limits is None else limits
    void = "" if str(data.attrs["status"]) == "ok" else str(data.attrs["message"])
    found, devices = [_complete(data, bound)], devices_of(data, frame)
    suite = RunSet(statistic="single", failed=(bool(void),), reason=void)
    demands = BearingDemands(data, suite, devices, limits, bound)
    for event, rows in slips_of_events(data, ends).groupby("event"):
        left = "s_star" if limits.slip_left is None else "s_allowed"
        for column, symbol, limit, what in (
            ("slip", "s", "s_lim", "slip"),
            ("slip_left", "s_left", left, "residual slip"),
        ):
            each = {
                name: _slip_of(devices[name], symbol, value, limit, limits)
                for name, value in zip(rows["bearing"], rows[column], strict=True)
                if not devices[name].is_dcfp
            }
            title = f"{what}, event {event}"
            found += demands.worst(PROJECT, by_equation("2.7"), title, each)
    return Checks(replace(check, void=void) for check in found)


def _complete(data: xr.Dataset, bound: Bound) -> Check:
    t = Trace()
    t.given("n_failed", float(str(data.attrs["status"]) != "ok"), note="runs that failed")
    t.given("n_allowed", 0.0)
    said = (f"assumption check: {doubt}" for doubt in doubts_of(data))
    note = "; ".join((str(data.attrs["message"]), *said))
    judge = CheckBuilder(t, bound, PROJECT)
    return judge("no code", "run is complete", "n_failed", "<=", "n_allowed", note=note)


def _structure(demands: BearingDemands) -> list[Check]:
    wanted = {"base shear": "base_shear", "acceleration": "floor_plan", "drift": "drift"}
    asked = {kind: name for kind, name in wanted.items() if demands.limit(name) is not None}
    if not asked:
        return []
    table, found = impact_demand(demands.data), []
    for kind, name in asked.items():
        each, symbol = {}, JUDGED[name].symbol
        for label, row in table[table.index.astype(str).str.startswith(kind)].iterrows():
            note = f"t = {row['time']:.4g} s; {row['ratio']:.3g} times the largest before impacts"
            place, t = str(label).partition(" of ")[2], Trace()
            each[place] = demands.within(t, symbol, name, value=row["at_impact"], note=note)
        found += demands.worst(PROJECT, PROJECT_LIMIT, f"{kind} at an impact", each)
    return found


def _uplift(demands: BearingDemands) -> list[Check]:
    wanted = (
        ("gap", "gap", "maximum uplift", "g"),
        ("landing_force", "axial_force", "force of landing", "N_land"),
    )
    asked = [each for each in wanted if demands.limit(each[1]) is not None]
    if not asked:
        return []
    table, found = uplift_events(demands.data), []
    said = f"{len(table)} times lifted off, {int(table['at_impact'].sum())} of them at an impact"
    for column, name, title, symbol in asked:
        rows = table.dropna(subset=[column])
        if rows.empty:
            continue
        row, t = rows.loc[rows[column].idxmax()], Trace()
        when = f"lifted off at t = {row['begin']:.4g} s for {row['duration']:.4g} s"
        one = demands.within(t, symbol, name, value=row[column], note=when)
        found += demands.worst(PROJECT, PROJECT_LIMIT, title, {str(row["bearing"]): one}, said)
    return found


def _engagement(data: xr.Dataset, whole: float, least: float, bound: Bound) -> list[Check]:
    table, found = rim_engagement(data), []
    for surface, rows in table.groupby("surface"):
        row = rows.loc[rows["displacement"].idxmin()]
        t = Trace()
        when = f"{row['bearing']}, t = {row['time']:.4g} s"
        t.given("U_rim", float(row["displacement"]), "m", shown="mm", note=when)
        t.given("D_TM", whole, "m", shown="mm", note="of ASCE 7-22")
        t.given("eta_least", least)
        t("eta", "U_rim / D_TM")
        found.append(
            CheckBuilder(t, bound, standing_in("ASCE 7-22", "rims")).worst(
                "ASCE 7-22 17.2.4.5",
                "displacement where a rim engages, over D_TM",
                "eta",
                ">=",
                "eta_least",
                subjects=(f"{row['bearing']}, {surface} rim",),
            )
        )
    return found


def _slip_of(
    bearing: LIRBearing, symbol: str, value: float, limit: str, limits: DesignLimits
) -> DemandOverLimit:
    t = enter_bearing(bearing, None)
    t.given(symbol, value, "m", shown="mm")
    if limit not in t and limits.slip_left is not None:
        t.given(limit, limits.slip_left, "m", shown="mm", note="as given")
    return DemandOverLimit(t, symbol, limit)


_NEEDED = (
    "interface_eccentricity",
    "axial_force",
    "rim_force",
    "slider_displacement",
    "interface_slip_size",
)


def resultant_offsets(
    data: xr.Dataset, *, least_load: float = PRESSED, limit: float = 0.8
) -> pd.DataFrame:
    """Return time and cause of the largest offset of the resultant between the sliders.

    Parameters
    ----------
    data : xarray.Dataset
        Result of a time history with eccentricity, axial force, rims, sliding and slip.
    least_load : float
        Axial force over that at rest above which offsets count [-]. All runs keep those above 0.05
        (`peak_eccentricity`) and above 0.5 (`peak_eccentricity_loaded`, which checks take).
    limit : float
        Offset over the slider's radius, the time above which is given [-].

    Returns
    -------
    pandas.DataFrame
        A row for each bearing: the largest offset over the slider's radius [-], its time [s], the
        axial force then over that at rest [-], pressed rims ("none", "bottom", "top", "both"),
        interface slip [m], distance from the other rim [m] if one pressed alone (else NaN), and the
        time above the limit [s].

    Raises
    ------
    CheckError
        If a share or a limit is out of bounds.
    ValueError
        If the variables or the steps between the ends were not recorded.

    Notes
    -----
    Source: docs/theory.md (10.2). At the level "pendulum" a rim may press alone while the other is
    a millimetre away; real sliders rotate against each other until both press, as at the level
    "contact".

    Examples
    --------
    >>> from frames import time_history
    >>> from frames.demo import example
    >>> from frames.design import resultant_offsets
    >>> frame, pulse = example(0.5)
    >>> table = resultant_offsets(time_history(frame, pulse))
    >>> table["rims"].tolist(), float(table["time_above"][0])
    (['none'], 0.0)
    """
    require_between("least_load", least_load, 0.0, 1.0, "-", error=CheckError)
    require_positive("limit", limit, "-", error=CheckError)
    require_recorded(data, "resultant_offsets", *_NEEDED)
    require_steps(data, "resultant_offsets")
    time = data["time"].to_numpy()
    load = of_bearings(data, "axial_force")
    load = load / data["static_axial_force"].to_numpy()
    offset = of_bearings(data, "interface_eccentricity")
    offset = np.where(load > least_load, offset / data["slider_radius"].to_numpy(), 0.0)
    met = of_bearings(data, "rim_force", "surface") > 0.0
    slid = of_bearings(data, "slider_displacement", "surface", "axis")
    clear = data["rim_displacement"].transpose("bearing", "surface").to_numpy() - in_plan(slid)
    slip = of_bearings(data, "interface_slip_size")
    lasts = np.diff(time, append=time[-1])
    words = [*data["surface"].to_numpy(), "both"]
    rows = []
    for b, name in enumerate(data["bearing"].to_numpy()):
        k = int(np.argmax(offset[:, b]))
        pressed = np.flatnonzero(met[k, b])
        rims = "none" if not len(pressed) else words[2 if len(pressed) == 2 else pressed[0]]
        other = float(clear[k, b, 1 - pressed[0]]) if len(pressed) == 1 else np.nan
        rows.append(
            (
                str(name),
                float(offset[k, b]),
                float(time[k]),
                float(load[k, b]),
                str(rims),
                float(slip[k, b]),
                other,
                float(lasts[offset[:, b] > limit].sum()),
            )
        )
    columns = ["bearing", "offset", "time", "load", "rims", "slip", "clearance", "time_above"]
    return pd.DataFrame(rows, columns=columns)
