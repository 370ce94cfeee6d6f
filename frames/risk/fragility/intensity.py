"""Intensity measures of ground motions, for fragility curves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol, runtime_checkable

import numpy as np

from frames.design.hazard.motion_measures import (
    ANGLES,
    MEASURES,
    build_up,
    cumulative_velocity,
    pair_spectrum,
)
from frames.motion.transforms import integrated
from frames.risk._errors import FragilityError
from lir_element.argument_checks import (
    require_between,
    require_choice,
    require_positive,
    require_type,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from frames._types import FloatArray
    from frames.motion.ground_motion import GroundMotion

Kind = Literal["Sa", "Sa_avg", "PGA", "PGV", "PGD", "CAV", "Arias", "scale"]

UNITS: dict[Kind, str] = {
    "Sa": "m/s2",
    "Sa_avg": "m/s2",
    "PGA": "m/s2",
    "PGV": "m/s",
    "PGD": "m",
    "CAV": "m/s",
    "Arias": "m/s",
    "scale": "-",
}
"""Kinds of intensity measures, and their units."""

OWN = "an Intensity, or a measure with unit, label and of(motion)"


@runtime_checkable
class IntensityMeasure(Protocol):
    """An intensity measure: an `Intensity`, or a user-defined one.

    If motions are scaled to an intensity (`ida`, `multiple_stripes`, ``Campaign(intensities=)``),
    it must grow with a power of the factor on the motion; the power is measured.

    Examples
    --------
    >>> import numpy as np
    >>> from frames.risk import IntensityMeasure
    >>> class RootMeanSquare:
    ...     unit, label = "m/s2", "root mean square of x"
    ...     def of(self, motion):
    ...         return np.sqrt(np.mean(motion.x**2))
    >>> isinstance(RootMeanSquare(), IntensityMeasure)
    True
    """

    @property
    def unit(self) -> str:
        """Unit of its values."""
        ...

    @property
    def label(self) -> str:
        """Name, in a few words; two of one label and unit are the same measure."""
        ...

    def of(self, motion: GroundMotion, /) -> float:
        """Return the intensity of a motion, above 0."""
        ...


@dataclass(frozen=True)
class StatedMeasure:
    """A measure of which a file keeps label and unit alone."""

    label: str
    unit: str

    def of(self, motion: GroundMotion, /) -> float:
        """Refuse: the function that it was is in no file."""
        msg = f"{self.label} of {motion.name or 'motion'}: give the measure itself, not that read"
        raise FragilityError(msg)


class Measured(Protocol):
    """A function of an intensity."""

    @property
    def unit(self) -> str:
        """Unit of the intensity."""
        ...

    @property
    def intensity(self) -> IntensityMeasure | None:
        """Intensity measure, None if it was not given."""
        ...


@dataclass(frozen=True, kw_only=True)
class Intensity:
    """An intensity measure that grows with the factor on a motion, or its square ("Arias").

    Parameters
    ----------
    kind : {"Sa", "Sa_avg", "PGA", "PGV", "PGD", "CAV", "Arias", "scale"}
        Spectral pseudo-acceleration, the geometric mean of those of several periods; peak
        acceleration, velocity or displacement of the ground; cumulative absolute velocity, the
        integral of abs(a); Arias intensity, pi / (2 g) times the integral of a^2; or the factor on
        the motion itself.
    period : float, optional
        Natural period of Sa [s]; usually of the isolated structure.
    periods : sequence of float, optional
        Natural periods of Sa_avg [s], rising, two at least; ten from 0.2 to 3 times that of the
        structure, equally apart in their logarithms, are usual. Those of the hazard, one by one.
    damping : float
        Damping of Sa and Sa_avg [-].
    measure : str
        Combination of both horizontal components (`pair_spectrum`): "RotD50", "RotD100", "geometric
        mean", "SRSS", "arithmetic mean", "x" or "y". The hazard must have the same.

    Raises
    ------
    FragilityError
        If an argument is out of its bounds.

    Examples
    --------
    >>> import numpy as np
    >>> from frames import GroundMotion
    >>> motion = GroundMotion(x=[0.0, 2.0, -3.0, 0.0], dt=0.1)
    >>> Intensity(kind="PGA", measure="x").of(motion)
    3.0
    >>> average = Intensity(kind="Sa_avg", periods=np.geomspace(0.6, 9.0, 10))
    >>> average.label
    'Sa_avg(10 periods from 0.6 to 9 s, 5 %), RotD50'
    """

    kind: Kind = "Sa"
    period: float | None = None
    damping: float = 0.05
    measure: str = "RotD50"
    periods: Sequence[float] = ()

    def __post_init__(self) -> None:
        """Check."""
        require_choice("kind", self.kind, tuple(UNITS), error=FragilityError)
        require_choice("measure", self.measure, tuple(MEASURES), error=FragilityError)
        require_between("damping", self.damping, 0.0, 1.0, "-", error=FragilityError)
        if self.kind == "Sa":
            if self.period is None:
                msg = 'period = None: give the period of Sa in s, or take kind="PGA" or "PGV"'
                raise FragilityError(msg)
            require_positive("period", self.period, "s", error=FragilityError)
        elif self.period is not None:
            msg = f'period = {self.period:g} s: only kind="Sa" has one, leave it out'
            raise FragilityError(msg)
        object.__setattr__(self, "periods", self._checked_periods())

    def _checked_periods(self) -> tuple[float, ...]:
        given = np.asarray(self.periods, dtype=np.float64)
        if self.kind != "Sa_avg":
            if given.size:
                msg = f'periods = {given.tolist()} s: only kind="Sa_avg" has them, leave them out'
                raise FragilityError(msg)
            return ()
        rising = given.ndim == 1 and len(given) > 1 and bool((np.diff(given) > 0.0).all())
        if not (rising and np.isfinite(given).all() and given[0] > 0.0):
            msg = (
                f"periods = {given.tolist()} s of Sa_avg must be two or more that rise from above "
                "0, such as numpy.geomspace(0.2 * T, 3.0 * T, 10)"
            )
            raise FragilityError(msg)
        return tuple(float(each) for each in given)

    @property
    def unit(self) -> str:
        """Unit of its values."""
        return UNITS[self.kind]

    @property
    def power(self) -> float:
        """Power of the factor on a motion that it grows with."""
        return 2.0 if self.kind == "Arias" else 1.0

    @property
    def label(self) -> str:
        """Name, in a few words."""
        if self.kind == "scale":
            return "factor on the motion"
        at = ""
        if self.kind == "Sa":
            at = f"({self.period:g} s, {100.0 * self.damping:g} %)"
        elif self.kind == "Sa_avg":
            low, high = self.periods[0], self.periods[-1]
            count = len(self.periods)
            at = f"({count} periods from {low:g} to {high:g} s, {100.0 * self.damping:g} %)"
        return f"{self.kind}{at}, {self.measure}"

    def of(self, motion: GroundMotion) -> float:
        """Return the intensity of a motion.

        Parameters
        ----------
        motion : GroundMotion
            The motion, with the horizontal components that the measure needs.

        Returns
        -------
        float
            Intensity, in `unit`.

        Raises
        ------
        FragilityError
            If the motion has none.
        MotionError
            If a component is missing.
        """
        if self.kind == "scale":
            return 1.0
        if self.period is not None:  # of Sa
            found = float(pair_spectrum(motion, [self.period], self.damping, self.measure)[0])
        elif self.kind == "Sa_avg":
            each = pair_spectrum(motion, self.periods, self.damping, self.measure)
            found = float(np.exp(np.log(each).mean())) if each.all() else 0.0
        elif self.kind == "PGA":
            found = float(pair_spectrum(motion, [0.0], 0.0, self.measure)[0])
        else:
            pair_spectrum(motion, [0.0], 0.0, self.measure)  # the components are there
            found = self._of_pair(motion)
        if not found > 0.0:
            msg = f"{motion.name or 'motion'} has no {self.label}: leave it out"
            raise FragilityError(msg)
        return found

    def _of_pair(self, motion: GroundMotion) -> float:
        # Histories as the path of a pair; integrals of each component, or each direction.
        dt = motion.dt
        x, y = (np.zeros(motion.n_steps) if a is None else a for a in (motion.x, motion.y))
        if self.kind in {"PGV", "PGD"}:
            moved = [integrated(a, dt)[self.kind == "PGD"] for a in (x, y)]
            return MEASURES[self.measure](*moved)
        number = _INTEGRALS[self.kind]
        if self.measure in {"RotD50", "RotD100"}:
            angles = np.pi / ANGLES * np.arange(ANGLES)
            each = [number(np.cos(a) * x + np.sin(a) * y, dt) for a in angles]
            return float(np.median(each) if self.measure == "RotD50" else np.max(each))
        return MEASURES[self.measure](*(np.array([number(a, dt)]) for a in (x, y)))


_INTEGRALS: dict[str, Callable[[FloatArray, float], float]] = {
    "CAV": cumulative_velocity,
    "Arias": lambda a, dt: float(build_up(a, dt)[-1]),
}


def is_same(first: IntensityMeasure, second: IntensityMeasure) -> bool:
    """Return whether two measures are the same; those of your own by label and unit."""
    if isinstance(first, Intensity) and isinstance(second, Intensity):
        return first == second
    return (first.label, first.unit) == (second.label, second.unit)


def unit_of(unit: str | None, intensity: IntensityMeasure | None) -> str:
    """Return the unit of intensities, checked against that of their measure."""
    if intensity is not None:
        require_type("intensity", intensity, IntensityMeasure, OWN)
        if unit not in {None, intensity.unit}:
            msg = f"unit = {unit!r}: {intensity.label} is in {intensity.unit}: convert the numbers"
            raise FragilityError(msg)
        return intensity.unit
    return "m/s2" if unit is None else unit


def require_one_measure(
    first: Measured, second: Measured, names: tuple[str, str] = ("the first", "the second")
) -> None:
    """Refuse two objects of different intensity measures."""
    told = [
        each.unit if each.intensity is None else f"{each.intensity.label} [{each.unit}]"
        for each in (first, second)
    ]
    a, b = first.intensity, second.intensity
    if first.unit != second.unit or (a is not None and b is not None and not is_same(a, b)):
        msg = (
            f"{names[0]} is over {told[0]}, {names[1]} over {told[1]}: bring them to one unit of "
            "one intensity measure"
        )
        raise FragilityError(msg)
