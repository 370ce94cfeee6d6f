"""Rows of a Dataset that runs of known intensity are read from: one structure and design, done."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from frames._fingerprint import motion_digest
from frames.batch.cases import named_motions
from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_choice
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    import xarray as xr

    from frames._types import BoolArray
    from frames.motion.ground_motion import GroundMotion

ALL_SETS = "all"

Sets: TypeAlias = "int | Mapping[str, float] | Literal['all'] | None"
"""Which sets of parameters of a campaign: a number, values by name, all of them together."""

_SHOWN = 3


def rows_of(data: xr.Dataset, model: str | None, parameters: Sets) -> xr.Dataset:
    """Return the runs of one structure and one set of parameters that are done."""
    names = sorted({str(name) for name in data["model"].to_numpy()})
    if model is None and len(names) > 1:
        msg = f"{len(names)} structures ({', '.join(names)}): name one as model="
        raise FragilityError(msg)
    chosen = names[0] if model is None else model
    require_choice("model", chosen, names, error=FragilityError)
    own = data.isel(run=np.flatnonzero(data["model"].to_numpy() == chosen))
    own = own.isel(run=np.flatnonzero(_of_sets(own, parameters)))
    done = own["status"].to_numpy() != ""  # what a campaign has not run yet
    if "done" in own.coords:
        done &= own["done"].to_numpy()
    if not done.any():
        msg = f"none of the {len(done)} runs is done: run the campaign first"
        raise FragilityError(msg)
    if not done.all():
        warnings.warn(
            f"{(~done).sum()} of {len(done)} runs are not done and left out: what is made of the "
            "others changes with them. Run the campaign to its end",
            AnalysisWarning,
            stacklevel=4,
        )
    return own.isel(run=np.flatnonzero(done))


def _of_sets(own: xr.Dataset, parameters: Sets) -> BoolArray:
    # Rows of the sets of parameters that are asked for.
    every = np.ones(own.sizes["run"], dtype=bool)
    if "parameter_set" not in own.coords:
        if parameters is None or parameters == ALL_SETS:
            return every
        msg = f"parameters = {parameters!r}: the runs have no sets of parameters, leave it out"
        raise FragilityError(msg)
    of = own["parameter_set"].to_numpy()
    sets = sorted({int(k) for k in of})
    if isinstance(parameters, Mapping):
        return _of_values(own, parameters)
    if parameters is None and len(sets) > 1:
        names = [str(n) for n in own.coords if own[n].dims == ("run",) and _is_parameter(own, n)]
        msg = (
            f"{len(sets)} sets of parameters ({', '.join(names)}): choose one by its number, "
            f"parameters={sets[0]}, or by values, parameters={{{names[0]!r}: "
            f"{float(own[names[0]].to_numpy()[0]):g}}}; parameters='all' pools them, and the "
            "dispersion of the curve then holds that of the parameters"
        )
        raise FragilityError(msg)
    if parameters is None or parameters == ALL_SETS:
        return every
    require_choice("parameters", parameters, tuple(sets), error=FragilityError)
    return np.asarray(of == parameters)


def _is_parameter(own: xr.Dataset, name: Any) -> bool:
    return name not in {"run", "scale", "done", "parameter_set"} and own[name].dtype.kind == "f"


def _of_values(own: xr.Dataset, parameters: Mapping[str, float]) -> BoolArray:
    found = np.ones(own.sizes["run"], dtype=bool)
    names = [str(n) for n in own.coords if own[n].dims == ("run",) and _is_parameter(own, n)]
    for name, value in parameters.items():
        require_choice("parameter", name, tuple(names), error=FragilityError)
        there = own[name].to_numpy()
        found &= np.isclose(there, value, rtol=1e-9, atol=0.0)
        if not found.any():
            near = ", ".join(f"{v:g}" for v in sorted({*there.tolist()})[:_SHOWN])
            msg = f"parameters: no set has {name} = {value:g}: there are {near}, ..."
            raise FragilityError(msg)
    of = {int(k) for k in own["parameter_set"].to_numpy()[found]}
    if len(of) > 1:
        msg = f"parameters = {dict(parameters)!r}: {len(of)} sets have them; name more of {names}"
        raise FragilityError(msg)
    return found


def motions_of(own: xr.Dataset, motions: object) -> dict[str, GroundMotion]:
    """Return the motions of runs by name, if they are those that were run."""
    grounds = named_motions(motions)
    used = list(dict.fromkeys(str(name) for name in own["motion"].to_numpy()))
    for name in used:
        require_choice("motion", name, tuple(grounds), error=FragilityError)
    if "motion_digest" in own.coords:
        pairs = zip(own["motion"].to_numpy(), own["motion_digest"].to_numpy(), strict=True)
        digests = {name: motion_digest(grounds[name]) for name in used}
        unlike = list(dict.fromkeys(str(n) for n, run in pairs if run and digests[str(n)] != run))
        if unlike:
            msg = (
                f"{len(unlike)} of {len(used)} motions are not those that were run, such as "
                f"{unlike[0]!r}: other samples or another step under the same name, as of a motion "
                "before it was scaled or given a tail. Give the motions that the runs were given"
            )
            raise FragilityError(msg)
    return {name: grounds[name] for name in used}
