"""Forces of members and bearings by combination: permanent loads with the earthquake of suites."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames.bundles.peak_data import PRESSED
from frames.design.histories.force_demands import EXTREMES
from frames.motion.ground_motion import GroundMotion
from frames.recording.force_rows import MEMBER_FORCES, REACTIONS
from frames.recording.recording import Recording
from frames.results.recorded import PEAK
from frames.solve.time_history import time_history

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pandas as pd

    from frames._types import FloatArray
    from frames.frame import Frame

_ROWS = 2 * len(MEMBER_FORCES)  # of a section: six forces, the largest and the smallest of each
_BELOW = 0  # place of the side "below" a bearing, of two


class Combination(NamedTuple):
    """Change of the permanent loads from those of the time histories to a combination."""

    words: str  # the combination, "1.44 D + L + 0.15 S"
    members: FloatArray  # (n_sections, 6), in the order of the tables of time histories
    reactions: FloatArray  # (2 n_bearings, 6)


def combinations_of(average: Frame, frames: Mapping[str, Frame]) -> list[Combination]:
    """Return the changes of load of each combination; `average` has the loads of time histories."""
    if not frames:
        return []
    members, reactions = _at_rest(average)
    found = []
    for words, frame in frames.items():
        own = _at_rest(frame)
        found.append(Combination(words, own[0] - members, own[1] - reactions))
    return found


def _at_rest(frame: Frame) -> list[FloatArray]:
    # Forces of members and reactions of a structure under its permanent loads.
    still = GroundMotion(x=np.zeros(2), dt=1e-2, name="at rest")
    kept = Recording(every=None, channels=("energy",), forces=True)
    data = time_history(frame, still, recording=kept)
    found = [np.zeros((0, 6))] * 2
    for k, kind in enumerate(("member", "reaction")):
        name = f"{PEAK}{kind}_force_at_rest"
        if name in data:
            found[k] = data[name].to_numpy().reshape(-1, 6)
    return found


def member_combinations(
    table: pd.DataFrame, combinations: Sequence[Combination], reduction: float
) -> pd.DataFrame:
    """Return the extreme forces of members by combination, over the bounds [N, N m].

    The earthquake's part is divided by `reduction`; if that is not 1, a further combination has it
    whole, for parts that must stay elastic.
    """
    parts = [(one.words, one.members, 1.0) for one in combinations]
    if reduction > 1.0:
        parts = [(one.words, one.members, 1.0 / reduction) for one in combinations] + parts
    return _combined(table, parts, MEMBER_FORCES)


def reaction_combinations(table: pd.DataFrame, combinations: Sequence[Combination]) -> pd.DataFrame:
    """Return the extreme reactions of bearings by combination, over the bounds [N, N m].

    Shears and moments grow with the load on the bearing, because it slides on a curved surface. If
    the combination presses less than the run did, they stay.
    """
    return _combined(table, [(one.words, one.reactions, 1.0) for one in combinations], REACTIONS)


def _combined(
    table: pd.DataFrame, parts: Sequence[tuple[str, FloatArray, float]], six: Sequence[str]
) -> pd.DataFrame:
    import pandas as pd

    found = []
    for level, each in table.groupby(level=0, sort=False):
        own, rest = _governing(each)
        shaken = _earthquake(own, rest, six)
        section = np.arange(len(own)) // _ROWS
        force = np.arange(len(own)) % _ROWS // len(EXTREMES)
        keys = [name for name in own.columns if name in _KEYS]
        for words, more, share in parts:
            still = rest + more[section]
            acting = still + share * shaken
            if six is REACTIONS:
                ran = np.maximum(rest[:, 0] + shaken[:, 0], PRESSED * rest[:, 0])
                acting[:, 1:] *= np.maximum(acting[:, :1] / ran[:, None], 1.0)
            made = own[keys].assign(
                level=level,
                combination=f"{words} + E" + (f" / {1.0 / share:.4g}" if share < 1.0 else ""),
                value=np.take_along_axis(acting, force[:, None], axis=1)[:, 0],
                static=np.take_along_axis(still, force[:, None], axis=1)[:, 0],
            )
            for k, name in enumerate(six):
                made[f"{name} then"] = acting[:, k]
            found.append(made.assign(void=own["void"]))
    done = pd.concat(found, ignore_index=True).round(3)
    first = ["level", "combination"]
    rest_of = [name for name in done.columns if name not in first]
    return done[[*first, *rest_of]].set_index("level")


_KEYS = {"bearing", "side", "member", "station", "force", "extreme", "unit", "bound", "motion"}


def _governing(table: pd.DataFrame) -> tuple[pd.DataFrame, FloatArray]:
    # The extreme row over the bounds of a level, whose tables have the same rows; and all six
    # forces at rest of its section at that bound.
    bounds = table["bound"].nunique()
    rows = len(table) // bounds
    sign = np.where(table["extreme"] == EXTREMES[0], 1.0, -1.0)
    out = (sign * table["value"].to_numpy()).reshape(bounds, rows)
    which = np.nan_to_num(out, nan=-np.inf).argmax(axis=0)
    permanent = table["permanent"].to_numpy().reshape(bounds, -1, 6, len(EXTREMES))[..., 0]
    each = np.arange(rows)
    return table.iloc[which * rows + each], permanent[which, each // _ROWS]


def _earthquake(table: pd.DataFrame, rest: FloatArray, six: Sequence[str]) -> FloatArray:
    # Part of the earthquake at the instant of each row: all six forces times the ratio of the
    # design value to the single run's own force.
    own = table["permanent"].to_numpy()
    single, value = table["single"].to_numpy() - own, table["value"].to_numpy() - own
    acts = np.abs(single) > 1e-9 * np.abs(value)
    factor = np.divide(value, single, out=np.ones(len(table)), where=acts)
    then = table[[f"{name} then" for name in six]].to_numpy()
    return np.asarray(factor[:, None] * (then - rest))


def least_loads(reactions: pd.DataFrame) -> pd.DataFrame:
    """Return the row of the least load of each bearing over all combinations, levels and bounds."""
    rows = reactions.reset_index()
    rows = rows[(rows["side"] == "below") & (rows["force"] == "N") & (rows["extreme"] == "min")]
    return rows.loc[rows.groupby("bearing", sort=False)["value"].idxmin()].set_index("bearing")


def uplift_table(
    reactions: pd.DataFrame, gaps: Mapping[str, float], linear: Mapping[str, float]
) -> pd.DataFrame:
    """Return the uplift of bearings [m], and the tension of a restraint that would prevent it [N].

    `gaps` has the largest gap of each bearing in all runs [m]. `linear` has the overturning force
    of the equivalent-linear analysis beyond the least permanent load [N]. It is negative if the
    bearing stays pressed.
    """
    least = least_loads(reactions)
    names = list(least.index)
    pulled = np.array([linear.get(name, np.nan) for name in names])
    table = least[["level", "bound", "combination", "value"]].rename(
        columns={"value": "least load by combination [N]"}
    )
    table["uplift in runs [m]"] = [gaps[name] for name in names]
    table["pull of the equivalent-linear analysis [N]"] = np.round(pulled, 3)
    both = np.fmax(-least["value"].to_numpy(), pulled)
    table["tension if held [N]"] = np.round(np.fmax(both, 0.0), 3) + 0.0
    return table.assign(void=least["void"])
