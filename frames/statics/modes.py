"""Natural modes of a frame on its bearings: the periods that an engineer checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from frames.assembly.natural_modes import UnstableError, few_modes, natural_modes
from frames.assembly.ritz import RitzSpace
from frames.model.components import bearing_axial_stiffness
from frames.model.frame_data import FrameData
from frames.statics.blas_threads import blas_threads_for
from frames.statics.gravity import at_rest, gravity, prepare
from frames.statics.gravity_state import GravityState
from frames.statics.springs import held_springs, spring_matrix
from lir_element.argument_checks import require_choice, require_type
from lir_element.texts import html_table, text_table

if TYPE_CHECKING:
    from frames._types import FloatArray, SparseMatrix
    from frames.assembly.system import System


BearingStiffness = Literal["sliding", "sticking", "fixed"]
"""Stiffness of bearings; or their lateral stiffnesses (n_bearings,) [N/m]."""


_LARGE = 1500  # displacements and rotations of nodes, above which sparse matrices are the faster
_HEAD = ("mode", "period [s]", "mass x [-]", "mass y [-]", "mass z [-]", "torsion [-]")


@dataclass(frozen=True, repr=False)
class Modes:
    """Natural modes of a frame on its bearings.

    Attributes
    ----------
    periods : ndarray, (n,)
        Periods, longest first [s].
    shapes : ndarray, (n_nodes, 6, n)
        Nodal displacements of each mode, scaled to a modal mass of 1 kg.
    mass_ratios : ndarray, (n, 3)
        Share of the total mass in the mode along x, y, z [-]; 0 if there is none.
    torsion_ratios : ndarray, (n,)
        Share of the rotational inertia about the vertical through the centre of mass in the mode
        [-]; 0 if there is none.

    Examples
    --------
    >>> from frames import modes, shear_building
    >>> from frames.demo import bearing_for
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6)
    >>> found = modes(frame, 2)
    >>> found.periods.shape, bool(found.periods[0] > 2.0)
    ((2,), True)
    """

    periods: FloatArray
    shapes: FloatArray
    mass_ratios: FloatArray
    torsion_ratios: FloatArray

    def __repr__(self) -> str:
        """Return periods and mass ratios as a table, without the shapes."""
        return text_table(self._rows(), _HEAD, left=0)

    def _repr_html_(self) -> str:
        return html_table("natural modes", self._rows(), _HEAD)

    def _rows(self) -> list[tuple[str, ...]]:
        return [
            (str(k + 1), f"{period:.4g}", *(f"{ratio:.3f}" for ratio in (*ratios, turn)))
            for k, (period, ratios, turn) in enumerate(
                zip(self.periods, self.mass_ratios, self.torsion_ratios, strict=True)
            )
        ]


def modes(
    frame: FrameData, count: int = 6, bearings: BearingStiffness | FloatArray = "sliding"
) -> Modes:
    """Return the first natural modes under gravity.

    Parameters
    ----------
    frame : Frame
        The model.
    count : int
        Number of modes, at least 1; at most those that have mass.
    bearings : {"sliding", "sticking", "fixed"} or ndarray, (n_bearings,)
        Stiffness of the bearings: the pendulum stiffness N/L sideways while sliding, their tangent
        stiffness at rest under gravity, or held rigidly (nodes i and j move together); or their
        lateral stiffnesses, for example effective ones at a displacement [N/m].

    Returns
    -------
    Modes
        Periods, shapes and participating masses.

    Raises
    ------
    ModelError
        If `count` or `bearings` is out of bounds, or a mode has no positive stiffness.

    Examples
    --------
    >>> from frames import modes, shear_building
    >>> from frames.demo import bearing_for
    >>> frame = shear_building(bearing_for(1000e3), storeys=2, storey_mass=34e3,
    ...                        storey_stiffness=40e6)
    >>> modes(frame, 2, bearings="fixed").periods.round(3).tolist()
    [0.296, 0.296]
    """
    if count < 1:
        message = f"count = {count} must be an integer of at least 1: raise it"
        raise ModelError(message)
    require_type("frame", frame, FrameData, "a Frame")
    if isinstance(bearings, str):
        require_choice("bearings", bearings, ("sliding", "sticking", "fixed"), error=ModelError)
    state = _at_rest(frame)
    system = state.system
    k = sparse.csr_array(system.stiffness + state.geometric + _mode_springs(state, bearings))
    try:
        with blas_threads_for(frame):
            if _is_large(frame):
                found = few_modes(k, system.mass, count)
            else:
                found = natural_modes(k.toarray(), system.mass.toarray(), count)
    except UnstableError as error:
        label = system.dof_labels[int(np.argmax(np.abs(error.direction)))]
        way = f'"{bearings}"' if isinstance(bearings, str) else "the stiffnesses given"
        message = (
            f'the first mode has no positive stiffness, at "{label}": the frame is unstable '
            f"under its permanent loads with bearings={way}. Reduce the loads or stiffen it"
        )
        raise ModelError(message) from error
    omega2, q = found.omega2, found.shapes
    shapes = np.asarray(system.transform @ q).reshape(-1, 6, len(omega2))
    shares = (system.inertia_load.T @ q) ** 2
    total = system.node_mass[:, :3].sum(axis=0)
    total[~total.astype(bool)] = np.inf  # a plane model: no mass moves out of its plane
    moment, turned = _turning(system)
    torsion = (turned @ q) ** 2 / (moment or np.inf)
    return Modes(2.0 * np.pi / np.sqrt(omega2), shapes, (shares / total[:, None]).T, torsion)


def _turning(system: System) -> tuple[float, FloatArray]:
    # Rotational inertia about the vertical through the centre of mass [kg m2], and the masses over
    # the free displacements (n_free,) that a unit rotation about it moves.
    mass = system.node_mass
    if not mass[:, 0].any():
        return 0.0, np.zeros(len(system.dof_labels))
    middle = np.average(system.coordinates[:, :2], axis=0, weights=mass[:, 0])
    arm = system.coordinates[:, :2] - middle
    turned = np.zeros_like(mass)
    turned[:, 0], turned[:, 1], turned[:, 5] = -arm[:, 1], arm[:, 0], 1.0
    forces = mass * turned
    moment = float(np.sum(forces * turned))
    return moment, np.asarray(system.transform.T @ forces.reshape(-1))


def _is_large(frame: FrameData) -> bool:
    return 6 * len(frame.nodes) > _LARGE


def _at_rest(frame: FrameData) -> GravityState:
    # The equilibrium; that of a large frame without its modes, which no equilibrium needs.
    if not _is_large(frame):
        return gravity(frame)
    with blas_threads_for(frame):
        prepared = prepare(frame, None, "pendulum")
        basis = RitzSpace(prepared.system, prepared.geometric, frame.damping).basis()
        return at_rest(prepared, basis, 0.0)


def _mode_springs(state: GravityState, bearings: BearingStiffness | FloatArray) -> SparseMatrix:
    devices = [placed.bearing for placed in state.system.bearings]
    values = np.zeros((len(devices), 6))
    values[:, 2] = [bearing_axial_stiffness(bearing) for bearing in devices]
    if not isinstance(bearings, str):
        values[:, :2] = np.asarray(bearings, dtype=np.float64)[:, None]
    elif bearings == "sliding":
        length = np.array([bearing.effective_radius for bearing in devices])
        values[:, :2] = (state.axial_forces / length)[:, None]
    elif bearings == "sticking":
        # the slider turns by 1/L a metre and slides R/L on both surfaces: exact at rest
        per_load = [
            sum(f.f_min * r * r for f, r in zip(b.frictions, b.radii, strict=True))
            / (b.yield_displacement * b.effective_radius**2)
            + 1.0 / b.effective_radius
            for b in devices
        ]
        values[:, :2] = (state.axial_forces * np.array(per_load))[:, None]
    else:
        return held_springs(state.system)
    return spring_matrix(state.system, values)
