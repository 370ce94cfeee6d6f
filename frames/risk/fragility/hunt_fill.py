"""Choice of the intensities of an incremental dynamic analysis: hunt and fill."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from frames.risk._errors import FragilityError
from lir_element.argument_checks import require_type
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray


@dataclass(frozen=True, kw_only=True)
class HuntFill:
    """Rules for the next intensities of a record, from its earlier runs.

    Hunt: steps from `first` upwards, each longer by `growth` than the one before, until the limit
    is exceeded. Bracket: runs within the gap about the limit, a third of it above the lower end,
    until it is narrow. Fill: the remaining runs in the widest gaps below.

    Parameters
    ----------
    first : float
        First intensity, in the unit of the measure.
    step : float, optional
        First step of the hunt; `first` if None.
    growth : float, optional
        Increase of each step; half of `first` if None.
    resolution : float
        Gap about the limit over its upper end at which the bracketing ends [-].
    runs : int
        Most runs of a record, failed ones included.
    highest : float
        Intensity beyond which the hunt does not go.

    Raises
    ------
    FragilityError
        If a value is out of its bounds.

    Notes
    -----
    Source: Vamvatsikos and Cornell (2002), Earthquake Eng. Struct. Dyn. 31:491-514, and (2004),
    Earthquake Spectra 20:523-553; the third of the gap is theirs (to be confirmed).

    Examples
    --------
    >>> rules = HuntFill(first=1.0, runs=6)
    >>> rules.next_intensities([], []), rules.next_intensities([1.0, 2.0], [0, 0])
    ((1.0,), (3.5,))
    >>> rules.next_intensities([1.0, 2.0, 3.5], [0, 0, 1])
    (2.5,)
    """

    first: float = field(metadata=number("", "(0, inf)"))
    step: float | None = field(default=None, metadata=number("", "(0, inf)"))
    growth: float | None = field(default=None, metadata=number("", "[0, inf)"))
    resolution: float = field(default=0.1, metadata=number("-", "[1e-6, 1)"))
    runs: int = field(default=12, metadata=number("", "[2, 1000)"))
    highest: float = field(default=math.inf, metadata=number("", "(0, inf]"))

    def __post_init__(self) -> None:
        """Check."""
        check_numbers(self, error=FragilityError)
        require_type("runs", self.runs, int, "a whole number")
        if self.highest < self.first:
            msg = f"highest = {self.highest:g} is below first = {self.first:g}: raise it"
            raise FragilityError(msg)

    def next_intensities(self, im: npt.ArrayLike, exceeded: npt.ArrayLike) -> tuple[float, ...]:
        """Return the next intensities of a record; none if it is complete.

        Parameters
        ----------
        im : array_like, shape (n,)
            Intensities that it was run at.
        exceeded : array_like, shape (n,)
            1 if the limit was exceeded, 0 if not, NaN if the run failed.

        Returns
        -------
        tuple of float
            One intensity while it hunts and brackets, all that are left when it fills.

        Raises
        ------
        FragilityError
            If the arrays differ in length.
        """
        at = np.asarray(im, dtype=np.float64)
        over = np.asarray(exceeded, dtype=np.float64)
        if at.shape != over.shape or at.ndim != 1:
            msg = f"im {at.shape} and exceeded {over.shape} must be lists of one length"
            raise FragilityError(msg)
        left = self.runs - len(at)
        if not len(at):
            return (float(self.first),)
        if left <= 0:
            return ()
        if not (over > 0.5).any():
            higher = self._hunted(at)
            return (higher,) if higher is not None else self._filled(at, left)
        upper = float(at[over > 0.5].min())
        lower = float(at[(over < 0.5) & (at < upper)].max(initial=0.0))
        if upper - lower > self.resolution * upper:
            return (self._between(lower, upper, at),)
        return self._filled(at[at <= lower], left)

    def _hunted(self, at: FloatArray) -> float | None:
        # The next higher intensity, None at the highest.
        step = self.first if self.step is None else self.step
        growth = 0.5 * self.first if self.growth is None else self.growth
        reached = float(at.max())
        if reached >= self.highest:
            return None
        return min(reached + step + growth * (len(at) - 1), self.highest)

    @staticmethod
    def _between(lower: float, upper: float, at: FloatArray) -> float:
        failed = np.sort(at[(at > lower) & (at < upper)])
        if not len(failed):
            return lower + (upper - lower) / 3.0
        ends = np.concatenate([[lower], failed, [upper]])
        return _middle_of_widest(ends)

    @staticmethod
    def _filled(at: FloatArray, left: int) -> tuple[float, ...]:
        ends, found = np.concatenate([[0.0], np.sort(at)]), []
        if len(ends) > 1:
            for _ in range(left):
                found.append(_middle_of_widest(ends))
                ends = np.sort(np.append(ends, found[-1]))
        return tuple(found)


def _middle_of_widest(ends: FloatArray) -> float:
    k = int(np.diff(ends).argmax())
    return float(0.5 * (ends[k] + ends[k + 1]))
