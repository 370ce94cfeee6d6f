"""The first start: what importing loads, what a wheel's kernels save, what is compiled ahead."""

import importlib
import os
import platform
import re
import subprocess  # what a new process does  # noqa: S404
import sys
from pathlib import Path

import numpy as np
import pytest
from numba.core import event
from typer.testing import CliRunner

from frames import GroundMotion, lumped_mass, moment_frame, precompile, time_history
from frames.command.app import app
from frames.design.project.example import BUILDINGS
from lir_element._compile import shipped
from tests.patience import fresh
from tests.scenes import paper_bearing

ROOT = Path(__file__).parents[2]
COMPILES = pytest.mark.skipif(
    os.environ.get("NUMBA_DISABLE_JIT", "0") != "0", reason="nothing is compiled"
)
KERNEL = """
import math
from pathlib import Path
from lir_element._compile import cache
from lir_element._compile.jit import kernels_of

@kernels_of(cache.Sources(Path(__file__).parents[1]))
def law(x):
    return math.exp(x) * (2.0 * x + 1.0 / 3.0)
"""
COMPILE = "from law_of_a_wheel import law; print(law(0.7).hex())"
HEAVY = ("scipy.signal", "scipy.stats", "scipy.optimize", "scipy.spatial", "matplotlib", "netCDF4")


def law_of():
    """Return the kernel as a new process finds it."""
    sys.modules.pop("law_of_a_wheel", None)
    importlib.invalidate_caches()
    return importlib.import_module("law_of_a_wheel").law


REPORTED = "frames.design.project.design_run, frames.design.report.files"


@pytest.mark.parametrize(("names", "heavy"), [("frames", HEAVY), (REPORTED, HEAVY[:2] + HEAVY[4:])])
def test_imports_leave_out_what_most_runs_do_without(names: str, heavy: tuple[str, ...]) -> None:
    code = f"import {names}, sys; print([name for name in {heavy} if name in sys.modules])"
    out = fresh(code)
    assert out.stdout.strip() == "[]"


def test_frames_are_described_and_results_read_without_a_compiler() -> None:
    code = "import frames.io, frames.results.peaks, sys; print('numba' in sys.modules)"
    assert fresh(code).stdout.strip() == "False"


def told_by(code: str) -> str:
    """Return what a new process prints."""
    done = fresh(code)
    return done.stdout.strip()


def test_help_and_version_of_the_command_wait_for_no_analysis() -> None:
    slow = ("numba", "numpy", "pandas", "scipy", "xarray")
    code = (
        "import sys\nfrom typer.testing import CliRunner\nfrom frames.command.app import app\n"
        "asked = ['--version'], ['--help'], ['check', '--help'], ['design', '--help']\n"
        "done = [CliRunner().invoke(app, words) for words in asked]\n"
        f"print([one.exit_code for one in done], [name for name in {slow} if name in sys.modules])"
    )
    assert told_by(code) == "[0, 0, 0, 0] []"


def test_the_command_names_the_buildings_that_there_are() -> None:
    help_of_new = CliRunner().invoke(app, ["new", "--help"], terminal_width=300).output
    assert all(name in help_of_new for name in BUILDINGS)


ARRAYS = """
import sys
import numpy as np
from frames import GroundMotion, lumped_mass, time_history
from frames.demo import bearing_for
pulse = GroundMotion(x=2.0 * np.sin(np.linspace(0.0, 6.28, 21)), dt=0.05)
data = time_history(lumped_mass(bearing_for(2000e3), mass=204e3), pulse, duration=0.5)
largest = float(abs(data["bearing_displacement"]).max())
print([name for name in ("dask.base", "dask.array", "pint") if name in sys.modules])
"""
LATER = """
import dask.array, xarray
lazy = data["bearing_displacement"].chunk({"time": 10})
assert isinstance(lazy.data, dask.array.Array)
assert float(abs(lazy).max()) == largest
assert xarray.Variable("x", dask.array.ones(3)).chunks is not None
assert xarray.namedarray.pycompat.mod_version("dask").release > (0,)
print("chunks")
"""


def test_arrays_of_other_packages_are_imported_when_they_are_used() -> None:
    pytest.importorskip("dask.array")
    assert told_by(ARRAYS + LATER).splitlines() == ["[]", "chunks"]


@COMPILES
@pytest.mark.skipif(shipped.baseline(platform.machine()) is None, reason="none are shipped")
def test_a_kernel_of_the_wheel_is_taken_and_gives_the_same_bits(tmp_path, monkeypatch):
    package, wheel = tmp_path / "package", tmp_path / "wheel"
    (package / "kernels").mkdir(parents=True)
    (package / "kernels" / "law_of_a_wheel.py").write_text(KERNEL, encoding="utf-8")
    environment = {
        "LIR_CACHE_DIR": str(wheel),
        "NUMBA_CPU_NAME": str(shipped.baseline(platform.machine())),
        "NUMBA_CPU_FEATURES": "",
        "PYTHONPATH": os.pathsep.join([str(package / "kernels"), *sys.path]),
    }
    kept = fresh(COMPILE, **environment).stdout.strip()
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(str(package / "kernels"))
    native = law_of()
    assert native(0.7).hex() == kept
    assert sum(native.stats.cache_misses.values()) == 1
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path / "empty"))
    monkeypatch.setattr(shipped, "FOLDER", wheel)
    taken = law_of()
    assert taken(0.7).hex() == kept
    assert sum(taken.stats.cache_misses.values()) == 0
    (package / "kernels" / "law_of_a_wheel.py").write_text(KERNEL + "# edited\n", encoding="utf-8")
    edited = law_of()
    assert edited(0.7).hex() == kept
    assert sum(edited.stats.cache_misses.values()) == 1


def test_kernels_of_the_wheel_are_left_where_the_processor_lacks_what_they_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shipped, "FOLDER", tmp_path)
    triple = "x86_64-unknown-linux-gnu"
    name, needs = shipped._BASELINES["x86_64"]
    has = ",".join(f"+{need}" for need in needs.split(","))
    assert shipped.shipped_for((triple, "znver3", has + ",-avx512f")) == (triple, name, "")
    assert shipped.shipped_for((triple, "ivybridge", has.replace("+avx2", "-avx2"))) is None
    assert shipped.shipped_for(("arm64-apple-darwin", "apple-m1", "+neon")) is not None
    assert shipped.shipped_for(("riscv64-unknown-linux-gnu", "generic", "")) is None
    assert shipped.baseline("AMD64") == name
    assert shipped.baseline("riscv64") is None
    monkeypatch.setattr(shipped, "FOLDER", tmp_path / "none")
    assert shipped.shipped_for((triple, "znver3", has)) is None


def test_processes_share_all_analyses_and_name_the_one_that_fails(monkeypatch):
    assert sorted(name for layer in precompile.LAYERS for name in layer) == sorted(precompile.USUAL)
    monkeypatch.setattr(precompile, "LAYERS", (("element",), ("of nobody",)))
    shared = precompile._compiled(2)
    assert next(shared)[0] == "element"
    with pytest.raises(RuntimeError, match=r"of 'of nobody': .*frames\.precompile --jobs 1"):
        next(shared)


@COMPILES
@pytest.mark.slow
def test_usual_analyses_compile_nothing_that_was_not_compiled_ahead() -> None:
    assert set(precompile.compile_usual()) == set(precompile.USUAL)
    bearing = paper_bearing()
    shaking = np.full(4, 0.5)
    motion = GroundMotion(x=shaking, y=shaking, z=0.1 * shaking, dt=0.005)
    with event.install_recorder("numba:compile") as recorder:
        for level in ("pendulum", "contact", "rigid_body"):
            time_history(lumped_mass(bearing, 2e5), motion, level=level)
        time_history(moment_frame(bearing=bearing), motion, integrator="generalised-alpha")
    assert [e.data["dispatcher"].__name__ for _, e in recorder.buffer if e.is_start] == []


STUB = """#!/bin/sh
echo "$0 $@" | tr '\\n' ' ' >>"$LOG"
case "$*" in
    "-m venv --clear "*) mkdir -p "$4/bin" && : >"$4/pyvenv.cfg" && cp "$0" "$4/bin/python" ;;
    *direct_url*) echo "$OTHER" ;;
    "-m uv"*) test -z "$NO_UV" ;;
esac
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no sh")
@pytest.mark.parametrize("case", ["own", "link", "other", "no uv"])
def test_environments_of_other_checkouts_are_left_alone(tmp_path: Path, case: str) -> None:
    """A stub stands for Python, and a file for what it is called with: nothing is installed."""
    log, there = tmp_path / "log", tmp_path / "there"
    for folder in (tmp_path / "path", there / "bin"):
        folder.mkdir(parents=True)
    for stub in (tmp_path / "path" / "python3.12", there / "bin" / "python"):
        stub.write_text(STUB)
        stub.chmod(0o755)
    (there / "pyvenv.cfg").touch()
    if case == "link":
        (tmp_path / ".venv").symlink_to(there)
    else:
        there.rename(tmp_path / ".venv")
    path = f"{tmp_path / 'path'}{os.pathsep}{os.environ['PATH']}"
    other = "/elsewhere" if case == "other" else ""
    done = subprocess.run(  # noqa: S603
        ["sh", str(ROOT / ".ci" / "venv"), ".venv"],  # noqa: S607
        cwd=tmp_path,
        env={"PATH": path, "LOG": str(log), "OTHER": other, "NO_UV": "1" * (case == "no uv")},
        capture_output=True,
        text=True,
        check=False,
    )
    calls = re.findall(r"-m (uv pip|pip) (?:(?!-m ).)*--editable", log.read_text())
    by = {"other": [], "no uv": ["uv pip", "pip"]}.get(case, ["uv pip"])
    assert (done.returncode, calls) == (int(case == "other"), by), done
    words = {"other": "environment of /elsewhere and is left", "link": "is left as it"}
    assert words.get(case, "") in done.stderr
    if case == "link":
        assert not (tmp_path / ".venv").is_symlink()
        assert sorted(p.name for p in there.iterdir()) == ["bin", "pyvenv.cfg"]
