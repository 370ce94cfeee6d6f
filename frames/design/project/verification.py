"""Candidates of a proposal put to the time histories of the project, and sized by its checks."""

from __future__ import annotations

import math
import re
import tomllib
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import pandas as pd

from frames._errors import ModelError, MotionError
from frames.design._errors import CheckError, ProjectError
from frames.design.project.asked_by_runs import Obstacle, asked_by, counted, is_sized, obstacles
from frames.design.project.design_run import checked_run
from frames.design.project.inputs import ProjectInputs
from frames.design.project.level_runs import project_runs
from frames.design.project.preliminary import preliminary
from frames.design.project.schema_bearing import bearing_table, bearing_type_table, completed
from frames.design.sizing.fitting import Asked
from frames.results.quantities import DEMANDS
from lir_element.errors import AnalysisError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames.batch.cases import BatchProgress
    from frames.design.calculation.check import Check, Checks
    from frames.design.project.check_register import RunToCheck
    from frames.design.sizing.candidate import Candidate
    from frames.design.sizing.proposal import Design
    from lir_element import LIRBearing

_DEMANDS = ("displacement", "slip", "rim_force", "base_shear", "drift", "floor_plan")


_HEADER = re.compile(r"\s*\[")
_OWN_HEADER = re.compile(r"\s*\[\s*bearings?\s*[].]")

MARGIN = 1.1
"""Margin of the checks that a bearing's size has a part in, on the building's quick model [-]."""

ROUNDS = 6
"""Largest number of sizings of a bearing by the checks."""


class Verified(NamedTuple):
    """A candidate after the time histories of its project."""

    candidate: Candidate  # as it was sized last
    run: RunToCheck | None  # its runs, demands and checks; None if it could not be run
    reason: str = ""  # reason that it could not be run; empty if it was
    asked: Asked = Asked()  # demands of its sizing
    agreed: bool = False  # true if the project intends rim contact
    lacks: tuple[str, ...] = ()  # failures of a larger size, as the checks need it
    rounds: int = 1  # of time histories

    @property
    def passed(self) -> bool:
        """True if it was run and no check fails."""
        return self.run is not None and self.run.checks.passed and not self.obstacles

    @property
    def obstacles(self) -> list[Obstacle]:
        """Failing checks, and solutions to agree that the project does not intend."""
        return [] if self.run is None else obstacles(self.run, agreed=self.agreed)

    @property
    def nearest(self) -> Check | None:
        """The check of the largest ratio, of those that the bearing's size has a part in."""
        if self.run is None:
            return None
        own = [c for c in counted(self.run.checks) if is_sized(c) and not c.is_unlimited]
        return max(own, key=lambda check: check.compared, default=None)

    def row(self) -> dict[str, object]:
        """Return its main numbers and its failing checks."""
        t = self.candidate.trace
        found: dict[str, Any] = {
            "radius [m]": self.candidate.radius,
            "friction [-]": self.candidate.friction.f_max,
            "slider radius [m]": t.value("a"),
            "capacity [m]": t.value("U_cap"),
            "interface friction [-]": t.value("mu_h"),
        }
        if self.run is None:
            return found | {"fails": f"cannot be run: {self.reason}"}
        demands = self.run.demands
        own = demands[demands["level"] == self.run.rules.bearing_level]
        for name in (DEMANDS[key].demand for key in _DEMANDS):
            if name in own.index:
                found[f"{name} [{own.loc[name, 'unit']}]"] = float(own.loc[name, "envelope"])
        nearest, shear = self.nearest, f"{DEMANDS['base_shear'].demand} [N]"
        if shear in found:
            found["base shear / weight [-]"] = found[shear] / t.value("W")
        if self.candidate.prices is not None:
            found["cost"] = self.candidate.cost
        return found | {
            "outcome": "passes" if self.passed else "fails",
            "rounds": self.rounds,
            "limited by": "" if nearest is None else nearest.title,
            "largest ratio [-]": math.nan if nearest is None else nearest.compared,
            "runs that stopped": int((self.run.runs.centred.of("status") != "ok").sum()),
            "checks": len(self.run.checks),
            "failed checks": len(self.run.checks.failed),
            "fails": _failures(self.run.checks.failed),
        }


def _failures(failed: Checks) -> str:
    # Kinds of checks that fail with their largest ratio; then those without a value for design.
    worst: dict[str, float] = {}
    for check in failed:
        if not check.void:
            worst[check.title] = max(check.ratio, worst.get(check.title, 0.0))
    said = [
        f"{title} (ratio {ratio:.2f})" if math.isfinite(ratio) else title
        for title, ratio in worst.items()
    ]
    if void := sum(bool(check.void) for check in failed):
        said.append(f"{void} checks have no value for design, since runs failed")
    return "; ".join(said)


def on_bearings(parts: ProjectInputs, one: Candidate, names: Sequence[str]) -> ProjectInputs:
    """Return a project with the bearings of a candidate, as `sections_of` writes them."""
    data = completed(tomllib.loads(sections_of(one, names)))
    kind: Any = bearing_table()
    types = bearing_type_table(kind)
    given = {
        "bearing": kind.model_validate(data["bearing"]),
        "bearings": {n: types.model_validate(v) for n, v in data.get("bearings", {}).items()},
    }
    return ProjectInputs(parts.file.model_copy(update=given), parts.folder)


def sections_of(one: Candidate, names: Sequence[str]) -> str:
    """Return a candidate as text of a project's file: a type for each size of slider.

    `names` are those of the frame's bearings.
    """
    found = section_of(one.bearings[0])
    for k, bearing in enumerate(one.bearings):
        if bearing.slider_radius == one.bearings[0].slider_radius:
            continue
        own = [name for name, place in zip(names, one.places, strict=True) if place == k]
        listed = ", ".join(f'"{name.removeprefix("bearing-")}"' for name in own)
        found += f"\n[bearings.size-{k + 1}]\ncolumns = [{listed}]\n"
        found += f'slider_radius = "{1e3 * bearing.slider_radius:.0f} mm"\n'
    return found


def section_of(bearing: LIRBearing) -> str:
    """Return a proposed bearing as text of a project's file, rounded to millimetres."""
    return (
        f'[bearing]\nradius = "{bearing.radii[0]:g} m"\n'
        f'slider_height = "{1e3 * bearing.slider_height:.0f} mm"\n'
        f'slider_radius = "{1e3 * bearing.slider_radius:.0f} mm"\n'
        f'capacity = "{1e3 * bearing.lateral_capacity:.0f} mm"\n'
        f"friction = {bearing.frictions[0].f_max:g}\n"
        f"interface_friction = {bearing.interface_friction:g}\n"
    )


def with_sections(text: str, sections: str) -> str:
    """Return the text of a project's file with other bearings; its other lines stay.

    They replace ``[bearing]`` and ``[bearings.<type>]``, or are appended.
    """
    found: list[str] = []
    inside, place = False, None
    for line in text.splitlines(keepends=True):
        if _HEADER.match(line):
            inside = bool(_OWN_HEADER.match(line))
            if inside and place is None:
                place = len(found)
        if not inside:
            found.append(line)
    if place is None:
        found.append("" if not found or found[-1].endswith("\n") else "\n")
        found.append("\n")
        place = len(found)
    found.insert(place, sections + "\n")
    return "".join(found)


def quick(parts: ProjectInputs) -> ProjectInputs:
    """Return a project whose runs are soon done: level "pendulum", both bounds, masses in place."""
    ends = tuple(end for end in parts.file.analysis.bounds if end != "nominal")
    soon = {"level": "pendulum", "accidental_eccentricity": "none"}
    analysis = parts.file.analysis.model_copy(
        update=soon | {"bounds": ends or parts.file.analysis.bounds}
    )
    return ProjectInputs(parts.file.model_copy(update={"analysis": analysis}), parts.folder)


def verified(
    parts: ProjectInputs,
    found: Design,
    candidate: Candidate,
    *,
    asked: Asked | None = None,
    margin: float = 1.0,
    rounds: int = ROUNDS,
    progress: Callable[[BatchProgress], None] | bool | None = None,
    told: Callable[[Verified], None] = lambda _: None,
) -> Verified:
    """Run a candidate's time histories in a project, and size it until its checks pass.

    After each round the bearing is fitted to the demands of the checks that depend on its size,
    `margin` below their limits. `told` is called after each.
    """
    names, agreed = found.system.names, parts.file.design.rim_share is not None
    last = Verified(candidate, None, asked=asked or Asked(), agreed=agreed)
    for count in range(1, rounds + 1):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # `lir run` gives these warnings for the chosen one
                own = on_bearings(parts, last.candidate, names)
                known = preliminary(own)
                run = checked_run(own, known, project_runs(own, known, progress))
        except (CheckError, ProjectError, ModelError, MotionError, AnalysisError) as cause:
            return last._replace(run=None, reason=str(cause), rounds=count)
        last = last._replace(run=run, rounds=count)
        told(last)
        more = asked_by(run, last.candidate, last.asked, margin, agreed=agreed)
        if more == last.asked or count == rounds:
            break
        larger = found.fit(candidate.radius, candidate.friction, more)
        if larger.lacks:
            return last._replace(lacks=larger.lacks)
        if larger.bearings == last.candidate.bearings and larger.places == last.candidate.places:
            break  # the size does not mend it
        last = last._replace(candidate=larger, asked=more)
    return last


def verification_table(found: Sequence[Verified]) -> pd.DataFrame:
    """Return verified candidates, a row for each, in SI units: `Verified.row`."""
    return pd.DataFrame([one.row() for one in found])
