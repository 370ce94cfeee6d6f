"""Friction laws of a concave surface, as an engineer specifies them, and their base class."""

from __future__ import annotations

import abc
import inspect
import math
from dataclasses import dataclass, field, is_dataclass
from functools import cached_property, lru_cache
from math import exp
from typing import TYPE_CHECKING, Any, final

import numpy as np

from lir_element.argument_checks import require_within
from lir_element.device.friction_table import FASTEST, FrictionValues, never_falling, sampled
from lir_element.fields import check_numbers, number
from lir_element.units import per_cent

if TYPE_CHECKING:
    from collections.abc import Callable

    from lir_element.layout import Floats, Records

_COEFFICIENT = number("-", "[0, 1)", remedy=per_cent)
_SAME = 1e-6  # of the coefficient, within which a law's own limits must be those of `at_speed`

_KNOWN: dict[str, dict[tuple[str, str], type[FrictionLaw]]] = {}
"""Laws by the name of their class, then by the place of its definition."""


class _OfSpeed:
    """Coefficient that a law derives from `at_speed`, unless a field of that name gives it.

    The class itself does not show it: a dataclass would use it as the default of such a field.
    """

    def __init__(self, of: Callable[[Any], float]) -> None:
        self._of, self.__doc__ = of, of.__doc__

    def __get__(self, law: object | None, owner: type | None = None) -> float:
        if law is None:
            raise AttributeError(self.__doc__)
        return self._of(law)


class FrictionLaw(abc.ABC):
    """A friction coefficient over the sliding speed: base class of the laws of a concave surface.

    A user-defined law is a frozen dataclass that derives from this class and gives `at_speed`
    (docs/extending.md). Kernels then read it from a table, cubic between 129 knots, which is made
    with the law and compared with it. Its fields are the parameters of campaigns and the keys of a
    project's file; ``field(metadata={"unit": "s/m"})`` names the SI unit of one.

    Raises
    ------
    TypeError
        If a law is no frozen dataclass, or a field cannot be hashed.
    ValueError
        If the coefficient is not finite, is outside of 0 to 1, falls with speed, or has no limit at
        high speed. If its table is off by more than 0.1 % of `f_max`. If a field `f_max` or `f_min`
        differs from `at_speed` at high speed or at rest.

    Notes
    -----
    A law with a ``__post_init__`` of its own ends it with ``FrictionLaw.__post_init__(self)``.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class HyperbolicFriction(FrictionLaw):
    ...     f_max: float
    ...     f_min: float
    ...     half_speed: float
    ...
    ...     def at_speed(self, speed):
    ...         share = speed / (speed + self.half_speed)
    ...         return self.f_min + (self.f_max - self.f_min) * share
    >>> law = HyperbolicFriction(0.06, 0.03, 0.02)
    >>> round(law.at_speed(0.02), 4), round(law.scaled(1.2).f_max, 4)
    (0.045, 0.072)
    """

    __slots__ = ()

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        closed = [base.__name__ for base in cls.__bases__ if getattr(base, "__final__", False)]
        if closed:
            msg = (
                f"{cls.__name__} must derive from FrictionLaw: the formula of {closed[0]} is "
                "built in"
            )
            raise TypeError(msg)
        _KNOWN.setdefault(cls.__name__, {})[cls.__module__, cls.__qualname__] = cls

    def __post_init__(self) -> None:
        self.kernel_values()

    if TYPE_CHECKING:

        @property
        def f_min(self) -> float:
            """Friction coefficient at rest [-], the least."""

        @property
        def f_max(self) -> float:
            """Friction coefficient at high speed [-], the largest."""
    else:

        @_OfSpeed
        def f_min(self) -> float:
            """Friction coefficient at rest [-], the least."""
            return float(self.at_speed(0.0))

        @_OfSpeed
        def f_max(self) -> float:
            """Friction coefficient at high speed [-], the largest."""
            return float(self.at_speed(FASTEST))

    @abc.abstractmethod
    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s], at least 0."""

    def scaled(self, factor: float) -> FrictionLaw:
        """Return the law with its coefficients times a factor [-], as at a bound of properties."""
        return _Scaled(self, float(factor))

    def kernel_values(self) -> FrictionValues:
        """Return the limits of the law and the table that kernels read.

        Returns
        -------
        FrictionValues
            Friction at high speed, its drop at rest [-], rate [s/m], table, error of the table [-].

        Raises
        ------
        TypeError
            If the law is no frozen dataclass, or a field cannot be hashed.
        ValueError
            As for the class.
        """
        name = type(self).__name__
        parameters: Any = getattr(self, "__dataclass_params__", None)
        if parameters is None or not parameters.frozen:
            msg = (
                f"{name} must be a frozen dataclass: write @dataclass(frozen=True) above its class"
            )
            raise TypeError(msg)
        try:
            hash(self)
        except TypeError as cause:
            msg = f"{name}: {cause}; use numbers, strings or tuples as its fields"
            raise TypeError(msg) from cause
        values = _sampled(self)
        for limit, speed, found in (
            ("f_max", "high speed", values.most),
            ("f_min", "rest", values.most - values.drop),
        ):
            if abs(getattr(self, limit) - found) > _SAME * values.most:
                msg = (
                    f"{name}: {limit} = {getattr(self, limit):g}, but at {speed} the law gives "
                    f"{found:g}: rename that field, or correct at_speed"
                )
                raise ValueError(msg)
        return values


@lru_cache(maxsize=64)
def _sampled(law: FrictionLaw) -> FrictionValues:
    return sampled(type(law).__name__, law.at_speed)


@final
@dataclass(frozen=True, slots=True)
class CoulombFriction(FrictionLaw):
    """A friction coefficient that does not depend on speed.

    Parameters
    ----------
    coefficient : float
        Friction coefficient mu_d [-], at least 0 and below 1.

    Examples
    --------
    >>> CoulombFriction(0.066).at_speed(0.2)
    0.066
    """

    coefficient: float = field(metadata=_COEFFICIENT)

    def __post_init__(self) -> None:
        check_numbers(self, owner="friction ")

    @property
    def f_max(self) -> float:
        """Friction coefficient at high speed [-]."""
        return float(self.coefficient)

    @property
    def f_min(self) -> float:
        """Friction coefficient at zero speed [-]."""
        return float(self.coefficient)

    @property
    def rate(self) -> float:
        """Rate parameter [s/m]; none."""
        return 0.0

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s]."""
        return float(self.coefficient)

    def scaled(self, factor: float) -> CoulombFriction:
        """Return the law with its coefficient times a factor [-], as at a bound of properties."""
        return CoulombFriction(factor * self.coefficient)

    def kernel_values(self) -> FrictionValues:
        """Return the values for kernels: one coefficient, no table."""
        return FrictionValues(self.f_max, 0.0, 0.0)


@final
@dataclass(frozen=True, slots=True)
class VelocityFriction(FrictionLaw):
    r"""A friction coefficient that grows with the sliding speed.

    .. math:: \mu_d = f_{max} - (f_{max} - f_{min}) e^{-\alpha |v|}

    Source: Eq. (1) of the paper, after Mokha, Constantinou and Reinhorn (1990).

    Parameters
    ----------
    f_max : float
        Friction coefficient at high speed [-], at least `f_min` and below 1.
    f_min : float
        Friction coefficient at zero speed [-], at least 0.
    rate : float
        Rate parameter alpha [s/m], at least 0. It belongs to the sliding speed on one surface.

    Examples
    --------
    >>> VelocityFriction(f_max=0.065, f_min=0.0325, rate=15.0).at_speed(0.0)
    0.0325
    """

    f_max: float = field(metadata=_COEFFICIENT)
    f_min: float = field(metadata=_COEFFICIENT)
    rate: float = field(metadata=number("s/m", "[0, inf)"))

    def __post_init__(self) -> None:
        check_numbers(self)
        if self.f_min > self.f_max:
            msg = (
                f"f_min = {self.f_min:g} exceeds f_max = {self.f_max:g}: the friction at zero "
                "speed must not exceed that at high speed; swap the values"
            )
            raise ValueError(msg)

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s]."""
        return self.f_max - (self.f_max - self.f_min) * exp(-self.rate * abs(speed))

    def scaled(self, factor: float) -> VelocityFriction:
        """Return the law with its coefficients times a factor [-], as at a bound of properties."""
        return VelocityFriction(factor * self.f_max, factor * self.f_min, self.rate)

    def kernel_values(self) -> FrictionValues:
        """Return the values for kernels: the constants of Eq. (1), no table."""
        return FrictionValues(self.f_max, self.f_max - self.f_min, self.rate)


@dataclass(frozen=True)
class MeasuredFriction(FrictionLaw):
    """A friction coefficient by tests: their isotonic fit, smoothed, which never falls.

    Parameters
    ----------
    speeds : sequence of float
        Sliding speeds on one surface [m/s], at least 0, in any order; tests may share one.
    coefficients : sequence of float
        Friction coefficient of each test [-], at least 0 and below 1.

    Raises
    ------
    ValueError
        If there are no points, or one is out of bounds.

    Notes
    -----
    Isotonic regression by least squares (`scipy.optimize.isotonic_regression`), monotone cubic
    between the centres of its blocks, constant below the first and beyond the last one. Kernels
    read its table, and this is the law: `misfit` counts all of it.

    Examples
    --------
    >>> tests = MeasuredFriction([0.01, 0.05, 0.2, 0.4], [0.04, 0.055, 0.07, 0.066])
    >>> round(tests.f_min, 4), round(tests.f_max, 4), round(tests.misfit, 4)
    (0.04, 0.068, 0.0022)
    """

    speeds: tuple[float, ...] = field(metadata=number("m/s", "[0, inf)"))
    coefficients: tuple[float, ...] = field(metadata=_COEFFICIENT)

    def __post_init__(self) -> None:
        for name in ("speeds", "coefficients"):
            given = np.ravel(np.asarray(getattr(self, name), dtype=np.float64)).tolist()
            object.__setattr__(self, name, tuple(given))
        if not len(self.speeds) == len(self.coefficients) > 0:
            msg = (
                f"MeasuredFriction has {len(self.speeds)} speeds and {len(self.coefficients)} "
                "coefficients: pass one speed and one coefficient for each test, and at least "
                "one test"
            )
            raise ValueError(msg)
        check_numbers(self)
        self.kernel_values()  # which refuses a law that cannot be

    @cached_property
    def _values(self) -> FrictionValues:
        curve = never_falling(self.speeds, self.coefficients)
        end = float(curve.x[-1])
        return sampled("MeasuredFriction", lambda speed: float(curve(min(speed, end))), math.inf)

    @property
    def misfit(self) -> float:
        """Root mean square difference between law and tests [-]."""
        pairs = zip(self.speeds, self.coefficients, strict=True)
        return float(np.sqrt(np.mean([(self.at_speed(v) - f) ** 2 for v, f in pairs])))

    def at_speed(self, speed: float) -> float:
        """Return the friction coefficient [-] at sliding speed `speed` [m/s]."""
        return self.kernel_values().at_speed(abs(speed))

    def kernel_values(self) -> FrictionValues:
        """Return the values for kernels: the table that is the law."""
        return self._values


@dataclass(frozen=True, repr=False)
class _Scaled(FrictionLaw):
    """Another law times a factor [-]."""

    law: FrictionLaw
    factor: float

    def __post_init__(self) -> None:
        require_within("f_max", self.f_max, "[0, 1)", "-", remedy="a smaller factor")

    def __repr__(self) -> str:
        return f"{self.factor:g} * {self.law!r}"

    def at_speed(self, speed: float) -> float:
        return self.factor * self.law.at_speed(speed)

    def scaled(self, factor: float) -> FrictionLaw:
        return _Scaled(self.law, factor * self.factor)

    def kernel_values(self) -> FrictionValues:
        return self.law.kernel_values().times(self.factor)


@dataclass(frozen=True)
class _Tabulated(FrictionLaw):
    """A law given by its table alone, for another process that lacks its class."""

    values: FrictionValues

    def at_speed(self, speed: float) -> float:
        return self.values.at_speed(speed)

    def kernel_values(self) -> FrictionValues:
        return self.values


def without_class(law: FrictionLaw) -> FrictionLaw:
    """Return a law that any process of this package can read: its table, if it is another's."""
    own = isinstance(law, (CoulombFriction, VelocityFriction))
    return law if own else _Tabulated(law.kernel_values())


def known_laws() -> tuple[type[FrictionLaw], ...]:
    """Return the classes of all laws, those of this module first."""
    public = [places for name, places in _KNOWN.items() if not name.startswith("_")]
    return tuple(law for places in public for law in places.values() if _is_complete(law))


def _is_complete(law: type) -> bool:
    return is_dataclass(law) and not inspect.isabstract(law)


def least_coefficients(props: Records) -> Floats:
    """Return the friction coefficients at rest of bearings with properties `props` (n,).

    Shapes: result (n, 2).
    """
    return np.asarray(props["friction_max"] - props["friction_drop"])


def as_laws(given: object) -> object:
    """Return friction with numbers as `CoulombFriction`; anything else is left to its check."""
    if isinstance(given, tuple):
        return tuple(as_laws(each) for each in given)
    if isinstance(given, (int, float, np.number)) and not isinstance(given, bool):
        return CoulombFriction(float(given))
    return given
