"""Shares of the strain energy that elements of an OpenSees model hold under horizontal load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from frames.assembly.constraints import eliminate

if TYPE_CHECKING:
    from collections.abc import Collection

    from frames._types import FloatArray, SparseMatrix
    from frames.opensees.model import OpenSeesModel

_SPARE = 1e-10  # of the mean stiffness, so that what nothing holds does not stop the solution


def energy_shares(model: OpenSeesModel, tags: Collection[int], vertical: int) -> dict[int, float]:
    """Find what share of the strain energy elements hold under loads in proportion to the masses.

    The compliance to a load changes by that share of the change of an element's stiffness:
    ``d(u' F) / (u' F) = -share dk / k``.

    In an element that is free of force in rigid motions the energy is a sum over pairs of its
    nodes, ``-u_a' K_ab (u_b - R_ab u_a) / 2`` in both orders, R_ab the motion of node b that goes
    with that of node a. So the blocks of the assembled stiffness are enough.
    """
    at = {tag: place for place, tag in enumerate(model.tags)}
    pairs: dict[tuple[int, int], list[int]] = {}
    for element in model.elements:
        places = sorted({at[node] for node in element.nodes})
        for k, first in enumerate(places):
            for second in places[k + 1 :]:
                pairs.setdefault((first, second), []).append(element.tag)
    wanted = set(tags)
    ndm = model.coordinates.shape[1]
    shares = dict.fromkeys(wanted, 0.0)
    for axis in range(ndm):
        if axis == vertical:
            continue
        moved, total = _moved(model, axis)
        own = dict.fromkeys(wanted, 0.0)
        for (a, b), elements in pairs.items():
            concerned = wanted.intersection(elements)
            if concerned and total > 0.0:
                energy = _pair_energy(model, moved, a, b) / total / len(elements)
                for tag in concerned:
                    own[tag] += energy
        if sum(own.values()) > sum(shares.values()):
            shares = own
    return shares


def _moved(model: OpenSeesModel, axis: int) -> tuple[FloatArray, float]:
    free = np.flatnonzero(~model.fixed)
    _, follow = eliminate(
        sparse.csr_array(model.equations[:, free]), np.ones(len(free), dtype=np.float64)
    )
    unit = np.zeros(len(model.fixed), dtype=np.float64)
    unit[axis :: model.ndf] = 1.0
    pull = np.asarray(model.mass @ unit)
    load = follow.T @ pull[free]
    initial = model.initial[free][:, free]
    stiffness: SparseMatrix = sparse.csr_array(follow.T @ initial @ follow)
    size = max(float(np.abs(stiffness.diagonal()).mean()), 1e-300)
    spare = _SPARE * size * sparse.eye_array(stiffness.shape[0])
    answer = splu(sparse.csc_matrix(stiffness + spare)).solve(load)
    moved = np.zeros(len(unit))
    moved[free] = follow @ answer
    return moved, float(answer @ (stiffness @ answer))


def _pair_energy(model: OpenSeesModel, moved: FloatArray, a: int, b: int) -> float:
    # Twice the energy between two nodes.
    u = moved.reshape(len(model.tags), model.ndf)
    rows = [slice(model.ndf * place, model.ndf * (place + 1)) for place in (a, b)]
    block = model.initial[rows[0], rows[1]].toarray()
    arm = model.coordinates[b] - model.coordinates[a]
    ahead = u[b] - _carried(u[a], arm)
    back = u[a] - _carried(u[b], -arm)
    return float(u[a] @ block @ ahead + u[b] @ block.T @ back)


def _carried(motion: FloatArray, arm: FloatArray) -> FloatArray:
    # The motion of a node at the end of a rigid arm.
    ndm = len(arm)
    turn = motion[ndm:]
    lever = np.cross(turn, arm) if ndm == 3 else turn[0] * np.array([-arm[1], arm[0]])
    return np.concatenate([motion[:ndm] + lever, turn])
