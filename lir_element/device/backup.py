"""What carries a structure once a bearing has failed, as an engineer specifies it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from lir_element.argument_checks import as_number, require_between, require_positive
from lir_element.units import LENGTHS, meant


@dataclass(frozen=True, slots=True, kw_only=True)
class BackupSupport:
    r"""A support beside a bearing that carries nothing until the bearing has failed.

    A bearing with one does not end an analysis by its failure: from then on it carries nothing,
    and the structure over it comes down by `drop`, on a flat stop that presses and rubs but does
    not pull. Without a stop (``drop=math.inf``) the neighbours have to carry the load.

    Parameters
    ----------
    drop : float
        Way that the top plate comes down from its undeformed place until the stop carries [m], at
        least 0; ``math.inf``: there is no stop.
    friction : float
        Friction coefficient of the stop [-], at least 0 and below 1.
    stiffness : float, optional
        Of the stop, vertical [N/m]. Default: the axial stiffness of the bearing.
    damping : float, optional
        Of the stop, vertical [N s/m]. Default: the axial damping of the bearing.

    Raises
    ------
    ValueError, TypeError
        If a value is out of bounds: the message names value, bound and remedy.

    Notes
    -----
    The stop is wide enough wherever the structure comes down. What presses on it acts under the top
    node, whose rotation meets no resistance; the moment that this takes is the bottom node's. Its
    friction is that of the surfaces (docs/theory.md, section 3): elastic sliding by the bearing's
    `yield_displacement`, then slip.

    Examples
    --------
    >>> BackupSupport(drop=0.05, friction=0.3).stiffness is None
    True
    """

    drop: float
    friction: float = 0.3
    stiffness: float | None = None
    damping: float | None = None

    def __post_init__(self) -> None:
        drop = as_number("drop", self.drop, "m")
        if drop != math.inf:
            remedy = f"{meant(drop, 'm', LENGTHS, 1e-3, 1.0)}, or math.inf without a stop"
            require_between("drop", drop, 0.0, 5.0, "m", remedy=remedy)
        require_between("friction", self.friction, 0.0, 1.0, "-")
        for name, unit in (("stiffness", "N/m"), ("damping", "N s/m")):
            value = getattr(self, name)
            if value is not None:
                require_positive(name, value, unit)

    def __str__(self) -> str:
        """Return it in words, for tables."""
        if self.drop == math.inf:
            return "none: the neighbours carry"
        return f"after {1e3 * self.drop:.4g} mm, friction {self.friction:.3g}"
