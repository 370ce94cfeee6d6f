"""Factors on friction put together of their sources, as each code does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.design._errors import CheckError
from frames.design.calculation.trace import Trace
from frames.design.codes.bounds import PropertyModificationFactors, require_around_one

if TYPE_CHECKING:
    Range = tuple[float, float]
    """A lower and an upper factor [-]."""

_AS_IT_IS = (1.0, 1.0)
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

    Nothing is taken off for effects that are not at their worst at once, which is on the safe side.

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
                f"{source} = [{low:g}, {high:g}]: EN 1998-2 annex JJ has factors that raise "
                f"friction, give [1, {high:g}]; what lowers it belongs into specification"
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
        msg = f"{odd[0]} is no source of factors of this code: it has {', '.join(known)}"
        raise CheckError(msg)
