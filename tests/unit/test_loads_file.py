"""``[loads]`` of a project: dead, live and snow load, their masses and combinations, by hand."""

import re
from pathlib import Path

import numpy as np
import pytest

from frames import Frame, ModelError, gravity
from frames.design import ProjectError, code_named, isolator_combinations
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.sanity_checks import file_doubts
from frames.design.project.structure_statement import structure_rows
from frames.model.axes import fields_of
from tests.refusals import refused
from tests.scenes import STICK
from tests.unit.test_structure_file import GRID, MEMBERS, REST

G = 9.80665
BARE = GRID.replace('floor_load = "1000 kg/m2"\n', "") + MEMBERS
LOADS = """
[loads]
dead = "3 kN/m2"
live = "2 kN/m2"
snow = "1 kN/m2"
roof = { dead = "4 kN/m2", live = "1 kN/m2" }
base = { live = "5 kN/m2" }
facade = "6 kN/m"
"""
AREA, EDGE = 12.0 * 5.0, 2.0 * (12.0 + 5.0)
DEAD = AREA * (3 * 3e3 + 4e3) + 3 * EDGE * 6e3
LIVE = AREA * (5e3 + 2 * 2e3 + 1e3)
SNOW = AREA * 1e3


SPECTRA = {
    "ASCE 7-22": "s_ms = 1.0\ns_m1 = 0.5",
    "EN 1998": 'a_g = "0.25 g"\nground_type = "B"\nkind = 1',
    "NCh2745": 'soil = "II"\nzone = 2',
}


def parts_of(folder: Path, text: str, code: str = "ASCE 7-22") -> ProjectInputs:
    """Return a project with a structure and loads."""
    rest = REST.replace('"ASCE 7-22"', f'"{code}"').replace(SPECTRA["ASCE 7-22"], SPECTRA[code])
    (folder / "project.toml").write_text(rest + text)
    return ProjectInputs(read_project(folder / "project.toml"), folder)


def members_weight(folder: Path) -> float:
    """Return what the members weigh [N], by the test of sections."""
    columns = 6 * 3 * 3.5 * 0.4 * 0.6
    each = 2 * 12.0 + 3 * 5.0
    return 2500.0 * G * (columns + each * (3 * 0.3 * 0.5 + 0.5 * 0.8))


@pytest.mark.parametrize("code", ["ASCE 7-22", "EN 1998", "NCh2745"])
def test_bearings_carry_the_combinations(tmp_path: Path, code: str) -> None:
    """In sum the factors times the loads, typed here by case."""
    parts = parts_of(tmp_path, BARE + LOADS, code)
    spectrum = parts.spectrum()
    system = parts.system(parts.loaded_frame(), spectrum)
    own = DEAD + members_weight(tmp_path)
    rule = code_named(code).loads.combined(spectrum)
    if code == "ASCE 7-22":
        assert rule == isolator_combinations(1.0)
    still = code_named(code).loads.combined(None)
    more = {name: rule[name]["D"] - still[name]["D"] for name in ("maximum", "minimum")}
    # 0.2 S_MS; 30 % of 3 times 0.9 a_g; 0.5 C_A with M_M
    part = {"ASCE 7-22": 0.2, "EN 1998": 0.81 * 0.25, "NCh2745": 0.24 * 11.0 / G}
    assert [more["maximum"], -more["minimum"]] == pytest.approx([part[code]] * 2, rel=1e-4)
    loads = {"average": system.loads, **system.combinations}
    assert set(loads) == {"average", "maximum", "minimum"}
    for name, each in loads.items():
        f = rule[name]
        assert sum(each) == pytest.approx(f["D"] * own + f["L"] * LIVE + f["S"] * SNOW, rel=1e-7)
    share = {"ASCE 7-22": 0.0, "EN 1998": 0.3, "NCh2745": 0.25}[code]
    assert system.seismic_weight == pytest.approx(own + share * LIVE)


def test_time_histories_carry_the_average_with_the_mass_of_the_code(tmp_path: Path) -> None:
    """Mass in plan is not what weighs: half of the live load weighs, none is mass."""
    checked = parts_of(tmp_path, BARE + LOADS).frame().check()
    own = DEAD + members_weight(tmp_path)
    assert checked.carried == pytest.approx(own + 0.5 * LIVE)
    assert checked.mass == pytest.approx(own / G)
    told = LOADS + "mass = { dead = 1.0, live = 0.4, snow = 0.1 }\n"
    more = parts_of(tmp_path, BARE + told).frame().check()
    assert more.mass == pytest.approx((own + 0.4 * LIVE + 0.1 * SNOW) / G)
    assert more.carried == pytest.approx(checked.carried)


def mass_of(frame: Frame) -> np.ndarray:
    """Masses and rotary inertias of the nodes, in the order of the nodes."""
    system = gravity(frame).system
    return np.asarray(system.node_mass)


def test_a_pressure_is_the_floor_load_times_gravity(tmp_path: Path) -> None:
    """Fields of a grid give nodes their tributary area; the moments in the beams are besides."""
    by_mass = parts_of(tmp_path, GRID + MEMBERS).frame()
    by_load = parts_of(tmp_path, BARE + f'[loads]\ndead = "{G} kN/m2"\n').frame()
    assert np.allclose(mass_of(by_load), mass_of(by_mass), rtol=1e-9)
    lumped, spread = (gravity(frame).axial_forces for frame in (by_mass, by_load))
    assert sum(spread) == pytest.approx(sum(lumped))
    assert spread == pytest.approx(lumped, rel=0.05)
    assert abs(spread - lumped).max() > 10.0  # the beams carry their load


def test_one_way_slabs_load_the_beams_across(tmp_path: Path) -> None:
    """Fields that carry along x hand half of their load to each beam along y."""
    frame = parts_of(tmp_path, BARE + '[loads]\ndead = "4 kN/m2"\nspan = "x"\n').loaded_frame()
    masses = {name: load.span for name, load in frame.floor_loads.items()}
    assert set(masses.values()) == {(1.0, 0.0)}
    nodes = mass_of(frame)
    assert nodes[:, 0].sum() == pytest.approx(4 * AREA * 4e3 / G + members_weight(tmp_path) / G)


def test_eccentric_loads(tmp_path: Path) -> None:
    """Their centre moves by the share of each side; sums stay."""
    text = BARE + "eccentricity = [0.05, -0.04]\n" + '[loads]\ndead = "4 kN/m2"\nlive = "2 kN/m2"\n'
    own = members_weight(tmp_path)
    for frame, load in (
        (parts_of(tmp_path, text).frame(), 4e3),
        (parts_of(tmp_path, text, "NCh2745").frame(), 4e3 + 0.25 * 2e3),
    ):
        system = gravity(frame).system
        mass, places = system.node_mass[:, 0], system.coordinates
        centre = mass @ places[:, :2] / mass.sum() - [6.0, 2.5]
        part = 4 * AREA * load / (4 * AREA * load + own)
        assert centre == pytest.approx([part * 0.05 * 12.0, -part * 0.04 * 5.0])
        assert mass.sum() == pytest.approx((4 * AREA * load + own) / G)
    with pytest.raises(ProjectError, match="without load"):
        parts_of(tmp_path, text.replace("0.05,", "0.45,")).frame()


REFUSED = {
    'floor_load = "500 kg/m2"\n[loads]\ndead = "3 kN/m2"': "both give the weight",
    "": "floor_load is missing: write the mass of the floors",
    '[loads]\nlive = "3 kN/m2"': "loads.dead is missing",
    '[loads]\ndead = "450 kg/m2"': 'is in "kg/m2", not a unit of N/m2: write a number in kN/m2',
    '[loads]\ndead = "-3 kN/m2"': "must be at least 0",
    '[loads]\ndead = "0 kN/m2"': "floors weigh more",
    '[loads]\ndead = "3 kN/m2"\nmass = { live = 25 }': "loads.mass.live",
    '[loads]\ndead = "3 kN/m2"\nmass = { dead = 0.0 }': "dead must be greater than 0",
    '[loads]\ndead = "3 kN/m2"\nspan = "z"': "loads.span",
    '[loads]\ndead = "3 kN/m2"\nfacade = "3 kN"': "a number in kN/m",
    STICK + '[loads]\ndead = "3 kN/m2"\n': "has its own masses and loads",
    GRID.replace("1000 kg/m2", "4.5 kN/m2"): "is a pressure, and floor_load a mass",
}


@pytest.mark.parametrize(("text", "said"), REFUSED.items(), ids=list(REFUSED.values()))
def test_what_is_refused(tmp_path: Path, text: str, said: str) -> None:
    """Each with what is wrong and what to write."""
    structure = text if text.startswith("\n[structure]") else BARE + text
    if "pressure" in said:
        structure = text + MEMBERS
    refused(ProjectError, re.escape(said), lambda: parts_of(tmp_path, structure).frame())


def test_check_says_the_loads(tmp_path: Path) -> None:
    """What counts as mass and by whose rule; a doubt where the unit must be wrong."""
    parts = parts_of(tmp_path, BARE + LOADS, "NCh2745")
    rows = dict(structure_rows(parts.file, parts.frame()))
    assert rows["loads of roof, besides the members"] == "dead 4, live 1, snow 1 kN/m²"
    assert rows["loads of base, besides the members"] == "dead 3, live 5 kN/m²"
    assert rows["seismic mass"].startswith("members, 1 D + 0.25 L (NCh433")
    assert rows["average combination, no horizontal earthquake"] == "1 D + 0.5 L"
    (doubt,) = file_doubts(parts_of(tmp_path, BARE + '[loads]\ndead = "3 N/m2"\n').file)
    assert "dead over gravity is 0.306 kg" in doubt


@pytest.mark.parametrize(
    "spectrum",
    [
        "s_ms = 1.0",
        'points = [["0 s", "0.4 g"], ["0.3 s", "1 g"], ["5 s", "0.1 g"]]\ns_ms = 1.0',
        'points = [["0 s", "0.4 g"], ["0.3 s", "1 g"], ["5 s", "0.1 g"]]',
    ],
)
def test_the_statement_has_the_combinations_that_are_analysed(tmp_path, spectrum):
    """Of a spectrum by points too: 1.2 D + 0.2 S_MS D, and 0.9 D less the same."""
    parts = parts_of(tmp_path, BARE + LOADS)
    text = (tmp_path / "project.toml").read_text()
    new = spectrum if "points" in spectrum else SPECTRA["ASCE 7-22"]
    (tmp_path / "project.toml").write_text(text.replace(SPECTRA["ASCE 7-22"], new))
    parts = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path)
    rows = dict(structure_rows(parts.file, parts.frame(), parts.spectrum()))
    s_ms = parts.spectrum().parameters["S_MS"]
    assert s_ms == pytest.approx(1.0 if "s_ms" in spectrum else 0.9, abs=0.01)
    for name, factors in isolator_combinations(s_ms).items():
        said = " + ".join(f"{value:g} {case}" for case, value in factors.items() if value > 0.0)
        assert rows[f"{name} combination, no horizontal earthquake"] == said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('live = "3000 kN/m2"', "live = 3000 kN/m2 is more than 25"),
        ('snow = "30 kN/m2"', "snow = 30 kN/m2 is more than 25"),
        ('facade = "600 kN/m"', "facade = 600 kN/m is more than 60"),
        ("", ""),
    ],
)
def test_loads_in_another_unit_are_doubted(tmp_path: Path, text: str, said: str) -> None:
    doubts = file_doubts(parts_of(tmp_path, BARE + f'[loads]\ndead = "4 kN/m2"\n{text}\n').file)
    assert said in " ".join(doubts)
    assert len(doubts) == bool(said)


def test_fields_of_an_l_shaped_plan() -> None:
    """Three fields of four squares; eight outer edges, and a corner that points inwards."""
    points = {f"{x}{y}": (float(x), float(y)) for x in range(3) for y in range(3)}
    points.pop("22")
    apart = {(a, b): np.subtract(points[a], points[b]) for a in points for b in points if a < b}
    beams = [pair for pair, way in apart.items() if np.hypot(*way) == pytest.approx(1.0)]
    found = fields_of(points, beams, "floor-1")
    fields = ("00 10 11 01", "10 20 21 11", "01 11 12 02")
    assert {frozenset(x) for x in found.corners} == {frozenset(x.split()) for x in fields}
    assert len(found.outer) == 8
    loose = fields_of(points | {"a": (-1.0, 0.0)}, [*beams, ("00", "a")], "floor-1")
    assert loose == found  # a beam that ends alone encloses nothing


def test_a_corner_on_a_straight_edge_is_none() -> None:
    points = {"a": (0.0, 0.0), "b": (2.0, 0.0), "c": (1.0, 0.0), "d": (0.0, 1.0)}
    found = fields_of(points, [("a", "c"), ("c", "b"), ("b", "d"), ("d", "a")], "floor-1")
    assert [set(each) for each in found.corners] == [{"a", "b", "d"}]


CROSSING = {
    "across": [("a", "c"), ("b", "d")],
    "on each other": [("a", "c"), ("a", "e")],
    "through an end": [("b", "d"), ("a", "m")],
    "twice": [("a", "b"), ("b", "a")],
    "on one line": [("a", "e"), ("m", "c")],
}


@pytest.mark.parametrize("beams", CROSSING.values(), ids=list(CROSSING))
def test_beams_that_overlap_are_refused(beams: list[tuple[str, str]]) -> None:
    """At a common end alone beams may meet."""
    points = {"a": (0.0, 0.0), "b": (2.0, 0.0), "c": (2.0, 2.0), "d": (0.0, 2.0)}
    points |= {"m": (1.0, 1.0), "e": (1.5, 1.5)}
    refused(ModelError, "overlap or cross", fields_of, points, beams, "floor-1")
    assert not fields_of(points, [("a", "b"), ("b", "c")], "floor-1").corners
