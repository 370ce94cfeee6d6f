"""Errors that are put into the file of a project, each with the words of what was put wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Document = dict[str, dict[str, Any]]
"""Sections of a project's file."""

_LOADED = 0.4
"""Share of the moment frames of ASCE 7-22 whose floors have pressures in place of masses."""


def sound(rng: np.random.Generator) -> Document:
    """Return a project that can be run, of a random code and structure."""
    code = str(rng.choice(["ASCE 7-22", "EN 1998", "NCh2745"]))
    frame = rng.random() < 0.5
    structure: dict[str, Any] = {
        "kind": "moment frame" if frame else "shear building",
        "bays": [int(rng.integers(1, 3)), int(rng.integers(1, 3))],
        "bay_width": ["6 m", f"{rng.uniform(4.5, 7.0):.1f} m"],
        "storey_height": f"{rng.uniform(3.0, 4.0):.2f} m",
    }
    if frame:
        structure |= {
            "storeys": int(rng.integers(1, 3)),
            "floor_load": f"{rng.uniform(600.0, 1200.0):.0f} kg/m2",
            "columns": {"box": ["400 mm", "25 mm"], "material": "A992"},
            "beams": {"i_shape": ["550 mm", "220 mm", "20 mm", "12 mm"]},
            "base_beams": {"i_shape": ["800 mm", "300 mm", "30 mm", "16 mm"]},
        }
    else:
        structure |= {
            "storey_mass": ["120 t", "110 t"],
            "storey_stiffness": ["400 kN/mm", "300 kN/mm"],
        }
    counted = frame and code == "ASCE 7-22"
    loads = _loads(rng) if counted and rng.random() < _LOADED else None
    if loads is not None:
        del structure["floor_load"]
        structure |= _stiffened(rng, structure)
    if rng.random() < 0.5:
        structure["eccentricity"] = [0.05, round(float(rng.uniform(0.0, 0.1)), 3)]
    radius, height = round(float(rng.uniform(1.2, 2.4)), 2), round(float(rng.uniform(160, 240)))
    friction = round(float(rng.uniform(0.03, 0.07)), 3)
    spectra: Document = {
        "ASCE 7-22": {"s_ms": 1.0, "s_m1": 0.5},
        "EN 1998": {"a_g": "2.5 m/s2", "ground_type": "B", "kind": 1},
        "NCh2745": {"soil": "II", "zone": 2},
    }
    found: Document = {
        "project": {"name": "Random", "code": code},
        "structure": structure,
        **({} if loads is None else {"loads": loads}),
        "superstructure": {"R": 5.0, "importance": 1.0},
        "spectrum": spectra[code],
        "motions": {"folder": "motions", "scale": round(float(rng.uniform(0.5, 1.5)), 2)},
        "bearing": {
            "radius": f"{radius:g} m",
            "slider_height": f"{height} mm",
            "slider_radius": "150 mm",
            "capacity": f"{rng.uniform(180.0, 260.0):.0f} mm",
            "friction": friction,
            "interface_friction": round(2.0 * friction + 0.04, 3),
        },
        "bounds": {"friction": [0.8, 1.25], "interface": [0.9, 1.1]},
        "limits": {"rim_strength": "3 MN", "interface_pressure": "80 MPa"},
        "analysis": {
            "level": "pendulum",
            "histories": "all",
            "uplift_allowed": True,
            "accidental_eccentricity": "none",  # half of the runs; tests/golden moves masses
            "bounds": ["lower", "upper"],
        },
    }
    if rng.random() < 0.3:
        found["bearing"]["friction"] = {"f_max": friction, "f_min": 0.02, "rate": "80 s/m"}
    return found


def _loads(rng: np.random.Generator) -> dict[str, Any]:
    # Pressures of floors in place of their mass: dead load alone, of which the recomputation knows
    # the combinations.
    found: dict[str, Any] = {"dead": f"{rng.uniform(6.0, 11.0):.2f} kN/m2"}
    if rng.random() < 0.5:
        found["facade"] = f"{rng.uniform(1.0, 8.0):.1f} kN/m"
    if rng.random() < 0.3:
        found["span"] = str(rng.choice(["x", "y"]))
    return found


def _stiffened(rng: np.random.Generator, structure: dict[str, Any]) -> dict[str, Any]:
    # A wall at one side, or braces at the other.
    n = structure["bays"][0]
    if rng.random() < 0.3:
        wall = {"between": ["0-0", "0-1"], "thickness": "200 mm", "material": "C30/37"}
        return {"walls": [wall]}
    if rng.random() < 0.3:
        rods = {"between": [f"{n}-0", f"{n}-1"], "circle": ["150 mm", "8 mm"], "material": "S355"}
        return {"braces": [rods]}
    return {}


SPOILT = "spoilt "
"""Key of ``[motions]`` that says what is wrong of the files; it is not written."""

_UNITS = ("m", "mm", "kN", "MPa", "t", "s", "kg/m2", "%", "m/s2", "stones")
_QUANTITY = re.compile(r"^([-+0-9.e]+) (\S+)$")


def _quantities(document: Document) -> list[tuple[str, str, int | None]]:
    # Section, key and place of all values with a unit.
    found: list[tuple[str, str, int | None]] = []
    for section, keys in document.items():
        for key, value in keys.items():
            each = value if isinstance(value, list) else [value]
            for k, one in enumerate(each):
                if isinstance(one, str) and _QUANTITY.match(one):
                    found.append((section, key, k if isinstance(value, list) else None))
    return found


def _numbers(document: Document) -> list[tuple[str, str]]:
    return [
        (section, key)
        for section, keys in document.items()
        for key, value in keys.items()
        if isinstance(value, (int, float)) and not isinstance(value, bool)
    ]


def _choice(rng: np.random.Generator, each: Sequence[Any]) -> Any:
    return each[int(rng.integers(len(each)))]


def _put(document: Document, place: tuple[str, str, int | None], new: Any) -> None:
    section, key, k = place
    if k is None:
        document[section][key] = new
    else:
        document[section][key][k] = new


def _got(document: Document, place: tuple[str, str, int | None]) -> str:
    section, key, k = place
    value = document[section][key]
    return str(value if k is None else value[k])


def another_unit(document: Document, rng: np.random.Generator) -> str:
    """Give a value another unit."""
    place = _choice(rng, _quantities(document))
    number, unit = _got(document, place).split(" ")
    other = _choice(rng, [u for u in _UNITS if u != unit])
    _put(document, place, f"{number} {other}")
    return f"{place[0]}.{place[1]}: {unit} is {other}"


def no_unit(document: Document, rng: np.random.Generator) -> str:
    """Leave a unit out."""
    place = _choice(rng, _quantities(document))
    _put(document, place, float(_got(document, place).split(" ")[0]))
    return f"{place[0]}.{place[1]}: no unit"


def thousandfold(document: Document, rng: np.random.Generator) -> str:
    """Take a value a thousand times, a thousandth, or its negative."""
    factor = _choice(rng, [1e3, 1e-3, -1.0, 0.0])
    if rng.random() < 0.3:
        section, key = _choice(rng, _numbers(document))
        document[section][key] = factor * document[section][key]
        return f"{section}.{key}: times {factor:g}"
    place = _choice(rng, _quantities(document))
    number, unit = _got(document, place).split(" ")
    _put(document, place, f"{factor * float(number):g} {unit}")
    return f"{place[0]}.{place[1]}: times {factor:g}"


def not_finite(document: Document, rng: np.random.Generator) -> str:
    """Make a number infinite or none."""
    word = _choice(rng, [math.inf, math.nan])
    if rng.random() < 0.5:
        section, key = _choice(rng, _numbers(document))
        document[section][key] = word
        return f"{section}.{key}: {word}"
    place = _choice(rng, _quantities(document))
    _put(document, place, f"{word} {_got(document, place).split(' ')[1]}")
    return f"{place[0]}.{place[1]}: {word}"


def missing_key(document: Document, rng: np.random.Generator) -> str:
    """Leave a key out."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    del document[section][key]
    return f"{section}.{key}: missing"


def missing_section(document: Document, rng: np.random.Generator) -> str:
    """Leave a section out."""
    section = _choice(rng, list(document))
    del document[section]
    return f"{section}: missing"


def misspelled(document: Document, rng: np.random.Generator) -> str:
    """Change a letter of a key."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    k = int(rng.integers(len(key)))
    other = key[:k] + _choice(rng, "abcxyz") + key[k + 1 :]
    document[section] = {(other if n == key else n): v for n, v in document[section].items()}
    return f"{section}.{key}: {other}"


def doubled(document: Document, rng: np.random.Generator) -> str:
    """Have a key twice, once with another value."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    document[section][f"{key} "] = document[section][key]  # written without the space
    return f"{section}.{key}: twice"


def swapped(document: Document, rng: np.random.Generator) -> str:
    """Swap two values of a section."""
    section = _choice(rng, [name for name in document if len(document[name]) > 1])
    one, two = rng.choice(list(document[section]), 2, replace=False)
    keys = document[section]
    keys[one], keys[two] = keys[two], keys[one]
    return f"{section}: {one} and {two} swapped"


def turned_bounds(document: Document, rng: np.random.Generator) -> str:
    """Swap the lower and upper bound friction properties."""
    key = _choice(rng, list(document["bounds"]))
    document["bounds"][key] = document["bounds"][key][::-1]
    return f"bounds.{key}: upper before lower"


def another_kind(document: Document, rng: np.random.Generator) -> str:
    """Put a value of another kind."""
    section = _choice(rng, [name for name in document if document[name]])
    key = _choice(rng, list(document[section]))
    document[section][key] = _choice(rng, [[], "", True, {"a": 1}, -3, "1 m 2 m", [1, 2, 3, 4]])
    return f"{section}.{key}: {document[section][key]!r}"


def another_order(document: Document, rng: np.random.Generator) -> str:
    """Write sections and keys in another order, which must not matter."""
    sections = list(document)
    rng.shuffle(sections)
    turned = {name: dict(reversed(document[name].items())) for name in sections}
    document.clear()
    document.update(turned)
    return "order"


def another_code(document: Document, rng: np.random.Generator) -> str:
    """Name another code than the spectrum is of."""
    own = document["project"]["code"]
    codes = ["ASCE 7-22", "EN 1998", "NCh2745", "ASCE 7-16", "eurocode 8"]
    document["project"]["code"] = _choice(rng, [c for c in codes if c != own])
    return f"project.code: {document['project']['code']} for {own}"


def bad_motion(document: Document, rng: np.random.Generator) -> str:
    """Ask for a motion that cannot be; who writes the files reads which."""
    kinds = ("no file", "a word", "nan", "empty", "unit", "no dt", "no table", "still", "in g")
    kind = str(_choice(rng, kinds))
    document["motions"][SPOILT] = kind
    return f"motions: {kind}"


ERRORS: tuple[Callable[[Document, np.random.Generator], str], ...] = (
    another_unit,
    no_unit,
    thousandfold,
    thousandfold,
    thousandfold,
    not_finite,
    missing_key,
    missing_section,
    misspelled,
    doubled,
    swapped,
    turned_bounds,
    another_kind,
    another_order,
    another_code,
    bad_motion,
)
"""What can be put wrong; what stands several times is chosen as often."""
