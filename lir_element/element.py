"""One bearing as a finite element: trial, commit, revert, force, tangent, responses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.argument_checks import require_choice
from lir_element.bundles.contact_data import (
    as_rows,
    contact_arrays,
    detached,
    heat_parts,
    initial_state,
    reset,
)
from lir_element.device.features import LEVELS, Features, Level, apply
from lir_element.errors import AnalysisError, RunStatus
from lir_element.kernels import levels
from lir_element.kernels.pendulum.trial import has_no_state, is_about_to_snap, last_slip
from lir_element.layout import STATE_BY_NAME, WORK, Floats, Records
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lir_element.device.bearing import LIRBearing


class Element:
    """An LIR-DCFP bearing between node i (below) and node j (above).

    Six degrees of freedom a node: ux, uy, uz, rx, ry, rz; z upwards. Displacements are measured
    from the undeformed, unloaded bearing. Node i is at the vertex of the bottom concave surface,
    node j at that of the top one (`plate_thickness` moves them outwards); in a model they may
    coincide.

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    level : {"pendulum", "contact"}
        Level of fidelity: "pendulum" holds the sliders in full contact; "contact" has them as
        bodies whose faces press as discs, which rock, open and land (some ten times the cost).
    features : Features, optional
        Modelled features; all if None. Without vertical coupling the constant load is the bearing's
        design load. Plate rotation and the second direction belong to the displacements that are
        imposed: they cannot be left out here.

    Raises
    ------
    ValueError
        If the level is unknown, or a feature is left out that an element needs.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> element = Element(bearing)
    >>> u = np.zeros(12)
    >>> u[8] = -1e-4
    >>> element.set_trial(u, np.zeros(12), 0.0)
    >>> element.commit()
    >>> float(element.response("axial_force")) > 0.0
    True
    """

    def __init__(
        self, bearing: LIRBearing, level: Level = "pendulum", *, features: Features | None = None
    ) -> None:
        require_choice("level", level, LEVELS)
        self.bearing = bearing
        self.level = level
        self.features = Features.all() if features is None else features
        for name in ("plate_rotation", "second_direction"):
            if name in self.features.left_out:
                msg = (
                    f"{name} = False is not supported by Element: keep it True, and impose zero "
                    "motion there"
                )
                raise ValueError(msg)
        always = {"uplift", "vertical_coupling"} & set(self.features.left_out)
        if level == "contact" and always:
            msg = f'{min(always)} = False: the level "contact" always has it, use "pendulum"'
            raise ValueError(msg)
        self._props = apply(self.features, bearing.to_record(), bearing.resolved()["design_load"])
        self._start = initial_state(self._props)
        self._committed = self._start.copy()
        self._trial = self._start.copy()
        self._words = as_rows(self._committed), as_rows(self._trial)
        self._work = np.zeros(1, dtype=WORK)
        self._heat = heat_parts(self._props)
        self._contacts = None
        if level == "contact":
            self._contacts = contact_arrays([bearing], [True], STANDARD_GRAVITY)
        self._tangent = np.zeros((12, 12))
        self._has_tangent = False
        self._pending = False
        self._initial: Floats | None = None
        self.revert_to_last_commit()

    def __getstate__(self) -> dict[str, Any]:
        # copies of all arrays: a copy of an element is independent of it at once
        state = {name: value for name, value in vars(self).items() if name != "_words"}
        for name, value in state.items():
            if isinstance(value, np.ndarray):
                state[name] = value.copy()
        if self._contacts is not None:
            state["_contacts"] = detached(self._contacts)
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        # views into the records are made anew: pickles and copies separate them
        vars(self).update(state)
        self._words = as_rows(self._committed), as_rows(self._trial)
        if self._contacts is not None:
            self._contacts = detached(self._contacts)

    def __repr__(self) -> str:
        """Return level, axial force and the bearing on one line."""
        force = 1e-3 * float(self._trial["axial_force"][0])
        return f"Element(level {self.level!r}, axial force {force:.4g} kN, {self.bearing!r})"

    def set_trial(self, displacement: ArrayLike, velocity: ArrayLike, time: float) -> None:
        """Determine the trial state.

        Parameters
        ----------
        displacement, velocity : array_like, shape (12,)
            Displacements [m, rad] and velocities [m/s, rad/s] of node i, then of node j.
        time : float
            Time of the trial [s]. If it is later than the committed time, all internal rates
            (sliding speeds, closing speeds of contacts) are differences over the step and the
            tangent contains them. Otherwise the trial is static, and the sliding speeds are those
            of `velocity` at the committed place.

        Raises
        ------
        AnalysisError
            If there is no such state (not finite, beyond the spheres, no internal equilibrium).
        ValueError
            If an array has the wrong shape.
        """
        u, v = _twelve("displacement", displacement), _twelve("velocity", velocity)
        code = levels.bearing_trial(
            self._props,
            self._committed,
            self._trial,
            self._work,
            self._contacts,
            0,
            u,
            v,
            float(time),
        )
        self._has_tangent = False
        self._pending = True
        if has_no_state(code):
            self.revert_to_last_commit()
            raise AnalysisError(RunStatus(code), float(time), "bearing element")

    def resisting_force(self) -> Floats:
        """Return the resisting forces (12,) of the trial state [N, N m]."""
        return np.array(self._trial["force"][0])

    def tangent_stiffness(self) -> Floats:
        """Return the consistent tangent (12, 12) of the trial state, unsymmetric as it comes."""
        if not self._has_tangent:
            levels.bearing_tangent(
                self._props, self._trial, self._work, self._contacts, 0, self._tangent
            )
            self._has_tangent = True
        return self._tangent.copy()

    def initial_stiffness(self) -> Floats:
        """Return the stiffness (12, 12) at rest: undeformed, sticking, under the design load."""
        if self._initial is None:
            other = Element(self.bearing, self.level, features=self.features)
            options = self.bearing.resolved()
            u = np.zeros(12)
            u[8] = -options["design_load"] / options["axial_stiffness"]
            other.set_trial(u, np.zeros(12), 0.0)
            self._initial = other.tangent_stiffness()
        return self._initial.copy()

    def commit(self) -> None:
        """Accept the trial state.

        Raises
        ------
        AnalysisError
            If the state lies beyond a limit of the bearing (it is committed all the same, so that
            you can inspect it).

        Notes
        -----
        Without a new trial since the last commit or revert there is nothing to accept.
        """
        if not self._pending:
            return
        self._pending = False
        if self._contacts is not None:
            self.tangent_stiffness()  # users may read it after the commit
        levels.bearing_commit(
            self._props, self._committed, self._trial, *self._words, self._heat, self._contacts, 0
        )
        status = RunStatus(int(self._committed["status"][0]))
        if status is not RunStatus.OK:  # a trial without a state never gets here
            detail = limit_detail(self._props, self._committed, 0)
            time = float(self._committed["time"][0])
            raise AnalysisError(status, time, "bearing element", detail)

    def revert_to_last_commit(self) -> None:
        """Return to the committed state."""
        committed = self._committed
        if self._contacts is None:
            u = np.array(committed["displacement"][0])
            self.set_trial(u, np.zeros(12), float(committed["time"][0]))
        else:
            levels.bearing_look(self._props, committed, self._work, self._contacts, 0)
            self._has_tangent = False
        self._trial[:] = committed
        self._pending = False

    def revert_to_start(self) -> None:
        """Return to the undeformed, unloaded bearing at time zero."""
        self._committed[:] = self._start
        self._heat[:] = 0.0
        if self._contacts is not None:
            reset(self._contacts, [self.bearing])
        self.revert_to_last_commit()

    def response(self, name: str) -> Any:
        """Return a response of the trial state by name (see `responses`)."""
        if name not in STATE_BY_NAME:
            msg = f"response {name!r} does not exist: choose one of {', '.join(STATE_BY_NAME)}"
            raise KeyError(msg)
        value = np.array(self._trial[name][0])
        return value if value.ndim else value[()]

    @staticmethod
    def responses() -> dict[str, str]:
        """Return the names of all responses with meaning and unit."""
        return {f.name: f"{f.meaning} [{f.unit}]" for f in STATE_BY_NAME.values()}


def limit_detail(props: Records, state: Records, index: int) -> str:
    """Return the excess of a bearing over its limit, in words."""
    status = RunStatus(int(state["status"][index]))
    if status is RunStatus.SLIP_EXCEEDED:
        slip = float(np.hypot(*state["slip"][index]))
        limit = float(props["slip_capacity"][index])
        return f"slip {slip:.4g} m, slip_capacity {limit:.4g} m"
    if status is RunStatus.UPLIFT_EXCEEDED:
        limit = float(props["uplift_capacity"][index])
        return f"opening {opening_of(props, state, index):.4g} m, uplift_capacity {limit:.4g} m"
    if status is RunStatus.RIM_OVERRUN:
        way = float(props["flange"][index])
        if way > 0.0:
            beyond = state["eccentricity"][index] - props["rim_displacement"][index]
            return f"slid {float(beyond.max()):.4g} m beyond a failed rim, flange {way:.4g} m"
        closure = float((state["rim_closure"] + state["rim_bent"])[index].max())
        limit = float(props["rim_overrun"][index])
        return f"rim deformation {closure:.4g} m, rim_overrun {limit:.4g} m"
    return ""


def about_to_snap(props: Records, state: Records) -> tuple[int, str] | None:
    """Return the first bearing whose slip is about to pass its last equilibrium, and how far it is.

    There (`last_slip`) the force no longer rises, and Newton's method does not converge.

    Shapes: props, state (n,).
    """
    for k, (p, at) in enumerate(zip(props, state, strict=True)):
        if is_about_to_snap(p, at):
            slip, held = float(np.hypot(*at["slip"])), last_slip(p, at)
            return k, f"slip {slip:.4g} m, no equilibrium beyond {held:.4g} m"
    return None


def opening_of(props: Records, state: Records, index: int) -> float:
    """Return how far the contact of a bearing is open in a state, negative while it presses [m]."""
    return float(props["length"][index] - state["string"][index])


def _twelve(name: str, value: ArrayLike) -> Floats:
    array = np.ascontiguousarray(value, dtype=np.float64)
    if array.shape != (12,):
        msg = f"{name} has shape {array.shape}: it must be (12,), node i then node j"
        raise ValueError(msg)
    return array
