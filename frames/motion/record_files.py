"""Records in the formats of networks: recognised, read by the table of formats, put on axes."""

from __future__ import annotations

import itertools
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames._types import FloatArray
from frames.motion.columns import even_step
from frames.motion.formats import FORMATS, Format
from frames.motion.number_text import Writing, acceleration_unit, rows_of, text_lines
from frames.motion.records import (
    AXES,
    PAD_PART,
    PAD_SAMPLES,
    AccelerationTrace,
    PathLike,
    is_at2,
    read_at2,
)
from lir_element.texts import worded

_LOOKED_AT = 60
"""Lines at the beginning of a file by which its format is recognised."""

_LENGTH_TOLERANCE = 0.05  # of a duration, which headers round
_PEAK_TOLERANCE = 0.02
"""Tolerance of the samples to the peak in the header [-]."""

_KIK_NET = {"1": "NS1", "2": "EW1", "3": "UD1", "4": "NS", "5": "EW", "6": "UD"}
_TEXT = re.compile(r"[A-CF-Za-cf-z/]")
_NOTHING = 1e38
"""SMC writes a larger value for a missing number."""


def format_of(lines: Sequence[str]) -> Format | None:
    """Return the format of a file by its first lines; None if it is none of the table."""
    head = "\n".join(lines[:_LOOKED_AT])
    return next((each for each in FORMATS if _found(each.mark, head)), None)


def is_record(path: PathLike) -> bool:
    """Return whether a file is in a format that is read by name."""
    lines = text_lines(Path(path))
    return is_at2(lines) or format_of(lines) is not None


def read_record(path: PathLike) -> list[Component]:
    """Read all components of a file in the format of a network."""
    name, lines = Path(path).name, text_lines(Path(path))
    if is_at2(lines):
        return [Component(lines[1].rpartition(",")[2].strip(), read_at2(path))]
    form = format_of(lines)
    if form is None:
        known = "; ".join(each.name for each in FORMATS)
        msg = (
            f"{name} is in no known format (PEER AT2; {known}): use from_columns(x=path, "
            'order="rows", skip=<lines of the header>, dt=<step in s>, unit="cm/s2")'
        )
        raise MotionError(msg)
    starts = [k for k, line in enumerate(lines) if form.parts and _found(form.parts, line)]
    found: list[Component] = []
    for start, end in itertools.pairwise(sorted({0, *starts, len(lines)})):
        at = start + 1 if _found(r"^\s*(?:/&|End-of-data)", lines[start]) else start
        if re.search(r"\w", "".join(lines[at:end])):
            found += _components(name, form, [(k + 1, lines[k]) for k in range(at, end)])
    return found


def _found(pattern: str, text: str) -> re.Match[str] | None:
    return re.search(pattern, text, re.IGNORECASE | re.MULTILINE) if pattern else None


def _components(name: str, form: Format, lines: list[tuple[int, str]]) -> list[Component]:
    """Return the components of one header and its numbers."""
    size = form.first
    if isinstance(size, str):
        at = next((k for k, (_, line) in enumerate(lines) if _found(str(size), line)), None)
        if at is None:
            msg = (
                f"{name}: {form.name}: line {lines[0][0]} begins a component without numbers: "
                "download the file again"
            )
            raise MotionError(msg)
        size = at + 1 + form.after
    head, body = [line for _, line in lines[:size]], lines[size:]
    known = _smc(head) if form.name.startswith("SMC") else _header(form, head)
    skipped = int(known.get("comments", 0.0))
    body = [(k, line) for k, line in body[skipped:] if line.strip()]
    text = "\n".join(head)
    titles = _directions(form, text)
    factor = _factor(name, form, text)
    count = known.get("count")
    if count is None and "step" in known and "length" in known:
        count = round(known["length"] / known["step"])
    if count is None or ("step" not in known and "pairs" not in form.order and known["pairs"] < 1):
        msg = (
            f"{name}: the header of {form.name} has no number of samples or no time step: "
            "download the file again, or use from_columns"
        )
        raise MotionError(msg)
    width = int(known.get("width", form.width)) or None
    values, step = _values(name, form, body, int(count), len(titles), width, known)
    if form.mean:
        values = values - values.mean(axis=0)
    found = [
        Component(title, AccelerationTrace(factor * column, step))
        for title, column in zip(titles, values.T, strict=True)
        if title.upper() != "TIME"
    ]
    _compare_peak(name, form, text, found[0].trace.acceleration)
    return found


def _header(form: Format, head: list[str]) -> dict[str, float]:
    """Return count, length, step and width as a header names them."""
    text, known = "\n".join(head), {"pairs": 0.0}
    for key, pattern in {"count": form.size, "length": form.length, "step": form.step}.items():
        if match := _found(pattern, text):
            known[key] = float(next(group for group in match.groups() if group))
    if match := _found(form.rate, text):
        known["step"] = 1.0 / float(match[1])
    if match := re.search(r"\(\d+[FEI](\d+)(?:\.\d+)?\)\s*$", head[-1], re.IGNORECASE):
        known["width"] = float(match[1])
    if form.name == "COSMOS":  # the 34th of its real values
        start = next(k for k, line in enumerate(head) if "Real-header values" in line)
        rows = int(re.findall(r"\d+", head[start])[1])
        reals = [
            float(word) for line in head[start + 1 : start + 1 + rows] for word in line.split()
        ]
        known["step"] = reals[33]
    return known


def _smc(head: list[str]) -> dict[str, float]:
    """Return the numbers of a header of SMC by name: 48 whole ones, and 50 others."""
    whole = [int(line[k : k + 10]) for line in head[11:17] for k in range(0, 80, 10)]
    reals = [float(line[k : k + 15]) for line in head[17:27] for k in range(0, 75, 15)]
    pairs = reals[1] > _NOTHING  # digitised from film: no samples a second
    known = {"comments": float(whole[15]), "pairs": float(pairs)}
    known["count"] = float(whole[16] // 2 if pairs else whole[16])
    return known if pairs else known | {"step": 1.0 / reals[1]}


def _directions(form: Format, text: str) -> list[str]:
    """Return the directions of the columns of a part, one if it is one component."""
    match = _found(form.direction, text)
    found = match[1].strip() if match else ""
    if form.order != "columns":
        return [_KIK_NET.get(found, found) if form.mean else found]
    return [each.strip() for each in re.split(r"[/;]|\s+", found) if each.strip()]


def _factor(name: str, form: Format, text: str) -> float:
    """Return the size of the numbers' unit [m/s2]."""
    match = _found(form.unit, text.splitlines()[-1]) or _found(form.unit, text)
    if match is None and not form.fixed_unit:
        msg = f"{name}: the header of {form.name} has no unit: download the file again"
        raise MotionError(msg)
    if match is not None and match.lastindex == 2:
        return 0.01 * float(match[1]) / float(match[2])
    unit = form.fixed_unit if match is None else match[1]
    factor = acceleration_unit(unit)
    if factor is None:
        msg = (
            f"{name}: the unit {unit!r} is not an acceleration: use the processed record "
            "(volume 1 or 2)"
        )
        raise MotionError(msg)
    return factor


def _values(
    name: str,
    form: Format,
    body: list[tuple[int, str]],
    count: int,
    columns: int,
    width: int | None,
    known: dict[str, float],
) -> tuple[FloatArray, float]:
    """Return samples (count, columns) and the time step [s]."""
    flat = _flat(name, body, width)
    pairs = known["pairs"] > 0.0 or (form.order == "rows or pairs" and len(flat) >= 2 * count)
    size = count * (2 if pairs else columns)
    more = len(flat) - size if form.whole else 0
    if len(flat) < size or more > max(PAD_SAMPLES * columns, PAD_PART * size):
        msg = (
            f"{name}: {form.name}: the header states {count} samples, but the file has "
            f"{len(flat) // (2 if pairs else columns)}: download the file again"
        )
        raise MotionError(msg)
    if pairs:
        try:
            step = even_step(name, flat[0:size:2])
        except MotionError as cause:
            msg = (
                f"{name}: {form.name}: an uncorrected record with uneven times ({cause}): use "
                "the corrected record (volume 2)"
            )
            raise MotionError(msg) from cause
        return flat[1:size:2, None], step
    step = known.get("step", known.get("length", 0.0) / count)
    length, lasts = known.get("length", 0.0), step * count
    if length > 0.0 and abs(lasts - length) > max(1.0, _LENGTH_TOLERANCE * length):
        msg = (
            f"{name}: {form.name}: the header states {length:g} s, but {count} samples at "
            f"its step of {step:g} s last {lasts:g} s: download the file again, or use "
            "from_columns with the right step"
        )
        raise MotionError(msg)
    return flat[:size].reshape(count, columns), step


def _flat(name: str, body: list[tuple[int, str]], width: int | None) -> FloatArray:
    """Return the numbers that follow a header, up to the first line of text."""
    end = next((k for k, (_, line) in enumerate(body) if _TEXT.search(line)), None)
    lines = [(k, line.replace("\0", "")) for k, line in body[:end]]
    for writing in [Writing(), Writing(width=width)][: 1 if width is None else 2]:
        try:
            rows = rows_of(name, lines, writing)
        except MotionError:
            if writing.width == width:
                raise
        else:
            break
    return np.array([value for row in rows for value in row], dtype=np.float64)


def _compare_peak(name: str, form: Format, text: str, values: FloatArray) -> None:
    match = _found(form.peak, text)
    if match is None:
        return
    factor = acceleration_unit(form.peak_unit or {"cm": "cm/s2"}.get(match[2].lower(), match[2]))
    if factor is None:
        return
    said, peak = abs(float(match[1])) * factor, float(np.abs(values).max())
    digits = 0.5 * 10.0 ** -len(match[1].partition(".")[2]) * factor
    if said > 0.0 and abs(peak - said) > _PEAK_TOLERANCE * said + digits:
        msg = worded(
            "{name}: the header states a peak of {said:.4g} m/s2, but the samples reach "
            "{peak:.4g}: check the unit and the offset in the file",
            name=name,
            said=said,
            peak=peak,
        )
        warnings.warn(msg, MotionWarning, stacklevel=6)


def single_traces(
    files: dict[str, Path],
) -> tuple[dict[str, AccelerationTrace], dict[str, float]]:
    """Read files of one component each, by axis; return them, and azimuths as facts."""
    found: dict[str, Component] = {}
    for axis, path in files.items():
        every = read_record(path)
        if len(every) != 1:
            named = ", ".join(each.direction for each in every)
            msg = (
                f"{path.name} holds {len(every)} components ({named}), but {axis} is one: put "
                "the file in the column record, and the directions in x, y and z"
            )
            raise MotionError(msg)
        found[axis] = every[0]
    return {axis: each.trace for axis, each in found.items()}, _azimuths(found)


def _azimuths(chosen: dict[str, Component]) -> dict[str, float]:
    return {
        f"azimuth_{axis}": azimuth
        for axis, each in chosen.items()
        if axis != "z" and (azimuth := each.azimuth) is not None
    }


def record_traces(
    paths: Sequence[PathLike], wanted: dict[str, str | None]
) -> tuple[dict[str, AccelerationTrace], dict[str, float]]:
    """Read files of one record, and put their components on axes."""
    if not paths:
        msg = "no file is given: pass the files of the record, from_record('A.EW', 'A.NS', 'A.UD')"
        raise MotionError(msg)
    every = [component for path in paths for component in read_record(path)]
    named = ", ".join(each.direction or "without a name" for each in every)
    chosen: dict[str, Component] = {}
    if any(wanted.values()):
        for axis, direction in wanted.items():
            if direction is not None:
                same = [
                    e for e in every if plain_direction(e.direction) == plain_direction(direction)
                ]
                if len(same) != 1:
                    msg = (
                        f"{axis} = {direction!r} is {len(same)} of the directions {named}: "
                        "write one as listed"
                    )
                    raise MotionError(msg)
                chosen[axis] = same[0]
    else:
        up = [each for each in every if each.vertical]
        flat = [each for each in every if not each.vertical]
        if len(up) > 1 or len(flat) > 2:
            msg = (
                f"{', '.join(Path(path).name for path in paths)} hold {len(every)} components "
                f"({named}): set the directions of x, y and z, for example "
                f"x={flat[0].direction!r}"
            )
            raise MotionError(msg)
        chosen = dict(zip("xy", flat, strict=False)) | dict(zip("z", up, strict=False))
    traces = {axis: chosen[axis].trace for axis in AXES if axis in chosen}
    if "z" in traces and plain_direction(chosen["z"].direction) in {"DOWN", "DN", "DWN"}:
        traces["z"] = AccelerationTrace(-traces["z"].acceleration, traces["z"].dt)
    return traces, _azimuths(chosen)


_VERTICAL = re.compile(r"UP|DOWN|DN|DWN|UD|VERT?\w*|VRT|V|Z|U|..Z", re.IGNORECASE)
_QUADRANT = re.compile(r"([NS])(\d{1,2})([EW])", re.IGNORECASE)
_NORTH = {"N": 0.0, "NS": 0.0, "NORTH": 0.0, "S": 180.0, "SOUTH": 180.0}
_AZIMUTHS = _NORTH | {"E": 90.0, "EW": 90.0, "EAST": 90.0, "W": 270.0, "WEST": 270.0}


class Component(NamedTuple):
    """One component of a record."""

    direction: str  # as the file names it
    trace: AccelerationTrace  # accelerations [m/s2] and time step [s]

    @property
    def vertical(self) -> bool:
        """True if it is vertical."""
        return _VERTICAL.fullmatch(plain_direction(self.direction)) is not None

    @property
    def azimuth(self) -> float | None:
        """Azimuth [degrees clockwise from north], None if the direction does not include it."""
        text = plain_direction(self.direction)
        digits = re.fullmatch(r"(\d{1,3})(?:DEG)?", text)
        if digits:
            return float(digits[1]) % 360.0
        quadrant = _QUADRANT.fullmatch(text)
        if quadrant:
            start = 0.0 if quadrant[1] == "N" else 180.0
            turn = float(quadrant[2]) if quadrant[1] + quadrant[3] in {"NE", "SW"} else None
            return (start + turn if turn is not None else start - float(quadrant[2])) % 360.0
        stream = text[-1] if re.fullmatch(r"[A-Z]N[NE]", text) else text
        return _AZIMUTHS.get(stream)


def plain_direction(direction: str) -> str:
    """Return a direction without spaces and signs, in capitals."""
    return re.sub(r"[\s_.-]|\(\+\)", "", direction).upper()
