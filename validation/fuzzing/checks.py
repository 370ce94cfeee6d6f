"""What must hold in every result of a random test case, whatever became of the run."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from frames import energy_error
from frames.assembly.assemble import assemble
from frames.statics.springs import guessed_springs, spring_forces
from lir_element import RunStatus

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray
    from lir_element import AnalysisError
    from validation.fuzzing.scenes import Scene

LEDGER = 1e-3
"""Largest gap, and largest numerical term, of the energy balance over the input [-]."""
SMALL_INPUT = 1e-6
"""Input below which the energy balance is not looked at, over weight times effective radius [-]."""
GIVEN_BACK = -1e-9
"""Largest step back of a dissipated energy, and least store, over its largest value [-]."""
BALANCE = 1e-4
"""Largest unbalanced force on the whole structure, over weight and largest force [-]."""
WORKS = 1e-3
"""Largest difference of the work of the forces in the Dataset and in the energy balance [-]."""
UNLIMITED = {"rim_displacement", "interface_friction", "rim_plastic"}
"""Variables that may be infinite: without rims, with a rigid slider, of a rim that broke."""
STATUSES = {status.name.lower() for status in RunStatus}


@dataclass
class Report:
    """What came out of a test case."""

    number: int
    scene: str
    model: str
    level: str
    outcome: str = "?"
    """"ok", the name of a status, "refused", or how the run died."""
    message: str = ""
    warnings: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)
    """What was found strange about the bearing or the model before the run."""
    findings: list[tuple[str, float, str]] = field(default_factory=list)
    """Kind, size and words of all that must not be."""
    has_uplift: bool = False
    has_rim: bool = False
    controlled: bool = False
    """Whether the program chose the step."""
    ledger: float = 0.0
    numerical: float = 0.0
    turn: float | None = None
    """Largest change of the displacement where the motion is turned, over its peak [-]."""
    mirror: float | None = None
    """The same where everything is seen in a mirror."""
    sensitivity: float | None = None
    """The same where the motion changes in its ninth digit; None where nobody asked."""
    peak_error: float | None = None
    """Of the peak displacement against a step 25 times finer [-]."""
    path_error: float | None = None
    """Largest difference of the displacement from the same, over the peak [-]."""
    seconds: float = 0.0

    def found(self, kind: str, size: float, words: str) -> None:
        """Add a finding."""
        self.findings.append((kind, float(size), words))

    def as_dict(self) -> dict[str, Any]:
        """Return what goes into a file of results."""
        return asdict(self)


def check_gravity(report: Report, model: Frame, failure: AnalysisError) -> None:
    """Write an equilibrium that was not found into the report; a bearing that is pulled has none.

    Uplift is believed where a bearing is in tension with all of them as linear springs.
    """
    report.outcome, report.message = failure.status.name.lower(), str(failure)
    if failure.status is not RunStatus.UPLIFTED or forces_on_springs(model).min() >= 0.0:
        report.found("gravity", 1.0, report.message)


def forces_on_springs(model: Frame) -> FloatArray:
    """Return the bearings' axial forces with springs in their place, compression positive [N]."""
    system = assemble(model)
    stiffness = sparse.csc_array(system.stiffness + guessed_springs(system))
    return spring_forces(system, spsolve(stiffness, system.load))


def check_result(report: Report, scene: Scene, model: Frame, data: xr.Dataset) -> None:
    """Check a result by itself and write what must not be into the report."""
    attrs = data.attrs
    report.outcome, report.message = attrs["status"], attrs["message"]
    report.controlled = attrs["step_control"] == "error"
    report.has_uplift = bool((data["axial_force"] <= 0.0).any())
    report.has_rim = bool((data["rim_force"] > 0.0).any())
    for kind, size, words in (
        *_end(scene, data, report.warnings),
        *_numbers(data),
        *_limits(model, data),
        *_ledger(report, data),
        *_friction(data),
        *(_balance(scene, model, data) if len(data["time"]) > 1 else ()),
    ):
        report.found(kind, size, words)


def _end(scene: Scene, data: xr.Dataset, warned: Sequence[str]) -> Iterator[tuple[str, float, str]]:
    # A run completes, or says when, where and what to try.
    status, last = data.attrs["status"], float(data["time"][-1])
    if status not in STATUSES:
        yield "end", 1.0, f"unknown status {status!r}"
    if status in {"ok", INACCURATE} and last < scene.options["duration"] - 1e-9:
        yield "end", last, f"{status}, but ended at {last:g} s"
    message = data.attrs["message"]
    if status == "ok":
        if message != "completed" and message.removeprefix("completed: ") not in warned:
            yield "end", last, f"no warning of what the message says: {message}"
        return
    if "What to try" not in message:
        yield "end", last, f"a message without a remedy: {message}"
    if message not in warned:
        yield "end", last, f"{status} without a warning"
    if status == INACCURATE:
        return
    failed_at = data.attrs.get("failed_at", np.nan)
    if f"{failed_at:.6g}" not in message:
        yield "end", last, f"a message without the time: {message}"
    if not data.attrs.get("failed_where"):
        yield "end", last, "a failure without place"
    if failed_at < last - 1e-9:
        yield "end", last, f"failed at {failed_at:g} s, before the last output"


def _numbers(data: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    # Nothing is NaN; nothing infinite but what has no limit.
    for name, variable in data.items():
        values = variable.to_numpy()
        fine = ~np.isnan(values) if name in UNLIMITED else np.isfinite(values)
        if not fine.all() and not str(name).startswith("body"):
            yield "not finite", float((~fine).sum()), f"{name} is not finite"


def _limits(model: Frame, data: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    # No bearing is computed on beyond its limits; axial forces do not pull.
    if float(data["axial_force"].min()) < 0.0:
        yield "limits", float(data["axial_force"].min()), "an axial force that pulls"
    failed = data.attrs["status"] in FAILED_BEARINGS
    for name, link in model.bearings.items():
        limits, own = link.bearing.resolved(), data.sel(bearing=name)
        slip = own["interface_slip_size"].where(own["axial_force"] > 0.0, 0.0)
        for what, value in (("slip_capacity", slip), ("rim_overrun", own["rim_closure"])):
            if what == "rim_overrun" and link.bearing.flange is not None:
                continue  # the slider goes on
            excess = float(value.max()) / limits[what] - 1.0
            if excess > 1e-9 and not failed:
                yield "limits", excess, f"{name}: {what} exceeded by {100.0 * excess:.3g} %"


def _ledger(report: Report, data: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    # The energy balance closes, without what is only called numerical; or the status says otherwise.
    supplied = float(np.abs(data["energy"].sel(term="input")).max())
    floor = SMALL_INPUT * float(data["weight"]) * float(data["length"].min())
    if supplied <= floor:
        return
    report.ledger = energy_error(data)
    report.numerical = float(np.abs(data["energy"].sel(term="numerical")).max()) / supplied
    status = data.attrs["status"]
    if report.ledger > LEDGER and status != INACCURATE:
        yield "ledger", report.ledger, f"gap of {100.0 * report.ledger:.3g} % of the input"
    share = f"{100.0 * report.numerical:.3g} %"
    if report.numerical > LEDGER and status == "ok" and share not in data.attrs["message"]:
        yield "numerical", report.numerical, f"numerical term of {share} of the input, and no word"


def _friction(data: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    # Friction never gives energy back, and its elastic part never more than it stored.
    count = len(data["time"])
    for name in ("work_low_friction", "work_high_friction"):
        work = data[name].to_numpy().reshape(count, -1)
        if count > 1 and work.max() > 0.0:
            least = float(np.diff(work, axis=0).min() / work.max())
            if least < GIVEN_BACK:
                yield "given back", least, f"{name} falls by {-100.0 * least:.3g} % of its end"
        elif work.min() < 0.0:
            yield "given back", float(work.min()), f"{name} is negative"
    store = data["work_friction_elastic"].to_numpy()
    share = float(store.min()) / max(float(store.max()), 1e-300)
    if share < GIVEN_BACK:
        yield "store", share, f"elastic store of friction at {100.0 * share:.3g} % of its largest"


def _balance(scene: Scene, model: Frame, data: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    # The accelerations of the Dataset balance its forces, and those do the energy balance's work.
    if not scene.is_newmark or scene.model == "frame":  # a frame's steel is not in its masses
        return
    weight = float(data["weight"])
    total = data["base_shear"].to_numpy() + np.array([0.0, 0.0, weight])
    for node, mass in model.masses.items():
        total = total + mass[0] * data["node_acceleration"].sel(node=node).to_numpy()[:, :3]
    scale = max(weight, float(np.abs(data["base_shear"]).max()))
    worst = float(np.abs(total).max()) / scale
    if worst > BALANCE:
        yield "balance", worst, f"masses times accelerations are off by {worst:.3g} of the load"
    if data.sizes["bearing"] > 1 or data.attrs.get("halvings", 1) or scene.level == "auto":
        return
    moved = np.diff(_six(data, scene), axis=0)
    force = data["bearing_force"].to_numpy()[:, 0]
    done = float((0.5 * (force[1:] + force[:-1]) * moved).sum())
    # what friction owes the energy balance, having turned within a step, stands in 'numerical'
    terms = [
        "low_friction_bottom",
        "low_friction_top",
        "high_friction",
        "friction_elastic",
        "rims",
        "contact",
        "sliders",
        "numerical",
    ]
    if scene.model == "tilting mass":
        return
    said = float(data["energy"].sel(term=terms).isel(time=-1).sum())
    scale = float(np.abs(data["energy"]).max())
    if scale > SMALL_INPUT * weight * scene.length and abs(done - said) > WORKS * scale:
        yield (
            "works",
            abs(done - said) / scale,
            "the forces' work is not that of the energy balance",
        )


def _six(data: xr.Dataset, scene: Scene) -> FloatArray:
    # Displacement of the bearing (time, 3).
    return np.asarray(data["bearing_displacement"].to_numpy()[:, 0], dtype=np.float64)


def same(one: xr.Dataset, other: xr.Dataset) -> str:
    """Return the name of the first variable or attribute that differs in a bit, or nothing."""
    for name, values in one.items():
        if values.to_numpy().tobytes() != other[name].to_numpy().tobytes():
            return str(name)
    for name, value in one.attrs.items():
        if name.startswith("seconds") or name == "auto_runs":
            continue
        if repr(value) != repr(other.attrs[name]):
            return str(name)
    return ""


INACCURATE = "inaccurate"
"""Status of a run that went to its end, with a energy balance that is open."""
FAILED_BEARINGS = {status.name.lower() for status in RunStatus if status.is_bearing_failure}
LATE = 0.1
"""Largest difference of the times at which a bearing fails, over the earlier one [-]."""
_STEEPEST = math.radians(72.0)


def end_of(data: xr.Dataset) -> str:
    """Return how a run ended; one whose energy balance is open went to its end, too."""
    status = str(data.attrs["status"])
    return "ok" if status == INACCURATE else status


def same_end(model: Frame, data: xr.Dataset, finer: xr.Dataset, error: float) -> bool:
    """Return whether two runs at different steps end alike.

    A bearing that fails must fail in both, at about the same time; which of its limits it passes
    first is a matter of the step once a slider rocks on an edge. Where one run completes, it must
    about then have come as near to the limit that the other passed as `error`.
    """
    ends = end_of(data), end_of(finer)
    if ends[0] == ends[1]:
        return True
    if set(ends) <= FAILED_BEARINGS:
        times = sorted(float(result.attrs["failed_at"]) for result in (data, finer))
        return times[1] <= (1.0 + LATE) * times[0]
    if "ok" in ends and set(ends) & FAILED_BEARINGS:
        completed, failed = (data, finer) if ends[0] == "ok" else (finer, data)
        until = (1.0 + LATE) * float(failed.attrs["failed_at"])
        return left_over(model, completed.sel(time=slice(0.0, until)), end_of(failed)) <= error
    return False


def left_over(model: Frame, data: xr.Dataset, status: str) -> float:
    """Return how far a run stayed away from the limit that a status names."""
    least = math.inf
    for name, link in model.bearings.items():
        limits, own = link.bearing.resolved(), data.sel(bearing=name)
        slip = own["interface_slip_size"].where(own["axial_force"] > 0.0, 0.0)
        if status == "slip_exceeded":
            left = limits["slip_capacity"] - slip
        elif status == "rim_overrun":
            left = limits["rim_overrun"] - own["rim_closure"]
        elif status == "slip_unstable":  # beyond L mu_h + mu_1 R_1 + mu_2 R_2, docs/theory.md, 2
            held = (own["friction_coefficient"] * own["radius"]).sum("surface")
            left = link.bearing.effective_radius * own["interface_friction"] + held - slip
        else:
            moved = np.linalg.norm(own["bearing_displacement"].sel(axis=["x", "y"]), axis=-1)
            left = link.bearing.effective_radius * math.sin(_STEEPEST) - moved
        least = min(least, float(np.min(left)))
    return least
