"""Fields of a file by what they are in a building: a map is applied to read, inverted to write."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from frames.exchange.tables import Row, Value
    from frames.exchange.units import Units


class Bound(NamedTuple):
    """What a number must be: the words of the refusal, and whether a number is that."""

    words: str
    holds: Callable[[float], bool]


ANY = Bound("", lambda _: True)
POSITIVE = Bound("must be positive", lambda value: value > 0.0)
NOT_NEGATIVE = Bound("must be 0 or greater", lambda value: value >= 0.0)
SHARE = Bound("must lie in [0, 1]", lambda value: 0.0 <= value <= 1.0)
POISSON = Bound("must lie in (-1, 0.5]", lambda value: -1.0 < value <= 0.5)


class Field(NamedTuple):
    """A number of a file.

    `ours` is what it is called in a row of a building, `names` what the file calls it: the first
    name is written, the others are those of other versions. `unit` is one of `Units`; without a
    `default` the file must have it.
    """

    ours: str
    names: str
    unit: str = "one"
    default: float | None = 0.0
    bound: Bound = ANY


Fields: TypeAlias = tuple[Field, ...]


class SectionMap(NamedTuple):
    """Fields of a cross-section: its constants, its sizes, and the factors on them."""

    constants: Fields
    sizes: Fields
    modifiers: Fields


def fields(
    pairs: str, unit: str = "one", default: float | None = 0.0, bound: Bound = ANY
) -> Fields:
    """Return fields of one kind from pairs "ours=theirs|other"."""
    split = (pair.split("=") for pair in pairs.split())
    return tuple(Field(ours, names, unit, default, bound) for ours, names in split)


def numbers(
    row: Row,
    map_: Fields,
    units: Units,
    of: str = "",
    *,
    prefix: str = "",
    only_given: bool = False,
) -> dict[str, Any]:
    """Return the numbers of a row by our names, in SI; a number out of its bound is refused."""
    found: dict[str, Any] = {}
    for field in map_:
        names = [f"{prefix}{name}" for name in field.names.split("|")]
        given = [name for name in names if row.has(name)]
        if only_given and not given:
            continue
        name = given[0] if given else names[0]
        value = row.number(name, field.default)
        if not field.bound.holds(value):
            message = f"{name} = {value:g}{of} {field.bound.words}"
            raise row.error(message, name)
        found[field.ours] = value * getattr(units, field.unit)
    return found


def written(map_: Fields, given: object, units: Units) -> dict[str, Value]:
    """Return the fields of a row of a building, or of as many numbers, as a file has them."""
    if isinstance(given, dict):
        pairs: Iterable[tuple[Field, float]] = ((f, given[f.ours]) for f in map_ if f.ours in given)
    elif isinstance(given, Sequence):
        pairs = zip(map_, given, strict=True)
    else:
        pairs = ((field, getattr(given, field.ours)) for field in map_)
    return {f.names.split("|")[0]: value / getattr(units, f.unit) for f, value in pairs}
