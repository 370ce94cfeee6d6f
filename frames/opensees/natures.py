"""Linear, nonlinear and undecidable elements of an OpenSees model."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from frames._errors import ModelError, argument, in_python
from frames.opensees.materials import DASHPOTS, DEPARTURE, Printed, law_of, printed_model
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from frames.opensees.materials import Law
    from frames.opensees.model import ElementEntry, OpenSeesModel

LINEAR = (
    "ElasticBeam2d",
    "ElasticBeam3d",
    "ElasticTimoshenkoBeam2d",
    "ElasticTimoshenkoBeam3d",
    "ModElasticBeam2d",
    "ModElasticBeam3d",
)
"""Classes of elements that are linear for any material: only P-Delta changes them."""

SPRINGS = ("ZeroLength", "TwoNodeLink", "CoupledZeroLength")
"""Classes of elements whose uniaxial materials see displacements of nodes, not strains."""

_COUPLED = "CoupledZeroLength"
_ALONG = "has a viscous force along the displacement between its nodes, not along the velocity"
_CURVED = "has a force that is not proportional to speed, or a spring and a dashpot in series"

BARS = ("Truss", "Truss2", "CorotTruss", "CorotTruss2")
"""Classes of elements whose uniaxial material has a strain."""

_ELASTIC_SECTIONS = (
    "ElasticSection2d",
    "ElasticSection3d",
    "ElasticShearSection2d",
    "ElasticShearSection3d",
    "ElasticMembranePlateSection",
    "ElasticPlateSection",
)
_ELASTIC_SOLID = "ElasticIsotropic"
_WRAPPERS = (
    "PlateFiberMaterial",
    "PlaneStressMaterial",
    "PlaneStrainMaterial",
    "PlateFromPlaneStressMaterial",
    "BeamFiberMaterial",
)


class Nature(NamedTuple):
    """Properties of an element."""

    element: ElementEntry
    is_known: bool
    """True if OpenSees shows all its laws."""
    curved: tuple[Law, ...]
    """Its nonlinear laws."""

    @property
    def is_linear(self) -> bool:
        """True if nothing of it can leave its present stiffness."""
        return self.is_known and not self.curved


@dataclass
class _Reader:
    # Reads each law once.
    ops: Any
    printed: Printed
    span: float
    known: dict[tuple[str, bool], Law | None] = field(default_factory=dict)

    def laws(self, tags: list[str], *, is_spring: bool) -> tuple[bool, list[Law]]:
        found = []
        for tag in tags:
            key = tag, is_spring
            if key not in self.known:
                span = self.span if is_spring else 1.0
                self.known[key] = law_of(self.ops, self.printed, tag, span)
            found.append(self.known[key])
        laws = [law for law in found if law is not None]
        return len(laws) == len(found) > 0, laws

    def section(self, tag: str) -> tuple[bool, list[Law]]:
        entry = self.printed.sections.get(tag, {})
        kind = str(entry.get("type", ""))
        if kind in _ELASTIC_SECTIONS:
            return True, []
        if kind == "SectionAggregator":
            known, laws = self.laws(_tags(entry, "materials"), is_spring=False)
            inner = self.section(str(entry["section"])) if entry.get("section") else (True, [])
            return known and inner[0], laws + inner[1]
        fibers = sorted({str(fiber["material"]) for fiber in entry.get("fibers", ())})
        if kind.startswith("Fiber"):
            return self.laws(fibers, is_spring=False)
        return bool(fibers) and all(self.is_elastic_solid(tag) for tag in fibers), []

    def is_elastic_solid(self, tag: str) -> bool:
        entry = self.printed.solid.get(tag, {})
        kind = str(entry.get("type", ""))
        if kind in _WRAPPERS:
            return self.is_elastic_solid(str(entry.get("material")))
        return kind.startswith(_ELASTIC_SOLID)

    def nature(self, element: ElementEntry) -> Nature:
        entry = self.printed.elements.get(str(element.tag), {})
        tags = _tags(entry, "materials") or _tags(entry, "material")
        sections = _tags(entry, "sections") or _tags(entry, "section")
        if element.kind in (*SPRINGS, *BARS):
            known, laws = self.laws(tags, is_spring=element.kind in SPRINGS)
            if element.kind == _COUPLED:
                laws = [law._replace(is_linear=law.is_linear and not law.dashpot) for law in laws]
        elif sections:
            parts = [self.section(tag) for tag in sorted(set(sections))]
            known, laws = all(part[0] for part in parts), [law for _, own in parts for law in own]
        else:
            known, laws = False, []
        curved = tuple(dict.fromkeys(law for law in laws if not law.is_linear))
        return Nature(element, known, curved)


def _tags(entry: dict[str, Any], word: str) -> list[str]:
    given = entry.get(word, [])
    return [str(tag) for tag in given] if isinstance(given, list) else [str(given)]


def natures(ops: Any, model: OpenSeesModel) -> list[Nature]:
    """Return the properties of all elements that are not linear by their class."""
    others = [element for element in model.elements if element.kind not in LINEAR]
    if not others:
        return []
    span = float(np.ptp(model.coordinates, axis=0).max()) or 1.0
    reader = _Reader(ops, printed_model(ops), span)
    return [reader.nature(element) for element in others]


def refuse_one_sided(found: list[Nature], *, accept: bool) -> list[str]:
    """Refuse bars and springs without a representative linear stiffness: gaps, ties, dashpots."""
    bad = [
        (nature.element, law)
        for nature in found
        if nature.element.kind in (*SPRINGS, *BARS)
        for law in nature.curved
        if law.one_sided
        or law.kind in DASHPOTS
        or (nature.element.kind == _COUPLED and law.dashpot)
    ]
    if not bad:
        return []
    element, law = bad[0]
    tags = listed(sorted({each.tag for each, _ in bad}))
    if law.one_sided:
        what = law.one_sided
        instead = "Gap(gap=..., stiffness=...), or Tie(stiffness=...) for tension only"
    else:
        what = _ALONG if element.kind == _COUPLED else _CURVED
        instead = "ViscousDamper(coefficient=..., exponent=...)"
    text = f"element {element.tag} ({element.kind}) is of {law.kind}, which {what}"
    if accept:
        return [
            f"{text} (elements {tags}): accept_nonlinear keeps the present stiffness, so it "
            "neither opens, closes nor slackens"
        ]
    i, j = element.nodes[0], element.nodes[-1]
    afterwards = in_python(
        f', and add it afterwards by frame.add_link("link-{element.tag}", "{i}", "{j}", '
        f"law, direction) with {instead}"
    )
    message = (
        f"{text}, and has no linear stiffness (elements {tags}): remove it first, "
        f"ops.remove('element', {element.tag}){afterwards}; or keep the present "
        f"stiffness, {argument('accept_nonlinear', True)}"
    )
    raise ModelError(message)


def told(found: list[Nature], shares: dict[int, float]) -> list[str]:
    """Return the elements that may leave their present stiffness, with their energy share."""
    groups: dict[tuple[str, str], list[Nature]] = {}
    for nature in found:
        if not nature.is_linear:
            kinds = ", ".join(sorted({law.kind for law in nature.curved}))
            groups.setdefault((nature.element.kind, kinds), []).append(nature)
    return [_note(kind, kinds, group, shares) for (kind, kinds), group in groups.items()]


def _note(kind: str, kinds: str, group: list[Nature], shares: dict[int, float]) -> str:
    tags = listed([nature.element.tag for nature in group])
    share = 100.0 * sum(shares.get(nature.element.tag, 0.0) for nature in group)
    limits = [law.limit for nature in group for law in nature.curved if np.isfinite(law.limit)]
    text = f"elements {kind} ({tags}) "
    text += f"are nonlinear, of {kinds}" if kinds else "may be nonlinear (OpenSees shows no law)"
    text += ": they are taken as linear with their present stiffness and damping"
    if kinds and limits:
        unit = "deformation" if kind in SPRINGS else "strain"
        text += f", valid within {100.0 * DEPARTURE:.0f} % up to a {unit} of {min(limits):.3g}"
    if not shares:
        return text
    return (
        f"{text}; they have {share:.3g} % of the strain energy under horizontal load on "
        "a fixed base: if they are 10 % softer, displacements above the base are about "
        f"{share / 10.0:.2g} % larger"
    )
