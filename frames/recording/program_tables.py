"""Results as the tables of SAP2000 and ETABS, so that spreadsheets made for those go on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
import xarray as xr

from frames._errors import ModelError
from frames.assembly.assemble import assemble
from frames.model.geometry_checks import member_ends
from frames.recording.force_rows import between_ends
from frames.recording.recovery import member_forces, support_reactions
from frames.results.measures import storey_drift
from frames.results.recorded import require_recorded, require_steps

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from frames._types import FloatArray
    from frames.model.frame_data import FrameData

UNITS = {"KN, m": (1e3, 1.0), "N, mm": (1.0, 1e-3), "Kip, in": (4448.2216152605, 0.0254)}
"""Units of force [N] and length [m] by their words; also "Kip, ft" and "N, m"."""

_MORE = {"Kip, ft": (4448.2216152605, 0.3048), "N, m": (1.0, 1.0)}
_KIND = "NonModHist"
_AT_ONCE = 500  # members whose histories are held at a time
_STEPS = ("Max", "Min")


def program_tables(
    model: FrameData,
    data: xr.Dataset | Mapping[str, xr.Dataset],
    *,
    units: str = "KN, m",
    stations: int = 3,
) -> dict[str, pd.DataFrame]:
    """Return largest and smallest results in the columns of SAP2000's and ETABS' tables.

    It is `Frame.program_tables`. Stations are measured from joint i of each member; between the
    ends forces follow from those at both and from the loads along it. P is tension positive; axis 2
    is local z and 3 is -y, so that V2 = Vz, V3 = -Vy, M2 = -Mz and M3 = -My of the section: M3 > 0
    if the side of -2 is in tension. Base reactions are about the origin. Drifts are those of the
    middle of a storey.
    """
    known = UNITS | _MORE
    if units not in known:
        message = f'units = "{units}" must be one of {", ".join(known)}'
        raise ModelError(message)
    if stations != int(stations) or stations < 2:
        message = f"stations = {stations} must be a whole number, at least 2: both ends of a member"
        raise ModelError(message)
    force, length = known[units]
    cases = {"TH": data} if isinstance(data, xr.Dataset) else dict(data)
    found: dict[str, list[pd.DataFrame]] = {}
    for case, history in cases.items():
        require_steps(history, "program_tables")
        require_recorded(history, "program_tables", "node_displacement")
        for name, table in _tables(model, history, str(case), (force, length), stations):
            found.setdefault(name, []).append(table)
    return {name: pd.concat(parts, ignore_index=True) for name, parts in found.items()}


def _tables(
    model: FrameData, data: xr.Dataset, case: str, units: tuple[float, float], stations: int
) -> Iterable[tuple[str, pd.DataFrame]]:
    force, length = units
    moves = np.array([length] * 3 + [1.0] * 3)
    nodes = data["node_displacement"].transpose("time", "node", "dof")
    words = ("U1", "U2", "U3", "R1", "R2", "R3")
    yield (
        "Joint Displacements",
        _table("Joint", nodes["node"].to_numpy(), nodes.to_numpy() / moves, case, words),
    )
    loads = np.array([force] * 3 + [force * length] * 3)
    given = support_reactions(model, data).transpose("time", "support", "dof")
    supports = [str(name) for name in given["support"].to_numpy()]
    values = np.nan_to_num(given.to_numpy())
    words = ("F1", "F2", "F3", "M1", "M2", "M3")
    yield "Joint Reactions", _table("Joint", supports, values / loads, case, words)
    places = np.array([model.nodes[name].position for name in supports])
    whole = values.sum(axis=1)
    whole[:, 3:] += np.cross(places, values[:, :, :3]).sum(axis=1)
    words = ("GlobalFX", "GlobalFY", "GlobalFZ", "GlobalMX", "GlobalMY", "GlobalMZ")
    yield "Base Reactions", _table("", [""], whole[:, None] / loads, case, words)
    if model.members:
        yield "Element Forces - Frames", _frames(model, data, case, units, stations)
    if len(model.levels) > 1:
        drift = storey_drift(data).transpose("time", "storey", "axis")
        yield "Story Drifts", _drifts(drift, case)


def _table(
    head: str, names: Iterable[object], values: FloatArray, case: str, words: tuple[str, ...]
) -> pd.DataFrame:
    # For values (time, name, word): a row of the largest and one of the smallest for each name.
    extremes = np.stack([values.max(axis=0), values.min(axis=0)], axis=1)
    rows = []
    for name, pair in zip(names, extremes, strict=True):
        for step, row in zip(_STEPS, pair.tolist(), strict=True):
            own = {head: str(name)} if head else {}
            own |= {"OutputCase": case, "CaseType": _KIND, "StepType": step}
            rows.append(own | dict(zip(words, row, strict=True)))
    return pd.DataFrame(rows)


def _frames(
    model: FrameData, data: xr.Dataset, case: str, units: tuple[float, float], stations: int
) -> pd.DataFrame:
    names, (force, length) = list(model.members), units
    shares = np.linspace(0.0, 1.0, stations)
    table = assemble(model).members
    more = [between_ends(model, table, float(share)) for share in shares]
    scale = np.array([force] * 3 + [force * length] * 3)
    words = ("P", "V2", "V3", "T", "M2", "M3")
    parts = []
    for first in range(0, len(names), _AT_ONCE):
        some = names[first : first + _AT_ONCE]
        given = member_forces(model, data, some).transpose("time", "member", "end", "component")
        ends = given.to_numpy() * np.array([-1.0, 1.0])[:, None]  # of a section, from i to j
        order, sign = [0, 2, 1, 3, 5, 4], np.array([1.0, 1.0, -1.0, 1.0, -1.0, -1.0])
        for share, loads in zip(shares, more, strict=True):
            here = (1.0 - share) * ends[:, :, 0] + share * ends[:, :, 1]
            here = here + loads[first : first + len(some)]
            rows = _table("Frame", some, here[..., order] * sign / scale, case, words)
            rows.insert(1, "Station", np.repeat([_station(model, n, share) for n in some], 2))
            rows["Station"] /= length
            parts.append(rows)
    found = pd.concat(parts, ignore_index=True)
    place = {name: k for k, name in enumerate(names)}
    order_of = found["Frame"].map(place)
    return found.iloc[np.lexsort((found["Station"], order_of))].reset_index(drop=True)


def _station(model: FrameData, name: str, share: float) -> float:
    member = model.members[name]
    start = np.array(model.nodes[member.i].position)
    way = np.array(model.nodes[member.j].position) - start
    near, far = ((end - start) @ way for end in member_ends(model.nodes, member))
    return float(((1.0 - share) * near + share * far) / np.linalg.norm(way))


def _drifts(drift: xr.DataArray, case: str) -> pd.DataFrame:
    rows = []
    for storey in drift["storey"].to_numpy():
        for axis, word in (("x", "X"), ("y", "Y")):
            values = drift.sel(storey=storey, axis=axis).to_numpy()
            for step, value in zip(_STEPS, (values.max(), values.min()), strict=True):
                own = {"Story": str(storey), "OutputCase": case, "CaseType": _KIND}
                rows.append(own | {"StepType": step, "Direction": word, "Drift": float(value)})
    return pd.DataFrame(rows)
