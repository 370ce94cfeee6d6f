"""Dense algebra of small models: one thread while an analysis lasts, as before afterwards."""

import threading

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController, threadpool_limits

from frames import Frame, GroundMotion, gravity, lumped_mass, modes, time_histories, time_history
from frames.batch import time_histories as batch
from frames.statics import gravity as static
from frames.statics import modes as natural
from frames.statics.blas_threads import blas_threads_for

MASS = 204e3


def threads() -> list[int]:
    """Return the threads of every BLAS."""
    found = ThreadpoolController().select(user_api="blas").info()
    return [one["num_threads"] for one in found]


@pytest.fixture
def several():
    """Have two threads, as far as every BLAS can."""
    with threadpool_limits(2, user_api="blas"):
        if max(threads(), default=1) < 2:
            pytest.skip("no BLAS here has threads")
        yield


@pytest.fixture
def seen(monkeypatch) -> list[list[int]]:
    """Return where the threads at equilibria, natural modes and batches will be."""
    found: list[list[int]] = []
    for module, name in ((static, "basis_of"), (natural, "natural_modes"), (batch, "Runner")):
        original = getattr(module, name)

        def watched(*given, original=original, **named):
            found.append(threads())
            return original(*given, **named)

        monkeypatch.setattr(module, name, watched)
    return found


@pytest.mark.usefixtures("several")
def test_a_small_model_has_one_thread_and_gives_the_others_back(seen, newhall_bearing):
    before, model = threads(), lumped_mass(newhall_bearing, MASS)
    motion = GroundMotion(x=np.ones(5), dt=0.01)
    for analyse in (
        lambda: gravity(model),
        lambda: modes(model, 1),
        lambda: time_history(model, motion),
        lambda: time_histories(model, motion, workers=2),
    ):
        seen.clear()
        analyse()
        assert seen
        assert all(set(one) == {1} for one in seen)
        assert threads() == before


@pytest.mark.usefixtures("several")
def test_two_at_a_time_leave_them_as_they_were(newhall_bearing):
    before, model = threads(), lumped_mass(newhall_bearing, MASS)
    inside, leave = threading.Event(), threading.Event()

    def stay() -> None:
        with blas_threads_for(model):
            inside.set()
            leave.wait(10.0)

    other = threading.Thread(target=stay)
    with blas_threads_for(model):
        other.start()
        assert inside.wait(10.0)
        assert set(threads()) == {1}
    leave.set()
    other.join()
    assert threads() == before


@pytest.mark.usefixtures("several")
def test_a_large_model_keeps_them():
    before, model = threads(), Frame()
    for place in range(501):
        model.add_node(f"n{place}", float(place), 0.0, 0.0)
    with blas_threads_for(model):
        assert threads() == before
