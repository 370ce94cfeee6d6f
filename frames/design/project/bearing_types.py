"""Which bearing stands under which column, where a project has several types."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from frames.design._errors import ProjectError
from frames.statics.gravity import gravity
from lir_element.argument_checks import listed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from frames.design.project.schema import BearingType
    from frames.frame import Frame
    from lir_element import LIRBearing

STANDARD = "standard"
"""Name of the type that ``[bearing]`` describes."""

_NAMED = 6  # columns that a message lists


def types_by_column(given: Mapping[str, BearingType], frame: Frame) -> dict[str, str]:
    """Return the type of each bearing of a frame."""
    found: dict[str, str] = dict.fromkeys(frame.bearings, STANDARD)
    by_load = {}
    for name, kind in given.items():
        if bool(kind.columns) == (kind.above is not None):
            msg = (
                f"[bearings.{name}] must say under which columns it stands: either columns = "
                '["0-0", "0-1"], or above = "1500 kN", the average axial load from which on'
            )
            raise ProjectError(msg)
        if kind.above is not None:
            by_load[name] = kind.above
    if by_load:
        loads = gravity(frame).axial_forces
        for bearing, load in zip(frame.bearings, loads, strict=True):
            heavy = [name for name, above in by_load.items() if load >= above]
            if heavy:
                found[bearing] = max(heavy, key=lambda name: by_load[name])
    taken: dict[str, str] = {}
    for name, kind in given.items():
        for column in map(str, kind.columns):
            for bearing in _named(column, name, frame):
                if bearing in taken:
                    msg = (
                        f"[bearings.{name}] columns: {column} is of [bearings.{taken[bearing]}] "
                        "already: name it once"
                    )
                    raise ProjectError(msg)
                taken[bearing] = found[bearing] = name
    idle = [name for name in given if name not in found.values()]
    if idle:
        msg = (
            f"[bearings.{idle[0]}] stands under no column: name its columns, or a lower load above"
        )
        raise ProjectError(msg)
    return found


def on_types(frame: Frame, chosen: Mapping[str, str], devices: Mapping[str, LIRBearing]) -> Frame:
    """Return a frame on bearings of several types."""
    others = {name: devices[kind] for name, kind in chosen.items() if kind != STANDARD}
    return frame.with_bearings(others) if others else frame


def columns_by_type(chosen: Mapping[str, str]) -> dict[str, list[str]]:
    """Return the bearings of each type, where there are several types; nothing where there is one."""
    found: dict[str, list[str]] = {}
    for name, kind in chosen.items():
        found.setdefault(kind, []).append(name)
    return found if len(found) > 1 else {}


def _named(column: str, kind: str, frame: Frame) -> list[str]:
    # The bearings of a column, or of a group of the model that the frame was read from.
    groups = {} if frame.imported is None else frame.imported.groups
    own = {column, f"bearing-{column}"} & set(frame.bearings)
    if own or column not in groups:
        try:
            return [bearing_under(column, frame)]
        except ProjectError as cause:
            msg = f"[bearings.{kind}] columns: {cause}"
            raise ProjectError(msg) from None
    found = [name for label in groups[column] for name in (f"bearing-{label}", label)]
    standing = [name for name in found if name in frame.bearings]
    if not standing:
        msg = f"[bearings.{kind}] columns: no joint or link of the group {column} has a bearing"
        raise ProjectError(msg)
    return standing


def bearing_under(column: str, frame: Frame) -> str:
    """Return the bearing of a column that is named as its bearing, or without that word."""
    for name in (column, f"bearing-{column}"):
        if name in frame.bearings:
            return name
    names = [name.removeprefix("bearing-") for name in frame.bearings]
    near = difflib.get_close_matches(column.removeprefix("bearing-"), names, n=1)
    meant = f'; is "{near[0]}" meant?' if near else f": there are {listed(names, _NAMED)}"
    msg = f"{column} is no column with a bearing{meant}"
    raise ProjectError(msg)
