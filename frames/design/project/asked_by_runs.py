"""Demands of a project's runs on its bearings, and failures that no size of them mends."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.design.histories.eccentricity import levels_of
from frames.design.sizing.fitting import Asked

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.project.check_register import RunToCheck
    from frames.design.sizing.candidate import Candidate

FARTHER = 1.1
"""Largest factor on the displacement of the rims from one round to the next [-]."""

_LEAST, _MOST = 1.02, 1.3  # factors on a size from one round to the next
_SLIPPED = 1.25  # factor on the required slip if a run fails

_SLIDERS = {  # checks that a wider slider mends, and the power of its radius that does
    "slip over the overlap": 1.0,
    "pressure on the sliders' overlap": 0.5,
    "pressure on the liner around its resultant": 0.5,
    "pressure of a landing on the sliders": 0.5,
}
_SLIPS = ("slip over its stable limit s*", "residual slip", "stable limit of interface slip")
_HOLDS = ("interface holds before the rim", "interface holds until a rim is met")
_FAILED = ("runs that failed", "runs with moved masses that failed")
_RIMS = (  # checks that rims farther out mend: later or no impacts, more capacity
    *_FAILED,
    "isolator displacement",
    "displacement where a rim engages",
    "rim force",
    "interface slips before the rim breaks",
    "maximum uplift",
)
_ECCENTRICITY = "normalised eccentricity e/a"
_SIZED = (*_SLIDERS, *_SLIPS, *_HOLDS, *_RIMS, _ECCENTRICITY)
_FITTED = (  # checks of the bearing's own numbers: a size is fitted to their limits, no farther
    "interface holds until a rim is met",
    "stable limit of interface slip",
    "interface slips before the rim breaks",
    "normalised eccentricity e/a at the rims",
)
TITLES = frozenset((*_SIZED, *_FITTED))
"""Beginnings of titles of the checks that change a bearing's size."""


class Obstacle(NamedTuple):
    """A check that fails, and by how much its limit would have to give."""

    check: Check  # the worst of its title
    sized: bool  # whether the size of the bearing has a part in it

    def __str__(self) -> str:
        """Return it in words."""
        one = self.check
        if one.void or not math.isfinite(one.ratio):
            return one.statement
        demand, limit, _ = one.said
        kind = "the bearing's size" if self.sized else "not by the bearing's size"
        return f"{one.brief}: {demand} would have to be allowed in place of {limit} ({kind})"


def is_sized(check: Check) -> bool:
    """Return whether the size of the bearings has a part in a check."""
    return check.title.startswith(_SIZED)


def counted(checks: Iterable[Check]) -> list[Check]:
    """Return the checks that must pass, those that the authority must agree to among them."""
    return [one for one in checks if one.scope in {"any", "demand", "agreement"}]


def obstacles(run: RunToCheck, *, agreed: bool) -> list[Obstacle]:
    """Return the failing checks, the worst of each title, and those to agree unless `agreed`."""
    failed = [*run.checks.failed, *(() if agreed else run.checks.to_agree)]
    worst: dict[str, Check] = {}
    for one in failed:
        if one.title not in worst or one.compared > worst[one.title].compared:
            worst[one.title] = one
    own = [Obstacle(one, is_sized(one)) for one in worst.values() if not one.void]
    return own or [Obstacle(one, is_sized(one)) for one in worst.values()]


def asked_by(
    run: RunToCheck, one: Candidate, before: Asked, margin: float, *, agreed: bool
) -> Asked:
    """Return the demands of a run on the bearings; `before` itself if none is larger.

    Each check of the histories that depends on the size of a bearing must pass with the margin: its
    ratio is at most the inverse. Checks of the bearing's own numbers must pass. If the project
    gives the rim displacement (`agreed`), rims are not moved for the share at contact.
    """
    aim = 1.0 / margin
    over = {}
    for check in counted(run.checks):
        if not is_sized(check) or (agreed and check.scope == "agreement"):
            continue
        if check.title.startswith(_FAILED):
            factor = 1.0 if check.passed else math.inf
        elif check.void or check.is_unlimited:
            continue
        else:
            factor = check.ratio / (1.0 if check.title.startswith(_FITTED) else aim)
        if factor > 1.0 + 1e-3:
            over[check] = factor
    if not over:
        return before
    t, found = one.trace, before
    loads, sliders = _by_bearing(run, one, aim)
    for check, factor in over.items():
        step = min(max(factor, _LEAST), _MOST)
        title = check.title
        if title.startswith(_RIMS):
            farther = max(found.displacement, min(step, FARTHER) * t.value("D"))
            found = found._replace(displacement=farther)
        if title.startswith((*_SLIPS, *_FAILED)):
            wanted = step * t.value("s") if title.startswith(_SLIPS) else _SLIPPED * t.value("s")
            found = found._replace(slip=max(found.slip, wanted))
        if title.startswith(_HOLDS):
            found = found._replace(interface=max(found.interface, step * t.value("mu_h")))
        power = next((p for name, p in _SLIDERS.items() if title.startswith(name)), 0.0)
        if power:
            for k in _bearings_of(run, check):
                sliders[k] = max(sliders[k], step**power * _radius(one, k))
    least = before.sliders or (0.0,) * len(sliders)
    most = before.loads or (0.0,) * len(loads)
    return found._replace(
        loads=tuple(map(max, loads, most)), sliders=tuple(map(max, sliders, least))
    )


def _by_bearing(run: RunToCheck, one: Candidate, aim: float) -> tuple[list[float], list[float]]:
    # The largest axial force of each bearing, and the slider radius for its resultant.
    cases = levels_of(run.cases)[run.rules.bearing_level]
    count = len(run.frame.bearings)
    loads, sliders = np.zeros(count), np.zeros(count)
    for case in cases:
        if not case.suite.void:
            loads = np.fmax(loads, case.design("axial_force"))
            offset = case.design("eccentricity_loaded") / (run.limits.eccentricity * aim)
            radii = np.array([_radius(one, k) for k in range(count)])
            sliders = np.fmax(sliders, np.where(offset > 1.0, np.minimum(offset, _MOST) * radii, 0))
    return loads.tolist(), sliders.tolist()


def _radius(one: Candidate, k: int) -> float:
    return one.bearings[one.places[k]].slider_radius


def _bearings_of(run: RunToCheck, check: Check) -> list[int]:
    # Places of the bearings that a check is of: by its name, by its type, or all.
    names = list(run.frame.bearings)
    if check.subject in names:
        return [names.index(check.subject)]
    kind = next((kind for kind in run.types if check.subject.startswith(f"type {kind}")), None)
    return [k for k, name in enumerate(names) if kind in {None, run.kinds.get(name)}]
