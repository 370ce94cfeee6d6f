"""The strength of a restraining rim by its geometry and steel."""

from __future__ import annotations

import math

from scipy.optimize import brentq

from lir_element.argument_checks import require_positive


def ring_strength(
    *, thickness: float, height: float, arc: float, yield_stress: float, lever: float | None = None
) -> float:
    """Return the radial force at which the foot of a restraining ring yields [N].

    The loaded part of the ring is a cantilever on the plate. Its section of width `arc` and depth
    `thickness` resists the moment ``P lever`` and the shear force ``P``, with ``M / M_p + (V /
    V_p)^4 = 1``. The resistance of the ring as a hoop is left out.

    Parameters
    ----------
    thickness, height : float
        Radial thickness of the ring's wall, and its height above the plate [m].
    arc : float
        Length of the ring along its circumference that resists the force [m]: the contact length
        plus its spread down to the foot.
    yield_stress : float
        Yield stress of the steel, or of the weld at the foot if that is lower [Pa].
    lever : float, optional
        Height of the force above the foot [m]. Default: half of the ring's height.

    Returns
    -------
    float
        Force [N], for `LIRBearing.rim_yield_force`.

    Raises
    ------
    ValueError
        If a value is not positive, the lever exceeds the height, or no number holds the force.

    Notes
    -----
    Source: D. C. Drucker (1956), The effect of shear on the plastic bending of beams, J. Appl.
    Mech. 23, 509; ``M_p = f_y b t^2 / 4``, ``V_p = f_y b t / sqrt(3)``.

    Examples
    --------
    >>> from lir_element import ring_strength
    >>> force = ring_strength(thickness=0.03, height=0.04, arc=0.3, yield_stress=345e6)
    >>> round(force / 1e3)  # kN
    1035
    """
    given = {"thickness": thickness, "height": height, "arc": arc}
    for name, value in given.items():
        require_positive(name, value, "m")
    require_positive("yield_stress", yield_stress, "Pa")
    arm = 0.5 * height if lever is None else require_positive("lever", lever, "m")
    if arm > height:
        msg = f"lever = {arm:g} m must not exceed the ring's height = {height:g} m: reduce it"
        raise ValueError(msg)
    bending = yield_stress * arc * (thickness * thickness) / 4.0 / arm
    shear = yield_stress * arc * thickness / math.sqrt(3.0)
    if not 0.0 < min(bending, shear) <= max(bending, shear) < math.inf:
        msg = (
            f"thickness = {thickness:g} m, arc = {arc:g} m, lever = {arm:g} m and "
            f"yield_stress = {yield_stress:g} Pa give no finite force above 0: check the "
            "units (m, Pa)"
        )
        raise ValueError(msg)
    return float(brentq(lambda p: p / bending + (p / shear) ** 4 - 1.0, 0.0, min(bending, shear)))
