"""Time histories against an independent route: full coordinates, Newmark, plain Python, Element.

Nothing of the change of basis, the assembly of bearings or the compiled loop is used here: the
matrices of the frame, bearings as `Element` objects, and a damping matrix built from its
definition (it acts on the motion relative to what follows the bearings quasi-statically).
"""

import numpy as np
from numpy.testing import assert_allclose

from frames import Frame, GroundMotion, RayleighDamping, gravity, moment_frame
from frames.solve import run as run_module
from lir_element import CoulombFriction, Element, VelocityFriction
from tests.scenes import uneven_bearing

DT, STEPS = 0.005, 240


def two_storey_frame() -> Frame:
    bearing = uneven_bearing(
        slider_radius=0.08,
        capacity=0.06,
        friction=(VelocityFriction(0.06, 0.03, 20.0), CoulombFriction(0.05)),
    )
    frame = moment_frame(bays=(1, 1), storeys=2, bearing=bearing)
    frame.set_damping(RayleighDamping(0.03, (0.5, 0.1)))
    return frame


def shaking() -> np.ndarray:
    t = np.arange(STEPS) * DT
    waves = [
        1.6 * np.sin(2 * np.pi * t / 1.2),
        1.2 * np.sin(2 * np.pi * t / 0.9),
        0.6 * np.sin(2 * np.pi * t / 0.21),
    ]
    return np.column_stack(waves) * np.minimum(t / 0.3, 1.0)[:, None]


def relative_damping(frame: Frame, state) -> np.ndarray:
    system, held = state.system, state.basis.bearing_dofs
    mass, elastic = system.mass.toarray(), system.stiffness.toarray()
    stiffness = elastic + state.geometric.toarray()
    rest = np.setdiff1d(np.arange(len(mass)), held)
    inner = np.ix_(rest, rest)
    follow = -np.linalg.solve(stiffness[inner], stiffness[np.ix_(rest, held)])
    relative = np.zeros((len(rest), len(mass)))
    relative[:, rest], relative[:, held] = np.eye(len(rest)), -follow
    static = np.zeros((len(mass), len(held)))
    static[held], static[rest] = np.eye(len(held)), follow
    base = np.zeros((len(held), len(mass)))
    base[:, held] = np.eye(len(held))
    w1, w2 = (2 * np.pi / period for period in frame.damping.periods)
    beta = 2 * frame.damping.ratio / (w1 + w2)
    alpha = beta * w1 * w2
    upper = relative.T @ (alpha * mass[inner] + beta * stiffness[inner]) @ relative
    return upper + base.T @ (beta * static.T @ elastic @ static) @ base


def integrate(frame: Frame, ground: np.ndarray) -> np.ndarray:
    """Return nodal displacements (STEPS, n_nodes, 6) by Newmark's method in full coordinates."""
    state = gravity(frame)
    system = state.system
    n = len(system.load)
    mass = system.mass.toarray()
    stiffness = system.stiffness.toarray() + state.geometric.toarray()
    damping = relative_damping(frame, state)
    elements = [Element(bearing) for _, _, _, bearing in system.bearings]
    maps = system.bearing_rows.toarray().reshape(len(elements), 12, n)
    q, v, a = state.displacement.copy(), np.zeros(n), np.zeros(n)
    for element, rows in zip(elements, maps, strict=True):
        element.set_trial(rows @ q, np.zeros(12), 0.0)
        element.commit()
    history = [q]
    linear = 4 / DT**2 * mass + 2 / DT * damping + stiffness
    for k in range(1, STEPS):
        step = np.zeros(n)
        for _ in range(40):
            a_new, v_new = 4 / DT**2 * step - 4 / DT * v - a, 2 / DT * step - v
            force, tangent = np.zeros(n), np.zeros((n, n))
            for element, rows in zip(elements, maps, strict=True):
                element.set_trial(rows @ (q + step), rows @ v_new, k * DT)
                force += rows.T @ element.resisting_force()
                tangent += rows.T @ element.tangent_stiffness() @ rows
            residual = system.load - system.inertia_load @ ground[k] - force
            residual -= mass @ a_new + damping @ v_new + stiffness @ (q + step)
            if np.abs(residual).max() < 1e-9 * np.abs(system.load).sum():
                break
            step += np.linalg.solve(linear + tangent, residual)
        else:
            raise AssertionError(k)
        q, v, a = q + step, v_new, a_new
        for element in elements:
            element.commit()
        history.append(q)
    return np.array(system.transform @ np.array(history).T).T.reshape(STEPS, -1, 6)


def test_time_history_equals_newmark_in_full_coordinates(run, monkeypatch):
    monkeypatch.setattr(run_module, "_ENERGY_TOLERANCE", np.inf)  # the same steps on both couplings
    ground = shaking()
    expected = integrate(two_storey_frame(), ground)
    data = run(two_storey_frame(), GroundMotion(*ground.T, dt=DT), dt=DT)
    assert float(data["rim_force"].max()) > 0.0  # oblique rim contact and slip take part
    assert float(data["interface_slip_size"].max()) > 1e-3
    got = data["node_displacement"].to_numpy()[:STEPS]
    # Newton's tolerances (1e-7 and 1e-9 of the weight) over the stiffness: some 1e-8 m of 0.1 m
    assert_allclose(got, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())
