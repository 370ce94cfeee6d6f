"""Figures of models: lines bent as members bend, what is drawn, and what is refused."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from mpl_toolkits.mplot3d.art3d import Line3DCollection
from numpy.testing import assert_allclose
from PIL import Image

from frames import Frame, GroundMotion, ModelError, Section, lumped_mass, modes, moment_frame, plots
from frames import time_history as run
from frames.assembly.assemble import assemble
from frames.plots.model_geometry import STATIONS, diaphragm_faces, member_lines
from frames.plots.plot_model import LARGEST
from tests.scenes import simple_bearing

TIME = np.arange(0.0, 1.5, 0.01)
MOTION = GroundMotion(x=1.5 * np.sin(2 * np.pi * TIME), y=0.4 * np.sin(9.0 * TIME), dt=0.01)


BEARING = simple_bearing()


@pytest.fixture(scope="module")
def building():
    frame = moment_frame((2, 1), 1, bearing=BEARING)
    return frame, run(frame, MOTION, dt=0.01)


def cantilever(up):
    frame = Frame("cantilever")
    frame.add_node("foot", 0.0, 0.0, 0.0)
    frame.add_node("low", 0.0, 0.0, 0.1)
    frame.add_node("high", 1.2, 0.9, 3.1)
    frame.fix("foot", "all")
    frame.fix("low", "rx", "ry", "rz")
    frame.add_bearing("one", "foot", "low", BEARING)
    frame.add_member("mast", "low", "high", Section.box(0.3, 0.3, 0.01), up=up)
    frame.add_mass("high", 2e4, (1e3, 1e3, 1e3))
    frame.add_mass("low", 2e4)
    return assemble(frame)


@pytest.mark.parametrize("up", [None, (0.3, 1.0, 0.2)])
def test_a_line_bends_by_the_cubic_of_its_ends(up):
    """Slopes at both ends are those of the nodes, whatever the local axes; in between a cubic."""
    system = cantilever(up)
    turn, shift = np.array([3e-3, -2e-3, 1e-3]), np.array([0.01, -0.02, 0.005])
    u = np.zeros((3, 6))
    u[2] = [*shift, *turn]
    line = member_lines(system.members, system.coordinates, u)[0]
    assert line.shape == (STATIONS, 3)
    start, end = system.coordinates[1], system.coordinates[2]
    assert_allclose(line[0], start, atol=1e-15)
    assert_allclose(line[-1], end + shift, atol=1e-14)
    axis = (end - start) / np.linalg.norm(end - start)
    moved = line - (start + np.linspace(0.0, 1.0, STATIONS)[:, None] * (end - start))
    across = moved - np.outer(moved @ axis, axis)
    t = np.linspace(0.0, 1.0, STATIONS)[:, None]
    length = np.linalg.norm(end - start)
    slope = np.cross(turn, axis) * length  # of a node that turns: its tangent turns with it
    aside = shift - (shift @ axis) * axis
    expected = (3.0 * t**2 - 2.0 * t**3) * aside + (t**3 - t**2) * slope
    assert_allclose(across, expected, atol=1e-14)


def test_a_model_at_rest_and_at_an_instant(building):
    frame, data = building
    rest, moved = plots.model_view(frame), plots.model_view(frame, data, time=0.5, factor=20.0)
    for figure, count in ((rest, 1), (moved, 2)):
        assert isinstance(figure, Figure)
        parts = [c for c in figure.axes[0].collections if isinstance(c, Line3DCollection)]
        assert len(parts) == count
    assert "at 0.500 s, enlarged 20 times" in moved.legends[0].get_title().get_text()
    texts = [text.get_text() for text in moved.legends[0].get_texts()]
    assert texts == ["members", "diaphragms", "bearings", "supports", "masses", "at rest"]
    assert len(diaphragm_faces(frame)) == 4  # two fields of beams, at two levels


def test_the_largest_displacement_shows(building):
    frame, data = building
    title = plots.model_view(frame, data).legends[0].get_title().get_text()
    u = np.linalg.norm(data["bearing_displacement"].to_numpy()[..., :2], axis=-1).max(axis=1)
    at = float(data["time"][int(u.argmax())])
    assert f"at {at:.3f} s" in title
    step = int(u.argmax())
    largest = np.linalg.norm(data["node_displacement"].to_numpy()[step, :, :3], axis=-1).max()
    extent = np.linalg.norm(np.ptp(assemble(frame).coordinates, axis=0))
    assert f"enlarged {LARGEST * extent / largest:.3g} times" in title


def test_a_film_shows_every_twentieth_of_a_second(building, tmp_path):
    frame, data = building
    film = plots.model_film(frame, data, start=0.2, end=0.5, factor=10.0)
    film.save(tmp_path / "model.gif", writer="pillow", dpi=40)
    with Image.open(tmp_path / "model.gif") as picture:
        assert picture.n_frames == 7
    panel = film._fig.axes[0]
    assert panel.texts[-1].get_text() == "0.50 s"
    assert len([c for c in panel.collections if isinstance(c, Line3DCollection)]) == 2
    quick = plots.model_film(frame, data, speed=5.0)
    assert quick._save_count == 6
    for wrong in ({"speed": 0.0}, {"factor": -1.0}, {"start": 90.0}):
        with pytest.raises(ValueError, match=r"speed|factor|9\d"):
            plots.model_film(frame, data, **wrong)
    quick.save(tmp_path / "quick.gif", writer="pillow", dpi=30)


def test_modes(building):
    frame, _ = building
    figure = plots.mode_shapes(frame, 4, "fixed")
    assert len(figure.axes) == 4
    periods = modes(frame, 4, "fixed").periods
    for panel, period in zip(figure.axes, periods, strict=True):
        assert f"{period:.3g} s" in panel.get_title()
    with pytest.raises(ValueError, match="count = 7: draw at most 6 modes"):
        plots.mode_shapes(frame, 7)


def test_bearings_in_plan(building):
    _, data = building
    panel = plots.bearing_plan(data).axes[0]
    circles = [patch for patch in panel.patches if isinstance(patch, Circle)]
    assert len(circles) == data.sizes["bearing"]
    u = np.linalg.norm(data["bearing_displacement"].to_numpy()[..., :2], axis=-1).max(axis=0)
    texts = [text.get_text() for text in panel.texts]
    for name, size, text in zip(data["bearing"].to_numpy(), u, texts, strict=True):
        assert text.startswith(f"{name}\n{100.0 * size / BEARING.lateral_capacity:.0f} %")


def test_one_bearing_in_plan():
    data = run(lumped_mass(BEARING, 3e4), MOTION, dt=0.01)
    assert len(plots.bearing_plan(data).axes[0].texts) == 1


def test_refusals(building):
    frame, data = building
    with pytest.raises(ModelError, match="not computed with this model"):
        plots.model_view(lumped_mass(BEARING, 3e4), data)
    with pytest.raises(ValueError, match=r"time = 9 s lies outside of the result, 0 to 1\.49 s"):
        plots.model_view(frame, data, time=9.0)
    with pytest.raises(ValueError, match="factor = -1 must be positive"):
        plots.model_view(frame, data, factor=-1.0)


def test_twins_share_a_circle():
    frame = Frame("twins")
    frame.add_node("ground", 0.0, 0.0, 0.0)
    frame.add_node("top", 0.0, 0.0, BEARING.height)
    frame.fix("ground", "all")
    frame.fix("top", "rx", "ry", "rz")
    for name in ("left", "right"):
        frame.add_bearing(name, "ground", "top", BEARING)
    frame.add_mass("top", 6e4)
    panel = plots.bearing_plan(run(frame, MOTION, dt=0.01)).axes[0]
    assert len(panel.patches) == 1
    assert panel.texts[0].get_text().startswith("left\nright\n")
