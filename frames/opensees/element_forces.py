"""Forces and strains in lines of an OpenSees model, as rows over displacements of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames.assembly.members import at_ends
from frames.model.superelement import PartElements, WithoutForces, no_elements
from frames.opensees.element_stiffness import apart_from_assembled, geometry, stiffnesses
from frames.opensees.materials import law_of, printed_model
from frames.opensees.natures import BARS, LINEAR
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.opensees.materials import Law, Printed
    from frames.opensees.model import ElementEntry, OpenSeesModel
    from frames.opensees.structure import Options


PREFIX = "element-"
"""Prefix of the names of elements, before their tags."""

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
    groups: dict[tuple[str, str], list[ElementEntry]] = {}
    for element, why in others:
        groups.setdefault((element.kind, why), []).append(element)
    found = []
    for (kind, why), own in groups.items():
        tags = listed(sorted(element.tag for element in own))
        faces = (tuple(map(str, e.nodes)) for e in own if len(e.nodes) in _FACES)
        found.append(WithoutForces(kind, len(own), tags, why, tuple(faces)))
    return tuple(found)


_FACES = {3, 4}
"""Numbers of nodes of shells and plates."""

_SIZES = {3: 2, 4: 3, 5: 3, 6: 4}
"""Count of the numbers that OpenSees returns for a load, by the tag of its class: uniform in the
plane, at a point in the plane, uniform in space, at a point in space.
"""

_UNIFORM = (3, 5)
_TURNED = 1e-2  # of the forces, by which loads that turn with their element may differ


class ElementLoad(NamedTuple):
    """A load of an element in its local axes."""

    force: tuple[float, float, float]
    """Force per length, or at a point, in units of the model."""
    at: float | None
    """Place of a point load over the length of the element [-]; None of a uniform load."""


def element_loads(ops: Any, ndm: int) -> dict[int, list[ElementLoad | None]]:
    """Read the loads of all elements."""
    found: dict[int, list[ElementLoad | None]] = {}
    for pattern in ops.getPatterns() or ():
        tags = [int(tag) for tag in ops.getEleLoadTags(pattern) or ()]
        if not tags:
            continue
        kinds = [int(kind) for kind in ops.getEleLoadClassTags(pattern)]
        numbers = list(map(float, ops.getEleLoadData(pattern)))
        is_known = sum(_SIZES.get(kind, 0) for kind in kinds) == len(numbers)
        is_known = is_known and all(kind in _SIZES for kind in kinds)
        factor, first = float(ops.getLoadFactor(pattern)), 0
        for tag, kind in zip(tags, kinds, strict=True):
            load = None
            if is_known:
                own = numbers[first : first + _SIZES[kind]]
                first += _SIZES[kind]
                load = _load(own, kind, ndm, factor)
            found.setdefault(tag, []).append(load)
    return found


def _load(numbers: Sequence[float], kind: int, ndm: int, factor: float) -> ElementLoad:
    # OpenSees lists the load across the element before that along it.
    across, along = numbers[: ndm - 1], numbers[ndm - 1]
    y, z = (*across, 0.0)[:2]
    at = None if kind in _UNIFORM else numbers[ndm]
    return ElementLoad((factor * along, factor * y, factor * z), at)


def middle_of(
    loads: Sequence[ElementLoad | None], length: float, ends: FloatArray
) -> FloatArray | None:
    """Return the forces of an element's loads in its middle, beyond the mean of both ends.

    Shapes: ends (12,), result (6,).
    """
    total, found = np.zeros(3), np.zeros(6)
    for load in loads:
        if load is None:
            return None
        force = np.array(load.force)
        at = 0.5 if load.at is None else load.at
        force = force * length if load.at is None else force
        total += force
        if load.at is not None:
            found[:3] += 0.5 * np.sign(at - 0.5) * force
        lever = 0.125 * length if load.at is None else (0.25 - 0.5 * abs(at - 0.5)) * length
        found[4] += lever * force[2]
        found[5] -= lever * force[1]
    apart = np.abs(ends[:3] + ends[6:9] + total).max()
    size = np.abs(ends[:3]).max() + np.abs(ends[6:9]).max()
    return found if apart <= _TURNED * size else None


_ANGLES = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.05
_WAYS = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])
_NONE = 1e-12  # of the largest stiffness of a section, that counts as none


def strain_rows(
    ops: Any, printed: Printed, lines: Sequence[ElementEntry]
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Return strains over their limits at both ends of elements, by their forces there.

    A strain is ``e_0 - y k_z + z k_y``, of the section's initial stiffness; its divisor is the
    strain up to which the material keeps its stiffness (`Law.limit`).
    """
    laws: dict[str, Law | None] = {}

    def law(tag: str) -> Law | None:
        if tag not in laws:
            laws[tag] = law_of(ops, printed, tag, 1.0)
        return laws[tag]

    sections: dict[str, FloatArray] = {}
    found = {}
    for element in lines:
        entry = printed.elements.get(str(element.tag), {})
        given = entry.get("sections") or ([entry["section"]] if "section" in entry else [])
        if given:
            ends = []
            for tag in (str(given[0]), str(given[-1])):
                if tag not in sections:
                    sections[tag] = _of_section(printed, tag, law)
                ends.append(sections[tag])
        elif "A" in entry and (own := law(str(entry.get("material")))) is not None:
            stiff = own.stiffness * float(entry["A"])
            known = 0.0 < own.limit < np.inf and stiff > 0.0
            rows = [[1.0 / (stiff * own.limit), 0.0, 0.0]] if known else []
            ends = [np.array(rows).reshape(-1, 3)] * 2
        else:
            continue
        if any(len(rows) for rows in ends):
            found[element.tag] = (ends[0], ends[1])
    return found


def _of_section(printed: Printed, tag: str, law: Any) -> FloatArray:
    entry = printed.sections.get(tag, {})
    if entry.get("section"):  # of an aggregator
        return _of_section(printed, str(entry["section"]), law)
    fibres = [(f, law(str(f["material"]))) for f in entry.get("fibers", ())]
    if not fibres or any(own is None for _, own in fibres):
        return np.zeros((0, 3))
    places = np.array([[*f["coord"], 0.0][:2] for f, _ in fibres], dtype=np.float64)
    shape = np.column_stack([np.ones(len(fibres)), places[:, 1], -places[:, 0]])  # e_0, k_y, k_z
    stiff = np.array([own.stiffness * float(f["area"]) for f, own in fibres])
    whole = shape.T @ (stiff[:, None] * shape)
    size = np.sqrt(np.maximum(np.diag(whole), _NONE * whole.max()))
    inverse = np.linalg.pinv(whole / np.outer(size, size), rcond=1e-9) / np.outer(size, size)
    rows = []
    for kind in dict.fromkeys(str(f["material"]) for f, _ in fibres):
        limit = law(kind).limit
        if 0.0 < limit < np.inf:
            own = np.flatnonzero([str(f["material"]) == kind for f, _ in fibres])
            far = np.unique(own[np.argmax(places[own] @ _WAYS.T, axis=0)])
            rows.append(shape[far] @ inverse / limit)
    return np.vstack(rows) if rows else np.zeros((0, 3))
