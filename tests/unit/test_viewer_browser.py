"""The page in a real browser: its numbers, its geometry, its controls, its width, its colours."""

import math
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("playwright", reason="playwright is not installed")

from playwright.sync_api import sync_playwright

from frames.plots.drawn_device import device_of
from frames.results.bearing_geometry import movement, outlines, posture
from frames.viewer import write_view
from tests.patience import patience
from tests.viewed import Judged, building

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed"),
    pytest.mark.meant("eccentricity|settles by|gap|slip"),
]
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("view") / "view.html"
    checks = [Judged(f"check {k}", "", verdict="ok", ratio=0.1 * k) for k in range(14)]
    failed = Judged("storey drift", "a note", concerns="bearing-1-1, upper", ratio=1.2)
    write_view(building()[1], building()[0], path, checks=[*checks, failed])
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_playwright() as started:
        found = started.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield found
        found.close()


def opened(browser: Any, path: Path, width: int = 1280, scheme: str = "light") -> Any:
    """Open the page; what it asks of a network or complains of is in `page.said`."""
    context = browser.new_context(
        viewport={"width": width, "height": 844}, color_scheme=scheme, has_touch=width < 500
    )
    context.set_default_timeout(1e3 * patience())
    page = context.new_page()
    page.said = []
    page.on("console", lambda message: page.said.append(message.text))
    page.on("pageerror", lambda error: page.said.append(str(error)))
    page.on("request", lambda asked: page.said.append(asked.url))
    page.goto(path.as_uri())
    page.wait_for_function("window.view !== undefined")
    return page


@pytest.fixture
def page(browser: Any, written: Path) -> Iterator[Any]:
    found = opened(browser, written)
    yield found
    found.context.close()


def numbers(page: Any) -> dict[str, str]:
    rows = page.locator("#readings tr").all()[1:]
    cells = [row.locator("td").all_inner_texts() for row in rows]
    return {title: f"{now} | {largest}" for title, now, largest, _ in cells}


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_it_shows_all_and_asks_for_nothing(browser, written, width, scheme):
    page = opened(browser, written, width, scheme)
    page.click("#to-rim")
    assert page.said == [written.as_uri()]
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    for name in ("model", "section", "loop", "orbit", "response", "timeline"):
        box = page.locator(f"#{name} canvas").bounding_box()
        assert min(box["width"] / 300.0, box["height"] / 35.0) > 1.0, name
        # a drawing, and not one colour: the picture of plain paper packs to next to nothing
        assert len(page.locator(f"#{name} canvas").screenshot()) > 1500, name
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    light = sum(map(int, paper[4:-1].split(","))) / 3.0
    assert light > 200.0 if scheme == "light" else light < 60.0
    page.context.close()


def test_numbers_are_those_of_the_run(page: Any) -> None:
    data = building()[1]
    name = str(data["bearing"].to_numpy()[2])
    page.select_option("#bearing", label=name)
    own, step = data.sel(bearing=name), 61
    page.evaluate(f"view.clock.set({float(data['time'][step])})")
    now = own.isel(time=step)
    u = np.linalg.norm(own["bearing_displacement"].to_numpy()[:, :2], axis=1)
    shown = numbers(page)
    k = int(u.argmax())
    said = f"{1e3 * u[step]:.1f} mm | {1e3 * u[k]:.1f} mm at {float(data['time'][k]):.2f} s"
    assert shown["displacement"] == said
    axial = own["axial_force"].to_numpy()
    assert shown["axial force"].startswith(f"{axial[step] / 1e3:.1f} kN | {axial.max() / 1e3:.1f}")
    slip = own["interface_slip_size"].to_numpy()
    assert shown["interface slip"].startswith(f"{1e3 * slip[step]:.1f} mm | {1e3 * slip.max():.1f}")
    rim = own["rim_force"].sel(surface="bottom").to_numpy()
    assert shown["bottom rim"].startswith(f"{rim[step] / 1e3:.1f} kN | {rim.max() / 1e3:.1f} kN")
    marked = page.locator("#readings td.is-rim").count()
    assert marked == int((now["rim_force"] > 0.0).sum())
    page.click("#to-rim")
    every = data["rim_force"].max(["bearing", "surface"])
    assert page.inner_text("#now") == f"{float(data['time'][int(every.argmax('time'))]):.3f} s"


def test_bodies_are_where_figures_draw_them(page: Any) -> None:
    data = building()[1]
    names = list(map(str, data["bearing"].to_numpy()))
    for name in (names[0], names[-1]):
        device = device_of(data, name)
        pressed = data["rim_force"].sel(bearing=name)
        gone = np.linalg.norm(movement(data, device, name).opening[:, :2], axis=1)
        assert gone.max() > 2e-3
        rims = [int(pressed.sel(surface=each).argmax("time")) for each in ("bottom", "top")]
        for step in (0, *rims, int(gone.argmax())):
            time = float(data["time"][step])
            found = page.evaluate(
                """([time, k]) => {
                  view.clock.set(time);
                  document.getElementById("bearing").value = String(k);
                  document.getElementById("bearing").dispatchEvent(new Event("change"));
                  const state = view.view.bearingNow();
                  const direction = view.view.direction();
                  const now = SectionGeometry.posture(state, direction);
                  return { direction, state, ...SectionGeometry.bodies(view.view.device(), now) };
                }""",
                [time, names.index(name)],
            )
            now = posture(data, device, name, time, np.array(found["direction"]))
            wanted = outlines(device, now)
            # corners alone: arcs have fewer points in the page; to a quarter of a millimetre
            for body, corners in (("bottomPlate", 6), ("topPlate", 6), ("topSlider", 2)):
                words = "".join(f" {c.lower()}" if c.isupper() else c for c in body)
                assert_allclose(
                    found[body][-corners:], wanted[words][-corners:], rtol=0.0, atol=2.5e-4
                )
            for k, face in enumerate(("bottomFace", "topFace")):
                if found["state"]["rims"][k]:  # the rim that is marked stands at the slider's edge
                    edges, mark = np.array(found[face])[[0, -1]], np.array(found["rims"][k])
                    apart = np.linalg.norm(edges[:, None] - mark[None], axis=-1).min()
                    assert apart < 0.02 < device.slider_radius


def test_the_cut_follows_the_displacement_without_a_jump(page: Any) -> None:
    planes = page.evaluate("Array.from(view.view.series().planes)")
    data, k = building()[1], page.evaluate("view.view.bearing")
    u = data["bearing_displacement"].to_numpy()[:, k, :2]
    sizes = np.linalg.norm(u, axis=1)
    far = sizes > 0.11 * sizes.max()
    across = u[:, 1] * np.cos(planes) - u[:, 0] * np.sin(planes)
    assert_allclose(across[far], 0.0, atol=1e-3 * sizes.max())
    assert np.abs(np.diff(planes)).max() <= 0.5 * math.pi + 1e-9


def test_keys_and_buttons_move_the_time(page: Any) -> None:
    times = building()[1]["time"].to_numpy()
    now = lambda: page.evaluate("view.clock.now")  # noqa: E731
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert now() == times[2]
    page.keyboard.press("ArrowLeft")
    assert now() == times[1]
    page.keyboard.press("Shift+ArrowRight")
    assert_allclose(now(), times[1] + 1.0)
    page.keyboard.press("End")
    assert now() == times[-1]
    page.keyboard.press("Home")
    page.select_option("#speed", label="1/10 speed")
    page.locator("body").click(position={"x": 2, "y": 2})
    page.keyboard.press("Space")
    page.wait_for_function("view.clock.now > 0.02")
    page.keyboard.press("Space")
    assert page.evaluate("view.clock.playing") is False
    page.click("#play")
    page.wait_for_function("view.clock.now > 0.05")
    page.click("#play")
    stopped = now()
    page.wait_for_timeout(100)
    assert now() == stopped
    page.evaluate("view.clock.speed = 50")
    page.click("#play")
    page.wait_for_function("!view.clock.playing")
    assert now() == times[-1]  # it stops at the end, and then begins anew
    page.click("#play")
    assert now() < times[-1]


def test_a_click_in_a_plot_sets_the_time(page: Any) -> None:
    times = building()[1]["time"].to_numpy()
    now = lambda: page.evaluate("view.clock.now")  # noqa: E731
    box = page.locator("#response canvas").bounding_box()
    page.locator("#response canvas").click(position={"x": 0.5 * box["width"], "y": 60})
    assert 0.3 * times[-1] < now() < 0.7 * times[-1]
    box = page.locator("#timeline canvas").bounding_box()
    page.locator("#timeline canvas").click(position={"x": 0.25 * box["width"], "y": 15})
    assert_allclose(now(), 0.25 * times[-1], atol=0.02 * times[-1])
    # in the orbit: the step nearest to where the largest displacement is drawn
    page.click("#to-far")
    wanted = now()
    place = page.evaluate(
        """() => {
          const [x, y] = view.view.bearingNow().displacement.map((value) => 1e3 * value);
          const { axes } = view.figures.orbit;
          return { x: axes.x(x), y: axes.y(y) };
        }"""
    )
    page.keyboard.press("Home")
    page.locator("#orbit canvas").click(position=place)
    assert_allclose(now(), wanted, atol=0.03)


def test_a_bearing_is_chosen_in_the_model_and_in_a_check(page: Any) -> None:
    names = list(map(str, building()[1]["bearing"].to_numpy()))
    chosen = lambda: page.locator("#bearing option:checked").inner_text()  # noqa: E731
    for name in (names[0], names[-1]):
        x, y = page.evaluate(f"view.model.onScreen({names.index(name)})")
        page.mouse.click(x, y)
        assert chosen() == name
    page.click("text=bearing-1-1, upper")
    assert chosen() == "bearing-1-1"


def test_failed_checks_come_first_and_all_can_be_seen(page: Any) -> None:
    rows = page.locator("#checks tbody tr, #checks tr").all_inner_texts()
    assert all(word in rows[1] for word in ("storey drift", "FAILS", "≤"))
    assert "check 13" in rows[2]
    assert len(rows) == 13
    assert page.inner_text("#tally") == "15 checks, 1 failed; governing ones first"
    page.click("#all-checks")
    assert page.locator("#checks tr").count() == 16
    assert not page.locator("#all-checks").is_visible()


def test_displacements_are_drawn_with_their_factor(page: Any) -> None:
    model, data = building()
    node = list(map(str, data["node"].to_numpy())).index("floor-1-2-1")
    step = int(data["time"].size // 3)
    page.evaluate(f"view.clock.set({float(data['time'][step])})")
    for factor in (1.0, 20.0):
        page.evaluate(f"view.model.setFactor({factor})")
        found = page.evaluate(
            f"Array.from(view.model.scene.places.slice({3 * node}, {3 * node + 3}))"
        )
        u = data["node_displacement"].to_numpy()[step, node, :3]
        wanted = data["node_position"].to_numpy()[node] + factor * u
        assert_allclose(found, wanted, rtol=0.0, atol=2e-4 * factor)
    assert model.name in page.inner_text("#title")


def test_without_checks_and_without_webgl_the_rest_works(browser: Any, tmp_path: Path) -> None:
    write_view(building()[1], building()[0], tmp_path / "bare.html")
    text = (tmp_path / "bare.html").read_text(encoding="utf-8")
    blind = """<script>HTMLCanvasElement.prototype.getContext = ((old) => function (kind, ...rest) {
      return kind === "2d" ? old.call(this, kind, ...rest) : null;
    })(HTMLCanvasElement.prototype.getContext);</script>"""
    (tmp_path / "bare.html").write_text(text.replace("<header>", f"{blind}<header>"), "utf-8")
    page = opened(browser, tmp_path / "bare.html")
    assert not page.locator("#checks").is_visible()
    assert "has no WebGL" in page.inner_text("#model")
    page.click("#to-far")
    assert float(page.inner_text("#now").split()[0]) > 0.0
    page.context.close()
