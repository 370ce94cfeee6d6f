"""Tables of a project's file made from dataclasses: their fields, types, units and defaults."""

from __future__ import annotations

import types
from collections.abc import Iterable
from dataclasses import MISSING, fields, is_dataclass
from difflib import get_close_matches
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import (
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    create_model,
    model_validator,
)

from frames.design.project.quantities import number_or_infinity
from lir_element.device.field_units import FIELD_UNITS

_NUMBER, _PAIR = "[number]", "[pair]"


class Table(BaseModel):
    """A table of the file: no keys but those that it knows."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _no_truth_for_a_number(cls, given: object) -> object:
        for key, value in given.items() if isinstance(given, dict) else ():
            field = cls.model_fields.get(str(key))
            if isinstance(value, bool) and field and "bool" not in str(field.annotation):
                msg = f"{key} = {str(value).lower()} must be a number or a text, not a truth value"
                raise ValueError(msg)
        return given


class DerivedTable(Table):
    """A table whose keys are the fields of a dataclass."""

    made_of: ClassVar[type]

    def made(self) -> Any:
        """Return the dataclass that the table describes; keys that are left out have its defaults.

        Returns
        -------
        object
            Of the class that the table was derived from.

        Raises
        ------
        ValueError, TypeError
            As the class does.
        """
        given = {name: getattr(self, name) for name in self.model_fields_set}
        return self.made_of(**{name: _made(value) for name, value in given.items()})


@cache
def table_of(kind: type) -> type[DerivedTable]:
    """Return the table of a dataclass: a key a field, numbers with the units of `FIELD_UNITS`.

    Parameters
    ----------
    kind : type
        A dataclass of numbers, choices, pairs of them, and other such dataclasses.

    Returns
    -------
    type
        Its table; `DerivedTable.made` returns the dataclass.
    """
    units, hints = FIELD_UNITS.get(kind.__name__, {}), get_type_hints(kind)
    keys: dict[str, Any] = {}
    for each in fields(kind):
        default = ... if each.default is MISSING else each.default
        keys[each.name] = (_kind(hints[each.name], units.get(each.name, "")), Field(default))
    said = f"Arguments of `{kind.__name__}`."
    table = create_model(kind.__name__, __base__=DerivedTable, __doc__=said, **keys)
    table.made_of = kind
    return table


def _made(value: object) -> object:
    if isinstance(value, DerivedTable):
        return value.made()
    return tuple(map(_made, value)) if isinstance(value, tuple) else value


def _kind(annotation: Any, unit: str) -> Any:
    # The type of a key: that of a field, its numbers with units.
    if annotation is float:
        return number_or_infinity(unit)
    if is_dataclass(annotation) and isinstance(annotation, type):
        return table_of(annotation)
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is tuple:
        return tuple[tuple(_kind(part, unit) for part in parts)]  # type: ignore[misc]
    if origin in {Union, types.UnionType}:
        ways = [part for part in parts if part is not type(None)]
        if len(ways) == 1:
            return _kind(ways[0], unit)
        tagged = tuple(Annotated[_kind(way, unit), Tag(_tag(way))] for way in ways)
        return Annotated[Union[tagged], Discriminator(_chosen(ways))]  # noqa: UP007
    if origin is Literal or annotation in {bool, int, str}:
        return annotation
    msg = f"no key of a file can be of the type {annotation}"
    raise AssertionError(msg)


def _tag(way: Any) -> str:
    # Ends with a bracket: messages leave such parts of a place out.
    if is_dataclass(way) and isinstance(way, type):
        return f"[{way.__name__}]"
    return _PAIR if get_origin(way) is tuple else _NUMBER


def _likeness(keys: set[str], given: Iterable[Any]) -> int:
    # How many keys are given, misspelt ones included.
    return sum(bool(get_close_matches(str(key), keys, n=1)) for key in given)


def _chosen(ways: list[Any]) -> Any:
    # Which of several ways a value is given in: by its kind, of tables by their keys.
    tables = {_tag(way): {f.name for f in fields(way)} for way in ways if is_dataclass(way)}
    others = [_tag(way) for way in ways if not is_dataclass(way)]

    def choose(value: object) -> str:
        if isinstance(value, DerivedTable):
            return f"[{value.made_of.__name__}]"
        if isinstance(value, dict) and tables:
            return max(tables, key=lambda tag: _likeness(tables[tag], value))
        if isinstance(value, (list, tuple)) and _PAIR in others:
            return _PAIR
        return _NUMBER if _NUMBER in others else [*others, *tables][0]

    return choose
