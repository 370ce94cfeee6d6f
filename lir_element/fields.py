"""The numbers of a dataclass, each declared once: unit, bounds, remedy, and its name in words.

The metadata of a field define it, ``field(default=0.3, metadata=number("-", "[0, 1)"))``. Input
checks, prints, keys of files and reports read them.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from lir_element.argument_checks import require_within
from lir_element.units import meant

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lir_element.argument_checks import Remedy


def number(
    unit: str = "-",
    within: str = "(-inf, inf)",
    title: str = "",
    *,
    usual: tuple[float, float] | None = None,
    remedy: Remedy = "",
    endless: str = "",
) -> dict[str, Any]:
    """Return the metadata of a field that holds a number, or several of one kind.

    `within` is the interval of its values; `usual` are values in the unit, by which a message finds
    the unit that was meant; `endless` describes an infinite value in words.
    """

    def by_size(value: float) -> str:
        return meant(value, unit, *(usual or (0.0, 0.0)))

    return {
        "unit": unit,
        "within": within,
        "title": title,
        "remedy": by_size if usual else remedy,
        "endless": endless,
    }


def said_of(kind: type, name: str) -> Mapping[str, Any]:
    """Return the metadata of a field of a dataclass; none of other attributes."""
    found = getattr(kind, "__dataclass_fields__", {}).get(name)
    return {} if found is None else found.metadata


def unit_of(kind: type, name: str) -> str:
    """Return the unit of a field of a dataclass, "" of a pure number."""
    unit = str(said_of(kind, name).get("unit", ""))
    return "" if unit == "-" else unit


def check_numbers(
    made: Any,
    *,
    error: type[ValueError] = ValueError,
    places: tuple[str, ...] = (),
    owner: str = "",
) -> None:
    """Refuse numbers of a dataclass that are outside the bounds of their fields.

    None is accepted if it is the default, or one of a pair; `places` names the members of pairs,
    and `owner` begins the names in messages.
    """
    for each in fields(made):
        given, said = getattr(made, each.name), each.metadata
        if "within" not in said or (given is None and each.default is None):
            continue
        for name, value in _numbered(each.name, given, places):
            require_within(
                owner + name,
                value,
                said["within"],
                said["unit"],
                remedy=said["remedy"],
                optional=each.default is None,
                error=error,
            )


def _numbered(name: str, given: Any, places: tuple[str, ...]) -> list[tuple[str, Any]]:
    # The numbers of a field, each with its name: of several with their places.
    if not isinstance(given, (tuple, list)):
        return [(name, given)]
    words = [f"{name} ({at})" for at in places] or [f"{name}[{k}]" for k in range(len(given))]
    found = zip(words, given, strict=False)
    return [pair for at, one in found if one is not None for pair in _numbered(at, one, ())]
