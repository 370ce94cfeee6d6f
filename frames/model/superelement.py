"""Superelements: linear parts of a structure given by matrices over their nodes' displacements."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from lir_element.argument_checks import require_vector

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from frames._types import FloatArray, IntArray, MatrixLike, SparseMatrix


class WithoutForces(NamedTuple):
    """Elements of a superelement whose forces are not known one by one."""

    kind: str
    """Their class, "ShellMITC4"."""
    number: int
    """Number of elements."""
    which: str
    """Their tags or names, the first of them if there are many."""
    why: str
    faces: tuple[tuple[str, ...], ...] = ()
    """Nodes around each of those with three or four, as figures draw them."""


class ShellElement(NamedTuple):
    """A shell element of one isotropic material, without mass and load."""

    area: str
    """Name of its area, "W1-Story2"."""
    nodes: tuple[str, ...]
    """Three or four nodes in order."""
    elastic_modulus: float
    """Elastic modulus of its membrane [Pa]."""
    poisson_ratio: float
    """[-]."""
    thickness: float
    """[m]."""
    bending: float
    """Modulus of its plate over that of its membrane [-]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PartElements:
    """Straight elements between two nodes of a superelement, a part with known forces.

    Attributes
    ----------
    names : tuple of str, (n,)
        Names, as members have them.
    nodes : tuple of (str, str), (n,)
        Nodes i and j.
    rows : ndarray, (n, 12, 12)
        Forces on both ends, positive along and about the element's local axes, per displacement of
        nodes i and j in global axes [N/m, N, N m].
    rest : ndarray, (n, 12)
        The same forces at zero displacements of the superelement [N, N m].
    middle : ndarray, (n, 6)
        Forces from loads along the element in its middle, beyond the mean of both ends [N, N m].
    without : tuple of WithoutForces
        Other elements of the superelement.
    shells : tuple of ShellElement
        Shells that make up all of the superelement's stiffness; none if they do not, or are
        unknown.
    strains : mapping of str to (ndarray, ndarray)
        For elements that may yield, by name: strains over their elastic limits, (k, 3) at ends i
        and j over N [N], My and Mz [N m].
    """

    names: tuple[str, ...] = ()
    nodes: tuple[tuple[str, str], ...] = ()
    rows: FloatArray
    rest: FloatArray
    middle: FloatArray
    without: tuple[WithoutForces, ...] = ()
    shells: tuple[ShellElement, ...] = ()
    strains: Mapping[str, tuple[FloatArray, FloatArray]] = field(default_factory=dict)

    def scaled(self, factor: float) -> PartElements:
        """Return the same under permanent loads multiplied by a factor [-]."""
        return replace(self, rest=factor * self.rest, middle=factor * self.middle)


def no_elements(
    without: Iterable[WithoutForces] = (), shells: Iterable[ShellElement] = ()
) -> PartElements:
    """Return a superelement's elements if no line element is known by itself."""
    return PartElements(
        rows=np.zeros((0, 12, 12)),
        rest=np.zeros((0, 12)),
        middle=np.zeros((0, 6)),
        without=tuple(without),
        shells=tuple(shells),
    )


class ElementTable(NamedTuple):
    """The line elements of all superelements of a frame; fields as in `PartElements`.

    Attributes
    ----------
    names : tuple of str, (n,)
        Names.
    nodes : ndarray, (n, 2)
        Places of nodes i and j.
    rows, rest, middle : ndarray, (n, 12, 12), (n, 12), (n, 6)
        Forces.
    """

    names: tuple[str, ...]
    nodes: IntArray
    rows: FloatArray
    rest: FloatArray
    middle: FloatArray


def element_table(
    parts: Iterable[PartElements], index: dict[str, int], members: Iterable[str]
) -> ElementTable:
    """Join the line elements of superelements in one table."""
    chosen = [no_elements(), *parts]
    names = [name for part in chosen for name in part.names]
    taken = {*members}
    for name in names:
        if name in taken:
            message = (
                f'"{name}" names a member and an element, or two elements: choose different names'
            )
            raise ModelError(message)
        taken.add(name)
    ends = [(index[i], index[j]) for part in chosen for i, j in part.nodes]
    return ElementTable(
        names=tuple(names),
        nodes=np.array(ends, dtype=np.int64).reshape(-1, 2),
        rows=np.concatenate([part.rows for part in chosen]),
        rest=np.concatenate([part.rest for part in chosen]),
        middle=np.concatenate([part.middle for part in chosen]),
    )


def require_elements(elements: PartElements, nodes: tuple[str, ...], owner: str) -> PartElements:
    """Return the elements of a superelement, their arrays checked."""
    count = len(elements.names)
    shapes = {"rows": (count, 12, 12), "rest": (count, 12), "middle": (count, 6)}
    for word, shape in shapes.items():
        given = getattr(elements, word)
        if given.shape != shape:
            message = f"{word} of elements of {owner} has shape {given.shape}, it must be {shape}"
            raise ModelError(message)
        if not np.isfinite(given).all():
            message = f"{word} of elements of {owner} must be finite: give numbers in SI units"
            raise ModelError(message)
    if len(elements.nodes) != count:
        message = f"elements of {owner}: {count} names, but nodes of {len(elements.nodes)}"
        raise ModelError(message)
    known = {*nodes}
    for name, ends in zip(elements.names, elements.nodes, strict=True):
        for node in ends:
            if node not in known:
                message = (
                    f'element "{name}" of {owner} ends at "{node}", which is not in its nodes: add '
                    "it to them"
                )
                raise ModelError(message)
    return elements


_SYMMETRY = 1e-8  # of the largest entry, that a matrix may differ from its transpose
_ROUND_OFF = 1e-12  # of the entries that a node's mass is the sum of, up to which it has none


@dataclass(frozen=True, eq=False)
class Superelement:
    """A linear part given by matrices over ux, uy, uz, rx, ry, rz of its nodes, node by node."""

    name: str
    nodes: tuple[str, ...]
    stiffness: SparseMatrix
    mass: SparseMatrix
    damping: SparseMatrix
    load: FloatArray
    equations: SparseMatrix
    notes: tuple[str, ...]
    elements: PartElements


def superelement(
    name: str,
    nodes: tuple[str, ...],
    stiffness: MatrixLike,
    mass: MatrixLike,
    *,
    damping: MatrixLike | None,
    load: Sequence[float] | FloatArray | None,
    equations: MatrixLike | None,
    notes: Sequence[str],
    elements: PartElements | None,
) -> Superelement:
    """Check the arrays of a superelement; see `Frame.add_superelement`.

    Shapes: nodes (n,), stiffness, mass, damping (6 n, 6 n), load (6 n,), equations (m, 6 n).
    """
    size = 6 * len(nodes)
    owner = f'superelement "{name}"'
    none = sparse.csr_array((size, size), dtype=np.float64)
    given = {"stiffness": stiffness, "mass": mass, "damping": none if damping is None else damping}
    return Superelement(
        name=name,
        nodes=nodes,
        **{word: _symmetric(f"{word} of {owner}", a, nodes) for word, a in given.items()},
        load=require_vector(
            f"load of {owner}", np.zeros(size) if load is None else load, size, error=ModelError
        ),
        equations=_finite(
            f"equations of {owner}", np.zeros((0, size)) if equations is None else equations, nodes
        ),
        notes=tuple(notes),
        elements=require_elements(no_elements() if elements is None else elements, nodes, owner),
    )


def _finite(what: str, given: MatrixLike, nodes: tuple[str, ...]) -> SparseMatrix:
    entries = given if sparse.issparse(given) else np.array(given, dtype=np.float64, ndmin=2)
    matrix = sparse.csr_array(entries)
    if matrix.ndim != 2 or matrix.shape[1] != 6 * len(nodes):
        message = (
            f"{what} has shape {matrix.shape}, it must have {6 * len(nodes)} columns: 6 for each "
            f"of its {len(nodes)} nodes"
        )
        raise ModelError(message)
    if not np.isfinite(matrix.data).all():
        message = f"{what} must be finite: give finite numbers in SI units"
        raise ModelError(message)
    matrix.eliminate_zeros()
    return matrix


def _symmetric(what: str, given: MatrixLike, nodes: tuple[str, ...]) -> SparseMatrix:
    matrix = _finite(what, given, nodes)
    size = 6 * len(nodes)
    if matrix.shape[0] != size:
        message = (
            f"{what} has shape {matrix.shape}, it must be ({size}, {size}): 6 rows for each of "
            f"its {len(nodes)} nodes"
        )
        raise ModelError(message)
    apart, largest, row = asymmetry(matrix)
    if apart > _SYMMETRY * largest:
        message = (
            f"{what} is not symmetric: entries differ by {apart:.3g}, {_SYMMETRY:g} of the "
            f'largest, {largest:.3g}, is allowed; look at node "{nodes[row // 6]}"'
        )
        raise ModelError(message)
    return sparse.csr_array(0.5 * (matrix + matrix.T))


def asymmetry(matrix: SparseMatrix) -> tuple[float, float, int]:
    """Return how far entries differ from those across the diagonal, the largest entry, the row."""
    if not matrix.nnz:
        return 0.0, 0.0, 0
    apart = abs(matrix - matrix.T)
    return float(apart.max()), float(abs(matrix).max()), int(np.argmax(apart.max(axis=1).toarray()))


class Placed(NamedTuple):
    """The sums of all superelements over the displacements of all nodes."""

    stiffness: SparseMatrix
    mass: SparseMatrix
    damping: SparseMatrix
    load: FloatArray
    equations: SparseMatrix


def placed(parts: Iterable[Superelement], index: dict[str, int]) -> Placed:
    """Sum up superelements."""
    size = 6 * len(index)
    stiffness, mass, damping = (sparse.csr_array((size, size), dtype=np.float64) for _ in range(3))
    load = np.zeros(size)
    equations = [sparse.csr_array((0, size), dtype=np.float64)]
    for part in parts:
        places = np.array([index[node] for node in part.nodes], dtype=np.int64)
        dofs = (6 * places[:, None] + np.arange(6)).ravel()
        count = len(dofs)
        put = sparse.csr_array((np.ones(count), (dofs, np.arange(count))), shape=(size, count))
        stiffness = sparse.csr_array(stiffness + put @ part.stiffness @ put.T)
        mass = sparse.csr_array(mass + put @ part.mass @ put.T)
        damping = sparse.csr_array(damping + put @ part.damping @ put.T)
        np.add.at(load, dofs, part.load)
        equations.append(sparse.csr_array(part.equations @ put.T))
    return Placed(stiffness, mass, damping, load, sparse.csr_array(sparse.vstack(equations)))


def lumped(mass: SparseMatrix) -> FloatArray:
    """Return masses by node (n_nodes, 6): translations by a unit motion; diagonal of rotations."""
    count = mass.shape[0] // 6
    found = mass.diagonal().reshape(count, 6).copy()
    for axis in range(3):
        unit = np.tile(np.eye(6)[axis], count)
        total, size = (mass @ unit)[axis::6], (abs(mass) @ unit)[axis::6]
        found[:, axis] = np.where(np.abs(total) > _ROUND_OFF * size, total, 0.0)
    return found
