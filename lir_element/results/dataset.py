"""Labelled results: bearing states as an xarray Dataset with units and names."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from lir_element._version import package_version
from lir_element.errors import (
    AnalysisError,
    AnalysisInterrupted,
    AnalysisWarning,
    RunStatus,
    failure_message,
)
from lir_element.formulas import in_plan, in_space
from lir_element.layout import PROPS_BY_NAME
from lir_element.results.deferred import deferred, spare

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy.typing as npt

    from lir_element.layout import Floats, Records

    IntArray = npt.NDArray[np.int64]

spare()

AXES = ("x", "y", "z")
SURFACES = ("bottom", "top")
DEVICE = (
    "radius",
    "length",
    "slider_radius",
    "interface_friction",
    "slip_capacity",
    "axial_stiffness",
    "yield_displacement",
    "lever",
    "rim_displacement",
    "friction_max",
    "friction_drop",
    "friction_rate",
)
"""Properties of the bearings that every Dataset keeps."""

TABLE = ("friction_table",)
PRESSURE = ("pressure_rate", "pressure_load")
SOFTENING = ("softening_scale", "softening_rate", "softening_rest")
RIMS = ("rim_yield_force", "rim_hardening", "rim_stiffness", "rim_overrun", "flange")
PRELOAD = ("interface_preload",)
"""The same of bearings whose friction is read from a table, depends on pressure, on temperature,
of those whose rims yield, and of those whose halves are held together."""

BODY_NAMES = ("bottom_slider", "top_slider", "top_plate")


def labelled(dims: tuple[str, ...], values: Any, units: str, long_name: str) -> xr.Variable:
    """Return a variable with its units and meaning."""
    return xr.Variable(dims, values, {"units": units, "long_name": long_name})


def bearing_variables(
    step: str, states: Records, velocity: Any, *, kept: bool = False
) -> dict[str, xr.Variable]:
    """Return the variables of the contract from states (n_steps, n_bearings).

    Shapes: states (n_steps, n_bearings), velocity (n_steps, n_bearings, 3).
    """

    def own(field: Floats) -> Floats:
        return field if kept else field.copy()

    def of(form: Callable[[], Floats], *shape: int) -> Any:
        return deferred((*states.shape, *shape), form) if kept else form()

    def entering(field: Floats) -> Any:  # into a deferred variable: read-only
        return of(field.copy, *field.shape[2:])

    u, f = states["displacement"], states["force"]
    each = (step, "bearing")
    vector, surface = (*each, "axis"), (*each, "surface")
    slip, passed = states["slip_total"], states["interface_force"]
    return {
        "bearing_displacement": labelled(
            vector, u[..., 6:9] - u[..., 0:3], "m", "displacement of node j relative to node i"
        ),
        "bearing_velocity": labelled(vector, velocity, "m/s", "velocity of node j relative to i"),
        "bearing_force": labelled(
            vector,
            entering(f[..., 6:9]),
            "N",
            "resisting force on node j, positive with positive displacement",
        ),
        "bearing_moment": labelled(
            (*each, "end", "axis"),
            of(lambda: np.stack([f[..., 3:6], f[..., 9:12]], axis=-2), 2, 3),
            "N m",
            "resisting moment on node i and on node j",
        ),
        "axial_force": labelled(
            each, own(states["axial_force"]), "N", "axial force, compression positive"
        ),
        "slider_displacement": labelled(
            (*surface, "axis"),
            own(states["slider_displacement"]),
            "m",
            "sliding on each concave surface",
        ),
        "interface_slip": labelled(
            vector, entering(slip), "m", "top slider relative to bottom slider"
        ),
        "interface_slip_size": labelled(
            each,
            of(lambda: in_space(slip[..., 0], slip[..., 1], slip[..., 2])),
            "m",
            "size of the interface slip",
        ),
        "slider_spin": labelled(
            each, own(states["spin"]), "rad", "spin of the sliders about their axis, mean of both"
        ),
        "interface_force": labelled(
            each,
            of(lambda: in_plan(passed[..., 0], passed[..., 1])),
            "N",
            "force that the interface passes in its plane",
        ),
        "rim_force": labelled(
            surface, entering(states["rim_force"]), "N", "radial force of each rim"
        ),
        "rim_closure": labelled(
            surface, own(states["rim_closure"]), "m", "deformation of each rim"
        ),
        "friction_coefficient": labelled(
            surface,
            own(states["friction_coefficient"]),
            "1",
            "friction coefficient of each surface",
        ),
        "sliding_speed": labelled(
            surface, own(states["sliding_speed"]), "m/s", "sliding speed on each surface"
        ),
        "torsional_moment": labelled(
            each, own(states["torque"]), "N m", "friction moment about the vertical axis"
        ),
    } | _works(step, states, own)


def _works(step: str, states: Records, own: Callable[[Floats], Floats]) -> dict[str, xr.Variable]:
    # Energy dissipated by friction, rims, contacts and sliders.
    each = (step, "bearing")
    surface = (*each, "surface")
    return {
        "work_low_friction": labelled(
            surface, own(states["work_friction"]), "J", "dissipated by low friction, each surface"
        ),
        "work_high_friction": labelled(
            each, own(states["work_interface"]), "J", "dissipated by the high-friction interface"
        ),
        "work_friction_elastic": labelled(
            each,
            own(states["work_elastic"]),
            "J",
            "stored in the elastic sliding before slip, all friction",
        ),
        "work_rims": labelled(each, states["work_rim"].sum(axis=-1), "J", "work done on the rims"),
        "work_contact": labelled(
            each, own(states["work_contact"]), "J", "work done on the axial contact"
        ),
        "work_sliders": labelled(
            each, own(states["work_sliders"]), "J", "taken up by the sliders' own mass"
        ),
    }


def body_variables(step: str, bodies: Records, displacement: Floats) -> dict[str, xr.Variable]:
    """Return places and rotations of the bodies of a bearing with contact points.

    Shapes: bodies (n_steps, n_bearings), displacement (n_steps, n_bearings, 12).
    """
    from scipy.spatial.transform import Rotation  # as slow to import as numba, for this level

    dims = (step, "bearing", "body", "axis")
    turns = Rotation.from_quat(bodies["turn"][..., :2, :].reshape(-1, 4), scalar_first=True)
    rotation = np.zeros((*displacement.shape[:2], 3, 3))
    rotation[:, :, :2] = turns.as_rotvec().reshape(*displacement.shape[:2], 2, 3)
    rotation[:, :, 2] = displacement[..., 9:12]
    moved = np.concatenate(
        [bodies["displacement"][..., :2, :], displacement[..., None, 6:9]], axis=-2
    )
    return {
        "body": xr.Variable(("body",), list(BODY_NAMES)),
        "body_position": labelled(
            dims, moved, "m", "displacement of mass centre or plate node from its undeformed place"
        ),
        "body_rotation": labelled(dims, rotation, "rad", "rotation vector of the body"),
    }


def some_bodies(
    step: str, row: IntArray, states: Records, bodies: Records
) -> dict[str, xr.Variable]:
    """Return `body_variables` of all bearings, NaN for those without contact points.

    Shapes: row (n_bearings,), states, bodies (n_steps, n_bearings).
    """
    if np.array_equal(row, np.arange(bodies.shape[1])):
        return body_variables(step, bodies, states["displacement"])
    full = np.zeros(states.shape, dtype=bodies.dtype)
    chosen = row >= 0
    full["turn"] = (1.0, 0.0, 0.0, 0.0)
    full[:, chosen] = bodies[:, row[chosen]]
    variables = body_variables(step, full, states["displacement"])
    for name in ("body_position", "body_rotation"):
        variables[name].data[:, ~chosen, :2] = np.nan
    return variables


def rims_give_way(props: Records) -> bool:
    """Return True if rims of any bearing yield, or break and let the slider go on."""
    return bool((np.isfinite(props["rim_yield_force"]) | (props["flange"] > 0.0)).any())


def device_variables(records: Records) -> dict[str, xr.Variable]:
    """Return the bearings' properties `records` (n_bearings,) that a Dataset keeps."""
    variables = {}
    names = [*DEVICE]
    names += TABLE if records["friction_table"].any() else ()
    names += PRESSURE if records["pressure_rate"].any() else ()
    names += SOFTENING if records["softens"].any() else ()
    names += RIMS if rims_give_way(records) else ()
    names += PRELOAD if records["interface_preload"].any() else ()
    for name in names:
        field = PROPS_BY_NAME[name]
        dims = ("bearing", "surface", "knot")[: 1 + len(field.shape)]
        unit = "1" if field.unit == "-" else field.unit
        variables[name] = labelled(dims, records[name].copy(), unit, field.meaning)
    return variables


def bearing_coordinates(names: Sequence[str]) -> dict[str, Any]:
    """Return the coordinates shared by all bearing variables."""
    return {
        "bearing": list(names),
        "axis": list(AXES),
        "surface": list(SURFACES),
        "end": ["i", "j"],
    }


def report(
    data: xr.Dataset,
    status: RunStatus,
    time: float,
    where: str,
    detail: str,
    *,
    on_failure: str,
    stacklevel: int = 3,
) -> xr.Dataset:
    """Write the outcome into the attributes; warn or raise on failure, warn of a given detail."""
    note_end(data, status, time, where, detail)
    data.attrs["lir_dcfp_version"] = package_version()
    if status is RunStatus.INTERRUPTED:  # for any `on_failure`: loops and scripts must stop
        raise AnalysisInterrupted(time, data)
    if "failed_at" in data.attrs and on_failure == "raise":
        raise AnalysisError(status, time, where, detail, data)
    if status is not RunStatus.OK:
        warnings.warn(data.attrs["message"], AnalysisWarning, stacklevel=stacklevel)
    elif detail:
        warnings.warn(detail, AnalysisWarning, stacklevel=stacklevel)
    return data


def note_end(data: xr.Dataset, status: RunStatus, time: float, where: str, detail: str) -> None:
    """Write the end of a run into the attributes: status, message, and the place of a failure."""
    message = "completed" + (f": {detail}" if detail else "")
    if status is RunStatus.INTERRUPTED:
        message = f"interrupted at t = {time:.6g} s"
    elif status is not RunStatus.OK:
        message = failure_message(status, time, where, detail)
        if not status.is_complete:  # else it is for the user to judge
            data.attrs |= {"failed_at": time, "failed_where": where}
    data.attrs |= {"status": status.name.lower(), "message": message}


def require_on_failure(value: str) -> None:
    """Raise unless `value` is 'warn' or 'raise'."""
    if value not in {"warn", "raise"}:
        msg = f"on_failure = {value!r}: choose 'warn' (return the computed steps) or 'raise'"
        raise ValueError(msg)
