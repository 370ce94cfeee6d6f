"""The search for the slider's axis where the slider leaves a rim and its slip turns round.

There the laws of friction make the equilibrium unsymmetric, and a search from the axis that keeps
the slip may run in circles. The committed state is one that a shaken building came to.
"""

from typing import Any

import numpy as np

from lir_element import Element
from lir_element.kernels.levels import bearing_trial
from tests.scenes import paper_bearing

BEARING = paper_bearing(design_load=286.73e3, friction=0.065)
COMMITTED: dict[str, Any] = {
    "step": 0.005,
    "axis": (0.10804290204869181, -0.02594252458763105, 0.993807685991066),
    "axis_top": (0.1080756715024258, -0.02593934990884151, 0.9938042057445755),
    "centres": (-0.25571327721775805, 0.015614639258433824, -2.235844557166208),
    "string": 2.2500325933189456,
    "closure": 3.259331894556183e-05,
    "axial_force": 382962.5495154226,
    "slip": (-0.012627051310559939, -0.04275356700901603),
    "sliding_increment": ((-7.606e-06, -2.6592e-05), (-3.2443e-06, -1.7502e-05)),
    "slip_increment": (-0.001108355644144382, -0.0004904127131961505),
    "hysteresis": ((-0.7343052674, -0.6788193974), (-0.5752055547, -0.8180089057)),
    "interface_hysteresis": (-0.9102039572178869, -0.4141603026183208),
    "friction_coefficient": (0.065, 0.065),
    "rim_closure": (3.222138296093968e-06, 4.0102995615909354e-05),
    "rim_force": (4072.352229187957, 47028.266031859996),
}
PLACE = np.array([-0.25575437965619113, 0.015602400439296263, 0.014155442057758542, 0.0, 0.0, 0.0])
PLACE[3:] = 1.0326979783295602e-05, -3.468594079369063e-05, 6.559672319663562e-05
MOVE = np.array([-9.89697630e-04, -5.17927206e-04, 1.25944642e-04, 0.0, 0.0, 0.0])
MOVE[3:] = -3.85570252e-06, 2.04426567e-05, 4.13880239e-06


def test_a_search_that_runs_in_circles_begins_anew() -> None:
    element = Element(BEARING)
    committed = element._committed
    for name, value in COMMITTED.items():
        committed[name] = value
    committed["displacement"][0, 6:] = PLACE
    shares = np.linspace(0.0, 1.5, 151)
    forces, codes = [], []
    for share in shares:
        u = np.zeros(12)
        u[6:] = PLACE + share * MOVE
        arguments = (element._props, committed, element._trial, element._work, None, 0)
        codes.append(bearing_trial(*arguments, u, np.zeros(12), 0.005))
        forces.append(element.resisting_force()[6:9])
    assert codes == [0] * len(shares)
    # one branch: from step to step the force changes as its own tangent allows
    changes = np.abs(np.diff(forces, axis=0)).max(axis=0)
    assert (changes < 0.02 * BEARING.resolved()["design_load"]).all()
