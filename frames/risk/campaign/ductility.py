"""Ductility of plastic hinges: their rotations over those at which their members yield."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from frames.model.components import hinged_ends
from frames.risk.fragility.limit_state import LimitState
from frames.risk.fragility.reading import rows_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    import xarray as xr

    from frames._types import FloatArray
    from frames.frame import Frame
    from frames.model.components import Member
    from frames.model.laws import PlasticHinge
    from frames.risk.fragility.runs import IntensityRuns

DUCTILITY = "ductility"
"""Column of runs: the largest ductility of all hinges [-], 1 if none yields."""


def ductility_limit(most: float) -> LimitState:
    """Return a ductility of plastic hinges above `most` [-]."""
    return LimitState(f"ductility {most:g}", DUCTILITY, most)


def yield_rotations(frame: Frame) -> dict[str, float]:
    """Return the rotation that counts as ductility 1 of each hinge [rad].

    That of the hinge, or ``M L / (6 E I)`` of its member between its offsets in double curvature,
    of the axis that yields at the smaller one.
    """
    return {
        name: _of_member(frame, frame.members[member], hinge)
        for name, member, _, hinge in hinged_ends(frame.hinges)
    }


def _of_member(frame: Frame, member: Member, hinge: PlasticHinge) -> float:
    if hinge.yield_rotation is not None:
        return hinge.yield_rotation
    ends = [
        np.array(frame.nodes[node].position) + np.array(offset)
        for node, offset in zip((member.i, member.j), member.offsets, strict=True)
    ]
    length, section = float(np.linalg.norm(ends[1] - ends[0])), member.section
    about = ((hinge.moment_y, section.inertia_y), (hinge.moment_z, section.inertia_z))
    return min(
        moment * length / (6.0 * section.elastic_modulus * inertia)
        for moment, inertia in about
        if math.isfinite(moment)
    )


def ductility(data: xr.Dataset, frame: Frame) -> FloatArray:
    """Return the largest ductility of each run of a structure: 1 if no hinge yields.

    Shapes: result (runs,).
    """
    at_yield = yield_rotations(frame)
    if not at_yield:
        return np.ones(data.sizes["run"])
    turned = data["peak_hinge_rotation"].sel(hinge=list(at_yield)).transpose("run", "hinge")
    shares = turned.to_numpy() / np.array(list(at_yield.values()))
    return 1.0 + np.asarray(shares.max(axis=1))


def with_ductility(
    runs: Mapping[str, IntensityRuns],
    data: xr.Dataset,
    frames: Callable[[], Mapping[str, Frame]],
    limits: Iterable[LimitState],
) -> dict[str, IntensityRuns]:
    """Return runs by structure, with their ductility among the quantities if a limit needs it."""
    if not any(limit.quantity == DUCTILITY for limit in limits):
        return dict(runs)
    found, models = {}, frames()
    for name, each in runs.items():
        own = ductility(rows_of(data, name, "all"), models[name])
        table = each.table.assign(**{DUCTILITY: own})
        found[name] = replace(each, table=table, units={**each.units, DUCTILITY: "1"})
    return found
