"""The structure of a project in an engineer's words: storeys, sections, loads."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from frames.design.project.schema_structure import MomentFrame, ShearBuilding
from frames.design.project.structure_plan import DIRECTIONS, sections_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames.design.project.schema import ProjectFile
    from frames.frame import Frame

Rows = list[tuple[str, str]]


def structure_rows(file: ProjectFile, frame: Frame) -> Rows:
    """Return what the structure is, a row for each thing.

    Parameters
    ----------
    file : ProjectFile
        The project's file.
    frame : Frame
        The structure that was made of it.

    Returns
    -------
    list of (str, str)
        What, and how it is; sections by storey, storeys of one section together.
    """
    given = file.structure
    levels = frame.levels
    rows = [
        ("structure", f"{given.kind}, {len(levels) - 1} storeys on {len(frame.bearings)} bearings")
    ]
    if len(levels) > 1:
        rows.append(("height above the base", f"{levels[-1].z - levels[0].z:.4g} m"))
    if isinstance(given, (MomentFrame, ShearBuilding)):
        sides = (n * w for n, w in zip(given.bays, given.bay_width, strict=True))
        rows.append(("plan", " x ".join(f"{side:.4g}" for side in sides) + " m"))
    if isinstance(given, MomentFrame):
        rows += _sections(given)
        rows.append(("mass of a floor besides its members", f"{given.floor_load:.4g} kg/m2"))
    return rows


def _sections(given: MomentFrame) -> Rows:
    found = sections_of(given)
    rows = _by_storey("columns", [one.said for one in found.columns])
    alike = [one.said for one in found.beams["x"]] == [one.said for one in found.beams["y"]]
    for direction in DIRECTIONS[: 1 if alike else 2]:
        what = "beams" if alike else f"beams along {direction}"
        rows += _by_storey(what, [one.said for one in found.beams[direction]])
    base = {found.base_beams[direction].said: direction for direction in DIRECTIONS}
    for said, direction in base.items():
        rows.append(("base beams" if len(base) == 1 else f"base beams along {direction}", said))
    return rows


def _by_storey(what: str, said: Sequence[str]) -> Rows:
    rows, storey = [], 1
    for text, group in groupby(said):
        last = storey + len(list(group)) - 1
        where = f", storey {storey}" if last == storey else f", storeys {storey} to {last}"
        rows.append((what + ("" if last - storey + 1 == len(said) else where), text))
        storey = last + 1
    return rows
