"""Checks of storeys besides their drift: torsion, and gravity on displaced storeys."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames.design.calculation.trace import Trace
from frames.design.codes.superstructure import floor_weights
from frames.design.histories.bearing_demands import DemandOverLimit
from frames.design.histories.suite import names_of, peaks_of_runs
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from frames.design.calculation.check import Check
    from frames.design.calculation.standing import Standing
    from frames.design.histories.bearing_demands import BearingDemands
    from frames.design.histories.eccentricity import Case
    from frames.frame import Frame

_STILL = 1e-6
"""Mean drift below which a storey does not move [-]: the ratio of its lines has no meaning."""


def torsion_checks(
    case: Case, makes: BearingDemands, frame: Frame, clause: str, standing: Standing
) -> list[Check]:
    """Return the check of the drift of the worst line over the mean of its storey."""
    if case.rules.torsion is None or not (case.keeps("drift") and case.keeps("line_drift")):
        return []
    mean, line = (peaks_of_runs(case.data, name) for name in ("drift", "line_drift"))
    levels = {node: level.name for level in frame.levels for node in level.nodes}
    lines = names_of(case.data, "line_drift")
    storeys = np.array([levels[name] for name in lines])
    each: dict[str, DemandOverLimit] = {}
    for k, storey in enumerate(names_of(case.data, "drift")):
        own = np.flatnonzero(storeys == storey)
        if not len(own) or not (mean[:, k] > _STILL).any():
            continue
        worst = own[np.nan_to_num(case.suite.values(line[:, own], "line_drift")).argmax()]
        t = Trace()
        case.suite.enter(t, "theta_max", line[:, worst], "-", "%", of="line_drift")
        case.suite.enter(t, "theta", mean[:, k], "-", "%", of="drift")
        case.suite.form(t, "r_t", "theta_max / theta", "-", of="theta_max")
        t.given("r_lim", case.rules.torsion)
        each[joined(storey, lines[worst], by=", ")] = DemandOverLimit(t, "r_t", "r_lim")
    note = "of time histories, mean over all lines of the storey"
    title = "largest over mean drift of a storey"
    found = makes.worst(standing, clause, title, each, note)
    return [check if check.void else replace(check, scope="procedure") for check in found]


def second_order_of(frame: Frame) -> str:
    """Return whether the analysis has the effects of gravity on the displaced structure."""
    return "the members have it" if frame.members else "springs do not have it"


def stability_checks(
    case: Case, makes: BearingDemands, frame: Frame, clause: str, standing: Standing
) -> list[Check]:
    """Return the check of the P-Delta coefficient of the worst storey."""
    if case.rules.stability is None or not (case.keeps("drift") and case.keeps("storey_shear")):
        return []
    limit = case.rules.stability[bool(frame.members)]
    drift, shear = (peaks_of_runs(case.data, name) for name in ("drift", "storey_shear"))
    weights = np.cumsum(floor_weights(frame)[::-1])[::-1]
    each: dict[str, DemandOverLimit] = {}
    for k, storey in enumerate(names_of(case.data, "drift")):
        if not (shear[:, k] > 0.0).any():
            continue
        t = Trace()
        t.given("W_above", weights[k], "N", note="weight of the floors above the storey")
        case.suite.enter(t, "theta", drift[:, k], "-", "%", of="drift")
        case.suite.enter(t, "V", shear[:, k], "N", of="storey_shear")
        case.suite.form(t, "theta_P", "W_above * theta / V", "-", of="theta")
        t.given("theta_P_lim", limit)
        each[storey] = DemandOverLimit(t, "theta_P", "theta_P_lim")
    note = worded("P-Delta in the analysis: {there}", there=second_order_of(frame))
    return makes.worst(standing, clause, "P-Delta coefficient of a storey", each, note)
