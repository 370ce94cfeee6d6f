"""The self-test of the in-process coupling: its verdict is kept, and believed."""

import json
import os
import subprocess  # what the self-test runs is exchanged here  # noqa: S404
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from validation.scenes import static_bearing

pytest.importorskip("openseespy")
pytest.importorskip("psutil")

from lir_element.opensees import RouteWarning, bearing_element, opensees, plugin
from lir_element.opensees.in_process import selftest, symbols

DEVICE = static_bearing()
_RUN = subprocess.run
ABORT = "import os; os.abort()"
EXCEPTION = "raise RuntimeError('the spring is off')"
NUMBERS = "class NotPossibleError(Exception): pass\nraise NotPossibleError('off by 0.1')"


@pytest.fixture
def door(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Any]:
    """An empty verdict file, an unasked self-test, and two nodes to put a bearing between."""
    monkeypatch.setattr(selftest, "OWN", SimpleNamespace(folder=lambda: tmp_path))
    monkeypatch.setattr(plugin._SESSION, "told", False)
    selftest.why_not_fast.cache_clear()
    symbols.addresses.cache_clear()
    ops = opensees()
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for node in (1, 2):
        ops.node(node, 0.0, 0.0, 0.0)
    yield tmp_path / "opensees.json"
    ops.wipe()
    selftest.why_not_fast.cache_clear()
    symbols.addresses.cache_clear()


def instead(monkeypatch: pytest.MonkeyPatch, code: str) -> list[int]:
    """Let the self-test's process run other code; returns where its runs are counted."""
    runs: list[int] = []
    original = _RUN

    def run(_command: list[str], **options: Any) -> "subprocess.CompletedProcess[str]":
        runs.append(1)
        return original([sys.executable, "-c", code], **options)

    monkeypatch.setattr(selftest.subprocess, "run", run)
    return runs


def test_the_verdict_is_kept(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = instead(monkeypatch, "pass")
    for _ in range(2):
        assert selftest.why_not_fast() == ""
        selftest.why_not_fast.cache_clear()  # as in another process
    assert len(runs) == 1
    assert list(json.loads(door.read_text(encoding="utf-8")).values()) == [""]
    assert os.listdir(door.parent) == ["opensees.json"]  # no partial file


@pytest.mark.parametrize("content", ["", "{", "[1]", '{"another": ""}'])
def test_a_damaged_verdict_is_asked_for_again(door, monkeypatch, content):
    runs = instead(monkeypatch, "pass")
    door.write_text(content, encoding="utf-8")
    assert selftest.why_not_fast() == ""
    assert len(runs) == 1
    assert "" in json.loads(door.read_text(encoding="utf-8")).values()


@pytest.mark.parametrize(
    ("code", "reason"), [(ABORT, "exit code -6"), (EXCEPTION, "RuntimeError: the spring is off")]
)
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_failed_self_test_leads_to_the_portable_route(door, monkeypatch, code, reason):
    runs = instead(monkeypatch, code)
    with pytest.warns(RouteWarning, match=f"its self-test failed .*{reason}"):
        assert bearing_element(1, 1, 2, DEVICE) == "portable"
    assert bearing_element(2, 1, 2, DEVICE) == "portable"  # told once, tried once
    with pytest.raises(RuntimeError, match=f'not possible: .*{reason}.*use route="portable"'):
        bearing_element(3, 1, 2, DEVICE, route="fast")
    assert opensees().getEleTags() == [1, 2]
    assert len(runs) == 1
    assert not door.exists()  # a crash is no number


def test_a_self_test_that_hangs(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    instead(monkeypatch, "import time; time.sleep(1e5)")
    monkeypatch.setattr(selftest, "_LONGEST", 0.3)
    assert selftest.why_not_fast() == "its self-test did not end within 0.3 s"
    assert not door.exists()  # another day there is more time
    instead(monkeypatch, "raise SystemExit(0)")
    monkeypatch.setattr(selftest, "_LONGEST", 300.0)
    selftest.why_not_fast.cache_clear()
    assert selftest.why_not_fast() == ""


def test_a_kept_failure_names_its_file(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = instead(monkeypatch, NUMBERS)
    first = selftest.why_not_fast()
    selftest.why_not_fast.cache_clear()  # as in another process
    assert selftest.why_not_fast() == f"{first}; remove {door} to repeat the test"
    assert len(runs) == 1


@pytest.mark.parametrize("folder_first", [False, True])
def test_no_module_of_the_working_folder_runs_in_the_self_test(tmp_path, monkeypatch, folder_first):
    (tmp_path / "numpy.py").write_text("raise SystemExit('numpy of the folder')")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [""] * folder_first + sys.path)
    done = selftest._run_child()
    assert "numpy of the folder" not in done[0]


def test_a_missing_symbol_is_named(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(symbols.CALLED, "get_node", "_ZN6Domain9notThereEi")
    runs = instead(monkeypatch, "pass")
    with pytest.warns(RouteWarning, match="does not export _ZN6Domain9notThereEi"):
        assert bearing_element(1, 1, 2, DEVICE) == "portable"
    with pytest.raises(symbols.NotPossibleError, match="_ZN6Domain9notThereEi"):
        bearing_element(2, 1, 2, DEVICE, route="fast")
    assert not runs
    assert not door.exists()


def test_an_unknown_build_is_named(door: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(symbols, "_LIBRARIES", ("openseespyelsewhere.opensees",))
    symbols.library.cache_clear()
    assert "does not export the functions of its elements" in selftest.why_not_fast()
    symbols.library.cache_clear()
    assert not door.exists()


def test_the_self_test_itself_agrees() -> None:
    if selftest.why_not_fast():
        pytest.skip(selftest.why_not_fast())
    selftest.main()
    assert opensees().getEleTags() in ([], None)
