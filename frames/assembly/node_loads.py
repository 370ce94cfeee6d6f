"""What acts at the nodes of a frame: its masses, what they weigh, and its permanent loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frames.model.applied_loads import load_masses
from frames.model.axes import to_global

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray
    from frames.assembly.system import MemberTable
    from frames.model.applied_loads import AppliedLoads
    from frames.model.frame_data import FrameData


def lumped_masses(
    frame: FrameData, index: Mapping[str, int], members: MemberTable, applied: AppliedLoads
) -> tuple[FloatArray, FloatArray]:
    """Return the masses at the nodes: lumped ones, those of members, and those that loads make.

    Shapes: mass (n_nodes, 6), weighing (n_nodes, 6).
    """
    mass = np.zeros((len(index), 6))
    for name, values in frame.masses.items():
        mass[index[name]] += values
    half = 0.5 * members.arrays.density * members.arrays.area * members.arrays.length
    for end in (0, 1):
        np.add.at(mass[:, :3], members.nodes[:, end], half[:, None])
    weighing = mass.copy()
    for name, values in frame.weightless_masses.items():
        weighing[index[name]] -= values
    for name, made in load_masses(frame, applied).items():
        mass[index[name], :3] += made
    return mass, weighing


def permanent_loads(
    frame: FrameData,
    index: Mapping[str, int],
    members: MemberTable,
    weighing: FloatArray,
    applied: AppliedLoads,
) -> FloatArray:
    """Return weights and permanent loads at the nodes, superelements left out.

    Shapes: weighing (n_nodes, 6), result (6 n_nodes,).
    """
    load = np.zeros((len(index), 6))
    load[:, 2] -= frame.weight_factor * frame.gravity * weighing[:, 2]
    for name, values in frame.loads.items():
        load[index[name]] += values
    for name, values, _ in applied.nodes:
        load[index[name]] += values
    flat = load.ravel()
    np.subtract.at(flat, members.dofs, to_global(members.fixed_end, members.arrays.axes))
    return flat
