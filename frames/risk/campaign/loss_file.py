"""Tables of ``[loss]``: components with their damage states, and a hazard, as spreadsheets save."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from frames._csv import csv_lines
from frames.design.project.quantities import si
from frames.risk._errors import FragilityError
from frames.risk.campaign.loss import DRIFT, LossComponent
from frames.risk.fragility.hazard_curve import HazardCurve

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from frames.risk.fragility.intensity import IntensityMeasure

COLUMNS = "component", "damaged by", "quantity", "median", "dispersion", "cost"
"""Columns of a table of components: a row a damage state."""

_HEADED = re.compile(r"\s*([^\[\]]*?)\s*\[(.+)\]\s*")
_RATE, _PERIOD = ("rate", "1/year"), ("return period", "years")


def read_components(path: Path) -> tuple[LossComponent, ...]:
    r"""Read components from a table, a row a damage state.

    Parameters
    ----------
    path : path
        CSV or a workbook with the columns "component", "damaged by" (drift, floor acceleration,
        floor acceleration above), "quantity" (one number, or "24 24 12" by storey from below),
        "median" (0.01, "1 %", "0.5 g"), "dispersion" and "cost"; others are ignored. The damage
        states of a component follow one another.

    Returns
    -------
    tuple of LossComponent
        The components, in their order.

    Raises
    ------
    FragilityError
        If a column is missing or a cell is no number.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from frames.risk import read_components
    >>> head = "component,damaged by,quantity,median,dispersion,cost"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "components.csv")
    ...     _ = path.write_text(f"{head}\nwalls,drift,10,1 %,0.4,500\n")
    ...     read_components(path)[0].medians
    (0.01,)
    """
    lines = _lines(path)
    head = [cell.strip().lower() for cell in lines[0][1]] if lines else []
    missing = [name for name in COLUMNS if name not in head]
    if missing or len(lines) < 2:
        lacks = f'has no column "{missing[0]}"' if missing else "has no row below its head"
        msg = f"{path.name} {lacks}: a row a damage state, with the columns {', '.join(COLUMNS)}"
        raise FragilityError(msg)
    states: dict[str, list[tuple[int, dict[str, str]]]] = {}
    for number, row in lines[1:]:
        cells = dict(zip(head, (cell.strip() for cell in row), strict=False))
        states.setdefault(cells.get("component", ""), []).append((number, cells))
    return tuple(_component(path, name, rows) for name, rows in states.items())


def _component(path: Path, name: str, rows: list[tuple[int, dict[str, str]]]) -> LossComponent:
    for key in ("damaged by", "quantity"):
        if len({cells.get(key) for _, cells in rows}) > 1:
            msg = (
                f'{path.name}, line {rows[-1][0]}: {name} has another "{key}" than above: repeat it'
            )
            raise FragilityError(msg)
    number, first = rows[0]
    by = first.get("damaged by", "")
    unit = "" if by == DRIFT else "m/s2"
    return LossComponent(
        name=name,
        damaged_by=by,
        medians=tuple(_number(path, n, each, "median", unit) for n, each in rows),
        dispersions=tuple(_number(path, n, each, "dispersion") for n, each in rows),
        costs=tuple(_number(path, n, each, "cost") for n, each in rows),
        quantity=tuple(
            _number(path, number, {"quantity": each}, "quantity")
            for each in first.get("quantity", "").split() or [""]
        ),
    )


def _number(path: Path, line: int, cells: dict[str, str], key: str, unit: str = "") -> float:
    try:
        return si(cells.get(key, ""), unit, "0.5 g" if unit else "0.01")
    except ValueError as cause:
        msg = f'{path.name}, line {line}: {key} = "{cells.get(key, "")}" {cause}'
        raise FragilityError(msg) from cause


def read_hazard(path: Path, measure: IntensityMeasure) -> HazardCurve:
    """Return the hazard of a table of two columns: intensity, and rate or return period."""
    lines = _lines(path)
    found = [_HEADED.fullmatch(cell) for cell in lines[0][1]] if lines else []
    head = [(each[1].lower(), each[2].strip()) if each else ("", "") for each in found]
    if len(head) != 2 or head[1] not in {_RATE, _PERIOD}:
        msg = (
            f'{path.name}: its first line must be "Sa [g],rate [1/year]" or '
            '"Sa [g],return period [years]"'
        )
        raise FragilityError(msg)
    points = []
    for number, row in lines[1:]:
        cells = dict(zip(("intensity", "rate"), row, strict=False))
        cells["intensity"] = f"{cells.get('intensity', '').strip()} {head[0][1]}"
        im = _number(path, number, cells, "intensity", measure.unit)
        points.append((im, _number(path, number, cells, "rate")))
    return hazard_of(points, measure, by_period=head[1] == _PERIOD)


def hazard_of(
    points: Sequence[tuple[float, float]], measure: IntensityMeasure, *, by_period: bool = True
) -> HazardCurve:
    """Return the hazard of points: intensity, and return period [years] or rate [1/year]."""
    rates = [1.0 / value if by_period and value else value for _, value in points]
    return HazardCurve([im for im, _ in points], rates, measure.unit, measure)


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    try:
        return csv_lines(path)
    except ValueError as cause:
        msg = f"{path.name}: {cause}"
        raise FragilityError(msg) from cause
