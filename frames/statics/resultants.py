"""Equilibrium of the isolated structure as a whole, and nodes that are accelerated beyond reason.

Both are formed from what is recorded: forces of bearings against weight and inertia, about all axes
about which the structure is held by its bearings alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from frames.assembly.basis import bearing_rows
from frames.assembly.sparse_solver import Factors
from frames.results.formulas import VIOLENT
from frames.results.peak_response import Extreme, extreme_of, later
from frames.statics.accelerations import AtRest

if TYPE_CHECKING:
    from frames._types import FloatArray, IntArray
    from frames.kernel_data import Output
    from frames.nonlinear_data import NonlinearElements
    from lir_element.layout import Records

RESULTANTS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
"""Forces along the axes, and moments about those through the middle of the bearings."""

_HELD = 1e-9  # of the stiffness against a motion, part by part, below which nothing holds it
_AT_ONCE = 256  # steps, of which the accelerations of all nodes are formed together


class AtRestMoving(AtRest, Protocol):
    """A structure at rest that knows how its coordinates move it."""

    @property
    def parts(self) -> NonlinearElements | None:
        """Its nonlinear parts."""
        ...

    @property
    def part_shift(self) -> FloatArray:
        """How their forces displace what has no mass."""
        ...

    @property
    def accelerating(self) -> FloatArray:
        """How accelerations of its coordinates accelerate it."""
        ...

    @property
    def has_light_nodes(self) -> bool:
        """Whether nodes have so little mass that no step follows it."""
        ...


class Resultants:
    """Sums of all forces on what stands on bearings alone.

    Parameters
    ----------
    state : AtRestMoving
        The structure at rest.

    Notes
    -----
    A rigid motion q_r of those parts of the structure that no support holds takes no elastic force:
    ``q_r' (M a + K_g q + B' f - p)`` is the sum of inertia, of what axial forces make of
    displacements, of bearing forces and of loads, which is zero in equilibrium. Sums that supports
    or the fixed rotations of a node share in are not formed.
    """

    def __init__(self, state: AtRestMoving) -> None:
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
        self._over_a = np.asarray(system.mass @ motions).T @ state.accelerating
        self._over_ground = motions.T @ system.inertia_load
        self._over_force = np.asarray(bearing_rows(system) @ motions).T
        self.nodes = _Nodes(state)
        """Those with mass."""

    def of(
        self, out: Output, states: Records, ground: FloatArray, first: int, last: int
    ) -> FloatArray:
        """Return what is left of all forces at rows first <= k < last of what was recorded."""
        rows = slice(first, last)
        x = np.hstack([out.b[rows], out.e[rows], out.beyond[rows]])
        rates = np.hstack([out.a_b[rows], out.a_e[rows]])
        found = _times(x, self._over_x) + _times(rates, self._over_a)
        found += _times(np.asarray(ground), self._over_ground)
        found += _times(states["force"][rows].reshape(last - first, -1), self._over_force)
        return np.asarray(found + self._rest)


def _times(steps: FloatArray, rows: FloatArray) -> FloatArray:
    # Rows times each step: the same to the last digit however many steps are taken at once.
    return np.asarray(np.einsum("ti,ki->tk", steps, rows))


def _rigid_motions(state: AtRestMoving) -> tuple[FloatArray, FloatArray, float]:
    # Rigid motions (n_free, 6) of what bearings alone hold, which of them nothing else resists,
    # and half the extent of the structure.
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


def _parts(state: AtRestMoving) -> IntArray:
    # Parts of the structure that bearings alone connect, by free displacement.
    system = state.system
    pattern = abs(system.stiffness) + abs(system.mass)
    return np.asarray(csgraph.connected_components(pattern, directed=False)[1], dtype=np.int64)


class _Nodes:
    # Nodes with mass that can move, the smallest of these masses, their translations over the free
    # displacements.

    def __init__(self, state: AtRestMoving) -> None:
        mass, transform = moving_mass(state), sparse.csr_array(state.system.transform)
        self.places = np.flatnonzero(mass.max(axis=1) > 0.0)
        self.least = float(mass.max(axis=1)[self.places].min())
        self.rows = sparse.csr_array(transform[(6 * self.places[:, None] + np.arange(3)).ravel()])


class Plausibility:
    """Keeps how far the forces of a run were from equilibrium, and how violently nodes moved.

    Parameters
    ----------
    state : AtRestMoving
        The structure.
    resultants : Resultants
        Its sums of forces.
    """

    def __init__(self, state: AtRestMoving, resultants: Resultants) -> None:
        self._state, self._resultants, self._nodes = state, resultants, resultants.nodes
        self._reached: dict[str, Extreme] = {}

    def take(self, out: Output, states: Records, ground: FloatArray, first: int, last: int) -> None:
        """Take up rows first <= k < last of what was recorded; arguments as `Resultants.of`."""
        if first >= last:
            return
        time = out.time[first:last]
        gaps = np.abs(self._resultants.of(out, states, ground, first, last))
        self._keep("imbalance", extreme_of(gaps, time))
        self._keep("violence", self._violence(out, ground, first, last))

    def reached(self) -> dict[str, Extreme]:
        """Return what was reached, by quantity."""
        return dict(self._reached)

    def _keep(self, name: str, now: Extreme) -> None:
        before = self._reached.get(name)
        self._reached[name] = now if before is None else later(before, now)

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
        doubtful = np.flatnonzero(~(bound < VIOLENT) | self._state.has_light_nodes)
        for begin in range(0, len(doubtful), _AT_ONCE):
            some = doubtful[begin : begin + _AT_ONCE]
            moves = np.hstack([a_b[some], a_e[some]]) @ self._state.accelerating.T
            moves = np.asarray(self._nodes.rows @ moves.T).T.reshape(len(some), -1, 3)
            sizes = np.linalg.norm(moves + ground[some][:, None], axis=-1)
            sizes = np.where(sizes > VIOLENT, sizes, 0.0)
            now = extreme_of(sizes, out.time[rows][some])
            more = now.values > found.values[nodes]
            found.values[nodes[more]] = now.values[more]
            found.at[nodes[more]] = now.at[more]
        return found


def moving_mass(state: AtRestMoving) -> FloatArray:
    """Return the masses of the nodes that can move (n_nodes, 3), 0 along what supports hold [kg].

    Shapes: result (n_nodes, 3).
    """
    mass = np.array(state.system.node_mass, dtype=np.float64).ravel()
    mass[state.system.fixed_dofs] = 0.0
    return mass.reshape(-1, 6)[:, :3]
