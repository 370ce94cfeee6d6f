"""Damping of the structure, as data: the engineer's input, not yet a matrix."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from frames._errors import ModelError
from lir_element.argument_checks import require_between, require_positive


@dataclass(frozen=True)
class RayleighDamping:
    """Damping proportional to mass and stiffness, fitted at two periods.

    Parameters
    ----------
    ratio : float
        Damping ratio at both periods [-], in [0, 1).
    periods : tuple of two floats
        The two different periods at which the ratio holds [s], > 0.

    Raises
    ------
    ModelError
        If the ratio or a period is out of bounds, or the periods are equal.

    Notes
    -----
    Between the two periods the damping is lower, outside them it is higher. Both parts act on the
    motion relative to the part that follows the bearings quasi-statically (docs/theory.md): the
    isolation is not damped. Choose the periods for the structure above it.

    Examples
    --------
    >>> RayleighDamping(0.02, periods=(0.5, 0.1))
    RayleighDamping(ratio=0.02, periods=(0.5, 0.1))
    """

    ratio: float
    periods: tuple[float, float]

    def __post_init__(self) -> None:
        """Check every number."""
        object.__setattr__(self, "ratio", _ratio(self.ratio, "RayleighDamping.ratio"))
        given: object = self.periods
        if not isinstance(given, Sequence) or len(given) != 2:
            message = (
                f"RayleighDamping.periods = {given!r} must be two periods in s: use the first "
                "and the third of the structure"
            )
            raise ModelError(message)
        first, second = (
            require_positive("RayleighDamping.periods", value, remedy="give s", error=ModelError)
            for value in given
        )
        if first == second:
            message = (
                f"RayleighDamping.periods = ({first:g}, {second:g}) s must differ: use two "
                "different periods"
            )
            raise ModelError(message)
        object.__setattr__(self, "periods", (first, second))


@dataclass(frozen=True)
class ModalDamping:
    """Damping ratios of the modes of the structure.

    Parameters
    ----------
    ratio : float or tuple of floats
        Damping ratio of every mode [-], or those of the first modes, of which the last holds for
        all further modes; each in [0, 1).

    Raises
    ------
    ModelError
        If a ratio is out of bounds or the tuple is empty.

    Examples
    --------
    >>> ModalDamping((0.02, 0.03)).ratios
    (0.02, 0.03)
    """

    ratio: float | tuple[float, ...]

    def __post_init__(self) -> None:
        """Check every number."""
        if isinstance(self.ratio, Sequence):
            if not self.ratio:
                message = (
                    "ModalDamping.ratio is empty: pass one ratio, or one for each of the first "
                    "modes"
                )
                raise ModelError(message)
            checked = tuple(_ratio(value, "ModalDamping.ratio") for value in self.ratio)
            object.__setattr__(self, "ratio", checked)
        else:
            object.__setattr__(self, "ratio", _ratio(self.ratio, "ModalDamping.ratio"))

    @property
    def ratios(self) -> tuple[float, ...]:
        """Ratios of the first modes; the last one holds for all further modes [-]."""
        return self.ratio if isinstance(self.ratio, tuple) else (self.ratio,)


Damping: TypeAlias = RayleighDamping | ModalDamping
"""Argument of `Frame.set_damping`, besides None."""


def _ratio(value: float, what: str) -> float:
    return require_between(what, value, 0.0, 1.0, remedy="use 0.02 for 2 %", error=ModelError)
