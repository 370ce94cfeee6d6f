"""Arguments of a time history besides model and motion: options, checked on input."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from frames.bundles.run_data import CORRECTED
from frames.recording.recording import number_of_steps
from frames.solve.rigid import LARGEST_STEP
from lir_element.argument_checks import require_between, require_choice, require_positive
from lir_element.device.features import ALL_LEVELS, Features
from lir_element.results.dataset import require_on_failure

if TYPE_CHECKING:
    from collections.abc import Callable

    from frames.motion.ground_motion import GroundMotion
    from frames.recording.recording import Recording

METHODS = ("direct", "reduced")
_REDUCTION = 1e-3  # of peaks of displacement and base shear, between runs of the method "reduced"


class Options(NamedTuple):
    """Common options of all runs of an analysis."""

    duration: float
    base: float
    steps: int
    tolerance: float | None  # error of histories; infinite: fixed step; None: by level
    method: str
    integrator: str
    spectral_radius: float
    recording: Recording
    progress: Callable[[float], None] | None
    reduction: float  # tolerance of the method "reduced"


def options_of(
    motion: GroundMotion,
    duration: float | None,
    dt: float | None,
    *,
    method: str,
    integrator: str | None,
    spectral_radius: float,
    tolerance: float | None,
    recording: Recording,
    progress: Callable[[float], None] | None,
    reduction: float | None = None,
) -> Options:
    """Return the options of a run under a motion, checked: arguments as of `time_history`."""
    if tolerance is not None:
        require_between("tolerance", tolerance, 1e-12, 1e-2, "-")
    require_between("spectral_radius", spectral_radius, 0.0, 1.0 + 1e-12, "-")
    length = motion.duration if duration is None else require_positive("duration", duration, "s")
    base = motion.dt / math.ceil(motion.dt / LARGEST_STEP - 1e-9) if dt is None else dt
    steps = number_of_steps(length, dt, base)
    return Options(
        duration=length,
        base=float(base),
        steps=steps,
        tolerance=tolerance if dt is None else math.inf,
        method=method,
        integrator=integrator or "newmark",
        spectral_radius=float(spectral_radius),
        recording=recording,
        progress=progress,
        reduction=_REDUCTION if reduction is None else reduction,
    )


def check_options(
    level: object,
    method: str,
    integrator: str | None,
    on_failure: str,
    features: object,
) -> None:
    """Refuse options that are not known, or do not go together."""
    choices: list[tuple[str, object, tuple[str | None, ...]]] = [
        ("method", method, METHODS),
        ("integrator", integrator, (None, "newmark", CORRECTED, "generalised-alpha", "explicit")),
    ]
    if isinstance(level, str):
        choices.insert(0, ("level", level, (*ALL_LEVELS, "auto")))
    for name, value, allowed in choices:
        require_choice(name, value, allowed)
    if integrator == "explicit" and level != "rigid_body":
        msg = f'integrator = "explicit" belongs to level="rigid_body", not to {level!r}'
        raise ValueError(msg)
    require_on_failure(on_failure)
    if features is not None and not isinstance(features, Features):
        msg = f"features = {features!r} must be a Features, such as Features(rims=False), or None"
        raise TypeError(msg)
    if features is not None and level == "auto":
        msg = 'level = "auto" sets the features itself: leave features out, or set another level'
        raise ValueError(msg)
    if features is not None:
        _check_features(features, level)


def check_reduction(method: str, level: object, tolerance: float | None) -> None:
    """Refuse options that do not suit a method."""
    if method == "direct" and tolerance is not None:
        msg = (
            f'reduction_tolerance = {tolerance!r} needs method="reduced": set it, or leave '
            "the tolerance out"
        )
        raise ValueError(msg)
    if method == "reduced" and level == "rigid_body":
        msg = 'method = "reduced" does not support level="rigid_body": use method="direct"'
        raise ValueError(msg)
    if tolerance is not None:
        require_between("reduction_tolerance", tolerance, 1e-8, 1e-1, "-")


def _check_features(features: Features, level: object) -> None:
    refused: set[str] = set()
    if level == "rigid_body":
        refused = set(features.left_out)
    elif level not in {"pendulum", "auto"} if isinstance(level, str) else True:
        refused = set(features.left_out) & {"uplift", "vertical_coupling"}
    if refused:
        msg = (
            f"features leave out {', '.join(sorted(refused))}, which level = {level!r} always has: "
            'keep it, or use level="pendulum"'
        )
        raise ValueError(msg)
