"""Compiled kernels on disk: never a stale one, and trouble with the disk costs time only."""

import importlib
import os
import subprocess  # what a new process does  # noqa: S404
import sys
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher

import lir_element
from lir_element._compile import cache
from lir_element._compile.jit import kernels_of
from lir_element._compile.sources import compiled_sources
from tests.patience import fresh

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
    monkeypatch.setattr(cache, "_said", set())
    folder = tmp_path / "package"
    (folder / "kernels").mkdir(parents=True)
    write(folder, 2.0)
    return folder


def write(folder: Path, factor: float) -> None:
    (folder / "kernels" / "law.py").write_text(LAW.format(factor=factor), encoding="utf-8")
    (folder / "kernels" / "use.py").write_text(USE, encoding="utf-8")


def start(folder: Path) -> Any:
    """Return the kernel that calls the other, as a new process finds it."""
    names: dict[str, Any] = {"kernel": kernels_of(cache.Sources(folder)), "__name__": "package"}
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
    early = cache.Sources(package)
    write(package, 4.0)
    names: dict[str, Any] = {"kernel": kernels_of(early), "__name__": "package"}
    for text in (LAW.format(factor=4.0), USE):  # imported after the edit
        exec(text, names)  # noqa: S102
    assert names["use"](1.0) == 5.0
    write(package, 2.0)
    assert start(package)(1.0) == 3.0  # what was compiled in between was not kept


BUNDLE = "class Bundle(NamedTuple):\n    {}: float\n    {}: float\n"
HELD = "class Held(NamedTuple):\n    inner: Bundle\n"
INNER = "@kernel\ndef inner(held):\n    return held.inner.right - held.inner.left\n"
OUTER = "@kernel\ndef outer(held):\n    return 2.0 * inner(held)\n"
FIELDS = "left", "right"
ORDERS = ((FIELDS, 1), (FIELDS, 0), (FIELDS[::-1], 1), (FIELDS, 0))


@pytest.mark.parametrize(("called", "factor"), [("inner", 1.0), ("outer", 2.0)])
def test_fields_that_change_places_compile_a_kernel_anew(package, monkeypatch, called, factor):
    for fields, compiled in ORDERS:
        module = ModuleType("package")  # whose classes are in no source that is hashed
        monkeypatch.setitem(sys.modules, "package", module)
        monkeypatch.setattr(cache, "_parts", {})
        names = vars(module)
        names |= {"kernel": kernels_of(cache.Sources(package)), "NamedTuple": NamedTuple}
        for text in (INNER, OUTER, BUNDLE.format(*fields), HELD):
            exec(text, names)  # noqa: S102
        bundle = names["Bundle"](**{"left": 1.0, "right": 4.0})
        assert names[called](names["Held"](bundle)) == 3.0 * factor
        assert compilations(names[called]) == compiled


def test_fields_of_a_record_that_change_places_compile_a_kernel_anew(package: Path) -> None:
    for fields, compiled in ORDERS:
        names: dict[str, Any] = {"kernel": kernels_of(cache.Sources(package)), "__name__": "p"}
        exec("@kernel\ndef of(r):\n    return r[0].right - r[0].left\n", names)  # noqa: S102
        records = np.zeros(1, dtype=[(name, np.float64) for name in fields])
        records["left"], records["right"] = 1.0, 4.0
        assert names["of"](records) == 3.0
        assert compilations(names["of"]) == compiled


LINES = {
    "kernels/law.py": (
        "from package.a import f as g, h",
        "from other.x import X",
        "import package.e",
        "if TYPE_CHECKING:",
        "    from package.bundle import (",
        "        Bundle,  # of",
        "    )",
    ),
    "a.py": ("from package.b import LEAST", "from package.c import make", "from .room import d"),
    "b.py": ("from package import room",),
    "bundle.py": ("if TYPE_CHECKING:", "    from package.f import F", "", "from .room.g import G"),
}


def test_sources_are_found_by_what_kernels_import(tmp_path: Path) -> None:
    names = "_jit.py c.py e.py f.py h.py room/__init__.py room/d.py room/g.py"
    empty = dict.fromkeys(names.split(), "")
    texts = empty | {name: "\n".join(lines) for name, lines in LINES.items()}
    folder = tmp_path / "package"
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    found = [path.relative_to(folder).as_posix() for _, path in compiled_sources(folder)]
    listed = "_jit.py a.py b.py bundle.py e.py kernels/law.py room/__init__.py room/d.py room/g.py"
    assert found == listed.split()


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
def test_without_a_place_to_keep_them_kernels_compile_in_memory(package, monkeypatch, trouble):
    folder = package.parent / "cache"
    trouble(folder, monkeypatch)
    for factor, expected in ((2.0, 3.0), (4.0, 5.0)):  # an edit is noticed here as well
        write(package, factor)
        monkeypatch.setattr(cache, "_said", set())
        with pytest.warns(RuntimeWarning, match="LIR_CACHE_DIR") as told:
            assert start(package)(1.0) == expected
        assert len(told) == 1
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert start(package)(1.0) == expected  # told once
    assert not [p for p in package.parent.rglob("*") if p.suffix in {".nbi", ".nbc", ".kernel"}]
    assert not [p for p in folder.rglob("*") if p.is_file()]  # no partial file either


DAMAGES = {
    "cut": lambda content: content[: len(content) // 2],
    "emptied": lambda _: b"",
    "foreign": lambda _: b"not a kernel" * 100,
    "one bit": lambda content: content[:99] + bytes([content[99] ^ 1]) + content[100:],
}


@pytest.mark.parametrize("damage", [*DAMAGES, "of another kernel"])
def test_a_damaged_file_is_compiled_anew_and_replaced(package: Path, damage: str) -> None:
    start(package)(1.0)
    [path], [other] = kept(package), (package.parent / "cache").rglob("package.law*")
    change = DAMAGES.get(damage, lambda _: other.read_bytes())
    path.write_bytes(change(path.read_bytes()))
    with pytest.warns(RuntimeWarning, match=r"damaged files, compiled anew.*LIR_CACHE_DIR"):
        assert start(package)(1.0) == 3.0
    healed = start(package)
    assert healed(1.0) == 3.0
    assert compilations(healed) == 0


def test_a_missing_file_is_compiled_without_a_word(package: Path) -> None:
    start(package)(1.0)
    kept(package)[0].unlink()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert start(package)(1.0) == 3.0
    assert len(kept(package)) == 1


@pytest.mark.skipif(os.name == "nt", reason="Windows has neither owners by number nor these rights")
@pytest.mark.parametrize(
    ("what", "mode", "words"),
    [
        ("base", 0o777, "may be written by others"),
        ("base", 0o775, "may be written by others"),
        ("folder", 0o777, "may be written by others"),
        ("file", 0o666, "may be written by others"),
        ("file", 0o664, "may be written by others"),
        ("folder", None, "are of another user"),
        ("file", None, "are of another user"),
    ],
)
def test_what_others_may_write_is_not_opened(package, monkeypatch, what, mode, words):
    start(package)(1.0)
    [path] = kept(package)
    places = {"base": [path.parent.parent], "folder": [path.parent]}
    for place in places.get(what, path.parent.iterdir()):  # the part that it calls is a file too
        if mode is not None:
            place.chmod(mode)
        elif os.geteuid() == 0:
            os.chown(place, 4321, -1)
        else:
            monkeypatch.setattr(os, "geteuid", lambda: 4321)

    def opened(_: bytes) -> None:
        pytest.fail("the file was opened")

    monkeypatch.setattr(cache.pickle, "loads", opened)
    monkeypatch.setattr(cache, "keep", lambda *_: False)  # else the file becomes one of our own
    with pytest.warns(RuntimeWarning, match=f"{words}.*chmod -R go-w .*LIR_CACHE_DIR"):
        assert start(package)(1.0) == 3.0


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
@pytest.mark.parametrize("mask", [0o000, 0o002, 0o022, 0o077])
def test_new_files_are_of_the_user_alone(package: Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        start(package)(1.0)
    finally:
        os.umask(before)
    [path] = kept(package)
    modes = [each.stat().st_mode & 0o777 for each in (path, path.parent, path.parent.parent)]
    assert modes == [0o600, 0o700, 0o700]
    assert compilations(start(package)) == 0


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such rights")
def test_a_cache_that_is_only_read_is_taken(package: Path) -> None:
    start(package)(1.0)
    for each in (*(package.parent / "cache").rglob("*"), package.parent / "cache"):
        each.chmod(0o555 if each.is_dir() else 0o444)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = start(package)
        assert again(1.0) == 3.0
    assert compilations(again) == 0


def run(code: str, root: Path = ROOT, **environment: str) -> "subprocess.CompletedProcess[str]":
    return fresh(code, cwd=root, PYTHONPATH=str(root), **environment)


KERNEL = "from lir_element.kernels.rotation import coefficients; print(coefficients(1.0)[0])"


@pytest.mark.skipif(sys.platform == "win32", reason="limits of a process")
def test_a_limit_on_files_ends_nothing(tmp_path: Path) -> None:
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100)); "
    whole = {"PYTHONDONTWRITEBYTECODE": "1"}  # Python would keep what it cut off
    done = run(limit + KERNEL, LIR_CACHE_DIR=str(tmp_path), **whole)
    assert done.stdout.startswith("0.84147")
    assert "File too large" in done.stderr
    assert done.stderr.count("Set LIR_CACHE_DIR to a writable") == 1
    assert not [p for p in tmp_path.rglob("*") if p.is_file()]


def test_importing_needs_no_cache(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = run("import frames, lir_element", LIR_CACHE_DIR=str(tmp_path / "file" / "below"))
    assert done.stderr == ""
