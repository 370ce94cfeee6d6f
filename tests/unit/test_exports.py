"""What the public packages export: all of it, documented, and nothing else by a star."""

import ast
import importlib
import subprocess  # this interpreter  # noqa: S404
import sys
from pathlib import Path

import pytest

from frames._moved import NAMES

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


@pytest.mark.parametrize("package", NAMES)
def test_names_that_moved_still_work_and_say_where_they_are(package: str) -> None:
    module = importlib.import_module(package)
    for name, home in NAMES[package].items():
        with pytest.warns(DeprecationWarning, match=rf"{package}.{name} is now {home}\.") as told:
            found = getattr(module, name)
        new = str(told[0].message).split(" is now ")[1].split(";")[0].rpartition(".")[2]
        assert found is getattr(importlib.import_module(home), new)
        assert told[0].filename == __file__  # the caller is told, not the package


def test_a_name_that_never_was_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'frames' has no attribute 'nothing'"):
        importlib.import_module("frames").nothing  # noqa: B018


def test_the_package_of_design_can_be_called_as_the_function_it_was() -> None:
    package = importlib.import_module("frames.design")
    with (
        pytest.warns(DeprecationWarning, match=r"now frames\.design\.design"),
        pytest.raises(TypeError),
    ):
        package()


def test_the_engine_has_a_short_list_of_names() -> None:
    assert len(importlib.import_module("frames").__all__) <= 45


def test_the_engine_does_not_import_design_or_risk() -> None:
    code = (
        "import sys, frames; "
        "print([m for m in sys.modules if m.startswith(('frames.design', 'frames.risk'))])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)  # noqa: S603
    assert out.stdout.strip() == "[]"
