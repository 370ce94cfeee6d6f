"""Results of a campaign as a table of sets of parameters by records, for Sobol' indices."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np
import xarray as xr

from frames.risk._errors import FragilityError
from frames.risk.fragility.reading import rows_of
from frames.risk.fragility.runs import COMPLETE, FAILURE, outcome_of
from lir_element.argument_checks import require_choice

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray

Quantity: TypeAlias = "str | Callable[[xr.Dataset], npt.ArrayLike]"
"""Name of a quantity of `frames.peaks`, or a function of runs that returns a number each."""


class HasResults(Protocol):
    """A campaign, or its results database."""

    def results(self) -> xr.Dataset:
        """Return the runs."""
        ...


def of_campaign(
    given: HasResults | xr.Dataset,
    sets: list[dict[str, float]],
    quantity: Quantity,
    at_most: float | None,
    model: str | None,
    scale: float | None,
) -> FloatArray:
    """Return results of a structure's runs at one factor, (sets, motions); NaN if unknown."""
    data = given if isinstance(given, xr.Dataset) else given.results()
    own = rows_of(data, model, "all")
    scales = sorted({*own["scale"].to_numpy().tolist()})
    if scale is None and len(scales) > 1:
        msg = f"{len(scales)} factors on the motions: name one as scale=, such as {scales[-1]:g}"
        raise FragilityError(msg)
    at = scales[0] if scale is None else float(scale)
    require_choice("scale", at, tuple(scales), error=FragilityError)
    own = own.isel(run=np.flatnonzero(own["scale"].to_numpy() == at))
    _require_sample(own, sets)
    values = _values(own, quantity, at_most)
    names, motion = np.unique(own["motion"].to_numpy(), return_inverse=True)
    found = np.full((len(sets), len(names)), np.nan)
    found[own["parameter_set"].to_numpy(), motion] = values
    return found


def _require_sample(own: xr.Dataset, sets: list[dict[str, float]]) -> None:
    # The sets of a campaign are those of the distributions.
    remedy = "sample=saltelli_sample(distributions, samples, seed=seed) with the same arguments"
    if "parameter_set" not in own.coords:
        msg = f"the campaign has no sets of parameters: run it with {remedy}"
        raise FragilityError(msg)
    number = own["parameter_set"].to_numpy()
    for name in sets[0]:
        wanted = np.array([each[name] for each in sets])
        same = name in own.coords and number.max() < len(sets)
        if not same or not np.allclose(own[name].to_numpy(), wanted[number], rtol=1e-12, atol=0.0):
            msg = f"the campaign's sets have other values of {name}: run it with {remedy}"
            raise FragilityError(msg)


def _values(own: xr.Dataset, quantity: Quantity, at_most: float | None) -> FloatArray:
    if callable(quantity):
        return np.asarray(quantity(own), dtype=np.float64)
    outcome = np.array([outcome_of(str(each)) for each in own["status"].to_numpy()])
    names = tuple(map(str, own["quantity"].to_numpy()))
    require_choice("quantity", quantity, names, error=FragilityError)
    found = own["peak"].sel(quantity=quantity).to_numpy()
    failed = outcome == FAILURE
    if at_most is None and failed.any():
        msg = (
            f"{quantity} is infinite in {failed.sum()} of {len(failed)} runs, whose bearings "
            "failed: give at_most=, the value that they and larger ones count as"
        )
        raise FragilityError(msg)
    most = math.inf if at_most is None else at_most
    reached = np.where(failed, most, np.minimum(found, most))
    return np.asarray(np.where(np.isin(outcome, (COMPLETE, FAILURE)), reached, np.nan))
