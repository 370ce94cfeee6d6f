"""What is said while kernels compile."""

import io
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import lir_element
from lir_element._compile.progress import Progress
from tests.patience import fresh

ROOT = Path(lir_element.__file__).parents[1]
SAID = (
    "lir-dcfp: compiling kernels for the first use, ten seconds to a minute; they are kept in /c\n"
)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def dispatcher(name: str, _: float, *calls: tuple[Any, ...]) -> SimpleNamespace:
    below = {call[0]: dispatcher(*call) for call in calls}
    code = SimpleNamespace(co_names=("shape", *below))
    return SimpleNamespace(__name__=name, py_func=SimpleNamespace(__code__=code, __globals__=below))


class Compiler:
    """Compiles a kernel of so many seconds, and first those that it calls."""

    def __init__(self, progress: Progress) -> None:
        self.now = 0.0
        self.progress = progress

    def compile(self, name: str, seconds: float, *calls: tuple[Any, ...]) -> None:
        event = SimpleNamespace(data={"dispatcher": dispatcher(name, seconds, *calls)})
        self.progress.on_start(event)
        for call in calls:
            self.compile(*call)
        self.now += seconds
        self.progress.on_end(event)


@pytest.fixture
def compiler(monkeypatch: pytest.MonkeyPatch) -> Compiler:
    monkeypatch.delenv("LIR_QUIET", raising=False)
    made: list[Compiler] = []
    made.append(
        Compiler(
            Progress(
                lambda d: d.__name__ != "foreign",
                lambda: "they are kept in /c",
                lambda: made[0].now,
            )
        )
    )
    return made[0]


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> Callable[[type[io.StringIO]], io.StringIO]:
    def to(kind: type[io.StringIO]) -> io.StringIO:
        stream = kind()
        monkeypatch.setattr(sys, "stderr", stream)
        return stream

    return to


def test_one_line_where_nobody_watches(compiler: Compiler, written: Any) -> None:
    stream = written(io.StringIO)
    compiler.compile("run", 20.0, ("trial", 3.0, ("slip", 1.0)), ("commit", 2.0))
    compiler.compile("audit", 5.0, ("tangent", 3.0))
    assert stream.getvalue() == SAID


def test_progress_on_a_terminal(compiler: Compiler, written: Any) -> None:
    stream = written(Terminal)
    compiler.compile("run", 20.0, ("trial", 3.0, ("slip", 1.0)), ("commit", 2.0))
    assert stream.getvalue().startswith(SAID)
    shown = [part.rstrip() for part in stream.getvalue()[len(SAID) :].split("\r")]
    assert shown == [
        "",
        "  [######                  ] 1 of at most 4 kernels, 1 s: trial",
        "  [############            ] 2 of at most 4 kernels, 4 s: run",
        "  [############            ] 2 of at most 4 kernels, 4 s: commit",
        "  [##################      ] 3 of at most 4 kernels, 6 s: run",
        "",
        "",
    ]


def test_a_small_kernel_is_not_worth_a_word(compiler: Compiler, written: Any) -> None:
    stream = written(Terminal)
    compiler.compile("slip", 0.4)
    compiler.compile("foreign", 90.0)
    assert stream.getvalue() == ""
    compiler.compile("run", 3.0, ("trial", 0.7))
    assert stream.getvalue().startswith(SAID)  # with the one before it is more than a second


def test_silence_on_request(compiler, written, monkeypatch):
    monkeypatch.setenv("LIR_QUIET", "1")
    stream = written(Terminal)
    compiler.compile("run", 20.0, ("trial", 3.0))
    assert stream.getvalue() == ""


@pytest.mark.parametrize("closed", [True, False])
def test_without_a_standard_error(compiler, monkeypatch, closed):
    stream = io.StringIO()
    stream.close()
    monkeypatch.setattr(sys, "stderr", stream if closed else None)
    compiler.compile("run", 20.0, ("trial", 3.0))
    assert compiler.now == 23.0


def test_the_compiler_is_followed(tmp_path: Path) -> None:
    """One line in the first process, none in the next, which takes the kernels from the cache."""
    code = (
        "from lir_element._compile import progress; progress.PATIENCE = 0.0; "
        "from lir_element.kernels.rotation import coefficients; coefficients(1.0)"
    )
    env = {
        "PYTHONPATH": str(ROOT),
        "LIR_CACHE_DIR": str(tmp_path),
        "LIR_QUIET": "0",
        "NUMBA_DISABLE_JIT": "0",
    }
    told = [fresh(code, **env).stderr for _ in range(2)]
    assert told == [SAID.replace("/c", str(tmp_path)), ""]
