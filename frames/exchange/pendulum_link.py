"""The friction isolator link that replaces a bearing in another program."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from lir_element import VelocityFriction
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from lir_element import LIRBearing


class PendulumLink(NamedTuple):
    """A friction isolator link that replaces a bearing under an axial load."""

    radius: float  # L = R_1 + R_2 - h [m]
    slow: float  # Q/W at rest [-]
    fast: float  # Q/W at high speed [-]
    rate: float  # of the speed of the whole bearing [s/m]
    elastic: float  # stiffness before sliding [N/m]
    effective: float  # secant to the displacement of the equivalent-linear analysis [N/m]
    damping: float  # with the energy of a cycle at that displacement [N s/m]
    vertical: float  # axial stiffness [N/m]


def pendulum_link(bearing: LIRBearing, load: float, displacement: float) -> PendulumLink:
    r"""Return the link equivalent to a bearing.

    .. math::
        K_{eff} = \frac{W}{L} + \frac{Q}{D}, \quad c = \frac{4 Q D}{\pi \omega D^2}, \quad
        \omega^2 = \frac{K_{eff} g}{W}

    Q/W of a surface that slides by u R_i / L at a displacement u is mu_i R_i / L; its rate
    parameter applies to the speed of the bearing times R_i / L. If the surfaces differ, the link
    has the mean weighted by the growth of friction with speed. Rims, interface and slip have no
    link.
    """
    length = bearing.effective_radius
    shares = [radius / length for radius in bearing.radii]
    laws = bearing.frictions
    fast = bearing.effective_friction
    grows = [isinstance(law, VelocityFriction) for law in laws]
    drops = [
        share * (law.f_max - law.f_min) if isinstance(law, VelocityFriction) else 0.0
        for share, law in zip(shares, laws, strict=True)
    ]
    drop = sum(drops)
    rate = 0.0
    if any(grows) and drop > 0.0:
        parts = [
            part * share * law.rate if isinstance(law, VelocityFriction) else 0.0
            for part, share, law in zip(drops, shares, laws, strict=True)
        ]
        rate = sum(parts) / drop
    strength = fast * load
    effective = load / length + strength / displacement
    omega = math.sqrt(effective * STANDARD_GRAVITY / load)
    return PendulumLink(
        radius=length,
        slow=fast - drop,
        fast=fast,
        rate=rate,
        elastic=strength / (bearing.yield_displacement * sum(shares)),
        effective=effective,
        damping=4.0 * strength / (math.pi * omega * displacement),
        vertical=float(bearing.to_record()["axial_stiffness"][0]),
    )
