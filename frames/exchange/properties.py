"""Materials, cross-sections and factors of a file, whichever its dialect."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frames.exchange.building import Building, FrameSection, Material
from frames.exchange.fields import values
from frames.exchange.members import MOMENTS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from frames.exchange.building import Vector
    from frames.exchange.fields import Fields, Units
    from frames.exchange.tables import Row


def in_use(rows: dict[str, Row], names: Iterable[str]) -> tuple[dict[str, Row], list[str]]:
    """Return the rows that some name refers to, and the names of the others."""
    wanted = set(names)
    return {k: r for k, r in rows.items() if k in wanted}, [k for k in rows if k not in wanted]


def material_of(row: Row, name: str, map_: Fields, units: Units) -> Material:
    """Return a material; without a shear modulus it is isotropic."""
    found = values(row, map_, units, f' of material "{name}"')
    isotropic = 0.5 * found["elastic_modulus"] / (1.0 + found["poisson_ratio"])
    return Material(name, **found | {"shear_modulus": found.get("shear_modulus") or isotropic})


def by_constants(row: Row, name: str, map_: Fields, units: Units) -> FrameSection:
    """Return a cross-section by its constants; without a width it is as wide as deep."""
    found = values(row, map_, units)
    return FrameSection(name, **found | {"width": found["width"] or found["depth"]})


def released(
    row: Row, frame: str, words: Iterable[str], building: Building
) -> tuple[frozenset[str], frozenset[str]]:
    """Return the releases of both ends of a frame object from words "M2I"; of moments alone."""
    first, last = (frozenset(w[:-1] for w in words if w.endswith(end)) for end in "IJ")
    if not first | last <= MOMENTS.keys():
        what = "releases of axial and shear forces, which are passed on"
        building.account.refuse("force releases", row.table, what, [frame], row.place)
    return first.intersection(MOMENTS), last.intersection(MOMENTS)


def offsets_of(row: Row, map_: Fields, units: Units) -> tuple[Vector, Vector]:
    """Return the offsets of both ends of a frame object."""
    a, b, c, d, e, f = values(row, map_, units).values()
    return (a, b, c), (d, e, f)


def shell_factors(row: Row, map_: Fields, building: Building) -> dict[str, Any]:
    """Return the factors of a shell [-]: in plane, of bending, on mass and on weight."""
    given = values(row, map_, building.units)
    found = {word: given[word] for word in ("mass", "weight")}
    for letter, word in (("F", "in_plane"), ("M", "bending")):
        factors = [given[f"{letter}{d}"] for d in ("11", "22", "12")]
        if max(factors) - min(factors) > 1e-9:
            what = "stiffness modifiers of an area that differ by direction, taken by their mean"
            name = next(f.names.split("|")[0] for f in map_ if f.ours == f"{letter}11")
            key = "directional area modifiers"
            building.account.refuse(key, row.table, what, [name], row.place)
        found[word] = sum(factors) / 3.0
    return found
