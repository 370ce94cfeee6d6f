"""Input of an equivalent-linear analysis: the structure above the bearings."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from frames.design._errors import CheckError
from frames.statics.gravity import gravity
from lir_element.argument_checks import require_vector
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    from frames._types import FloatArray
    from frames.frame import Frame


@dataclass(frozen=True, kw_only=True)
class Superstructure:
    """The structure above the isolation system, for design formulas.

    Parameters
    ----------
    fixed_base_period : float
        Period of the structure on a fixed base, T_fb [s].
    storey_weights : tuple of float, (n,)
        Weight of each floor above the base level, lowest first [N]; the weight of the base level is
        the seismic weight minus their sum.
    storey_heights : tuple of float, (n,)
        Height of each storey [m].
    R : float
        Response modification factor of the same structure on a fixed base [-]; EN 1998 has the
        behaviour factor of `EN1998` instead.
    importance : float
        Importance factor I_e of the fixed-base structure [-], for least shears of ASCE 7.
    storey_stiffness : tuple of float, (n,), optional
        Lateral stiffness of each storey [N/m], for drifts; without it they are not checked.
    wind_shear : float
        Factored wind shear of the superstructure [N], least V_s of ASCE 7 and NCh2745.
    service_displacement : float
        Displacement of the bearings without an earthquake, of temperature or shrinkage [m].
    vertical_period : float, optional
        Vertical period T_v of the structure on its bearings [s], for the simplified analysis of
        EN 1998.

    Raises
    ------
    CheckError, ValueError, TypeError
        If numbers are out of bounds, or their counts differ.

    Examples
    --------
    >>> above = Superstructure(fixed_base_period=0.6, storey_weights=(2e6, 2e6, 1.5e6),
    ...                        storey_heights=(3.5, 7.0, 10.5), R=8.0)
    >>> sum(above.storey_weights) / 1e6
    5.5
    """

    fixed_base_period: float = field(metadata=number("s", "(0, inf)"))
    storey_weights: tuple[float, ...] = field(metadata=number("N", "(0, inf)"))
    storey_heights: tuple[float, ...] = field(metadata=number("m", "(0, inf)"))
    R: float = field(metadata=number("-", "[1, 12]"))
    importance: float = field(default=1.0, metadata=number("-", "(0, 3]"))
    storey_stiffness: tuple[float, ...] | None = field(
        default=None, metadata=number("N/m", "(0, inf)")
    )
    wind_shear: float = field(default=0.0, metadata=number("N", "[0, inf)"))
    service_displacement: float = field(default=0.0, metadata=number("m", "[0, inf)"))
    vertical_period: float | None = field(default=None, metadata=number("s", "(0, inf)"))

    def __post_init__(self) -> None:
        for name in ("storey_weights", "storey_heights", "storey_stiffness"):
            values = getattr(self, name)
            if values is not None:
                found = require_vector(name, values, len(self.storey_weights), error=CheckError)
                object.__setattr__(self, name, tuple(found.tolist()))
        if not self.storey_weights:
            msg = "storey_weights is empty: give the weight of at least one floor"
            raise CheckError(msg)
        check_numbers(self, error=CheckError)

    @classmethod
    def from_frame(
        cls,
        frame: Frame,
        *,
        R: float,  # noqa: N803
        importance: float = 1.0,
        storey_stiffness: tuple[float, ...] | None = None,
        wind_shear: float = 0.0,
        service_displacement: float = 0.0,
        vertical_period: float | None = None,
    ) -> Superstructure:
        """Return the structure above the bearings of a frame: weights, heights and period.

        Parameters
        ----------
        frame : Frame
            The model, whose lowest level is the base above the bearings (`Frame.add_level`); each
            node's mass above the bearings belongs to the level that is nearest in height.
        R, importance, storey_stiffness, wind_shear, service_displacement, vertical_period
            As in `Superstructure`.

        Returns
        -------
        Superstructure
            Model of the structure; its fixed-base period is the longest with bearings and base
            held.

        Raises
        ------
        CheckError
            If the frame has no level above its base.
        ModelError
            If the frame has no equilibrium.
        """
        levels = np.array([level.z for level in frame.levels])
        if len(levels) < 2:
            msg = (
                f"{len(levels)} levels, and at least 2 are needed: add the base and each floor "
                "by Frame.add_level"
            )
            raise CheckError(msg)
        return cls(
            fixed_base_period=gravity(frame).held_periods[0],
            storey_weights=tuple(floor_weights(frame).tolist()),
            storey_heights=tuple(np.diff(levels).tolist()),
            R=R,
            importance=importance,
            storey_stiffness=storey_stiffness,
            wind_shear=wind_shear,
            service_displacement=service_displacement,
            vertical_period=vertical_period,
        )

    @property
    def weight(self) -> float:
        """W_s, weight above the base level [N]."""
        return sum(self.storey_weights)

    @property
    def elevations(self) -> tuple[float, ...]:
        """Height of each floor above the base level [m]."""
        return tuple(np.cumsum(self.storey_heights).tolist())


def floor_weights(frame: Frame) -> FloatArray:
    """Return the weights of the masses of the floors above the base level [N].

    Shapes: result (n_floors,), lowest first.
    """
    levels = np.array([level.z for level in frame.levels])
    system = gravity(frame).system
    away = np.abs(system.coordinates[:, 2, None] - levels)
    own = np.where(system.above_bearings, system.node_mass[:, 0], 0.0)
    weights = frame.gravity * np.bincount(away.argmin(axis=1), own, len(levels))
    return np.asarray(weights[1:])
