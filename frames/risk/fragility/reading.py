"""Rows of a Dataset that runs of known intensity are read from: one structure and design, done."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from frames._fingerprint import motion_digest
from frames.batch.cases import named_motions
from frames.batch.runs import Runs
from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_choice
from lir_element.errors import AnalysisWarning

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from frames.motion.ground_motion import GroundMotion

ALL_SETS = "all"

Sets: TypeAlias = "int | Mapping[str, float] | Literal['all'] | None"
"""Sets of parameters of a campaign: a number, values by name, all of them together."""

_SHOWN = 3


def rows_of(data: xr.Dataset, model: str | None, parameters: Sets) -> xr.Dataset:
    """Return the runs of one structure and one set of parameters that are done."""
    runs = Runs(data)
    names = sorted({*map(str, runs.of("model"))})
    if model is None and len(names) > 1:
        msg = f"{len(names)} structures ({', '.join(names)}): name one as model="
        raise FragilityError(msg)
    chosen = names[0] if model is None else model
    require_choice("model", chosen, names, error=FragilityError)
    own = _of_sets(runs.where(model=chosen), parameters)
    done = own.of("status") != ""  # runs of a campaign that are not complete
    if "done" in data.coords:
        done &= own.of("done")
    if not done.any():
        msg = f"none of the {len(done)} runs is done: run the campaign first"
        raise FragilityError(msg)
    if not done.all():
        warnings.warn(
            f"results will change: {(~done).sum()} of {len(done)} runs are not done and left out. "
            "Run the campaign to its end",
            AnalysisWarning,
            stacklevel=4,
        )
    return own.those(done).data


def _of_sets(own: Runs, parameters: Sets) -> Runs:
    # Rows of the chosen sets of parameters.
    data = own.data
    if "parameter_set" not in data.coords:
        if parameters is None or parameters == ALL_SETS:
            return own
        msg = f"parameters = {parameters!r}: the runs have no sets of parameters, leave it out"
        raise FragilityError(msg)
    tags = {"run", "scale", "done", "parameter_set"}
    coords = {str(name): each for name, each in data.coords.items() if each.dims == ("run",)}
    names = [name for name, each in coords.items() if name not in tags and each.dtype.kind == "f"]
    if isinstance(parameters, Mapping):
        return _of_values(own, parameters, names)
    sets = sorted({*map(int, own.of("parameter_set"))})
    if parameters is None and len(sets) > 1:
        msg = (
            f"{len(sets)} sets of parameters ({', '.join(names)}): choose parameters={sets[0]}, or "
            f"parameters={{{names[0]!r}: {own.of(names[0])[0]:g}}}; parameters='all' pools them "
            "and adds their scatter to the dispersion"
        )
        raise FragilityError(msg)
    if parameters is None or parameters == ALL_SETS:
        return own
    require_choice("parameters", parameters, tuple(sets), error=FragilityError)
    return own.where(parameter_set=parameters)


def _of_values(own: Runs, parameters: Mapping[str, float], names: Sequence[str]) -> Runs:
    found = own
    for name, value in parameters.items():
        require_choice("parameter", name, tuple(names), error=FragilityError)
        found = found.those(np.isclose(found.of(name), value, rtol=1e-9, atol=0.0))
        if not len(found):
            near = ", ".join(f"{v:g}" for v in sorted({*own.of(name).tolist()})[:_SHOWN])
            msg = f"parameters: no set has {name} = {value:g}: there are {near}, ..."
            raise FragilityError(msg)
    of = {*found.of("parameter_set").tolist()}
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
                f"{unlike[0]!r}: give the motions as they were run, with their scale and tail"
            )
            raise FragilityError(msg)
    return {name: grounds[name] for name in used}
