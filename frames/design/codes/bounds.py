"""Bounds of the friction of bearings: factors of their properties, put together by each code."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from lir_element.argument_checks import require_choice, require_non_negative, require_within

if TYPE_CHECKING:
    Range = tuple[float, float]
    """A lower and an upper factor [-]."""


BoundName = Literal["lower", "nominal", "upper"]
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
        """Return the factors [-] of ASCE 7-22, 17.2.8.4 (clause to be confirmed).

        Parameters
        ----------
        ageing, contamination : tuple of two floats
            Lower and upper factor of ageing, and of environment (contamination, wear); their
            product is lambda_ae.
        test : tuple of two floats
            Factors of heating, rate of loading and cycling, from prototype tests.
        spec : tuple of two floats
            Tolerance of production in the specification.
        full_scale_tests : bool
            True if dynamic tests of full-scale prototypes justify less than floor and cap.
        adjustment : float
            Share of lambda_ae that counts, all effects not being at their worst at once.
        floor, cap : float
            Least upper, and largest lower factor without full-scale tests.

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
    """Bounds of the friction of bearings, as factors.

    Parameters
    ----------
    friction : PropertyModificationFactors
        Factors of the low friction of both concave surfaces.
    interface : PropertyModificationFactors, optional
        Factors of the friction mu_h of the interface between the sliders. Its upper bound limits
        the rim force; its lower bound decides when the interface slides. Default: those of
        `friction`.

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


_SYMBOLS = {
    "ageing": "age",
    "contamination": "cont",
    "temperature": "temp",
    "wear": "wear",
    "test": "test",
    "specification": "spec",
}


def factors_by_source(**given: Any) -> PropertyModificationFactors:
    """Return the product of factors by source: a code without a rule of its own.

    There is no reduction for effects that are not at their worst at once, which is on the safe
    side.

    Parameters
    ----------
    **given
        Lower and upper factor [-] of ageing, contamination, temperature, wear, test (heating, rate
        and cycling, by prototype tests), and specification.

    Returns
    -------
    PropertyModificationFactors
        The products, with their calculation.

    Raises
    ------
    CheckError
        If a factor is out of bounds, or a key belongs to the rule of another code.
    """
    _refuse_others(given, tuple(_SYMBOLS))
    t, names = Trace(), []
    for source, (low, high) in given.items():
        require_around_one(source, (low, high))
        name = _SYMBOLS[source]
        t.given(f"lambda_{name}_min", low, note=source)
        t.given(f"lambda_{name}_max", high, note=source)
        names.append(name)
    for end in ("max", "min"):
        formula = " * ".join(f"lambda_{name}_{end}" for name in names) or "1"
        t(f"lambda_{end}", f"{formula} * 1" if len(names) == 1 else formula, note="no reduction")
    return PropertyModificationFactors(t.value("lambda_min"), t.value("lambda_max"), t)


def factors_of_asce7(
    *,
    ageing: Range = _AS_IT_IS,
    contamination: Range = _AS_IT_IS,
    test: Range = _AS_IT_IS,
    specification: Range = _AS_IT_IS,
    full_scale_tests: bool = False,
    **others: Any,
) -> PropertyModificationFactors:
    """Return the factors of ASCE 7-22, 17.2.8.4, of their sources."""
    _refuse_others(others, ("ageing", "contamination", "test", "specification", "full_scale_tests"))
    return PropertyModificationFactors.asce7(
        ageing=ageing,
        contamination=contamination,
        test=test,
        spec=specification,
        full_scale_tests=full_scale_tests,
    )


def factors_of_en1998(
    *,
    ageing: Range = _AS_IT_IS,
    temperature: Range = _AS_IT_IS,
    contamination: Range = _AS_IT_IS,
    wear: Range = _AS_IT_IS,
    specification: Range = _AS_IT_IS,
    importance_class: str = "II",
    **others: Any,
) -> PropertyModificationFactors:
    """Return the factors of EN 1998-2, annexes J and JJ, of their sources."""
    raising = {
        "ageing": ageing,
        "temperature": temperature,
        "contamination": contamination,
        "wear": wear,
    }
    _refuse_others(others, (*raising, "specification", "importance_class"))
    for source, (low, high) in raising.items():
        require_around_one(source, (low, high))
        if low < 1.0:
            msg = (
                f"{source} = [{low:g}, {high:g}]: the factors of EN 1998-2 annex JJ only "
                f"raise friction: give [1, {high:g}], and put reductions into specification"
            )
            raise CheckError(msg)
    return PropertyModificationFactors.en1998(
        **{source: high for source, (_, high) in raising.items()},
        spec=specification,
        importance=importance_class,  # type: ignore[arg-type]  # checked there
    )


def _refuse_others(given: dict[str, Any], known: tuple[str, ...]) -> None:
    odd = [name for name in given if name not in known]
    if odd:
        msg = f"{odd[0]} is not a source of factors in this code: choose one of {', '.join(known)}"
        raise CheckError(msg)
