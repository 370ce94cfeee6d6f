"""Levels of the seismic action that a code asks for, and which checks it makes at each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from frames.design._errors import CheckError
from lir_element.argument_checks import require_between, require_choice

Judged = Literal["all", "superstructure", "isolation"]

MCE_R, DESIGN, MAXIMUM = "MCE_R", "design", "maximum"
"""Names of levels."""

NCH_MAXIMUM = 1.2
"""M_M of NCh2745: maximum over design level, to be confirmed against the standard."""


@dataclass(frozen=True)
class ActionLevel:
    """A level of the seismic action, and what is judged at it.

    Parameters
    ----------
    name : str
        As tables and checks show it.
    factor : float
        On motions that are scaled to the design spectrum [-], at least 1.
    judges : {"all", "superstructure", "isolation"}
        What is judged at this level: what stands on the bearings (base shear, storey shears and
        drifts, accelerations), the bearings (displacement, rims, slip, forces, uplift), or both.

    Raises
    ------
    CheckError
        If the factor is out of bounds, or a word is none of those allowed.

    Examples
    --------
    >>> from frames.design import HISTORY_RULES
    >>> [level.name for level in HISTORY_RULES["NCh2745"].levels]
    ['design', 'maximum']
    """

    name: str
    factor: float = 1.0
    judges: Judged = "all"

    def __post_init__(self) -> None:
        require_between("factor", self.factor, 1.0, 10.0, "-", error=CheckError)
        words = ("all", "superstructure", "isolation")
        require_choice("judges", self.judges, words, error=CheckError)

    @property
    def judges_bearings(self) -> bool:
        """Whether the bearings are judged at this level."""
        return self.judges != "superstructure"

    @property
    def judges_structure(self) -> bool:
        """Whether what stands on the bearings is judged at this level."""
        return self.judges != "isolation"
