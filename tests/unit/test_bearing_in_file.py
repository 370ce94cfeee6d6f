"""A project's file reaches every field of a bearing, with units."""

import math
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import pytest

from frames.design import ProjectError
from frames.design.project.derived import table_of
from frames.design.project.inputs import ProjectInputs
from frames.design.project.quantities import si
from frames.design.project.reading import read_project, schema
from lir_element import (
    BackupSupport,
    CoulombFriction,
    FrictionHeating,
    LIRBearing,
    PressureDependence,
    VelocityFriction,
)
from lir_element.fields import unit_of
from tests.refusals import refused
from tests.scenes import BOUNDS, MOTIONS, SOIL, STICK, project_head

pytestmark = pytest.mark.plain
REQUIRED: dict[str, tuple[str, Any]] = {
    "radius": ('["1.5 m", "1800 mm"]', (1.5, 1.8)),
    "slider_height": ('"200 mm"', 0.2),
    "slider_radius": ('"20 cm"', 0.2),
    "friction": (
        '[0.05, { f_max = 0.06, f_min = "3 %", rate = "100 s/m" }]',
        (CoulombFriction(0.05), VelocityFriction(0.06, 0.03, 100.0)),
    ),
    "interface_friction": ("0.2", 0.2),
}
GIVEN = {key: text for key, (text, _) in REQUIRED.items()}
OTHERS: dict[str, tuple[str, Any]] = {
    "capacity": ('"180 mm"', 0.18),
    "rims": ('["90 mm", "0.11 m"]', (0.09, 0.11)),
    "axial_stiffness": ('"8000 kN/mm"', 8e9),
    "axial_damping": ('"3 MN s/m"', 3e6),
    "rim_stiffness": ('"800 kN/mm"', 8e8),
    "rim_damping": ('"500 kN s/m"', 5e5),
    "rim_overrun": ('"15 mm"', 0.015),
    "rim_yield_force": ('"2.5 MN"', 2.5e6),
    "rim_hardening": ("0.01", 0.01),
    "flange": ('"80 mm"', 0.08),
    "uplift_capacity": ('"30 mm"', 0.03),
    "backup": (
        '{ drop = "50 mm", friction = 0.25, stiffness = "900 kN/mm" }',
        BackupSupport(drop=0.05, friction=0.25, stiffness=9e8),
    ),
    "slip_capacity": ('"150 mm"', 0.15),
    "design_load": ('"3.5 MN"', 3.5e6),
    "yield_displacement": ('"0.5 mm"', 0.5e-3),
    "interface_yield_displacement": ('"0.02 mm"', 0.02e-3),
    "interface_hold": ('"2 kN"', 2e3),
    "friction_law": ('"bouc-wen"', "bouc-wen"),
    "bouc_wen_exponent": ("3.0", 3.0),
    "torsional_friction": ("false", False),
    "plate_thickness": ('["40 mm", "50 mm"]', (0.04, 0.05)),
    "slider_density": ('"7.8 t/m3"', 7800.0),
    "slider_mass": ('["90 kg", "0.1 t"]', (90.0, 100.0)),
    "slider_inertia": (
        '[["2 kg m2", "3 kg m2"], ["2.5 kg m2", "3.5 kg m2"]]',
        ((2.0, 3.0), (2.5, 3.5)),
    ),
    "contact_points": ("12", 12),
    "allow_weak_interface": ("true", True),
    "pressure_dependence": (
        '{ reference_pressure = "20 MPa", rate = "0.007 1/MPa" }',
        PressureDependence(reference_pressure=20e6, rate=7e-9),
    ),
    "friction_heating": (
        '{ variant = "third", conductivity = "16 W/(m K)", diffusivity = "4 mm2/s", '
        'initial_temperature = "-10 °C", reference_temperature = "293.15 K", '
        'thickness = "30 mm", share = "90 %" }',
        FrictionHeating(
            variant="third",
            conductivity=16.0,
            diffusivity=4e-6,
            initial_temperature=-10.0,
            reference_temperature=20.0,
            thickness=0.03,
            share=0.9,
        ),
    ),
}
HEAD = project_head("One bearing") + STICK + SOIL + MOTIONS + BOUNDS + "[bearing]\n"


def of_file(folder: Path, given: dict[str, str]) -> LIRBearing:
    path = folder / "project.toml"
    path.write_text(HEAD + "\n".join(f"{key} = {value}" for key, value in given.items()))
    return ProjectInputs(read_project(path), folder).bearing()


def flat(value: object) -> list[object]:
    """Return the numbers and words that a value is made of."""
    if isinstance(value, tuple):
        return [one for part in value for one in flat(part)]
    if is_dataclass(value) and not isinstance(value, type):
        return [type(value), *(one for f in fields(value) for one in flat(getattr(value, f.name)))]
    return [value]


def test_every_field_is_tried() -> None:
    assert {*REQUIRED, *OTHERS} == {f.name for f in fields(LIRBearing)}
    assert set(table_of(LIRBearing).model_fields) == {f.name for f in fields(LIRBearing)}


@pytest.mark.parametrize("name", OTHERS)
def test_a_field_of_the_file_arrives(tmp_path: Path, name: str) -> None:
    text, value = OTHERS[name]
    given = GIVEN | {name: text}
    if name != "rims":
        given["capacity"] = OTHERS["capacity"][0]
    found = of_file(tmp_path, given)
    expected = {key: each[1] for key, each in REQUIRED.items()} | {name: value}
    for key, each in expected.items():
        for one, other in zip(flat(getattr(found, key)), flat(each), strict=True):
            is_number = isinstance(other, float)
            assert one == (pytest.approx(other, rel=1e-12) if is_number else other), key
    plain = {f.name: f.default for f in fields(LIRBearing)}
    left = set(plain) - set(expected) - {"capacity"}
    assert all(getattr(found, key) == plain[key] for key in left)


@pytest.mark.parametrize(
    ("text", "law"),
    [
        ("0.05", CoulombFriction(0.05)),
        ('"5 %"', CoulombFriction(0.05)),
        ("{ coefficient = 0.05 }", CoulombFriction(0.05)),
        ('{ f_max = 0.06, f_min = 0.03, rate = "100 s/m" }', VelocityFriction(0.06, 0.03, 100.0)),
    ],
)
def test_friction_is_given_in_each_way(tmp_path: Path, text: str, law: object) -> None:
    found = of_file(tmp_path, GIVEN | {"friction": text, "capacity": '"180 mm"'})
    assert found.frictions == (law, law)


def test_rims_and_interface_can_be_left_out(tmp_path: Path) -> None:
    found = of_file(tmp_path, GIVEN | {"capacity": "inf", "interface_friction": "inf"})
    assert found.is_dcfp
    assert math.isinf(found.lateral_capacity)


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("radius", '["1.5 m", 1.8]', r"bearing\.radius\.1 = 1\.8 has no unit"),
        ("friction", "{ f_max = 0.06, f_min = 0.03 }", r"bearing\.friction\.rate is missing"),
        ("friction", "[0.05]", r"bearing\.friction\.1 is missing"),
        ("slider_height", "inf", r"\[bearing\] slider_height = inf"),
        ("friction_heating", '{ thicknes = "30 mm" }', r'thicknes is not known; is "thickness"'),
        ("friction_heating", '{ initial_temperature = "20 m" }', r"not a unit of temperature"),
        ("friction_heating", "{ initial_temperature = 20 }", r'write "20 C" if that is meant'),
        ("pressure_dependence", '{ rate = "0.007" }', r"rate = .0.007. has no unit"),
        ("contact_points", "true", r"contact_points = true must be a number"),
        ("rims", '"200 mm"', r"\[bearing\].*rims"),
    ],
)
def test_what_is_wrong_is_said_at_its_place(tmp_path, key, text, words):
    given = GIVEN | {"capacity": '"180 mm"', key: text}
    refused(ProjectError, words, of_file, tmp_path, given)


def test_the_section_of_the_page_is_a_bearing(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "project_file.md").read_text(encoding="utf-8")
    section = page.split("    [bearing]\n", 1)[1].split("\n\n", 1)[0]
    given = dict(line.strip().split(" = ", 1) for line in section.splitlines())
    found = of_file(tmp_path, given)
    assert found.friction_heating == FrictionHeating()
    assert found.pressure_dependence == PressureDependence(reference_pressure=20e6)


def test_every_field_of_a_bearing_says_its_unit_and_its_name() -> None:
    for each in fields(LIRBearing):
        assert each.metadata["title"], each.name
        assert ("unit" in each.metadata) == ("float" in each.type and each.name != "friction")
    for kind in (PressureDependence, FrictionHeating, BackupSupport):
        assert all(f.metadata["unit"] for f in fields(kind) if "float" in f.type)
    assert unit_of(LIRBearing, "radius") == "m"
    assert unit_of(LIRBearing, "rim_hardening") == ""
    assert unit_of(VelocityFriction, "rate") == "s/m"
    assert "friction_heating" in schema()
    assert si("68 F", "C", "20 C") == pytest.approx(20.0)
