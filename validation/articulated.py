"""The double concave bearing with an articulated slider, as Fenz and Constantinou (2006) have it.

Source: Fenz and Constantinou (2006), Earthq. Eng. Struct. Dyn. 35, 1403. The two parts of the
slider meet in a hinge at distance h_i from surface i. Part i swings about its sphere's centre with
the radius ``R_eff,i = R_i - h_i`` of the hinge, and with the displacement u_i of the hinge against
its plate, under the load W,

    F = W u_i / R_eff,i + mu_i W sign(du_i)    on each surface,    u_1 + u_2 = U.

Both surfaces pass the same force: two such elements in series, each of which stands still while F
lies between its friction's limits, and stops where its part meets the rim, at
``u_i = d_i R_eff,i / R_i``. From this follow their regimes: first the surface of lower friction
alone (stiffness W / R_eff,1), from ``u* = (mu_2 - mu_1) R_eff,1`` on both
(W / (R_eff,1 + R_eff,2)), after the first rim the other alone (W / R_eff,2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from frames._types import FloatArray
    from lir_element import LIRBearing


@dataclass(frozen=True)
class Articulated:
    """A double concave bearing with an articulated slider; the load is 1."""

    radii: tuple[float, float]
    """Effective radii R_i - h_i [m]."""
    frictions: tuple[float, float]
    """Coefficients of friction [-]."""
    reach: tuple[float, float] = (math.inf, math.inf)
    """Displacements of the hinge at which each rim is met [m]."""

    @property
    def at_zero(self) -> float:
        """Force at zero displacement while both surfaces slide, over the load [-]."""
        moment = sum(mu * r for mu, r in zip(self.frictions, self.radii, strict=True))
        return moment / sum(self.radii)

    @property
    def second_starts(self) -> float:
        """Displacement u* at which the second surface starts to slide [m]."""
        first = int(np.argmin(self.frictions))
        return abs(self.frictions[1] - self.frictions[0]) * self.radii[first]

    def force(self, path: FloatArray) -> FloatArray:
        """Return the force over the load along a path of displacements [m] from rest [-].

        Shapes: path (n,), result (n,).
        """
        places = (0.0, 0.0)
        forces = np.zeros(len(path))
        for k, target in enumerate(path):
            if target == sum(places):  # at rest: any force that friction holds would do
                forces[k] = forces[k - 1] if k else 0.0
                continue
            low, high = -10.0, 10.0
            for _ in range(60):
                middle = 0.5 * (low + high)
                if sum(self._moved(places, middle)) < target:
                    low = middle
                else:
                    high = middle
            forces[k] = 0.5 * (low + high)
            places = self._moved(places, forces[k])
        return forces

    def _moved(self, places: tuple[float, float], force: float) -> tuple[float, float]:
        # Displacements of both hinges under a force: each follows it at the distance of friction.
        first, second = (
            max(-reach, min(reach, (force + mu) * radius, max(place, (force - mu) * radius)))
            for place, mu, radius, reach in zip(
                places, self.frictions, self.radii, self.reach, strict=True
            )
        )
        return first, second


def articulated(bearing: LIRBearing, *, moments: bool = False, share: float = 0.5) -> Articulated:
    """Return the bearing with an articulated slider."""
    heights = (share * bearing.slider_height, (1.0 - share) * bearing.slider_height)
    first, second = (r - h for r, h in zip(bearing.radii, heights, strict=True))
    ratios = (first / bearing.radii[0], second / bearing.radii[1])
    mu = [law.f_max for law in bearing.frictions]
    if moments:
        mu = [m / ratio for m, ratio in zip(mu, ratios, strict=True)]
    rims = bearing.rim_displacement
    return Articulated((first, second), (mu[0], mu[1]), (rims[0] * ratios[0], rims[1] * ratios[1]))
