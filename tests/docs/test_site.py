"""The site builds without a warning, and every public name is on it."""

import importlib
import os
import subprocess  # runs this interpreter on the sources of the site  # noqa: S404
import sys
import zlib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest

pytest.importorskip("sphinx")

ROOT = Path(__file__).parents[2]
MODULES = (
    "lir_element",
    "lir_element.opensees",
    "frames",
    "frames.laws",
    "frames.plots",
    "frames.design",
    "frames.design.plots",
    "frames.risk",
    "frames.risk.plots",
)
ELSEWHERE = {"frames": {"AnalysisInterrupted"}}
"""Names of `lir_element` that `frames` hands on."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        "-c",
        str(ROOT / "docs"),
        "-d",
        str(folder / "doctrees"),
        str(ROOT),
        str(folder / "html"),
    ]
    built = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    assert built.returncode == 0, built.stderr
    return folder / "html"


class _Page(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.title, self.ids = "", set[str]()
        self.targets, self.sources = list[str](), list[str]()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._in_title = tag == "title"
        self.targets += [v for n, v in attrs if n in {"href", "src"} and v]
        self.sources += [v for n, v in attrs if n == "src" and v]
        self.ids |= {v for n, v in attrs if n == "id" and v}

    def handle_data(self, data: str) -> None:
        if getattr(self, "_in_title", False):
            self.title += data
            self._in_title = False


def pages(site: Path) -> Iterator[tuple[Path, _Page]]:
    for file in sorted(site.rglob("*.html")):
        if "_modules" not in file.parts and "_static" not in file.parts:
            yield file, _Page(file.read_text(encoding="utf-8"))


def test_every_page_has_a_title_and_reaches_what_it_names(site: Path) -> None:
    parsed = dict(pages(site))
    count = 0
    for file, page in parsed.items():
        assert page.title.strip(), file
        for target in page.targets:
            path, _, anchor = target.partition("#")
            path = path.split("?")[0]
            if "//" in path or path.startswith(("mailto:", "data:")):
                continue
            reached = Path(os.path.normpath(file.parent / path)) if path else file
            assert reached.exists(), (file, target)
            if anchor and reached in parsed:
                assert anchor in parsed[reached].ids, (file, target)
            count += 1
    assert count > 1000


def test_pages_are_read_without_a_network(site: Path) -> None:
    drawn = 0
    for file, page in pages(site):
        assert not [t for t in page.sources if "//" in t], file
        drawn += file.read_text(encoding="utf-8").count("<math ")
    assert drawn


def test_all_documents_are_pages(site: Path) -> None:
    for source in (ROOT / "docs").rglob("*.md"):
        assert (site / source.relative_to(ROOT)).with_suffix(".html").is_file(), source


@pytest.mark.parametrize("module", MODULES)
def test_every_public_name_has_an_entry(site: Path, module: str) -> None:
    packed = (site / "objects.inv").read_bytes().split(b"\n", 4)[4]
    entries = {line.split()[0] for line in zlib.decompress(packed).decode().splitlines()}
    names = set(importlib.import_module(module).__all__) - ELSEWHERE.get(module, set())
    assert {f"{module}.{name}" for name in names} <= entries
