"""Strains of fibres and bars of an OpenSees model over their limits, by the forces of elements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frames.opensees.materials import law_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray
    from frames.opensees.materials import Law, Printed
    from frames.opensees.model import ElementEntry

_ANGLES = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False) + 0.05
_WAYS = np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)])
_NONE = 1e-12  # of the largest stiffness of a section, that counts as none


def strain_rows(
    ops: Any, printed: Printed, lines: Sequence[ElementEntry]
) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Return how far strains go at both ends of elements, by their forces there.

    A strain is ``e_0 - y k_z + z k_y``, of the section's initial stiffness; what it is divided by
    is the strain up to which the material keeps its stiffness (`Law.limit`).
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
