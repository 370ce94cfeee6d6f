"""Every example in a docstring of the packages runs and prints what it says."""

import doctest
import importlib
import pkgutil

import pytest

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
