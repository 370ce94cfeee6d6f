"""The frame as the engineer describes it: built by its verbs, checked, copied, changed."""

from __future__ import annotations

import copy as copying
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from frames._errors import ModelError, known_name, new_name
from frames.model.builder import FrameBuilder
from frames.model.components import DEFAULT_CASE, DOFS, BearingLink, Link, bearing_height
from frames.model.geometry_checks import fits, require_bearing_place, require_two_nodes
from frames.model.laws import LAWS, Gap, HertzGap, Law, PlasticHinge
from frames.model.load_combinations import combination, factor_all, factor_loads
from lir_element.argument_checks import require_choice, require_type, require_vector

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element import LIRBearing

_SIDES = {"x+": (1.0, 0.0), "x-": (-1.0, 0.0), "y+": (0.0, 1.0), "y-": (0.0, -1.0)}


class NonlinearBuilder(FrameBuilder):
    """A frame that may yield."""

    def add_link(
        self, name: str, i: str, j: str, law: Law, direction: str | Sequence[float] = "axial"
    ) -> None:
        """Add a nonlinear spring, brace, damper or stop between two nodes.

        Parameters
        ----------
        name : str
            New name.
        i, j : str
            Nodes of the link. It is at node j; if the nodes are apart, a rigid lever joins it to
            node i, so that rigid motions of both nodes are free of force.
        law : Bilinear, BoucWen, Tie, ViscousDamper, Gap or HertzGap
            Law of its force. The first two are part of the structure, carry permanent loads and
            must be elastic under them; the others are added afterwards.
        direction : str or sequence of 3 floats
            "axial" for the line from i to j, one of "ux", "uy", "uz", "rx", "ry", "rz", or a
            vector. The deformation is positive if node j moves along it against node i.

        Raises
        ------
        ModelError
            If a name is unknown or in use, or nodes at one place have the direction "axial".
        TypeError
            If the law is none.
        """
        new_name(name, self._links, "link")
        require_two_nodes(self._nodes, i, j, f'link "{name}"')
        require_type(
            f'law of link "{name}"',
            law,
            LAWS,
            "a law such as Bilinear(stiffness=..., yield_force=...)",
        )
        vector, turns = self._link_direction(name, i, j, direction)
        self._links[name] = Link(name, i, j, law, vector, turns)

    def add_hinges(
        self,
        member: str,
        hinge: PlasticHinge | Mapping[str, PlasticHinge],
    ) -> None:
        """Add plastic hinges at the ends of a member.

        Parameters
        ----------
        member : str
            Name of the member.
        hinge : PlasticHinge or mapping
            One for both ends, or hinges by end: ``{"i": ...}``.

        Raises
        ------
        ModelError
            If the member is unknown, has hinges already, or releases.
        """
        known_name(member, self._members, "member")
        new_name(member, self._hinges, "pair of hinges on member")
        given = hinge if isinstance(hinge, Mapping) else {"i": hinge, "j": hinge}
        for end, each in given.items():
            require_choice(f'end of the hinge on member "{member}"', end, ("i", "j"))
            require_type(
                f'hinge at end {end} of member "{member}"',
                each,
                PlasticHinge,
                "a PlasticHinge(moment_y=..., moment_z=...)",
            )
        if any(self._members[member].releases):
            message = (
                f'member "{member}" has releases, which do not combine with plastic hinges: '
                "leave out one of the two"
            )
            raise ModelError(message)
        if not given:
            message = (
                f'add_hinges("{member}", {{}}) names no end: set hinges at "i" or "j", '
                "or pass one hinge for both"
            )
            raise ModelError(message)
        self._hinges[member] = (given.get("i"), given.get("j"))

    def add_moat(
        self,
        name: str,
        nodes: Sequence[str],
        law: Gap | HertzGap | Mapping[str, Gap | HertzGap],
    ) -> None:
        """Add walls around nodes of the isolated base, for contact beyond the clearance.

        Parameters
        ----------
        name : str
            Name of the moat; its walls are links "<name>-<node>-<side>" from ground nodes
            "<name>-<node>", which are fixed.
        nodes : sequence of str
            Nodes with possible wall contact, for example the corners of the base slab: each has
            walls on all sides of the law.
        law : Gap, HertzGap or mapping
            Law of one node's part of a wall, on all four sides, or by side "x+", "x-", "y+", "y-":
            the direction of the wall from the node.

        Raises
        ------
        ModelError
            If a name is unknown or in use.
        """
        given = law if isinstance(law, Mapping) else dict.fromkeys(_SIDES, law)
        for side, each in given.items():
            require_choice(f'side of moat "{name}"', side, tuple(_SIDES))
            require_type(
                f'law of moat "{name}", side {side}',
                each,
                (Gap, HertzGap),
                "a Gap(gap=..., stiffness=...) or a HertzGap",
            )
        for node in nodes:
            known_name(node, self._nodes, "node")
            new_name(f"{name}-{node}", self._nodes, "node")
            for side in given:
                new_name(f"{name}-{node}-{side}", self._links, "link")
        for node in nodes:
            ground = f"{name}-{node}"
            self.add_node(ground, *self._nodes[node].position)
            self.fix(ground, "all")
            for side, each in given.items():
                self.add_link(f"{ground}-{side}", ground, node, each, (*_SIDES[side], 0.0))

    def _link_direction(
        self, name: str, i: str, j: str, direction: str | Sequence[float] | FloatArray
    ) -> tuple[tuple[float, ...], bool]:
        # Unit vector, and whether it is an axis of rotation.
        if isinstance(direction, str):
            what = f'direction of link "{name}"'
            require_choice(what, direction, ("axial", *DOFS), error=ModelError)
            if direction == "axial":
                ends = [np.array(self._nodes[node].position) for node in (i, j)]
                vector, turns = ends[1] - ends[0], False
            else:
                place = DOFS.index(direction)
                vector, turns = np.eye(3)[place % 3], place >= 3
        else:
            vector = require_vector(f'direction of link "{name}"', direction, 3, error=ModelError)
            turns = False
        size = float(np.linalg.norm(vector))
        if not size > 0.0:
            message = (
                f'direction of link "{name}" has no length, because nodes "{i}" and "{j}" '
                'coincide: set direction to "ux", "uy", "uz" or a vector'
            )
            raise ModelError(message)
        return tuple((vector / size).tolist()), turns


class Frame(NonlinearBuilder):
    """A frame that can be copied, put on other bearings, and lose parts."""

    def copy(self, name: str | None = None) -> Self:
        """Return a copy that shares nothing mutable.

        Parameters
        ----------
        name : str, optional
            Name of the copy; that of this frame if None.

        Returns
        -------
        Frame
            The copy: later additions to one are not in the other.
        """
        found = copying.copy(self)
        if name is not None:
            found._name = new_name(name, (), "frame")
        return found

    def with_bearings(
        self, bearing: LIRBearing | Mapping[str, LIRBearing], name: str | None = None
    ) -> Self:
        """Return a copy on other bearings.

        Parameters
        ----------
        bearing : LIRBearing or mapping
            One device for all bearings, or devices by name of bearing; those that are not named
            stay.
        name : str, optional
            Name of the copy; that of this frame if None.

        Returns
        -------
        Frame
            The same structure. If a device has another height, the node below it is moved up or
            down; this is possible for a node of the ground that carries nothing else.

        Raises
        ------
        ModelError
            If there is no bearing of a name, or a device does not fit between its nodes.
        """
        found = self.copy(name)
        chosen = bearing if isinstance(bearing, Mapping) else dict.fromkeys(self._bearings, bearing)
        for each, device in chosen.items():
            known_name(each, self._bearings, "bearing")
            link = self._bearings[each]
            found._settle_under(each, link, bearing_height(each, device))
            require_bearing_place(found._nodes, each, link.i, link.j, device)
            found._bearings[each] = replace(link, bearing=device)
        return found

    def combined(
        self,
        factors: Mapping[str, float],
        name: str | None = None,
        *,
        weight: str = DEFAULT_CASE,
        masses: bool = False,
    ) -> Self:
        """Return a copy whose permanent loads are a combination of the load cases.

        Parameters
        ----------
        factors : mapping of str to float
            Factor of each load case [-], as in ``{"D": 1.2, "L": 0.5}``; `isolator_combinations`
            has those of ASCE 7. A missing case of the frame is refused; a case that the frame lacks
            has no effect.
        name : str, optional
            Name of the copy; that of this frame if None.
        weight : str
            The case to which the weight of masses, members and superelements belongs.
        masses : bool
            False: masses stay as they are, those that loads make (`set_mass_source`) included.
            True: all that weighs in the combination is mass, lumped masses and those of members
            by the factor of `weight`, loads by their own.

        Returns
        -------
        Frame
            The copy; `weight_factor` is the factor on the weight of masses.

        Raises
        ------
        ModelError
            If a case has no factor, or masses cannot follow.
        """
        found = self.copy(name)
        chosen = combination(self, factors, weight)
        (factor_all if masses else factor_loads)(found, chosen, weight)
        return found

    def remove(self, kind: str, name: str) -> None:
        """Remove a part from the frame.

        Parameters
        ----------
        kind : str
            "member", "spring", "link", "hinges", "bearing", "diaphragm", "level", "mass", "load" or
            "floor load". A mass or a load has the name of its node, and is removed from all load
            cases; hinges have the name of their member. A member's hinges and own loads are removed
            with it; a floor load on it must be removed as well.
        name : str
            Name of the part.

        Raises
        ------
        ModelError
            If there is no part of that name.
        """
        groups: dict[str, dict[str, Any]] = {
            "member": self._members,
            "spring": self._springs,
            "link": self._links,
            "hinges": self._hinges,
            "bearing": self._bearings,
            "diaphragm": self._diaphragms,
            "level": self._levels,
            "mass": self._masses,
            "load": self._loads,
            "floor load": self._floor_loads,
        }
        if kind not in groups:
            msg = f"kind = {kind!r}: choose one of {', '.join(groups)}"
            raise ModelError(msg)
        known_name(name, groups[kind], kind)
        del groups[kind][name]
        if kind == "member":
            self._uniform_loads.pop(name, None)
            self._hinges.pop(name, None)
            self._tapered_loads.pop(name, None)
        elif kind == "mass":
            self._weightless.pop(name, None)

    def _settle_under(self, name: str, link: BearingLink, height: float) -> None:
        # Moves the node below a bearing so that a device of another height fits.
        low, high = self._nodes[link.i], self._nodes[link.j]
        if fits(high.z - low.z, height):
            return
        ends: list[tuple[str, ...]] = [
            *((member.i, member.j) for member in self._members.values()),
            *((spring.i, spring.j) for spring in self._springs.values()),
            *((part.i, part.j) for part in self._links.values()),
            *((other.i, other.j) for key, other in self._bearings.items() if key != name),
            *(part.nodes for part in self._superelements.values()),
        ]
        ground = {"ux", "uy", "uz"} <= self._fixed.get(link.i, frozenset())
        if ground and not any(link.i in nodes for nodes in ends):
            self._nodes[link.i] = replace(low, z=high.z - height)


def stand(frame: Frame, node: str, name: str, bearing: LIRBearing, mark: str) -> None:
    """Put a bearing under a node, on the fixed node "ground-<mark>"."""
    x, y, z = frame.nodes[node].position
    frame.add_node(f"ground-{mark}", x, y, z - bearing.height)
    frame.fix(f"ground-{mark}", "all")
    frame.add_bearing(name, f"ground-{mark}", node, bearing)
