"""What the report says the structure is, from the project's file and the model's nodes."""

import math

import building
import imported

STEELS = {"S": 210, "A": 200}  # GPa, by the first letter of a grade
COMBINATIONS = {  # of dead load, live load and snow, without S_MS
    "ASCE 7-22": {"average": (1.0, 0.5, 0.0), "maximum": (1.2, 1.0, 0.15), "minimum": (0.9, 0, 0)},
    "EN 1998": {"average": (1.0, 0.3, 0.0), "maximum": (1.0, 0.3, 0.2), "minimum": (1.0, 0, 0)},
    "NCh2745": {"average": (1.0, 0.5, 0.0), "maximum": (1.2, 1.0, 0.2), "minimum": (0.8, 0, 0)},
}
LIVE_MASS = {"ASCE 7-22": 0.0, "EN 1998": 0.3, "NCh2745": 0.25}


def compare(project, rows, tally):
    """Hold each row of the report's table against the file."""
    wanted = described(project)
    told = imported_rows(project)
    own = [(row[0], row[1]) for row in rows if row[0] in {key for key, _ in told}]
    for k, (one, other) in enumerate(zip(own, told, strict=False)):
        tally.words("tables of the report", f"of the structure: import {k}", one, other)
    tally.words("tables of the report", "rows of the import", len(own), len(told))
    rows = [row for row in rows if (row[0], row[1]) not in own]
    if project.file["structure"]["kind"] == "sap2000":
        became = [row for row in rows if row[0].startswith("read")]
        rows = [row for row in rows if row not in became]
        for row in became:
            tally.unknown("tables of the report", f"of the structure: {row[0]}")
    found = {row[0]: row[1] for row in rows}
    for key, text in found.items():
        if key not in wanted:
            tally.unknown("tables of the report", f"of the structure: {key}")
        elif key == "seismic mass":
            text = text.partition(" (")[0]  # the clause behind it is the code's
            tally.words("tables of the report", key, text, wanted[key])
        else:
            tally.words("tables of the report", f"of the structure: {key}", text, wanted[key])
    tally.words("tables of the report", "rows of the structure", sorted(found), sorted(wanted))


def described(project):
    """Return the rows by what they say."""
    given, statics = project.file["structure"], project.governing
    levels, kind = statics["level_height"], given["kind"]
    count = len(project.table("bearings"))
    found = {"structure": f"{kind}, {len(levels) - 1} storeys on {count} bearings"}
    if len(levels) > 1:
        found["height above the base"] = f"{levels[-1] - levels[0]:.4g} m"
    if kind in {"etabs", "sap2000"}:
        found["import"] = f"of {given['file']}"
    if kind in {"opensees", "etabs", "sap2000"}:
        return found
    sides = [n * w for n, w in zip(given["bays"], given["bay_width"], strict=True)]
    found["plan"] = " x ".join(f"{side:.4g}" for side in sides) + " m"
    if kind == "moment frame":
        names = {"columns": "columns", "beams": "beams", "base_beams": "base beams"}
        for key, said in names.items():
            parts = given[key] if isinstance(given[key], list) else [given[key]]
            for part in parts:
                of = "storeys" in part and ", storeys {} to {}".format(*part["storeys"])
                found[said + (of or "")] = section(part)
        found |= stiffened(given)
        damping = 100.0 * given.get("damping", 0.02)
        found["damping above the bearings"] = f"{damping:g} % in each mode"
        if "floor_load" in given:
            mass = f"{given['floor_load']:.4g} kg/m²"
            found["mass of a floor besides its members"] = mass
    loads = project.file.get("loads")
    if loads is not None:
        last = f"floor-{given['storeys']}"
        found["loaded area"] = f"base to {last} {math.prod(sides):.5g} m²"
        found |= loaded(loads, project)
    return found


def imported_rows(project):
    """Return the rows of what became of a model's file."""
    is_imported = project.file["structure"]["kind"] == "etabs"
    return imported.model(project).told() if is_imported else []


def modulus(material):
    """Return E of a named material [GPa]."""
    if material.startswith("C"):
        strength = float(material[1:].partition("/")[0]) + 8.0
        return 22.0 * (strength / 10.0) ** 0.3
    return STEELS[material[0]]


def section(given):
    """Return a section in words: box, I, circle, rectangle or a rolled one."""
    material = given.get("material", "A992")
    of = f"{material} (E {modulus(material):.4g} GPa)"
    if "section" in given:
        return f"{given['section']}, {of}"
    shape = next(key for key in ("box", "i_shape", "circle", "rectangle") if key in given)
    sizes = [1e3 * size for size in given[shape]]
    if shape == "box" and len(sizes) == 2:
        sizes.insert(0, sizes[0])
    word = {"i_shape": "I"}.get(shape, shape)
    sized = " x ".join(f"{size:.5g}" for size in sizes)
    return f"{word} {sized} mm, {of}"


def stiffened(given):
    """Return walls and braces."""
    found = {}
    for wall in given.get("walls", []):
        one, other = wall["between"]
        thick, material = 1e3 * wall["thickness"], wall["material"]
        found[f"wall {one} to {other}, as a wide column"] = (
            f"{thick:.5g} mm, {material} (E {modulus(material):.4g} GPa)"
        )
    for rod in given.get("braces", []):
        one, other = rod["between"]
        found[f"braces {one} to {other}"] = f"crossed, {section(rod)}"
    return found


def loaded(loads, project):
    """Return pressures, masses and combinations."""
    code, found = project.code, {}
    dead, live, snow = (loads.get(key, 0.0) for key in ("dead", "live", "snow"))
    for what in ("floors", "roof", "base"):
        own = {"dead": dead, "live": live, "snow": snow if what == "roof" else 0.0}
        own |= loads.get(what, {})
        parts = [f"{key} {1e-3 * q:.4g}" for key, q in own.items() if q > 0.0]
        found[f"loads of {what}, besides the members"] = ", ".join(parts) + " kN/m²"
    if loads.get("facade", 0.0) > 0.0:
        found["facade, along the outer edges"] = f"{1e-3 * loads['facade']:.4g} kN/m"
    mass = loads.get("mass", {"live": LIVE_MASS[code]})
    shares = (mass.get("dead", 1.0), mass.get("live", 0.0), mass.get("snow", 0.0))
    found["seismic mass"] = f"members, {added(shares)}"
    for name, (fixed, light, white) in COMBINATIONS[code].items():
        part = {"maximum": 1.0, "minimum": -1.0}.get(name, 0.0) * building.upright(project)
        light *= 1.0 + part * (code == "EN 1998")
        found[f"{name} combination, no horizontal earthquake"] = added((fixed + part, light, white))
    return found


def added(factors):
    """Return factors of dead load, live load and snow as a sum."""
    named = zip(factors, "DLS", strict=True)
    return " + ".join(f"{factor:.4g} {case}" for factor, case in named if factor > 0.0)
