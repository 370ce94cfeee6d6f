"""Numbers in other units: what is impossible is refused, what is strange warns, by the unit's name.

Real bearings and structures, from a twentieth of the scale to bridges, pass without a word (a
warning is an error here).
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from frames import Frame, GroundMotion, ModelError, MotionError, Section
from frames.model.sanity_checks import sanity_warnings
from lir_element import CoulombFriction, DesignWarning, LIRBearing, VelocityFriction
from tests.scenes import paper_bearing, small_bearing

PAPER = small_bearing.keywords
NEWHALL = paper_bearing.keywords
LENGTHS = ("radius", "slider_height", "slider_radius", "capacity")


def scaled(device: dict[str, Any], factor: float) -> dict[str, Any]:
    return device | {name: factor * device[name] for name in LENGTHS}


REAL: dict[str, dict[str, Any]] = {
    "the paper's static test": PAPER,
    "the paper's example": NEWHALL,
    "a twentieth of it": scaled(NEWHALL, 0.05),
    "a twentieth without added mass": scaled(NEWHALL, 0.05)
    | {"design_load": 1.5e6 * math.pi * 0.0075**2},
    "a model on a desk": scaled(NEWHALL, 0.08) | {"design_load": 100.0},
    "a house": NEWHALL | {"slider_radius": 0.075, "slider_height": 0.1, "design_load": 90e3},
    "a viaduct": {
        "radius": 3.05,
        "slider_height": 0.35,
        "slider_radius": 0.5,
        "capacity": 0.6,
        "friction": CoulombFriction(0.05),
        "interface_friction": 0.12,
        "design_load": 40e6,
    },
    "the largest of bridges": {
        "radius": 6.2,
        "slider_height": 0.6,
        "slider_radius": 0.9,
        "capacity": 1.3,
        "friction": CoulombFriction(0.06),
        "interface_friction": 0.15,
        "design_load": 60e6,
    },
    "unlike surfaces, one almost flat": {
        "radius": (8.0, 0.6),
        "slider_height": 0.1,
        "slider_radius": 0.1,
        "rims": (0.3, 0.05),
        "friction": (CoulombFriction(0.02), VelocityFriction(0.1, 0.05, 100.0)),
        "interface_friction": 0.25,
    },
    "no rims": NEWHALL | {"capacity": math.inf, "interface_friction": math.inf},
    "stiff and soft seats": NEWHALL | {"axial_stiffness": 2e9, "rim_stiffness": 2e7},
    "thick plates": NEWHALL | {"plate_thickness": (0.05, 0.3), "slider_mass": 40.0},
}


@pytest.mark.parametrize("device", REAL.values(), ids=REAL)
def test_real_bearings_pass(device: dict[str, Any]) -> None:
    assert LIRBearing(**device).describe()


IMPOSSIBLE: dict[str, tuple[dict[str, Any], str]] = {
    "all in mm": (scaled(PAPER, 1e3), r"slider_height = 85 \[m\] must .*85 mm are 0.085 m"),
    "all in cm": (scaled(PAPER, 1e2), r"slider_height = 8.5 \[m\] must .*8.5 cm are 0.085 m"),
    "a small one in mm": (
        scaled(PAPER, 50.0),
        r"slider_height = 4.25 \[m\] must .*4.25 mm are 0.00425 m",
    ),
    "radius in mm": ({"radius": 750.0}, "radius = 750 m .*pendulum of 78 s.*750 mm are 0.75 m"),
    "height in mm": ({"slider_height": 85.0}, r"slider_height = 85 \[m\] must .*85 mm are 0.085 m"),
    "slider in mm": ({"slider_radius": 80.0}, r"slider_radius = 80 \[m\] must .*80 mm are 0.08 m"),
    "capacity in mm": ({"capacity": 175.0}, "capacity = 175 m .*175 mm are 0.175 m"),
    "plates in mm": (
        {"plate_thickness": 30.0},
        r"plate_thickness = 30 \[m\] must .*30 mm are 0.03 m",
    ),
    "stiffness in kN/mm": ({"axial_stiffness": 4730.0}, "4730 kN/mm are 4.73e.09 N/m"),
    "stiffness in kN/m": ({"axial_stiffness": 4.73e6}, r"4.73e\+06 kN/m are 4.73e\+09 N/m"),
    "load in mN": (
        {"design_load": 6e8},
        r"design_load = 6e\+08 N gives a slider pressure of 2.98e\+04 MPa",
    ),
    "mu_h in per cent": ({"interface_friction": 13.0}, "13 % is 0.13"),
    "mm and kN/mm": (scaled(PAPER, 1e3) | {"axial_stiffness": 4730.0}, "85 mm are 0.085 m"),
}
STRANGE: dict[str, tuple[dict[str, Any], str]] = {
    "load in kN": ({"design_load": 603.0}, "pressure of 0.03 MPa .*603 kN are 6.03e.05 N"),
    "load in MN": ({"design_load": 0.6}, "0.6 MN are 6e.05 N"),
    "yield displacement in mm": ({"yield_displacement": 0.25}, "0.25 mm are 0.00025 m"),
    "that of the interface": ({"interface_yield_displacement": 0.01}, "0.01 mm are 1e-05 m"),
    "rim in kN/mm": ({"rim_stiffness": 473.0}, r"473 kN/mm are 4.73e\+08 N/m"),
    "restrainer failure in mm": ({"rim_overrun": 8.0}, "8 mm are 0.008 m"),
    "slip capacity in mm": ({"slip_capacity": 80.0}, "80 mm are 0.08 m"),
    "rate in s/mm": ({"friction": VelocityFriction(0.066, 0.03, 0.02)}, "0.02 s/mm are 20 s/m"),
    "density in t/m3": ({"slider_density": 7.85}, "7.85 t/m3 are 7850 kg/m3"),
    "slider's mass in t": ({"slider_mass": 0.0067}, "0.0067 t are 6.7 kg"),
    "very rough": (
        {"friction": CoulombFriction(0.5), "interface_friction": 0.9},
        "friction of 0.5 is far",
    ),
    "long pendulum": ({"radius": 12.0}, "pendulum of 9.8 s"),
    "softer than a seat": ({"axial_stiffness": 2e7}, "settles by 30.2 mm"),
    "needle": (
        {"slider_height": 0.9, "slider_radius": 0.04, "interface_friction": 0.2},
        "times the slider's diameter",
    ),
}


@pytest.mark.parametrize(("changes", "words"), IMPOSSIBLE.values(), ids=IMPOSSIBLE)
def test_impossible_bearings(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        small_bearing(**changes)


@pytest.mark.parametrize(("changes", "words"), STRANGE.values(), ids=STRANGE)
def test_strange_bearings(changes: dict[str, Any], words: str) -> None:
    with pytest.warns(DesignWarning, match=words):
        small_bearing(**changes)


@pytest.mark.parametrize("law", [(6.6,), (0.066, 6.6, 20.0), (6.6, 3.3, 20.0)])
def test_friction_in_per_cent(law: tuple[float, ...]) -> None:
    make = CoulombFriction if len(law) == 1 else VelocityFriction
    with pytest.raises(ValueError, match=r"6\.6 % is 0\.066"):
        make(*law)


def test_a_flat_surface_is_no_mistake() -> None:
    flat = small_bearing(radius=(1e6, 0.75), capacity=math.inf)
    assert flat.effective_radius > 1e5


@pytest.mark.parametrize(
    ("wave", "dt", "words"),
    [
        (720 * 9.80665, 0.005, "720 g, above any .*720 cm/s2 are 7.2 m/s2"),
        (3000.0, 0.005, "3000 mm/s2 are 3 m/s2"),
        (3.0, 5.0, "dt = 5 s is longer .*5 ms are 0.005 s"),
    ],
)
def test_impossible_motions(wave: float, dt: float, words: str) -> None:
    with pytest.raises(MotionError, match=words):
        GroundMotion(x=[0.0, wave, -wave], dt=dt)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"elastic_modulus": 200e3}, r"2e\+05 MPa are 2e\+11 Pa"),
        ({"elastic_modulus": 30e3}, r"30000 MPa are 3e\+10 Pa"),
        ({"elastic_modulus": 200.0}, r"200 GPa are 2e\+11 Pa"),
        ({"width": 300.0, "depth": 300.0, "thickness": 10.0}, "width = 300 m.*300 mm are 0.3 m"),
    ],
)
def test_impossible_sections(changes: dict[str, float], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        Section.box(**({"width": 0.3, "depth": 0.3, "thickness": 0.01} | changes))


def test_a_section_in_mm() -> None:
    given = {
        "inertia_y": 1.6e8,
        "inertia_z": 1.6e8,
        "torsion_constant": 2.4e8,
        "density": 7850.0,
        "elastic_modulus": 200e9,
        "shear_modulus": 77e9,
    }
    with pytest.raises(ModelError, match=r"area = 11600 m2.*11600 mm2 are 0\.0116 m2"):
        Section(area=11600.0, **given)


def test_a_section_that_stands_for_stiffnesses() -> None:
    """Modulus 1 with E A and E I in the place of A and I; a rigid link without mass."""
    assert Section(2e9, 1e8, 1e8, 1e8, elastic_modulus=1.0, shear_modulus=0.4).area == 2e9
    assert Section(1e6, 1e6, 1e6, 1e6, elastic_modulus=2e11, shear_modulus=8e10).density == 0.0


def portal(scale: float = 1.0, section: Section | None = None, gravity: float = 9.81) -> Frame:
    frame = Frame("portal", gravity)
    for k, (x, z) in enumerate(((0.0, 0.0), (0.0, 3.0), (6.0, 3.0), (6.0, 0.0))):
        frame.add_node(f"n{k}", scale * x, 0.0, scale * z)
    for k in range(3):
        frame.add_member(f"m{k}", f"n{k}", f"n{k + 1}", section or Section.box(0.3, 0.3, 0.01))
    return frame


USUAL_FRAMES = {
    "steel": portal(),
    "tower": portal(60.0, Section.box(3.0, 3.0, 0.1)),
    "a twentieth": portal(0.05, Section.rectangle(0.01, 0.01)),
    "tension rods": portal(1.0, Section.rectangle(0.03, 0.03)),
    "walls": portal(1.0, Section.rectangle(0.3, 6.0, elastic_modulus=30e9, density=2500.0)),
    "timber": portal(1.0, Section.rectangle(0.3, 0.3, elastic_modulus=11e9, density=450.0)),
    "without gravity": portal(gravity=0.0),
}
STRANGE_FRAMES = {
    "in mm": (portal(100.0), "are the coordinates in mm or cm"),
    "sections in mm": (
        portal(1.0, Section(11600.0, 1.6e8, 1.6e8, 2.4e8, 200e9, 77e9)),
        "are the sections in mm or cm",
    ),
    "kPa": (portal(1.0, Section.box(0.3, 0.3, 0.01, elastic_modulus=2e8)), r"2e\+08 kPa"),
    "t/m3": (portal(1.0, Section.box(0.3, 0.3, 0.01, density=7.85)), "7.85 t/m3 are 7850"),
    "g in cm/s2": (portal(gravity=981.0), "981 cm/s2 are 9.81 m/s2"),
    "g in mm/s2": (portal(gravity=9810.0), "9810 mm/s2 are 9.81 m/s2"),
    "g in g": (portal(gravity=1.0), "1 g are 9.807 m/s2"),
}


@pytest.mark.parametrize("frame", USUAL_FRAMES.values(), ids=USUAL_FRAMES)
def test_usual_frames_pass(frame: Frame) -> None:
    assert sanity_warnings(frame) == ()


@pytest.mark.parametrize(("frame", "words"), STRANGE_FRAMES.values(), ids=STRANGE_FRAMES)
def test_strange_frames(frame: Frame, words: str) -> None:
    found = sanity_warnings(frame)
    assert len(found) == 1
    assert words.replace("\\", "") in found[0]


def test_a_bearing_in_m_under_a_frame_in_mm() -> None:
    frame = Frame("mixed")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("base", 0.0, 0.0, 85.0)
    with pytest.raises(ModelError, match=r"coordinates are in m \(85 mm are 0.085 m\)"):
        frame.add_bearing("b", "ground", "base", small_bearing())


def test_warnings_point_at_the_caller() -> None:
    with pytest.warns(DesignWarning) as caught:
        small_bearing(design_load=603.0)
    assert caught[0].filename == __file__
    with pytest.warns(DesignWarning):
        assert replace(small_bearing(), design_load=603.0).resolved()["design_load"] == 603.0


def test_random_usual_bearings_pass() -> None:
    """Sizes, proportions and frictions as they are built, and pressures of 1 to 100 MPa."""
    rng = np.random.default_rng(3)
    for _ in range(300):
        size = 10.0 ** rng.uniform(-1.3, 0.6)
        edge = size * rng.uniform(0.06, 0.2)
        fast = rng.uniform(0.03, 0.15)
        LIRBearing(
            radius=tuple(size * rng.uniform(0.8, 1.25, 2)),
            slider_radius=edge,
            slider_height=edge * rng.uniform(0.6, 1.5),
            capacity=size * rng.uniform(0.05, 0.1),
            friction=VelocityFriction(fast, 0.5 * fast, rng.uniform(5.0, 200.0)),
            interface_friction=2.5 * fast,
            slider_density=rng.uniform(2700.0, 8900.0),
            design_load=10.0 ** rng.uniform(6.0, 8.0) * math.pi * edge**2,
        )
