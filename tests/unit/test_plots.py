"""Figures of a small real analysis, and the numbers behind the section of a bearing."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from numpy.testing import assert_allclose

from frames import GroundMotion, moment_frame, plots, time_history
from frames.plots.bearing_drawing import impact_direction, impact_instants
from frames.plots.bearing_geometry import (
    Posture,
    area_of,
    contact_points,
    interface_height,
    outlines,
    posture,
    rim_face,
    rim_gap,
    rim_height,
    slider_axis,
)
from frames.plots.plot_style import PALETTE, as_systems, engineering, label_of, worst_bearing
from lir_element import CoulombFriction, LIRBearing

BEARING = LIRBearing(
    radius=0.75,
    slider_height=0.085,
    slider_radius=0.08,
    capacity=0.10,
    friction=CoulombFriction(0.05),
    interface_friction=0.10,
    design_load=250e3,
)
UNEVEN = LIRBearing(
    radius=(1.0, 0.6),
    slider_height=0.12,
    slider_radius=0.10,
    rims=(0.12, 0.08),
    friction=CoulombFriction(0.05),
    interface_friction=0.15,
)
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
        assert_allclose(rim_face(UNEVEN, surface), exact, rtol=1e-12, atol=0.0)
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
        assert_allclose(area_of(bodies[body]), exact, rtol=1e-5, atol=0.0)
    assert_allclose(area_of(np.array([[0, 0], [2, 0], [2, 3], [0, 3.0]])), 6.0, rtol=1e-14, atol=0)


def test_interface_moves_where_a_cap_is_higher_than_half_the_slider() -> None:
    flat = LIRBearing(
        radius=(0.30, 5.0), slider_height=0.03, slider_radius=0.10, capacity=0.05,
        friction=CoulombFriction(0.05), interface_friction=0.2,
    )  # fmt: skip
    lower = interface_height(flat)
    caps = [r - math.sqrt(r**2 - 0.1**2) for r in flat.radii]
    assert caps[0] > 0.5 * flat.slider_height
    assert_allclose(lower - caps[0], flat.slider_height - lower - caps[1], rtol=1e-12, atol=0.0)
    assert_allclose(interface_height(BEARING), 0.0425, rtol=1e-15, atol=0.0)


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
    assert_allclose(plate[241, 0], rim_face(BEARING, 0) - gap, rtol=1e-12, atol=0.0)
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
        "before the impact", "rim contact", "largest displacement", "after the impact",
    ]  # fmt: skip
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
    assert_allclose(abs(now.slip), np.linalg.norm(vector), rtol=1e-2, atol=0.0)


# --- figures ------------------------------------------------------------------------------------


def test_every_figure_draws_and_is_written(results: dict[str, xr.Dataset], tmp_path: Path) -> None:
    capacity = {"LIR": 0.10, "rims": 0.10, "free": math.inf}
    figures = {
        "level": plots.hysteresis(results, force_limit=0.3),
        "one": plots.hysteresis(results["LIR"], NAME),
        "orbits": plots.orbits(results, capacity=capacity),
        "orbit": plots.orbits(results["free"]),
        "histories": plots.histories(results, tuple(plots.QUANTITIES), limits={"base_shear": 0.1}),
        "window": plots.histories(results["LIR"], ("axial_force",), NAME, window=(0.2, 0.9)),
        "profiles": plots.storey_profiles(results),
        "energy": plots.energy(results),
        "lines": plots.energy(results["LIR"], stacked=False, window=(0.0, 1.0)),
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
    assert_allclose(left.lines[0].get_xdata(), 1e3 * u, rtol=1e-12, atol=0.0)
    assert_allclose(left.lines[0].get_ydata(), force / weight, rtol=1e-12, atol=0.0)
    assert left.get_xlabel() == "displacement x [mm]"
    assert right.get_xlabel() == "displacement y [mm]"
    assert left.get_ylabel() == "force / weight [-]"


def test_capacity_is_drawn_to_scale(results: dict[str, xr.Dataset]) -> None:
    figure = plots.orbits({"LIR": results["LIR"], "free": results["free"]}, NAME,
                          capacity={"LIR": 0.10, "free": math.inf})  # fmt: skip
    with_rim, without = figure.axes
    factor = 1e3 if "mm" in with_rim.get_xlabel() else 1.0
    assert_allclose(with_rim.patches[0].get_radius(), 0.10 * factor, rtol=1e-12, atol=0.0)
    assert not without.patches


def test_energy_areas_add_up_to_the_input(results: dict[str, xr.Dataset]) -> None:
    panel = plots.energy(results["LIR"]).axes[0]
    energy = results["LIR"]["energy"]
    total = energy.sel(term="input").to_numpy()
    drawn = sum(
        energy.sel(term=list(terms)).sum("term").to_numpy()
        for terms, _ in _groups().values()
    )  # fmt: skip
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
    assert_allclose(figure.axes[0].get_xlim()[1], 1.6, rtol=1e-9, atol=0.0)


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


def test_bad_requests_are_refused(results: dict[str, xr.Dataset]) -> None:
    with pytest.raises(ValueError, match="choose one or more of displacement"):
        plots.histories(results, ("temperature",))
    with pytest.raises(ValueError, match="give 1 to 6"):
        as_systems({})
    with pytest.raises(ValueError, match="instants is empty"):
        plots.bearing_sections(results["LIR"], BEARING, NAME, {})
