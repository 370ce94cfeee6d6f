"""Notes of checks about runs: small gaps, doubts, omissions, margins of levels."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames.design.calculation.standing import PROJECT
from frames.design.calculation.trace import Trace
from frames.design.codes.secant import CheckBuilder
from frames.design.histories.suite import motion_of, names_of, parted, peaks_of_runs
from frames.results.bearing_findings import IMPACT
from frames.results.findings import findings_by_run
from frames.results.level_doubts import (
    DOUBTED,
    errors_of,
    levels_of_bearings,
    rims_are_unequal,
    travels,
)
from frames.results.recorded import PEAK
from lir_element.texts import joined, worded
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import FloatArray
    from frames.design.calculation.check import Bound, Check
    from frames.results.findings import Finding
    from lir_element import LIRBearing


ON_AXIAL_STIFFNESS = (
    "rim contact with slip: the force varies with the square root of axial_stiffness, here the "
    "default, an estimate from 0.3 to 3 times"
)
"""Note of checks of forces that rest on a default (docs/theory.md, 2.9)."""


def note_of_impacts(data: xr.Dataset, bearings: Mapping[str, LIRBearing]) -> str:
    """Return the note of force checks for rim contact and slip of bearings of default stiffness."""
    if "run" in data.dims and f"{PEAK}closing" not in data.variables:
        return ""  # of an earlier version
    closing = np.nan_to_num(peaks_of_runs(data, "closing")).max(axis=0)
    devices = [bearings[name] for name in names_of(data, "displacement")]
    for speed, device in zip(closing.tolist(), devices, strict=True):
        own = device.resolved()
        rise = speed * math.sqrt(own["axial_stiffness"] / own["design_load"] / STANDARD_GRAVITY)
        if rise > IMPACT and device.axial_stiffness is None:
            return ON_AXIAL_STIFFNESS
    return ""


def contact_notes(data: xr.Dataset, least: float) -> str:
    """Return the runs in which bearings lifted off by no more than a gap [m], in words."""
    time, gap = peaks_of_runs(data, "time_lifted"), peaks_of_runs(data, "gap")
    small = (time > 0.0) & ~parted(data, least)
    words = [
        worded(
            "{motion}: {gap:.2g} mm, {time:.3g} s",
            motion=motion_of(data, int(k)),
            gap=1e3 * gap[k, small[k]].max(),
            time=time[k, small[k]].max(),
        )
        for k in np.flatnonzero(small.any(axis=1))
    ]
    if not words:
        return ""
    return worded(
        "gaps up to {gap:g} mm count as contact ({runs})", gap=1e3 * least, runs=joined(*words)
    )


def audit_notes(data: xr.Dataset) -> str:
    """Return what the assumption checks of runs mark, each feature once, of its first run."""
    said = []
    for runs in marked_features([data]).values():
        first, found = runs[0]
        said.append(
            worded(
                "assumption checks of {n} of {all} runs, first {motion}: {doubt}",
                n=len(runs),
                all=data.sizes["run"],
                motion=motion_of(data, first),
                doubt=found.sentence,
            )
        )
    return joined(*said)


def marked_features(parts: Iterable[xr.Dataset]) -> dict[str, list[tuple[int, Finding]]]:
    """Return the findings that the assumption checks mark, with their run, by feature."""
    marked: dict[str, list[tuple[int, Finding]]] = {}
    for data in parts:
        for k, found in enumerate(findings_by_run(data)):
            for one in found:
                if one.is_marked:
                    marked.setdefault(one.feature, []).append((k, one))
    return marked


def left_out_checks(data: xr.Dataset, bound: Bound, void: str = "") -> list[Check]:
    """Return the check that omitted effects do not matter; none if runs left nothing out."""
    features = str(data.attrs.get("features_left_out", "none"))
    if features == "none":
        return []
    t = Trace()
    spoilt = sum(bool(found.missing()) for found in findings_by_run(data))
    t.given("n_spoilt", float(spoilt), note="by their assumption checks")
    t.given("n_allowed", 0.0)
    judge = CheckBuilder(t, bound, PROJECT, void=void)
    title = "runs whose modelling assumptions are violated"
    return [judge("no code: assumption check", title, "n_spoilt", "<=", "n_allowed", note=features)]


def doubted(checks: list[Check], errors: Mapping[str, float], quantity: str) -> list[Check]:
    r"""Return checks with a note at those that pass by less than the possible error of their level.

    Errors :math:`e` are over the right value, so that a demand :math:`x` may mean :math:`x / (1 -
    e)`, and from :math:`e = 1` on any value. A demand that a least value governs is treated the
    same, on the safe side.
    """
    found = []
    for check in checks:
        error = errors[check.subject] if check.subject else 0.0
        most = check.demand / (1.0 - error) if error < 1.0 else math.inf
        if check.passed and error > 0.0 and most > check.limit:
            doubt = worded(
                'at the level "pendulum" the {quantity} may be off by {error:.0f} %, more than its '
                'margin: run at level = "contact"',
                quantity=DOUBTED[quantity],
                error=100.0 * error,
            )
            check = replace(check, note=joined(check.note, doubt))
        found.append(check)
    return found


def level_errors(data: xr.Dataset, bearings: Sequence[LIRBearing], quantity: str) -> FloatArray:
    """Return the largest possible error of the level 'pendulum' over all runs, by bearing.

    Shapes: result (n_bearings,).
    """
    rims, lifted, share, moved = (
        np.nan_to_num(peaks_of_runs(data, name))
        for name in ("rim_force", "lifted", "eccentricity", "displacement")
    )
    unequal = rims_are_unequal(
        np.array([bearing.rim_displacement for bearing in bearings]),
        np.array([bearing.radii for bearing in bearings]),
    )
    friction = np.array([[law.f_max for law in bearing.frictions] for bearing in bearings])
    length = np.array([bearing.effective_radius for bearing in bearings])
    travel = travels(moved, friction, length)
    errors, _ = errors_of(rims > 0.0, lifted > 0.0, share, unequal, travel)
    at = np.array([level == "pendulum" for level in levels_of_bearings(data)])
    return np.asarray((errors.max(axis=0) * at[:, None])[:, list(DOUBTED).index(quantity)])
