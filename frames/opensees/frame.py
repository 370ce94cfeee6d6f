"""From an OpenSees model to a frame: axes, units, supports released, bearings under the bases."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from scipy import sparse

from frames._errors import ModelError, ModelWarning
from frames.assembly.assemble import assemble
from frames.frame import Frame, stand
from frames.model.components import DOFS, bearing_height
from frames.model.superelement import lumped
from frames.opensees.checks import (
    judge_elements,
    refuse_leaning,
    refuse_other_supports,
    refuse_unsymmetric,
)
from frames.opensees.element_forces import line_elements
from frames.opensees.materials import with_viscous_springs
from frames.opensees.model import read_model
from frames.opensees.natures import natures
from frames.opensees.structure import (
    Options,
    Structure,
    light_base,
    permanent_load,
    rigid_damping,
    turning,
    with_vertical_mass,
)
from lir_element.argument_checks import listed, require_choice, require_positive
from lir_element.elevations import by_elevation
from lir_element.opensees.base_nodes import BASE_ROTATIONS
from lir_element.opensees.library import opensees
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.assembly.system import System
    from frames.opensees.model import OpenSeesModel

NAME = "opensees"
"""Name of the superelement that holds the model."""


F = TypeVar("F", bound=Frame)


def imported(kind: type[F], options: Options, name: str) -> F:
    """Return OpenSees' current model as a frame on bearings, with warnings."""
    _check_options(options)
    frame = kind(name, STANDARD_GRAVITY if options.gravity is None else options.gravity)
    model = read_model()
    unknown = [tag for tag in (*options.bases, *options.other_supports) if tag not in model.tags]
    if unknown:
        message = (
            f"the OpenSees model has no node {unknown[0]}, but base_nodes or supports name "
            f"it: use tags of its nodes, {listed(model.tags)}"
        )
        raise ModelError(message)
    refuse_unsymmetric(model)
    up = 1 if options.vertical == "y" or model.coordinates.shape[1] == 2 else 2
    ops = opensees()
    notes = judge_elements(model, natures(ops, model), up, accept=options.accept_nonlinear)
    refuse_other_supports(model, options.bases, options.other_supports)
    if options.damping:
        damping, said = with_viscous_springs(ops, model)
        notes += said
    else:
        damping = sparse.csr_array(model.damping.shape, dtype=np.float64)
    structure = _released(_turned(replace(model, damping=damping), options), options)
    structure.matrices["mass"], said = with_vertical_mass(structure, options.vertical_mass)
    notes += said
    load, said = permanent_load(structure, options)
    notes += said + rigid_damping(structure, options) + light_base(structure, options)
    elements = line_elements(ops, model, options)
    _add_nodes(frame, structure)
    frame.add_superelement(
        NAME,
        [str(tag) for tag in structure.tags],
        **structure.matrices,
        load=load,
        equations=structure.equations,
        notes=notes,
        elements=elements,
    )
    _add_bearings(frame, options)
    _add_levels(frame, structure, options)
    system = assemble(frame)
    _refuse_held_bases(system, structure, options)
    refuse_leaning(system, structure.initial)
    for note in notes:
        warnings.warn(f"Frame.from_opensees: {note}", ModelWarning, stacklevel=3)
    return frame


def _check_options(options: Options) -> None:
    bearings = options.bearings
    if options.vertical not in {None, "y", "z"}:
        message = f'vertical = {options.vertical!r}: use "z" or "y", the axis that points up'
        raise ModelError(message)
    require_choice("base_rotations", options.base_rotations, BASE_ROTATIONS, error=ModelError)
    for word in ("length_unit", "force_unit"):
        require_positive(
            word,
            getattr(options, word),
            remedy="give the unit of the model in m or N",
            error=ModelError,
        )
    if options.gravity is not None:
        require_positive(
            "gravity [m/s2]",
            options.gravity,
            remedy="use 9.81, or None if the model is loaded",
            error=ModelError,
        )
    for tag, device in bearings.items():
        bearing_height(f"bearing-{tag}", device)


def _turned(model: OpenSeesModel, options: Options) -> Structure:
    # Axes: x, y, z of the frame; a plane model lies in x-z. Forces and lengths to SI.
    count, ndm = model.coordinates.shape
    if ndm == 2 and options.vertical == "z":
        message = 'vertical = "z": a plane model of OpenSees has its y axis up, leave vertical out'
        raise ModelError(message)
    axes, turn = turning(ndm, options.vertical)
    moves = np.array([1.0] * ndm + [0.0] * (model.ndf - ndm))
    length = options.length_unit
    to_model = np.where(moves > 0.0, 1.0 / length, 1.0)  # model's displacements from SI
    scale = np.tile(to_model, count)
    put = sparse.csr_array(sparse.kron(sparse.eye_array(count), turn) @ sparse.diags_array(scale))
    energy = options.force_unit * length
    matrices = {
        word: sparse.csr_array(energy * (put @ getattr(model, word) @ put.T))
        for word in ("mass", "damping", "stiffness", "initial")
    }
    points = np.zeros((count, 3))
    points[:, :ndm] = model.coordinates * length
    has = np.abs(turn) > 0.0
    return Structure(
        tags=model.tags,
        coordinates=points @ axes.T,
        initial=matrices.pop("initial"),
        matrices=matrices,
        fixed=(model.fixed.reshape(count, -1) @ has.T.astype(float)) > 0.0,
        present=np.tile(has.any(axis=1), (count, 1)),
        equations=sparse.csr_array(model.equations @ put.T),
        load=energy * (put @ model.unbalance),
    )


def _released(structure: Structure, options: Options) -> Structure:
    # Base nodes: translations and the rotation about the vertical free, the others by the option; a
    # DOF held at every node (a plane model in space) stays held. Nodes without elements are
    # removed.
    bases = [structure.tags.index(tag) for tag in options.bases]
    parts = [*structure.matrices.values(), structure.equations]
    reached = np.sum([np.asarray(abs(part).sum(axis=0)) for part in parts], axis=0)
    used = reached.reshape(-1, 6).any(axis=1)
    fixed = structure.fixed.copy()
    fixed[np.ix_(bases, [0, 1, 2, 5])] = False
    if options.base_rotations != "kept":
        fixed[np.ix_(bases, [3, 4])] = options.base_rotations == "fixed"
    fixed |= np.all(structure.fixed[used], axis=0)
    idle = [tag for tag in options.bases if not used[structure.tags.index(tag)]]
    if idle:
        message = (
            f"base node {idle[0]} has no element, mass or constraint: remove it from base_nodes"
        )
        raise ModelError(message)
    places = np.flatnonzero(used)
    dofs = (6 * places[:, None] + np.arange(6)).ravel()
    return Structure(
        tags=tuple(structure.tags[place] for place in places),
        coordinates=structure.coordinates[places],
        matrices={word: m[dofs][:, dofs] for word, m in structure.matrices.items()},
        initial=structure.initial[dofs][:, dofs],
        fixed=(fixed | ~structure.present)[places],
        present=structure.present[places],
        equations=structure.equations[:, dofs],
        load=structure.load[dofs],
    )


def _add_nodes(frame: Frame, structure: Structure) -> None:
    places = structure.coordinates.tolist()
    for tag, place, fixed in zip(structure.tags, places, structure.fixed, strict=True):
        frame.add_node(str(tag), *place)
        held = [dof for dof, is_held in zip(DOFS, fixed, strict=True) if is_held]
        if held:
            frame.fix(str(tag), *held)


def _add_bearings(frame: Frame, options: Options) -> None:
    for tag, device in options.bearings.items():
        stand(frame, str(tag), f"bearing-{tag}", device, str(tag))
    if not options.base_diaphragm:
        return
    at = {str(tag): frame.nodes[str(tag)].z for tag in options.bases}
    groups = [group for group in by_elevation(at) if len(group) > 1]
    for k, group in enumerate(groups):
        frame.add_diaphragm("base" if len(groups) == 1 else f"base-{k + 1}", group)


def _add_levels(frame: Frame, structure: Structure, options: Options) -> None:
    # The base, and every elevation with mass; or as given.
    at = dict(zip(map(str, structure.tags), structure.coordinates[:, 2].tolist(), strict=True))
    if options.levels is not None:
        given = sorted(options.levels.items(), key=lambda item: at.get(str(item[1][0]), math.inf))
        for name, tags in given:
            frame.add_level(name, [str(tag) for tag in tags])
        return
    mass = lumped(structure.matrices["mass"])[:, 0]
    heavy = dict(zip(at, mass.tolist(), strict=True))
    rises = dict(zip(at, (~structure.fixed[:, 2]).tolist(), strict=True))
    bases = {str(tag) for tag in options.bases}
    floors = [
        group
        for group in by_elevation(at)
        if bases.intersection(group) or any(heavy[name] > 0.0 for name in group)
    ]
    for k, group in enumerate(floors):
        # a master node that is held vertically is no part of the floor's vertical motion
        frame.add_level(f"level-{k}", [node for node in group if rises[node]] or group)


def _refuse_held_bases(system: System, structure: Structure, options: Options) -> None:
    # A base node that constraints still hold would leave its bearing without work.
    moving = np.diff(system.transform.indptr) > 0
    for tag in options.bases:
        node = system.node_names.index(str(tag))
        needed = ~structure.fixed[structure.tags.index(tag)]
        held = [DOFS[axis] for axis in range(3) if needed[axis] and not moving[6 * node + axis]]
        if held:
            message = (
                f"base node {tag} cannot move along {held[0]}: a multi-point constraint ties it to "
                "a fixed node; remove that constraint by ops.remove('mp', ...)"
            )
            raise ModelError(message)
