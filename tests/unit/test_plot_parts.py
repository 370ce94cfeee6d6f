"""Figures of what yields: links and hinges of a model, their loops, states and energies."""

from io import BytesIO

import numpy as np
import pytest
from matplotlib.colors import to_hex
from numpy.testing import assert_allclose

from frames import (
    GroundMotion,
    Recording,
    Section,
    lumped_mass,
    moment_frame,
    plots,
    shear_building,
    time_history,
)
from frames.laws import Bilinear, Gap, PlasticHinge, Tie, ViscousDamper
from frames.plots.model_geometry import HINGES, KINDS, SHARE
from frames.plots.plot_parts import COLOURS
from frames.plots.plot_summaries import ENERGY_GROUPS
from tests.scenes import simple_bearing

TIME = np.arange(0.0, 2.0, 0.01)
PULSE = np.where(TIME < 1.2, np.sin(2.0 * np.pi * TIME / 1.2), 0.0)
MOTION = GroundMotion(x=3.0 * PULSE, y=1.0 * PULSE, dt=0.01, name="pulse")
GAP = 0.06


def bearing():
    return simple_bearing(capacity=0.3).as_dcfp(rims=False)


def building():
    """Return a small frame that yields, in a moat, with a brace, a rod and a damper."""
    frame = moment_frame(
        (1, 1),
        1,
        bearing=bearing(),
        name="small",
        hinges={"column": PlasticHinge(moment_y=1.2e5, moment_z=1.2e5)},
    )
    frame.add_moat("moat", ["base-0-0"], {"x+": Gap(gap=GAP, stiffness=1e8, damping=1e5)})
    brace = Bilinear(stiffness=2e7, yield_force=4e4, hardening=0.02)
    frame.add_link("brace", "base-0-0", "floor-1-1-0", brace)
    frame.add_link("rod", "base-0-1", "floor-1-1-1", Tie(stiffness=1e7, yield_force=2e4))
    frame.add_link("damper", "base-1-0", "floor-1-1-0", ViscousDamper(coefficient=1e5), "ux")
    return frame


@pytest.fixture(scope="module")
def run():
    frame = building()
    data = time_history(frame, MOTION, dt=0.005)
    assert data.attrs["status"] == "ok"
    sizes = np.linalg.norm(data["hinge_rotation"].to_numpy()[..., 1:], axis=-1).max(axis=0)
    assert (sizes > 1e-4).sum() > 1
    assert float(data["link_force"].sel(link="moat-base-0-0-x+").max()) > 1e5
    return frame, data, sizes


def labels(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def faces_of(figure):
    """Return the colours of the circles, as drawn."""
    figure.savefig(BytesIO(), dpi=30)
    return [to_hex(face) for face in figure.axes[0].collections[-1].get_facecolor()]


def marked(panel, colour, marker=None):
    """Return the lines of a colour in a panel, and of a marker."""
    found = [line for line in panel.lines if to_hex(line.get_color()) == to_hex(colour)]
    return found if marker is None else [one for one in found if one.get_marker() == marker]


def test_every_kind_of_link_is_marked_and_named(run):
    frame, _, _ = run
    figure = plots.model_view(frame)
    named = ["yielding links", "ties", "dampers", "walls, stops", "plastic hinges"]
    assert [label for label in labels(figure) if label in named] == named
    panel = figure.axes[0]
    for kind, name in zip(KINDS[:3], ("brace", "rod", "damper"), strict=True):
        (mark,) = marked(panel, kind.colour, kind.mark)
        link = frame.links[name]
        ends = [frame.nodes[node].position for node in (link.i, link.j)]
        assert_allclose(np.ravel(mark.get_data_3d()), np.mean(ends, axis=0))


def test_a_damper_across_its_nodes_has_a_tick_along_its_direction(run):
    """The damper acts along x between nodes over one another: line, tick and mark."""
    panel = plots.model_view(run[0]).axes[0]
    lines = [np.array(line.get_data_3d()) for line in marked(panel, KINDS[2].colour)]
    tick = lines[1][:, 1] - lines[1][:, 0]
    assert [line.shape[1] for line in lines] == [2, 2, 1]
    assert tick[0] > 0.1
    assert_allclose(tick[1:], 0.0, atol=1e-12)


def test_a_wall_stands_at_its_gap_enlarged_as_displacements_are(run):
    frame, data, _ = run
    corner = frame.nodes["base-0-0"].x
    for figure, factor in (
        (plots.model_view(frame), 1.0),
        (plots.model_view(frame, data, factor=7.0), 7.0),
    ):
        (wall,) = marked(figure.axes[0], KINDS[3].colour)
        x, y, _ = (np.asarray(part) for part in wall.get_data_3d())
        assert_allclose(x, corner + factor * GAP)
        assert np.ptp(y) > 0.1  # across the direction


def test_plastic_hinges_are_told_from_releases(run):
    frame = run[0].copy("both")
    free = {"i": ("My", "Mz"), "j": ("My", "Mz")}
    frame.add_member("strut", "base-0-0", "floor-1-0-1", Section.circle(0.1, 0.01), releases=free)
    figure = plots.model_view(frame)
    assert {"releases", "plastic hinges"} <= set(labels(figure))
    (rings,) = [line for line in figure.axes[0].lines if line.get_fillstyle() == "none"]
    (dots,) = [
        line
        for line in figure.axes[0].lines
        if line.get_markerfacecolor() == HINGES["markerfacecolor"]
    ]
    assert len(rings.get_data_3d()[0]) == 2
    places = np.array(dots.get_data_3d()).T
    assert len(places) == 2 * 4
    foot, head = (np.array(frame.nodes[f"{level}-0-0"].position) for level in ("base", "floor-1"))
    assert_allclose(places[0], foot + SHARE * (head - foot))


def test_a_film_of_a_model_with_links_and_hinges(run, tmp_path):
    frame, data, _ = run
    film = plots.model_film(frame, data, start=0.2, end=0.4)
    film.save(tmp_path / "film.gif", writer="pillow", dpi=30)
    assert len(marked(film._fig.axes[0], KINDS[3].colour)) == 1  # the last picture's alone


@pytest.mark.parametrize("time", [None, 1.5])
def test_hinges_are_coloured_by_their_rotation(run, time):
    frame, data, sizes = run
    if time is not None:
        vectors = data["hinge_rotation"].sel(time=time, method="nearest").to_numpy()
        sizes = np.linalg.norm(vectors[:, 1:], axis=-1)
    figure = plots.hinge_map(frame, data, time)
    yielded = int((sizes > 1e-9).sum())
    assert labels(figure) == [f"elastic: {len(sizes) - yielded}", f"yielded: {yielded}"]
    faces = faces_of(figure)
    assert len(faces) == len(sizes)
    assert faces.count("#ffffff") == len(sizes) - yielded
    assert yielded > 2
    bar = figure.axes[1]
    assert bar.get_ylabel() == "plastic rotation [rad]"
    assert bar.get_ylim() == pytest.approx((0.0, sizes.max()))


def test_hinges_are_coloured_by_acceptance_limits(run):
    """Limits between the rotations that were reached: the legend counts as sorting does."""
    frame, data, sizes = run
    order = np.sort(sizes[sizes > 1e-9])
    io, cp = 0.5 * (order[0] + order[1]), 0.5 * (order[-2] + order[-1])
    figure = plots.hinge_map(frame, data, limits=(io, 0.5 * (io + cp), cp))
    counts = [int(text.split(": ")[1]) for text in labels(figure)]
    assert counts[0] == (sizes <= 1e-9).sum()
    assert (counts[1], counts[4]) == (1, 1)
    assert sum(counts) == len(sizes)
    assert len(figure.axes) == 1  # no bar
    assert faces_of(figure).count(COLOURS[4].lower()) == 1


def test_a_map_of_a_run_that_kept_its_extremes_alone(run):
    frame, data, _ = run
    short = time_history(frame, MOTION, dt=0.005, recording=Recording.peaks())
    maps = [plots.hinge_map(frame, each) for each in (data, short)]
    assert labels(maps[0]) == labels(maps[1])
    assert faces_of(maps[0]) == faces_of(maps[1])


def test_loops_of_links_are_those_of_the_data(run):
    _, data, _ = run
    figure = plots.link_loops(data, ["brace", "damper"])
    for panel, name in zip(figure.axes, ("brace", "damper"), strict=True):
        line = panel.lines[0]
        assert_allclose(line.get_xdata(), 1e3 * data["link_deformation"].sel(link=name))
        assert_allclose(line.get_ydata(), 1e-3 * data["link_force"].sel(link=name))
        assert panel.get_title(loc="left") == name
    assert figure.axes[0].get_ylabel() == "force [kN, kN m]"
    limits = [line.get_xdata()[0] for line in figure.axes[0].lines[1:]]
    sides = data["link_force"].sel(link="brace")
    reached = [sign * 2.0 for sign in (-1.0, 1.0) if float((sign * sides).max()) > 4e4]
    assert_allclose(limits, reached)  # mm at yield
    assert len(figure.axes[1].lines) == 1
    rod = plots.link_loops(data, "rod").axes[0]
    assert [line.get_xdata()[0] for line in rod.lines[1:]] == pytest.approx([2.0])  # pulls only


def test_links_that_took_up_work_are_shown_unless_named(run):
    _, data, _ = run
    titles = [panel.get_title(loc="left") for panel in plots.link_loops(data).axes]
    worked = abs(data["link_work"].isel(time=-1)) > 0.0
    assert titles == [str(name) for name in data["link"].to_numpy()[worked.to_numpy()]]
    both = plots.link_loops({"one": data, "two": data}, "brace", start=0.5)
    assert [text.split(" (")[0] for text in labels(both)] == ["one", "two"]
    assert (
        float(both.axes[0].lines[0].get_xdata().size) == data.sel(time=slice(0.5, None)).time.size
    )


def test_energies_of_parts_are_drawn_where_there_are_any(run):
    _, data, _ = run
    figure = plots.energy(data)
    assert {"yielding", "dampers", "stops, walls"} <= set(labels(figure))
    assert len(figure.axes[0].collections) == len(ENERGY_GROUPS) + 3
    tops = [area.get_paths()[0].get_extents().y1 for area in figure.axes[0].collections]
    total = float(data["energy"].sel(term="input").max())
    assert max(tops) == pytest.approx(1e-3 * total, rel=1e-3)
    plain = time_history(lumped_mass(bearing(), 3e4), MOTION, dt=0.01)
    assert not {"yielding", "dampers", "stops, walls"} & set(labels(plots.energy(plain)))


def test_a_stick_without_members(tmp_path):
    """Springs and links alone: storeys that yield stand beside their axial springs."""
    stick = shear_building(
        bearing(), [3e4] * 2, [3e7] * 2, storey_law=lambda k: Bilinear(stiffness=k, yield_force=3e4)
    )
    data = time_history(stick, MOTION, dt=0.01)
    for figure in (
        plots.model_view(stick),
        plots.model_view(stick, data),
        plots.mode_shapes(stick),
    ):
        assert "yielding links" in labels(figure)
        assert "members" not in labels(figure)
    ticks = [
        np.ptp(np.array(line.get_data_3d()), axis=1).argmax()
        for line in marked(plots.model_view(stick).axes[0], KINDS[0].colour, "None")
    ]
    assert ticks == [2, 0, 2, 1] * 2  # line and tick of each storey's two links


def test_refusals(run):
    frame, data, _ = run
    plain = moment_frame((1, 1), 1, bearing=bearing())
    elastic = time_history(plain, MOTION, dt=0.01)
    with pytest.raises(ValueError, match="the model has no plastic hinges"):
        plots.hinge_map(plain, elastic)
    with pytest.raises(ValueError, match=r"time = 9 s lies outside of the result, 0 to 1\.99"):
        plots.hinge_map(frame, data, 9.0)
    for limits in ((0.01, 0.02), (0.02, 0.01, 0.03), (0.0, 0.01, 0.02), (0.01, np.nan, 0.02)):
        with pytest.raises(ValueError, match="give three growing rotations"):
            plots.hinge_map(frame, data, limits=limits)
    with pytest.raises(ValueError, match="the Dataset has no link_deformation"):
        plots.link_loops(elastic)
    with pytest.raises(ValueError, match=r"there is no link 'brase'; known: .*brace"):
        plots.link_loops(data, "brase")
    with pytest.raises(ValueError, match="0 links: give 1 to 6"):
        plots.link_loops(data, [])
