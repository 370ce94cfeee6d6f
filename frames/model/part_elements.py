"""Line elements within superelements: how their forces follow from displacements of nodes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames._types import FloatArray, IntArray


class WithoutForces(NamedTuple):
    """Elements of a superelement whose forces are not known one by one."""

    kind: str
    """Their class, "ShellMITC4"."""
    number: int
    """How many."""
    which: str
    """Their tags or names, the first of them where they are many."""
    why: str


class ShellElement(NamedTuple):
    """A shell element of one isotropic material, without mass and load."""

    area: str
    """What it is a part of, "W1-Story2"."""
    nodes: tuple[str, ...]
    """Three or four nodes in order."""
    elastic_modulus: float
    """Of its membrane [Pa]."""
    poisson_ratio: float
    """[-]."""
    thickness: float
    """[m]."""
    bending: float
    """Modulus of its plate over that of its membrane [-]."""


@dataclass(frozen=True, eq=False, kw_only=True)
class PartElements:
    """Straight elements between two nodes of a superelement: a part of it, whose forces are told.

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
        The same forces where the superelement's displacements are nought [N, N m].
    middle : ndarray, (n, 6)
        What loads along the element add in its middle to the mean of both ends [N, N m].
    without : tuple of WithoutForces
        What else the superelement holds.
    shells : tuple of ShellElement
        Shells that are all of the superelement's stiffness; none where they are not, or not known.
    strains : mapping of str to (ndarray, ndarray)
        Of elements that may leave their stiffness, by name: strains over those up to which they
        keep it, (k, 3) at ends i and j over N [N], My and Mz [N m].
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
    """Return a superelement's elements where no line element is known by itself."""
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
    """Put the line elements of superelements one after the other."""
    chosen = [no_elements(), *parts]
    names = [name for part in chosen for name in part.names]
    taken = {*members}
    for name in names:
        if name in taken:
            message = f'"{name}" is the name of a member and of an element, or of two elements'
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
                message = f'element "{name}" of {owner} ends at "{node}", which is no node of it'
                raise ModelError(message)
    return elements
