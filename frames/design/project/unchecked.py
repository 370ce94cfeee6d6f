"""What a project's checks leave out, provision by provision; what of a code is from memory."""

from __future__ import annotations

from typing import TYPE_CHECKING

from frames.design.codes.provisions import OF_BEARINGS, states_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.codes.provisions import ProvisionState
    from frames.design.codes.registry import DesignCode
    from frames.design.project.inputs import ProjectInputs
    from frames.design.project.preliminary import Preliminary


def provisions_of(
    parts: ProjectInputs, known: Preliminary, checks: Iterable[Check], *, is_run: bool = True
) -> tuple[ProvisionState, ...]:
    """Return whether each provision of the code is checked in a project, and why not."""
    asked = (*parts.code().provisions, *OF_BEARINGS)
    return states_of(asked, facts_of(parts, known), (*checks, *known.checks), is_run=is_run)


def facts_of(parts: ProjectInputs, known: Preliminary) -> frozenset[str]:
    """Return what of `NEEDS` a project has, and what its structure is made of."""
    file, frame, above = parts.file, known.frame, known.superstructure
    limits, facts = parts.limits(), [one.get("near_fault") for one in known.motions.facts.values()]
    laws = [getattr(link.law, "yield_force", None) for link in frame.links.values()]
    there = {
        "superstructure": above is not None,
        "wind": above is not None and above.wind_shear > 0.0,
        "service": above is not None and above.service_displacement > 0.0,
        "storey stiffness": above is not None and above.storey_stiffness is not None,
        "combinations": bool(known.system.combinations),
        "storeys": len(frame.levels) > 1,
        "moved": bool(known.moved),
        "bounds": not {*file.analysis.bounds}.isdisjoint(known.equivalent.bounds),
        "gap": limits.moat_gap is not None,
        "pressure": limits.interface_pressure is not None,
        "liner": limits.liner_pressure is not None,
        "rim strength": limits.rim_strength is not None,
        "near fault": any(facts),
        "walls": bool(getattr(file.structure, "walls", ())),
        "dampers": bool(file.dampers),
        "yields": bool(frame.hinges) or any(force is not None for force in laws),
    }
    return frozenset(name for name, is_there in there.items() if is_there)


def from_memory(code: DesignCode) -> tuple[str, ...]:
    """Return which values of a code are from memory alone."""
    said = [f"{v.clause} ({v.what})" for v in code.values.values() if v.standing.starred]
    return (f"from memory, not read in the standard: {'; '.join(said)}",) if said else ()
