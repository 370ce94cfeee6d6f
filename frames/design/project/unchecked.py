"""What a project's checks leave out, since its file gives no number for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
    if file.limits.moat_gap is None and file.moat is None:
        found.append(
            "separation to walls and neighbours: not checked, since no clear distance is given "
            "([limits] moat_gap)"
        )
    return tuple(found)


def from_memory(code: DesignCode) -> tuple[str, ...]:
    """Return which values of a code are from memory alone.

    Parameters
    ----------
    code : DesignCode
        The code.

    Returns
    -------
    tuple of str
        One sentence, with clause and value of each; none where all were read, or agree with a
        public text.
    """
    said = [f"{v.clause} ({v.what})" for v in code.values.values() if v.standing.starred]
    return (f"from memory, not read in the standard: {'; '.join(said)}",) if said else ()
