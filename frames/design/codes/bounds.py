"""Bounds of the friction of bearings: property modification factors, and what they are put on."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, TypeVar

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from frames.design.codes.isolation import IsolationSystem
from frames.design.codes.pendulum import FrictionPendulum
from frames.frame import Frame
from lir_element import LIRBearing
from lir_element.argument_checks import (
    require_choice,
    require_non_negative,
    require_type,
    require_within,
)
from lir_element.texts import worded

if TYPE_CHECKING:
    Range = tuple[float, float]
    """A lower and an upper factor [-]."""

BoundName = Literal["lower", "nominal", "upper"]
Bounded = TypeVar("Bounded", LIRBearing, FrictionPendulum, IsolationSystem, Frame)
Device = TypeVar("Device", bound=LIRBearing)
Pendulum = TypeVar("Pendulum", bound=FrictionPendulum)
ENDS: tuple[BoundName, BoundName] = ("lower", "upper")
"""Bounds that a design is made with."""
_BOUNDS = ("lower", "nominal", "upper")
_AS_IT_IS = (1.0, 1.0)
_IMPORTANCE = {"I": 0.60, "II": 0.70, "III": 0.90}


@dataclass(frozen=True)
class PropertyModificationFactors:
    """Factors of one property of bearings, at its lower and upper bound.

    Parameters
    ----------
    lower, upper : float
        Factors on the nominal value [-]: 0 < lower <= 1 <= upper.
    trace : Trace
        The calculation they come from.

    Raises
    ------
    CheckError
        If the factors are not around 1.

    Examples
    --------
    >>> factors = PropertyModificationFactors.asce7(
    ...     ageing=(1.0, 1.56), test=(0.9, 1.3), spec=(0.85, 1.15)
    ... )
    >>> factors.lower, round(factors.upper, 4)
    (0.6, 2.1229)
    """

    lower: float
    upper: float
    trace: Trace = field(default_factory=Trace, compare=False, repr=False)

    def __post_init__(self) -> None:
        require_around_one("properties", (self.lower, self.upper))

    @classmethod
    def asce7(
        cls,
        *,
        ageing: Range = _AS_IT_IS,
        contamination: Range = _AS_IT_IS,
        test: Range = _AS_IT_IS,
        spec: Range = _AS_IT_IS,
        full_scale_tests: bool = False,
        adjustment: float = 0.75,
        floor: float = 1.8,
        cap: float = 0.60,
    ) -> PropertyModificationFactors:
        """Return the factors of ASCE 7-22, 17.2.8.4 (clause to be confirmed).

        Parameters
        ----------
        ageing, contamination : tuple of two floats
            Lower and upper factor of ageing, and of environment (contamination, wear); their
            product is lambda_ae.
        test : tuple of two floats
            Of heating, rate of loading and cycling, from prototype tests.
        spec : tuple of two floats
            Of what the specification allows the production to deviate.
        full_scale_tests : bool
            Whether dynamic tests of full-scale prototypes justify less than floor and cap.
        adjustment : float
            Share of lambda_ae that counts, all effects not being at their worst at once.
        floor, cap : float
            Least upper, and largest lower factor without such tests.

        Returns
        -------
        PropertyModificationFactors
            The factors, with their calculation.
        """
        t = Trace()
        words = {"aging": ageing, "env": contamination, "test": test, "spec": spec}
        for name, pair in words.items():
            _enter(t, name, pair)
        t.given("a", adjustment, note="property adjustment factor")
        t("lambda_ae_max", "lambda_aging_max * lambda_env_max")
        t("lambda_ae_min", "lambda_aging_min * lambda_env_min")
        upper = "(1 + a * (lambda_ae_max - 1)) * lambda_test_max * lambda_spec_max"
        lower = "(1 - a * (1 - lambda_ae_min)) * lambda_test_min * lambda_spec_min"
        source = "ASCE 7-22 (17.2-1)", "ASCE 7-22 (17.2-2)"
        if full_scale_tests:
            note = "floor and cap waived: dynamic tests of full-scale prototypes"
            t("lambda_max", upper, source=source[0], note=note)
            t("lambda_min", lower, source=source[1], note=note)
        else:
            t.given("floor", floor)
            t.given("cap", cap)
            t("lambda_max", f"max({upper}, floor)", source=source[0])
            t("lambda_min", f"min({lower}, cap)", source=source[1])
        return cls(t.value("lambda_min"), t.value("lambda_max"), t)

    @classmethod
    def en1998(
        cls,
        *,
        ageing: float = 1.0,
        temperature: float = 1.0,
        contamination: float = 1.0,
        wear: float = 1.0,
        spec: Range = _AS_IT_IS,
        importance: Literal["I", "II", "III"] = "II",
        psi: float | None = None,
    ) -> PropertyModificationFactors:
        """Return the factors of EN 1998-2, Annexes J and JJ (clauses to be confirmed).

        Parameters
        ----------
        ageing, temperature, contamination, wear : float
            Largest factors lambda_max,fi of friction [-], at least 1.
        spec : tuple of two floats
            Range of the tested and specified values about the nominal one.
        importance : {"I", "II", "III"}
            Importance class: combination factor psi of 0.60, 0.70 and 0.90.
        psi : float, optional
            Combination factor instead of that.

        Returns
        -------
        PropertyModificationFactors
            The factors: those of ageing and environment only raise friction, the lower bound is
            that of the tests.
        """
        require_choice("importance", importance, tuple(_IMPORTANCE), error=CheckError)
        t = Trace()
        source = "EN 1998-2 Annex J"
        chosen = _IMPORTANCE[importance] if psi is None else psi
        t.given("psi_f", require_non_negative("psi", chosen, "-", error=CheckError), source=source)
        _enter(t, "spec", spec)
        given = {"f1": ageing, "f2": temperature, "f3": contamination, "f4": wear}
        for name, value in given.items():
            _enter(t, name, (1.0, value))
            t(f"lambda_U_{name}", f"1 + (lambda_{name}_max - 1) * psi_f", source=source)
        product = " * ".join(f"lambda_U_{name}" for name in given)
        t("lambda_max", f"lambda_spec_max * {product}", source=source)
        t("lambda_min", "lambda_spec_min * 1", source=source)
        return cls(t.value("lambda_min"), t.value("lambda_max"), t)

    def at(self, bound: BoundName) -> float:
        """Return the factor at a bound, 1 at "nominal"."""
        require_choice("bound", bound, _BOUNDS, error=CheckError)
        return {"lower": self.lower, "nominal": 1.0, "upper": self.upper}[bound]


@dataclass(frozen=True)
class PropertyBounds:
    """What bounds the friction of bearings.

    Parameters
    ----------
    friction : PropertyModificationFactors
        Of the low friction of both concave surfaces.
    interface : PropertyModificationFactors, optional
        Of the friction mu_h of the interface between the sliders: its upper bound decides what
        force a rim passes, its lower one when the interface slides. Default: those of `friction`.

    Examples
    --------
    >>> from frames.design import PropertyModificationFactors
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.8, 1.3))
    >>> bounds.interface_factors.upper  # those of the surfaces, where none are given
    1.3
    """

    friction: PropertyModificationFactors
    interface: PropertyModificationFactors | None = None

    @property
    def interface_factors(self) -> PropertyModificationFactors:
        """Factors of the interface friction."""
        return self.interface or self.friction


def with_property_bounds(
    what: Bounded,
    bound: BoundName,
    bounds: PropertyBounds,
    *,
    interface: BoundName | None = None,
) -> Bounded:
    """Return a bearing, a frame or an isolation system with friction at a bound.

    Parameters
    ----------
    what : LIRBearing, FrictionPendulum, Frame or IsolationSystem
        What has nominal friction; of a frame or system all bearings are taken.
    bound : {"lower", "nominal", "upper"}
        The bound.
    bounds : PropertyBounds
        The factors.
    interface : {"lower", "nominal", "upper"}, optional
        Bound of the interface friction, where another than that of the surfaces is wanted.

    Returns
    -------
    LIRBearing, FrictionPendulum, Frame or IsolationSystem
        A copy; a frame's name gets the bound.

    Raises
    ------
    CheckError
        If a word is no bound, or a bearing cannot be at it: friction of 1 and more, an interface
        that slides before the surfaces do.

    Examples
    --------
    >>> from lir_element import CoulombFriction
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.05), interface_friction=0.15)
    >>> bounds = PropertyBounds(PropertyModificationFactors(0.6, 1.8))
    >>> upper = with_property_bounds(bearing, "upper", bounds)
    >>> round(upper.frictions[0].f_max, 4), round(upper.interface_friction, 4)
    (0.09, 0.27)
    """
    require_type("bounds", bounds, PropertyBounds, "PropertyBounds")
    factor = bounds.friction.at(bound)
    inner = bounds.interface_factors.at(bound if interface is None else interface)
    try:
        return _with_factors(what, factor, inner, bound)
    except ValueError as cause:
        msg = (
            f"at the {bound} bound, friction times {factor:g} and interface friction times "
            f"{inner:g}: {cause}; or give narrower factors (`bounds`)"
        )
        raise CheckError(msg) from cause


def _with_factors(what: Bounded, factor: float, inner: float, bound: str) -> Bounded:
    if isinstance(what, LIRBearing):
        return _bearing(what, factor, inner)
    if isinstance(what, FrictionPendulum):
        return _pendulum(what, factor)
    if isinstance(what, IsolationSystem):
        found = (
            _bearing(b, factor, inner) if isinstance(b, LIRBearing) else _pendulum(b, factor)
            for b in what.bearings
        )
        return replace(what, bearings=tuple(found))
    require_type("what", what, Frame, "an LIRBearing, a Frame or an IsolationSystem")
    links = what.bearings.items()
    devices = {name: _bearing(link.bearing, factor, inner) for name, link in links}
    return what.with_bearings(devices, worded("{name}, {bound} bound", name=what.name, bound=bound))


def _bearing(bearing: Device, factor: float, inner: float) -> Device:
    bottom, top = bearing.frictions
    laws = (bottom.scaled(factor), top.scaled(factor))
    return replace(bearing, friction=laws, interface_friction=inner * bearing.interface_friction)


def _pendulum(pendulum: Pendulum, factor: float) -> Pendulum:
    return replace(pendulum, frictions=tuple(factor * mu for mu in pendulum.frictions))


def _enter(t: Trace, name: str, pair: Range) -> None:
    low, high = require_around_one(name, pair)
    t.given(f"lambda_{name}_min", low)
    t.given(f"lambda_{name}_max", high)


def require_around_one(name: str, pair: Range) -> Range:
    """Return a lower and an upper factor [-] if 1 is between them, or raise."""
    how = "give the lower at most 1, the upper at least 1"
    ends = zip(("lower", "upper"), pair, ("(0, 1]", "[1, inf)"), strict=True)
    low, high = (
        require_within(f"{end} factor of {name}", factor, within, remedy=how, error=CheckError)
        for end, factor, within in ends
    )
    return low, high
