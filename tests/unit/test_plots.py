"""Figures of a small real analysis, and the numbers behind the section of a bearing."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from numpy.testing import assert_allclose

from frames import GroundMotion, floor_spectrum, moment_frame, plots, time_history
from frames.plots.bearing_drawing import impact_direction, impact_instants
from frames.plots.drawn_device import device_of
from frames.plots.plot_choice import as_systems, label_of, worst_bearing
from frames.plots.plot_style import PALETTE, engineering, wrapped
from frames.results.bearing_geometry import (
    Posture,
    area_of,
    contact_points,
    outlines,
    plane_height,
    posture,
    rim_face,
    rim_gap,
    rim_height,
    slider_axis,
)
from lir_element import LIRBearing, cyclic_test
from lir_element.results.dataset import bearing_coordinates, device_variables
from tests.refusals import refused
from tests.scenes import rimmed_bearing, small_bearing

BEARING = small_bearing(capacity=0.1, friction=0.05, interface_friction=0.1, design_load=250e3)
UNEVEN = rimmed_bearing(radius=(1.0, 0.6), slider_height=0.12, slider_radius=0.1, rims=(0.12, 0.08))
SYSTEMS = {"LIR": BEARING, "rims": BEARING.as_dcfp(), "free": BEARING.as_dcfp(rims=False)}
NAME = "bearing-0-0"


@pytest.fixture(scope="module")
def results() -> dict[str, xr.Dataset]:
    """Three systems under one pulse that brings the sliders to their rims, off both axes."""
    time = np.arange(0.0, 2.0, 0.01)
    pulse = np.where(time < 1.0, np.sin(2.0 * math.pi * time), 0.0)
    motion = GroundMotion(x=1.8 * pulse, y=-0.9 * pulse, dt=0.01, name="pulse")
    found = {}
    for name, bearing in SYSTEMS.items():
        frame = moment_frame((1, 1), 1, bearing=bearing, name=name)
        found[name] = time_history(frame, motion, duration=1.6, dt=0.005)
    assert all(data.attrs["status"] == "ok" for data in found.values())
    assert float(found["LIR"]["interface_slip_size"].max()) > 5e-3  # the pulse meets the rims
    return found


def tilted(angle: float, slip: float = 0.0, plate: float = 0.0) -> Posture:
    """Slider leaning to the left by `angle`: slid to the right on the bottom plate."""
    return Posture(
        np.array([-math.sin(angle), math.cos(angle)]),
        np.array([math.sin(plate), math.cos(plate)]),
        slip,
    )


# --- geometry -----------------------------------------------------------------------------------


@pytest.mark.parametrize("bearing", [BEARING, UNEVEN])
@pytest.mark.parametrize("now", [tilted(0.0), tilted(0.08, 0.02), tilted(-0.1, -0.01, 0.02)])
def test_sliders_and_plates_touch_on_the_spheres(bearing: LIRBearing, now: Posture) -> None:
    bodies, points = outlines(bearing, now), contact_points(bearing, now)
    # The caps are the first points of each outline; the plates' surfaces likewise.
    for slider, plate, centre, radius in (
        ("bottom slider", "bottom plate", "centre bottom", bearing.radii[0]),
        ("top slider", "top plate", "centre top", bearing.radii[1]),
    ):
        for body, count in ((slider, 121), (plate, 242)):
            distance = np.linalg.norm(bodies[body][:count] - points[centre], axis=1)
            assert_allclose(distance, radius, rtol=0.0, atol=1e-9)
    for contact, centre, radius in (
        ("bottom", "centre bottom", bearing.radii[0]),
        ("top", "centre top", bearing.radii[1]),
        ("vertex", "centre top", bearing.radii[1]),
    ):
        size = np.linalg.norm(points[contact] - points[centre])
        assert_allclose(size, radius, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("slip", [0.0, 0.03, -0.03])
def test_sliders_meet_in_one_plane_at_their_height(slip: float) -> None:
    now = tilted(0.07, slip)
    points, bodies = contact_points(UNEVEN, now), outlines(UNEVEN, now)
    lower = points["interface bottom"]
    assert_allclose(points["interface top"] - lower, slip * now.across, rtol=0.0, atol=1e-12)
    for body in ("bottom slider", "top slider"):
        face = bodies[body][-2:]  # the last two points are the plane face
        assert_allclose((face - lower) @ now.axis, 0.0, rtol=0.0, atol=1e-12)
        assert_allclose(
            np.linalg.norm(face[1] - face[0]), 2.0 * UNEVEN.slider_radius, rtol=0.0, atol=1e-12
        )
    height = (points["top"] - points["bottom"]) @ now.axis
    assert_allclose(height, UNEVEN.slider_height, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("surface", [0, 1])
def test_rim_gap_is_zero_where_the_model_has_the_contact(side: float, surface: int) -> None:
    reach, radius = UNEVEN.rim_displacement[surface], UNEVEN.radii[surface]
    now = tilted(side * math.asin(reach / radius))
    assert_allclose(rim_gap(UNEVEN, now, surface), 0.0, rtol=0.0, atol=1e-12)
    assert rim_gap(UNEVEN, tilted(0.99 * side * math.asin(reach / radius)), surface) > 0.0
    # The slider's edge in the picture stands on the face of the rim, in the axes of its plate.
    body = outlines(UNEVEN, now)[("bottom slider", "top slider")[surface]]
    origin = contact_points(UNEVEN, now)["vertex"] if surface else np.zeros(2)
    edges = np.abs(body[[0, 120], 0] - origin[0])
    assert_allclose(edges.max(), rim_face(UNEVEN, surface), rtol=0.0, atol=1e-9)


def test_rim_face_is_near_the_sum_of_reach_and_slider() -> None:
    # Exactly R sin(a + b) with sin a = reach / R, sin b = slider_radius / R.
    for surface, radius in enumerate(UNEVEN.radii):
        reach = UNEVEN.rim_displacement[surface]
        a, b = reach / radius, UNEVEN.slider_radius / radius
        exact = radius * (a * math.sqrt(1.0 - b**2) + b * math.sqrt(1.0 - a**2))
        assert_allclose(rim_face(UNEVEN, surface), exact, rtol=1e-12)
    assert math.isinf(rim_face(BEARING.as_dcfp(rims=False), 0))


def test_area_of_the_slider_section() -> None:
    # A rectangle without the two segments of a circle between its caps and their chords.
    bodies = outlines(BEARING, tilted(0.05, 0.02))
    half, radius = BEARING.slider_radius, BEARING.radii[0]
    angle = math.asin(half / radius)
    sagitta = radius * (1.0 - math.cos(angle))
    segment = radius**2 * (angle - math.sin(angle) * math.cos(angle))
    exact = 2.0 * half * (0.5 * BEARING.slider_height - sagitta) + segment
    for body in ("bottom slider", "top slider"):
        # 120 chords instead of the arc lose (1/120)^2 of the segment
        assert_allclose(area_of(bodies[body]), exact, rtol=1e-5)
    assert_allclose(area_of(np.array([[0, 0], [2, 0], [2, 3], [0, 3.0]])), 6.0, rtol=1e-14)


def test_edges_of_both_sliders_are_equally_high_in_the_picture() -> None:
    for bearing in (BEARING, UNEVEN):
        bodies, height = outlines(bearing, tilted(0.0)), plane_height(bearing)
        low, high = bodies["bottom slider"][0, 1], bodies["top slider"][0, 1]
        assert_allclose(height - low, high - height, rtol=1e-12)
    assert_allclose(plane_height(BEARING), 0.0425, rtol=1e-15)
    assert abs(plane_height(UNEVEN) - 0.06) > 1e-3  # not half the height


def test_rims_leave_room_between_the_plates() -> None:
    height = rim_height(BEARING)
    face = rim_face(BEARING, 0)
    edge = BEARING.radii[0] - math.sqrt(BEARING.radii[0] ** 2 - face**2)
    assert 0.0 < 2.0 * (height + edge) < BEARING.slider_height
    assert rim_height(BEARING.as_dcfp(rims=False)) == 0.0


def test_rim_that_is_pressed_in_is_drawn_moved_outwards() -> None:
    angle = 1.02 * math.asin(BEARING.rim_displacement[0] / BEARING.radii[0])
    now = tilted(angle)
    gap = rim_gap(BEARING, now, 0)
    assert gap < 0.0
    plate = outlines(BEARING, now)["bottom plate"]
    slider = outlines(BEARING, now)["bottom slider"]
    assert_allclose(plate[241, 0], rim_face(BEARING, 0) - gap, rtol=1e-12)
    assert_allclose(slider[120, 0], plate[241, 0], rtol=0.0, atol=1e-12)


# --- geometry from results ----------------------------------------------------------------------


def test_axis_from_results_is_a_unit_vector_and_adds_up(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    axis = slider_axis(data, BEARING, NAME)
    # 1e-6: the bottom plate is fixed, d1 is exact
    assert_allclose(np.linalg.norm(axis, axis=1), 1.0, rtol=0.0, atol=1e-6)
    sliding = data["slider_displacement"].sel(bearing=NAME)
    turned = (axis - [0.0, 0.0, 1.0]) * BEARING.slider_height
    total = sliding.sum("surface").to_numpy() + turned
    total += data["interface_slip"].sel(bearing=NAME).to_numpy()
    u = data["bearing_displacement"].sel(bearing=NAME).to_numpy()
    # what is left is the axial closure of the contact and the turn of the top plate
    assert_allclose(total[:, :2], u[:, :2], rtol=0.0, atol=5e-4)


def test_posture_at_the_contact_closes_the_gap(results: dict[str, xr.Dataset]) -> None:
    data = results["rims"]
    bearing = SYSTEMS["rims"]
    when = impact_instants(data, NAME)
    assert list(when) == [
        "before the impact",
        "rim contact",
        "largest displacement",
        "after the impact",
    ]
    assert list(when.values()) == sorted(when.values())
    plane = impact_direction(data, NAME, when["rim contact"])
    now = posture(data, bearing, NAME, when["rim contact"], plane)
    closure = data["rim_closure"].sel(time=when["rim contact"], bearing=NAME, method=None)
    # the gap is the closure, but for the cosine of the tilt and the direction of the slider
    assert_allclose(rim_gap(bearing, now, 0), -float(closure[0]), rtol=0.0, atol=3e-4)
    before = posture(data, bearing, NAME, when["before the impact"], plane)
    assert rim_gap(bearing, before, 0) > 0.01


def test_slip_of_the_section_is_that_of_the_results(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    slip = data["interface_slip"].sel(bearing=NAME)
    time = float(data["time"][int(np.argmax(np.linalg.norm(slip.to_numpy(), axis=1)))])
    vector = slip.sel(time=time).to_numpy()
    plane = vector[:2] / np.linalg.norm(vector[:2])
    now = posture(data, BEARING, NAME, time, plane)
    # the slider leans a little across the section
    assert_allclose(abs(now.slip), np.linalg.norm(vector), rtol=1e-2)


def test_the_dataset_has_the_geometry_of_its_bearings() -> None:
    devices = {
        "uneven": UNEVEN,
        "thick": replace(UNEVEN, plate_thickness=(0.03, 0.05)),
        "one": BEARING.as_dcfp(),
        "free": BEARING.as_dcfp(rims=False),
    }
    records = np.concatenate([device.to_record() for device in devices.values()])
    data = xr.Dataset(device_variables(records), bearing_coordinates(list(devices)))
    for name, device in devices.items():
        found = device_of(data, name)
        for key in ("radii", "slider_height", "slider_radius", "rim_displacement"):
            assert_allclose(getattr(found, key), getattr(device, key), rtol=1e-12)
        assert found.is_dcfp == device.is_dcfp
        assert_allclose(found.lateral_capacity, device.lateral_capacity, rtol=1e-12)
    refused(ValueError, "the Dataset has no radius", device_of, data.drop_vars("radius"), "one")


def test_a_lifted_bearing_is_drawn_with_its_gap(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"].sel(bearing=[NAME]).copy(deep=True)
    device, plane = device_of(data, NAME), np.array([1.0, 0.0])
    assert posture(data, device, NAME, 0.3, plane).lift == 0.0
    axis = slider_axis(data, device, NAME)[int(np.searchsorted(data["time"], 0.2999))]
    data["axial_force"][:] = 0.0
    data["bearing_displacement"][:] += 0.05 * axis  # the plate moves away along the slider's axis
    now = posture(data, device, NAME, 0.3, plane)
    # less the closure under the load that was there: 250 kN on some 5 GN/m
    assert_allclose(now.lift, 0.05, rtol=0.0, atol=1e-4)
    # the plate's vertex is node j: where the results have it, but for the closure
    moved = data["bearing_displacement"].sel(bearing=NAME, time=0.3, method="nearest").to_numpy()
    vertex = contact_points(device, now)["vertex"]
    assert_allclose(vertex - [0.0, device.slider_height], moved[[0, 2]], rtol=0.0, atol=3e-4)
    figure = plots.bearing_sections(data, NAME, instants=[0.3])
    assert "lifted 49.9 mm" in texts(figure)


def texts(figure: Figure) -> str:
    """All that is written into the panels."""
    return "\n".join(text.get_text() for ax in figure.axes for text in ax.texts)


# --- figures ------------------------------------------------------------------------------------


def test_every_figure_draws_and_is_written(results: dict[str, xr.Dataset], tmp_path: Path) -> None:
    capacity = {"LIR": 0.10, "rims": 0.10, "free": math.inf}
    figures = {
        "level": plots.hysteresis(results, force_limit=0.3),
        "one": plots.hysteresis(results["LIR"], NAME),
        "orbits": plots.orbits(results, capacity=capacity),
        "orbit": plots.orbits(results["free"]),
        "histories": plots.histories(results, tuple(plots.QUANTITIES), limits={"base_shear": 0.1}),
        "window": plots.histories(results["LIR"], "axial_force", NAME, start=0.2, end=0.9),
        "profiles": plots.storey_profiles(results),
        "energy": plots.energy(results),
        "lines": plots.energy(results["LIR"], stacked=False, end=1.0),
        "sections": plots.bearing_sections(results["LIR"], BEARING, NAME),
        "free": plots.bearing_sections(results["free"], SYSTEMS["free"], NAME, {"start": 0.0}),
    }
    for name, figure in figures.items():
        assert isinstance(figure, Figure)
        path = tmp_path / f"{name}.png"
        figure.savefig(path, dpi=50)
        assert path.stat().st_size > 2000


def test_loops_show_the_data_with_units(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    figure = plots.hysteresis(data, NAME)
    left, right = figure.axes
    u = data["bearing_displacement"].sel(bearing=NAME, axis="x").to_numpy()
    force = data["bearing_force"].sel(bearing=NAME, axis="x").to_numpy()
    weight = float(data["static_axial_force"].sel(bearing=NAME))
    assert_allclose(left.lines[0].get_xdata(), 1e3 * u, rtol=1e-12)
    assert_allclose(left.lines[0].get_ydata(), force / weight, rtol=1e-12)
    assert left.get_xlabel() == "displacement x [mm]"
    assert right.get_xlabel() == "displacement y [mm]"
    assert left.get_ylabel() == "force / weight [-]"


def test_energy_areas_add_up_to_the_input(results: dict[str, xr.Dataset]) -> None:
    panel = plots.energy(results["LIR"]).axes[0]
    energy = results["LIR"]["energy"]
    total = energy.sel(term="input").to_numpy()
    drawn = sum(
        energy.sel(term=list(terms)).sum("term").to_numpy() for terms, _, _ in _groups().values()
    )
    assert_allclose(drawn, total, rtol=0.0, atol=1e-4 * np.abs(total).max())
    assert len(panel.collections) == len(_groups())


def _groups() -> dict:
    from frames.plots.plot_summaries import ENERGY_GROUPS

    return ENERGY_GROUPS


def test_systems_keep_their_colours(results: dict[str, xr.Dataset]) -> None:
    figure = plots.histories(results, ("displacement",))
    colours = [line.get_color() for line in figure.axes[0].lines]
    assert colours == list(PALETTE[:3])
    loops = plots.hysteresis(results)
    assert [ax.lines[0].get_color() for ax in loops.axes[::2]] == list(PALETTE[:3])


def test_a_stopped_run_says_so(results: dict[str, xr.Dataset]) -> None:
    cut = (
        results["LIR"].isel(time=slice(0, 100)).assign_attrs(status="slip_exceeded", failed_at=0.5)
    )
    assert label_of("LIR", cut) == "LIR (stopped at 0.50 s)"
    figure = plots.histories({"cut": cut, "whole": results["rims"]}, ("ground_acceleration",))
    assert len(figure.axes[0].lines) == 1  # one ground for both
    assert_allclose(figure.axes[0].get_xlim()[1], 1.6, rtol=1e-9)


def test_worst_bearing_has_the_largest_value(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    peaks = data["axial_force"].max("time")
    name = worst_bearing(data, "axial_force")
    assert float(peaks.sel(bearing=name)) == float(peaks.max())


def test_engineering_units() -> None:
    assert engineering("N", 5e3) == (1.0, "N")
    assert engineering("N", 5e4) == (1e-3, "kN")
    assert engineering("N", 5e7) == (1e-6, "MN")
    assert engineering("m", 0.25) == (1e3, "mm")
    assert engineering("m", 2.5) == (1.0, "m")
    assert engineering("furlong", 1.0) == (1.0, "furlong")


def with_spike(data: xr.Dataset, force: float) -> xr.Dataset:
    """The result with one step of a high base shear along x, over weight."""
    spiked = data.copy(deep=True)
    spiked["base_shear"][100, 0] = force * float(data["weight"])
    return spiked


def test_a_spike_does_not_flatten_the_loops(results: dict[str, xr.Dataset]) -> None:
    plain = np.abs(results["free"]["base_shear"][:, :2]).max() / results["free"]["weight"]
    whole = plots.hysteresis(results["free"])
    assert_allclose(whole.axes[0].get_ylim()[1], 1.06 * float(plain), rtol=1e-12)
    assert not texts(whole)
    spiked = {"free": with_spike(results["free"], -3.21)}
    figure = plots.hysteresis(spiked)
    assert 1.06 * float(plain) < figure.axes[0].get_ylim()[1] < 2.0 * float(plain)
    assert texts(figure) == "▼ −3.21"
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "value of a peak beyond the axis"
    ]
    for limit, end in ((math.inf, 1.06 * 3.21), (0.5, 0.5)):
        panel = plots.hysteresis(spiked, force_limit=limit).axes[0]
        assert_allclose(panel.get_ylim()[1], end, rtol=1e-12)
    history = plots.histories(spiked, "base_shear")
    assert history.axes[0].get_ylim()[1] < 3.0 * float(plain)
    assert texts(history) == "▲ 3.21"
    history = plots.histories(spiked, "base_shear", limits={"base_shear": math.inf})
    assert history.axes[0].get_ylim()[1] > 3.21


def test_a_component_without_motion_has_no_panel(results: dict[str, xr.Dataset]) -> None:
    along = results["LIR"].copy(deep=True)
    for name in ("base_shear", "bearing_displacement", "bearing_force"):
        along[name].loc[{"axis": "y"}] *= 1e-6
    for bearing in (None, NAME):
        figure = plots.hysteresis(along, bearing)
        assert [ax.get_xlabel() for ax in figure.axes] == ["displacement x [mm]"]
        both = plots.hysteresis({"along": along, "LIR": results["LIR"]}, bearing)
        assert len(both.axes) == 4  # one of them moves along y
    five = plots.hysteresis(dict.fromkeys("abcde", along))
    assert [bool(ax.get_xlabel()) for ax in five.axes] == [False, False, True, True, True]


def test_a_quantity_without_any_value_is_left_out_unless_named(results):
    one_piece = {name: results[name] for name in ("rims", "free")}
    assert len(plots.histories(one_piece).axes) == 3  # no interface slip
    assert len(plots.histories(results).axes) == 4
    assert len(plots.histories(one_piece, "interface_slip").axes) == 1


def test_a_window_shows_its_part_alone(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    part = data.sel(time=slice(0.2, 0.6))
    u = part["bearing_displacement"].sel(bearing=NAME, axis="x").to_numpy()
    for figure in (
        plots.hysteresis(data, NAME, start=0.2, end=0.6),
        plots.orbits(data, NAME, start=0.2, end=0.6),
    ):
        drawn = figure.axes[0].lines[0].get_xdata()
        assert len(drawn) == len(u)
        assert_allclose(drawn / drawn[0], u / u[0], rtol=1e-12)
    for figure in (
        plots.histories(data, start=0.2, end=0.6),
        plots.energy(data, start=0.2, end=0.6),
    ):
        assert_allclose(figure.axes[0].get_xlim(), (0.2, 0.6), rtol=1e-12)
    early = plots.storey_profiles(data, end=0.1).axes[1].lines[0].get_xdata()
    assert (early < plots.storey_profiles(data).axes[1].lines[0].get_xdata()).all()
    drawn = plots.bearing_sections(data, NAME, start=0.2, end=0.6)
    times = [float(ax.get_title(loc="left").split("t = ")[1][:-2]) for ax in drawn.axes]
    assert all(0.2 <= time <= 0.6 for time in times)


def test_windows_that_cannot_be_are_refused(results: dict[str, xr.Dataset]) -> None:
    with pytest.raises(ValueError, match="start = 2 s is not before end = 1 s"):
        plots.orbits(results, start=2.0, end=1.0)
    with pytest.raises(
        ValueError, match="start = 7 s: LIR has fewer than two steps there, it goes"
    ):
        plots.energy(results, start=7.0)
    refused(ValueError, "end = nan", plots.hysteresis, results, end=math.nan)


def test_rims_are_drawn_as_the_dataset_has_them(results: dict[str, xr.Dataset]) -> None:
    rim, same, free = plots.orbits(results, NAME).axes
    for panel in (rim, same):
        assert_allclose(panel.patches[0].get_radius(), 100.0, rtol=1e-9)  # mm
    assert not free.patches
    circles = plots.orbits(results, NAME, capacity={"LIR": math.inf, "free": 0.05}).axes
    assert [len(ax.patches) for ax in circles] == [0, 1, 1]
    with pytest.raises(ValueError, match=r"no system 'lir', as capacity has it; known: LIR, rims"):
        plots.orbits(results, capacity={"lir": 0.1})
    assert not plots.orbits(results["LIR"].drop_vars("radius"), NAME).axes[0].patches


def test_a_notebook_shows_a_picture(results: dict[str, xr.Dataset], tmp_path: Path) -> None:
    figure = plots.orbits(results["LIR"])
    picture = figure._repr_png_()
    assert picture.startswith(b"\x89PNG\r\n")
    width, height = (int.from_bytes(picture[k : k + 4], "big") for k in (16, 20))
    assert_allclose((width, height), 110.0 * figure.get_size_inches(), rtol=0.0, atol=1.0)
    figure.savefig(tmp_path / "after.pdf")
    assert (tmp_path / "after.pdf").stat().st_size > 2000


def test_sections_show_the_largest_displacement(results: dict[str, xr.Dataset]) -> None:
    data = results["rims"].copy(deep=True)
    assert "turn of the swing" not in impact_instants(data, NAME)
    u = data["bearing_displacement"].sel(bearing=NAME, axis=["x", "y"])
    assert impact_instants(data, NAME)["largest displacement"] == float(
        data["time"][int(np.argmax(np.linalg.norm(u, axis=1)))]
    )
    data["bearing_displacement"].loc[{"bearing": NAME}][-5:] = [0.501, 0.0, 0.0]  # no contact
    data["rim_force"][-20:] = 0.0
    when = impact_instants(data, NAME)
    assert when["largest displacement"] == float(data["time"][-5])
    assert when["rim contact"] < when["turn of the swing"] < when["largest displacement"]
    figure = plots.bearing_sections(data, NAME, direction=[2.0, 0.0])
    shown = dict(
        zip(
            [ax.get_title(loc="left") for ax in figure.axes],
            [ax.texts[0].get_text() for ax in figure.axes],
            strict=True,
        )
    )
    (text,) = (text for title, text in shown.items() if title.startswith("largest displacement"))
    assert text.startswith("displacement 501 mm")


def test_only_the_bearing_of_the_dataset_is_drawn(results: dict[str, xr.Dataset]) -> None:
    data = results["LIR"]
    by_name = plots.bearing_sections(data, NAME)
    for figure in (plots.bearing_sections(data, BEARING, NAME), plots.bearing_sections(data)):
        for ax, other in zip(figure.axes, by_name.axes, strict=True):
            assert len(ax.patches) == len(other.patches)
            assert_allclose(ax.patches[0].get_xy(), other.patches[0].get_xy(), rtol=0.0, atol=1e-12)
    with pytest.raises(
        ValueError, match=r"not bearing-0-0: its radius is 1 and 0.6 m, that .* 0.75 m"
    ):
        plots.bearing_sections(data, UNEVEN, NAME)
    with pytest.raises(
        ValueError, match=r"its interface_friction is inf 1.*no bearing of the Data"
    ):
        plots.bearing_sections(data, SYSTEMS["free"], NAME)
    mixed = data.copy(deep=True)
    mixed["slider_radius"].loc[{"bearing": NAME}] = 0.09
    with pytest.raises(ValueError, match=r"slider_radius is 0.08 m.* it is that of bearing-0-1"):
        plots.bearing_sections(mixed, BEARING, NAME)
    with pytest.raises(TypeError, match="bearing is a dict: give a LIRBearing, or only the name"):
        plots.bearing_sections(data, {}, NAME)
    refused(ValueError, "two names", plots.bearing_sections, data, NAME, "bearing-0-1")


def test_long_names_fit(results: dict[str, xr.Dataset]) -> None:
    assert wrapped("one two three four", 1.0, 9.0) == "one two three\nfour"
    long = {
        f"an isolation system with a rather long name, number {k}": results["LIR"] for k in range(3)
    }
    for draw in (plots.hysteresis, plots.histories, plots.orbits, plots.energy):
        figure = draw(long)
        figure.draw_without_rendering()
        frame = figure.bbox
        for legend in figure.legends:
            box = legend.get_window_extent()
            assert frame.x0 <= box.x0 < box.x1 <= frame.x1
        titles = [ax._left_title.get_window_extent() for ax in figure.axes[:3]]
        assert all(a.x1 <= b.x0 or a.y0 != b.y0 for a, b in pairwise(titles))
        assert max(box.x1 for box in titles) <= frame.x1


def test_no_figure_needs_pyplot() -> None:
    for path in Path(plots.__file__).parent.glob("*.py"):
        assert "matplotlib.pyplot" not in path.read_text(encoding="utf-8")


def test_bad_requests_are_refused(results: dict[str, xr.Dataset]) -> None:
    with pytest.raises(
        ValueError, match="no quantity 'temperature'; known: displacement, base_shear"
    ):
        plots.histories(results, ("temperature",))
    with pytest.raises(ValueError, match=r"no quantity 'displacment'.*did you mean .displacement"):
        plots.histories(results, "displacment")
    refused(ValueError, "quantities is empty", plots.histories, results, ())
    refused(ValueError, "no quantity 'shear'", plots.histories, results, limits={"shear": 1.0})
    with pytest.raises(ValueError, match=r"limits\['base_shear'\] = 0.0 must be greater than 0"):
        plots.histories(results, limits={"base_shear": 0.0})
    refused(ValueError, "force_limit = -1 must be", plots.hysteresis, results, force_limit=-1)
    for draw in (plots.histories, plots.hysteresis, plots.orbits):
        with pytest.raises(ValueError, match=r"no bearing 'bearing-0-7' in 'LIR'.*did you mean"):
            draw(results, bearing="bearing-0-7")
    with pytest.raises(ValueError, match="no bearing 'west'; known: bearing-0-0, bearing-0-1"):
        plots.bearing_sections(results["LIR"], "west")
    with pytest.raises(ValueError, match="no variable of bearings 'slip'"):
        plots.worst_bearing(results["LIR"], "slip")
    refused(ValueError, "give 1 to 6", as_systems, {})
    refused(TypeError, "systems is a list: give a Dataset", plots.orbits, [results["LIR"]])  # type: ignore[arg-type]
    refused(TypeError, "LIR is a float: give a Dataset", plots.orbits, {"LIR": 1.0})  # type: ignore[dict-item]
    with pytest.raises(ValueError, match="has no dimension 'time', but step"):
        plots.hysteresis(cyclic_test(BEARING, [0.0, 0.01], 250e3))
    with pytest.raises(ValueError, match="has no weight: name a bearing"):
        plots.hysteresis(results["LIR"].drop_vars("weight"))
    with pytest.raises(ValueError, match="instants is empty"):
        plots.bearing_sections(results["LIR"], BEARING, NAME, {})
    with pytest.raises(ValueError, match="instant 'late' = 99 s is outside of the result, 0"):
        plots.bearing_sections(results["LIR"], NAME, instants={"late": 99.0})
    with pytest.raises(ValueError, match="direction = "):
        plots.bearing_sections(results["LIR"], NAME, direction=np.zeros(2))


def test_floor_spectra(results: dict[str, xr.Dataset]) -> None:
    figure = plots.floor_spectra(results, axis="y")
    levels = [str(name) for name in results["LIR"]["level"].to_numpy()]
    assert [panel.get_title(loc="left") for panel in figure.axes] == levels[::-1]
    assert all(len(panel.lines) == len(results) for panel in figure.axes)
    one = plots.floor_spectra(results["LIR"], level=levels[-1]).axes
    x, y = one[0].lines[0].get_data()
    expected = floor_spectrum(results["LIR"], x).sel(level=levels[-1], axis="x")
    assert_allclose(y, expected, rtol=1e-12)
    with pytest.raises(ValueError, match="level = 'attic': the model has the levels base"):
        plots.floor_spectra(results, level="attic")
