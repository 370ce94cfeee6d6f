"""Own measures of a campaign: functions of a run's histories, kept among its quantities."""

from __future__ import annotations

import inspect
import math
import textwrap
from dataclasses import dataclass
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from frames._fingerprint import fingerprint
from frames.risk._errors import CampaignError
from frames.risk.fragility.runs import COMPLETE, outcome_of
from lir_element.argument_checks import require_type

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


@dataclass(frozen=True)
class Measure:
    """A number of each run of a campaign, from its histories.

    Parameters
    ----------
    function : callable
        ``function(data) -> float``: `data` is the run's Dataset, as a row of `time_histories` with
        `record=Recording()`, until the end of its motion. A plain function or a lambda with
        readable source: it is part of the campaign's plan.
    unit : str
        SI unit of the returned number; "1" for a pure number.

    Raises
    ------
    TypeError
        If it is no function.
    CampaignError
        If its source cannot be read.

    Examples
    --------
    >>> def held(data):
    ...     return float(abs(data["base_shear"].isel(axis=0)).quantile(0.95))
    >>> Measure(held, "N").unit
    'N'
    """

    function: Callable[[xr.Dataset], float]
    unit: str

    def __post_init__(self) -> None:
        """Check."""
        require_type("function", self.function, FunctionType, "a function or a lambda")
        require_type("unit", self.unit, str, 'a string such as "m", or "1"')
        self.digest()

    def digest(self) -> str:
        """Return a digest of the function's source and of the names that it uses.

        Returns
        -------
        str
            16 hexadecimal digits, the same in every process.

        Raises
        ------
        CampaignError
            If a source cannot be read, or something that it uses has no digest.
        """
        function: Any = self.function
        return fingerprint(_told(function, function.__module__, {}))


def _told(function: FunctionType, module: str, seen: dict[str, Any]) -> dict[str, Any]:
    # Source, defaults and used names, of functions of the same module recursively.
    name = function.__qualname__
    if name in seen:
        return {"again": name}
    seen[name] = True
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError) as cause:
        msg = (
            f"the source of {name} cannot be read, and a resumed campaign compares it: write the "
            "function in a file"
        )
        raise CampaignError(msg) from cause
    used = inspect.getclosurevars(function)
    around = {**used.globals, **used.nonlocals}
    return {
        "source": source,
        "defaults": _value(name, list(function.__defaults__ or ())),
        "keywords": _value(name, dict(function.__kwdefaults__ or {})),
        "uses": {key: _used(key, around[key], module, seen) for key in sorted(around)},
    }


def _used(key: str, value: Any, module: str, seen: dict[str, Any]) -> Any:
    if isinstance(value, ModuleType):
        return value.__name__
    if isinstance(value, FunctionType) and value.__module__ == module:
        return _told(value, module, seen)
    if isinstance(value, (FunctionType, BuiltinFunctionType, type, np.ufunc)):
        return (
            f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', value.__name__)}"
        )
    return _value(key, value)


def _value(key: str, value: Any) -> str:
    try:
        return fingerprint(value)
    except (TypeError, RecursionError) as cause:
        msg = f"{key} = {value!r} that a measure uses has no digest: use numbers, texts or arrays"
        raise CampaignError(msg) from cause


def checked_measures(measures: object) -> dict[str, Measure]:
    """Return own measures by name."""
    given: Mapping[str, Measure] = measures or {}  # type: ignore[assignment]
    require_type("measures", given, dict, "a dict of Measure by name")
    for name, each in given.items():
        require_type("name of a measure", name, str, "a string")
        require_type(f'measures["{name}"]', each, Measure, 'a Measure(function, unit="m")')
    return dict(given)


def with_room(data: xr.Dataset, measures: Mapping[str, Measure]) -> xr.Dataset:
    """Return results with own measures among their quantities, not a number yet."""
    if not measures:
        return data
    names = [str(name) for name in data["quantity"].to_numpy()]
    twice = [name for name in measures if name in names]
    if twice:
        msg = f'the measure "{twice[0]}" has the name of a quantity of frames.peaks: rename it'
        raise CampaignError(msg)
    texts = {str(name): "" for name, own in data.variables.items() if own.dtype.kind != "f"}
    found = data.reindex(quantity=[*names, *measures], fill_value=texts)
    units = [*map(str, data["unit"].to_numpy()), *(each.unit for each in measures.values())]
    return found.assign_coords(
        quantity=np.array([*names, *measures]),
        unit=("quantity", np.array(units), data["unit"].attrs),
    )


def evaluate(
    data: xr.Dataset, measures: Mapping[str, Measure], places: Sequence[int]
) -> xr.Dataset:
    """Return results with own measures of the runs that went to their end."""
    if not measures:
        return data
    peak = data["peak"].copy()
    names = [str(name) for name in data["quantity"].to_numpy()]
    for k, place in enumerate(places):
        if outcome_of(str(data["status"].to_numpy()[k])) != COMPLETE:
            continue
        own = _of_run(data, k)
        for name, measure in measures.items():
            peak[k, names.index(name)] = _evaluated(name, measure, own, place)
    return data.assign(peak=peak)


def _of_run(data: xr.Dataset, k: int) -> xr.Dataset:
    # A run until the end of its motion: shorter motions are filled up with NaN.
    own = data.isel(run=k)
    if "time" not in own.dims:
        return own
    until = float(own["peak_until"])
    return own.isel(time=np.flatnonzero(own["time"].to_numpy() <= until * (1.0 + 1e-9)))


def _evaluated(name: str, measure: Measure, own: xr.Dataset, place: int) -> float:
    model, motion, scale = (own[key].item() for key in ("model", "motion", "scale"))
    run = f'run {place} ("{model}" under {scale:g} x "{motion}")'
    try:
        found: Any = measure.function(own)
        value = float(found)
    except Exception as cause:
        msg = f'the measure "{name}" of {run}: {type(cause).__name__}: {cause}'
        raise CampaignError(msg) from cause
    if math.isnan(value):
        msg = (
            f'the measure "{name}" of {run} is not a number: return one for each complete run, '
            "math.inf if it has no bound"
        )
        raise CampaignError(msg)
    return value
