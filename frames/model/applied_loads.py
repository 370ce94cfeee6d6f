"""All permanent loads of a frame as those who analyse it need them, and the masses they make."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from frames._errors import ModelError
from frames.model.components import TaperedLoad
from frames.model.floors import members_at, panel_loads
from frames.model.geometry_checks import member_points

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.components import Member
    from frames.model.frame_data import FrameData


class NodeLoad(NamedTuple):
    """Forces and moments (6,) on a node [N, N m], and the share of them that is mass [-]."""

    node: str
    forces: FloatArray
    share: float


class SpanLoad(NamedTuple):
    """A load along a member, and the share of it that is mass [-]."""

    member: str
    load: TaperedLoad
    share: float


class AppliedLoads(NamedTuple):
    """What floor panels and tapered loads come to."""

    nodes: list[NodeLoad]  # of floor panels, on the rigid end zones of members
    # of floor panels and tapered loads; uniform loads are in `Frame.uniform_loads`
    spans: list[SpanLoad]


def applied_loads(frame: FrameData) -> AppliedLoads:
    """Return the loads of floor panels and tapered loads."""
    found = AppliedLoads([], [])
    for member, loads in frame.tapered_loads.items():
        found.spans.extend(SpanLoad(member, x, frame.mass_source.get(x.case, 0.0)) for x in loads)
    around = members_at(frame.members) if frame.floor_loads else {}
    for panel in frame.floor_loads.values():
        share = frame.mass_source.get(panel.case, 0.0) if panel.mass is None else panel.mass
        parts = panel_loads(frame.nodes, around, panel)
        found.spans.extend(SpanLoad(member, load, share) for member, load in parts.members)
        found.nodes.extend(NodeLoad(node, forces, share) for node, forces in parts.nodes)
    return found


def load_masses(frame: FrameData, applied: AppliedLoads) -> dict[str, float]:
    """Return the masses that permanent loads make, by node."""
    found: dict[str, float] = {}
    parts = [*_at_nodes(frame, applied), *_along_members(frame, applied)]
    for node, force in parts:
        found[node] = found.get(node, 0.0) + force / frame.gravity
    least = 1e-9 * max(map(abs, found.values()), default=0.0)
    for node, mass in found.items():
        if mass < -least:
            message = (
                f'the permanent loads at node "{node}" that make mass pull upwards, {mass:g} kg: '
                "leave their case out of set_mass_source, or turn their sign (down is -z)"
            )
            raise ModelError(message)
    return {node: mass for node, mass in found.items() if mass > 0.0}


def _at_nodes(frame: FrameData, applied: AppliedLoads) -> Iterator[tuple[str, float]]:
    # Downward forces that are mass, of loads on nodes.
    for node, cases in frame.loads_by_case.items():
        for case, forces in cases.items():
            share = frame.mass_source.get(case, 0.0)
            if share:
                yield node, -share * float(forces[2])
    for node, forces, share in applied.nodes:
        if share:
            yield node, -share * float(forces[2])


def _along_members(frame: FrameData, applied: AppliedLoads) -> Iterator[tuple[str, float]]:
    # The same of loads along members, by the rule of the lever at their ends.
    for name, cases in frame.uniform_loads_by_case.items():
        member = frame.members[name]
        for case, q in cases.items():
            share = frame.mass_source.get(case, 0.0)
            if share:
                half = -0.5 * share * float(q[2]) * _length(frame, member)
                yield from ((member.i, half), (member.j, half))
    for name, load, share in applied.spans:
        if share:
            member = frame.members[name]
            near, far, span = load.start[2], load.end[2], load.b - load.a
            force = -0.5 * share * (near + far) * span
            moment = (
                -share * span * (load.a * (2.0 * near + far) + load.b * (near + 2.0 * far)) / 6.0
            )
            part = moment / _length(frame, member)
            yield from ((member.i, force - part), (member.j, part))


def _length(frame: FrameData, member: Member) -> float:
    return math.dist(*member_points(frame.nodes, member))
