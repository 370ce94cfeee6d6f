"""The structure of a project in an engineer's words: storeys, sections, loads."""

from __future__ import annotations

from collections import Counter
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from frames.design.codes.registry import code_named
from frames.design.project.member_sections import (
    bending_said,
    material_of,
    named_section,
    of_material,
    storeys_said,
)
from frames.design.project.moat_and_dampers import device_rows
from frames.design.project.schema_sections import CrackedTable
from frames.design.project.schema_structure import (
    BuildingTable,
    IrregularFrame,
    MomentFrame,
    ShearBuilding,
)
from frames.design.project.structure_loads import loads_of
from frames.design.project.structure_plan import DIRECTIONS, sections_of
from frames.model.axes import area_of
from frames.model.components import DEFAULT_CASE
from lir_element.texts import joined, worded

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from frames.design.hazard.spectrum import Spectrum
    from frames.design.project.schema import ProjectFile
    from frames.design.project.schema_sections import BraceTable, WallTable
    from frames.design.project.structure_loads import LoadsTable
    from frames.exchange.import_report import ImportReport
    from frames.io import Frame

Rows = list[tuple[str, str]]


def structure_rows(file: ProjectFile, frame: Frame, spectrum: Spectrum | None = None) -> Rows:
    """Return the description of the structure, a row for each property."""
    given = file.structure
    levels = frame.levels
    rows = [
        (
            "structure",
            worded(
                "{kind}, {n} storeys on {m} bearings",
                kind=given.kind,
                n=len(levels) - 1,
                m=len(frame.bearings),
            ),
        )
    ]
    if len(levels) > 1:
        rows.append(("height above the base", f"{levels[-1].z - levels[0].z:.4g} m"))
    if isinstance(given, (MomentFrame, ShearBuilding)):
        sides = (n * w for n, w in zip(given.bays, given.bay_width, strict=True))
        rows.append(("plan", " x ".join(f"{side:.4g}" for side in sides) + " m"))
    if isinstance(given, MomentFrame):
        rows += _sections(given)
    if isinstance(given, IrregularFrame):
        rows += _named_sections(given, frame)
    if isinstance(given, BuildingTable):
        rows += _areas(frame)
        rows += _walls_and_braces(given)
        rows.append(
            (
                "damping above the bearings",
                worded("{share:g} % in each mode", share=100.0 * given.damping),
            )
        )
    if isinstance(given, BuildingTable) and given.floor_load is not None:
        rows.append(("mass of a floor besides its members", f"{given.floor_load:.4g} kg/m²"))
    if file.loads is not None:
        rows += _loads(file, file.loads, spectrum)
    rows += device_rows(file.moat, file.dampers)
    if frame.imported is not None:
        rows += _import(frame.imported)
    return rows


def _import(account: ImportReport) -> Rows:
    # Imported objects of the other program's file, a row for each kind.
    rows = [("import", worded("of {file}", file=account.file))]
    for fate, table, what, count, weight, stiffness in account.rows():
        shares = [
            worded("{share} of {whole}", share=share, whole=word)
            for share, word in ((weight, "own weight"), (stiffness, "stiffness"))
            if share
        ]
        rows.append(
            (
                fate,
                worded(
                    "{table}: {what} ({counts})",
                    table=table,
                    what=what,
                    counts=joined(count, *shares, by=", "),
                ),
            )
        )
    return rows


def _named_sections(given: IrregularFrame, frame: Frame) -> Rows:
    places = np.array([node.position[:2] for node in frame.nodes.values()])
    sides = " x ".join(f"{side:.4g}" for side in np.ptp(places, axis=0))
    kinds = Counter(name.split("-", maxsplit=1)[0] for name in frame.members)
    counts = joined(
        *(worded("{n} {kind}", n=count, kind=f"{kind}s") for kind, count in kinds.items()), by=", "
    )
    rows = [("plan, largest sides", f"{sides} m"), ("members", counts)]
    for name, table in given.sections.items():
        rows.append((worded("section {name}", name=name), named_section(table, column=True).said))
    return rows


def _areas(frame: Frame) -> Rows:
    # Areas with loads, floors of one area together.
    found = {level.name: 0.0 for level in frame.levels}
    places = {name: (node.x, node.y) for name, node in frame.nodes.items()}
    for load in frame.floor_loads.values():
        level = next(each.name for each in frame.levels if load.nodes[0] in each.nodes)
        if load.case == DEFAULT_CASE:
            found[level] += area_of(places, load.nodes)
    if not any(found.values()):
        return []
    said = []
    for area, group in groupby(found, key=lambda level: f"{found[level]:.5g}"):
        names = list(group)
        where = names[0] if len(names) == 1 else _span(names[0], names[-1])
        said.append(worded("{where} {area} m²", where=where, area=area))
    return [("loaded area", joined(*said, by=", "))]


def _loads(file: ProjectFile, given: LoadsTable, spectrum: Spectrum | None) -> Rows:
    rule = code_named(file.project.code).loads
    names = {"D": "dead", "L": "live", "S": "snow"}
    rows = []
    for what in ("floors", "roof", "base"):
        each = given.of_field(base=what == "base", roof=what == "roof")
        parts = [
            worded("{case} {load:.4g}", case=names[c], load=1e-3 * q)
            for c, q in each.items()
            if q > 0.0
        ]
        title = worded("loads of {what}, besides the members", what=what)
        rows.append((title, worded("{loads} kN/m²", loads=joined(*parts, by=", "))))
    if given.facade > 0.0:
        rows.append(("facade, along the outer edges", f"{1e-3 * given.facade:.4g} kN/m"))
    found = loads_of(given, rule)
    mass = {} if found is None else found.mass
    source = rule.cited if given.mass is None else "as in the file"
    counted = worded("members, {sum} ({source})", sum=_sum(mass), source=source)
    rows.append(("seismic mass", counted))
    for name, factors in rule.combined(spectrum).items():
        title = worded("{name} combination, no horizontal earthquake", name=name)
        rows.append((title, _sum(factors)))
    return rows


def _sum(factors: Mapping[str, float]) -> str:
    parts = (
        worded("{factor:.4g} {case}", factor=factor, case=case)
        for case, factor in factors.items()
        if factor > 0.0
    )
    return joined(*parts, by=" + ")


def _sections(given: MomentFrame) -> Rows:
    found = sections_of(given)
    rows = _by_storey("columns", [one.said for one in found.columns])
    tables = {id(one): one for one in found.special.values()}
    for one in tables.values():
        title = worded("columns at {lines}", lines=", ".join(one.at))
        title = joined(title, storeys_said(one.storeys), by=", ")
        rows.append((title, named_section(one, column=True).said))
    alike = [one.said for one in found.beams["x"]] == [one.said for one in found.beams["y"]]
    for direction in DIRECTIONS[: 1 if alike else 2]:
        what = "beams" if alike else worded("beams along {axis}", axis=direction)
        rows += _by_storey(what, [one.said for one in found.beams[direction]])
    base = {found.base_beams[direction].said: direction for direction in DIRECTIONS}
    for said, direction in base.items():
        what = "base beams" if len(base) == 1 else worded("base beams along {axis}", axis=direction)
        rows.append((what, said))
    return rows


def _walls_and_braces(given: BuildingTable) -> Rows:
    rows = []
    for wall in given.walls:
        material = material_of(wall.material)
        thickness = f"{1e3 * wall.thickness:.5g} mm"
        bending = wall.cracked if isinstance(wall.cracked, float) else None
        bending = wall.cracked.bending if isinstance(wall.cracked, CrackedTable) else bending
        cracked = "" if bending is None else bending_said(bending)
        title = worded("wall {where}, as a wide column", where=_between(wall))
        rows.append((title, joined(thickness, of_material(material), cracked, by=", ")))
    for rod in given.braces:
        of_rod = named_section(rod, column=False).said
        title = worded("braces {where}", where=_between(rod))
        rows.append((title, joined(_PATTERNS[rod.pattern], of_rod, by=", ")))
    for what, kind in (("floors", given.floor_diaphragm), ("base", given.base_diaphragm)):
        if kind == "flexible":
            title = worded("diaphragm of {what}", what=what)
            rows.append((title, "none: beams alone connect the floor in plan"))
    return rows


_PATTERNS = {"x": "crossed", "up": "rising to the second", "down": "rising to the first"}


def _between(part: WallTable | BraceTable) -> str:
    return joined(_span(*part.between), storeys_said(part.storeys), by=", ")


def _span(first: str, last: str) -> str:
    return worded("{first} to {last}", first=first, last=last)


def _by_storey(what: str, said: Sequence[str]) -> Rows:
    rows, storey = [], 1
    for text, group in groupby(said):
        last = storey + len(list(group)) - 1
        alone = worded("storey {number}", number=storey)
        where = alone if last == storey else storeys_said((storey, last))
        whole = last - storey + 1 == len(said)
        rows.append((joined(what, "" if whole else where, by=", "), text))
        storey = last + 1
    return rows
