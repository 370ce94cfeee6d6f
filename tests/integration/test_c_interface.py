"""The element from C, Fortran (as a UEL of Abaqus) and C++ (as an element of OpenSees)."""

import ctypes
import functools
import re
import shutil
import subprocess  # compilers, and what they make  # noqa: S404
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lir_element import AnalysisError, Element, Features
from lir_element.library import main, write_bearing, write_library
from tests.scenes import small_bearing

DATA = Path(__file__).parents[1] / "data/c_interface"
HEADERS = "Domain Element ID Information Matrix Node OPS_Stream Vector elementAPI"
DT = 1.0 / 512.0  # whose multiples have no round-off
LOAD = 150e3
BEARING = small_bearing(rim_stiffness=2e7)

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler (cc)")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("library")
    write_library(place)
    return place


@functools.cache
def path_of(level: str) -> tuple[list[np.ndarray], np.ndarray]:
    """Return motions (n, 25) through rims, slip and uplift, and forces and tangents (n, 156).

    The vertical displacement is the one that carries the load, or opens the bearing.
    """
    element = Element(BEARING, level)
    motions, found, reached = [], [], []
    u, v = np.zeros(12), np.zeros(12)
    v[6] = 0.3
    for k in range(1000):
        u[6], u[7] = 0.185 * np.sin(0.006 * k), 0.04 * np.sin(0.004 * k)
        u[9], u[10] = 5e-4 * np.sin(0.01 * k), 2e-4 * np.sin(0.02 * k)
        time, rates = k * DT, v if k else 0.0 * v
        if 700 <= k < 720:
            u[8] += 2e-4
            element.set_trial(u, rates, time)
        else:
            for _ in range(8):
                element.set_trial(u, rates, time)
                off = element.resisting_force()[8] + LOAD
                if abs(off) < 1.0:
                    break
                stiffness = max(element.tangent_stiffness()[8, 8], 1e7)
                u[8] -= off / stiffness
            element.set_trial(u, rates, time)
        motions.append(np.concatenate([[time], u, rates]))
        found.append(np.append(element.resisting_force(), element.tangent_stiffness()))
        element.commit()
        names = "rim_force", "slip", "axial_force"
        reached.append([np.abs(element.response(n)).max() for n in names])
    rim, slip, axial = np.transpose(reached)
    assert rim.max() > 1e4
    assert slip.max() > 5e-3
    assert axial.min() == 0.0
    return motions, np.array(found)


def compiled(folder: Path, compiler: str, name: str, *sources: str) -> Path:
    """Compile a program against the library; templates of the test get the library's numbers."""
    if shutil.which(compiler) is None:
        pytest.skip(f"there is no compiler {compiler}")
    header = (folder / "lir_element.h").read_text(encoding="utf-8")
    for source in DATA.iterdir():
        text = source.read_text(encoding="utf-8")
        size = re.search(r"#define LIR_SIZE (\d+)", header)
        assert size
        (folder / source.name).write_text(text.replace("@LIR_SIZE@", size[1]), encoding="utf-8")
    for each in HEADERS.split():
        (folder / f"{each}.h").write_text('#include "opensees.h"\n', encoding="utf-8")
    strict = ["-Wall", "-Werror"] if compiler != "gfortran" else ["-fcheck=all"]
    link = ["-L.", "-llir_element", "-Wl,-rpath,$ORIGIN", "-o", name]
    words = [compiler, "-I.", *strict, *sources, *link]
    subprocess.run(words, cwd=folder, check=True, capture_output=True)  # noqa: S603
    return folder / name


PROGRAMS = {
    "example": ("cc", "example.c"),
    "uel": ("gfortran", "uel.f90", "drive_uel.f90"),
    "opensees": ("c++", "drive_opensees.cpp"),
}


@pytest.mark.parametrize("level", ["pendulum", "contact"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_has_the_numbers_of_python(folder: Path, name: str, level: str) -> None:
    motions, expected = path_of(level)
    assert np.array_equal(outcome(folder, name, level, motions), expected)


def outcome(folder: Path, name: str, level: str, motions: list[np.ndarray], *more: str) -> Any:
    """Return what a program writes: forces and tangents (n, 156)."""
    program = compiled(folder, PROGRAMS[name][0], name, *PROGRAMS[name][1:])
    write_bearing(BEARING, folder / "bearing_7.lir", level)
    given = "\n".join(" ".join(map(repr, m.tolist())) for m in motions)
    words = [str(program), "bearing_7.lir", *more]
    done = subprocess.run(  # noqa: S603
        words, input=given, cwd=folder, check=True, capture_output=True, text=True
    )
    return np.array([line.split() for line in done.stdout.splitlines()], dtype=np.float64)


@pytest.mark.parametrize("name", ["uel", "opensees"])
def test_an_analysis_can_begin_at_an_unloaded_bearing(folder: Path, name: str) -> None:
    found = outcome(folder, name, "pendulum", [np.zeros(25)])[0]
    assert not found[:12].any()
    assert np.array_equal(found[12:].reshape(12, 12), Element(BEARING).initial_stiffness())


def test_abaqus_weighs_both_ends_of_a_step(folder: Path) -> None:
    """Hilber, Hughes and Taylor: (1 + alpha) F - alpha F_old, and the derivative of that."""
    motions, expected = path_of("pendulum")
    alpha = -0.05
    found = outcome(folder, "uel", "pendulum", motions[:200], str(alpha))
    force, old = expected[1:200], expected[:199]
    weighed = (1.0 + alpha) * force[:, :12] - alpha * old[:, :12]
    assert found[1:, :12] == pytest.approx(weighed, rel=1e-12, abs=1e-6)
    assert found[1:, 12:] == pytest.approx((1.0 + alpha) * force[:, 12:], rel=1e-12, abs=1e-6)


def test_the_library_needs_no_python(folder: Path) -> None:
    found = subprocess.run(  # noqa: S603
        ["nm", "-D", "--undefined-only", str(folder / "liblir_element.so")],  # noqa: S607
        check=True,
        capture_output=True,
        text=True,
    )
    assert "fread" in found.stdout
    assert not re.search(r"\b_?(Py|NRT|numba)", found.stdout)


def test_outcomes_are_those_of_python(folder: Path) -> None:
    """A trial without a state is forgotten; a limit that is exceeded is committed and told."""
    lib = ctypes.CDLL(str(folder / "liblir_element.so"))
    pointer = np.ctypeslib.ndpointer(np.float64)
    lib.lir_read.argtypes = [ctypes.c_char_p, pointer, ctypes.c_int]
    lib.lir_trial.argtypes = [pointer, pointer, pointer, ctypes.c_double]
    lib.lir_size.argtypes = lib.lir_commit.argtypes = lib.lir_revert.argtypes = [pointer]
    bearing, u, rest = np.zeros(6000), np.zeros(12), np.zeros(12)
    file = folder / "one.lir"
    assert lib.lir_trial(bearing, u, rest, 0.0) == -2
    assert lib.lir_read(bytes(folder / "none.lir"), bearing, bearing.size) == -1
    write_bearing(BEARING, file, features=Features.all())
    assert lib.lir_read(bytes(file), bearing, 100) == -3
    assert lib.lir_read(bytes(file), bearing, bearing.size) == 0
    assert lib.lir_size(bearing) * 8 == file.stat().st_size
    start = bearing.copy()
    u[8] = -1e-4
    assert lib.lir_trial(bearing, u, rest, 0.0) == 0
    lib.lir_revert(bearing)
    assert np.array_equal(bearing, start)
    element = Element(BEARING)
    for far, trial, commit in ((np.nan, 1, 0), (5.0, 5, 0), (0.35, 0, 4)):
        u[6] = far
        told = []
        for act in (functools.partial(element.set_trial, u, rest, 0.0), element.commit):
            try:
                act()
                told.append(0)
            except AnalysisError as error:
                told.append(int(error.status))
        assert told == [trial, commit]
        assert lib.lir_trial(bearing, u, rest, 0.0) == trial
        assert lib.lir_commit(bearing) == commit
    file.write_bytes(file.read_bytes()[:-8])
    assert lib.lir_read(bytes(file), bearing, bearing.size) == -2
    file.write_bytes(bytes(file.stat().st_size))
    assert lib.lir_read(bytes(file), bearing, bearing.size) == -2


def test_refusals(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match=r"contact_points = 24: .* use contact_points=None"):
        write_bearing(small_bearing(contact_points=24), folder / "x.lir", "contact")
    monkeypatch.setenv("CC", "no-such-compiler -O1")
    with pytest.raises(SystemExit, match="the C compiler 'no-such-compiler' was not found"):
        main([str(folder / "other")])
    monkeypatch.setenv("CC", "false")
    with pytest.raises(SystemExit, match="the C compiler failed: false -O2"):
        main([str(folder / "other")])
