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
