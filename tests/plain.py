"""What a script computes with compiled kernels, and the same as plain Python."""

import json
from typing import Any

import numpy as np

from tests.patience import fresh

ELEMENT = """
import numpy as np
from lir_element import Element, LIRBearing, VelocityFriction
out = []
for options in given["bearings"]:
    laws = tuple(VelocityFriction(*law) for law in options.pop("friction"))
    element = Element(LIRBearing(friction=laws, **options), *given["level"])
    for u, t in zip(given["u"], given["t"]):
        element.set_trial(u, np.zeros(12), t)
        element.commit()
        out.append(element.resisting_force().tolist())
    out += element.tangent_stiffness().tolist()
"""
"""Forces and tangents of bearings along a path."""

DEVICE = {
    "radius": (0.75, 1.1),
    "slider_height": 0.11,
    "slider_radius": 0.08,
    "axial_stiffness": 1e8,
    "rim_stiffness": 2e7,
    "slip_capacity": 0.08,
    "rim_overrun": 0.05,
    "friction": [(0.07, 0.03, 12.0), (0.09, 0.05, 6.0)],
}
"""Numbers that the bearings of both elements share."""


def both_ways(script: str, **given: Any) -> tuple[Any, Any]:
    """Return `out` of a script that is `given` values: compiled here, and as plain Python."""
    words = json.dumps(given)
    found = {"given": json.loads(words)}
    exec(script, found)  # of this suite  # noqa: S102
    around = "import json, sys\ngiven = json.loads(sys.argv[1])", "json.dump(out, sys.stdout)"
    code = "\n".join((around[0], script, around[1]))
    done = fresh(code, words, NUMBA_DISABLE_JIT="1")
    return found["out"], json.loads(done.stdout)


def forces_both_ways(
    bearings: list[dict[str, Any]], u: np.ndarray, time: np.ndarray, *level: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return forces and tangents of bearings along a path, compiled and as plain Python."""
    found = both_ways(ELEMENT, bearings=bearings, u=u.tolist(), t=time.tolist(), level=level)
    compiled, python = map(np.array, found)
    return compiled, python
