"""Compiled loops in pieces: none lost, none twice; a failure or Ctrl-C ends them."""

from time import sleep

import numpy as np
import pytest

from frames._jit import kernel
from lir_element import RunStatus
from lir_element.interruptible import interruptible, ready


class Loop:
    """A loop whose unit takes some work, and which may fail or be interrupted."""

    def __init__(
        self, *, work: int = 3, pause: float = 0.0, end: BaseException | int | None = None
    ) -> None:
        self.done, self.work, self.pause, self.end = 0, work, pause, end
        self.left = work
        self.calls: list[int] = []

    def advance(self, last: int, work: int) -> int:
        self.calls.append(work)
        sleep(self.pause)
        while self.done < last and work > 0:
            part = min(work, self.left)
            work, self.left = work - part, self.left - part
            if self.left == 0:
                self.done, self.left = self.done + 1, self.work
        if self.end is not None and self.done >= 5:
            if isinstance(self.end, int):
                return self.end
            raise KeyboardInterrupt
        return 0


def test_to_the_end() -> None:
    loop = Loop(work=17)
    assert interruptible(loop.advance, lambda: loop.done, 1000) is RunStatus.OK
    assert (loop.done, loop.left) == (1000, 17)
    assert loop.calls[1] > loop.calls[0]  # the loop is fast: larger pieces


def test_slow_work_makes_small_pieces() -> None:
    loop = Loop(work=100, pause=0.1)
    interruptible(loop.advance, lambda: loop.done, 1)
    assert min(loop.calls) < 20


def test_progress_goes_to_one() -> None:
    shares: list[float] = []
    loop = Loop(work=7)
    interruptible(loop.advance, lambda: loop.done, 333, shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert 40 <= len(shares) <= 50


def test_failure_and_interrupt() -> None:
    failed = Loop(end=int(RunStatus.RIM_OVERRUN))
    assert interruptible(failed.advance, lambda: failed.done, 10**6) is RunStatus.RIM_OVERRUN
    stopped = Loop(end=KeyboardInterrupt())
    assert interruptible(stopped.advance, lambda: stopped.done, 10**6) is RunStatus.INTERRUPTED


def test_ready_compiles_without_calling() -> None:
    @kernel
    def add(x: np.ndarray, y: float) -> None:
        x[0] += y

    x = np.zeros(1)
    assert ready(add, x, 2.0) >= 0.0
    assert x[0] == 0.0
    if hasattr(add, "signatures"):
        assert len(add.signatures) == 1
    add(x, 2.0)
    assert x[0] == 2.0
    if hasattr(add, "signatures"):
        assert len(add.signatures) == 1


@pytest.mark.parametrize("total", [1, 2, 49, 50, 51, 999])
def test_every_total(total: int) -> None:
    shares: list[float] = []
    loop = Loop(work=1)
    interruptible(loop.advance, lambda: loop.done, total, shares.append)
    assert loop.done == total
    assert shares[-1] == 1.0


def test_no_piece_goes_beyond_its_room() -> None:
    """Room for seven units at a time; larger pieces are not asked for where they end early."""
    loop, seen, first = Loop(), [], [0]

    def room() -> int:
        if loop.done == first[0] + 7:
            first[0] = loop.done
            sleep(0.001)  # not counted as the loop's
        return first[0] + 7

    def advance(last: int, work: int) -> int:
        assert last <= first[0] + 7
        return loop.advance(last, work)

    def done() -> int:
        return loop.done

    assert interruptible(advance, done, 1000, seen.append, room=room) is RunStatus.OK
    assert loop.done == 1000
    assert first[0] == 994
    assert max(loop.calls) <= 8 * 50  # the first pieces alone spend their work
    assert seen == [k / 50 for k in range(1, 51)]
