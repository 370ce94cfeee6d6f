"""Sensitivity of a result to the assumptions, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames._types import FloatArray
from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_finite

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

Batch = Callable[[list[dict[str, float]]], "Sequence[float]"]
"""Function from many sets of parameters to a result each: one call for all, for a batch."""


@dataclass(frozen=True, eq=False)
class Tornado:
    """Results with one parameter at a time at its lower and upper value.

    Attributes
    ----------
    base : float
        Result with all parameters at their base values.
    table : pandas.DataFrame
        A row a parameter, the widest swing first: values "low", "high" of the parameter, results
        "at low", "at high", and "swing", the size of the difference of both results.

    Examples
    --------
    In the gallery: "Which property matters" (docs/gallery/research/d_tornado.py).
    """

    base: float
    table: pd.DataFrame

    def to_dataframe(self) -> pd.DataFrame:
        """Return a copy of the table."""
        return self.table.copy()


def tornado(results_of: Batch, parameters: Mapping[str, tuple[float, float, float]]) -> Tornado:
    """Change one parameter at a time.

    Parameters
    ----------
    results_of : callable
        Function from a list of sets of parameters (dicts of numbers by name) to a result each, such
        as a median displacement of a batch of time histories. It is called once.
    parameters : mapping of str to (float, float, float)
        Low, base and high value by name.

    Returns
    -------
    Tornado
        Results, the widest swing first.

    Raises
    ------
    FragilityError
        If there is no parameter, values are not in order, or a result is not finite.

    Notes
    -----
    Choose low and high as wide as the uncertainty. Gradients by small differences are rough (by
    friction 7 % over a range of 0.4 %), because peaks with stick, slip and impacts are not smooth.

    Examples
    --------
    >>> def squares(sets):
    ...     return [10.0 * each["a"] ** 2 + each["b"] for each in sets]
    >>> found = tornado(squares, {"b": (0.0, 1.0, 3.0), "a": (1.0, 2.0, 3.0)})
    >>> found.base, list(found.table.index), found.table["swing"].tolist()
    (41.0, ['a', 'b'], [80.0, 3.0])
    """
    if not parameters:
        msg = "parameters is empty: name at least one with its low, base and high value"
        raise FragilityError(msg)
    for name, values in parameters.items():
        if np.shape(values) != (3,) or not values[0] <= values[1] <= values[2]:
            msg = f"{name} = {values!r}: give its low, base and high value, in this order"
            raise FragilityError(msg)
        for value in values:
            require_finite(name, value, error=FragilityError)
    base = {name: float(values[1]) for name, values in parameters.items()}
    sets = [dict(base)]
    for name, (low, _, high) in parameters.items():
        sets += [{**base, name: float(low)}, {**base, name: float(high)}]
    found = results_by(results_of, sets)
    lows, highs = found[1::2], found[2::2]
    table = pd.DataFrame(
        {
            "low": [float(v[0]) for v in parameters.values()],
            "high": [float(v[2]) for v in parameters.values()],
            "at low": lows,
            "at high": highs,
            "swing": np.abs(highs - lows),
        },
        index=pd.Index(list(parameters), name="parameter"),
    )
    return Tornado(float(found[0]), table.sort_values("swing", ascending=False, kind="stable"))


def results_by(results_of: Batch | npt.ArrayLike, sets: list[dict[str, float]]) -> FloatArray:
    """Return results, a row a set of parameters, all of them finite."""
    given = results_of(sets) if callable(results_of) else results_of
    found = np.asarray(given, dtype=np.float64)
    if found.shape != (len(sets),):
        msg = (
            f"results have the shape {found.shape}: return one number for each of {len(sets)} sets"
        )
        raise FragilityError(msg)
    if not np.isfinite(found).all():
        k = int(np.flatnonzero(~np.isfinite(found))[0])
        msg = f"the result for {sets[k]} is {found[k]}: results must be finite"
        raise FragilityError(msg)
    return found
