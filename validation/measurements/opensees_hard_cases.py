"""Hard cases with OpenSeesPy's own elements: writes docs/validation/opensees_hard_cases.md.

    python -m validation.measurements.opensees_hard_cases

Impacts, axial load through zero, extreme steps, as in `hard_cases`, with the elements of OpenSees
and the macro-model beside the element of this package. For every run: did it complete, or
stop, hang or crash; how far is it from the reference (level 'rigid_body'); does the balance of
energy close; did the device hand out more energy than it had stored. The bearing is that of the
paper (COMPDYN 2023), section 3.1, with constant friction and wide limits.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames import lumped_mass, time_history
from lir_element import CoulombFriction, Element
from lir_element.opensees import opensees
from lir_element.units import STANDARD_GRAVITY
from validation.measurements.hard_cases import given_back, outcome, quiet
from validation.measurements.hard_scenes import Case, impact, vertical
from validation.opensees.trials import (
    CODES,
    DEVICES,
    ITERATIONS,
    PLAIN,
    ROBUST,
    TOLERANCE,
    Shaken,
    Steps,
    shake,
    take_back,
)
from validation.opensees.worker import LIMIT, Worker
from validation.page import FOLDER, render
from validation.scenes import MASS, example_bearing

if TYPE_CHECKING:
    import xarray as xr

    from frames import GroundMotion
    from lir_element import LIRBearing
    from lir_element.layout import Floats

WEIGHT = MASS * STANDARD_GRAVITY
SETTINGS: tuple[tuple[Steps, float], ...] = ((PLAIN, 5e-3), (PLAIN, 1e-3), (ROBUST, 1e-3))
DT = 5e-3
NAMES = {PLAIN: "Newton", ROBUST: "fallback"}
ALIKE = 0.05
"""Axial load over the weight less one, within which energies are compared."""
STEP_SIZES = (5e-2, 2e-2, 1e-3, 1e-4, 1e-5)
STEP_SPAN = 0.5  # s


GROUPS = {
    "impacts": "impact",
    "axial load to zero": "axial load",
    "uplift": "uplift",
    "38 Hz": "38 Hz",
}
"""Kinds of cases, by words in their names."""
OFF = 5.0
"""Error of the peak from which a completed run counts as off [%]."""
MADE = 0.01
"""Energy made, over the work done on the device, from which it counts."""


class Entry(NamedTuple):
    """A row of the table: how a run ended, its peak [m], the errors and energies of it."""

    case: str
    kind: str
    model: str
    setting: str
    status: str
    reached: float = math.nan
    peak: float = math.nan
    error: float = math.nan
    """Of the peak against the reference, up to where both go [%]."""
    balance: float = math.nan
    made: float = math.nan

    @property
    def line(self) -> tuple[str, ...]:
        """The entry as a row."""
        return (
            *(self.case, self.kind, self.model, self.setting, self.ended),
            *(number(1e3 * self.peak), number(self.error, 2)),
            *(number(self.balance, 1), number(self.made, 1)),
        )

    @property
    def ended(self) -> str:
        """How the run ended."""
        if self.status == "ok":
            return "completed"
        if math.isnan(self.reached):
            return f"**{self.status}**"
        kind = self.status if self.status in CODES.values() else f"`{self.status}`"
        return f"stopped ({kind}) at {self.reached:.3g} s"


def number(value: float, digits: int = 4) -> str:
    """Return a number with some digits, nothing for NaN."""
    if math.isnan(value):
        return ""
    if 10.0**digits <= abs(value) < 1e5:
        return f"{value:.0f}"
    return f"{value + 0.0:.{digits}g}"


class Kind(NamedTuple):
    """What a group of elements models, and the bearing of ours that models the same."""

    name: str
    bearing: LIRBearing
    devices: tuple[str, ...]


def kinds() -> tuple[Kind, ...]:
    """Return the three groups."""
    bearing = example_bearing(friction=CoulombFriction(0.065), slip_capacity=3.0, rim_overrun=0.1)
    return (
        Kind("pendulum", bearing.as_dcfp(rims=False), ("singleFPBearing", "FPBearingPTV")),
        Kind("with rims", bearing.as_dcfp(), ("TripleFrictionPendulum", "TFP")),
        Kind("LIR-DCFP", bearing, ("macro-model",)),
    )


def cases() -> list[Case]:
    """Return the motions."""
    return [
        *(impact(speed, oblique=False) for speed in (0.1, 0.3, 1.0, 3.0)),
        *(impact(speed, oblique=True) for speed in (0.3, 3.0)),
        vertical("axial load down to zero, 2 Hz", 9.9, 0.5, 6.0),
        vertical("axial load creeping to a hundredth", 9.7, 3.0, 1.0),
        vertical("uplift and landing, 1.3 g", 13.0, 0.35, 6.0),
        vertical("uplift and landing, 2 g", 20.0, 0.3, 8.0),
        vertical("vertical at 38 Hz, resonance", 4.0, 1.0 / 38.0, 60.0),
    ]


def energies(done: Shaken, motion: GroundMotion, bearing: LIRBearing) -> tuple[float, float]:
    """Return how far the balance of energy stays open, and the energy that the device made."""
    if len(done.time) < 3:
        return float("nan"), float("nan")
    ground = np.column_stack(
        [np.interp(done.time, motion.time, values, right=0.0) for values in motion.components.T]
    )
    push = -MASS * ground - np.array([0.0, 0.0, WEIGHT])
    work = _work(done.force, done.displacement)
    given = _work(push, done.displacement)
    kinetic = 0.5 * MASS * (done.velocity**2).sum(axis=1)
    gap = float(np.abs(given - kinetic - work).max() / np.abs(given).max())
    pressed = np.maximum(-done.force[:, 2], 0.0)
    place = (done.displacement - (done.displacement - done.middle) * done.middle.any())[:, :2]
    reach = np.linalg.norm(place, axis=1)
    stored = 0.5 * pressed**2 / bearing.resolved()["axial_stiffness"]
    stored += 0.5 * pressed * reach**2 / bearing.effective_radius
    # like is compared with like: off the rims, which store nothing there, and under the weight
    alike = reach < 0.99 * bearing.lateral_capacity
    alike &= np.abs(pressed / WEIGHT - 1.0) < ALIKE
    taken = (work - stored)[alike]
    drop = np.maximum.accumulate(taken) - taken
    return gap, float(drop.max() / np.abs(work).max())


def _work(force: Floats, displacement: Floats) -> Floats:
    middle = 0.5 * (force[1:] + force[:-1])
    steps = (middle * np.diff(displacement, axis=0)).sum(axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def peak_until(time: Floats, displacement: Floats, end: float) -> float:
    """Return the largest horizontal displacement until a time [m]."""
    return float(np.linalg.norm(displacement[time <= end + 1e-9, :2], axis=1).max())


def reference_of(case: Case, kind: Kind, duration: float) -> xr.Dataset:
    """Run the level 'rigid_body'."""
    model = lumped_mass(kind.bearing, MASS)
    data: xr.Dataset = quiet(
        time_history, model, case.motion, duration, level="rigid_body", dt=1e-3
    )
    return data


def ours(
    case: Case, kind: Kind, level: str, dt: float, duration: float, reference: xr.Dataset
) -> Entry:
    """Run the element of this package."""
    model = lumped_mass(kind.bearing, MASS)
    data = quiet(time_history, model, case.motion, duration, dt=dt, level=level)
    found = outcome(case.name, level, dt, data)
    u = data["bearing_displacement"][:, 0].to_numpy()
    return Entry(
        case.name,
        kind.name,
        f"**element ({level})**",
        f"{1e3 * dt:g}",
        found.status,
        found.reached,
        found.peak,
        _error(data["time"].to_numpy(), u, reference),
        found.ledger,
        abs(given_back(data)),
    )


def _error(time: Floats, u: Floats, reference: xr.Dataset) -> float:
    other = reference["bearing_displacement"][:, 0].to_numpy()
    clock = reference["time"].to_numpy()
    end = min(float(time[-1]), float(clock[-1]))
    return 100.0 * abs(peak_until(time, u, end) / peak_until(clock, other, end) - 1.0)


def theirs(
    worker: Worker,
    case: Case,
    kind: Kind,
    device: str,
    dt: float,
    algorithms: Steps,
    duration: float,
    reference: xr.Dataset,
) -> Entry:
    """Run an element of OpenSees."""
    status, done = worker.run(
        shake,
        make=DEVICES[device],
        bearing=kind.bearing,
        mass=MASS,
        motion=case.motion,
        duration=duration,
        dt=dt,
        algorithms=algorithms,
    )
    setting = f"{1e3 * dt:g}, {NAMES[algorithms]}"
    if done is None:
        return Entry(case.name, kind.name, device, setting, status)
    gap, made = energies(done, case.motion, kind.bearing)
    return Entry(
        case.name,
        kind.name,
        device,
        setting,
        done.status,
        float(done.time[-1]),
        peak_until(done.time, done.displacement, np.inf),
        _error(done.time, done.displacement, reference),
        gap,
        made,
    )


def run_cases(worker: Worker) -> list[Entry]:
    """Run all cases with all elements."""
    found = []
    for case in cases():
        for kind in kinds():
            reference = reference_of(case, kind, case.duration)
            levels = (("pendulum", DT), ("contact", 1e-3))[: 1 + ("uplift" in case.name)]
            found += [ours(case, kind, level, dt, case.duration, reference) for level, dt in levels]
            for device in kind.devices:
                for algorithms, dt in SETTINGS:
                    found.append(
                        theirs(worker, case, kind, device, dt, algorithms, case.duration, reference)
                    )
        print(case.name, flush=True)
    return found


def run_steps(worker: Worker) -> list[Entry]:
    """Run an impact at steps over almost four orders."""
    case = impact(0.5, oblique=False)
    found = []
    for kind in kinds():
        reference = reference_of(case, kind, STEP_SPAN)
        for dt in STEP_SIZES:
            found.append(ours(case, kind, "pendulum", dt, STEP_SPAN, reference))
            found += [
                theirs(worker, case, kind, device, dt, PLAIN, STEP_SPAN, reference)
                for device in kind.devices
            ]
        print("steps", kind.name, flush=True)
    return found


def element_taken_back() -> float:
    """Return the element's force over friction after a trial far off that was taken back."""
    bearing = kinds()[2].bearing
    element = Element(bearing)
    squeeze = WEIGHT / bearing.resolved()["axial_stiffness"]
    rest, far = np.zeros(12), np.zeros(12)
    rest[8] = far[8] = -squeeze
    far[6] = 2e-3
    element.set_trial(rest, np.zeros(12), 0.0)
    element.commit()
    element.set_trial(far, np.zeros(12), 0.0)
    element.revert_to_last_commit()
    element.set_trial(rest, np.zeros(12), 0.0)
    element.commit()
    return float(element.resisting_force()[6] / (bearing.effective_friction * WEIGHT))


def taken_back(worker: Worker) -> list[tuple[str, str]]:
    """Return rows of what a step taken back leaves behind."""
    rows = [("**element (pendulum)**", f"{element_taken_back():.3f}")]
    for kind in kinds():
        for device in kind.devices:
            status, force = worker.run(
                take_back, make=DEVICES[device], bearing=kind.bearing, load=WEIGHT
            )
            said = status if force is None else f"{force:.3f}"
            if force is not None and np.isnan(force):
                said = "the step did not fail"
            rows.append((device, said))
    return rows


def summary(found: list[Entry]) -> list[tuple[str, ...]]:
    """Return rows of counts by model and setting."""
    rows: list[tuple[str, ...]] = []
    for model, setting in dict.fromkeys((e.model, e.setting) for e in found):
        own = [e for e in found if (e.model, e.setting) == (model, setting)]
        good = [e for e in own if e.status == "ok"]
        worst = max((e.error for e in good), default=float("nan"))
        largest = max((e.peak for e in own if not math.isnan(e.peak)), default=float("nan"))
        rows.append(
            (
                model,
                setting,
                str(len(own)),
                str(len(good)),
                str(
                    sum(
                        e.status not in {"ok", "not finite"} and not math.isnan(e.reached)
                        for e in own
                    )
                ),
                str(sum(math.isnan(e.reached) for e in own)),
                str(sum(e.status == "not finite" for e in own)),
                str(sum(e.error > OFF for e in good)),
                number(worst, 2),
                number(1e3 * largest),
                str(sum(e.made > MADE for e in own)),
            )
        )
    return rows


def group(found: list[Entry], model: str, word: str) -> str:
    """Return how many runs of a model were completed in a kind of case, and their largest error."""
    own = [e for e in found if e.model == model and word in e.case]
    good = [e.error for e in own if e.status == "ok"]
    worst = f", {number(max(good), 2)} %" if good else ""
    return f"{len(good)} of {len(own)}{worst}" if own else ""


def write(found: list[Entry], sizes: list[Entry], traces: list[tuple[str, str]]) -> str:
    """Return the page."""
    capacity = kinds()[1].bearing.lateral_capacity
    done = [e for e in found if e.status == "ok"]
    macro = [e for e in found if e.model == "macro-model"]
    lifted = [e for e in macro if "uplift" in e.case]
    return render(
        globals(),
        at_rims=[e for e in found if e.model == "TFP" and e.peak > 0.98 * capacity],
        beyond=max((e for e in macro if e.status == "ok"), key=lambda e: e.peak),
        fallback=[e.error for e in lifted if "fallback" in e.setting and e.status == "ok"],
        far=max(done, key=lambda e: e.peak),
        found=found,
        iterations=ITERATIONS,
        lifted=lifted,
        limit=LIMIT,
        lost=sum(math.isnan(e.reached) or e.status == "not finite" for e in found),
        made=max(done, key=lambda e: e.made),
        newton=[e for e in lifted if "Newton" in e.setting],
        sizes=sizes,
        tolerance=TOLERANCE,
        traces=traces,
        version=opensees().version(),
    )


def main() -> None:
    """Run all and write the page."""
    with Worker() as worker:
        page = write(run_cases(worker), run_steps(worker), taken_back(worker))
    (FOLDER / "opensees_hard_cases.md").write_text(page, encoding="utf-8")
    print(page)


if __name__ == "__main__":
    main()
