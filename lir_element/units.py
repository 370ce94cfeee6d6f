"""The constant of gravity, and the unit that a number of the wrong size was probably given in."""

from __future__ import annotations

from lir_element.texts import joined, worded

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity [m/s2]."""

OTHER_UNITS: dict[str, tuple[tuple[str, float], ...]] = {
    "m": (("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254)),
    "N/m": (("kN/mm", 1e6), ("kN/m", 1e3)),
    "N": (("kN", 1e3), ("MN", 1e6)),
    "N/m2": (("kN/m2", 1e3),),
    "kg": (("t", 1e3),),
    "m/s2": (("mm/s2", 1e-3), ("cm/s2", 1e-2), ("g", STANDARD_GRAVITY)),
    "Pa": (("MPa", 1e6), ("GPa", 1e9), ("kPa", 1e3)),
    "m2": (("mm2", 1e-6), ("cm2", 1e-4)),
    "s": (("ms", 1e-3), ("us", 1e-6)),
    "s/m": (("s/mm", 1e3), ("s/cm", 1e2)),
    "kg/m3": (("t/m3", 1e3), ("kg/mm3", 1e9)),
}
"""Units of input numbers besides those of SI, and the size of each in the SI unit."""


def meant(value: float, unit: str, low: float, high: float) -> str:
    """Return the unit in which a number of the wrong size would be usual, to end a sentence."""
    fitting = [
        worded(
            "{value:.5g} {name} are {same:.4g} {unit}",
            value=value,
            name=name,
            same=value * factor,
            unit=unit,
        )
        for name, factor in OTHER_UNITS[unit]
        if low <= value * factor <= high
    ]
    if not fitting:
        return worded("give {unit}", unit=unit)
    return worded("give {unit} ({units})", unit=unit, units=joined(*fitting, by=", "))


def per_cent(value: object) -> str:
    """Return the probable meaning of a coefficient of friction above one."""
    if isinstance(value, (int, float)) and 1.0 <= value < 100.0:
        return f"give a pure number ({value:g} % is {0.01 * value:g})"
    return "give a pure number, 0.06 for 6 %"
