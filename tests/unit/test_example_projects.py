"""The projects of ``lir new``: their files can be used, whole buildings weigh what they should."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from frames.command.app import app
from frames.design import ProjectError, code_named, equivalent_linear
from frames.design.codes.isolation import with_property_bounds
from frames.design.codes.registry import known_codes
from frames.design.devices.capacity import engagement_checks
from frames.design.devices.device import device_checks
from frames.design.project import example
from frames.design.project.design_run import ProjectRun, run_project
from frames.design.project.example import BUILDINGS, write_example
from frames.design.project.inputs import ProjectInputs
from frames.design.project.reading import read_project
from frames.design.project.sanity_checks import file_doubts
from frames.motion.spectra import response_spectrum
from tests.refusals import refused

CODES = tuple(code.name for code in known_codes() if code.example is not None)


@pytest.fixture
def one_motion(monkeypatch: pytest.MonkeyPatch) -> None:
    # one of the seven: they take a second each to make
    monkeypatch.setattr(example, "PULSES", {"artificial-1": 1.9})


@pytest.mark.parametrize("building", BUILDINGS)
@pytest.mark.usefixtures("one_motion")
def test_whole_building_is_a_project(building: str, tmp_path: Path) -> None:
    written = write_example(tmp_path, building=building)
    assert written[0] == tmp_path / "project.toml"
    assert all(path.is_file() for path in written)
    parts = ProjectInputs(read_project(written[0]), tmp_path)
    assert parts.code().name in BUILDINGS[building]
    assert len(parts.motions()) == 1
    refused(FileExistsError, r"project\.toml", write_example, tmp_path, building=building)
    told = CliRunner().invoke(app, ["new", str(tmp_path / "told"), "--example", building]).output
    assert f"next: lir {'design' if building == 'imported' else 'check'} " in told


def test_unknown_building_and_another_code(tmp_path: Path) -> None:
    with pytest.raises(ProjectError, match=r"example = 'castle': choose one of .*'hospital'"):
        write_example(tmp_path, building="castle")
    with pytest.raises(ProjectError, match="has the code NCh2745: leave --code out"):
        write_example(tmp_path, code="EN 1998", building="hospital")
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize("code", CODES)
@pytest.mark.usefixtures("one_motion")
def test_plain_example_is_sound_before_any_run(code: str, tmp_path: Path) -> None:
    """No check that fails or warns; rims as the code wants them, sliders as makers build them."""
    write_example(tmp_path, code)
    parts = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path)
    assert file_doubts(parts.file) == ()
    frame, bearing, spectrum = parts.frame(), parts.bearing(), parts.spectrum()
    system = parts.system(parts.loaded_frame(), spectrum)
    linear = equivalent_linear(
        system,
        spectrum,
        bounds=parts.bounds(),
        superstructure=parts.superstructure(frame),
        code=parts.code().analysis(),
    )
    assert not linear.checks.failed, linear.checks.failed
    allowed = {each.bound: each.allowed_displacement for each in linear.bounds.values()}
    rims = engagement_checks(bearing, allowed, code=code)
    assert rims
    assert {check.verdict for check in rims} == {"ok"}, rims
    loads = min(system.loads), max(system.loads)
    slip = max(max(allowed.values()) - bearing.lateral_capacity, 0.02)
    of_bearing = device_checks(bearing, loads, slip=slip, bounds=parts.bounds())
    assert of_bearing.passed, of_bearing.failed
    for bound in ("lower", "nominal", "upper"):
        device = with_property_bounds(frame, bound, parts.bounds()).bearings["bearing-0-0"].bearing
        assert device.slip_stability >= bearing.slider_radius  # a slip of the whole overlap holds
    assert bearing.slider_radius >= 0.2
    pressures = np.array(system.loads) / (np.pi * bearing.slider_radius**2)
    assert 20e6 < pressures.max() < 60e6
    assert pressures.mean() > 10e6


@pytest.mark.nightly
@pytest.mark.parametrize("code", CODES)
def test_plain_example_runs_to_the_end_and_is_sound(code, tmp_path, monkeypatch):
    """`lir new`, `lir run` as they are: all motions, bounds and ways at the level "contact"."""
    runs = []

    def kept(*given: Any, **options: Any) -> ProjectRun:
        runs.append(run_project(*given, **options))
        return runs[-1]

    monkeypatch.setattr("frames.design.project.design_run.run_project", kept)
    command, folder = CliRunner().invoke, tmp_path / "plain"
    done = command(app, ["new", str(folder), "--code", code])
    assert done.exit_code == 0, done.output
    done = command(app, ["run", str(folder / "project.toml"), "--results", str(folder / "results")])
    assert done.exit_code == 0, done.output
    assert (folder / "results" / "report.html").is_file()
    (run,) = runs
    assert read_project(folder / "project.toml").analysis.level == "contact"
    assert run.checks.passed, run.checks.failed
    assert not run.checks.to_agree, run.checks.to_agree
    assert run.doubts == ()
    assert run.moved


@pytest.mark.usefixtures("one_motion")
def test_vertical_component_follows_two_thirds_at_a_third_of_the_periods() -> None:
    target = code_named("ASCE 7-22").spectrum(s_ms=2.0, s_m1=1.2)
    files = example.motion_files(target, vertical=True)
    assert files["motions.csv"].splitlines()[1].split(",")[1:4] == [
        f"artificial-1-{axis}.txt" for axis in "xyz"
    ]
    values = np.loadtxt(files["artificial-1-z.txt"].splitlines())
    periods = np.geomspace(0.1, 1.0, 20)
    reached = response_spectrum(values, 0.005, periods)["pseudo_acceleration"].to_numpy()
    wanted = 2.0 / 3.0 * np.asarray(target.acceleration(3.0 * periods))
    assert np.abs(reached / wanted - 1.0).mean() < 0.1  # of a real motion, matched by amplitudes


@pytest.mark.nightly  # imported by OpenSees
@pytest.mark.usefixtures("one_motion")
def test_hospital_weighs_what_its_parts_do(tmp_path: Path) -> None:
    pytest.importorskip("openseespy")
    write_example(tmp_path, building="hospital")
    frame = ProjectInputs(read_project(tmp_path / "project.toml"), tmp_path).frame()
    slabs = 12 * 49.0 * (800.0 + 5 * (600.0 + 0.5 * 300.0) + 550.0)  # kg: 12 panels a floor
    columns = 21 * 6 * 3.6 * 0.75 * 0.75 * 2500.0
    beams = 32 * 7.0 * 0.9 * 1.6 * 2500.0 + 6 * 28 * 7.0 * 0.4 * 0.75 * 2500.0  # four lines walled
    walls = 4 * 6 * 7.0 * 3.6 * 0.3 * 2500.0
    weight = 9.81 * (slabs + columns + beams + walls)
    assert frame.check().carried == pytest.approx(weight, rel=1e-9)
