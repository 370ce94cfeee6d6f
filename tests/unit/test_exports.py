"""What the public packages export: all of it, documented, and nothing else by a star."""

import ast
import functools
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from frames import io
from tests.patience import fresh

PACKAGES = [
    "lir_element",
    "lir_element.opensees",
    "frames",
    "frames.laws",
    "frames.plots",
    "frames.viewer",
    "frames.design",
    "frames.design.plots",
    "frames.risk",
    "frames.risk.plots",
]

ROOT = Path(__file__).parents[2]
SECTIONS = re.compile(r"^ *(Parameters|Returns|Yields|Raises|Warns)\n *-{3,}$", re.MULTILINE)


def functions_of(thing: Any) -> Iterator[tuple[Any, bool]]:
    """Yield an exported function, or those of a class and its bases; whether it is a property."""
    members = {"": thing}
    if inspect.isclass(thing):
        ours = [b for b in thing.__mro__ if b.__module__.startswith(("frames", "lir_element"))]
        members = {f"{b.__qualname__}.{k}": v for b in ours for k, v in vars(b).items()}
    for name, member in members.items():
        function = member
        for held in ("__func__", "fget", "func"):  # a class method, a property, a cached one
            function = getattr(function, held, None) or function
        function = inspect.unwrap(function) if callable(function) else function
        if inspect.isfunction(function) and "._" not in name:
            yield function, not callable(member) and not hasattr(member, "__func__")


@functools.cache
def described() -> dict[tuple[str, str], tuple[Any, bool]]:
    """Return the functions that users call: exported, or imported by a page on extensions."""
    packages = [importlib.import_module(name) for name in PACKAGES]
    things = [getattr(package, name) for package in packages for name in package.__all__]
    pages = (ROOT / f"docs/{name}.md" for name in ("extending", "frameworks"))
    page = "\n".join(each.read_text(encoding="utf-8") for each in pages)
    for module, names in re.findall(r"from ((?:frames|lir_element)[\w.]*) import ([\w, ]+)", page):
        things += [getattr(importlib.import_module(module), name) for name in names.split(", ")]
    found = [each for thing in things for each in functions_of(thing)]
    return {(each.__module__, each.__qualname__): (each, kept) for each, kept in found}


def defined(node: ast.AST, prefix: str = "") -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yield all functions of a module, methods and inner ones too, with their qualified names."""
    for child in ast.iter_child_nodes(node):
        name = f"{prefix}{getattr(child, 'name', '')}"
        if isinstance(child, ast.FunctionDef):
            yield name, child
            yield from defined(child, f"{name}.<locals>.")
        else:
            yield from defined(child, f"{name}." if isinstance(child, ast.ClassDef) else prefix)


def test_frames_read_and_write_by_functions_of_their_module() -> None:
    for program in ("etabs", "opensees", "sap2000"):
        assert getattr(io.Frame, f"from_{program}") is getattr(io, f"read_{program}")
    assert (io.Frame.to_etabs, io.Frame.to_sap2000) == (io.write_etabs, io.write_sap2000)


def test_internal_functions_are_described_in_prose() -> None:
    """Sections on parameters are for those who call from outside; a reader has the signature."""
    wrong = []
    for package in ("lir_element", "frames", "validation"):
        for path in (ROOT / package).rglob("*.py"):
            module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            text = path.read_text(encoding="utf-8")
            for name, node in defined(ast.parse(text)) if SECTIONS.search(text) else ():
                known = (module.removesuffix(".__init__"), name) in described()
                if not known and SECTIONS.search(ast.get_docstring(node, clean=False) or ""):
                    wrong.append(f"{path.relative_to(ROOT)}:{node.lineno} {name}")
    assert not wrong, wrong


def test_exported_functions_describe_what_they_are_given_and_return() -> None:
    wrong = []
    for (module, name), (function, is_property) in described().items():
        text = inspect.getdoc(function) or ""
        known = [each for each in inspect.signature(function).parameters if each != "self"]
        returns = function.__annotations__.get("return") not in {None, "None", "NoReturn"}
        found = SECTIONS.findall(text)
        if (
            "\n" in text
            and not is_property
            and (
                (known and "Parameters" not in found)
                or (returns and not {"Returns", "Yields"} & set(found))
            )
        ):
            wrong.append(f"{module}.{name}")
    assert not wrong, wrong


@pytest.mark.parametrize("package", PACKAGES)
def test_a_star_gives_what_the_package_lists(package: str) -> None:
    module = importlib.import_module(package)
    found: dict[str, object] = {}
    exec(f"from {package} import *", found)  # noqa: S102
    found.pop("__builtins__")
    assert set(found) == set(module.__all__)
    imported = {
        alias.asname
        for node in ast.walk(ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8")))
        for alias in getattr(node, "names", [])
        if alias.asname and isinstance(node, ast.ImportFrom)
    }
    assert imported == set(module.__all__), "exported, but not listed, or the other way round"
    assert all(getattr(module, name).__doc__ for name in module.__all__)


def test_errors_and_warnings_of_a_run_are_exported() -> None:
    """Whoever catches one by name finds it where the function that raises it came from."""
    frames, device = importlib.import_module("frames"), importlib.import_module("lir_element")
    errors = {name: getattr(frames, name) for name in ("ModelError", "MotionError")}
    errors["AnalysisError"] = device.AnalysisError
    assert all(issubclass(error, Exception) for error in errors.values())
    for name in ("ModelWarning", "MotionWarning"):
        assert issubclass(getattr(frames, name), Warning)
    with pytest.raises(frames.MotionError):
        frames.GroundMotion(x=[1.0], dt=0.1)


def test_a_name_that_never_was_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'frames' has no attribute 'nothing'"):
        importlib.import_module("frames").nothing  # noqa: B018


def test_the_engine_has_a_short_list_of_names() -> None:
    assert len(importlib.import_module("frames").__all__) <= 46


def test_the_engine_does_not_import_design_or_risk() -> None:
    code = (
        "import sys, frames; "
        "print([m for m in sys.modules if m.startswith(('frames.design', 'frames.risk'))])"
    )
    out = fresh(code)
    assert out.stdout.strip() == "[]"
