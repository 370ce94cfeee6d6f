"""Runs, curves and rates in files: JSON that other programs read, too."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import pandas as pd

from frames._provenance import provenance
from frames.results.storage import write_whole
from frames.risk._errors import FragilityError
from frames.risk.fragility.curve import CollapseFragility, Fragility
from frames.risk.fragility.hazard_curve import HazardCurve
from frames.risk.fragility.hunt_fill import HuntFill
from frames.risk.fragility.incremental import IDA
from frames.risk.fragility.intensity import Intensity, IntensityMeasure, StatedMeasure
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.risk import Risk
from frames.risk.fragility.runs import IntensityRuns
from lir_element.argument_checks import require_type

if TYPE_CHECKING:
    from frames._types import FloatArray

Kept: TypeAlias = IntensityRuns | IDA | Fragility | CollapseFragility | HazardCurve | Risk
"""Objects that can be saved."""

FORMAT = "lir-dcfp fragility 1"
"""First line of a file: its kind and version."""

_KINDS: dict[str, type] = {
    kind.__name__: kind
    for kind in (IntensityRuns, IDA, Fragility, CollapseFragility, HazardCurve, Risk)
}
_PARTS: dict[str, type] = {
    kind.__name__: kind for kind in (Intensity, StatedMeasure, LimitState, HuntFill)
}


def save_fragility(found: Kept, path: str | Path) -> None:
    """Save runs, an incremental analysis, a fragility curve, a hazard or a rate to a JSON file.

    Parameters
    ----------
    found : IntensityRuns, IDA, Fragility, CollapseFragility, HazardCurve or Risk
        The file is complete: runs with their plan, curves with their resamples.
    path : str or path
        The file; an existing one is replaced at the end, in one move.

    Raises
    ------
    TypeError
        If it is something else.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from frames.risk import lognormal_fragility
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_fragility(lognormal_fragility(2.0, 0.4), f"{folder}/curve.json")
    ...     load_fragility(f"{folder}/curve.json").median
    2.0
    """
    kinds = tuple(_KINDS.values())
    require_type("found", found, kinds, f"one of {', '.join(_KINDS)}")
    content = {"format": FORMAT, "origin": provenance(), **_written(found)}
    write_whole(path, json.dumps(content, indent=1, allow_nan=False).encode())


def load_fragility(path: str | Path) -> Any:
    """Read a file of `save_fragility`.

    Parameters
    ----------
    path : str or path
        The file.

    Returns
    -------
    IntensityRuns, IDA, Fragility, CollapseFragility, HazardCurve or Risk
        The saved object.

    Raises
    ------
    FragilityError
        If the file does not exist or holds nothing of the kind.

    Examples
    --------
    >>> import tempfile
    >>> from frames.risk import load_fragility, lognormal_fragility, save_fragility
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_fragility(lognormal_fragility(2.0, 0.4), f"{folder}/curve.json")
    ...     print(load_fragility(f"{folder}/curve.json").median)
    2.0
    """
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        right = content.get("format") == FORMAT
    except (OSError, ValueError, AttributeError):
        right = False
    if not right:
        msg = f"{path} holds no {FORMAT!r}: give a file that save_fragility wrote"
        raise FragilityError(msg)
    return _read(content)


def _written(value: Any) -> Any:
    # Plain values; numbers that JSON has not ("nan", "inf") as texts; of own measures their label.
    if isinstance(value, IntensityMeasure) and not isinstance(value, Intensity):
        value = StatedMeasure(value.label, value.unit)
    if type(value).__name__ in _KINDS | _PARTS:
        own = {field.name: _written(getattr(value, field.name)) for field in fields(value)}
        return {"what": type(value).__name__, **own}
    if isinstance(value, pd.DataFrame):
        columns = {
            str(name): {"type": column.dtype.kind, "values": _written(column.to_numpy())}
            for name, column in value.items()
        }
        return {"what": "table", "columns": columns}
    if isinstance(value, np.ndarray):
        return _written(value.tolist())
    if isinstance(value, dict):
        return {"what": "mapping", "values": {str(k): _written(v) for k, v in value.items()}}
    if isinstance(value, (list, tuple)):
        return [_written(each) for each in value]
    if isinstance(value, float) and not np.isfinite(value):
        return str(value)
    return value


def _read(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    kind = str(value.get("what"))
    if kind == "table":
        return pd.DataFrame({name: _column(each) for name, each in value["columns"].items()})
    if kind == "mapping":
        return value["values"]
    of: Any = (_KINDS | _PARTS)[kind]
    names = [field.name for field in fields(of)]
    own = {name: value[name] for name in names if name in value}  # files of before lack some
    arrays = {"parameters", "covariance", "resampled", "im", "contribution", "rate"}
    return of(
        **{
            name: _array(each)
            if name in arrays and isinstance(each, list)
            else tuple(each)
            if isinstance(each, list)
            else _number(each)
            if name in _NUMBERS
            else _read(each)
            for name, each in own.items()
        }
    )


_NUMBERS = {"median", "dispersion", "added", "rate", "above", "highest", "limit"}


def _number(value: Any) -> Any:
    # A number that may be infinite; other parts are read by name.
    return float(value) if isinstance(value, (str, float, int)) else _read(value)


def _array(values: list[Any]) -> FloatArray:
    return np.array(values, dtype=np.float64)  # "nan" and "inf", too


def _column(column: dict[str, Any]) -> Any:
    kind, values = column["type"], column["values"]
    if kind == "f":
        return _array(values)
    return np.array(values, dtype={"b": bool, "i": np.int64, "u": np.int64}.get(kind, object))
