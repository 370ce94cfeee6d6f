"""Responses, recorders and recordings of bearings in OpenSees."""

from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

from frames import GroundMotion, lumped_mass, time_history
from frames.plots.plot_loops import hysteresis, orbits
from lir_element import Element
from lir_element.opensees import bearing_response, record_bearings


def begin(stand: Any, **options: Any) -> None:
    stand.build(**options)
    stand.gravity()
    stand.shaking(2.8)


def test_all_names_of_responses(stand: Any) -> None:
    begin(stand)
    stand.run(40)
    for name in Element.responses():
        value = bearing_response(1, name)
        assert np.isfinite(value).all(), name
    assert bearing_response(1, "route") == stand.route
    u = bearing_response(1, "displacement")
    moved = (u[6:] - u[:6])[[2, 0, 1, 5, 3, 4]]  # local x, y, z: the bearing's z, x, y
    assert bearing_response(1, "deformation") == pytest.approx(moved, abs=1e-15)
    with pytest.raises(
        KeyError, match=r"'colour' does not exist: choose one of .*axial_force.*slip"
    ):
        bearing_response(1, "colour")
    with pytest.raises(
        ValueError, match=r"element 9 is not a bearing of the current model.*\(1,\)"
    ):
        bearing_response(9, "slip")


def test_forces_of_the_element_and_reactions(stand: Any) -> None:
    begin(stand)
    stand.run(40)
    ops = stand.ops
    force = bearing_response(1, "force")
    assert np.abs(force[:3]).max() > 1e4
    assert ops.eleResponse(1, "force") == pytest.approx(force, rel=1e-12, abs=1e-6)
    assert ops.eleForce(1) == pytest.approx(force, rel=1e-12, abs=1e-6)
    ops.reactions()
    assert ops.nodeReaction(1) == pytest.approx(force[:6], rel=1e-9, abs=1e-3)


@pytest.mark.parametrize("name", ["slip", "axial_force", "friction_coefficient", "status"])
def test_responses_by_opensees_are_those_by_python(stand: Any, name: str) -> None:
    if stand.route == "portable":
        pytest.skip("the host element knows its forces only")
    begin(stand)
    stand.run(40)
    assert stand.ops.eleResponse(1, name) == pytest.approx(np.ravel(bearing_response(1, name)))


def test_recorders_write_files(stand: Any, tmp_path: Path) -> None:
    names = ["force", "deformation", "slip", "axial_force", "work_friction"]
    if stand.route == "portable":
        names = names[:1]
    stand.build()
    for name in names:
        path = str(tmp_path / f"{name}.txt")
        stand.ops.recorder("Element", "-file", path, "-precision", 12, "-time", "-ele", 1, name)
    recording = record_bearings(1)
    stand.gravity()
    stand.shaking(2.8)
    stand.run(40)
    stand.ops.wipe()
    data = recording.dataset()
    tables = {name: np.loadtxt(tmp_path / f"{name}.txt") for name in names}
    for table in tables.values():
        assert table[:, 0] == pytest.approx(data.time.to_numpy(), abs=1e-9)
    force = data["bearing_force"].isel(bearing=0).to_numpy()
    assert tables["force"][:, 7:10] == pytest.approx(force, rel=1e-9, abs=1e-3)
    if stand.route == "portable":
        return
    moved = data["bearing_displacement"].isel(bearing=0).to_numpy()
    assert tables["deformation"][:, [2, 3, 1]] == pytest.approx(moved, rel=1e-9, abs=1e-13)
    slip = data["interface_slip_size"].isel(bearing=0).to_numpy()
    assert np.hypot(*tables["slip"][:, 1:].T) == pytest.approx(slip, rel=1e-6, abs=1e-12)
    assert tables["axial_force"][:, 1] == pytest.approx(data["axial_force"][:, 0].to_numpy())
    work = data["work_low_friction"].isel(bearing=0).to_numpy()
    assert tables["work_friction"][:, 1:] == pytest.approx(work, rel=1e-9, abs=1e-6)


def test_a_recording_is_the_dataset_of_frames(stand: Any) -> None:
    t = np.arange(0.0, 0.8, 0.001)
    motion = GroundMotion(x=2.8 * np.sin(2.0 * np.pi * t), dt=0.001)
    ours = time_history(lumped_mass(stand.DEVICE, stand.MASS), motion, dt=0.001)
    stand.build()
    stand.gravity(stand.MASS * 9.80665)
    recording = record_bearings()
    stand.shaking(2.8)
    stand.run(len(t) - 1, 0.001)
    data = recording.dataset()
    stand.ops.wipe()
    for name, variable in data.data_vars.items():
        assert variable.attrs["units"], name
        assert variable.attrs["long_name"], name
        if name not in ours:
            continue
        theirs = ours[name].to_numpy()
        if "time" not in variable.dims:
            assert np.array_equal(variable.to_numpy(), theirs, equal_nan=True), name
            continue
        assert variable.dims == ours[name].dims, name
        assert variable.attrs == ours[name].attrs or name == "base_shear", name
        peak = np.abs(theirs).max()
        if name in {
            "bearing_displacement",
            "bearing_force",
            "interface_slip",
            "axial_force",
            "slider_displacement",
            "friction_coefficient",
        }:
            assert np.abs(variable.to_numpy() - theirs[1:]).max() < 0.005 * peak, name
    attributes = data.attrs
    assert attributes["status"] == "ok"
    assert (attributes["level"], attributes["route"]) == ("pendulum", stand.route)
    assert attributes["opensees_version"].startswith("3.")
    assert {"message", "lir_dcfp_version", "record_every", "seconds"} <= set(attributes)


def test_every_so_many_steps_and_after_a_wipe(stand: Any) -> None:
    begin(stand)
    recording = record_bearings(1, every=7)
    with pytest.raises(ValueError, match=r"no committed step .* call ops\.analyze"):
        recording.dataset()
    moved = stand.run(50)
    before = recording.dataset()
    stand.ops.wipe()
    stand.build()  # the old bearing is released here
    after = recording.dataset()
    del before.attrs["seconds"], after.attrs["seconds"]
    assert after.identical(before)
    assert after.attrs["record_every"] == 7
    assert after.time.to_numpy() == pytest.approx(0.01 + 0.07 * np.arange(8))
    kept = after["bearing_displacement"].isel(bearing=0).to_numpy()
    assert np.allclose(kept, moved[::7], rtol=1e-12)


def test_memory_grows_with_the_recording(stand: Any) -> None:
    begin(stand)
    recording = record_bearings()
    assert stand.ops.analyze(6000, 0.001) == 0
    data = recording.dataset()
    assert len(data.time) == 6000
    assert (np.diff(data.time) > 0.0).all()
    assert np.isfinite(data["bearing_force"]).all()
    work = data["work_low_friction"].sum("surface")
    assert (work.diff("time") > -1e-6 * float(work.max())).all()


def test_the_level_contact_has_bodies(stand: Any) -> None:
    stand.build(count=2)
    stand.ops.remove("element", 2)
    stand.put(2, 1, 3, level="contact")
    recording = record_bearings()
    stand.gravity()
    stand.shaking(2.8)
    stand.run(20)
    data = recording.dataset()
    assert data.attrs["level"] == "contact, pendulum"
    assert "body" in data.dims
    sliders = data["body_position"].isel(body=[0, 1])
    assert np.isnan(sliders.sel(bearing="1")).all()
    assert np.isfinite(sliders.sel(bearing="2")).all()
    assert np.abs(sliders.sel(bearing="2", axis="x")).max() > 1e-3


def test_figures_read_a_recording(stand: Any) -> None:
    begin(stand)
    recording = record_bearings()
    stand.run(100)
    data = recording.dataset()
    assert float(data["static_axial_force"][0]) == pytest.approx(float(data["axial_force"][0, 0]))
    for draw in (orbits, hysteresis):
        figure = draw(data, "1")
        lines = figure.axes[0].get_lines()
        assert max(len(line.get_xdata()) for line in lines) >= 100
        plt.close(figure)


def test_a_failed_bearing_is_told_in_the_attributes(stand: Any) -> None:
    stand.build()
    stand.gravity()
    recording = record_bearings()
    stand.shaking(8.0)
    while stand.ops.analyze(1, 0.005) == 0:
        pass
    data = recording.dataset()
    assert data.attrs["status"] in {"slip_exceeded", "rim_overrun"}
    assert "bearing element 1" in data.attrs["message"]
    assert "What to try" in data.attrs["message"]


def test_a_step_that_was_given_up_is_told_in_the_attributes(stand: Any) -> None:
    begin(stand)
    recording = record_bearings()
    stand.run(10)
    assert recording.dataset().attrs["status"] == "ok"
    stand.ops.test("NormDispIncr", 1e-16, 1)
    assert stand.ops.analyze(1, 0.05) == -3
    attributes = recording.dataset().attrs
    assert attributes["status"] == "newton_failed"
    assert "at t = 0.1 s, the model in OpenSees" in attributes["message"]
    assert "analyze gave up the step that follows" in attributes["message"]
    stand.ops.test("NormDispIncr", 1e-9, 100)
    stand.run(1)
    assert recording.dataset().attrs["status"] == "ok"
    assert recording.dataset().attrs["message"] == "completed"


def test_a_trial_without_a_state_is_told_in_the_attributes(stand: Any) -> None:
    begin(stand)
    recording = record_bearings()
    stand.run(10)
    stand.ops.timeSeries("Constant", 5)
    stand.ops.pattern("Plain", 5, 5)
    stand.ops.load(2, 1e13, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert stand.ops.analyze(1, 0.05) != 0
    attributes = recording.dataset().attrs
    stand.ops.wipe()
    assert attributes["status"] in {"not_finite", "sphere_exceeded", "no_equilibrium"}
    assert "bearing element 1" in attributes["message"]
    assert recording.dataset().attrs["status"] == attributes["status"]


def test_refusals_of_recordings(stand: Any) -> None:
    with pytest.raises(ValueError, match="has no bearing: add one by bearing_element"):
        record_bearings()
    stand.build()
    for every in (0, -1, 1.5, "a", None):
        with pytest.raises(ValueError, match=r"every = .* must be an integer of at least 1"):
            record_bearings(1, every=every)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="element 2 is not a bearing"):
        record_bearings(2)
