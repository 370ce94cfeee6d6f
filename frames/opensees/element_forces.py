"""Forces in beams, columns and bars of an OpenSees model, as rows over displacements of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.assembly.members import at_ends
from frames.model.part_elements import PartElements, WithoutForces, no_elements
from frames.opensees.element_loads import element_loads, middle_of
from frames.opensees.element_stiffness import apart_from_assembled, geometry, stiffnesses
from frames.opensees.materials import printed_model
from frames.opensees.natures import BARS, LINEAR
from frames.opensees.strains import strain_rows
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.opensees.model import ElementEntry, OpenSeesModel
    from frames.opensees.structure import Options

PREFIX = "element-"
"""Of the names of elements, before their tags."""

_NO_LINE = "no beam, column or bar between two nodes"
_LOADED = "loaded along it in a way that OpenSees does not show"
_OTHERWISE = "OpenSees tells another stiffness of it than it assembles"


def line_elements(ops: Any, model: OpenSeesModel, options: Options) -> PartElements:
    """Read how the forces in beams, columns and bars follow from displacements of their nodes."""
    points = dict(zip(model.tags, model.coordinates, strict=True))
    lines = [element for element in model.elements if _is_line(points, element)]
    tags = {element.tag for element in lines}
    others = [(element, _NO_LINE) for element in model.elements if element.tag not in tags]
    if not lines:
        return no_elements(_told(others))
    printed = printed_model(ops)
    place = geometry(ops, model, lines, printed, options)
    stiffness = stiffnesses(ops, model, lines, printed, place)
    apart = apart_from_assembled(model, lines, stiffness, place)
    loads = element_loads(ops, model.coordinates.shape[1])
    local = place.local()
    present = np.array([ops.eleForce(element.tag) for element in lines]) @ place.put.T
    rest = at_ends(np.einsum("nab,nb->na", local, present), place.arms)
    rows = np.moveaxis(at_ends(np.moveaxis(local @ stiffness, 2, 0), place.arms), 0, 2)
    kept, middle = [], []
    for k, element in enumerate(lines):
        own = middle_of(loads.get(element.tag, []), float(place.length[k]), rest[k])
        if own is None or k in apart:
            others.append((element, _LOADED if own is None else _OTHERWISE))
        else:
            kept.append(k)
            middle.append(own)
    strains = strain_rows(ops, printed, [lines[k] for k in kept])
    in_si = np.array([*[1.0] * 3, *[options.length_unit] * 3]) * options.force_unit
    both = np.tile(in_si, 2)
    moves = np.tile([*[1.0 / options.length_unit] * 3, *[1.0] * 3], 2)
    return PartElements(
        names=tuple(f"{PREFIX}{lines[k].tag}" for k in kept),
        nodes=tuple((str(lines[k].nodes[0]), str(lines[k].nodes[1])) for k in kept),
        rows=both[:, None] * rows[kept] * moves,
        rest=rest[kept] * both,
        middle=np.array(middle).reshape(-1, 6) * in_si,
        strains={
            f"{PREFIX}{tag}": (first / in_si[[0, 4, 5]], last / in_si[[0, 4, 5]])
            for tag, (first, last) in strains.items()
        },
        without=_told(others),
    )


def _is_line(points: dict[int, FloatArray], element: ElementEntry) -> bool:
    kind = element.kind
    if kind not in LINEAR and kind not in BARS and "BeamColumn" not in kind:
        return False
    return len(element.nodes) == 2 and bool(
        np.any(points[element.nodes[0]] != points[element.nodes[1]])
    )


def _told(others: Sequence[tuple[ElementEntry, str]]) -> tuple[WithoutForces, ...]:
    groups: dict[tuple[str, str], list[int]] = {}
    for element, why in others:
        groups.setdefault((element.kind, why), []).append(element.tag)
    return tuple(
        WithoutForces(kind, len(tags), listed(sorted(tags)), why)
        for (kind, why), tags in groups.items()
    )
