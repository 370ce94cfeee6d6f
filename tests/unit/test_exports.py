"""What the public packages export: all of it, documented, and nothing else by a star."""

import ast
import importlib
from pathlib import Path

import pytest

PACKAGES = ["lir_element", "frames", "frames.plots", "lir_element.opensees"]


@pytest.mark.parametrize("package", PACKAGES)
def test_a_star_gives_what_the_package_lists(package: str) -> None:
    module = importlib.import_module(package)
    found: dict[str, object] = {}
    exec(f"from {package} import *", found)  # noqa: S102
    found.pop("__builtins__")
    assert set(found) == set(module.__all__)
    imported = {
        alias.asname
        for node in ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8")).body
        for alias in getattr(node, "names", [])
        if alias.asname
    }
    assert imported == set(module.__all__), "exported, but not listed, or the other way round"
    assert all(getattr(module, name).__doc__ for name in module.__all__)


def test_errors_and_warnings_of_a_run_are_exported() -> None:
    """Whoever catches one by name finds it where the function that raises it came from."""
    frames, device = importlib.import_module("frames"), importlib.import_module("lir_element")
    errors = {name: vars(frames)[name] for name in ("ModelError", "MotionError")}
    errors["AnalysisError"] = device.AnalysisError
    assert all(issubclass(error, Exception) for error in errors.values())
    for name in ("ModelWarning", "MotionWarning"):
        assert issubclass(vars(frames)[name], Warning)
    with pytest.raises(frames.MotionError):
        frames.GroundMotion(x=[1.0], dt=0.1)
