"""The frame as the engineer describes it: nodes, members, masses, loads, bearings."""

from __future__ import annotations

import math
import warnings
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Literal, Self

import numpy as np

from frames._errors import ModelError, ModelWarning
from frames.model.axes import default_up, local_axes
from frames.model.contents import STANDARD_GRAVITY, FrameContents, frozen
from frames.model.damping import Damping, ModalDamping, RayleighDamping
from frames.model.names import known_name, new_name
from frames.model.parts import (
    DOFS,
    BearingLink,
    Diaphragm,
    Level,
    Member,
    Node,
    Spring,
    bearing_height,
)
from frames.model.sections import Section
from frames.model.superelement import superelement
from lir_element.door import require_non_negative, require_type, require_vector
from lir_element.units import LENGTHS

if TYPE_CHECKING:
    from frames._types import FloatArray, MatrixLike
    from frames.analysis.model_check import ModelCheck
    from frames.motion.ground_motion import GroundMotion
    from frames.opensees.structure import Taken
    from lir_element import LIRBearing

POSITION_TOLERANCE = 1e-3
"""How far positions that should agree may differ: diaphragm planes, bearing ends [m]."""


class Frame(FrameContents):
    """A structure on bearings, built one verb at a time; `frames.assembly` reads it.

    Units are SI, axes are global and right-handed with z up. Every call checks what it is given
    and leaves the frame as it was when it refuses.

    Parameters
    ----------
    name : str
        Name of the model.
    gravity : float
        Acceleration of gravity [m/s2], >= 0: every mass weighs mass * gravity along -z.

    Examples
    --------
    >>> from frames.model.sections import Section
    >>> frame = Frame("mast")
    >>> frame.add_node("foot", 0.0, 0.0, 0.0)
    >>> frame.add_node("top", 0.0, 0.0, 4.0)
    >>> frame.fix("foot", "all")
    >>> frame.add_member("mast", "foot", "top", Section.box(0.3, 0.3, 0.01))
    >>> frame.add_mass("top", 5000.0)
    """

    @classmethod
    def from_opensees(
        cls,
        base_nodes: Sequence[int],
        bearing: LIRBearing | Mapping[int, LIRBearing],
        *,
        vertical: Literal["y", "z"] | None = None,
        base_rotations: Literal["kept", "free", "fixed"] = "kept",
        base_diaphragm: bool = True,
        gravity: float | None = None,
        damping: bool = True,
        levels: Mapping[str, Sequence[int]] | None = None,
        other_supports: Collection[int] = (),
        accept_nonlinear: bool = False,
        vertical_mass: Literal["horizontal"] | Mapping[int, float] | None = None,
        length_unit: float = 1.0,
        force_unit: float = 1.0,
        name: str = "OpenSees model",
    ) -> Self:
        """Take over the current model of OpenSeesPy, linear as it stands, and put it on bearings.

        Parameters
        ----------
        base_nodes : sequence of int
            Tags of the nodes that stand on a bearing. Fixed ones are released: their translations
            and the rotation about the vertical.
        bearing : LIRBearing or mapping
            One bearing for all base nodes, or one by tag.
        vertical : {None, "z", "y"}
            Axis of the OpenSees model that points up: None is z in three dimensions and y in
            the plane. Results are in the axes of docs/conventions.md, z up.
        base_rotations : {"kept", "free", "fixed"}
            Rotations of the base nodes about horizontal axes: held where the model holds them (as
            stiff base beams would), free (of a model that has base beams), or held.
        base_diaphragm : bool
            Whether base nodes at one elevation move in plan as one rigid body, as on a base slab.
        gravity : float, optional
            Acceleration of gravity [m/s2] for a model without loads: its masses then weigh. None:
            its loads, as they stand, are what the bearings carry.
        damping : bool
            Whether to take over the damping of the model (Rayleigh, modal, dashpots).
        levels : mapping, optional
            Tags of nodes by name of level, for storey drifts. None: "level-0" at the base, and
            one at each elevation with mass.
        other_supports : collection of int
            Tags of supports that carry elements and shall stay as they are.
        accept_nonlinear : bool
            Whether to freeze the present stiffness of elements that have left their initial one.
        vertical_mass : {None, "horizontal"} or mapping
            Vertical mass besides that of the model: "horizontal" lets masses act along the
            vertical as along x, a mapping gives kg by tag. It adds no weight to a loaded model.
        length_unit, force_unit : float
            Units of the OpenSees model [m], [N]: 1e-3 and 1e3 for mm and kN. Time is in seconds.
        name : str
            Name of the frame.

        Returns
        -------
        Frame
            Nodes are named by their tags; "ground-<tag>" and "bearing-<tag>" stand below the base
            nodes. The model is the superelement "opensees", whose `notes` repeat the warnings.

        Raises
        ------
        ModelError
            If the model cannot be taken over; the message says what to change.
        ImportError
            If openseespy is not installed.

        Warns
        -----
        ModelWarning
            On what should be known: elements that may be nonlinear, damping of the isolation.

        Notes
        -----
        The OpenSees model stays as it is, time and recorders too, but its analysis objects are
        wiped (`wipeAnalysis`). Displacements count from its present state. What OpenSees does not
        show cannot be seen: damping by `modalDampingQ` and by elements' option ``-damp``. See
        docs/choices.md.
        """
        from frames.opensees import frame as opensees_frame  # needs the optional openseespy
        from frames.opensees.structure import Options

        tags, devices = opensees_frame.bearings_by_tag(base_nodes, bearing)
        options = Options(
            base_nodes=tags,
            bearings=devices,
            vertical=vertical,
            base_rotations=base_rotations,
            base_diaphragm=base_diaphragm,
            gravity=gravity,
            damping=damping,
            levels=levels,
            other_supports=tuple(other_supports),
            accept_nonlinear=accept_nonlinear,
            vertical_mass=vertical_mass,
            length_unit=length_unit,
            force_unit=force_unit,
        )
        frame = cls(name, STANDARD_GRAVITY if gravity is None else gravity)
        taken, structure = opensees_frame.read(options)
        frame._add_taken(taken)
        opensees_frame.refuse_taken(frame, structure, options)
        for note in taken.notes:
            warnings.warn(f"Frame.from_opensees: {note}", ModelWarning, stacklevel=2)
        return frame

    def _add_taken(self, taken: Taken) -> None:
        # Everything that was read of an OpenSees model.
        for name, point in taken.nodes.items():
            self.add_node(name, *point)
        for name, dofs in taken.fixed.items():
            self.fix(name, *dofs)
        self.add_superelement(
            "opensees", taken.members, **taken.matrices,
            load=taken.load, equations=taken.equations, notes=taken.notes,
        )  # fmt: skip
        for name, (i, j, device) in taken.bearings.items():
            self.add_bearing(name, i, j, device)
        for name, nodes in taken.diaphragms.items():
            self.add_diaphragm(name, nodes)
        for name, nodes in taken.levels.items():
            self.add_level(name, nodes)

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

    def add_mass(self, node: str, mass: float, inertia: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
        """Add a lumped mass to a node; repeated calls accumulate.

        Parameters
        ----------
        node : str
            Name of the node.
        mass : float
            Mass in all three directions [kg], >= 0. It also weighs, mass * gravity along -z.
        inertia : sequence of 3 floats
            Rotary inertia about global x, y, z through the node [kg m2], each >= 0.

        Raises
        ------
        ModelError
            If the node does not exist or a number is negative or not finite.
        """
        known_name(node, self._nodes, "node")
        number = require_non_negative(
            f'mass [kg] at node "{node}"', mass, remedy="masses add up, give kg", error=ModelError
        )
        rotary = require_vector(f'inertia [kg m2] at node "{node}"', inertia, 3, error=ModelError)
        if (rotary < 0.0).any():
            message = (
                f'inertia [kg m2] at node "{node}" = {rotary.tolist()} must be 0 or greater: '
                "give the moments of inertia about global x, y, z"
            )
            raise ModelError(message)
        total = self._masses.get(node, np.zeros(6))
        self._masses[node] = frozen(total + np.concatenate([np.full(3, number), rotary]))

    def add_member(
        self, name: str, i: str, j: str, section: Section, up: Sequence[float] | None = None
    ) -> None:
        """Add an elastic beam-column, rigidly joined to its nodes.

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

        Raises
        ------
        ModelError
            If a name is unknown or taken, the length is zero or `up` is parallel to the member.
        """
        new_name(name, self._members, "member")
        self._two_nodes(i, j, f'member "{name}"')
        require_type(f'section of member "{name}"', section, Section, "a Section: Section.box(...)")
        start, end = (np.array([self._nodes[node].position]) for node in (i, j))
        length = float(np.linalg.norm(end - start))
        if length < POSITION_TOLERANCE:
            message = (
                f'member "{name}" from "{i}" to "{j}" is {length:g} m long, it must be longer '
                f"than {POSITION_TOLERANCE:g} m: join coincident nodes by add_spring"
            )
            raise ModelError(message)
        given = (
            None
            if up is None
            else require_vector(f'up of member "{name}"', up, 3, error=ModelError)
        )
        try:
            local_axes(start, end, default_up(start, end) if given is None else given[None, :])
        except ModelError as cause:
            message = f'member "{name}" has no local axes: {cause}'
            raise ModelError(message) from cause
        fixed_up = None if given is None else (float(given[0]), float(given[1]), float(given[2]))
        self._members[name] = Member(name, i, j, section, fixed_up)

    def add_spring(self, name: str, i: str, j: str, stiffness: Sequence[float]) -> None:
        """Add a linear 6-component spring between two nodes, in global axes.

        The spring sits at the position of node j; where the nodes are apart, a rigid lever joins
        it to node i, so that rigid motions of both nodes are free of force.

        Parameters
        ----------
        name : str
            New name.
        i, j : str
            Its nodes, coincident or apart.
        stiffness : sequence of 6 floats
            Stiffness along x, y, z [N/m] and about x, y, z [N m/rad], each >= 0, not all 0.

        Raises
        ------
        ModelError
            If a name is unknown or taken, or a stiffness is negative or none is positive.
        """
        new_name(name, self._springs, "spring")
        self._two_nodes(i, j, f'spring "{name}"')
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
    ) -> None:
        """Add a linear part given by its matrices: of another program, or condensed.

        Its displacements u are ux, uy, uz, rx, ry, rz of its first node, then of the second, and
        so on, in global axes; they count from the state that matrices and loads belong to.

        Parameters
        ----------
        name : str
            New name.
        nodes : sequence of str, (n,)
            Its nodes.
        stiffness, mass : array_like or sparse, (6 n, 6 n)
            Symmetric matrices [N/m, N, N m] and [kg, kg m, kg m2]; the geometric stiffness
            included.
        damping : array_like or sparse, (6 n, 6 n), optional
            Symmetric damping [N s/m, N s, N m s] of the motion relative to the ground. What
            `set_damping` asks for acts besides.
        load : array_like, (6 n,), optional
            Permanent forces and moments [N, N m], its weight among them: its mass does not weigh
            by itself.
        equations : array_like or sparse, (m, 6 n), optional
            Ties of its displacements, ``equations @ u = 0``.
        notes : sequence of str
            What whoever reads the results should know of where it came from.

        Raises
        ------
        ModelError
            If the name is taken, a node unknown or listed twice, or an array has the wrong shape,
            is not finite or not symmetric.
        """
        new_name(name, self._superelements, "superelement")
        chosen = self._node_list(nodes, f'superelement "{name}"', least=1)
        self._superelements[name] = superelement(
            name, chosen, stiffness, mass,
            damping=damping, load=load, equations=equations, notes=notes,
        )  # fmt: skip

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
            If a node is unknown, repeated or taken, or the nodes are not at one elevation.
        """
        new_name(name, self._diaphragms, "diaphragm")
        chosen = self._node_list(nodes, f'diaphragm "{name}"', least=2)
        for other in self._diaphragms.values():
            shared = sorted(set(chosen) & set(other.nodes))
            if shared:
                message = (
                    f'node "{shared[0]}" of diaphragm "{name}" belongs to diaphragm '
                    f'"{other.name}" already: a node may be in one only, merge the two'
                )
                raise ModelError(message)
        self._one_elevation(chosen, f'diaphragm "{name}"')
        self._diaphragms[name] = Diaphragm(name, chosen)

    def add_load(self, node: str, forces: Sequence[float]) -> None:
        """Add permanent forces (3 x N) and moments (3 x N m), global axes; they carry no mass."""
        known_name(node, self._nodes, "node")
        values = require_vector(f'forces [N, N m] at node "{node}"', forces, 6, error=ModelError)
        self._loads[node] = frozen(self._loads.get(node, np.zeros(6)) + values)

    def add_uniform_load(self, member: str, q: Sequence[float]) -> None:
        """Add a permanent load per unit length [N/m], (3,) in global axes; it carries no mass."""
        known_name(member, self._members, "member")
        values = require_vector(f'uniform load [N/m] on member "{member}"', q, 3, error=ModelError)
        self._uniform_loads[member] = frozen(self._uniform_loads.get(member, np.zeros(3)) + values)

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
            If a name is unknown or taken, or the nodes are not where the bearing needs them.
        """
        new_name(name, self._bearings, "bearing")
        self._two_nodes(i, j, f'bearing "{name}"')
        height = bearing_height(name, bearing)
        below, above = self._nodes[i], self._nodes[j]
        offset = math.hypot(above.x - below.x, above.y - below.y)
        rise = above.z - below.z
        if offset > POSITION_TOLERANCE:
            message = (
                f'bearing "{name}": node "{j}" stands {offset:g} m beside the vertical through '
                f'node "{i}", at most {POSITION_TOLERANCE:g} m is allowed: give both one x and y'
            )
            raise ModelError(message)
        if min(abs(rise), abs(rise - height)) > POSITION_TOLERANCE:
            message = (
                f'bearing "{name}": node "{j}" is {rise:g} m above node "{i}", it must be 0 m or '
                f"the bearing's height {height:g} m within {POSITION_TOLERANCE:g} m: "
                f"place node j at z of node i plus bearing.height{_in_mm(rise, height)}"
            )
            raise ModelError(message)
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
            If the level does not lie above the one added before.
        """
        new_name(name, self._levels, "level")
        chosen = self._node_list(nodes, f'level "{name}"', least=1)
        z = self._one_elevation(chosen, f'level "{name}"')
        if self._levels:
            below = next(reversed(self._levels.values()))
            if z <= below.z + POSITION_TOLERANCE:
                message = (
                    f'level "{name}" at z = {z:g} m must lie above level "{below.name}" at '
                    f"{below.z:g} m: add levels from below to above, one for each elevation"
                )
                raise ModelError(message)
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
            "RayleighDamping, ModalDamping or None: "
            "write ModalDamping(0.02) for two per cent in every mode"
        )
        require_type("damping", damping, kinds, remedy)
        self._damping = damping

    def check(self, motion: GroundMotion | None = None) -> ModelCheck:
        """Add the model up, and say what looks as if given in other units or put in a wrong place.

        Parameters
        ----------
        motion : GroundMotion, optional
            The motion it is meant for.

        Returns
        -------
        ModelCheck
            Mass, weight and loads; periods with bearings held and on the bearings; axial force,
            pressure and settlement of each bearing; what is strange. It prints as a table.

        Raises
        ------
        ModelError
            If the model cannot be assembled. Where only the equilibrium fails, the table says so.
        """
        from frames.analysis.model_check import check_model  # the analysis reads the model

        return check_model(self, motion)

    def _two_nodes(self, i: str, j: str, owner: str) -> None:
        for node in (i, j):
            known_name(node, self._nodes, "node")
        if i == j:
            message = f'{owner} starts and ends at node "{i}": give two different nodes'
            raise ModelError(message)

    def _node_list(self, nodes: Sequence[str], owner: str, least: int) -> tuple[str, ...]:
        if isinstance(nodes, str):
            message = f'nodes of {owner} = "{nodes}" must be a list of names: write ["{nodes}"]'
            raise TypeError(message)
        chosen = tuple(known_name(node, self._nodes, "node") for node in nodes)
        repeated = sorted({node for node in chosen if chosen.count(node) > 1})
        if repeated:
            message = f'{owner} lists node "{repeated[0]}" more than once: list each node once'
            raise ModelError(message)
        if len(chosen) < least:
            message = f"{owner} has {len(chosen)} nodes, it needs {least} or more: name them"
            raise ModelError(message)
        return chosen

    def _one_elevation(self, nodes: tuple[str, ...], owner: str) -> float:
        low = min((self._nodes[node] for node in nodes), key=lambda node: node.z)
        high = max((self._nodes[node] for node in nodes), key=lambda node: node.z)
        if high.z - low.z > POSITION_TOLERANCE:
            message = (
                f'{owner} is not horizontal: node "{low.name}" is at z = {low.z:g} m, node '
                f'"{high.name}" at z = {high.z:g} m, they may differ by {POSITION_TOLERANCE:g} m: '
                "split it, or put its nodes at one elevation"
            )
            raise ModelError(message)
        return low.z


def _in_mm(rise: float, height: float) -> str:
    for name, factor in LENGTHS:
        if abs(rise * factor - height) <= max(POSITION_TOLERANCE * factor, 1e-3 * height):
            return f"; coordinates are in m ({rise:g} {name} are {rise * factor:.4g} m)"
    return ""
