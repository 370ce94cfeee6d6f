"""Laws of OpenSees' elements, by its printed model and by trial; viscous parts of springs."""

from __future__ import annotations

import contextlib
import itertools
import json
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy import sparse

from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames._types import FloatArray, SparseMatrix
    from frames.opensees.model import ElementEntry, OpenSeesModel

DASHPOTS = frozenset(
    {
        "Viscous",
        "ViscousMaterial",
        "ViscousDamper",
        "Maxwell",
        "MaxwellMaterial",
        "BilinearOilDamper",
        "DamperMaterial",
        "ViscoelasticGap",
    }
)
"""Types of uniaxial materials whose force depends on speed: not tried, as trials are static."""

DEPARTURE = 0.05
"""Change of secant stiffness, of that at rest, from which on a law has left its straight line."""

_STIFFENS = 2.0  # secant stiffness over that at rest, from which on a law closes like a gap
_SPARE_TAGS = itertools.count(2_147_000_000)  # of the copies on which materials are tried
_STEPS = np.array([0.1, 0.2, 0.5])
_ENTRY = re.compile(r'\{"name": ')
_PLAIN = re.compile(r"^\s*(\w+) tag: (\d+)\s*$", re.MULTILINE)
_EXPONENT = re.compile(r"^\s*Alpha: (\S+)", re.MULTILINE)


@dataclass(frozen=True)
class Printed:
    """The model as OpenSees prints it, by tag; entries that it does not print well are left out."""

    # uniaxial materials, those of continua, sections, coordinate transformations and elements:
    # their entries by tag
    uniaxial: Mapping[str, dict[str, Any]]
    # uniaxial materials, those of continua, sections, coordinate transformations and elements:
    # their entries by tag
    solid: Mapping[str, dict[str, Any]]
    # uniaxial materials, those of continua, sections, coordinate transformations and elements:
    # their entries by tag
    sections: Mapping[str, dict[str, Any]]
    # uniaxial materials, those of continua, sections, coordinate transformations and elements:
    # their entries by tag
    transformations: Mapping[str, dict[str, Any]]
    # uniaxial materials, those of continua, sections, coordinate transformations and elements:
    # their entries by tag
    elements: Mapping[str, dict[str, Any]]


class Law(NamedTuple):
    """Response of a uniaxial material to a slow pull and push from its unloaded state."""

    kind: str
    """Type in OpenSees."""
    stiffness: float
    """Stiffness at rest: the larger one of pull and push."""
    is_linear: bool
    """True if the force is proportional to deformation (and speed)."""
    one_sided: str
    """Difference of pull and push, or a closing gap; empty if there is none."""
    limit: float
    """Deformation up to which its secant stiffness is that at rest within `DEPARTURE`."""
    dashpot: float
    """Force over speed, at rest."""


def printed_model(ops: Any) -> Printed:
    """Read the printed model of OpenSees."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        ops.printModel("-JSON", "-file", str(path))
        text = path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""
    return Printed(
        uniaxial=_plain(_part(text, "uniaxialMaterials")) | _entries(text, "uniaxialMaterials"),
        solid=_entries(text, "ndMaterials"),
        sections=_entries(text, "sections"),
        transformations=_entries(text, "crdTransformations"),
        elements=_entries(text, "elements"),
    )


def _part(text: str, word: str) -> str:
    # The list of that name; lists begin a line of the printed model and end at the next one.
    begin = text.find(f'\t"{word}": [')
    if begin < 0:
        return ""
    following = [
        text.find(f'\t"{other}": [', begin + 1)
        for other in ("ndMaterials", "sections", "crdTransformations", "nodes", "elements")
    ]
    return text[begin : min((place for place in following if place > 0), default=len(text))]


def _entries(text: str, word: str) -> dict[str, dict[str, Any]]:
    # Some classes print invalid JSON among the others: each entry is read by itself.
    part, decoder, found = _part(text, word), json.JSONDecoder(), {}
    for match in _ENTRY.finditer(part):
        with contextlib.suppress(json.JSONDecodeError):
            entry = decoder.raw_decode(part, match.start())[0]
            found[str(entry["name"])] = entry
    return found


def _plain(part: str) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    places = list(_PLAIN.finditer(part))
    ends = [match.start() for match in places[1:]] + [len(part)]
    for match, end in zip(places, ends if places else [], strict=True):
        own = part[match.end() : end].split('{"name"')[0]
        exponent = _EXPONENT.search(own)
        found[match[2]] = {"name": match[2], "type": match[1]} | (
            {"alpha": float(exponent[1])} if exponent else {}
        )
    return found


def law_of(ops: Any, printed: Printed, tag: str, span: float) -> Law | None:
    """Return the law of a uniaxial material.

    OpenSees tries materials on the original, from which later elements are copied. So the trial is
    made on a copy, which stays in the model under a tag from 2,147,000,000 on; no element has it.
    For elastic materials the printed values are used.
    """
    entry = printed.uniaxial.get(tag)
    if entry is None:
        return None
    kind = str(entry["type"])
    ops.testUniaxialMaterial(int(tag))
    dashpot, at_rest = float(ops.getDampTangent()), float(ops.getTangent())
    if kind in DASHPOTS:
        is_linear = not at_rest and not float(entry.get("alpha", 0.0)) - 1.0
        return Law(kind, at_rest, is_linear, "", 0.0, dashpot)
    if kind == "ElasticMaterial" and entry["Epos"] == entry["Eneg"]:
        return Law(kind, float(entry["Epos"]), True, "", np.inf, dashpot)
    steps = span * np.concatenate([_STEPS * 10.0**power for power in range(-6, 1)])
    secants = np.array([_secants(ops, int(tag), sign * steps) for sign in (1.0, -1.0)])
    first = secants[:, 0]
    stiffness = float(first.max())
    away = np.abs(secants - first[:, None]) > DEPARTURE * max(stiffness, 1e-300)
    within = int(np.argmax(away.any(axis=0)))
    limit = np.inf if not away.any() else float(steps[within - 1]) if within else 0.0
    doubt = _one_sided(secants, dashpot)
    return Law(kind, stiffness, not (away.any() or doubt), doubt, limit, dashpot)


def _one_sided(secants: FloatArray, dashpot: float) -> str:
    pull, push = secants[:, 0].tolist()
    if not secants.any():
        return "" if dashpot else "has no stiffness"
    if not pull and not push:
        return "has no stiffness at rest and acts as a gap"
    if abs(pull - push) > DEPARTURE * max(abs(pull), abs(push)):
        return f"has a stiffness of {pull:.4g} in tension and {push:.4g} in compression"
    ratio = float(secants.max()) / max(pull, push)
    return f"stiffens to {ratio:.3g} times what it is at rest" if ratio > _STIFFENS else ""


def _secants(ops: Any, tag: int, steps: FloatArray) -> list[float]:
    # A copy, as an element would have; it cannot be removed again.
    spare = next(_SPARE_TAGS)
    ops.uniaxialMaterial("Parallel", spare, tag)
    ops.testUniaxialMaterial(spare)
    ops.setStrain(0.0)
    start, found = float(ops.getStress()), []
    for step in steps.tolist():
        ops.setStrain(step)
        found.append((float(ops.getStress()) - start) / step)
    return found


_CLASSES = ("ZeroLength", "CorotTruss")
_ALIKE = 1e-5  # relative difference of matrices that count as one; axes are printed to six digits
_MOVED = 1e-2  # the same of bars, of whose motion the matrix leaves one direction out
_DIRECTIONS = {"P": 0, "Vy": 1, "Vz": 2, "T": 3, "My": 4, "Mz": 5}


def with_viscous_springs(ops: Any, model: OpenSeesModel) -> tuple[SparseMatrix, list[str]]:
    """Return the damping of a model with the viscous part of springs and bars as in their forces.

    A ``zeroLength`` with ``-doRayleigh 1`` puts Rayleigh damping in place of its materials' in the
    damping matrix, while its force has both. A ``corotTruss`` has four times its force's part
    there, because its length is counted twice (openseespy 3.7 and 3.8). The matrix of a pair of
    nodes is either the materials' own, or this and a part in proportion to the stiffness.
    """
    springs = [element for element in model.elements if element.kind in _CLASSES]
    if not springs:
        return model.damping, []
    printed = printed_model(ops)
    groups: dict[frozenset[int], list[ElementEntry]] = {}
    for element in springs:
        groups.setdefault(frozenset(element.nodes), []).append(element)
    at = {tag: place for place, tag in enumerate(model.tags)}
    ndf, damping = model.ndf, model.damping.tolil()
    added = False
    unclear: list[int] = []
    for group in groups.values():
        own, faulty = (
            sum(parts)
            for parts in zip(*(_viscous(ops, printed, model, e) for e in group), strict=True)
        )
        if not own.any():
            continue
        first, second = (slice(ndf * at[n], ndf * (at[n] + 1)) for n in group[0].nodes)
        present = -model.damping[first, second].toarray()
        size = float(np.linalg.norm(own)) * (_MOVED if faulty.any() else _ALIKE)
        if np.linalg.norm(present - own) <= size:
            continue
        if not _is_rayleigh(present - faulty, model, (first, second), size):
            unclear += [element.tag for element in group]
            continue
        for rows, columns, sign in (
            (first, first, 1),
            (second, second, 1),
            (first, second, -1),
            (second, first, -1),
        ):
            damping[rows, columns] = damping[rows, columns].toarray() + sign * (own - faulty)
        added = True
    notes = []
    if unclear:
        notes.append(
            "the damping matrix of OpenSees may not contain the viscous forces of the "
            f"elements {listed(unclear)}: leave -doRayleigh out, use truss in place of "
            "corotTruss, or use separate nodes for viscous elements"
        )
    return sparse.csr_array(damping) if added else model.damping, notes


def _viscous(
    ops: Any, printed: Printed, model: OpenSeesModel, element: ElementEntry
) -> tuple[FloatArray, FloatArray]:
    # Force over speed between its nodes, in the model's axes; and the matrix entry if that is
    # wrong.
    entry = printed.elements.get(str(element.tag), {})
    ndf = model.ndf
    if element.kind != _CLASSES[0]:
        return _viscous_bar(ops, entry, model, element)
    axes = np.array(entry.get("transMatrix", np.eye(3)), dtype=np.float64)
    full = np.zeros((6, 6))
    for tag, word in zip(entry.get("materials", ()), entry.get("dof", ()), strict=True):
        block, row = divmod(_DIRECTIONS[word], 3)
        along = np.zeros(6)
        along[3 * block : 3 * block + 3] = axes[row]
        full += _coefficient(ops, tag) * np.outer(along, along)
    kept = [0, 1, 5] if ndf == 3 else list(range(6))
    return full[np.ix_(kept, kept)], np.zeros((ndf, ndf))


def _viscous_bar(
    ops: Any, entry: dict[str, Any], model: OpenSeesModel, element: ElementEntry
) -> tuple[FloatArray, FloatArray]:
    # The force is along the present chord; the matrix adds the chord before the loads to that.
    start, end = (np.array(ops.nodeCoord(tag), dtype=np.float64) for tag in element.nodes)
    first = end - start
    moved = [np.array(ops.nodeDisp(tag))[: len(first)] for tag in element.nodes]
    now = first + moved[1] - moved[0]
    length = float(np.linalg.norm(first))
    factor = float(entry.get("A", 0.0)) * _coefficient(ops, entry["material"]) if entry else 0.0
    parts = []
    for chord in (now, now + first):
        along = np.zeros(model.ndf)
        along[: len(first)] = chord / np.linalg.norm(now)
        parts.append(factor / length * np.outer(along, along))
    return parts[0], parts[1]


def _coefficient(ops: Any, tag: object) -> float:
    ops.testUniaxialMaterial(int(str(tag)))
    return float(ops.getDampTangent())


def _is_rayleigh(
    damping: FloatArray, model: OpenSeesModel, places: tuple[slice, slice], error: float
) -> bool:
    # True if the damping of two nodes is zero, or a multiple of the stiffness between them.
    if np.linalg.norm(damping) <= error:
        return True
    for stiffness in (-model.stiffness[places].toarray(), -model.initial[places].toarray()):
        norm = float(np.sum(stiffness * stiffness))
        factor = float(np.sum(damping * stiffness)) / norm if norm > 0.0 else 0.0
        if factor >= 0.0 and np.linalg.norm(damping - factor * stiffness) <= error:
            return True
    return False
