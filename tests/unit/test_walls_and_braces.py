"""Walls and braces of a project's building: closed forms of cantilevers and rods, refusals."""

import math
from pathlib import Path

import pytest

pytest.importorskip("typer")

from frames import Frame, ModelError, Section, gravity, modes
from frames.demo import bearing_for
from frames.design import ProjectError
from frames.design.project.structure_statement import structure_rows
from frames.library.building import build
from frames.library.building_plan import BeamPart, BuildingPlan, ColumnPart, WallPart
from tests.unit.test_structure_file import GRID, MEMBERS, frame_of, parts_of

E, G = 30e9, 12.5e9
CONCRETE = {"elastic_modulus": E, "poisson_ratio": 0.2}
LENGTH, THICKNESS = 6.0, 0.3
WALL = '[[structure.walls]]\nbetween = ["0-0", "0-1"]\nthickness = "300 mm"\nmaterial = "C30/37"\n'
BRACE = '[[structure.braces]]\nbetween = ["0-0", "1-0"]\ncircle = "100 mm"\nmaterial = "S355"\n'


def cantilever(storeys: int, angle: float) -> Frame:
    """Return a wall alone, its mass on top, in a direction of the plan."""
    section = Section.rectangle(THICKNESS, LENGTH, **CONCRETE, density=0.0)
    lines = {"A": (0.0, 0.0), "B": (LENGTH * math.cos(angle), LENGTH * math.sin(angle))}
    wall = WallPart("A", "B", storeys, section)
    plan = BuildingPlan(lines=lines, heights=(3.0,) * storeys, columns=(), beams=(), walls=(wall,))
    frame = build(plan, bearing_for(1000e3), damping=None)
    for line in lines:  # two bearings hold no wall upright across its plane
        frame.fix(f"base-{line}", "rx", "ry", "rz")
        frame.add_mass(f"base-{line}", 50e3)
    frame.add_mass(f"floor-{storeys}-wall-A-B", 100e3, weighs=False)
    return frame


@pytest.mark.parametrize("storeys", [1, 4])
@pytest.mark.parametrize("angle", [0.0, 0.5 * math.pi, 0.6])
def test_period_of_a_cantilever(storeys: int, angle: float) -> None:
    """In its plane and across it: bending and shear of the whole height, on a held base."""
    height = 3.0 * storeys
    area = 5.0 / 6.0 * THICKNESS * LENGTH
    found = modes(cantilever(storeys, angle), 3, bearings="fixed").periods
    for side, other in ((LENGTH, THICKNESS), (THICKNESS, LENGTH)):
        inertia = other * side**3 / 12.0
        flexibility = height**3 / (3.0 * E * inertia) + height / (G * area)
        period = 2.0 * math.pi * math.sqrt(100e3 * flexibility)
        assert min(abs(found / period - 1.0)) < 2e-3


def test_a_wall_stands_on_two_bearings(tmp_path: Path) -> None:
    """A push at the top goes into them as a couple; the floor's load on its arms goes down."""
    frame = frame_of(tmp_path, GRID + MEMBERS + WALL)
    assert "beam-y-floor-1-0-0" not in frame.members
    assert {"wall-3-0-0-0-1", "arm-base-0-0-0-0-0-1"} <= set(frame.members)
    assert "floor-2-wall-0-0-0-1" in frame.diaphragms["floor-2"].nodes
    wall = frame.members["wall-1-0-0-0-1"]
    assert wall.section.inertia_y == pytest.approx(0.3 * 5.0**3 / 12.0)
    assert wall.up == (0.0, 5.0, 0.0)
    bare = frame_of(tmp_path, GRID + MEMBERS).check()
    own = 2500.0 * (0.3 * 5.0 * 10.5 - 5.0 * (3 * 0.3 * 0.5 + 0.5 * 0.8))
    checked = frame.check()
    assert checked.mass == pytest.approx(bare.mass + own)
    assert checked.carried == pytest.approx(checked.weight)
    assert checked.periods[-1] < bare.periods[-1]


def test_loads_on_the_arms_of_walls(tmp_path: Path) -> None:
    """A field at a wall hands its part to the arms."""
    text = GRID.replace('floor_load = "1000 kg/m2"\n', "") + MEMBERS + WALL
    frame = parts_of(tmp_path, text + '[loads]\ndead = "4 kN/m2"\n').frame()
    columns, each = 6 * 3 * 3.5 * 0.4 * 0.6, 2 * 12.0 + 2 * 5.0
    members = columns + each * (3 * 0.3 * 0.5 + 0.5 * 0.8) + 0.3 * 5.0 * 10.5
    weight = 4 * 60.0 * 4e3 + 2500.0 * 9.80665 * members
    assert frame.check().weight == pytest.approx(weight)
    assert gravity(frame).axial_forces.sum() == pytest.approx(weight)


def braced(tmp_path: Path, pattern: str) -> Frame:
    """Return a frame of one bay whose columns hardly bend, with braces in both frames along x."""
    text = """
[structure]
kind = "moment frame"
bays = [1, 1]
bay_width = ["4 m", "4 m"]
storeys = 1
storey_height = "3 m"
floor_load = "1000 kg/m2"
[structure.columns]
material = { E = "200 GPa", nu = 0.3, density = "0 kg/m3" }
[structure.columns.properties]
area = "1 m2"
inertia_y = "10 cm4"
inertia_z = "1000000 cm4"
torsion_constant = "10 cm4"
[structure.beams]
box = ["1 m", "100 mm"]
material = { E = "200 GPa", nu = 0.3, density = "0 kg/m3" }
[structure.base_beams]
box = ["1 m", "100 mm"]
material = { E = "200 GPa", nu = 0.3, density = "0 kg/m3" }
"""
    for iy in (0, 1):
        text += f"""
[[structure.braces]]
between = ["0-{iy}", "1-{iy}"]
pattern = "{pattern}"
circle = "50 mm"
material = {{ E = "200 GPa", nu = 0.3, density = "0 kg/m3" }}
"""
    return frame_of(tmp_path, text)


@pytest.mark.parametrize(("pattern", "rods"), [("up", 2), ("down", 2), ("x", 4)])
def test_period_of_a_braced_frame(tmp_path: Path, pattern: str, rods: int) -> None:
    """Rods of E A / L, leaning 3 in 4, in place of the columns' bending."""
    frame = braced(tmp_path, pattern)
    area = math.pi * 0.05**2 / 4.0
    stiffness = rods * 200e9 * area / 5.0 * (4.0 / 5.0) ** 2
    period = 2.0 * math.pi * math.sqrt(16e3 / stiffness)
    found = modes(frame, 3, bearings="fixed").periods
    assert min(abs(found / period - 1.0)) < 5e-3
    names = {name for name in frame.members if name.startswith("brace")}
    ways = {"up": ("0-0-1-0",), "down": ("1-0-0-0",), "x": ("0-0-1-0", "1-0-0-0")}
    assert {f"brace-1-{way}" for way in ways[pattern]} <= names
    assert len(names) == rods
    rod = frame.members[f"brace-1-{ways[pattern][0]}"]
    assert [set(end) for end in rod.releases] == [{"My", "Mz"}, {"T", "My", "Mz"}]


def test_flexible_diaphragms(tmp_path: Path) -> None:
    """Floors or the base alone held in plan by their beams."""
    head = GRID + MEMBERS
    for key, gone in (("floor_diaphragm", "floor-1"), ("base_diaphragm", "base")):
        frame = frame_of(tmp_path, head + f'{key} = "flexible"\n')
        assert gone not in frame.diaphragms
        assert len(frame.diaphragms) == (1 if key == "floor_diaphragm" else 3)
        assert frame.check().carried == pytest.approx(frame.check().weight)


def test_check_says_walls_and_braces(tmp_path: Path) -> None:
    text = WALL + "cracked = 0.5\nstoreys = [1, 2]\n" + BRACE
    parts = parts_of(tmp_path, GRID + MEMBERS + 'base_diaphragm = "flexible"\n' + text)
    rows = dict(structure_rows(parts.file, parts.frame()))
    assert rows["wall 0-0 to 0-1, storeys 1 to 2, as a wide column"] == (
        "300 mm, C30/37 (E 32.84 GPa), cracked: 0.5 of the bending stiffness"
    )
    assert rows["braces 0-0 to 1-0"] == "crossed, circle 100 mm, S355 (E 210 GPa)"
    assert rows["diaphragm of base"].startswith("none")


REFUSED = {
    "unknown column of a wall": (WALL.replace('"0-1"', '"0-7"'), 'there is no column "0-7"'),
    "one column": (WALL.replace('"0-1"', '"0-0"'), "twice: write two different columns"),
    "wall above": (WALL + "storeys = [2, 3]", "a wall must start"),
    "thick": (WALL.replace("300 mm", "3000 mm"), "more than half of the length"),
    "storeys": (WALL + "storeys = [1, 4]", "within 1 to 3: write"),
    "wall twice": (WALL + WALL.replace('"0-0", "0-1"', '"0-1", "0-0"'), "occurs twice"),
    "over beams": (WALL.replace('"0-0", "0-1"', '"0-0", "2-0"'), "overlap or cross"),
    "material": (WALL.replace('material = "C30/37"\n', ""), "material is missing"),
    "concrete": (WALL.replace('"C30/37"', '"concrete"'), 'material = "concrete" is not known'),
    "unknown column of a brace": (BRACE.replace('"1-0"', '"9-0"'), 'there is no column "9-0"'),
    "brace to itself": (BRACE.replace('"1-0"', '"0-0"'), "twice: write two different columns"),
    "pattern": (BRACE + 'pattern = "k"', "pattern"),
    "brace above": (BRACE + "storeys = [3, 4]", "within 1 to 3: write"),
    "brace section": (BRACE.replace('circle = "100 mm"\n', ""), "has no section"),
    "turned brace": (
        BRACE.replace('circle = "100 mm"', 'box = ["9 cm", "5 mm"]\ndepth_along = "x"'),
        "rods have axial force alone",
    ),
}


@pytest.mark.parametrize(("text", "said"), REFUSED.values(), ids=list(REFUSED))
def test_what_is_refused(tmp_path: Path, text: str, said: str) -> None:
    """Each with what is wrong and what to write."""
    with pytest.raises(ProjectError) as told:
        frame_of(tmp_path, GRID + MEMBERS + text)
    assert said in str(told.value)


def test_plans_whose_parts_do_not_meet() -> None:
    """In Python, too."""
    section = Section.box(0.3, 0.3, 0.01)
    lines = {"A": (0.0, 0.0), "B": (5.0, 0.0)}
    columns = tuple(ColumnPart(line, 1, section) for line in lines)
    beams = tuple(BeamPart("beam", level, "A", "B", section) for level in (0, 1))
    sound = {"lines": lines, "heights": (3.0,), "columns": columns, "beams": beams}
    bearing = bearing_for(500e3)
    assert len(build(BuildingPlan(**sound), bearing).members) == 4  # type: ignore[arg-type]
    for change, said in (
        ({"beams": ()}, "has no base beam"),
        ({"heights": (3.0, 3.0)}, "no column reaches level 2"),
        ({"columns": (*columns, ColumnPart("C", 1, section))}, 'no column line "C"'),
        ({"columns": (*columns, ColumnPart("A", 2, section))}, "storey 2 does not exist"),
        ({"walls": (WallPart("A", "D", 1, section),)}, 'no column line "D"'),
    ):
        with pytest.raises(ModelError, match=said):
            build(BuildingPlan(**(sound | change)), bearing)  # type: ignore[arg-type]
