"""What all tests share: the random-test profile, and the folder of recorded ground motions."""

import os
from pathlib import Path

import matplotlib as mpl
import pytest
from hypothesis import settings

mpl.use("Agg")  # no test needs a display

settings.register_profile("ci", derandomize=True, deadline=None, database=None)
settings.load_profile("ci")


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
