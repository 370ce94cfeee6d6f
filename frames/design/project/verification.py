"""Candidates of a proposal put to the project's time histories: demands, and checks that fail."""

from __future__ import annotations

import math
import tomllib
from typing import TYPE_CHECKING, NamedTuple

import pandas as pd

from frames._errors import ModelError, MotionError
from frames.design._errors import CheckError, ProjectError
from frames.design.project.design_run import run_project
from frames.design.project.inputs import ProjectInputs
from frames.design.project.schema_bearing import bearing_table
from frames.results.quantities import DEMANDS
from lir_element.errors import AnalysisError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from frames.batch.cases import BatchProgress
    from frames.design.calculation.check import Checks
    from frames.design.project.design_run import ProjectRun
    from frames.design.sizing.candidate import Candidate
    from lir_element import LIRBearing

_DEMANDS = ("displacement", "slip", "rim_force", "base_shear", "drift", "floor_plan")


class Verified(NamedTuple):
    """A candidate after the time histories of its project."""

    candidate: Candidate  # which
    run: ProjectRun | None  # its runs, demands and checks; None where it could not be run
    reason: str = ""  # why it could not be run; empty where it was

    @property
    def passed(self) -> bool:
        """Whether it was run and no check fails."""
        return self.run is not None and self.run.checks.passed

    def row(self) -> dict[str, object]:
        """Return its main numbers and what fails."""
        t = self.candidate.trace
        found: dict[str, object] = {
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
        return found | {
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


def on_bearing(parts: ProjectInputs, bearing: LIRBearing) -> ProjectInputs:
    """Return a project with ``[bearing]`` as `section_of` writes it, and no further types."""
    given = bearing_table().model_validate(tomllib.loads(section_of(bearing))["bearing"])
    alone = {"bearing": given, "bearings": {}}
    return ProjectInputs(parts.file.model_copy(update=alone), parts.folder)


def section_of(bearing: LIRBearing) -> str:
    """Return a proposed bearing as it stands in a project's file, rounded to millimetres."""
    return (
        f'[bearing]\nradius = "{bearing.radii[0]:g} m"\n'
        f'slider_height = "{1e3 * bearing.slider_height:.0f} mm"\n'
        f'slider_radius = "{1e3 * bearing.slider_radius:.0f} mm"\n'
        f'capacity = "{1e3 * bearing.lateral_capacity:.0f} mm"\n'
        f"friction = {bearing.frictions[0].f_max:g}\n"
        f"interface_friction = {bearing.interface_friction:g}\n"
    )


def verified(
    parts: ProjectInputs,
    candidates: Sequence[Candidate],
    *,
    progress: Callable[[BatchProgress], None] | bool | None = None,
) -> Iterator[Verified]:
    """Put candidates to the time histories of a project, each when it is asked for."""
    for candidate in candidates:
        if len(candidate.bearings) != 1:
            msg = (
                f"a candidate has {len(candidate.bearings)} sizes of slider, and [bearing] of a "
                "project has one: verify with sizes = 1"
            )
            raise CheckError(msg)
        try:
            run = run_project(on_bearing(parts, candidate.bearings[0]), progress=progress)
        except (CheckError, ProjectError, ModelError, MotionError, AnalysisError) as cause:
            yield Verified(candidate, None, str(cause))
        else:
            yield Verified(candidate, run)


def verification_table(found: Sequence[Verified]) -> pd.DataFrame:
    """Return verified candidates, a row for each, in SI units: `Verified.row`."""
    return pd.DataFrame([one.row() for one in found])
