"""Hard cases at every level: writes their section of docs/validation/robustness.md.

    python -m validation.measurements.hard_cases

Impacts, axial load through zero, extreme properties and steps. For every run: did it complete, or
stop with a reason; does the energy balance close; did friction ever give energy back; how far is
it from the reference (level 'rigid_body', or 'contact' at a small step where the bearing stands
on a frame). The bearing is that of the paper (COMPDYN 2023), section 3.1.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import energy_error, time_history
from lir_element import RunStatus, cyclic_test
from lir_element.errors import AnalysisWarning
from validation.measurements.hard_scenes import Case, cases
from validation.measures import response
from validation.page import ROBUSTNESS, put, render
from validation.scenes import example_bearing

if TYPE_CHECKING:
    import xarray as xr

REFERENCE_TOLERANCE = 1e-9
LEDGER = 1e-3
"""Largest gap of the energy balance that passes [-]."""
GIVEN_BACK = -1e-9
"""Largest step back of a dissipated energy, over its largest value [-]."""
CREEP = (1e-5, 2e-3)
"""Speed [m/s] and reach [m] of the slow cyclic test."""


@dataclass(frozen=True)
class Outcome:
    """What one run says."""

    case: str
    level: str
    dt: float
    status: str
    reached: float
    """Time at which it ended [s]."""
    peak: float
    """Largest displacement [m]."""
    ledger: float
    given_back: float
    """Most negative increment of a dissipated energy over its largest value [-]."""
    finite: bool
    rim_speed: float
    """Speed at the first rim contact [m/s], NaN without one."""
    least_axial: float
    """Minimum axial force over its static value [-]."""
    tilt: float
    """Largest rotation of a plate [rad]."""
    error: float = float("nan")
    """Of the peak displacement against the reference, up to where both go [%]."""

    @property
    def sound(self) -> bool:
        """Whether it completed or the bearing failed, its energy in order."""
        reasons = {"ok", *(s.name.lower() for s in RunStatus if s.is_bearing_failure)}
        return (
            self.status in reasons
            and self.finite
            and self.ledger < LEDGER
            and self.given_back >= GIVEN_BACK
        )


def outcome(case: str, level: str, dt: float, data: xr.Dataset) -> Outcome:
    """Read off a run what the table says."""
    finite = all(
        np.isfinite(values.to_numpy()).all()
        for name, values in data.items()
        if "time" in values.dims or "step" in values.dims  # a device without a rim has one at inf
        if not str(name).startswith("body")
    )
    axial = data["axial_force"].to_numpy()
    static = data["static_axial_force"].to_numpy() if "static_axial_force" in data else axial[0]
    tilt = 0.0
    if "node_displacement" in data:
        turns = data["node_displacement"].sel(dof=["rx", "ry"]).to_numpy()
        tilt = float(np.linalg.norm(turns, axis=-1).max())
    return Outcome(
        case=case,
        level=level,
        dt=dt,
        status=data.attrs["status"],
        reached=float(data["time"][-1]),
        peak=float(np.linalg.norm(data["bearing_displacement"][..., :2], axis=-1).max()),
        ledger=energy_error(data) if "energy" in data else 0.0,
        given_back=given_back(data),
        finite=finite,
        rim_speed=rim_speed(data),
        least_axial=float((axial / static).min()),
        tilt=tilt,
    )


def given_back(data: xr.Dataset) -> float:
    """Return the most negative increment of an energy dissipated, over its largest value."""
    worst = 0.0
    for name in ("work_low_friction", "work_high_friction"):
        work = data[name].to_numpy().reshape(len(data["time"]), -1)
        if len(work) > 1 and work.max() > 0.0:
            worst = min(worst, float(np.diff(work, axis=0).min() / work.max()))
    return worst


def rim_speed(data: xr.Dataset) -> float:
    """Return the speed in the output before the first rim contact [m/s]."""
    touched = (data["rim_closure"].to_numpy() > 0.0).reshape(len(data["time"]), -1).any(axis=1)
    if not touched.any():
        return float("nan")
    at = max(int(np.argmax(touched)) - 1, 0)
    return float(np.linalg.norm(data["bearing_velocity"].to_numpy()[at, 0, :2]))


def compare(one: xr.Dataset, other: xr.Dataset) -> float:
    """Return the error of the peak displacement up to the end of the shorter run [%]."""
    ours, theirs = response(one, seconds=0.0), response(other, seconds=0.0)
    end = min(ours.time[-1], theirs.time[-1]) + 1e-9
    sizes = [
        float(np.linalg.norm(r.displacement[r.time <= end], axis=-1).max()) for r in (ours, theirs)
    ]
    return 100.0 * abs(sizes[0] / sizes[1] - 1.0)


def quiet(run: Any, *arguments: Any, **options: Any) -> Any:
    """Run without the warning of a failure: the table tells it."""
    with warnings.catch_warnings(action="ignore", category=AnalysisWarning):
        return run(*arguments, **options)


def run_case(case: Case) -> list[Outcome]:
    """Run a case at its levels and steps, and its reference."""
    smallest = min(dt for _, dt in case.runs)
    options: dict[str, Any] = {"dt": max(smallest, 1e-3), "tolerance": REFERENCE_TOLERANCE}
    if case.reference == "contact":
        options = {"dt": 0.1 * smallest, "record_every": 10}
    reference = quiet(
        time_history, case.model, case.motion, case.duration, level=case.reference, **options
    )
    found = [outcome(case.name, f"{case.reference} (reference)", options["dt"], reference)]
    for level, dt in case.runs:
        every = max(1, round(1e-3 / dt))
        data = quiet(
            time_history,
            case.model,
            case.motion,
            case.duration,
            dt=dt,
            level=level,
            record_every=every,
        )
        entry = outcome(case.name, level, dt, data)
        found.append(Outcome(**{**vars(entry), "error": compare(data, reference)}))
    return found


def creep() -> list[Outcome]:
    """Take a bearing to and fro at a creeping speed, at all levels."""
    speed, reach = CREEP
    path = np.concatenate([np.linspace(0.0, reach, 101), np.linspace(reach, -reach, 201)[1:]])
    found, reference = [], None
    for level in ("rigid_body", "contact", "pendulum"):
        data = quiet(
            cyclic_test, example_bearing(), path, axial_load=2e6, velocity=speed, level=level
        )
        force = data["bearing_force"].sel(axis="x").to_numpy()[:, 0]
        entry = outcome(f"cyclic test at {speed:g} m/s", level, float("nan"), data)
        if reference is None:
            reference = force
            entry = Outcome(**{**vars(entry), "level": "rigid_body (reference)"})
        else:
            shared = min(len(force), len(reference))
            error = float(np.abs(force[:shared] - reference[:shared]).max())
            error *= 100.0 / float(np.abs(reference).max())
            entry = Outcome(**{**vars(entry), "error": error})
        found.append(entry)
    return found


def line(entry: Outcome) -> str:
    """Return an outcome as a row of the table."""
    status = "completed" if entry.status == "ok" else f"{entry.status} at {entry.reached:.3g} s"
    size = "" if np.isnan(entry.dt) else f"{1e3 * entry.dt:.3g}"
    error = "" if np.isnan(entry.error) else f"{entry.error:.2g}"
    speed = "" if np.isnan(entry.rim_speed) else f"{entry.rim_speed:.2f}"
    tilt = f"{entry.tilt:.3f}" if entry.tilt > 0.0 else ""
    return (
        f"| {entry.case} | {entry.level} | {size} | {status} | {speed} | {entry.least_axial:.2f} | "
        f"{tilt} | {1e3 * entry.peak:.4g} | {error} | {entry.ledger:.0e} | "
        f"{'no' if entry.given_back >= GIVEN_BACK else f'{entry.given_back:.0e}'} | "
        f"{'yes' if entry.sound else '**no**'} |"
    )


def write(found: list[Outcome]) -> str:
    """Return the section."""
    return render(globals(), found=found, rows=summary(found))


def summary(found: list[Outcome]) -> list[list[str]]:
    """Return a row a level: runs, how many completed or failed, errors of peaks, energy gap."""
    rows = []
    for level in ("pendulum", "contact"):
        own = [entry for entry in found if entry.level == level]
        errors = sorted(entry.error for entry in own if not np.isnan(entry.error))
        complete = sum(entry.status == "ok" for entry in own)
        part = [level, f"{len(own)}", f"{complete}", f"{len(own) - complete}"]
        sizes = [f"{errors[len(errors) // 2]:.2g}", f"{errors[-1]:.2g}"]
        rows.append([*part, *sizes, f"{max(entry.ledger for entry in own):.0e}"])
    return rows


def main() -> None:
    """Run all cases and write the page."""
    found = []
    for case in cases():
        found += run_case(case)
        print("\n".join(line(entry) for entry in found[-len(case.runs) - 1 :]), flush=True)
    found += creep()
    put(ROBUSTNESS, "hard_cases", write(found))


if __name__ == "__main__":
    main()
