"""One random test case, run and run again: repeated, turned, mirrored, with a finer step."""

from __future__ import annotations

import math
import time
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from frames import GroundMotion, ModelError, time_history
from lir_element import AnalysisError, AnalysisWarning
from validation.fuzzing.checks import Report, check_gravity, check_result, end_of, same, same_end
from validation.fuzzing.motions import mirrored, turned
from validation.fuzzing.scenes import random_scene

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from frames import Frame
    from frames._types import FloatArray
    from validation.fuzzing.scenes import Scene

TURN = 1e-3
"""Largest change of the displacement under a turn or in a mirror, over its peak [-]."""
NOISE = 1e-9
"""Relative change of a motion that must not matter [-]."""
NOISY_RUNS = 4
"""How often it is tried: what it does to a test case that lands often is a matter of luck."""
MARGIN = 10.0
"""How many times more than that noise a turn may change [-]."""
SMALL_PEAK = 1e-3
"""Least peak that errors of a chosen step are measured against, over the effective radius [-]."""
SENSITIVE_ERROR = 1e-2
"""Error of a chosen step from which the sensitivity of the test case is asked for, too [-]."""
AUTO = 1e-2
"""Largest difference of the peak between what `level="auto"` keeps and all features [-]."""
FINER = 25
"""How many times finer the step of the reference is."""
REFERENCE_LEVELS = ("pendulum", "contact")


def run(
    scene: Scene, motion: GroundMotion, *, in_mirror: bool = False, **changes: Any
) -> tuple[Frame, xr.Dataset, list[warnings.WarningMessage]]:
    """Return the model, the result and the warnings of a test case."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = scene.build(in_mirror)
        data = time_history(model, motion, **{**scene.options_of(in_mirror), **changes})
    return model, data, caught


def try_scene(
    seed: int,
    number: int,
    *,
    level: str | None = None,
    again: bool = True,
    finer: bool = True,
    change: Callable[[Scene], Scene] | None = None,
) -> Report:
    """Run a test case with all its checks."""
    began = time.process_time()
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        scene = random_scene(seed, number, level)
        scene = scene if change is None else change(scene)
    report = Report(number, scene.describe(), scene.model, scene.level)
    try:
        model, data, caught = run(scene, scene.motion)
    except (ModelError, ValueError) as refusal:
        report.outcome, report.message = "refused", f"{type(refusal).__name__}: {refusal}"
        report.found("refused", 1.0, report.message)
    except AnalysisError as failure:
        check_gravity(report, scene.build(False), failure)
    else:
        strange = [entry for entry in caught if not issubclass(entry.category, AnalysisWarning)]
        report.doubts = [str(entry.message) for entry in (*doubts, *strange)]
        report.warnings = [str(entry.message) for entry in caught if entry not in strange]
        check_result(report, scene, model, data)
        if again:
            compare_runs(report, scene, model, data, finer=finer)
    report.seconds = time.process_time() - began
    return report


def compare_runs(
    report: Report, scene: Scene, model: Frame, data: xr.Dataset, *, finer: bool
) -> None:
    """Run the test case again in all ways and compare."""
    rng = np.random.default_rng((scene.seed, scene.number, 9))
    angle = rng.uniform(0.2, 6.0)
    if differs := same(data, run(scene, scene.motion)[1]):
        report.found("repeat", 1.0, f"{differs} differs in a second run")
    turned_too = []
    if scene.is_axisymmetric:
        points = any(link.bearing.contact_points for link in model.bearings.values())
        if scene.level != "pendulum" and points:  # they look the same in quarter turns only
            angle = 0.5 * math.pi * float(rng.integers(1, 4))
        other = run(scene, turned(scene.motion, angle))[1]
        report.turn = change(data, _turned_back(other, angle))
        turned_too.append(("turn", report.turn, other))
    other = run(scene, mirrored(scene.motion), in_mirror=True)[1]
    report.mirror = change(data, _mirrored_back(scene, other))
    turned_too.append(("mirror", report.mirror, other))
    if finer and report.controlled and scene.level in REFERENCE_LEVELS:
        step = data.attrs["dt"] / FINER
        reference = run(scene, scene.motion, dt=step, record_every=FINER)[1]
        if not compare_steps(report, model, data, reference):
            _judge_ends(report, scene, data, reference)
    if scene.level == "auto":
        whole = run(scene, scene.motion, level=data.attrs["level"])[1]
        if feature_error(data, whole) > AUTO:
            report.sensitivity = sensitivity(scene, data)[0]
            compare_features(report, data, whole)
    for kind, changed, other in turned_too:
        if changed > TURN or end_of(data) != end_of(other):
            _judge(report, scene, data, kind, changed, other)
    if (report.peak_error or 0.0) > SENSITIVE_ERROR and report.sensitivity is None:
        report.sensitivity = sensitivity(scene, data)[0]


def _judge(
    report: Report, scene: Scene, data: xr.Dataset, kind: str, changed: float, other: xr.Dataset
) -> None:
    # A change is a finding where one of the motion's ninth digit does not do nearly as much.
    report.sensitivity, ends = sensitivity(scene, data)
    status, theirs = end_of(data), end_of(other)
    if changed > max(TURN, MARGIN * report.sensitivity):
        words = f"the displacement changes by {100.0 * changed:.3g} % of its peak"
        report.found(kind, changed, words)
    if theirs != status and ends == {status} and report.sensitivity < TURN:
        words = f"{data.attrs['message']} -- other: {other.attrs['message']}"
        report.found(f"{kind} ends differently", 1.0, words)


def sensitivity(scene: Scene, data: xr.Dataset) -> tuple[float, set[str]]:
    """Return how much the result changes with the motion's last digits, and how it then ends."""
    rng = np.random.default_rng((scene.seed, scene.number, 10))
    changed, ends = [], set()
    for _ in range(NOISY_RUNS):
        x, y, z = scene.motion.components.T
        noise = NOISE * rng.uniform(-1.0, 1.0, (3, len(x)))
        size = np.hypot(x, y)  # so that a motion in a plane is not kept in it
        x, y, z = x + noise[0] * size, y + noise[1] * size, z + noise[2] * z
        other = run(scene, GroundMotion(x=x, y=y, z=z, dt=scene.motion.dt, name="random"))[1]
        changed.append(change(data, other))
        ends.add(end_of(other))
    return max(changed), ends


def _judge_ends(report: Report, scene: Scene, data: xr.Dataset, reference: xr.Dataset) -> None:
    # Another end at a finer step is a finding where the motion's ninth digit does not change it.
    report.sensitivity, ends = sensitivity(scene, data)
    if ends == {end_of(data)} and report.sensitivity < TURN:
        words = f"{data.attrs['message']} -- finer: {reference.attrs['message']}"
        report.found("finer ends differently", 1.0, words)


def compare_steps(report: Report, model: Frame, data: xr.Dataset, reference: xr.Dataset) -> bool:
    """Put the errors of the chosen step into the report; return whether both ends are the same."""
    ours, theirs = places(data), places(reference)
    count = min(len(ours), len(theirs))
    peaks = [float(np.linalg.norm(u[:count], axis=-1).max()) for u in (ours, theirs)]
    scale = max(peaks[1], SMALL_PEAK * float(data["length"].min()))
    report.peak_error = abs(peaks[0] - peaks[1]) / scale
    off = float(np.linalg.norm(ours[:count] - theirs[:count], axis=-1).max())
    report.path_error = off / scale
    return same_end(model, data, reference, min(off, SENSITIVE_ERROR * scale))


def feature_error(data: xr.Dataset, whole: xr.Dataset) -> float:
    """Return the error of the peak of `level="auto"` against all features at its level [-]."""
    peaks = [float(np.linalg.norm(places(d), axis=-1).max()) for d in (data, whole)]
    return abs(peaks[0] - peaks[1]) / max(peaks[1], _least(data))


def compare_features(report: Report, data: xr.Dataset, whole: xr.Dataset) -> None:
    """Find features that should not have been left out; noise counts as for turns."""
    off = feature_error(data, whole)
    if off > max(AUTO, MARGIN * (report.sensitivity or 0.0)):
        out = data.attrs["features_left_out"]
        report.found("auto", off, f"the peak is off by {100.0 * off:.3g} %, left out: {out}")


def places(data: xr.Dataset) -> FloatArray:
    """Return the horizontal displacements of the bearings (time, bearing, 2)."""
    values = data["bearing_displacement"].sel(axis=["x", "y"])
    return np.asarray(values.transpose("time", "bearing", "axis").to_numpy(), dtype=np.float64)


def _least(data: xr.Dataset) -> float:
    # A displacement that counts as none: a ten thousandth of the effective radius.
    return 1e-4 * float(data["length"].min())


def _turned_back(data: xr.Dataset, angle: float) -> xr.Dataset:
    x, y = (data["bearing_displacement"].sel(axis=a) for a in "xy")
    c, s = math.cos(angle), math.sin(angle)
    moved = data["bearing_displacement"].copy(deep=True)
    moved.loc[{"axis": "x"}] = c * x + s * y
    moved.loc[{"axis": "y"}] = c * y - s * x
    return data.assign(bearing_displacement=moved)


def _mirrored_back(scene: Scene, data: xr.Dataset) -> xr.Dataset:
    moved = data["bearing_displacement"].copy(deep=True)
    moved.loc[{"axis": "y"}] *= -1.0
    images = scene.images()
    if len(images) > 1:
        moved = moved.sel(bearing=list(images.values())).assign_coords(bearing=list(images))
    return data.assign(bearing_displacement=moved)


def change(data: xr.Dataset, other: xr.Dataset) -> float:
    """Return the largest difference of the displacements of two results, over the peak [-]."""
    one, two = places(data), places(other)
    count = min(len(one), len(two))
    scale = max(float(np.linalg.norm(one, axis=-1).max()), _least(data))
    return float(np.linalg.norm(one[:count] - two[:count], axis=-1).max()) / scale
