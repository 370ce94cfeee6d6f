"""What all tests share: the random-test profile, an empty OpenSees, the folder of records."""

import gc
import itertools
import os
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import settings

from lir_element.opensees import opensees

mpl.use("Agg")  # no test needs a display

settings.register_profile("ci", derandomize=True, deadline=None, database=None)
settings.load_profile("ci")


PLAIN = {
    "test_assembly",
    "test_axis_search",
    "test_bearing",
    "test_contact",
    "test_door",
    "test_features",
    "test_library",
    "test_members",
    "test_model",
    "test_model_check",
    "test_rotation",
    "test_shaking",
    "test_sliders",
    "test_slip",
    "test_superelement",
}
"""Modules of tests/unit that are soon done with the kernels as plain Python, too."""


LONG = set((Path(__file__).parent / "long.txt").read_text(encoding="utf-8").split())
"""Modules and tests of others that `make quick` leaves out, but for what is marked: long ones."""


ROOMS = {"unit", "integration", "properties"}
"""Folders whose modules `make quick` runs, but for those that are long."""


def has_quick_tests(path: Path) -> bool:
    """Whether `make quick` runs tests of a module: it need not be imported otherwise."""
    whole = path.parent.name in ROOMS and path.stem not in LONG
    return whole or "mark.quick" in path.read_text(encoding="utf-8")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave out modules without a quick test where only those are asked for."""
    if config.option.markexpr != "quick" or collection_path.suffix != ".py":
        return None
    return None if has_quick_tests(collection_path) else True


MISSING = re.compile(r"No module named '(pydantic|pint|typer)\b")
"""Libraries of the command: modules of tests that import it are skipped without them."""


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Iterator[Any]:
    """Skip a module whose import fails because a library of the command is not installed."""
    report = yield
    found = MISSING.search(str(report.longrepr)) if report.failed else None
    if found:
        report.outcome = "skipped"
        report.longrepr = report.nodeid, 0, f"{found[1]} is not installed"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[Any]:
    """Collect without Python's search for cycles, which later passes over what is there then.

    A third of the time of collecting is that search, again and again through all modules.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


DOUBTS = ("lir_element.DesignWarning", "lir_element.AnalysisWarning", "frames.ModelWarning")
"""Warnings of what is strange of a bearing, a model or a run, which a test may mean to be."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what is quick, and what runs as plain Python; let pass the doubts that a test means.

    Quick are the first and the last case of each test, where neither it nor its module is long.
    ``pytest.mark.meant("settles by")`` says that a bearing or a model is strange on purpose: the
    warnings whose text these words (a regular expression) are found in are no errors there.
    """
    cases: dict[tuple[str, str], list[pytest.Item]] = {}
    for item in items:
        if item.path.parent.name in ROOMS and item.get_closest_marker("nightly") is None:
            name = getattr(item, "originalname", item.name)
            cases.setdefault((item.path.stem, name), []).append(item)
    for (module, name), each in cases.items():
        for item in () if {module, f"{module}::{name}"} & LONG else (each[0], each[-1]):
            item.add_marker("quick")
    for item in items:
        if item.path.stem in PLAIN and item.path.parent.name == "unit":
            item.add_marker("plain")
        words = [each for marker in item.iter_markers("meant") for each in marker.args]
        for each, kind in itertools.product(words, DOUBTS):
            item.add_marker(pytest.mark.filterwarnings(f"ignore:.*{each}:{kind}"))


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


@pytest.fixture(scope="session")
def made_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Put a folder that is made once for all processes of the suite, under a name, into another."""
    filelock = pytest.importorskip("filelock")
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def put(name: str, make: Callable[[Path], object], folder: Path) -> Path:
        made = shared / name
        with filelock.FileLock(f"{made}.lock"):
            if not made.is_dir():
                part = tmp_path_factory.mktemp("made")
                make(part)
                part.rename(made)  # whole, or not there
        shutil.copytree(made, folder, dirs_exist_ok=True)
        return folder

    return put


KEPT = slice(1200, 2400)
"""Steps of the artificial motions of ``lir new`` that tests keep: a quarter, with the pulse."""


def shorten(file: Path) -> None:
    """Cut a motion to its strong part, and bring the ground to rest at its end."""
    values = np.loadtxt(file)[KEPT]
    t = np.linspace(0.0, 1.0, len(values))
    values *= np.minimum(1.0, np.minimum(20.0 * t, (4.0 * (1.0 - t)) ** 2))
    shapes = np.sin(np.pi * t) ** 2 * np.array([np.ones_like(t), t])
    ends = np.array([np.ones_like(t), 1.0 - t])  # velocity and displacement, of an acceleration
    values -= np.linalg.solve(ends @ shapes.T, ends @ values) @ shapes
    np.savetxt(file, values, "%.6g")


@pytest.fixture(scope="session")
def put_example(made_once: Callable[..., Path]) -> Callable[..., Path]:
    """Put the project of ``lir new`` into a folder: made once a code, for all processes.

    Its motions are short and it has one storey, if not `whole`: they are most of the suite's time.
    """
    example = pytest.importorskip("frames.design.project.example")

    def put(folder: Path, code: str = "ASCE 7-22", *, whole: bool = False) -> Path:
        def write(part: Path) -> None:
            example.write_example(part, code)

        def cut(part: Path) -> None:
            put(part, code, whole=True)
            for motion in part.glob("motions/*.txt"):
                shorten(motion)
            file = part / "project.toml"
            file.write_text(file.read_text().replace("storeys = 5", "storeys = 1"))

        return made_once(f"{'whole' if whole else 'short'} {code}", write if whole else cut, folder)

    return put
