"""What a project's checks leave out, since its file gives no number for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.design.calculation.check import Check
    from frames.design.codes.registry import DesignCode
    from frames.design.project.schema import ProjectFile


def unchecked(file: ProjectFile) -> tuple[str, ...]:
    """Return what is not checked for want of a number, each with the key that gives it.

    Parameters
    ----------
    file : ProjectFile
        The project's file.

    Returns
    -------
    tuple of str
        Sentences, in the order of the file.
    """
    above = file.superstructure
    found = []
    if above is None:
        found.append(
            "shears and drifts above the isolation, and overturning: not checked, since there is "
            "no [superstructure] with R"
        )
    if above is None or not above.wind_shear:
        found.append(
            "sliding under wind: not checked, since no wind shear is given ([superstructure] "
            "wind_shear)"
        )
    if above is None or not above.service_displacement:
        found.append(
            "movements in service: not checked, since no displacement is given ([superstructure] "
            "service_displacement)"
        )
    if file.limits.moat_gap is None:
        found.append(
            "separation to walls and neighbours: not checked, since no clear distance is given "
            "([limits] moat_gap)"
        )
    return tuple(found)


def from_memory(checks: Iterable[Check], code: DesignCode) -> tuple[str, ...]:
    """Return which clauses and values of a code are from memory alone.

    Parameters
    ----------
    checks : iterable of Check
        Checks of a project.
    code : DesignCode
        Its code.

    Returns
    -------
    tuple of str
        One sentence, with each clause once and what is checked by it; none where nothing is.
    """
    clauses: dict[str, list[str]] = {}
    for check in checks:
        if check.standing.starred:
            titles = clauses.setdefault(check.clause, [])
            title = check.title.partition(",")[0]
            if title not in titles:
                titles.append(title)
    said = [f"{clause} ({', '.join(titles)})" for clause, titles in sorted(clauses.items())]
    if code.damping.standing.starred:
        said.append(f"{code.damping.source} (damping factors)")
    said += [f"{rule.clause} (scaling of motions)" for rule in code.scaling[:1]]
    return (f"from memory, not read in the standard: {'; '.join(said)}",) if said else ()
