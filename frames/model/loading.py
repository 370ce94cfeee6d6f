"""Masses and permanent loads of a frame: on nodes, along members, on floor panels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError, known_name, new_name
from frames.model.components import DEFAULT_CASE, FloorLoad, TaperedLoad
from frames.model.floors import floor_panel, members_at, panel_loads
from frames.model.frame_data import FrameData, frozen
from frames.model.geometry_checks import member_span
from lir_element.argument_checks import (
    require_non_negative,
    require_positive,
    require_type,
    require_vector,
)

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.model.floors import Span


class FrameLoader(FrameData):
    """The verbs of `Frame` that add masses and permanent loads."""

    def add_mass(
        self,
        node: str,
        mass: float,
        inertia: Sequence[float] = (0.0, 0.0, 0.0),
        *,
        weighs: bool = True,
    ) -> None:
        """Add a lumped mass to a node; repeated calls accumulate.

        Parameters
        ----------
        node : str
            Name of the node.
        mass : float
            Mass in all three directions [kg], >= 0. It also weighs, mass * gravity along -z.
        inertia : sequence of 3 floats
            Rotary inertia about global x, y, z through the node [kg m2], each >= 0.
        weighs : bool
            False for a mass whose weight is among the loads already.

        Raises
        ------
        ModelError
            If the node does not exist or a number is negative or not finite.
        """
        known_name(node, self._nodes, "node")
        number = require_non_negative(
            f'mass [kg] at node "{node}"', mass, remedy="give kg; masses add up", error=ModelError
        )
        rotary = require_vector(f'inertia [kg m2] at node "{node}"', inertia, 3, error=ModelError)
        if (rotary < 0.0).any():
            message = (
                f'inertia [kg m2] at node "{node}" = {rotary.tolist()} must be at least 0: give '
                "moments of inertia about global x, y, z"
            )
            raise ModelError(message)
        given = np.concatenate([np.full(3, number), rotary])
        self._masses[node] = frozen(self._masses.get(node, np.zeros(6)) + given)
        if not weighs:
            self._weightless[node] = frozen(self._weightless.get(node, np.zeros(6)) + given)

    def set_mass_source(self, shares: Mapping[str, float] | None) -> None:
        """Set the share of the permanent loads that is mass, by case; it replaces earlier ones.

        Parameters
        ----------
        shares : mapping or None
            Share of each case [-], >= 0, as in ``{"D": 1.0, "L": 0.25}``; cases that are not named,
            and all for None, make no mass. The vertical part of a load over gravity times its share
            is mass in all three directions: at its node; of a load along a member at the member's
            ends by the rule of the lever. The mass has no weight besides the load.

        Raises
        ------
        ModelError
            If a share is negative, or gravity is 0.

        Notes
        -----
        The masses are made when the frame is analysed, so that loads may be added before and
        after; a node whose loads pull upwards in sum is refused then. Horizontal loads, moments
        and loads of superelements make none.
        """
        what = 'shares by load case: write {"D": 1.0, "L": 0.25}'
        require_type("shares of set_mass_source", shares, (Mapping, type(None)), what)
        found = {}
        for case, share in dict(shares or {}).items():
            new_name(case, (), "load case")
            found[case] = require_non_negative(
                f'share of case "{case}" [-]', share, remedy="1 is the full load", error=ModelError
            )
        if found and self.gravity <= 0.0:
            message = (
                f"gravity = {self.gravity:g} m/s2 cannot convert loads to mass: use Frame(name, "
                "gravity=9.80665), or add_mass"
            )
            raise ModelError(message)
        self._mass_source = found

    def add_load(self, node: str, forces: Sequence[float], *, case: str = DEFAULT_CASE) -> None:
        """Add permanent forces and moments to a node; they carry no mass (`set_mass_source`).

        Parameters
        ----------
        node : str
            Name of the node.
        forces : sequence of 6 floats
            Forces along [N] and moments about [N m] global x, y, z; repeated calls accumulate.
        case : str
            Load case, for `combined`.

        Raises
        ------
        ModelError
            If the node does not exist, or a number is not finite.
        """
        known_name(node, self._nodes, "node")
        values = require_vector(f'forces [N, N m] at node "{node}"', forces, 6, error=ModelError)
        _accumulate(self._loads, node, case, values)

    def add_uniform_load(
        self, member: str, q: Sequence[float], *, case: str = DEFAULT_CASE
    ) -> None:
        """Add a permanent load along the whole of a member; no mass (`set_mass_source`).

        Parameters
        ----------
        member : str
            Name of the member.
        q : sequence of 3 floats
            Load per unit length along global x, y, z [N/m]; repeated calls accumulate.
        case : str
            Load case, for `combined`.

        Raises
        ------
        ModelError
            If the member does not exist, or a number is not finite.
        """
        known_name(member, self._members, "member")
        values = require_vector(f'uniform load [N/m] on member "{member}"', q, 3, error=ModelError)
        _accumulate(self._uniform_loads, member, case, values)

    def add_tapered_load(
        self,
        member: str,
        q_start: Sequence[float],
        q_end: Sequence[float],
        a: float = 0.0,
        b: float | None = None,
        *,
        case: str = DEFAULT_CASE,
    ) -> None:
        """Add a permanent load of linear size along a member, or a part of it.

        Parameters
        ----------
        member : str
            Name of the member.
        q_start, q_end : sequence of 3 floats
            Load per unit length along global x, y, z at its begin and end [N/m].
        a, b : float
            Begin and end: distances from the member's end i along its axis [m]; None is its end j.
        case : str
            Load case, for `combined`.

        Raises
        ------
        ModelError
            If the member does not exist, a number is not finite, or the part is not on it.

        Notes
        -----
        It carries no mass by itself (`set_mass_source`).
        """
        known_name(member, self._members, "member")
        what = f'tapered load [N/m] on member "{member}"'
        first, second = (
            require_vector(f"{name} of {what}", given, 3, error=ModelError).tolist()
            for name, given in (("q_start", q_start), ("q_end", q_end))
        )
        start, end = member_span(self._nodes, self._members[member], a, b)
        load = TaperedLoad(start, end, tuple(first), tuple(second), new_name(case, (), "load case"))
        self._put_on_member(member, load)

    def _put_on_member(self, member: str, load: TaperedLoad) -> None:
        # A load that is known to be one of this member.
        self._tapered_loads[member] = (*self._tapered_loads.get(member, ()), load)

    def add_floor_load(
        self,
        name: str,
        nodes: Sequence[str],
        q: float,
        *,
        span: Span | None = None,
        mass: float | None = None,
        case: str = DEFAULT_CASE,
    ) -> None:
        """Add a load to a floor panel; the members along its edges carry it.

        Parameters
        ----------
        name : str
            New name of the panel's load.
        nodes : sequence of str, (n,)
            Corners in order, three or more at one elevation, a convex outline. Along each edge that
            carries runs a member, or a chain of them, from corner to corner.
        q : float
            Load per unit area, downwards [N/m2], > 0.
        span : {None, "x", "y"} or sequence of 2 floats
            Direction in plan in which a one-way panel carries: each strip gives half of its load
            to the edges at its two ends. None: two ways, every point to the nearest edge, which
            on a rectangle makes triangles and trapezoids under 45 degrees.
        mass : float, optional
            Share of the load that is mass [-], as in `set_mass_source`, which it overrides; the
            mass has no weight besides the load.
        case : str
            Load case, for `combined`.

        Raises
        ------
        ModelError
            If the panel is not horizontal or not convex, no single chain of members runs along an
            edge that carries, or a number is out of bounds.

        Notes
        -----
        Sum and moments of the members' loads are those of the load on the panel.
        """
        new_name(name, self._floor_loads, "floor load")
        require_positive(f'q [N/m2] of floor load "{name}"', q, error=ModelError)
        share = mass
        if mass is not None:
            share = require_non_negative(f'mass [-] of floor load "{name}"', mass, error=ModelError)
            if share > 0.0 and self.gravity <= 0.0:
                message = (
                    f'mass of floor load "{name}" needs gravity above 0 m/s2: set gravity of the '
                    "Frame"
                )
                raise ModelError(message)
        corners, direction = floor_panel(self._nodes, name, nodes, span)
        load = FloorLoad(name, corners, float(q), direction, share, new_name(case, (), "load case"))
        panel_loads(self._nodes, members_at(self._members), load)  # raises if no member carries it
        self._floor_loads[name] = load


def _accumulate(
    group: dict[str, dict[str, FloatArray]], key: str, case: str, values: FloatArray
) -> None:
    # A new inner dict each time: copies of a frame share the old one.
    new_name(case, (), "load case")
    cases = group.get(key, {})
    group[key] = {**cases, case: frozen(cases.get(case, np.zeros(len(values))) + values)}
