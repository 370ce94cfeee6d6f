"""Statuses of an analysis, their meaning, and the errors that carry them."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from lir_element.texts import TextWarning


class RunStatus(IntEnum):
    """Outcome of a state determination or of an analysis.

    Examples
    --------
    >>> RunStatus.SLIP_EXCEEDED.meaning
    "the interface slipped further than the sliders' overlap supports: the bearing failed"
    >>> RunStatus.SLIP_EXCEEDED.is_bearing_failure, RunStatus.STEP_TOO_SMALL.is_bearing_failure
    (True, False)
    """

    OK = 0
    NOT_FINITE = 1
    NO_EQUILIBRIUM = 2
    SLIP_EXCEEDED = 3
    RIM_OVERRUN = 4
    SPHERE_EXCEEDED = 5
    NEWTON_FAILED = 6
    STEP_TOO_SMALL = 7
    SINGULAR = 8
    UPLIFTED = 9
    SLIP_UNSTABLE = 10
    INTERRUPTED = 11
    INACCURATE = 12
    NO_REST = 13
    UPLIFT_EXCEEDED = 14
    BEARING_LOST = 15

    @property
    def meaning(self) -> str:
        """Description of the status, in a sentence."""
        return _TEXT[self][0]

    @property
    def remedy(self) -> str:
        """Remedy for the status."""
        return _TEXT[self][1]

    @property
    def is_bearing_failure(self) -> bool:
        """True if the bearing itself failed (not the computation)."""
        return self in {
            RunStatus.SLIP_EXCEEDED,
            RunStatus.RIM_OVERRUN,
            RunStatus.SPHERE_EXCEEDED,
            RunStatus.SLIP_UNSTABLE,
            RunStatus.UPLIFT_EXCEEDED,
        }

    @property
    def is_complete(self) -> bool:
        """True if a run reached its end, with or without warnings."""
        return self in {RunStatus.OK, RunStatus.INACCURATE, RunStatus.BEARING_LOST}


_TEXT = {
    RunStatus.OK: ("completed", "nothing"),
    RunStatus.NOT_FINITE: (
        "a displacement, velocity or force is not finite",
        "check the input for NaN or infinite values, and the units of the motion",
    ),
    RunStatus.NO_EQUILIBRIUM: (
        "the slider found no equilibrium inside the bearing",
        "use a smaller step; check that mu_h exceeds mu_d and that the yield displacements "
        "are not extremely small",
    ),
    RunStatus.SLIP_EXCEEDED: (
        "the interface slipped further than the sliders' overlap supports: the bearing failed",
        "use a larger slider or slip_capacity, more lateral capacity, or a higher mu_h",
    ),
    RunStatus.RIM_OVERRUN: (
        "the slider overran a restraining rim: the bearing failed",
        "use more lateral capacity, or a stiffer rim (rim_stiffness, rim_overrun)",
    ),
    RunStatus.SPHERE_EXCEEDED: (
        "the slider left the concave surfaces (its axis tilted beyond 72 degrees)",
        "use rims (capacity) or larger radii; check the motion's scale",
    ),
    RunStatus.SLIP_UNSTABLE: (
        "the slip exceeded the snap-back limit L mu_h + mu_1 R_1 + mu_2 R_2: the bearing failed",
        "use a higher mu_h, or more lateral capacity",
    ),
    RunStatus.UPLIFT_EXCEEDED: (
        "the uplift exceeded uplift_capacity: the bearing failed",
        "add load on the bearing, add a device that resists tension, or raise uplift_capacity",
    ),
    RunStatus.NEWTON_FAILED: (
        "Newton's method did not converge",
        "use a smaller dt; check for a mechanism or a load above the strength of the model",
    ),
    RunStatus.STEP_TOO_SMALL: (
        "adaptive substepping reached the smallest step without convergence",
        "use another dt, add contact damping, soften axial_stiffness or rim_stiffness, or check "
        "the model",
    ),
    RunStatus.SINGULAR: (
        "the tangent stiffness is singular",
        "check for a mechanism, or for bearings that all lifted off",
    ),
    RunStatus.UPLIFTED: (
        "a bearing carries no compression under the permanent loads",
        "add weight over the bearing, or leave the bearing out",
    ),
    RunStatus.NO_REST: (
        "no equilibrium was found under the permanent loads (also tried with softer friction)",
        "check the units of masses and loads, and axial_stiffness against the load of the bearing; "
        "use a larger yield_displacement, stiffer members, or supports against a mechanism",
    ),
    RunStatus.INTERRUPTED: ("interrupted by Ctrl-C", "run it again, or use the results so far"),
    RunStatus.INACCURATE: (
        "completed, but the results are doubtful",
        "use dt=None or a smaller dt; check the step with half of it",
    ),
    RunStatus.BEARING_LOST: (
        "a bearing failed, and the run continued without it to the end",
        "check the backup support (bearing_force), or use a larger bearing",
    ),
}


class AnalysisError(RuntimeError):
    """Raised if an analysis fails: the failure, its time and place, and the remedy.

    Attributes
    ----------
    status : RunStatus
        Why it failed.
    time : float
        Time of the failure [s].
    where : str
        The bearing or degree of freedom concerned.
    detail : str
        Extent or reason; empty if there is no more to say.
    data : xarray.Dataset or None
        Results up to the failure.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing, cyclic_test
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> try:
    ...     cyclic_test(bearing, [0.0, 0.4], axial_load=150e3, on_failure="raise")
    ... except AnalysisError as error:
    ...     print(error.status.name, error.status.is_bearing_failure, len(error.data["step"]))
    SLIP_EXCEEDED True 1
    """

    def __init__(
        self, status: RunStatus, time: float, where: str, detail: str = "", data: Any = None
    ) -> None:
        self.status = status
        self.time = time
        self.where = where
        self.detail = detail
        self.data = data
        super().__init__(failure_message(status, time, where, detail))

    def __reduce__(self) -> tuple[Any, ...]:
        # an exception is made again of its message alone, which would be the wrong argument
        arguments = (self.status, self.time, self.where, self.detail, self.data)
        return type(self), arguments, self.__dict__


class AnalysisInterrupted(KeyboardInterrupt):
    """Raised by Ctrl-C in an analysis: stops loops and scripts, and keeps the results so far.

    Attributes
    ----------
    time : float
        Time that the analysis had reached [s].
    data : xarray.Dataset
        Results until then; its attribute `status` is "interrupted".

    Examples
    --------
    >>> try:
    ...     raise AnalysisInterrupted(2.5, data=None)  # as Ctrl-C does within an analysis
    ... except AnalysisInterrupted as stop:
    ...     print(str(stop).split(":")[0])
    interrupted at t = 2.5 s of the analysis
    """

    def __init__(self, time: float, data: Any) -> None:
        self.time = time
        self.data = data
        super().__init__(time, data)

    def __str__(self) -> str:
        """Return the time of the stop, and the place of the results."""
        return (
            f"interrupted at t = {self.time:.6g} s of the analysis: the results so far are "
            "in the attribute `data` of this AnalysisInterrupted"
        )


def failure_message(status: RunStatus, time: float, where: str, detail: str = "") -> str:
    """Return the sentence on a failure: its kind, time, place, and the remedy."""
    extra = f" ({detail})" if detail else ""
    return f"at t = {time:.6g} s, {where}: {status.meaning}{extra}. What to try: {status.remedy}."


class AnalysisWarning(TextWarning):
    """Warning: an analysis stopped early and returned its results so far, or is doubtful.

    Examples
    --------
    >>> import warnings
    >>> from lir_element import CoulombFriction, LIRBearing, cyclic_test
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> with warnings.catch_warnings(record=True) as told:
    ...     warnings.simplefilter("always")
    ...     test = cyclic_test(bearing, [0.0, 0.4], axial_load=150e3)
    >>> told[0].category.__name__, test.attrs["status"]
    ('AnalysisWarning', 'slip_exceeded')
    """
