"""What a model of OpenSees is asked for, what is read of it, and what a frame is given."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, SparseMatrix
    from frames.model.part_elements import PartElements
    from lir_element import LIRBearing


@dataclass(frozen=True)
class Options:
    """What `Frame.from_opensees` was asked for."""

    base_nodes: tuple[int, ...]
    bearings: Mapping[int, LIRBearing]
    vertical: str | None
    base_rotations: str
    base_diaphragm: bool
    gravity: float | None
    damping: bool
    levels: Mapping[str, Sequence[int]] | None
    other_supports: Collection[int]
    accept_nonlinear: bool
    vertical_mass: str | Mapping[int, float] | None
    length_unit: float
    force_unit: float


def turning(ndm: int, vertical: str | None) -> tuple[FloatArray, FloatArray]:
    """Return how vectors and displacements of a node turn from the model's axes to the frame's.

    Shapes: result (3, 3).
    """
    y_up = ndm == 2 or vertical == "y"
    axes = np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]) if y_up else np.eye(3)
    return axes, np.kron(np.eye(2), axes)[:, [0, 1, 5] if ndm == 2 else list(range(6))]


@dataclass(frozen=True, eq=False)
class Structure:
    """The model in axes of the frame (z up) and SI units, six displacements a node."""

    tags: tuple[int, ...]
    coordinates: FloatArray
    matrices: dict[str, SparseMatrix]  # mass, damping, stiffness
    initial: SparseMatrix  # stiffness of the elements before any load
    fixed: BoolArray  # (n, 6), true where held
    present: BoolArray  # (n, 6), false for displacements that the model does not have
    equations: SparseMatrix
    load: FloatArray  # (6 n,)


@dataclass
class Taken:
    """What a frame is given: the arguments of the verbs that add it, in their order."""

    nodes: dict[str, tuple[float, float, float]] = field(default_factory=dict)
    fixed: dict[str, tuple[str, ...]] = field(default_factory=dict)
    matrices: dict[str, SparseMatrix] = field(default_factory=dict)
    members: tuple[str, ...] = ()  # nodes of the superelement
    load: FloatArray | None = None
    equations: SparseMatrix | None = None
    bearings: dict[str, tuple[str, str, LIRBearing]] = field(default_factory=dict)
    diaphragms: dict[str, list[str]] = field(default_factory=dict)
    levels: dict[str, list[str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    elements: PartElements | None = None
