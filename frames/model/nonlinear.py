"""Verbs that add what yields, damps or stops: links, hinges of members, walls of a moat."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import ModelError
from frames.model.builder import FrameBuilder
from frames.model.components import DOFS, Link
from frames.model.geometry_checks import require_two_nodes
from frames.model.laws import LAWS, Gap, HertzGap, Law, PlasticHinge
from frames.model.names import known_name, new_name
from lir_element.argument_checks import require_choice, require_type, require_vector

if TYPE_CHECKING:
    from frames._types import FloatArray

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
            Its nodes. It sits at node j; where the nodes are apart, a rigid lever joins it to node
            i, so that rigid motions of both nodes are free of force.
        law : Bilinear, BoucWen, Tie, ViscousDamper, Gap or HertzGap
            Law of its force. The first two are part of the structure, carry permanent loads and
            must be elastic under them; the others are put in afterwards.
        direction : str or sequence of 3 floats
            "axial" for the line from i to j, one of "ux", "uy", "uz", "rx", "ry", "rz", or a
            vector. The deformation is positive where node j moves along it against node i.

        Raises
        ------
        ModelError
            If a name is unknown or taken, or nodes at one place have the direction "axial".
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
        """Give a member plastic hinges at its ends.

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
                f'member "{member}" has releases, and plastic hinges do not go with them: leave '
                "out one of the two"
            )
            raise ModelError(message)
        if not given:
            message = f'add_hinges("{member}", {{}}) names no end: give "i", "j" or one hinge'
            raise ModelError(message)
        self._hinges[member] = (given.get("i"), given.get("j"))

    def add_moat(
        self,
        name: str,
        nodes: Sequence[str],
        law: Gap | HertzGap | Mapping[str, Gap | HertzGap],
    ) -> None:
        """Put walls around nodes of the isolated base: what is met when the clearance is used up.

        Parameters
        ----------
        name : str
            Name of the moat; its walls are links "<name>-<node>-<side>" from ground nodes
            "<name>-<node>", which are fixed.
        nodes : sequence of str
            Nodes that may run into a wall, as the corners of the base slab: each has walls on all
            sides that the law names.
        law : Gap, HertzGap or mapping
            Of one node's part of a wall, on all four sides, or by side "x+", "x-", "y+", "y-":
            where the wall stands, seen from the node.

        Raises
        ------
        ModelError
            If a name is unknown or taken.
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
                f'direction of link "{name}" has no length: its nodes "{i}" and "{j}" stand at one '
                'place, give "ux", "uy", "uz" or a vector'
            )
            raise ModelError(message)
        return tuple((vector / size).tolist()), turns
