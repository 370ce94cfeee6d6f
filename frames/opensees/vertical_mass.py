"""Vertical mass of models that have none: a bearing's axial force needs what it accelerates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from frames._errors import ModelError
from frames.model.superelement import lumped
from lir_element.argument_checks import listed, require_non_negative

if TYPE_CHECKING:
    from frames._types import BoolArray, FloatArray, SparseMatrix
    from frames.opensees.structure import Structure

HORIZONTAL = "horizontal"
"""The option that lets masses act along the vertical as they do along x."""

_NONE = 1e-6  # of the mass along x, below which a model counts as without vertical mass
_FEW = 0.5  # of the same, below which that is worth a note
_LEVEL = 1e-3  # m, within which nodes are at one elevation


def with_vertical_mass(
    structure: Structure, given: str | Mapping[int, float] | None
) -> tuple[SparseMatrix, list[str]]:
    """Return the mass of a structure with the vertical mass that was asked for."""
    mass = structure.matrices["mass"]
    own = lumped(mass)
    rises = ~structure.fixed[:, 2]
    if isinstance(given, Mapping):
        more = _given(structure, given, rises)
    elif given == HORIZONTAL:
        more = _as_horizontal(structure, own, rises)
    elif given is None:
        more = np.zeros(len(own))
    else:
        message = (
            f'vertical_mass = {given!r}: give "horizontal", masses in kg by tag of node, or None'
        )
        raise ModelError(message)
    moving, lifted = float(own[:, 0].sum()), float((own[:, 2] + more)[rises].sum())
    if lifted <= _NONE * moving:
        message = (
            f"the OpenSees model has {moving:.4g} kg along x, but no mass along the vertical that "
            'could move: pass vertical_mass="horizontal" to let its masses act along the '
            "vertical, too, or vertical_mass={tag: kg, ...}; neither adds weight to a loaded model"
        )
        raise ModelError(message)
    notes = []
    if lifted < _FEW * moving:
        notes.append(
            f"the mass that can move along the vertical is {lifted:.4g} kg, that along x "
            f'{moving:.4g} kg: pass vertical_mass="horizontal" if the rest moves vertically, too'
        )
    diagonal = np.zeros((len(own), 6))
    diagonal[:, 2] = more
    return sparse.csr_array(mass + sparse.diags_array(diagonal.ravel())), notes


def _given(structure: Structure, given: Mapping[int, float], rises: BoolArray) -> FloatArray:
    more = np.zeros(len(structure.tags))
    for tag, value in given.items():
        number = require_non_negative(
            f"vertical_mass [kg] of node {tag}", value, remedy="give kg", error=ModelError
        )
        if tag not in structure.tags or not rises[structure.tags.index(tag)]:
            able = [node for node, free in zip(structure.tags, rises, strict=True) if free]
            message = (
                f"vertical_mass names node {tag}, which is not there or held vertically: give "
                f"nodes that can rise, {listed(able)}"
            )
            raise ModelError(message)
        more[structure.tags.index(tag)] += number
    return more


def _as_horizontal(structure: Structure, own: FloatArray, rises: BoolArray) -> FloatArray:
    lacking = np.maximum(own[:, 0] - own[:, 2], 0.0)
    more = np.where(rises, lacking, 0.0)
    heights = structure.coordinates[:, 2]
    carrying = rises & (structure.matrices["stiffness"].diagonal().reshape(-1, 6)[:, 2] > 0.0)
    for place in np.flatnonzero(~rises & (lacking > 0.0)):
        floor = np.flatnonzero(carrying & (np.abs(heights - heights[place]) < _LEVEL))
        if not len(floor):
            message = (
                f"node {structure.tags[place]} has {lacking[place]:.4g} kg, but it is held "
                "vertically and no node of its elevation can rise: give vertical_mass by tag"
            )
            raise ModelError(message)
        more[floor] += lacking[place] / len(floor)
    return more
