"""Numbers with their units in a project's file, as SI numbers: '175 mm', '150 kN', '5 %'."""

from __future__ import annotations

import math
import re
from functools import cache
from tokenize import TokenError
from typing import Annotated, Any

import pint
from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_POWER = re.compile(r"(?<=[A-Za-z])(\d)")  # m2 for m^2


_LEAST_IN_MM = 20.0  # a smaller length without a unit was probably meant in m
_LARGEST_IN_G = 2.0  # a smaller acceleration without a unit was probably meant in g


EXAMPLES = {
    "m": "175 mm",
    "N": "150 kN",
    "N/m": "400 kN/mm",
    "N s/m": "50 kN s/m",
    "kg": "40 kg",
    "kg m2": "0.5 kg m2",
    "kg/m3": "7850 kg/m3",
    "s/m": "100 s/m",
    "m/s": "360 m/s",
    "Pa": "20 MPa",
    "1/Pa": "0.0071 1/MPa",
    "W/(m K)": "18 W/(m K)",
    "m2/s": "4.44 mm2/s",
    "C": "20 C",
    "s": "5 ms",
    "m/s2": "3.5 m/s2",
    "kg/m2": "1450 kg/m2",
    "m2": "150 cm2",
    "m4": "25000 cm4",
    "N/m2": "4.5 kN/m2",
    "": "0.05",
}
"""Notation of numbers of each unit, for messages and the schema."""


_PER_AREA = {
    "psf": ("lbf/ft^2", "lb/ft^2"),
    "ksf": ("kip/ft^2", "klb/ft^2"),
    "plf": ("lbf/ft", "lb/ft"),
    "klf": ("kip/ft", "klb/ft"),
    "pli": ("lbf/inch", "lb/inch"),
    "pcf": ("lbf/ft^3", "lb/ft^3"),
    "kcf": ("kip/ft^3", "klb/ft^3"),
    "pci": ("lbf/inch^3", "lb/inch^3"),
    "kci": ("kip/inch^3", "klb/inch^3"),
}
"""Units of US practice that pint does not have: as forces, and as masses."""

_UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    RecursionError,
    SyntaxError,
    TokenError,
    TypeError,
    ValueError,
    pint.PintError,
)
"""Errors of pint for a text that is no unit."""

_COMMA = re.compile(r"\s*([-+]?\d*),(\d+)\s*(.*?)\s*")


@cache
def _units() -> pint.UnitRegistry[float]:
    return pint.UnitRegistry()


def si(value: object, unit: str, example: str) -> float:
    """Return a number with its unit in SI.

    Examples
    --------
    >>> si("175 mm", "m", "175 mm"), si("5 %", "", "0.05")
    (0.175, 0.05)
    """
    unit = unit.replace("^", "")
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if unit:
            msg = f"has no unit: {_written(value, unit, example)}"
            raise ValueError(msg)
        return _finite(float(value))
    comma = _COMMA.fullmatch(value) if isinstance(value, str) else None
    if comma:
        written = f"{comma[1]}.{comma[2]} {comma[3]}".strip()
        msg = f'has a comma: write "{written}" for decimals, no sign for thousands'
        raise ValueError(msg)
    found = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        msg = f"is not a number{' with a unit' if unit else ''}: {_neutral(unit, example)}"
        raise ValueError(msg)
    number, given = float(found[1]), _POWER.sub(r"^\1", found[2])
    if unit and not given:
        msg = f"has no unit: {_written(number, unit, example)}"
        raise ValueError(msg)
    if unit == "m/s2" and given in {"g", "G"}:  # elsewhere the gram
        given = "standard_gravity"
    if unit == "C":
        return _finite(_celsius(number, given, example))
    wanted = _POWER.sub(r"^\1", unit) or "dimensionless"
    try:
        one = _units().Quantity(1.0, _as_pint(given, wanted) or "dimensionless")
        factor = one.to(wanted)
    except pint.UndefinedUnitError as cause:
        remedy = _written(number, unit, example) if unit else _neutral(unit, example)
        msg = f'has an unknown unit "{found[2]}": {remedy}'
        raise ValueError(msg) from cause
    except pint.DimensionalityError as cause:
        kind = unit or "a pure number"
        msg = f'is in "{found[2]}", not a unit of {kind}: {_neutral(unit, example)}'
        raise ValueError(msg) from cause
    except _UNREADABLE as cause:
        msg = f'has "{found[2]}" in place of a unit: {_neutral(unit, example)}'
        raise ValueError(msg) from cause
    return _finite(float(f"{number * factor.magnitude:.15g}"))


def _as_pint(given: str, wanted: str) -> str:
    # psf and its like by the units that pint has: of a force, or of a mass if one is wanted.
    if given not in _PER_AREA:
        return given
    force, mass = _PER_AREA[given]
    return force if _units().is_compatible_with(force, wanted) else mass


def _celsius(number: float, given: str, example: str) -> float:
    # A temperature, whose scales begin at different places.
    scale = {"C": "degC", "F": "degF"}.get(given.removeprefix("°"), given)
    try:
        return float(_units().Quantity(number, scale).to("degC").magnitude)
    except (pint.UndefinedUnitError, pint.DimensionalityError, *_UNREADABLE) as cause:
        msg = f'is in "{given}", not a unit of temperature: {_neutral("C", example)}'
        raise ValueError(msg) from cause


def _neutral(unit: str, example: str) -> str:
    # A remedy without a number, which would be of another size than the one that is meant.
    return f"write a number in {example.split(maxsplit=1)[1]}" if unit else "write a pure number"


def _written(value: float, unit: str, example: str) -> str:
    # A number with its unit; of lengths that are too short for mm, m; of accelerations below 2, g.
    if unit == "m" and abs(value) < _LEAST_IN_MM:
        return f'write "{value:g} m" or "{1e3 * value:g} mm" if that is meant'
    if unit == "m/s2" and abs(value) < _LARGEST_IN_G:
        return f'write "{value:g} g" or "{value:g} m/s2" if that is meant'
    return f'write "{value:g} {example.split(maxsplit=1)[1]}" if that is meant'


def _finite(number: float) -> float:
    if not math.isfinite(number):
        msg = "is not finite: write a number"
        raise ValueError(msg)
    return number


def _kind(unit: str, example: str) -> tuple[BeforeValidator, WithJsonSchema]:
    schema = {"type": ["string"] if unit else ["number", "string"], "examples": [example]}
    return BeforeValidator(lambda value: si(value, unit, example)), WithJsonSchema(schema)


def number_or_infinity(unit: str) -> Any:
    """Return the type of a number with a unit that may be ``inf``, as of a bearing without rims."""
    example = EXAMPLES.get(unit, f"1 {unit}")

    def read(value: object) -> float:
        infinite = isinstance(value, float) and math.isinf(value)
        return float(str(value)) if infinite else si(value, unit, example)

    schema = {"type": ["string", "number"], "examples": [example]}
    return Annotated[float, BeforeValidator(read), WithJsonSchema(schema)]


def quantity(unit: str, example: str = "") -> Any:
    """Return the type of a number with an SI unit, "" for a pure number, for a field of a table."""
    said = example or EXAMPLES.get(unit.replace("^", ""), f"1 {unit}")
    return Annotated[float, *_kind(unit, said)]


def positive(number: float) -> float:
    """Return a number above zero [-, SI], or raise a ValueError."""
    if not number > 0.0:
        msg = "must be greater than 0: write a positive number"
        raise ValueError(msg)
    return number


def not_negative(number: float) -> float:
    """Return a number of at least zero [-, SI], or raise a ValueError."""
    if number < 0.0:
        msg = "must be at least 0: write 0 or a positive number"
        raise ValueError(msg)
    return number


def part_of_side(number: float) -> float:
    """Return an eccentricity over a side of the plan [-], or raise a ValueError."""
    if abs(number) >= _LARGEST_ECCENTRICITY:
        meant = f', or "{number:g} %" if per cent are meant' if abs(number) >= 1.0 else ""
        msg = f"must be between -0.5 and 0.5 of the side of the plan: write 0.03{meant}"
        raise ValueError(msg)
    return number


_LARGEST_ECCENTRICITY = 0.5  # there the mass is at the edge

Positive, NotNegative = AfterValidator(positive), AfterValidator(not_negative)

Length = Annotated[float, *_kind("m", "175 mm")]
Force = Annotated[float, *_kind("N", "150 kN")]
Pressure = Annotated[float, *_kind("Pa", "30 MPa")]
Mass = Annotated[float, *_kind("kg", "200 t")]
AreaMass = Annotated[float, *_kind("kg/m2", "1450 kg/m2")]
Density = Annotated[float, *_kind("kg/m3", "2500 kg/m3"), NotNegative]
AreaLoad = Annotated[float, *_kind("N/m2", "4.5 kN/m2")]
LineLoad = Annotated[float, *_kind("N/m", "8 kN/m")]
Stiffness = Annotated[float, *_kind("N/m", "400 kN/mm")]
Time = Annotated[float, *_kind("s", "5 ms")]
Acceleration = Annotated[float, *_kind("m/s2", "3.5 m/s2")]
Speed = Annotated[float, *_kind("m/s", "0.8 m/s")]
SpeedRate = Annotated[float, *_kind("s/m", "100 s/m")]
Ratio = Annotated[float, *_kind("", "0.05")]
Eccentricity = Annotated[Ratio, AfterValidator(part_of_side)]
