"""The site builds without a warning, and every public name is on it."""

import functools
import importlib
import json
import os
import re
import shutil
import subprocess  # runs this interpreter on the sources of the site  # noqa: S404
import sys
import zlib
from html import unescape
from pathlib import Path

import pytest
from typer.main import get_group

from frames.command.app import app
from tests.unit.test_exports import PACKAGES

pytest.importorskip("sphinx_gallery")
pytestmark = pytest.mark.nightly  # half a minute; links of sources: test_generated.py

ROOT = Path(__file__).parents[2]
ELSEWHERE = {"frames": {"AnalysisInterrupted"}}
"""Names of `lir_element` that `frames` hands on."""


def build(folder: Path) -> "subprocess.CompletedProcess[str]":
    """Build the site of a copy of the sources: the build writes pages between them."""
    source = folder / "source"
    beside = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "CITATION.cff")
    source.mkdir()
    for name in beside:
        shutil.copy(ROOT / name, source)
    for name in ("docs", ".github", "validation", "frames", "lir_element", "tests"):
        written = shutil.ignore_patterns("generated", "__pycache__", "*.nbi", "*.nbc")
        shutil.copytree(ROOT / name, source / name, ignore=written)
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    command += ["-c", str(source / "docs"), "-d", str(folder / "doctrees")]
    command += [str(source), str(folder / "html")]
    packages = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    around = os.environ | {"LIR_DOCS_RUN": "0", "PYTHONPATH": packages}
    return subprocess.run(  # noqa: S603
        command, capture_output=True, text=True, check=False, env=around
    )


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site without what its scripts draw."""
    folder = tmp_path_factory.mktemp("site")
    built = build(folder)
    assert not built.returncode, built.stderr
    return folder / "html"


class _Page:
    """Title, anchors and targets of a page: read by patterns, as Sphinx writes them."""

    def __init__(self, text: str) -> None:
        self.title = "".join(re.findall(r"<title>(.*?)</title>", text, re.DOTALL))
        tags = [dict(ATTRIBUTE.findall(tag)) for tag in TAG.findall(text)]
        self.sources = [unescape(tag["src"]) for tag in tags if tag.get("src")]
        self.targets = [unescape(tag["href"]) for tag in tags if tag.get("href")] + self.sources
        self.ids = {unescape(tag["id"]) for tag in tags if tag.get("id")}
        self.formulas = text.count("<math ")


TAG = re.compile(r"<[a-z][^>]*? (?:id|href|src)=[^>]*>")
ATTRIBUTE = re.compile(r"""\s(id|href|src)="([^"]*)\"""")


@functools.cache
def pages(site: Path) -> dict[Path, _Page]:
    found = (f for f in sorted(site.rglob("*.html")) if not {"_modules", "_static"} & {*f.parts})
    return {file: _Page(file.read_text(encoding="utf-8")) for file in found}


def test_every_page_has_a_title_and_reaches_what_it_names(site: Path) -> None:
    parsed = pages(site)
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
    for file, page in pages(site).items():
        assert not [t for t in page.sources if "//" in t], file
        drawn += page.formulas
    assert drawn


def test_all_documents_are_pages(site: Path) -> None:
    for source in {*(ROOT / "docs").rglob("*.md")} - {ROOT / "docs" / "README.md"}:
        assert (site / source.relative_to(ROOT)).with_suffix(".html").is_file(), source


@pytest.mark.parametrize("module", PACKAGES)
def test_every_public_name_has_an_entry(site: Path, module: str) -> None:
    packed = (site / "objects.inv").read_bytes().split(b"\n", 4)[4]
    entries = {line.split()[0] for line in zlib.decompress(packed).decode().splitlines()}
    names = set(importlib.import_module(module).__all__) - ELSEWHERE.get(module, set())
    assert {f"{module}.{name}" for name in names} <= entries


@pytest.mark.parametrize("module", PACKAGES)
def test_every_public_class_and_function_has_a_page(site: Path, module: str) -> None:
    package = importlib.import_module(module)
    names = set(package.__all__) - ELSEWHERE.get(module, set())
    objects = {name for name in names if callable(getattr(package, name))}
    pages_of = site / "docs" / "api" / "generated"
    assert {name for name in objects if not (pages_of / f"{module}.{name}.html").is_file()} == set()


def test_scripts_can_be_downloaded_as_notebooks(site: Path) -> None:
    scripts = [p for kind in ("gallery", "tutorials") for p in (ROOT / "docs" / kind).rglob("*.py")]
    downloads = {path.name for path in (site / "_downloads").rglob("*.ipynb")}
    assert downloads == {f"{path.stem}.ipynb" for path in scripts}


def test_every_command_and_option_is_on_its_page(site: Path) -> None:
    page = unescape((site / "docs" / "cli.html").read_text(encoding="utf-8"))
    plain = re.sub(r"<[^>]+>", "", page).replace("\u2019", "'")  # quotes are set as in print
    text = " ".join(plain.split())
    commands = get_group(app).commands
    assert len(commands) > 5
    for name, command in commands.items():
        assert f"lir {name}" in text, name
        assert " ".join((command.help or "").split("\n")[0].split()) in text, name
        for option in (word for one in command.params for word in one.opts if "-" in word):
            assert option in text, (name, option)


def test_search_finds_terms_and_units(site: Path) -> None:
    """The index of the search knows abbreviations and units, and the glossary has both."""
    text = (site / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text[text.index("{") : text.rindex("}") + 1])
    glossary = index["docnames"].index("docs/glossary")
    for word in ("edc", "kn", "mpa", "rad", "q", "w"):
        found = index["terms"][word]
        assert glossary in (found if isinstance(found, list) else [found]), word


def test_equations_have_numbers_and_are_linked(site: Path) -> None:
    page = (site / "docs" / "theory_bearing.html").read_text(encoding="utf-8")
    assert re.search(r'id="equation-2-1".*?<span class="eqno">\(2\.1\)</span>', page, re.DOTALL)
    assert 'href="#equation-2-1">(2.1)</a>' in page
    assert 'href="theory_friction.html#equation-3-8">' in page or "(3.8)" not in page
