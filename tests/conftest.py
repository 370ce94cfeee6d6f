"""What all tests share: the random-test profile, an empty OpenSees, the folder of records."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest
from hypothesis import settings

from lir_element.opensees import opensees

mpl.use("Agg")  # no test needs a display

settings.register_profile("ci", derandomize=True, deadline=None, database=None)
settings.load_profile("ci")


PLAIN = {
    "test_assembly", "test_axis_search", "test_bearing", "test_contact", "test_features",
    "test_library", "test_members", "test_model", "test_model_check",
    "test_rotation", "test_shaking", "test_sliders", "test_slip", "test_superelement",
}  # fmt: skip
"""Modules of tests that are soon done with the kernels as plain Python, too."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what `pytest -m plain tests/unit` runs where NUMBA_DISABLE_JIT=1."""
    for item in items:
        if item.path.stem in PLAIN:
            item.add_marker("plain")


@pytest.fixture
def ops() -> Iterator[Any]:
    """OpenSees without a model, and without one afterwards."""
    commands = opensees()
    commands.wipe()
    yield commands
    commands.wipe()


@pytest.fixture(scope="session")
def records() -> Path:
    """Folder of recorded ground motions, named by LIR_RECORDS; skips where there is none."""
    folder = os.environ.get("LIR_RECORDS", "")
    if not folder:
        pytest.skip("LIR_RECORDS does not name a folder of recorded ground motions")
    path = Path(folder)
    if not path.is_dir():
        pytest.skip(f"LIR_RECORDS={folder} is not a folder")
    return path
