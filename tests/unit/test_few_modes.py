"""First modes of large structures, from sparse matrices, against those of dense ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse import linalg

import frames.statics.modes
from frames import ModelError, modes, moment_frame
from frames.assembly.natural_modes import UnstableError, few_modes, natural_modes
from frames.demo import bearing_for
from tests.refusals import refused

if TYPE_CHECKING:
    from frames import Frame


@pytest.fixture(scope="module")
def frame() -> Frame:
    """Return three storeys whose bays differ, so that no two periods are the same."""
    return moment_frame(bays=(3, 2), storeys=3, bearing=bearing_for(1000e3), bay_width=(5.0, 7.0))


@pytest.mark.parametrize("bearings", ["sliding", "sticking", "fixed"])
def test_same_modes_as_dense(bearings: Any, frame: Frame, monkeypatch: pytest.MonkeyPatch) -> None:
    """Periods, participating masses and shapes but for their sign."""
    dense = modes(frame, 8, bearings)
    monkeypatch.setattr(frames.statics.modes, "_LARGE", 0)
    found = modes(frame, 8, bearings)
    assert found.periods == pytest.approx(dense.periods, rel=1e-9)
    assert found.mass_ratios == pytest.approx(dense.mass_ratios, abs=1e-6)
    size = abs(dense.shapes).max(axis=(0, 1))
    assert abs(found.shapes) / size == pytest.approx(abs(dense.shapes) / size, abs=1e-5)


def chain(count: int) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Return stiffness and mass of two equal chains: each period twice; ends without mass."""
    one = sparse.diags_array([-np.ones(count - 1), np.full(count, 2.0), -np.ones(count - 1)],
                             offsets=[-1, 0, 1])  # fmt: skip
    mass = np.ones(count)
    mass[[0, -1]] = 0.0
    both = sparse.block_diag([one, one]), sparse.diags_array(np.tile(mass, 2))
    return tuple(map(sparse.csr_array, both))


def test_equal_periods_are_all_found() -> None:
    """Twice each, also where the last one wanted is the first of two."""
    k, m = chain(40)
    for count in (4, 5):
        expected = natural_modes(k.toarray(), m.toarray(), count).omega2
        found = few_modes(k, m, count)
        assert found.omega2 == pytest.approx(expected, rel=1e-10)
        assert found.shapes.T @ (m @ found.shapes) == pytest.approx(np.eye(count), abs=1e-9)


def test_a_missed_mode_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """An eigensolver that leaves one out is not believed."""
    k, m = chain(40)
    original = linalg.eigsh

    def forgetful(*args: Any, **kwargs: Any) -> tuple[np.ndarray, np.ndarray]:
        values, shapes = original(*args, **kwargs)
        order = np.argsort(values)
        return np.delete(values[order], 1), np.delete(shapes[:, order], 1, axis=1)

    monkeypatch.setattr(linalg, "eigsh", forgetful)
    expected = natural_modes(k.toarray(), m.toarray(), 4).omega2
    assert few_modes(k, m, 4).omega2 == pytest.approx(expected, rel=1e-10)


def test_unstable_structures_are_refused(frame: Frame, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the same words as dense ones."""
    k, m = chain(40)
    with pytest.raises(UnstableError, match="not positive definite"):
        few_modes(sparse.csr_array(k - 0.5 * m), m, 3)
    monkeypatch.setattr(frames.statics.modes, "_LARGE", 0)
    refused(ModelError, "count = 0 must be an integer of at least 1", modes, frame, 0)
