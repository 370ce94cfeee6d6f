"""Compiled kernels on disk: never a stale one, and trouble with the disk costs time only."""

import importlib
import os
import subprocess  # what a new process does  # noqa: S404
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from numba.core.dispatcher import Dispatcher

import lir_element
from lir_element import _cache
from lir_element._jit import kernels_of

pytestmark = pytest.mark.skipif(
    not isinstance(importlib.import_module("lir_element.kernels.rotation").rotate, Dispatcher),
    reason="nothing is compiled",
)
ROOT = Path(lir_element.__file__).parents[1]
LAW = "@kernel\ndef law(x):\n    return {factor} * x\n"
USE = "@kernel\ndef use(x):\n    return law(x) + 1.0\n"


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package of two kernels in two files, one of which calls the other, and an empty cache."""
    monkeypatch.setenv("LIR_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(_cache, "_said", set())
    folder = tmp_path / "package"
    (folder / "kernels").mkdir(parents=True)
    write(folder, 2.0)
    return folder


def write(folder: Path, factor: float) -> None:
    (folder / "kernels" / "law.py").write_text(LAW.format(factor=factor), encoding="utf-8")
    (folder / "kernels" / "use.py").write_text(USE, encoding="utf-8")


def start(folder: Path) -> Any:
    """Return the kernel that calls the other, as a new process finds it."""
    names: dict[str, Any] = {"kernel": kernels_of(_cache.Sources(folder)), "__name__": "package"}
    for file in ("law.py", "use.py"):
        path = folder / "kernels" / file
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)  # noqa: S102
    return names["use"]


def compilations(use: Any) -> int:
    return sum(use.stats.cache_misses.values())


def kept(folder: Path) -> list[Path]:
    return sorted((folder.parent / "cache").rglob("package.use*"))


def test_a_second_start_compiles_nothing(package: Path) -> None:
    first, second = start(package), start(package)
    assert (first(1.5), second(1.5)) == (4.0, 4.0)
    assert (compilations(first), compilations(second)) == (1, 0)
    assert second("a" != "b") == 3.0
    assert compilations(second) == 1  # another type is another kernel
    assert len(kept(package)) == 2


def test_an_edit_of_what_a_kernel_calls_compiles_it_anew(package: Path) -> None:
    assert start(package)(1.0) == 3.0
    write(package, 4.0)
    assert start(package)(1.0) == 5.0
    write(package, 2.0)
    again = start(package)
    assert again(1.0) == 3.0
    assert compilations(again) == 0


def test_an_edit_during_the_process_is_not_mixed_in(package: Path) -> None:
    assert start(package)(1.0) == 3.0
    early = _cache.Sources(package)
    write(package, 4.0)
    names: dict[str, Any] = {"kernel": kernels_of(early), "__name__": "package"}
    for text in (LAW.format(factor=4.0), USE):  # imported after the edit
        exec(text, names)  # noqa: S102
    assert names["use"](1.0) == 5.0
    write(package, 2.0)
    assert start(package)(1.0) == 3.0  # what was compiled in between was not kept


def as_a_file(cache: Path, _: pytest.MonkeyPatch) -> None:
    cache.write_text("in the way", encoding="utf-8")


def below_a_file(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache.write_text("in the way", encoding="utf-8")
    monkeypatch.setenv("LIR_CACHE_DIR", str(cache / "below"))


def full(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def write_bytes(path: Path, content: bytes) -> int:
        with path.open("wb") as file:
            file.write(content[:10])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", write_bytes)


def no_home(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def home() -> Path:
        msg = "Could not determine home directory."
        raise RuntimeError(msg)

    monkeypatch.setattr(Path, "home", home)
    monkeypatch.delenv("LIR_CACHE_DIR")


@pytest.mark.parametrize("trouble", [as_a_file, below_a_file, full, no_home])
def test_without_a_place_to_keep_them_kernels_compile_in_memory(
    package: Path, monkeypatch: pytest.MonkeyPatch, trouble: Callable[..., None]
) -> None:
    cache = package.parent / "cache"
    trouble(cache, monkeypatch)
    for factor, expected in ((2.0, 3.0), (4.0, 5.0)):  # an edit is noticed here as well
        write(package, factor)
        monkeypatch.setattr(_cache, "_said", set())
        with pytest.warns(RuntimeWarning, match="LIR_CACHE_DIR") as told:
            assert start(package)(1.0) == expected
        assert len(told) == 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert start(package)(1.0) == expected  # told once
    assert not [p for p in package.parent.rglob("*") if p.suffix in {".nbi", ".nbc", ".kernel"}]
    assert not [p for p in cache.rglob("*") if p.is_file()]  # no partial file either


def cut(content: bytes) -> bytes:
    return content[: len(content) // 2]


def emptied(_: bytes) -> bytes:
    return b""


def foreign(_: bytes) -> bytes:
    return b"not a kernel" * 100


def one_bit(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


@pytest.mark.parametrize("damage", [cut, emptied, foreign, one_bit])
def test_a_damaged_file_is_compiled_anew_and_replaced(
    package: Path, monkeypatch: pytest.MonkeyPatch, damage: Callable[[bytes], bytes]
) -> None:
    start(package)(1.0)
    [path] = kept(package)
    path.write_bytes(damage(path.read_bytes()))
    with pytest.warns(RuntimeWarning, match=r"damaged files, compiled anew.*LIR_CACHE_DIR"):
        assert start(package)(1.0) == 3.0
    healed = start(package)
    assert healed(1.0) == 3.0
    assert compilations(healed) == 0


def test_the_file_of_another_kernel_is_not_taken(package: Path) -> None:
    start(package)(1.0)
    [path] = kept(package)
    [other] = (package.parent / "cache").rglob("package.law*")
    path.write_bytes(other.read_bytes())
    with pytest.warns(RuntimeWarning, match="damaged"):
        assert start(package)(1.0) == 3.0


def test_a_missing_file_is_compiled_without_a_word(package: Path) -> None:
    start(package)(1.0)
    kept(package)[0].unlink()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert start(package)(1.0) == 3.0
    assert len(kept(package)) == 1


def run(code: str, **environment: str) -> "subprocess.CompletedProcess[str]":
    env = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    command = [sys.executable, "-c", code]
    return subprocess.run(command, env=env, capture_output=True, text=True, check=True)  # noqa: S603


KERNEL = "from lir_element.kernels.rotation import coefficients; print(coefficients(1.0)[0])"


@pytest.mark.skipif(sys.platform == "win32", reason="limits of a process")
def test_a_limit_on_files_ends_nothing(tmp_path: Path) -> None:
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)); "
    done = run(limit + KERNEL, LIR_CACHE_DIR=str(tmp_path))
    assert done.stdout.startswith("0.84147")
    assert "File too large" in done.stderr
    assert done.stderr.count("Set LIR_CACHE_DIR to a folder") == 1
    assert not [p for p in tmp_path.rglob("*") if p.is_file()]


def test_importing_needs_no_cache(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = run("import frames, lir_element", LIR_CACHE_DIR=str(tmp_path / "file" / "below"))
    assert done.stderr == ""
