"""The testing rig: a bearing on a lateral path under axial load."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np
import xarray as xr

from lir_element.argument_checks import require_choice, require_positive, unreal
from lir_element.bundles.contact_data import contact_arrays, heat_parts, initial_state
from lir_element.bundles.rigid_data import FIRST_STEP, rig_run, rigid_input, rigid_run, rigid_setup
from lir_element.device.bearing_checks import (
    AT_RIGID_BODY,
    DesignWarning,
    require_constant_friction,
)
from lir_element.device.features import ALL_LEVELS, AnyLevel
from lir_element.element import limit_detail
from lir_element.errors import RunStatus
from lir_element.interruptible import interruptible, ready
from lir_element.kernels.cyclic_kernel import begin_path, follow_path
from lir_element.kernels.rigid_body.integrate import integrate_bodies, start
from lir_element.results.dataset import (
    bearing_coordinates,
    bearing_variables,
    body_variables,
    labelled,
    report,
    require_on_failure,
)
from lir_element.results.optional_variables import optional_variables
from lir_element.units import STANDARD_GRAVITY, meant

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lir_element.bundles.contact_data import Contacts
    from lir_element.bundles.rigid_data import RigRun
    from lir_element.device.bearing import LIRBearing
    from lir_element.layout import Floats, Records

_TOO_LIGHT = 2e-3  # of the design load: kilonewtons
_TOO_FAR = 10.0  # of the radius: a path in millimetres
_INCREMENT = 0.2  # largest increment over the yield displacement of the surfaces


def cyclic_test(
    bearing: LIRBearing,
    displacement: ArrayLike,
    axial_load: float | ArrayLike,
    velocity: float = 0.02,
    level: AnyLevel = "pendulum",
    on_failure: Literal["warn", "raise"] = "warn",
) -> xr.Dataset:
    """Impose a lateral path on the top plate under axial load, plates kept parallel.

    Parameters
    ----------
    bearing : LIRBearing
        The device. The test ends by its failure: a backup belongs to a structure.
    displacement : array_like, shape (n,) or (n, 2)
        Path of the top plate, x or (x, y) [m], from the centre to the first point and on. It is
        straight between the points, in increments below a fifth of the yield displacement.
    axial_load : float or array_like, shape (n,)
        Compression held by the vertical actuator [N], linear between the points.
    velocity : float
        Speed along the path [m/s].
    level : {"pendulum", "contact", "rigid_body"}
        Level of fidelity; "rigid_body" drives the top plate, whose weight is the axial load.
    on_failure : {"warn", "raise"}
        "warn": a failure returns the results so far with a warning; "raise": it raises
        AnalysisError (whose `data` holds them).

    Returns
    -------
    xarray.Dataset
        Dimension 'step' (one entry a point), with the bearing variables of docs/results.md.

    Raises
    ------
    ValueError
        If an input is out of bounds.
    lir_element.AnalysisInterrupted
        After Ctrl-C; the `data` of the exception holds the results so far.

    Warns
    -----
    DesignWarning
        If the axial load is far below the design load: probably in kilonewtons.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=0.126)
    >>> data = cyclic_test(bearing, [0.0, 0.1, 0.185], axial_load=150e3)
    >>> round(float(data.interface_slip.sel(axis="x")[-1, 0]), 3)
    0.01
    """
    require_choice("level", level, ALL_LEVELS)
    require_on_failure(on_failure)
    path, loads = _path(displacement), _loads(axial_load, displacement)
    farthest, longest = float(np.abs(path).max()), max(bearing.radii)
    if farthest > _TOO_FAR * longest:
        msg = (
            f"displacement reaches {farthest:g} m, more than {_TOO_FAR:g} times the radius of "
            f"the plates, {longest:g} m: give metres, 150 mm as 0.15"
        )
        raise ValueError(msg)
    _tell_of_small_loads(bearing, float(loads.max()))
    speed = require_positive("velocity", velocity, "m/s")
    if level == "rigid_body":
        require_constant_friction(bearing, AT_RIGID_BODY)
    props = replace(bearing, backup=None).to_record()
    contacts = None
    if level != "pendulum":
        contacts = contact_arrays([bearing], [True], STANDARD_GRAVITY)
    largest = _INCREMENT * bearing.yield_displacement
    run = rig_run(props, initial_state(props), heat_parts(props), path, loads, speed, largest)
    status, time, reached = RunStatus(begin_path(run, contacts)), 0.0, 0
    out, v_out, bodies, last = run.states, run.velocities, run.bodies, run.new
    if status is RunStatus.OK and level == "rigid_body" and contacts is not None:
        out, bodies, reached, status, time, last = drive_path(
            props, contacts, run.old, path, loads, speed
        )
        v_out = np.ascontiguousarray(bodies["velocity"][:, 2, :2])
    elif status is RunStatus.OK:
        status = _follow(run, contacts)
        reached, time = int(run.reached[0]), float(run.clock[1])
    velocities = np.zeros((reached, 1, 3))
    velocities[:, 0, :2] = v_out[:reached]
    variables = bearing_variables("step", out[:reached, None], velocities)
    variables |= optional_variables("step", out[:reached, None], props)
    variables["time"] = labelled(("step",), out["time"][:reached], "s", "time")
    if contacts is not None:
        variables |= body_variables(
            "step", bodies[:reached, None], out["displacement"][:reached, None]
        )
    data = xr.Dataset(variables, {"step": np.arange(reached), **bearing_coordinates(["bearing"])})
    data.attrs |= {"title": "cyclic test", "level": level, "velocity": speed}
    detail = "" if status is RunStatus.OK else limit_detail(props, last, 0)
    return report(data, status, time, "bearing in the rig", detail, on_failure=on_failure)


def _follow(run: RigRun, contacts: Contacts | None) -> RunStatus:
    """Follow the path piece by piece, so that Ctrl-C is heard."""
    ready(follow_path, run, contacts, 0, 0)

    def go(last: int, increments: int) -> int:
        return follow_path(run, contacts, last, increments)

    return interruptible(go, lambda: int(run.reached[0]), len(run.path))


def _path(displacement: ArrayLike) -> Floats:
    if odd := unreal(displacement):
        msg = f"displacement {odd}"
        raise ValueError(msg)
    path = np.asarray(displacement, dtype=np.float64)
    if path.ndim == 1:
        path = np.column_stack([path, np.zeros_like(path)])
    if path.ndim != 2 or path.shape[1] != 2 or len(path) == 0:
        msg = f"displacement has shape {np.shape(displacement)}: give (n,) or (n, 2) with n >= 1"
        raise ValueError(msg)
    if not np.isfinite(path).all():
        where = int(np.argmin(np.isfinite(path).all(axis=1)))
        msg = f"displacement[{where}] = {path[where]} is not finite: remove or replace it"
        raise ValueError(msg)
    return np.ascontiguousarray(path)


def _tell_of_small_loads(bearing: LIRBearing, largest: float) -> None:
    design = bearing.resolved()["design_load"]
    if largest >= _TOO_LIGHT * design:
        return
    told = (
        f"axial_load = {largest:g} N is {largest / design:.2g} times the design load, "
        f"{design:.3g} N: {meant(largest, 'N', 0.01 * design, 10.0 * design)}"
    )
    warnings.warn(told, DesignWarning, stacklevel=3)


def _loads(axial_load: float | ArrayLike, displacement: ArrayLike) -> Floats:
    if odd := unreal(axial_load):
        msg = f"axial_load {odd}"
        raise ValueError(msg)
    count = len(np.asarray(displacement))
    loads = np.asarray(axial_load, dtype=np.float64)
    if loads.ndim > 1 or (loads.ndim == 1 and len(loads) != count):
        msg = (
            f"axial_load has shape {loads.shape}: pass one number, or one for each point, "
            f"({count},)"
        )
        raise ValueError(msg)
    loads = np.ascontiguousarray(np.broadcast_to(loads, (count,)))
    if not (np.isfinite(loads).all() and (loads > 0.0).all()):
        worst = float(loads[int(np.argmin(np.where(np.isfinite(loads), loads, -np.inf)))])
        msg = f"axial_load = {worst:g} N: it must be positive (compression) and finite everywhere"
        raise ValueError(msg)
    return loads


def drive_path(
    props: Records,
    contacts: Contacts,
    state: Records,
    path: Floats,
    loads: Floats,
    velocity: float,
) -> tuple[Records, Records, int, RunStatus, float, Records]:
    """Drive one bearing in equilibrium along a path of its top plate, as rigid bodies.

    The mass of the rig's plate is the axial load over standard gravity.

    Shapes: path (n, 2), loads (n,).
    """
    mass = np.max(loads) / STANDARD_GRAVITY
    run = rigid_run(
        props,
        contacts,
        state,
        np.full(3, mass),
        np.zeros(3),
        np.array([0, 0, 1, 0, 0, 0]),
        driven=True,
    )
    points = np.vstack([np.zeros((1, 2)), path])
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    count = len(points)
    load = np.zeros((count, 6))
    load[:, 2] = -np.concatenate([loads[:1], loads])
    times = np.concatenate([[0.0], np.cumsum(lengths / velocity)])
    given, out = rigid_input((np.zeros((2, 3)), 1.0), times, points, load)
    length = float(props["length"][0])
    largest = 0.2 * float(props["yield_displacement"].min()) / velocity
    setup = rigid_setup(length, largest)
    run.clock["step"] = min(FIRST_STEP, largest)
    start(run, given)

    def go(last: int, tries: int) -> int:
        return integrate_bodies(run, given, setup, last, tries)

    status = interruptible(go, lambda: int(run.counts["outputs"][0]), count)
    reached = int(run.counts["outputs"][0]) - 1
    time = float(run.clock["time"][0])
    return out.states[1:], out.bodies[1:], reached, status, time, run.states[2:]
