"""Permanent loads of a frame for its analysis, and combinations of their cases."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import replace
from operator import is_
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from frames._errors import ModelError
from frames.model.components import TaperedLoad
from frames.model.floors import PanelLoads, members_at, panel_loads
from frames.model.frame_data import FrameData, frozen
from frames.model.geometry_checks import member_points
from lir_element.argument_checks import require_finite, require_non_negative, require_type

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.components import Member


def isolator_combinations(s_ms: float = 0.0) -> dict[str, dict[str, float]]:
    r"""Return the gravity parts of the vertical load combinations for isolators of ASCE 7-22.

    Average 1.0 D + 0.5 L; maximum 1.2 D + E_v + L + 0.15 S; minimum 0.9 D - E_v, where :math:`E_v =
    0.2 S_{MS} D`. The time history adds the horizontal earthquake. Snow is that of ASCE 7-22, whose
    loads are of strength level, with its factor of sec. 2.3.6; ASCE 7-16 has 0.2 on its own, lower
    snow loads: give those factors to `Frame.combined`. Source: ASCE/SEI 7-22, sec. 17.2.7.1;
    compare with the edition that you design by.

    Parameters
    ----------
    s_ms : float
        Spectral acceleration S_MS at short periods [g], >= 0; 0 leaves E_v out, for motions with a
        vertical component.

    Returns
    -------
    dict of str to dict of str to float
        "average", "maximum" and "minimum": factors of dead load "D", live load "L" and snow "S",
        for `Frame.combined`.

    Examples
    --------
    >>> isolator_combinations()["maximum"]
    {'D': 1.2, 'L': 1.0, 'S': 0.15}
    """
    part = 0.2 * require_non_negative("s_ms [g]", s_ms)
    return {
        "average": {"D": 1.0, "L": 0.5, "S": 0.0},
        "maximum": {"D": 1.2 + part, "L": 1.0, "S": 0.15},
        "minimum": {"D": 0.9 - part, "L": 0.0, "S": 0.0},
    }


def combination(frame: FrameData, factors: Mapping[str, float], weight: str) -> dict[str, float]:
    """Return the factors of a combination once they fit the frame."""
    what = 'factors by load case: write {"D": 1.2, "L": 1.0}'
    require_type("factors of combined", factors, Mapping, what)
    found = {
        case: require_finite(f'factor of load case "{case}"', value, error=ModelError)
        for case, value in factors.items()
    }
    lacking = [case for case in (weight, *frame.load_cases) if case not in found]
    if lacking:
        what = "what masses weigh" if lacking[0] == weight else "loads of the frame"
        message = (
            f'combined: load case "{lacking[0]}" ({what}) has no factor: set one (0 leaves '
            f"it out). Cases with factors: {', '.join(found) or 'no case'}"
        )
        raise ModelError(message)
    return found


def factor_loads(frame: FrameData, factors: Mapping[str, float], weight: str) -> None:
    """Multiply the permanent loads of a frame and the weight of its masses; masses stay."""
    for node, mass in load_masses(frame, applied_loads(frame)).items():
        both = np.array([mass] * 3 + [0.0] * 3)
        for group in (frame._masses, frame._weightless):
            group[node] = frozen(group.get(node, np.zeros(6)) + both)
    frame._mass_source = {}
    _multiply(frame, factors)
    frame._weight_factor *= factors[weight]
    frame._superelements = {
        name: replace(
            part,
            load=frozen(factors[weight] * part.load),
            elements=part.elements.scaled(factors[weight]),
        )
        for name, part in frame._superelements.items()
    }


def factor_all(frame: FrameData, factors: Mapping[str, float], weight: str) -> None:
    """Multiply permanent loads and masses of a frame, so that all that weighs is mass."""
    share = factors[weight]
    if share <= 0.0:
        message = (
            f'combined: the factor {share:g} of "{weight}", which also scales masses, must '
            "be positive: raise it"
        )
        raise ModelError(message)
    if frame._superelements or frame._weightless:
        what = "superelements" if frame._superelements else "masses that do not weigh"
        message = (
            f"combined(masses=True): the frame has {what} outside the load cases: use masses=False"
        )
        raise ModelError(message)
    _multiply(frame, factors)
    frame._mass_source = dict.fromkeys(frame.load_cases, 1.0)
    frame._masses = {node: frozen(share * mass) for node, mass in frame._masses.items()}
    frame._members = {
        name: replace(
            member, section=replace(member.section, density=share * member.section.density)
        )
        for name, member in frame._members.items()
    }


def _multiply(frame: FrameData, factors: Mapping[str, float]) -> None:
    def scaled(group: dict[str, dict[str, FloatArray]]) -> dict[str, dict[str, FloatArray]]:
        return {
            key: {case: frozen(factors[case] * values) for case, values in cases.items()}
            for key, cases in group.items()
        }

    frame._loads, frame._uniform_loads = scaled(frame._loads), scaled(frame._uniform_loads)
    frame._tapered_loads = {
        member: tuple(
            replace(
                load,
                start=_times(factors[load.case], load.start),
                end=_times(factors[load.case], load.end),
            )
            for load in loads
        )
        for member, loads in frame._tapered_loads.items()
    }
    frame._floor_loads = {
        name: replace(load, q=factors[load.case] * load.q, mass=None)
        for name, load in frame._floor_loads.items()
    }


def _times(factor: float, vector: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = vector
    return factor * x, factor * y, factor * z


class NodeLoad(NamedTuple):
    """Forces and moments (6,) on a node [N, N m], and the share of them that is mass [-]."""

    node: str
    forces: FloatArray
    share: float


class SpanLoad(NamedTuple):
    """A load along a member, and its share that is mass [-]."""

    member: str
    load: TaperedLoad
    share: float


class AppliedLoads(NamedTuple):
    """Sums of the loads of floor panels and tapered loads."""

    nodes: list[NodeLoad]  # of floor panels, on the rigid end zones of members
    # of floor panels and tapered loads; uniform loads are in `Frame.uniform_loads`
    spans: list[SpanLoad]


def applied_loads(frame: FrameData) -> AppliedLoads:
    """Return the loads of floor panels and tapered loads."""
    found = AppliedLoads([], [])
    for member, loads in frame.tapered_loads.items():
        found.spans.extend(SpanLoad(member, x, frame.mass_source.get(x.case, 0.0)) for x in loads)
    for panel, parts in zip(frame.floor_loads.values(), _of_panels(frame), strict=True):
        share = frame.mass_source.get(panel.case, 0.0) if panel.mass is None else panel.mass
        found.spans.extend(SpanLoad(member, load, share) for member, load in parts.members)
        found.nodes.extend(NodeLoad(node, forces, share) for node, forces in parts.nodes)
    return found


_KNOWN: deque[tuple[list[object], list[PanelLoads]]] = deque(maxlen=8)  # results with their inputs


def _of_panels(frame: FrameData) -> list[PanelLoads]:
    # Results of an earlier call if nothing changed: parts of a frame are frozen.
    parts: list[object] = [*frame.nodes.values(), *frame.members.values()]
    parts += frame.floor_loads.values()
    for known, found in tuple(_KNOWN):
        if len(known) == len(parts) and all(map(is_, known, parts)):
            return found
    around = members_at(frame.members)
    found = [panel_loads(frame.nodes, around, panel) for panel in frame.floor_loads.values()]
    _KNOWN.append((parts, found))
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
                f'the mass from loads at node "{node}" is negative, {mass:g} kg: leave their '
                "case out of the mass source, or change their sign (down is -z)"
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
