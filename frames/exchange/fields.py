"""Fields of a file: a map of them is applied to read, and inverted to write."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from frames.exchange.tables import known

if TYPE_CHECKING:
    from frames.exchange.building import Building
    from frames.exchange.import_report import ImportReport
    from frames.exchange.tables import Row, Units, Value


class Bound(NamedTuple):
    """Bound of a number: the words of the refusal, and the test."""

    words: str
    holds: Callable[[float], bool]


ANY = Bound("", lambda _: True)
POSITIVE = Bound("must be positive", lambda value: value > 0.0)
NOT_NEGATIVE = Bound("must be 0 or greater", lambda value: value >= 0.0)
SHARE = Bound("must lie in [0, 1]", lambda value: 0.0 <= value <= 1.0)
POISSON = Bound("must lie in (-1, 0.5]", lambda value: -1.0 < value <= 0.5)


class Field(NamedTuple):
    """A number, a text, or a Yes of a file.

    `ours` is its name in a row of a building, `names` are those in the file: the first name is
    written, the others are those of other versions. `unit` is one of `Units`, or "text" or "yes";
    without a `default` the file must have it. A 0 of the file is read as `zero`.
    """

    ours: str
    names: str
    unit: str = "one"
    default: Any = 0.0
    bound: Bound = ANY
    zero: float = 0.0
    said: str = ""  # name of a reference in messages


Fields: TypeAlias = tuple[Field, ...]


def fields(
    pairs: str,
    unit: str = "one",
    default: Any = 0.0,
    bound: Bound = ANY,
    zero: float = 0.0,
    said: str = "",
) -> Fields:
    """Return fields of one kind from pairs "ours=theirs|other"."""
    split = (pair.split("=") for pair in pairs.split())
    return tuple(Field(ours, names, unit, default, bound, zero, said) for ours, names in split)


def factors(ours: str, names: str) -> Fields:
    """Return fields of factors on a stiffness, a mass or a weight by our names and theirs."""
    pairs = zip(ours.split(), names.split(), strict=True)
    return tuple(Field(word, name, default=1.0, bound=NOT_NEGATIVE) for word, name in pairs)


OF_FRAMES = "area shear_2 shear_3 torsion inertia_22 inertia_33 mass weight"
OF_SHELLS = "F11 F22 F12 M11 M22 M12 mass weight"
"""Our names of the factors of frame objects and of shells."""


class Refusal(NamedTuple):
    """A field whose loss would change the answer: its names, the key of `allow`, and its meaning.

    It applies if its text does (`has`, `lacks`, `is_none_of`), or without `when` if it is Yes. "{}"
    in `what` is the text.
    """

    names: str
    key: str
    what: str
    when: Callable[[str], bool] | None = None

    def odd(self, row: Row) -> str | None:
        """Return the text of the field if it matters."""
        for name in filter(row.has, self.names.split("|")):
            text = row.text(name)
            if row.yes(name) if self.when is None else self.when(text):
                return text
        return None


def has(*words: str) -> Callable[[str], bool]:
    """Return whether a text has one of some words in it."""
    return lambda text: any(word in text.lower() for word in words)


def lacks(word: str) -> Callable[[str], bool]:
    """Return whether a text has a word nowhere in it."""
    return lambda text: word not in text.lower()


def is_none_of(*words: str) -> Callable[[str], bool]:
    """Return whether a text is none of some words."""
    return lambda text: text.strip().lower() not in words


def refused(row: Row, name: str, account: ImportReport, refusals: Iterable[Refusal]) -> bool:
    """Refuse an object by its row, or record an exception of `allow`; return True if any."""
    found = False
    for refusal in refusals:
        odd = refusal.odd(row)
        if odd is not None:
            account.refuse(refusal.key, row.table, refusal.what.format(odd), [name], row.place)
            found = True
    return found


def values(
    row: Row,
    map_: Fields,
    building: Building,
    of: str = "",
    *,
    units: Units | None = None,
    prefix: str = "",
    only_given: bool = False,
) -> dict[str, Any]:
    """Return the fields of a row by our names, in SI; values out of bounds are refused.

    Units are those of the building unless others are given.
    """
    scale = units or building.units
    found: dict[str, Any] = {}
    for field in map_:
        names = _names(field.names, prefix)
        given = [name for name in names if row.has(name)]
        if only_given and not given:
            continue
        name = given[0] if given else names[0]
        factor = getattr(scale, field.unit, None)
        if field.unit == "yes":
            found[field.ours] = row.yes(name, default=field.default)
        elif factor is not None:
            value = row.number(name, field.default)
            if not field.bound.holds(value):
                message = f"{name} = {value:g}{of} {field.bound.words}"
                raise row.error(message, name)
            found[field.ours] = value * factor or field.zero
        else:
            text = found[field.ours] = row.text(name, field.default)
            if field.unit != "text":
                known(row, field.said or name, text, getattr(building, field.unit), of)
    return found


@cache
def _names(names: str, prefix: str) -> tuple[str, ...]:
    return tuple(f"{prefix}{name}" for name in names.split("|"))


def written(map_: Fields, given: object, units: Units) -> dict[str, Value]:
    """Return the fields of a row of a building, or of as many numbers, in the file's format."""
    if isinstance(given, dict):
        pairs: Iterable[tuple[Field, Any]] = ((f, given[f.ours]) for f in map_ if f.ours in given)
    elif isinstance(given, Sequence):
        pairs = zip(map_, given, strict=True)
    else:
        pairs = ((field, getattr(given, field.ours)) for field in map_)
    return {field.names.split("|")[0]: _written(field, value, units) for field, value in pairs}


def _written(field: Field, value: Any, units: Units) -> Value:
    if field.unit == "yes":
        return bool(value)
    if not hasattr(units, field.unit):
        return str(value)
    return 0.0 if value == field.zero else float(value) / getattr(units, field.unit)
