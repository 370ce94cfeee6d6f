"""The bearing between two rigid bodies of a model in Exudyn, a program for multibody dynamics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from lir_element.element import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from lir_element.device.bearing import LIRBearing
    from lir_element.device.features import Level
    from lir_element.layout import Floats

_NODE = "RigidBodyRotVecLG"
_SIZE = 6


class ExudynBearing:
    """An LIR-DCFP bearing between the ground, or a rigid body, and a rigid body above.

    Parameters
    ----------
    system : exudyn.MainSystem
        The model, to which an object for the bearing is added.
    bearing : LIRBearing
        The device.
    upper : (node, (x, y, z))
        Node of the body above, and the place of the bearing's top vertex in axes of that body [m].
    lower : (node, (x, y, z)), optional
        The same of the body below and the bottom vertex; None: the ground.
    level : {"pendulum", "contact"}
        Level of fidelity.

    Raises
    ------
    ImportError
        If exudyn is not installed.
    ValueError
        If a node is no NodeRigidBodyRotVecLG, is rotated in its reference state, or serves both
        ends.

    Notes
    -----
    Units are SI, z points upwards. The undeformed, unloaded bearing is that of the nodes'
    reference coordinates; the initial coordinates are to compress it by the weight. Pass
    `after_step` of all bearings to ``system.SetPostStepUserFunction``: it commits their states.

    Examples
    --------
    >>> from lir_element.exudyn import ExudynBearing, after_step  # with exudyn installed
    """

    def __init__(
        self,
        system: Any,
        bearing: LIRBearing,
        upper: tuple[Any, Sequence[float]],
        lower: tuple[Any, Sequence[float]] | None = None,
        level: Level = "pendulum",
    ) -> None:
        try:
            from exudyn import OutputVariableType
            from exudyn.itemInterface import ObjectGenericODE2
        except ImportError as cause:
            msg = 'exudyn is not installed: pip install "lir-dcfp[exudyn]"'
            raise ImportError(msg) from cause
        self.element = Element(bearing, level)
        ends = [(6, upper)] if lower is None else [(0, lower), (6, upper)]
        self._nodes = [end[0] for _, end in ends]
        self._check(system)
        self._places = [(first, np.array(end[1], dtype=np.float64)) for first, end in ends]
        self._kinds = OutputVariableType.Coordinates, OutputVariableType.Coordinates_t
        self._time: float | None = None
        size = _SIZE * len(ends)
        force, tangent = cast("Any", self._force), cast("Any", self._jacobian)
        self.object_number = system.AddObject(
            ObjectGenericODE2(
                nodeNumbers=self._nodes,
                massMatrix=np.zeros((size, size)),
                stiffnessMatrix=np.zeros((size, size)),
                dampingMatrix=np.zeros((size, size)),
                forceUserFunction=force,
                jacobianUserFunction=tangent,
            )
        )

    def commit(self, system: Any, time: float) -> None:
        """Accept the state at the end of a step.

        Parameters
        ----------
        system : exudyn.MainSystem
            The model.
        time : float
            End of the step [s]; a time before the last one accepted changes nothing.

        Raises
        ------
        AnalysisError
            If the state lies beyond a limit of the bearing.
        """
        if self._time is not None and time <= self._time:
            return
        q, rates = (
            np.concatenate([system.GetNodeOutput(node, kind) for node in self._nodes])
            for kind in self._kinds
        )
        self._trial(q, rates, time)
        self.element.commit()
        self._time = time

    def _check(self, system: Any) -> None:
        if len(set(map(str, self._nodes))) < len(self._nodes):
            msg = f"upper and lower are both node {self._nodes[0]}: pass the nodes of two bodies"
            raise ValueError(msg)
        for node in self._nodes:
            given = system.GetNode(node)
            if _NODE not in given["nodeType"]:
                msg = f"node {node} is a {given['nodeType']}: use a NodeRigidBodyRotVecLG"
                raise ValueError(msg)
            if np.any(np.array(given["referenceCoordinates"])[3:]):
                msg = f"node {node} is turned in its reference state: turn it by initialCoordinates"
                raise ValueError(msg)

    def _trial(self, q: Floats, rates: Floats, time: float) -> Floats:
        # Set the element's trial; return its motion (12,) by the coordinates' rates, (12, size).
        displacement, by_rates = np.zeros(12), np.zeros((12, q.size))
        for k, (first, place) in enumerate(self._places):
            own = slice(_SIZE * k, _SIZE * k + _SIZE)
            turn = q[own][3:]
            axes = _axes(turn)
            arm = axes @ place
            displacement[first : first + 6] = *(q[own][:3] + arm - place), *turn
            rows, turns = by_rates[first : first + 6, own], np.s_[3:]
            rows[:3, :3] = np.eye(3)
            rows[:3, turns] = -_skew(arm) @ axes  # the rates of a turn are in axes of the body
            rows[3:, turns] = axes
        self.element.set_trial(displacement, by_rates @ rates, time)
        return by_rates

    def _force(self, _system: Any, time: float, _item: int, q: Floats, rates: Floats) -> Floats:
        by_rates = self._trial(np.asarray(q), np.asarray(rates), time)
        return -by_rates.T @ self.element.resisting_force()

    def _jacobian(
        self,
        _system: Any,
        time: float,
        _item: int,
        q: Floats,
        rates: Floats,
        by_place: float,
        _by_rate: float,
    ) -> Floats:
        by_rates = self._trial(np.asarray(q), np.asarray(rates), time)
        return by_place * by_rates.T @ self.element.tangent_stiffness() @ by_rates


def after_step(bearings: Sequence[ExudynBearing]) -> Callable[[Any, float], bool]:
    """Return the function for ``system.SetPostStepUserFunction`` that commits bearings.

    Parameters
    ----------
    bearings : sequence of ExudynBearing
        All bearings of the model.

    Returns
    -------
    callable
        Function of the system and the time.

    Examples
    --------
    >>> from lir_element.exudyn import after_step
    >>> after_step([])(None, 0.0)
    True
    """

    def commit(system: Any, time: float) -> bool:
        for bearing in bearings:
            bearing.commit(system, time)
        return True

    return commit


def _skew(v: Floats) -> Floats:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _axes(turn: Floats) -> Floats:
    # The rotation matrix of a rotation vector.
    angle, cross = float(np.linalg.norm(turn)), _skew(turn)
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    return np.asarray(np.eye(3) + first * cross + second * cross @ cross)
