"""Equivalent properties of a plain bearing over its whole height, for elements of OpenSees.

Source: moment equilibrium of the rigid slider (docs/theory.md, section 2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from lir_element.argument_checks import require_positive
from lir_element.device.bearing_checks import (
    TO_OPENSEES,
    require_constant_friction,
    require_lasting_rims,
    require_no_backup,
)
from lir_element.device.friction import CoulombFriction, VelocityFriction

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing

_SAME = 1e-9  # relative difference up to which two rates count as equal


@dataclass(frozen=True, kw_only=True)
class BuiltinValues:
    """Equivalent properties of a plain bearing, for elements with one displacement.

    With ``L = R1 + R2 - h``, U the displacement over the bearing and W the axial load:

    Attributes
    ----------
    length : float
        Effective radius L [m]: post-sliding stiffness W / L.
    friction_max, friction_min : float
        Strength over W at high speed and at zero speed [-]: ``(mu1 R1 + mu2 R2) / L``, from the
        moment equilibrium of the rigid slider, which slides on both surfaces at once for any radii
        and frictions. An element with mu itself is too weak by h / L.
    rate : float
        Rate of friction over the velocity of the **bearing** [s/m]: ``alpha R / L``, because the
        sliding on a surface is ``R U / L``. Zero if friction does not depend on speed.
    yield_displacement : float
        Displacement U at the start of sliding [m]: ``u_y (mu1 R1 + mu2 R2) L / (mu1 R1^2 + mu2
        R2^2)``, hence ``u_y L / R`` if the radii are equal.
    initial_stiffness : float
        Before sliding [N/m]: ``friction_max W / yield_displacement + W / L``. The bearing itself
        keeps its yield displacement, the elements keep this stiffness.
    axial_stiffness, axial_damping : float
        Stiffness [N/m] and damping [N s/m] of the vertical material in compression.
    torque, torsion_yield : float
        Resistance to rotation about the vertical axis [N m], and the rotation at which it is
        reached [rad].

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import builtin_values
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> values = builtin_values(bearing.as_dcfp(), 150e3)
    >>> round(values.length, 3), round(values.friction_max, 4)
    (1.415, 0.07)
    """

    length: float
    friction_max: float
    friction_min: float
    rate: float
    yield_displacement: float
    initial_stiffness: float
    axial_stiffness: float
    axial_damping: float
    torque: float
    torsion_yield: float


def builtin_values(bearing: LIRBearing, axial_load: float) -> BuiltinValues:
    """Return the equivalent properties of a plain bearing over its whole height.

    Parameters
    ----------
    bearing : LIRBearing
        The device; its rigid slider.
    axial_load : float
        Load that the stiffness before sliding and the torque refer to [N].

    Returns
    -------
    BuiltinValues
        The values.

    Raises
    ------
    ValueError
        If the slider is in two pieces. If friction follows a law other than these two, cannot be
        written as one law, or depends on pressure or temperature.

    Examples
    --------
    >>> import math
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=CoulombFriction(0.066), interface_friction=math.inf)
    >>> values = builtin_values(bearing, 150e3)
    >>> round(values.length, 3), round(values.friction_max, 4)
    (1.415, 0.07)
    """
    load = require_positive("axial_load", axial_load, "N")
    if not bearing.is_dcfp:
        msg = (
            f"interface_friction = {bearing.interface_friction:g}: no element of OpenSees "
            "has a slipping interface; use bearing.as_dcfp()"
        )
        raise ValueError(msg)
    if bearing.friction_law != "elastic-plastic":
        msg = (
            f'friction_law = "{bearing.friction_law}": these elements are elastic-perfectly '
            'plastic; set friction_law="elastic-plastic"'
        )
        raise ValueError(msg)
    require_constant_friction(bearing, TO_OPENSEES)
    require_lasting_rims(bearing, TO_OPENSEES)
    require_no_backup(bearing, TO_OPENSEES)
    radii, laws, length = bearing.radii, laws_of_opensees(bearing), bearing.effective_radius
    least = min(law.f_min for law in laws)
    if least <= 0.0:
        msg = (
            f"friction coefficient {least:g}: friction models of OpenSees need a positive "
            "one; use a small value, 1e-6"
        )
        raise ValueError(msg)
    highs = [law.f_max if law.rate > 0.0 else law.f_min for law in laws]
    high, low = (
        sum(mu * r for mu, r in zip(values, radii, strict=True)) / length
        for values in (highs, [law.f_min for law in laws])
    )
    square = sum(mu * r**2 for mu, r in zip(highs, radii, strict=True)) / length**2
    slip = bearing.yield_displacement * high / square
    options = bearing.resolved()
    lever = 2.0 / 3.0 * bearing.slider_radius
    return BuiltinValues(
        length=length,
        friction_max=high,
        friction_min=low,
        rate=_rate(bearing),
        yield_displacement=slip,
        initial_stiffness=load * (high / slip + 1.0 / length),
        axial_stiffness=options["axial_stiffness"],
        axial_damping=options["axial_damping"],
        torque=lever * min(highs) * load * bearing.torsional_friction,
        torsion_yield=bearing.yield_displacement / lever,
    )


def laws_of_opensees(bearing: LIRBearing) -> list[CoulombFriction | VelocityFriction]:
    """Return the friction of both surfaces, of laws that OpenSees' friction models follow."""
    known = (CoulombFriction, VelocityFriction)
    for law in bearing.frictions:
        if not isinstance(law, known):
            msg = (
                f"friction = {law!r}: OpenSees supports Coulomb friction (CoulombFriction) and "
                "exponential friction (VelocityFriction): use one of them, or bearing_element "
                "for any law"
            )
            raise ValueError(msg)
    return [law for law in bearing.frictions if isinstance(law, known)]


def _rate(bearing: LIRBearing) -> float:
    # Rate of one law for both surfaces, over the velocity of the bearing; 0 if speed has no effect.
    laws, radii = laws_of_opensees(bearing), bearing.radii
    rates = [
        law.rate * r / bearing.effective_radius
        for law, r in zip(laws, radii, strict=True)
        if law.f_max > law.f_min and law.rate > 0.0
    ]
    if rates and max(rates) - min(rates) > _SAME * max(rates):
        msg = (
            f"radius = {radii} with friction rates {tuple(law.rate for law in laws)} s/m: "
            "one law cannot represent surfaces with different rates over the bearing's "
            f"velocity ({rates[0]:.4g} and {rates[1]:.4g} s/m): use equal rate * radius, or "
            "CoulombFriction"
        )
        raise ValueError(msg)
    return rates[0] if rates else 0.0
