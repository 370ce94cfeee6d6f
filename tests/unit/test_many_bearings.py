"""Many bearings under one diaphragm: what they share is kept apart in the tangent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import frames.bundles.model_data
from frames import GroundMotion, moment_frame, time_history
from frames.demo import bearing_for
from frames.kernels.shared_tangent import (
    carry_products,
    factorise_blocks,
    goes_on_missing,
    keep_secant,
    linear_part_of_correction,
    set_linear_blocks,
    substitute_blocks,
    with_secants,
)
from frames.solve import analysis
from frames.statics.gravity import gravity
from lir_element.kernels.linear import factorise, substitute, substitute_rows, subtract_squares

if TYPE_CHECKING:
    from frames import Frame

SHARED, ALL = 3, 23  # unknowns of the kernels' tests


@pytest.mark.parametrize("n", [1, 5, 64, 200, 201, 202, 231])
def test_large_systems_are_solved(n: int) -> None:
    """Panels and pairs of rows, whole or not, against numpy's LAPACK."""
    random = np.random.default_rng(n)
    matrix, right = random.normal(size=(n, n)), random.normal(size=(3, n))
    factors, order = matrix.T.copy(), np.zeros(n, np.int64)
    assert factorise(factors, order)
    found, alone = right.copy(), right[1].copy()
    substitute_rows(factors, order, found)
    substitute(factors, order, alone)
    assert found == pytest.approx(np.linalg.solve(matrix, right.T).T, rel=1e-8, abs=1e-8)
    assert np.array_equal(alone, found[1])
    assert not factorise(np.zeros((n, n)), order)


def test_systems_of_no_unknown_are_solved() -> None:
    """As when no part of a structure has let go."""
    assert factorise(np.zeros((0, 0)), np.zeros(0, np.int64))


def test_weighted_squares_are_subtracted() -> None:
    """Against the product as it is written, blocks of rows whole or not."""
    random = np.random.default_rng(1)
    for m, n in ((1, 3), (31, 5), (70, 9)):
        rows, weights, out = random.normal(size=(m, n)), random.normal(size=m), np.ones((n, n))
        subtract_squares(rows, weights, out)
        assert out == pytest.approx(1.0 - rows.T @ np.diag(weights) @ rows, abs=1e-12)


def blocks(linear: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return blocks of a symmetric matrix, the last of `at` being shared, not factorised."""
    n_v = ALL - SHARED
    made = (
        np.zeros((n_v, n_v)),
        np.zeros((SHARED, n_v)),
        np.zeros((SHARED, n_v)),
        np.zeros((SHARED, SHARED)),
    )
    set_linear_blocks(linear, at, True, *made)
    return made


def test_blocks_solve_the_whole_tangent() -> None:
    """A tangent in blocks against numpy; then with what is shared renewed alone."""
    random = np.random.default_rng(2)
    linear = random.normal(size=(ALL, ALL))
    linear = linear @ linear.T + ALL * np.eye(ALL)
    at = random.permutation(ALL)
    n_v = ALL - SHARED
    tangent, across, below, corner = blocks(linear, at)
    more = random.normal(size=(SHARED, n_v))
    below += more  # friction is not symmetric
    whole = linear.copy()
    whole[np.ix_(at[n_v:], at[:n_v])] += more
    order, corner_order = np.zeros(n_v, np.int64), np.zeros(SHARED, np.int64)
    assert factorise_blocks(True, tangent, order, across, below, corner, corner_order)
    right = random.normal(size=ALL)
    x = right.copy()
    solve = (tangent, order, across, below, corner, corner_order, at, np.zeros(ALL))
    substitute_blocks(*solve, x)
    assert x == pytest.approx(np.linalg.solve(whole, right), rel=1e-9)

    changed = linear.copy()
    turned = random.normal(size=(SHARED, ALL))
    changed[at[n_v:]] += turned
    changed[:, at[n_v:]] += turned.T
    set_linear_blocks(changed, at, False, tangent, across, below, corner)
    assert factorise_blocks(False, tangent, order, across, below, corner, corner_order)
    x = right.copy()
    substitute_blocks(*solve, x)
    assert x == pytest.approx(np.linalg.solve(changed, right), rel=1e-9)


def test_secants_find_what_a_wrong_tangent_does_not() -> None:
    """A tangent 40 % off in three directions: few corrections, and fewer for the next load."""
    random = np.random.default_rng(3)
    n = 40
    base = np.diag(random.uniform(1.0, 100.0, n))
    off = random.normal(size=(n, 3)) * np.sqrt(np.diag(base))[:, None] / np.sqrt(n)
    true, weights = base + 0.4 * off @ off.T, np.diag(base).copy()
    memory = np.zeros((16, n)), np.zeros((16, n)), np.zeros((16, n)), np.zeros(16)
    count, counts = 0, []
    loads = random.normal(size=(2, n))
    for remembers, right in ((False, loads[0]), (True, loads[0]), (True, loads[1])):
        x, flow, turns = np.zeros(n), np.zeros(n), 0
        residual = right.copy()
        while np.linalg.norm(residual) > 1e-9 and turns < 200:
            step = np.linalg.solve(base, residual)
            made = true @ step
            if remembers:
                with_secants(weights, *memory, count, step, made)
                count = keep_secant(weights, *memory, count, turns > 0, step, made)
            x, flow, turns = x + step, flow + made, turns + 1
            assert flow == pytest.approx(true @ x, abs=1e-9)
            residual = right - flow
        counts.append(turns)
        assert x == pytest.approx(np.linalg.solve(true, right), abs=1e-9)
    assert counts[1] < 0.7 * counts[0]
    assert counts[2] < counts[1]


def test_a_guess_counts_on_what_the_last_two_missed_by() -> None:
    """Alike in both: the next misses by it too; of unlike signs: by nothing."""
    weights, missed = np.array([1.0, 1e3]), np.array([[1e-3, 1e-4], [0.8e-3, 1.2e-4], [0.0, 0.0]])
    assert goes_on_missing(weights, missed)
    missed[1] *= -1.0
    assert not goes_on_missing(weights, missed)


def test_products_are_carried_with_the_motion() -> None:
    """Over a step of Newmark's rule, against the products of what it leads to."""
    random = np.random.default_rng(4)
    n, dt, beta, gamma = 7, 0.01, 0.25, 0.5
    mass, damping, stiffness = random.normal(size=(3, n, n))
    mass, damping, stiffness = mass + mass.T, damping + damping.T, stiffness + stiffness.T
    b, v, a, step = random.normal(size=(4, n))
    after = (step / dt - v) / (beta * dt) - (0.5 / beta - 1.0) * a
    v_after = v + dt * ((1.0 - gamma) * a + gamma * after)
    flows = np.array([mass @ v, mass @ a, damping @ v, damping @ a, np.zeros(n), np.zeros(n)])
    held = stiffness @ b
    rates = 1.0 / (beta * dt), 0.5 / beta - 1.0, dt, gamma
    carry_products(mass, damping, stiffness, step, *rates, flows, held)
    assert held == pytest.approx(stiffness @ (b + step), rel=1e-12)
    found = [mass @ v_after, mass @ after, damping @ v_after, damping @ after]
    assert flows[:4] == pytest.approx(np.array(found), rel=1e-9)
    assert flows[4] == pytest.approx(damping @ (0.5 * (v + v_after)), rel=1e-9)


@pytest.fixture(scope="module")
def frame() -> Frame:
    """Return a storey on 16 bearings, whose diaphragm has 3 of their 51 unknowns."""
    return moment_frame(bays=(3, 3), storeys=1, bearing=bearing_for(500e3))


def test_what_the_structure_makes_of_a_correction(frame, monkeypatch):
    """The tangent's product less the bearings', which the kernel takes element by element."""
    monkeypatch.setattr(frames.bundles.model_data, "MANY", 10)
    analysis._KEPT.clear()
    model = gravity(frame).model
    n_b, n_v = len(model.load_b), len(model.load_b) - len(model.shared)
    assert len(model.shared) == 3  # of the diaphragm: in plan
    random = np.random.default_rng(5)
    before, latest = random.normal(size=(2, len(model.props), 12, 12))
    assembled = np.zeros((n_b, n_b))
    for k, start in enumerate(model.start):
        rows = np.zeros((12, n_b))
        for row in range(12):
            for i in range(start[row], start[row + 1]):
                rows[row, model.columns[i]] += model.values[i]
        inner = rows.copy()
        inner[:, model.shared] = 0.0
        assembled += rows.T @ latest[k] @ rows + inner.T @ (before[k] - latest[k]) @ inner
    x, flow = random.normal(size=n_b), np.zeros(n_b)
    linear_part_of_correction(
        model.start,
        model.columns,
        model.values,
        latest,
        before,
        0.7,
        model.place,
        n_v,
        x,
        np.zeros((4, 12)),
        flow,
    )
    assert flow == pytest.approx(-0.7 * (assembled @ x), rel=1e-9, abs=1e-9)


CASES: dict[str, dict[str, Any]] = {
    "chosen steps": {},
    "fixed steps": {"dt": 0.01},
    "one impact after the other": {"scale": 1.5},
    "damped integration": {"integrator": "generalised-alpha", "spectral_radius": 0.8},
    "discs": {"level": "contact"},
    "few vectors": {"method": "reduced"},
}


@pytest.mark.parametrize("case", CASES)
def test_histories_are_the_same(case: str, frame: Frame, monkeypatch: pytest.MonkeyPatch) -> None:
    """Kept apart or not: the same steps, and motions within Newton's tolerance."""
    options = dict(CASES[case])
    scale = options.pop("scale", 1.0)
    t = np.arange(121) * 0.01
    wave = np.sin(2.0 * np.pi * t / 0.9)
    motion = GroundMotion(x=2.2 * scale * wave, y=1.0 * wave, z=1.5 * wave**2, dt=0.01)
    found = []
    for many in (10, 10**6):
        monkeypatch.setattr(frames.bundles.model_data, "MANY", many)
        analysis._KEPT.clear()
        found.append(time_history(frame, motion, **options))
    analysis._KEPT.clear()
    apart, whole = found
    assert apart.attrs["status"] == whole.attrs["status"] == "ok"
    assert apart.attrs["steps"] == whole.attrs["steps"]
    assert apart.attrs["newton_iterations"] != whole.attrs["newton_iterations"]  # by another way
    for name in ("bearing_displacement", "axial_force"):
        size = float(abs(whole[name]).max())
        assert apart[name].values == pytest.approx(whole[name].values, abs=2e-5 * size)
    closed = abs(apart["energy"].sel(term="numerical")).max() if case == "fixed steps" else 0.0
    assert float(closed) < 1e-5 * float(abs(apart["energy"].sel(term="input")).max())
