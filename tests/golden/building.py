"""Weight and mass of a frame with loads by area, counted by hand from the project's file."""

import math

import codes
import imported
from reading import GRAVITY

DENSITY = {"S": 7850.0, "A": 7850.0, "C": 2500.0}  # kg/m3, by the first letter of a grade
FACTORS = {  # of dead load, live load and snow
    "ASCE 7-22": {"average": (1.0, 0.5, 0.0), "maximum": (1.2, 1.0, 0.15), "minimum": (0.9, 0, 0)},
    "EN 1998": {"average": (1.0, 0.3, 0.0), "maximum": (1.0, 0.3, 0.2), "minimum": (1.0, 0, 0)},
    "NCh2745": {"average": (1.0, 0.5, 0.0), "maximum": (1.2, 1.0, 0.2), "minimum": (0.8, 0, 0)},
}
MASS = {"ASCE 7-22": (1.0, 0.0, 0.0), "EN 1998": (1.0, 0.3, 0.0), "NCh2745": (1.0, 0.25, 0.0)}


ROLLED = {  # depth, width, flange, web, radius of the fillet [m]
    "HEA 600": (0.59, 0.3, 0.025, 0.013, 0.027),
    "HEM 900": (0.91, 0.302, 0.04, 0.021, 0.03),
}


def area(section):
    """Return the area of a box, a pipe, an I shape or a rolled one [m2]."""
    if "section" in section:
        *shape, fillet = ROLLED[section["section"]]
        return area({"i_shape": shape}) + (4.0 - math.pi) * fillet**2
    if "circle" in section:
        outer, wall = section["circle"]
        return math.pi * wall * (outer - wall)
    if "box" in section:
        *sides, wall = section["box"]
        one, other = sides if len(sides) == 2 else (sides[0], sides[0])
        return one * other - (one - 2.0 * wall) * (other - 2.0 * wall)
    depth, width, flange, web = section["i_shape"]
    return 2.0 * width * flange + (depth - 2.0 * flange) * web


def weight(section, length):
    """Return the weight of members of a section [N]."""
    return GRAVITY * DENSITY[section.get("material", "A992")[0]] * area(section) * length


def cases(project):
    """Return dead load, live load and snow of the whole building [N]."""
    given, loads = project.file["structure"], project.file["loads"]
    (n, m), (a, b) = given["bays"], given["bay_width"]
    storeys, plan = given["storeys"], n * a * m * b
    along = n * a * (m + 1) + m * b * (n + 1)  # of the beams of a level
    height, dead = given["storey_height"], 0.0
    parts = given["columns"]
    for part in parts if isinstance(parts, list) else [parts]:
        first, last = part.get("storeys", (1, storeys))
        dead += weight(part, (n + 1) * (m + 1) * (last - first + 1) * height)
    for rod in given.get("braces", []):
        is_along_y = rod["between"][0][0] == rod["between"][1][0]
        dead += weight(rod, 2.0 * storeys * math.hypot((a, b)[is_along_y], height))
    dead += weight(given["beams"], storeys * along) + weight(given["base_beams"], along)
    roof = loads | loads.get("roof", {})
    dead += plan * (storeys * loads["dead"] + roof["dead"])
    dead += storeys * 2.0 * (n * a + m * b) * loads.get("facade", 0.0)
    live = plan * (storeys * loads.get("live", 0.0) + roof.get("live", 0.0))
    return dead, live, plan * loads.get("snow", 0.0)


def combined(project, each, vertical=None):
    """Return the vertical load of each combination [N] of dead load, live load and snow."""
    found, vertical = {}, upright(project) if vertical is None else vertical
    for name, factors in FACTORS[project.code].items():
        sign = {"maximum": 1.0, "minimum": -1.0}.get(name, 0.0)
        live = factors[1] * (1.0 + sign * vertical * (project.code == "EN 1998"))
        factors = (factors[0] + sign * vertical, live, factors[2])
        found[name] = math.fsum(f * load for f, load in zip(factors, each, strict=True))
    return found


def upright(project, share=0.3):
    """Return the vertical earthquake of the combinations over dead load: of EN 1998 a share."""
    given = project.file["spectrum"]
    if project.code == "ASCE 7-22":
        return 0.2 * given.get("s_ms", 0.0)
    if project.code == "EN 1998":  # the plateau 3 a_vg
        peak = given["a_g"] * given.get("importance", 1.0)
        return share * 3.0 * {1: 0.9, 2: 0.45}[given.get("kind", 1)] * peak / GRAVITY
    top = 0.01 * codes.SOIL[given["soil"]][5] * codes.ZONE[given["zone"]]
    return 0.5 * codes.M_M * top / 2.5 / GRAVITY  # 0.5 C_A at the maximum level


def totals(project, vertical=None):
    """Return the vertical load of each combination [N] where loads are by cases, else nothing."""
    if "loads" in project.file:
        return combined(project, cases(project), vertical)
    if project.file["structure"]["kind"] in {"etabs", "sap2000"}:
        dead, live, _ = imported.model(project).cases()
        return combined(project, (dead, live, 0.0), vertical)
    return {}


def compare(project, tally):
    """Hold the weight that the bearings carry, and the seismic mass, against the count."""
    if project.file["structure"]["kind"] in {"etabs", "sap2000"}:
        imported.compare(project, tally, totals(project)["average"])
    if "loads" not in project.file or "bays" not in project.file["structure"]:
        return
    structure = project.file["structure"]
    if "walls" in structure or "span" in project.file["loads"]:
        return
    name = "loads and masses, by hand"
    tally.category(name, 1e-9, "sums of the same numbers in another order")
    given = project.file["loads"].get("mass")
    shares = MASS[project.code]
    if given is not None:
        shares = given.get("dead", 1.0), given.get("live", 0.0), given.get("snow", 0.0)
    carried = float(project.governing["weight"])
    tally.same(name, "average combination", carried, combined(project, cases(project))["average"])
    dead, live, snow = cases(project)
    mass = (shares[0] * dead + shares[1] * live + shares[2] * snow) / GRAVITY
    for axis in (0, 1, 2):
        own = project.governing["node_mass"][:, axis].sum()
        tally.same(name, f"mass along {'xyz'[axis]}", own, mass)
