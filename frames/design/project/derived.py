"""Tables of a project's file made from dataclasses: their fields, types, units and defaults."""

from __future__ import annotations

import math
import types
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import (
    Annotated,
    Any,
    ClassVar,
    Literal,
    Self,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    PrivateAttr,
    Tag,
    create_model,
    model_validator,
)

from frames.design.project.quantities import (
    NotNegative,
    Positive,
    number_or_infinity,
    quantity,
)
from lir_element.argument_checks import interval
from lir_element.device.friction import CoulombFriction, FrictionLaw, VelocityFriction, known_laws
from lir_element.fields import said_of, unit_of

_NUMBER, _PAIR = "[number]", "[pair]"

LAW = "law"
"""Key that names the class of a friction law."""

_BY_KEYS = CoulombFriction, VelocityFriction
"""Laws that are recognised by their keys alone if none is named."""


class _NoKeyError(TypeError):
    """A field without a possible key in a file."""


class Table(BaseModel):
    """A table of the file, without unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _no_truth_for_a_number(cls, given: object) -> object:
        for key, value in given.items() if isinstance(given, dict) else ():
            field = cls.model_fields.get(str(key))
            if isinstance(value, bool) and field and "bool" not in str(field.annotation):
                msg = (
                    f"{key} = {str(value).lower()} must be a number or a text: write it without "
                    "true or false"
                )
                raise ValueError(msg)
        return given


class WholeFile(Table):
    """A whole file, with the bytes of it and of those that it is based on."""

    _read: dict[Path, bytes] = PrivateAttr(default_factory=dict)

    @property
    def source_path(self) -> Path | None:
        """Path of the file, None if it was made in Python."""
        return next(iter(self._read), None)

    @property
    def sources(self) -> Mapping[Path, bytes]:
        """Content of the file, and of those that it is based on."""
        return self._read

    @property
    def source(self) -> bytes:
        """All that was read: the file, then those that it is based on after their names."""
        first, *others = self._read.items() or [(Path(), b"")]
        return first[1] + b"".join(f"\n# {p.name}\n".encode() + each for p, each in others)

    def read_from(self, read: dict[Path, bytes]) -> Self:
        """Return the file with the paths and contents that it was read from."""
        self._read = read
        return self


class DerivedTable(Table):
    """A table whose keys are the fields of a dataclass."""

    made_of: ClassVar[type]
    beside: ClassVar[frozenset[str]] = frozenset()
    """Keys that are no argument of the dataclass."""

    def made(self, **others: object) -> Any:
        """Return the dataclass that the table describes; omitted keys count as in `others`."""
        names = self.model_fields_set - {LAW} - self.beside
        return self.made_of(**others | {name: _made(getattr(self, name)) for name in names})


def table_of(kind: type, *names: str) -> type[DerivedTable]:
    """Return the table of a dataclass: a key a field, numbers with the units of its fields.

    If only some fields are named, the file checks their bounds, because the object has further
    fields. A field whose default is made by a factory has no key. All friction laws registered now
    (`known_laws`) are accepted: ``law = "..."`` names the class.
    """
    return _table_of(kind, tuple(law for law in known_laws() if _fits_a_file(law)), names)


def key_of(kind: type, name: str) -> Any:
    """Return the type of a key that is a number of a dataclass: with its unit and its bounds."""
    within = interval(said_of(kind, name)["within"])
    bounds: list[Any] = []
    if not within.low:
        bounds.append(Positive if within.open_below else NotNegative)
    elif math.isfinite(within.low):
        bounds.append(Field(gt=within.low) if within.open_below else Field(ge=within.low))
    if math.isfinite(within.high):
        bounds.append(Field(lt=within.high) if within.open_above else Field(le=within.high))
    unit = unit_of(kind, name)
    return Annotated[quantity(unit, "1.0" if not unit and within.holds(1.0) else ""), *bounds]


def _fits_a_file(law: type[FrictionLaw]) -> bool:
    # True if all fields of a law can be written in a file.
    try:
        _table_of(law, ())
    except (_NoKeyError, NameError):
        return False
    return True


@cache
def _table_of(
    kind: type, laws: tuple[type[FrictionLaw], ...], names: tuple[str, ...] = ()
) -> type[DerivedTable]:
    hints = get_type_hints(kind)
    keys: dict[str, Any] = {}
    for each in fields(kind):
        if each.default_factory is not MISSING or (names and each.name not in names):
            continue
        default = ... if each.default is MISSING else each.default
        endless = isinstance(default, float) and math.isinf(default)
        held = _kind(hints[each.name], unit_of(kind, each.name), laws)
        key = Field(default, json_schema_extra=_without_default if endless else None)
        keys[each.name] = (key_of(kind, each.name) if names else held, key)
    if issubclass(kind, FrictionLaw):
        if LAW in keys:
            msg = (
                f'{kind.__name__}: its field "{LAW}" is reserved for the name of the law: rename it'
            )
            raise _NoKeyError(msg)
        known = kind in _BY_KEYS
        keys[LAW] = (Literal[kind.__name__], Field(kind.__name__ if known else ...))
    said = f"Arguments of `{kind.__name__}`."
    table = create_model(kind.__name__, __base__=DerivedTable, __doc__=said, **keys)
    table.made_of = kind
    return table


def _without_default(schema: dict[str, Any]) -> None:
    # JSON has no infinity.
    schema.pop("default", None)


def _made(value: object) -> object:
    if isinstance(value, DerivedTable):
        return value.made()
    return tuple(map(_made, value)) if isinstance(value, tuple) else value


def _kind(annotation: Any, unit: str, laws: tuple[type[FrictionLaw], ...]) -> Any:
    # The type of a key: that of a field, its numbers with units.
    if annotation is float:
        return number_or_infinity(unit)
    if is_dataclass(annotation) and isinstance(annotation, type):
        return _table_of(annotation, laws)
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin in {tuple, Sequence}:
        if origin is Sequence or parts[1:] == (...,):
            return tuple[_kind(parts[0], unit, laws), ...]  # type: ignore[misc]
        return tuple[tuple(_kind(part, unit, laws) for part in parts)]  # type: ignore[misc]
    if origin in {Union, types.UnionType}:
        ways = [part for part in parts if part is not type(None)]
        if FrictionLaw in ways:
            twice = _given_twice(laws)
            one_of_its_name = [law for law in laws if law.__name__ not in twice]
            ways = [*one_of_its_name, *(way for way in ways if way is not FrictionLaw)]
        if len(ways) == 1:
            return _kind(ways[0], unit, laws)
        tagged = tuple(Annotated[_kind(way, unit, laws), Tag(_tag(way))] for way in ways)
        return Annotated[Union[tagged], _discriminator(ways, laws)]  # noqa: UP007
    if origin is Literal or annotation in {bool, int, str}:
        return annotation
    msg = f"no key of a file can be of the type {annotation}"
    raise _NoKeyError(msg)


def _tag(way: Any) -> str:
    # Ends with a bracket: messages leave these parts of a place out.
    if is_dataclass(way) and isinstance(way, type):
        return f"[{way.__name__}]"
    return _PAIR if get_origin(way) is tuple else _NUMBER


def _likeness(keys: set[str], given: Iterable[Any]) -> int:
    # Number of given keys, misspelt ones included.
    return sum(bool(get_close_matches(str(key), keys, n=1)) for key in given)


def _given_twice(laws: tuple[type[FrictionLaw], ...]) -> list[str]:
    counts = Counter(law.__name__ for law in laws)
    return [name for name, count in counts.items() if count > 1]


def _is_law(way: Any) -> bool:
    return isinstance(way, type) and issubclass(way, FrictionLaw)


def _discriminator(ways: list[Any], laws: tuple[type[FrictionLaw], ...]) -> Discriminator:
    named = [f'"{way.__name__}"' for way in ways if _is_law(way)]
    if not named:
        return Discriminator(_chosen(ways))
    said = f"its law is not known: choose one of {', '.join(named)}, or add its Python file to "
    said += "extensions"
    for name in _given_twice(laws):
        places = [law.__module__ for law in laws if law.__name__ == name]
        said += f"; {name} is written in {' and in '.join(places)}: rename one of them"
    return Discriminator(_chosen(ways), custom_error_type="unknown_law", custom_error_message=said)


def _chosen(ways: list[Any]) -> Any:
    # Alternative in which a value is given: by its kind, or for tables by their keys.
    tables = {
        _tag(way): {f.name for f in fields(way)}
        for way in ways
        if is_dataclass(way) and (way in _BY_KEYS or not _is_law(way))
    }
    others = [_tag(way) for way in ways if not is_dataclass(way)]

    def choose(value: object) -> str:
        if isinstance(value, DerivedTable):
            return f"[{value.made_of.__name__}]"
        if isinstance(value, dict) and LAW in value:
            return f"[{value[LAW]}]"
        if isinstance(value, dict) and tables:
            return max(tables, key=lambda tag: _likeness(tables[tag], value))
        if isinstance(value, (list, tuple)) and _PAIR in others:
            return _PAIR
        return _NUMBER if _NUMBER in others else [*others, *tables][0]

    return choose
