"""Equilibrium of the isolated structure as a whole, and nodes that are accelerated beyond reason.

Both are formed from records: forces of bearings against weight and inertia, about all axes about
which the structure is held by its bearings alone.

A displacement without mass has an acceleration, the second derivative of a static one. It jumps
when friction reverses or slips, and no step resolves it. In Newmark's rule it rings from step to
step, undamped, and negligible masses ring so fast that no step follows. Masses are accelerated by
the forces on them. The rest moves with the elastic structure, with unchanged forces of bearings and
nonlinear parts on it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from frames.assembly.solvers import Factors
from frames.model.components import bearing_axial_stiffness
from frames.results.formulas import VIOLENT
from frames.results.peak_response import Extreme, extreme_of, larger_of
from frames.statics.springs import spring_matrix

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, IntArray, SparseMatrix
    from frames.bundles.run_data import Output
    from frames.statics.gravity_state import GravityState
    from lir_element.layout import Records

FASTEST = 1e-3
"""Own period of a displacement, all others held, over sqrt(L / g) of the bearings, below which its
mass counts as none: half a millisecond, a tenth of the largest step (a choice).
"""

LIGHTEST = 1e-3
"""Further condition for translations: their mass over that on a bearing, because floors' masses on
stiff ties are not negligible (a choice).
"""


def accelerating(state: GravityState, stiffness: SparseMatrix, light: BoolArray) -> FloatArray:
    """Return how accelerations of b and eta accelerate the free degrees of freedom.

    Shapes: stiffness (n_free, n_free) on bearings pressed as at rest, light (n_free,), result
    (n_free, n_b + n_e).
    """
    basis = state.basis
    found = np.hstack([basis.expand_b, basis.mass_e * basis.expand_e])
    if not _carries_along(state, light):
        return found  # the rest does so in these coordinates
    inner = sparse.csr_array(stiffness[light][:, light])
    alone = inner.diagonal() <= 0.0
    if alone.any():  # held by nothing that is linear: not accelerated
        inner = sparse.csr_array(inner + sparse.diags_array(alone.astype(np.float64)))
    right = np.asarray(stiffness[light][:, ~light] @ found[~light])
    found[light] = -Factors(inner).solve(right)
    return found


def _carries_along(state: GravityState, light: BoolArray) -> bool:
    # True if a DOF of little or no mass is not one that the basis has without mass.
    return bool(light[state.basis.bearing_dofs].any() or _has_light_nodes(state, light))


def _has_light_nodes(state: GravityState, light: BoolArray) -> bool:
    # True if a displacement of the structure has so little mass that it counts as none.
    return bool((light & (state.system.mass.diagonal() > 0.0)).any())


def without_inertia(state: GravityState, held: FloatArray) -> BoolArray:
    """Return which free degrees of freedom have no mass, or so little that no step follows it.

    Shapes: held (n_free,) the stiffness that holds each by itself, result (n_free,).
    """
    system = state.system
    mass = system.mass.diagonal()
    length = min(placed.bearing.effective_radius for placed in system.bearings)
    rate = 2.0 * math.pi / (FASTEST * math.sqrt(length / system.gravity))
    carried = float(system.node_mass[:, :3].mean(axis=1).sum()) / len(system.bearings)
    turns = np.array([label.rsplit(" ", 1)[1].startswith("r") for label in system.dof_labels])
    fast = (held > rate**2 * mass) & (turns | (mass < LIGHTEST * carried))
    return np.asarray(~(mass > 0.0) | fast)


def _springs(state: GravityState) -> FloatArray:
    # The bearings pressed as at rest: the restoring stiffness of the pendulum, and the axial
    # contact.
    system = state.system
    values = np.zeros((len(system.bearings), 6))
    for k, (_, _, _, bearing) in enumerate(system.bearings):
        values[k, :2] = state.axial_forces[k] / bearing.effective_radius
        values[k, 2] = bearing_axial_stiffness(bearing)
    return values


RESULTANTS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
"""Forces along the axes, and moments about those through the middle of the bearings."""

_HELD = 1e-9  # of the stiffness against a motion, part by part, below which nothing holds it
_AT_ONCE = 256  # steps, of which the accelerations of all nodes are formed together


class Resultants:
    """Sums of all forces on the parts that only bearings support.

    A rigid motion q_r of the parts of the structure without supports causes no elastic force.
    ``q_r' (M a + K_g q + B' f - p)`` is the sum of inertia, of the axial forces' effect on
    displacements, of bearing forces and of loads. In equilibrium it is zero. Sums with forces of
    supports or of fixed rotations of a node are not formed.
    """

    def __init__(self, state: GravityState) -> None:
        system, basis = state.system, state.basis
        motions, formed, extent = _rigid_motions(state)
        weight = float(abs(motions[:, 2] @ system.load)) or float(np.abs(system.load).sum()) or 1.0
        scale = np.where(np.arange(6) < 3, weight, weight * extent)
        self.names = tuple(
            name for name, is_formed in zip(RESULTANTS, formed, strict=True) if is_formed
        )
        """Sums that are formed, of `RESULTANTS`."""
        motions = (motions / scale)[:, formed]
        whole = np.hstack([basis.expand_b, basis.expand_e])
        if state.parts is not None:
            whole = np.hstack([whole, -state.part_shift])
        stiffness = sparse.csr_array(system.stiffness + state.geometric)
        self._over_x = np.asarray(stiffness @ motions).T @ whole
        if state.parts is not None:
            self._over_x[:, basis.expand_b.shape[1] + basis.expand_e.shape[1] :] += np.asarray(
                system.part_rows @ motions
            ).T
        self._rest = np.asarray(stiffness @ motions).T @ basis.offset - motions.T @ system.load
        present = sparse.csr_array(stiffness + spring_matrix(system, _springs(state)))
        self._basis, self._held = basis, stiffness.diagonal()
        ends = np.arange(12 * len(system.bearings)).reshape(-1, 2, 6)
        moves = system.bearing_rows[ends[:, 1].ravel()] - system.bearing_rows[ends[:, 0].ravel()]
        self._give = sparse.csr_array(moves.multiply(moves))  # of each spring between its ends
        self._light = without_inertia(state, present.diagonal())
        self.accelerating = accelerating(state, present, self._light)
        """Accelerations of the free displacements by those of b and eta, (n_free, n)."""
        self.has_light_nodes = _has_light_nodes(state, self._light)
        """True if nodes have so little mass that no step follows it."""
        self._over_a = np.asarray(system.mass @ motions).T @ self.accelerating
        self._over_ground = motions.T @ system.inertia_load
        self._over_force = np.asarray(system.bearing_rows @ motions).T
        self.nodes = _Nodes(state)
        """Nodes with mass."""

    def serves(self, state: GravityState) -> bool:
        """Return whether these are the sums of the same structure on other bearings."""
        if state.basis is not self._basis or _carries_along(state, self._light):
            return False
        held = self._held + _springs(state).ravel() @ self._give
        return np.array_equal(without_inertia(state, held), self._light)

    def of(
        self, out: Output, states: Records, ground: FloatArray, first: int, last: int
    ) -> FloatArray:
        """Return the sum of all forces at rows first <= k < last of the recorded steps."""
        rows = slice(first, last)
        x = np.hstack([out.b[rows], out.e[rows], out.beyond[rows]])
        rates = np.hstack([out.a_b[rows], out.a_e[rows]])
        found = _times(x, self._over_x) + _times(rates, self._over_a)
        found += _times(np.asarray(ground), self._over_ground)
        found += _times(states["force"][rows].reshape(last - first, -1), self._over_force)
        return np.asarray(found + self._rest)


def _times(steps: FloatArray, rows: FloatArray) -> FloatArray:
    # Rows times each step: the same to the last digit for any number of steps at once.
    return np.asarray(np.einsum("ti,ki->tk", steps, rows))


def _rigid_motions(state: GravityState) -> tuple[FloatArray, FloatArray, float]:
    # Rigid motions (n_free, 6) of the parts on bearings alone, those without other resistance, and
    # half the extent of the structure.
    system = state.system
    transform = sparse.csr_array(system.transform)
    ends = [placed.i for placed in system.bearings]
    arms = system.coordinates - system.coordinates[ends].mean(axis=0)
    x, y, z = arms.T
    nodes = np.zeros((len(arms), 6, 6))
    nodes[:, range(6), range(6)] = 1.0
    for row, column, value in ((1, 3, -z), (2, 3, y), (0, 4, z), (2, 4, -x), (0, 5, -y), (1, 5, x)):
        nodes[:, row, column] = value
    square = sparse.csr_array(transform.T @ transform)
    motions = Factors(square).solve(np.asarray(transform.T @ nodes.reshape(-1, 6)))
    part = _parts(state)
    stiff = system.stiffness
    held = np.stack([motions * np.asarray(stiff @ motions), motions**2 * stiff.diagonal()[:, None]])
    by_part = np.zeros((2, part.max() + 1, 6))
    for kind in range(2):
        np.add.at(by_part[kind], part, held[kind])
    rests = np.abs(by_part[0]) <= _HELD * by_part[1]
    stands = rests[:, :3].all(axis=1)
    motions[~stands[part]] = 0.0
    damped = np.abs(np.asarray(system.damping @ motions)).max(axis=0, initial=0.0)
    size = float(abs(system.damping).max()) if system.damping.nnz else 0.0
    moves = np.abs(motions).max(axis=0) > 0.0
    extent = 0.5 * float(np.ptp(arms, axis=0).max()) or 1.0
    formed = rests[stands].all(axis=0) & moves & (damped <= _HELD * size)
    return motions, formed, extent


def _parts(state: GravityState) -> IntArray:
    # Parts of the structure that bearings alone connect, by free displacement.
    system = state.system
    pattern = abs(system.stiffness) + abs(system.mass)
    return np.asarray(csgraph.connected_components(pattern, directed=False)[1], dtype=np.int64)


class _Nodes:
    # Nodes with mass that can move, the smallest of these masses, their translations over the free
    # displacements.

    def __init__(self, state: GravityState) -> None:
        mass, transform = moving_mass(state), sparse.csr_array(state.system.transform)
        self.places = np.flatnonzero(mass.max(axis=1) > 0.0)
        self.least = float(mass.max(axis=1)[self.places].min())
        self.rows = sparse.csr_array(transform[(6 * self.places[:, None] + np.arange(3)).ravel()])


class Plausibility:
    """Keeps how far the forces of a run were from equilibrium, and how violently nodes moved."""

    def __init__(self, state: GravityState, resultants: Resultants) -> None:
        self._state, self._resultants, self._nodes = state, resultants, resultants.nodes
        self._reached: dict[str, Extreme] = {}

    def take(self, out: Output, states: Records, ground: FloatArray, first: int, last: int) -> None:
        """Add rows first <= k < last of the recorded steps; arguments as `Resultants.of`."""
        if first >= last:
            return
        time = out.time[first:last]
        gaps = np.abs(self._resultants.of(out, states, ground, first, last))
        self._keep("imbalance", extreme_of(gaps, time))
        self._keep("violence", self._violence(out, ground, first, last))

    def reached(self) -> dict[str, Extreme]:
        """Return the peaks by quantity."""
        return dict(self._reached)

    def _keep(self, name: str, now: Extreme) -> None:
        before = self._reached.get(name)
        self._reached[name] = now if before is None else larger_of(before, now)

    def _violence(self, out: Output, ground: FloatArray, first: int, last: int) -> Extreme:
        # No node has more energy of acceleration than all: others need not be looked at.
        basis, rows = self._state.basis, slice(first, last)
        a_b, a_e = out.a_b[rows], out.a_e[rows]
        inertia = a_b @ basis.mass_b + 2.0 * (a_e @ basis.mass_be.T)
        square = (a_b * inertia).sum(axis=1) + (basis.mass_e * a_e**2).sum(axis=1)
        bound = np.sqrt(np.maximum(square, 0.0) / self._nodes.least)
        bound += np.linalg.norm(ground, axis=1)
        nodes, count = self._nodes.places, len(self._state.system.node_names)
        found = Extreme(np.zeros(count), np.full(count, float(out.time[first])))
        doubtful = np.flatnonzero(~(bound < VIOLENT) | self._resultants.has_light_nodes)
        for begin in range(0, len(doubtful), _AT_ONCE):
            some = doubtful[begin : begin + _AT_ONCE]
            moves = np.hstack([a_b[some], a_e[some]]) @ self._resultants.accelerating.T
            moves = np.asarray(self._nodes.rows @ moves.T).T.reshape(len(some), -1, 3)
            sizes = np.linalg.norm(moves + ground[some][:, None], axis=-1)
            sizes = np.where(sizes > VIOLENT, sizes, 0.0)
            now = extreme_of(sizes, out.time[rows][some])
            more = now.values > found.values[nodes]
            found.values[nodes[more]] = now.values[more]
            found.at[nodes[more]] = now.at[more]
        return found


def moving_mass(state: GravityState) -> FloatArray:
    """Return the masses of the nodes that can move (n_nodes, 3), 0 along supports [kg].

    Shapes: result (n_nodes, 3).
    """
    mass = np.array(state.system.node_mass, dtype=np.float64).ravel()
    mass[state.system.fixed_dofs] = 0.0
    return mass.reshape(-1, 6)[:, :3]
