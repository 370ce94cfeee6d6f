"""Laws of force and deformation for nonlinear links: input of `Frame.add_link`.

A link has one deformation d, positive in tension or along its direction, and one force f. Laws with
an elastic stiffness belong to the structure and carry permanent loads; the others (dampers, stops,
ties) are added afterwards: their deformation counts from the state under permanent loads.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TypeAlias

from frames._errors import ModelError
from lir_element.argument_checks import require_positive, require_type, require_within
from lir_element.fields import check_numbers, number

_STIFFNESS = number("N/m", "(0, inf)")
_FORCE = number("N", "(0, inf)")
_ENDLESS = number("N/m", "(0, inf]")
_SHARE = number("-", "[0, 0.999999999)")  # below 1
_GROWTH = number("-", "[0, inf)")
_LENGTH = number("m", "[0, inf)")


class _Checked:
    """A law whose numbers stay in the bounds of their fields."""

    def __post_init__(self) -> None:
        check_numbers(self, error=ModelError, owner=f"{type(self).__name__}: ")


@dataclass(frozen=True, kw_only=True)
class Bilinear(_Checked):
    """Elastic-plastic law with linear kinematic hardening: a yielding storey, a brace that yields.

    Attributes
    ----------
    stiffness : float
        Elastic stiffness k [N/m, N m/rad].
    yield_force : float
        Force at first yield [N, N m].
    hardening : float
        Stiffness after yielding over the elastic one [-], in [0, 1).

    Examples
    --------
    >>> law = Bilinear(stiffness=60e6, yield_force=300e3, hardening=0.03)
    >>> 1e3 * law.yield_force / law.stiffness  # mm
    5.0
    """

    stiffness: float = field(metadata=_STIFFNESS)
    yield_force: float = field(metadata=_FORCE)
    hardening: float = field(default=0.0, metadata=_SHARE)

    @property
    def yield_deformation(self) -> float:
        """Deformation at first yield [m, rad]."""
        return self.yield_force / self.stiffness


@dataclass(frozen=True, kw_only=True)
class Pinching(_Checked):
    """Pinching of a Bouc-Wen law, after Baber and Noori (1985) and Foliente (1995); all in [-].

    Attributes
    ----------
    slip : float
        Largest share zeta_s of the stiffness that slip removes, in [0, 1).
    rate : float
        Rate of its growth with the dissipated energy, p.
    place : float
        Force over the largest one at the deepest pinching, q.
    width : float
        Spread psi of the pinched part, of the largest force.
    spreading : float
        Growth delta_psi of the spread with the energy dissipated.
    severity : float
        lambda, by which the spread follows the depth.

    Examples
    --------
    >>> from frames.laws import BoucWen
    >>> law = BoucWen(stiffness=60e6, yield_force=300e3, pinching=Pinching(severity=0.2))
    >>> law.pinching.severity
    0.2
    """

    slip: float = field(default=0.9, metadata=_SHARE)
    rate: float = field(default=0.5, metadata=_GROWTH)
    place: float = field(default=0.1, metadata=_SHARE)
    width: float = field(default=0.2, metadata=number("-", "(0, inf)"))
    spreading: float = field(default=0.005, metadata=_GROWTH)
    severity: float = field(default=0.1, metadata=number("-", "(0, inf)"))


@dataclass(frozen=True, kw_only=True)
class BoucWen(_Checked):
    """Smooth hysteresis that may lose strength and stiffness and pinch: concrete, timber, steel.

    ``f = r k d + (1 - r) k u_y z``, with ``dz = h (1 - nu |z|^n (beta sgn(z dd) + 1 - beta))
    / eta * dd / u_y``; ``nu = 1 + strength_loss E``, ``eta = 1 + stiffness_loss E``, E the energy
    that z has dissipated over ``yield_force * u_y``. Source: Baber and Noori (1985); the pinching h
    after Foliente (1995).

    Attributes
    ----------
    stiffness : float
        Elastic stiffness k [N/m, N m/rad].
    yield_force : float
        k u_y, the force that is reached asymptotically without hardening [N, N m].
    hardening : float
        Stiffness after yielding over the elastic one, r [-], in [0, 1).
    exponent : float
        n [-], at least 1: how sharply it yields.
    shape : float
        beta [-] in (0, 1]: 0.5 unloads straight, larger values unload in a curve.
    strength_loss, stiffness_loss : float
        Degradation a unit of normalised energy [-], >= 0.
    pinching : Pinching or None
        Slip that pinches the loops.

    Examples
    --------
    >>> from frames.laws import Pinching
    >>> law = BoucWen(stiffness=60e6, yield_force=300e3, strength_loss=0.01, pinching=Pinching())
    >>> law.pinching.slip
    0.9
    """

    stiffness: float = field(metadata=_STIFFNESS)
    yield_force: float = field(metadata=_FORCE)
    hardening: float = field(default=0.0, metadata=_SHARE)
    exponent: float = field(default=2.0, metadata=number("-", "[1, 20)"))
    shape: float = field(default=0.5, metadata=number("-", "[1e-6, 1]"))
    strength_loss: float = field(default=0.0, metadata=_GROWTH)
    stiffness_loss: float = field(default=0.0, metadata=_GROWTH)
    pinching: Pinching | None = None

    def __post_init__(self) -> None:
        """Check the numbers, and that the pinching is one."""
        super().__post_init__()
        require_type(
            "BoucWen: pinching", self.pinching, (Pinching, type(None)), "a Pinching or None"
        )

    @property
    def yield_deformation(self) -> float:
        """Deformation u_y at which it would yield without its curve [m, rad]."""
        return self.yield_force / self.stiffness


@dataclass(frozen=True, kw_only=True)
class Tie(_Checked):
    """A slender brace, rod or cable: it pulls only, yields, and is slack by its plastic strain.

    Attributes
    ----------
    stiffness : float
        Stiffness in tension [N/m].
    yield_force : float
        Force at yield [N]; infinity for one that stays elastic.
    hardening : float
        Stiffness after yielding over the elastic one [-], in [0, 1).
    slack : float
        Elongation from the state under permanent loads at which it begins to pull [m], >= 0.

    Examples
    --------
    >>> Tie(stiffness=20e6, yield_force=150e3)
    Tie(stiffness=20000000.0, yield_force=150000.0, hardening=0.0, slack=0.0)
    """

    stiffness: float = field(metadata=_STIFFNESS)
    yield_force: float = field(default=math.inf, metadata=number("N", "(0, inf]"))
    hardening: float = field(default=0.0, metadata=_SHARE)
    slack: float = field(default=0.0, metadata=_LENGTH)

    @property
    def yield_deformation(self) -> float:
        """Elongation from the beginning of its pull to yield [m]."""
        return self.yield_force / self.stiffness


@dataclass(frozen=True, kw_only=True)
class ViscousDamper(_Checked):
    """A fluid damper, ``f = c |v|^exponent sgn(v)``; with a stiffness in series (Maxwell).

    Attributes
    ----------
    coefficient : float
        c [N (s/m)^exponent].
    exponent : float
        [-] in [0.1, 2]: 1 is linear; devices have 0.15 to 1.
    stiffness : float
        Stiffness of brace, clevis and fluid in series [N/m]; infinity for none.
    linear_below : float
        Speed below which the force is smoothed if the exponent is below 1 [m/s].

    Examples
    --------
    >>> damper = ViscousDamper(coefficient=400e3, exponent=0.4)
    >>> round(damper.coefficient * 0.3**damper.exponent / 1e3)  # kN at 0.3 m/s
    247
    """

    coefficient: float = field(metadata=number("N (s/m)^exponent", "(0, inf)"))
    exponent: float = field(default=1.0, metadata=number("-", "[0.1, 2]"))
    stiffness: float = field(default=math.inf, metadata=_ENDLESS)
    linear_below: float = field(default=1e-3, metadata=number("m/s", "(0, inf)"))


@dataclass(frozen=True, kw_only=True)
class Gap(_Checked):
    """A wall or buffer behind a gap, with linear stiffness and damping (Kelvin-Voigt).

    It pushes only, ``f = k x + c v`` for a penetration x > 0, and never pulls. So that the force
    is continuous the damping comes in over the first `soft` metres.

    Attributes
    ----------
    gap : float
        Deformation at contact [m], >= 0.
    stiffness : float
        k [N/m].
    damping : float
        c [N s/m], >= 0; `Gap.damping_for` gives it for a coefficient of restitution.
    soft : float
        Penetration over which the damping comes in [m].

    Examples
    --------
    >>> from frames import Frame
    >>> from frames.demo import bearing_for
    >>> from frames import lumped_mass
    >>> frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    >>> frame.add_moat("moat", ["mass"], Gap(gap=0.3, stiffness=500e6))
    """

    gap: float = field(metadata=_LENGTH)
    stiffness: float = field(metadata=_STIFFNESS)
    damping: float = field(default=0.0, metadata=number("N s/m", "[0, inf)"))
    soft: float = field(default=1e-4, metadata=number("m", "(0, inf)"))

    @staticmethod
    def damping_for(restitution: float, stiffness: float, mass: float) -> float:
        """Return the damping that makes a mass rebound with a share of its speed.

        Parameters
        ----------
        restitution : float
            Speed after over speed before the impact [-], in [0.15, 1].
        stiffness : float
            Stiffness of the stop [N/m].
        mass : float
            Mass of the body that hits it, against a fixed wall [kg].

        Returns
        -------
        float
            c = 2 xi (k m)^(1/2) [N s/m] of a stop that does not pull, with
            ``e = exp(-xi / w (pi - atan2(2 xi w, 1 - 2 xi^2)))``, ``w = (1 - xi^2)^(1/2)``
            (Schwager and Poeschel 2007, eq. 12).
        """
        what = "Gap.damping_for: restitution"
        e = require_within(what, restitution, "[0.15, 1]", "-", error=ModelError)
        k = require_positive("Gap.damping_for: stiffness [N/m]", stiffness, error=ModelError)
        m = require_positive("Gap.damping_for: mass [kg]", mass, error=ModelError)

        def left(ratio: float) -> float:
            w = math.sqrt(1.0 - ratio * ratio)
            turn = math.pi - math.atan2(2.0 * ratio * w, 1.0 - 2.0 * ratio * ratio)
            return math.exp(-ratio / w * turn) - e

        from scipy.optimize import brentq  # imported on use, which is rare

        ratio = brentq(left, 0.0, 1.0 - 1e-9, xtol=1e-12) if e < 1.0 else 0.0
        return 2.0 * float(ratio) * math.sqrt(k * m)


@dataclass(frozen=True, kw_only=True)
class HertzGap(_Checked):
    """A wall behind a gap with Hertz' contact and damping: pounding of bodies.

    ``f = k x^n (1 + a v / v_0)`` for a penetration x > 0, v_0 the speed of approach (Hunt and
    Crossley 1975). The damping a follows from the restitution by ``a (1 + e) = ln((1 + a) /
    (1 - a e))``, which is exact for any n (Gonthier et al. 2004, eq. 13); near e = 1 it is the 3/4
    (1 - e^2) of Muthukumar and DesRoches (2006).

    Attributes
    ----------
    gap : float
        Deformation at contact [m], >= 0.
    stiffness : float
        k [N/m^exponent].
    restitution : float
        e, speed after over speed before the impact [-], in [0.05, 1].
    exponent : float
        n [-], in [1, 3]; 1.5 of two spheres.

    Examples
    --------
    >>> from frames.demo import bearing_for
    >>> from frames import lumped_mass
    >>> frame = lumped_mass(bearing_for(2000e3), mass=204e3)
    >>> frame.add_moat("moat", ["mass"], HertzGap(gap=0.3, stiffness=2e9, restitution=0.6))
    """

    gap: float = field(metadata=_LENGTH)
    stiffness: float = field(metadata=number("N/m^exponent", "(0, inf)"))
    restitution: float = field(default=0.7, metadata=number("-", "[0.05, 1]"))
    exponent: float = field(default=1.5, metadata=number("-", "[1, 3]"))

    @property
    def damping(self) -> float:
        """Damping a of the force at the speed of approach over the elastic one [-]."""
        e = self.restitution

        def open_loop(a: float) -> float:
            return a * (1.0 + e) - math.log1p(a) + math.log1p(-a * e)

        if e > 1.0 - 1e-6:
            return 0.0
        from scipy.optimize import brentq

        return float(brentq(open_loop, 1e-3 * (1.0 - e), (1.0 - 1e-12) / e, xtol=1e-14))


@dataclass(frozen=True, kw_only=True)
class PlasticHinge(_Checked):
    """A plastic hinge at a member's end with interaction of axial force and both moments.

    It is rigid until ``m + |n|^axial_exponent = 1`` with ``m^2 = (My/moment_y)^2 +
    (Mz/moment_z)^2`` and ``n = (N - axial_centre) / axial``; then it turns, and lengthens, along
    the normal of that surface (associated flow), with linear kinematic hardening. Member's axes.

    Attributes
    ----------
    moment_y, moment_z : float
        Plastic moments about local y and z [N m]; infinity if it does not yield.
    axial : float
        Axial force from `axial_centre` at which no moment is left [N]; infinity: no interaction.
    axial_centre : float
        Axial force at the largest moment, tension positive [N]: 0 of steel; of a concrete column
        the force at balance, with the moments that belong to it.
    axial_exponent : float
        [-] in [1, 4]: 1.3 of I-sections about the strong axis (Duan and Chen 1989), 2 of
        rectangles and of concrete.
    hardening : float
        Stiffness of the hinged member in double curvature after yielding over the elastic one [-],
        in [0, 0.9); steel beams 0.03 (ASCE/SEI 41-17, 9.4.2.2).
    yield_rotation : float, optional
        Rotation that counts as ductility 1 in campaigns [rad]; None: ``M L / (6 E I)`` of the
        member.

    Examples
    --------
    >>> from frames import moment_frame
    >>> from frames.demo import bearing_for
    >>> beam = PlasticHinge(moment_y=400e3, hardening=0.02)  # N m
    >>> frame = moment_frame((1, 1), 2, bearing=bearing_for(400e3), hinges={"beam": beam})
    >>> len(frame.hinges)
    8
    """

    moment_y: float = field(default=math.inf, metadata=number("N m", "(0, inf]"))
    moment_z: float = field(default=math.inf, metadata=number("N m", "(0, inf]"))
    axial: float = field(default=math.inf, metadata=number("N", "(0, inf]"))
    axial_centre: float = field(default=0.0, metadata=number("N"))
    axial_exponent: float = field(default=2.0, metadata=number("-", "[1, 4]"))
    hardening: float = field(default=0.01, metadata=number("-", "[0, 0.9)"))
    yield_rotation: float | None = field(default=None, metadata=number("rad", "(0, inf)"))

    def __post_init__(self) -> None:
        """Check the numbers, and that they go together."""
        super().__post_init__()
        if self.moment_y == self.moment_z == math.inf:
            msg = "PlasticHinge: moment_y and moment_z are both infinite: set at least one of them"
            raise ModelError(msg)
        if abs(self.axial_centre) >= self.axial:
            msg = (
                f"PlasticHinge: axial_centre = {self.axial_centre!r} N must be smaller than "
                f"axial = {self.axial!r} N"
            )
            raise ModelError(msg)
        if self.axial == math.inf and abs(self.axial_centre) > 0.0:
            msg = (
                "PlasticHinge: axial_centre needs axial: set axial to the axial strength "
                "without moment"
            )
            raise ModelError(msg)


Law: TypeAlias = Bilinear | BoucWen | Tie | ViscousDamper | Gap | HertzGap
LAWS = (Bilinear, BoucWen, Tie, ViscousDamper, Gap, HertzGap)


def elastic_stiffness(law: Law) -> float:
    """Return the stiffness of a link in the elastic structure [N/m]; 0 if it is added later."""
    return law.stiffness if isinstance(law, Bilinear | BoucWen) else 0.0
