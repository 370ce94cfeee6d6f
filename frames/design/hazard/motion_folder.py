"""Sets of motions from a folder: by a table that names the files, or by the names of PEER files."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from frames._errors import MotionError
from frames.motion.components import AXES
from frames.motion.ground_motion import GroundMotion

if TYPE_CHECKING:
    from frames.motion.records import PathLike

Facts = dict[str, object]
Loaded = tuple[dict[str, GroundMotion], dict[str, Facts]]

_READ = {"name", "dt", "unit", *AXES}
_YES_NO = {"yes": True, "true": True, "no": False, "false": False}
_VERTICAL = re.compile(r"[-_.]?(UP|VER|VRT|V|DWN|DN|Z)$", re.IGNORECASE)
_HORIZONTAL = re.compile(r"[-_.]?(\d{3}|[NS]\d{2}[EW]|EW|NS|E|N)$", re.IGNORECASE)
_AZIMUTHS = {"N": 0.0, "NS": 0.0, "E": 90.0, "EW": 90.0}


def read_table(folder: PathLike, table: str) -> Loaded:
    """Return motions and facts of the rows of a table; columns as in `MotionSet.from_folder`."""
    path = Path(folder) / table
    if not path.is_file():
        msg = f"{path} is no file: give the folder of the motions, and table= as it is named there"
        raise MotionError(msg)
    rows = pd.read_csv(path, dtype=str, keep_default_na=False, skipinitialspace=True)
    rows.columns = rows.columns.str.strip()
    if "name" not in rows or not set(AXES) & set(rows.columns):
        msg = f"{table} has the columns {list(rows.columns)}: it needs name, and x, y or z"
        raise MotionError(msg)
    motions: dict[str, GroundMotion] = {}
    facts: dict[str, Facts] = {}
    for row in rows.to_dict("records"):
        given = {str(key): str(value).strip() for key, value in row.items() if str(value).strip()}
        name = given.get("name", "")
        if not name or name in motions:
            msg = f"{table}: name = {name!r} is empty or there twice: give each motion its own"
            raise MotionError(msg)
        motions[name] = _motion(Path(folder), given)
        facts[name] = {key: _value(given[key]) for key in given if key not in _READ}
    return motions, facts


def _motion(folder: Path, row: Mapping[str, str]) -> GroundMotion:
    """Return the motion of one row."""
    files = {axis: folder / row[axis] for axis in AXES if axis in row}
    absent = [path for path in files.values() if not path.is_file()]
    if absent or not files:
        found = f"{absent[0]} is no file" if absent else "no x, y or z is given"
        msg = f"{row['name']}: {found}: name a file of the folder in x, y and z"
        raise MotionError(msg)
    name, (x, y, z) = row["name"], (files.get(axis) for axis in AXES)
    if all(path.suffix.lower() == ".at2" for path in files.values()):
        return GroundMotion.from_at2(x, y, z, name=name)
    if "unit" not in row:
        msg = f"{name}: files of columns need their unit in the column unit: g, m/s2, cm/s2, gal"
        raise MotionError(msg)
    step = _value(row["dt"]) if "dt" in row else None
    if step is not None and not isinstance(step, float):
        msg = f"{name}: dt = {row['dt']} is no number: give the time step in s"
        raise MotionError(msg)
    return GroundMotion.from_columns(
        x=x, y=y, z=z, unit=row["unit"], dt=step, time=0 if step is None else None, name=name
    )


def _value(text: str) -> object:
    """Return an entry as yes or no, as a number, or as the text it is."""
    if text.lower() in _YES_NO:
        return _YES_NO[text.lower()]
    number = pd.to_numeric(text, errors="coerce")
    return text if math.isnan(number) else float(number)


def read_at2_folder(folder: PathLike) -> Loaded:
    """Return the motions that PEER files of a folder make; names as in `from_at2_folder`."""
    groups: dict[str, dict[str, Path]] = {}
    for path in sorted(p for p in Path(folder).iterdir() if p.suffix.lower() == ".at2"):
        vertical, horizontal = _VERTICAL.search(path.stem), _HORIZONTAL.search(path.stem)
        found = vertical or horizontal
        if found is None:
            msg = f"{path.name}: the name ends in no azimuth and no direction: use from_folder"
            raise MotionError(msg)
        groups.setdefault(path.stem[: found.start()], {})[found[1].upper()] = path
    if not groups:
        msg = f"{folder} holds no AT2 file: give the folder of the records"
        raise MotionError(msg)
    motions: dict[str, GroundMotion] = {}
    facts: dict[str, Facts] = {}
    for name, files in groups.items():
        up = [mark for mark in files if not _HORIZONTAL.fullmatch(mark)]
        flat = [mark for mark in files if mark not in up]
        if len(flat) != 2 or len(up) > 1:
            held = ", ".join(path.name for path in files.values())
            msg = f"{name}: {held} make no pair of horizontal components: use from_folder"
            raise MotionError(msg)
        scale = (1.0, 1.0, -1.0 if up and up[0] in {"DWN", "DN"} else 1.0)
        z = files[up[0]] if up else None
        motions[name] = GroundMotion.from_at2(
            files[flat[0]], files[flat[1]], z, scale=scale, name=name
        )
        azimuths = [_azimuth(mark) for mark in flat]
        keys = ("azimuth_x", "azimuth_y")
        facts[name] = {k: a for k, a in zip(keys, azimuths, strict=True) if a is not None}
    return motions, facts


def _azimuth(mark: str) -> float | None:
    """Return the azimuth [degrees] that the end of a name tells, None where it is unclear."""
    return float(mark) if mark.isdigit() else _AZIMUTHS.get(mark)
