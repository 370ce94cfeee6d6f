"""Building a frame: one verb for each kind of part, checked before anything is changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from frames._errors import ModelError, known_name, new_name
from frames.model.components import DOFS, BearingLink, Diaphragm, Level, Member, Node, Spring
from frames.model.damping import Damping, ModalDamping, RayleighDamping
from frames.model.geometry_checks import (
    member_offsets,
    member_releases,
    member_up,
    node_list,
    one_elevation,
    refuse_shared,
    require_above,
    require_bearing_place,
    require_two_nodes,
)
from frames.model.loading import FrameLoader
from frames.model.sections import Section
from frames.model.superelement import superelement
from lir_element.argument_checks import require_type, require_vector

if TYPE_CHECKING:
    from frames._types import FloatArray, MatrixLike
    from frames.model.superelement import PartElements
    from lir_element import LIRBearing


class FrameBuilder(FrameLoader):
    """The verbs of `Frame` that add parts; each leaves it as it was when it refuses."""

    def add_node(self, name: str, x: float, y: float, z: float) -> None:
        """Add a node at (x, y, z) [m]; the name must be new."""
        new_name(name, self._nodes, "node")
        point = require_vector(f'coordinates [m] of node "{name}"', (x, y, z), 3, error=ModelError)
        self._nodes[name] = Node(name, *point.tolist())

    def fix(self, node: str, *dofs: str) -> None:
        """Fix degrees of freedom of a node to the ground.

        Parameters
        ----------
        node : str
            Name of the node.
        *dofs : str
            Any of "ux", "uy", "uz", "rx", "ry", "rz", or "all"; added to those fixed before.

        Raises
        ------
        ModelError
            If the node or a degree of freedom does not exist, or none is named.
        """
        known_name(node, self._nodes, "node")
        if not dofs:
            message = f'fix("{node}") names no degree of freedom: add "all" or some of {DOFS}'
            raise ModelError(message)
        for dof in dofs:
            if dof != "all" and dof not in DOFS:
                message = f'fix("{node}", {dof!r}): a degree of freedom is "all" or one of {DOFS}'
                raise ModelError(message)
        chosen = frozenset(DOFS) if "all" in dofs else frozenset(dofs)
        self._fixed[node] = self._fixed.get(node, frozenset()) | chosen

    def add_member(
        self,
        name: str,
        i: str,
        j: str,
        section: Section,
        up: Sequence[float] | None = None,
        *,
        releases: Mapping[str, Sequence[str]] | None = None,
        offsets: Mapping[str, Sequence[float]] | None = None,
    ) -> None:
        """Add an elastic beam-column, rigidly joined to its nodes but for its releases.

        Parameters
        ----------
        name : str
            New name.
        i, j : str
            Nodes at its ends; local x runs from i to j.
        section : Section
            Section; density * area * length is its mass, lumped half to each end.
        up : sequence of 3 floats, optional
            Vector that fixes the local x-z plane; default global Z, and global X for vertical
            members.
        releases : mapping, optional
            Moments that an end does not pass on, of "T", "My" and "Mz" about local x, y and z: a
            strut that is hinged at both ends has ``{"i": ("My", "Mz"), "j": ("My", "Mz")}``. A node
            whose rotation nothing else holds must be fixed.
        offsets : mapping, optional
            Rigid end zones: vectors from node i and from node j to the member's ends, in global
            axes [m]: a beam along x between columns 0.5 m wide has
            ``{"i": (0.25, 0, 0), "j": (-0.25, 0, 0)}``. The member, its loads, its mass and its
            end forces are those of the length between its ends; half of its mass is lumped to
            each node.

        Raises
        ------
        ModelError
            If a name is unknown or in use, the length is zero, `up` is parallel to the member,
            torsion is released at both ends, or offsets leave no length.
        """
        new_name(name, self._members, "member")
        require_two_nodes(self._nodes, i, j, f'member "{name}"')
        require_type(f'section of member "{name}"', section, Section, "a Section: Section.box(...)")
        zones = member_offsets(name, offsets)
        fixed_up = member_up(self._nodes, name, i, j, up, zones)
        self._members[name] = Member(
            name, i, j, section, fixed_up, member_releases(name, releases), zones
        )

    def add_spring(self, name: str, i: str, j: str, stiffness: Sequence[float]) -> None:
        """Add a linear 6-component spring between two nodes, in global axes.

        The spring is at the position of node j; if the nodes are apart, a rigid lever joins it to
        node i, so that rigid motions of both nodes are free of force.

        Parameters
        ----------
        name : str
            New name.
        i, j : str
            Nodes of the spring, coincident or apart.
        stiffness : sequence of 6 floats
            Stiffness along x, y, z [N/m] and about x, y, z [N m/rad], each >= 0, not all 0.

        Raises
        ------
        ModelError
            If a name is unknown or in use, or a stiffness is negative or none is positive.
        """
        new_name(name, self._springs, "spring")
        require_two_nodes(self._nodes, i, j, f'spring "{name}"')
        values = require_vector(f'stiffness of spring "{name}"', stiffness, 6, error=ModelError)
        if (values < 0.0).any() or not values.any():
            message = (
                f'stiffness of spring "{name}" = {values.tolist()} must be 0 or greater and not '
                "all 0: give N/m along x, y, z and N m/rad about x, y, z"
            )
            raise ModelError(message)
        self._springs[name] = Spring(name, i, j, tuple(values.tolist()))

    def add_superelement(
        self,
        name: str,
        nodes: Sequence[str],
        stiffness: MatrixLike,
        mass: MatrixLike,
        *,
        damping: MatrixLike | None = None,
        load: Sequence[float] | FloatArray | None = None,
        equations: MatrixLike | None = None,
        notes: Sequence[str] = (),
        elements: PartElements | None = None,
    ) -> None:
        """Add a linear part given by its matrices: of another program, or condensed.

        Its displacements u are ux, uy, uz, rx, ry, rz of its first node, then of the second, and
        so on, in global axes; they count from the state that matrices and loads belong to.

        Parameters
        ----------
        name : str
            New name.
        nodes : sequence of str, (n,)
            Nodes of the superelement.
        stiffness, mass : array_like or sparse, (6 n, 6 n)
            Symmetric matrices [N/m, N, N m] and [kg, kg m, kg m2]; the geometric stiffness
            included.
        damping : array_like or sparse, (6 n, 6 n), optional
            Symmetric damping [N s/m, N s, N m s] of the motion relative to the ground. That of
            `set_damping` acts in addition.
        load : array_like, (6 n,), optional
            Permanent forces and moments [N, N m], its weight among them: its mass does not weigh
            by itself.
        equations : array_like or sparse, (m, 6 n), optional
            Ties of its displacements, ``equations @ u = 0``.
        notes : sequence of str
            Remarks on its origin for readers of the results.
        elements : PartElements, optional
            Line elements that are in the matrices already: how the forces in them follow from
            displacements (`frames.model.superelement`), so that results have them with those of
            members.

        Raises
        ------
        ModelError
            If the name is in use, a node unknown or listed twice, or an array has the wrong shape,
            is not finite or not symmetric.
        """
        new_name(name, self._superelements, "superelement")
        chosen = node_list(self._nodes, nodes, f'superelement "{name}"', least=1)
        self._superelements[name] = superelement(
            name,
            chosen,
            stiffness,
            mass,
            damping=damping,
            load=load,
            equations=equations,
            notes=notes,
            elements=elements,
        )

    def add_diaphragm(self, name: str, nodes: Sequence[str]) -> None:
        """Make nodes move in their horizontal plane as one rigid body.

        Parameters
        ----------
        name : str
            New name.
        nodes : sequence of str
            Two nodes or more at one elevation within 1 mm, in no other diaphragm.

        Raises
        ------
        ModelError
            If a node is unknown, repeated or in another diaphragm, or the nodes are not at one
            elevation.
        """
        new_name(name, self._diaphragms, "diaphragm")
        chosen = node_list(self._nodes, nodes, f'diaphragm "{name}"', least=2)
        refuse_shared(name, chosen, self._diaphragms)
        one_elevation(self._nodes, chosen, f'diaphragm "{name}"')
        self._diaphragms[name] = Diaphragm(name, chosen)

    def add_bearing(self, name: str, i: str, j: str, bearing: LIRBearing) -> None:
        """Put a bearing between two nodes of one vertical.

        Parameters
        ----------
        name : str
            New name.
        i, j : str
            Node below and node above, at distance 0 or `bearing.height`, within 1 mm. Node i is
            a fixed node of the ground or a node of the structure below.
        bearing : LIRBearing
            The device.

        Raises
        ------
        ModelError
            If a name is unknown or in use, or the nodes are not at the bearing's ends.
        """
        new_name(name, self._bearings, "bearing")
        require_two_nodes(self._nodes, i, j, f'bearing "{name}"')
        require_bearing_place(self._nodes, name, i, j, bearing)
        self._bearings[name] = BearingLink(name, i, j, bearing)

    def add_level(self, name: str, nodes: Sequence[str]) -> None:
        """Name a storey level, from below to above, for storey drifts.

        Parameters
        ----------
        name : str
            New name.
        nodes : sequence of str
            One node or more at one elevation within 1 mm.

        Raises
        ------
        ModelError
            If the level is not above the one added before.
        """
        new_name(name, self._levels, "level")
        chosen = node_list(self._nodes, nodes, f'level "{name}"', least=1)
        z = one_elevation(self._nodes, chosen, f'level "{name}"')
        require_above(name, z, next(reversed(self._levels.values()), None))
        self._levels[name] = Level(name, z, chosen)

    def set_damping(self, damping: Damping | None) -> None:
        """Set the damping of the structure: RayleighDamping, ModalDamping or None.

        Parameters
        ----------
        damping : RayleighDamping, ModalDamping or None
            Damping of members and springs; the bearings dissipate by themselves.

        Notes
        -----
        Anything else is refused with a `TypeError`, a bare number among them.
        """
        kinds = (RayleighDamping, ModalDamping, type(None))
        remedy = (
            "RayleighDamping, ModalDamping or None: write ModalDamping(0.02) for 2 % in every mode"
        )
        require_type("damping", damping, kinds, remedy)
        self._damping = damping
