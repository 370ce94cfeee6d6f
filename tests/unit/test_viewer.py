"""The page of a run in motion: its numbers are those of the Dataset, and what is refused."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

from frames import (
    Frame,
    GroundMotion,
    ModelError,
    floor_acceleration,
    lumped_mass,
    shear_building,
    storey_drift,
    time_history,
    uplift_gap,
)
from frames.assembly.assemble import assemble
from frames.plots.drawn_device import device_of
from frames.plots.model_geometry import member_lines
from frames.results.bearing_geometry import movement, rim_face
from frames.viewer import write_view
from frames.viewer.payload import SHAPE_ERROR, as_shapes, kept_steps
from tests.viewed import BEARING, Judged, building, payload

pytestmark = pytest.mark.meant("eccentricity|settles by|gap|slip")
HALF = 0.51 / 32767  # of the largest: half a step of 16 bits, and rounding


@pytest.fixture(scope="module")
def run() -> tuple[Frame, xr.Dataset]:
    return building()


@pytest.fixture(scope="module")
def whole(run: tuple[Frame, xr.Dataset], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("view") / "view.html"
    write_view(run[1], run[0], path)
    return path


@pytest.fixture(scope="module")
def held(whole: Path) -> dict[str, Any]:
    return payload(whole)


def require_close(found: Any, wanted: Any) -> None:
    """Within half a step of the 16 bits of each history."""
    wanted = np.asarray(wanted, dtype=float)
    assert np.all(np.abs(found - wanted) <= HALF * np.abs(wanted).max(axis=0) + 1e-12)


def test_histories_are_those_of_the_dataset(run, held):
    data = run[1]
    assert_array_equal(held["time"], data["time"])
    axis, horizontal = ["x", "y", "z"], ["x", "y"]
    wanted = {
        "displacement": data["bearing_displacement"].sel(axis=axis),
        "force": data["bearing_force"].sel(axis=horizontal),
        "axial_force": data["axial_force"],
        "slip": data["interface_slip"].sel(axis=axis),
        "gap": uplift_gap(data),
        "rim_force": data["rim_force"],
    }
    for name, values in wanted.items():
        assert float(np.abs(values).max()) > 0.0, name
        require_close(held["bearings"][name], values)
    found = {one["name"]: one["values"] for one in held["responses"]}
    require_close(found["floor acceleration"], floor_acceleration(data).sel(axis=horizontal))
    require_close(found["storey drift"], storey_drift(data))
    require_close(found["base shear"][:, 0], data["base_shear"].sel(axis=horizontal))


def test_contacts_are_those_of_the_dataset(run, held):
    bits, data = held["bearings"]["contacts"], run[1]
    for k, surface in enumerate(("bottom", "top")):
        assert_array_equal(bits & (1 << k) > 0, data["rim_force"].sel(surface=surface) > 0.0)
    assert_array_equal(bits & 8 > 0, data["axial_force"] <= 0.0)
    # where it slides its friction is used up, where not there is some left: in all but the steps
    # at which one turns into the other
    load, static = data["axial_force"], data["static_axial_force"]
    share = (data["interface_force"] / (data["interface_friction"] * load)).to_numpy()
    loaded, slides = (load > 0.2 * static).to_numpy(), bits & 4 > 0
    assert 0.02 < slides[loaded].mean() < 0.5
    assert np.mean(slides[loaded] == (share[loaded] > 0.999)) > 0.97
    # a residual slip that the turning sliders carry along is none (90 % would slide in space)
    left = (data["interface_slip_size"] > 0.01).to_numpy() & (share < 0.5) & loaded
    assert left.sum() > 100
    assert slides[left].mean() < 0.1


def test_extremes_and_geometry_are_exact(run, held):
    data, names = run[1], list(run[1]["bearing"].to_numpy())
    slip = data["interface_slip_size"]
    for k, name in enumerate(names):
        value, at = held["peaks"]["slip"][k]
        assert_allclose(value, float(slip.sel(bearing=name).max()), rtol=1e-9)
        assert at == float(data["time"][int(slip.sel(bearing=name).argmax("time"))])
        assert held["peaks"]["rimTop"][k][0] == float(
            data["rim_force"].sel(bearing=name, surface="top").max()
        )
        assert held["peaks"]["axialLeast"][k][0] == float(data["axial_force"][:, k].min())
        device = held["devices"][k]
        assert device["name"] == name
        assert_allclose(device["radii"], BEARING.radii, rtol=1e-12)
        assert_allclose(device["sliderHeight"], BEARING.slider_height, rtol=1e-12)
        assert_allclose(device["capacity"], BEARING.lateral_capacity, rtol=1e-12)
        assert device["rimFaces"] == [rim_face(device_of(data, name), k) for k in (0, 1)]


def test_nodes_and_members_move_as_the_model_does(run, held):
    """Lines from what the page holds, as its script puts them together, are those of figures."""
    model, data = run
    system, step = assemble(model), int(data.sizes["time"] // 3)
    u = data["node_displacement"].to_numpy()[step]
    found = (held["shapeHistories"][step] @ held["shapes"]).reshape(-1, 6)
    largest = float(np.abs(data["node_displacement"].to_numpy()[..., :3]).max())
    assert_allclose(found[:, :3], u[:, :3], rtol=0.0, atol=2.0 * SHAPE_ERROR * largest)
    members = held["structure"]["members"]
    ends, bending = members["ends"], members["bending"][members["kind"]]
    share = np.linspace(0.0, 1.0, bending.shape[1])[:, None]
    straight = ends[:, None, 0] + share * (ends[:, None, 1] - ends[:, None, 0])
    moved = np.einsum("msck,mk->msc", bending, 3.0 * u[members["nodes"]].reshape(-1, 12))
    wanted = member_lines(system.members, system.coordinates, 3.0 * u)
    assert_allclose(straight + moved, wanted, rtol=0.0, atol=1e-5)  # single precision of 10 m


def test_the_plate_of_a_lifted_bearing_is_where_its_node_is(run):
    """With contact points, too, whose sliding on a surface that is not touched says nothing."""
    data = run[1]
    for name in map(str, data["bearing"].to_numpy()):
        device = device_of(data, name)
        moved = movement(data, device, name)
        length, up = sum(device.radii) - device.slider_height, np.array([0.0, 0.0, 1.0])
        centres = moved.slip + moved.opening - length * moved.axis
        vertex = device.radii[0] * up + centres + device.radii[1] * moved.plate_axis
        u = data["bearing_displacement"].sel(bearing=name).to_numpy()
        lifted = data["axial_force"].sel(bearing=name).to_numpy() <= 0.0
        apart = vertex - (u + device.slider_height * up)
        assert_allclose(apart[lifted], 0.0, atol=1e-9)
        turned = data["body_rotation"].sel(bearing=name, body="top_plate").to_numpy()[lifted]
        leans = np.column_stack([turned[:, 1], -turned[:, 0]])
        assert np.abs(leans).max() > 3e-4
        assert_allclose(moved.plate_axis[lifted, :2], leans, atol=1e-6)
        # before the ground drops: but for the closure of the contact under its load
        assert_allclose(apart[:30], 0.0, atol=1e-3)
        assert not moved.opening[~lifted].any()
        gap = uplift_gap(data).sel(bearing=name).to_numpy()
        assert gap.max() > 0.01
        # the gap of the string and that along the slider's axis, which leans, where it is largest
        most = np.where(lifted, gap, 0.0).argmax()
        rests = (
            abs(np.linalg.norm(moved.axis[most]) - 1.0) < 1e-6
        )  # the slider, on its bottom plate
        assert not rests or moved.lift[most] == pytest.approx(gap[most], rel=0.05)


def test_fewer_steps_keep_extremes_and_say_what_they_miss(run, held, tmp_path):
    model, data = run
    said = write_view(data, model, tmp_path / "thin.html", size=0.1)
    thin = payload(tmp_path / "thin.html")
    kept, recorded = thin["kept"]["steps"], data.sizes["time"]
    assert f"{kept} of {recorded} steps" in said
    assert kept < 0.6 * recorded
    whole = held["bearings"]
    for name in ("displacement", "force", "rim_force", "slip"):
        few, every = thin["bearings"][name], whole[name]
        assert_allclose(few.max(axis=0), every.max(axis=0), atol=2.0 * HALF * np.abs(every).max())
        between = np.apply_along_axis(
            lambda y: np.interp(held["time"], thin["time"], y), 0, few.astype(float)
        )
        error = np.abs(between - every).max() / np.abs(every).max()
        told = thin["kept"]["errors"][name.replace("_", " ").replace("slip", "interface slip")]
        assert_allclose(error, told, rtol=0.01, atol=3.0 * HALF)
    near = held["bearings"]["contacts"] & 11 > 0
    share = np.isin(held["time"], thin["time"])
    assert share[near.any(axis=1)].mean() > 1.3 * share[~near.any(axis=1)].mean()


def test_steps_go_where_lines_miss_most() -> None:
    time = np.linspace(0.0, 1.0, 101)
    bump = np.exp(-(((time - 0.5) / 0.02) ** 2))[:, None]
    kept = kept_steps(time, bump, np.zeros(101, dtype=bool), 12)
    assert {0, 50, 100} <= set(kept)
    assert len(kept) == 12
    assert np.sum((kept >= 44) & (kept <= 56)) >= 8
    two = np.exp(-(((time - 0.25) / 0.03) ** 2)) + np.exp(-(((time - 0.75) / 0.03) ** 2))
    touched = np.abs(time - 0.75) < 0.1
    weighed = kept_steps(time, two[:, None], touched, 24)
    assert np.sum(weighed > 50) >= 1.4 * np.sum(weighed < 50)
    straight = kept_steps(time, time[:, None], np.zeros(101, dtype=bool), 12)
    assert len(straight) <= 12  # a line needs its ends alone
    assert_array_equal(kept_steps(time, bump, np.zeros(101, dtype=bool), 200), np.arange(101))


def test_shapes_hold_what_is_asked() -> None:
    rng = np.random.default_rng(3)
    moves = (rng.normal(size=(50, 4)) @ rng.normal(size=(4, 60))).reshape(50, 10, 6)
    found = as_shapes(moves, 2.0, 1e-9)
    assert found.shapes.shape == (4, 60)
    assert_allclose(found.histories @ found.shapes, moves.reshape(50, -1), atol=1e-9)
    assert as_shapes(0.0 * moves, 2.0, 1e-3).shapes.shape == (0, 60)


@pytest.mark.parametrize("kind", ["mass", "stick", "rigid slider", "no rims"])
def test_other_models_have_a_page(kind: str, tmp_path: Path) -> None:
    """Without members, floors or rims, and with a slider in one piece."""
    motion = GroundMotion(x=1.5 * np.sin(np.arange(0.0, 6.3, 0.1)), dt=0.01)
    if kind == "stick":
        model = shear_building(BEARING, storeys=2, storey_mass=34e3, storey_stiffness=40e6)
    else:
        device = BEARING if kind == "mass" else BEARING.as_dcfp(rims=kind != "no rims")
        model = lumped_mass(device, mass=50e3)
    data = time_history(model, motion)
    write_view(data, model, tmp_path / "view.html")
    held = payload(tmp_path / "view.html")
    device = held["devices"][0]
    assert device["rigid"] == (kind in {"rigid slider", "no rims"})
    assert (device["capacity"] is None) == (kind == "no rims")
    named = [one["name"] for one in held["responses"]]
    assert ("storey drift" in named) == (kind == "stick")
    require_close(held["bearings"]["displacement"], data["bearing_displacement"])


def test_texts_stay_texts_and_nothing_is_fetched(run, tmp_path):
    model, data = run
    evil = "</script><script>alert(1)</script><!-- scripts -->"
    named = data.assign_attrs(title=evil)
    checks = [Judged(title=evil, note="x & y"), Judged("b", "", concerns="bearing-0-1, upper")]
    write_view(named, model, tmp_path / "view.html", checks=checks)
    text = (tmp_path / "view.html").read_text(encoding="utf-8")
    assert "alert(1)</script>" not in text
    found = payload(tmp_path / "view.html")
    assert found["title"] == evil
    assert [check["title"] for check in found["checks"]] == [evil, "b"]
    names = [str(name) for name in data["bearing"].to_numpy()]
    assert [check["bearing"] for check in found["checks"]] == [None, names.index("bearing-0-1")]
    assert not re.findall(r"""(?:src|href)\s*=\s*["'](?!data:)|@import|\bfetch\(["']""", text)
    assert "Permission is hereby granted, free of charge" in text  # three.js, MIT


def test_what_cannot_be_shown_says_what_to_do(run, tmp_path):
    model, data = run
    path = tmp_path / "view.html"
    other = lumped_mass(BEARING, mass=50e3)
    for size in (0.0, -1.0, float("nan")):
        with pytest.raises(ValueError, match=r"size = .* MB must be positive"):
            write_view(data, model, path, size=size)
    with pytest.raises(ModelError, match="was not computed with this model"):
        write_view(data, other, path)
    with pytest.raises(ValueError, match=r"has no rim_force: record all variables of bearings"):
        write_view(data.drop_vars("rim_force"), model, path)
    with pytest.raises(ModelError, match="no node_displacement"):
        write_view(data.drop_vars("node_displacement"), model, path)
    broken = data.copy(deep=True)
    broken["bearing_force"][7, 0, 0] = np.nan
    with pytest.raises(ValueError, match=r"force of step 7 of \d+ is not finite.*slice\(0, 7\)"):
        write_view(broken, model, path)
    with pytest.raises(OSError, match=r"could not be written .* save to another place"):
        write_view(data, model, tmp_path / "nowhere" / "view.html")
    assert not path.exists()
