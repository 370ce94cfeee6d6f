"""The testing rig at the level 'rigid_body': the top plate driven along its path under load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lir_element.bundles.rigid_data import FIRST_STEP, rigid_input, rigid_run, rigid_setup
from lir_element.device.bearing import STANDARD_GRAVITY
from lir_element.interruptible import interruptible
from lir_element.kernels.rigid_body.integrate import integrate_bodies, start

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import Contacts
    from lir_element.errors import RunStatus
    from lir_element.layout import Floats, Records


def drive_path(
    props: Records,
    contacts: Contacts,
    state: Records,
    path: Floats,
    loads: Floats,
    velocity: float,
) -> tuple[Records, Records, int, RunStatus, float, Records]:
    """Take one bearing in equilibrium through a path of its top plate, as rigid bodies.

    The rig's plate weighs what it carries: axial load over standard gravity.

    Shapes: path (n, 2), loads (n,).
    """
    mass = np.max(loads) / STANDARD_GRAVITY
    run = rigid_run(
        props,
        contacts,
        state,
        np.full(3, mass),
        np.zeros(3),
        np.array([0, 0, 1, 0, 0, 0]),
        driven=True,
    )
    points = np.vstack([np.zeros((1, 2)), path])
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    count = len(points)
    load = np.zeros((count, 6))
    load[:, 2] = -np.concatenate([loads[:1], loads])
    times = np.concatenate([[0.0], np.cumsum(lengths / velocity)])
    given, out = rigid_input((np.zeros((2, 3)), 1.0), times, points, load)
    length = float(props["length"][0])
    largest = 0.2 * float(props["yield_displacement"].min()) / velocity
    setup = rigid_setup(length, largest)
    run.clock["step"] = min(FIRST_STEP, largest)
    start(run, given)

    def go(last: int, tries: int) -> int:
        return integrate_bodies(run, given, setup, last, tries)

    status = interruptible(go, lambda: int(run.counts["outputs"][0]), count)
    reached = int(run.counts["outputs"][0]) - 1
    time = float(run.clock["time"][0])
    return out.states[1:], out.bodies[1:], reached, status, time, run.states[2:]
