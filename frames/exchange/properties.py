"""Materials and cross-sections of a file, by constants, by shape, or by a program's library."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.parsers import expat

from frames._errors import ModelError, argument
from frames.exchange.building import Building, FrameSection, Material, Modifiers
from frames.exchange.fields import values
from frames.exchange.members import MOMENTS
from frames.exchange.tables import LENGTHS, Row
from frames.model.sections import Section
from frames.model.shapes import catalogue_dimensions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from frames.exchange.building import Vector
    from frames.exchange.fields import Fields
    from frames.exchange.tables import Units


def in_use(rows: dict[str, Row], names: Iterable[str]) -> tuple[dict[str, Row], list[str]]:
    """Return the rows that some name refers to, and the names of the others."""
    wanted = set(names)
    return {k: r for k, r in rows.items() if k in wanted}, [k for k in rows if k not in wanted]


def material_of(row: Row, name: str, map_: Fields, building: Building) -> Material:
    """Return a material; without a shear modulus it is isotropic."""
    found = values(row, map_, building, f' of material "{name}"')
    isotropic = 0.5 * found["elastic_modulus"] / (1.0 + found["poisson_ratio"])
    return Material(name, **found | {"shear_modulus": found.get("shear_modulus") or isotropic})


def by_constants(
    row: Row, name: str, map_: Fields, building: Building, units: Units | None = None
) -> FrameSection:
    """Return a cross-section by its constants; without a width it is as wide as deep."""
    found = values(row, map_, building, units=units)
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


def offsets_of(row: Row, map_: Fields, building: Building) -> tuple[Vector, Vector]:
    """Return the offsets of both ends of a frame object."""
    a, b, c, d, e, f = values(row, map_, building).values()
    return (a, b, c), (d, e, f)


def shell_factors(row: Row, map_: Fields, building: Building) -> dict[str, Any]:
    """Return the factors of a shell [-]: in plane, of bending, on mass and on weight."""
    given = values(row, map_, building)
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


_SOLID = {"rectangular", "concrete rectangular", "steel plate", "steel rod rectangular"}
_ROUND = {"circle", "concrete circle", "steel rod", "steel solid rod"}
_I = {"i/wide flange", "steel i/wide flange", "i section"}
_TUBE = {"box/tube", "tube", "steel tube"}
_PIPE = {"pipe", "steel pipe"}
_ROLLED = re.compile(r"(IPE|HE)[ABM]?\s*\d+\s*[ABM]?", re.IGNORECASE)
_ANY = 1e9  # Pa: the constants of a shape are those of any material but for its Poisson's ratio


def shape_constants(
    shape: str, sizes: tuple[float, float, float, float], poisson_ratio: float
) -> Section | None:
    """Return the constants of a shape."""
    word = shape.strip().lower()
    depth, width, flange, web = sizes
    if word in _SOLID:
        return Section.rectangle(width, depth, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _ROUND:
        return Section.circle(depth, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _I:
        return Section.i_shape(
            depth, width, flange, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio
        )
    if word in _TUBE and math.isclose(flange, web, rel_tol=1e-6):
        return Section.box(width, depth, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if word in _PIPE:
        return Section.circle(depth, web, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    if _ROLLED.fullmatch(word):
        return Section.catalogue(word, elastic_modulus=_ANY, poisson_ratio=poisson_ratio)
    return None


def section_by_shape(
    row: Row,
    name: str,
    material: str,
    shape: str,
    sizes: tuple[float, float, float, float],
    poisson_ratio: float,
) -> FrameSection:
    """Return a cross-section that is given by its shape."""
    try:
        if not sizes[0] and _ROLLED.fullmatch(shape.strip()):
            depth, width, flange, web, _ = catalogue_dimensions(shape)
            sizes = (depth, width, flange, web)
        found = shape_constants(shape, sizes, poisson_ratio)
    except ModelError as cause:
        msg = f'section "{name}": {cause}'
        raise row.error(msg) from cause
    if found is None:
        message = (
            f'section "{name}" is a "{shape}" without Area, I33, I22 and torsion constant: '
            "define it as a general section, or for ETABS set its constants, "
            f"{argument('sections', {name: ...})}, or its property file, "
            f"{argument('library', ['AISC14.xml'])}"
        )
        raise row.error(message)
    return with_constants(name, material, shape, found, sizes)


def with_constants(
    name: str,
    material: str,
    shape: str,
    found: Section,
    sizes: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
) -> FrameSection:
    """Return a cross-section with the constants of a section, whose local z is axis 2."""
    depth = sizes[0] or math.sqrt(12.0 * found.inertia_y / found.area)
    width = sizes[1] or sizes[0] or found.area / depth
    return FrameSection(
        name=name,
        material=material,
        shape=shape,
        area=found.area,
        torsion=found.torsion_constant,
        inertia_33=found.inertia_y,
        inertia_22=found.inertia_z,
        shear_2=found.shear_area_z,
        shear_3=found.shear_area_y,
        depth=depth,
        width=width,
    )


_PIPE_FILLED = "filled steel pipe"
FILLED = ("filled steel tube", _PIPE_FILLED)
"""Shapes that are filled, in lower case."""


def filled_section(
    row: Row,
    name: str,
    sizes: tuple[float, float, float, float],
    steel: Material,
    fill: Material,
) -> FrameSection:
    """Return the section of a filled tube or pipe, transformed to its steel.

    Areas and inertias of the concrete count by its modulus over that of the steel, uncracked and
    bonded; torsion and shear by the shear moduli, each part for itself. Factors on mass and weight
    make them those of both materials.
    """
    shape = row.text("SHAPE")
    solid, hollow = (
        ("circle", "pipe") if shape.strip().lower() == _PIPE_FILLED else ("rectangular", "tube")
    )
    depth, width, _, web = sizes
    inner = (depth - 2.0 * web, width - 2.0 * web, 0.0, 0.0)
    try:
        wall = shape_constants(hollow, sizes, steel.poisson_ratio)
        core = shape_constants(solid, inner, fill.poisson_ratio)
    except ModelError as cause:
        msg = f'section "{name}": {cause}'
        raise row.error(msg) from cause
    if wall is None or core is None:
        message = (
            f'section "{name}": TF = {sizes[2]:g} m and TW = {web:g} m differ, but filled '
            "tubes need equal thickness: set its constants, "
            f"{argument('sections', {name: ...})}"
        )
        raise row.error(message)
    stretch = fill.elastic_modulus / steel.elastic_modulus
    shear = fill.shear_modulus / steel.shear_modulus
    area = wall.area + stretch * core.area

    def share(value: Callable[[Material], float], word: str) -> float:
        # Weight of both over that of the transformed area of steel alone.
        own, inside = value(steel), value(fill)
        if own <= 0.0:
            if inside <= 0.0:
                return 1.0
            msg = f'section "{name}": its steel "{steel.name}" has no {word}, its concrete has'
            raise row.error(msg)
        return (own * wall.area + inside * core.area) / (own * area)

    return replace(
        with_constants(name, steel.name, shape, wall, sizes),
        area=area,
        torsion=wall.torsion_constant + shear * core.torsion_constant,
        inertia_33=wall.inertia_y + stretch * core.inertia_y,
        inertia_22=wall.inertia_z + stretch * core.inertia_z,
        shear_2=wall.shear_area_z + shear * core.shear_area_z,
        shear_3=wall.shear_area_y + shear * core.shear_area_y,
        modifiers=Modifiers(
            mass=share(lambda matter: matter.density, "mass"),
            weight=share(lambda matter: matter.weight, "weight"),
        ),
    )


ROOT = "PROPERTY_FILE"
FIELDS = {"A": "AREA", "J": "TORSION", "HT": "D", "OD": "D", "BF": "B"}
"""Words of these files that ETABS' text has otherwise."""


class Shape(NamedTuple):
    """Constants of a shape, in the words of ETABS' text, and their unit of length [m]."""

    row: Row
    length: float


def read_libraries(paths: str | Path | Sequence[str | Path]) -> dict[str, Shape]:
    """Return the shapes of property files by their labels, in capitals."""
    given = [paths] if isinstance(paths, str | Path) else list(paths)
    found: dict[str, Shape] = {}
    for path in given:
        for label, shape in _read(Path(path)).items():
            found.setdefault(label, shape)
    return found


def _read(path: Path) -> dict[str, Shape]:
    try:
        content = path.read_bytes()
    except OSError as cause:
        message = (
            f"{path} cannot be read ({cause.strerror}): name a property file of ETABS or SAP2000"
        )
        raise ModelError(message) from cause
    rows = _Entries(path.name)
    try:
        rows.parse(content)
    except (expat.ExpatError, LookupError, ValueError) as cause:  # of these, encodings
        where = f", line {cause.lineno}" if isinstance(cause, expat.ExpatError) else ""
        message = (
            f"{path.name}{where} is not valid XML ({cause}): name a property file of ETABS "
            "or SAP2000, AISC14.xml"
        )
        raise ModelError(message) from cause
    words = rows.control.text("LENGTH_UNITS", "") if rows.control else ""
    if rows.root != ROOT or words.upper() not in LENGTHS:
        message = (
            f"{path.name} is not a property file of ETABS or SAP2000, which begins with "
            f"{ROOT} and has LENGTH_UNITS of {', '.join(LENGTHS)} under CONTROL"
        )
        raise ModelError(message)
    one = LENGTHS[words.upper()]
    return {row.text("LABEL").strip().upper(): Shape(row, one) for row in rows.shapes}


class _Entries:
    # The entries of a file: elements under its root, their texts by name.
    def __init__(self, file: str) -> None:
        self.file, self.root = file, ""
        self.control: Row | None = None
        self.shapes: list[Row] = []
        self._open: list[str] = []
        self._text: list[str] = []
        self._row = Row(file, "", 0, {})

    def parse(self, content: bytes) -> None:
        parser = expat.ParserCreate(namespace_separator=" ")

        def start(tag: str, _: object) -> None:
            name = tag.rsplit(" ", 1)[-1].upper()
            self._open.append(name)
            self._text = []
            if len(self._open) == 1:
                self.root = name
            elif len(self._open) == 2:
                self._row = Row(self.file, name, parser.CurrentLineNumber, {})

        parser.StartElementHandler = start
        parser.CharacterDataHandler = self._text_of
        parser.EndElementHandler = self._end
        parser.Parse(content, True)

    def _text_of(self, data: str) -> None:
        self._text.append(data)

    def _end(self, _: str) -> None:
        name = self._open.pop()
        if len(self._open) == 2:
            self._row.values[FIELDS.get(name, name)] = "".join(self._text).strip()
        elif len(self._open) == 1 and name == "CONTROL":
            self.control = self._row
        elif len(self._open) == 1 and self._row.has("LABEL", "AREA", "I33", "I22"):
            self.shapes.append(self._row)
        self._text = []
