"""The largest and smallest member forces of a run by group of members."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from frames.library.building import ARM
from frames.recording.force_rows import MEMBER_FORCES

if TYPE_CHECKING:
    from frames.design.project.design_run import ProjectRun
    from frames.frame import Frame

_ROUND_OFF = 1e-6  # of the largest force, or moment, below which a row is left out


def member_groups(run: ProjectRun, forces: pd.DataFrame | None) -> pd.DataFrame:
    """Return the extremes of the members' forces by group, over bounds and stations.

    Members of the same kind of name at the same heights are a group.
    """
    if forces is None:
        return pd.DataFrame()
    judged = [level.name for level in run.rules.levels if level.judges_structure]
    governing = forces[(forces["governs"] == "yes") & forces.index.isin(judged)].reset_index()
    governing = governing[~governing["member"].str.startswith(ARM)]  # rigid: nothing to design
    names = group_names(run.frame)
    order = {name: k for k, name in enumerate(dict.fromkeys(names.values()))}
    group = governing["member"].map(names)
    parts = dict(iter(governing.groupby([group, "force"])))
    rows, void = [], governing["void"].any()
    for name, force in sorted(parts, key=lambda key: (order[key[0]], MEMBER_FORCES.index(key[1]))):
        part = parts[name, force]
        row = {"group": name, "members": part["member"].nunique(), "force": force}
        row["unit"] = part["unit"].iloc[0]
        for extreme, title, sign in (("min", "smallest", -1.0), ("max", "largest", 1.0)):
            those = part[part["extreme"] == extreme]
            worst = those.iloc[int(np.argmax(sign * those["value"].to_numpy()))]
            row[title] = float(worst["value"])
            row[f"member of {title}"] = f"{worst['member']} {worst['station']}, {worst['bound']}"
        if void:
            row["void"] = "; ".join(dict.fromkeys(why for why in part["void"] if why))
        rows.append(row)
    table = pd.DataFrame(rows).set_index("group")
    size = table[["smallest", "largest"]].abs().max(axis=1)
    return table[size > _ROUND_OFF * size.groupby(table["unit"]).transform("max")]


def without_forces(frame: Frame) -> pd.DataFrame:
    """Return the elements of superelements that the tables of member forces leave out."""
    rows = [
        {"kind": one.kind, "elements": one.number, "which": one.which, "why": one.why}
        for part in frame.superelements.values()
        for one in part.elements.without
    ]
    return pd.DataFrame(rows).set_index("kind") if rows else pd.DataFrame()


def group_names(frame: Frame) -> dict[str, str]:
    """Return the group of each member and line element: its kind of name, and its heights."""
    ends = {name: (member.i, member.j) for name, member in frame.members.items()}
    for part in frame.superelements.values():
        ends |= dict(zip(part.elements.names, part.elements.nodes, strict=True))
    found = {}
    for name, nodes in ends.items():
        heights = " to ".join(
            f"{height:g}" for height in sorted({round(frame.nodes[node].z, 6) for node in nodes})
        )
        kind = re.sub(r"[-_ ]*\d+", "", name)
        found[name] = f"{kind} at {heights} m"
    return found
