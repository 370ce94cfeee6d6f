"""An LIR-DCFP put together from elements that OpenSees brings along, to compare with.

    node i --+-- friction pendulum --+-- node m -- flat slider (interface) -- node j
             +-- gaps (rims) --------+

Sources: the documentation of OpenSees for singleFPBearing, flatSliderBearing and ElasticPPGap;
Fenz and Constantinou (2008), Earthq. Spectra 24, 1011, for the arrangement in series.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from lir_element.argument_checks import require_choice, require_non_negative, require_positive
from lir_element.device.bearing_checks import (
    TO_OPENSEES,
    require_constant_friction,
    require_lasting_rims,
    require_no_backup,
)
from lir_element.opensees.compare.builtin_mapping import laws_of_opensees
from lir_element.opensees.library import opensees
from lir_element.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lir_element.device.bearing import LIRBearing

Restoring = Literal["series", "across"]

_FIRST = 1_000_000  # OpenSees does not list tags of materials: begin far above usual ones
_FEWEST = 4
_MASS = 0.01  # of node m, over that of the axial load
_UP = (0.0, 0.0, 1.0, 1.0, 0.0, 0.0)  # local x upwards, local y along global x
_STRENGTH = 1e6  # of a gap, in axial loads: it shall not yield
_SLACK = 1e-6  # rotational stiffness of the bearing over load times effective radius
_ITERATIONS = 50
_TOLERANCE = 1e-10  # of the shear force inside an element, in axial loads


class MacroModel(NamedTuple):
    """The tags of the nodes and elements that `macro_model` made.

    Attributes
    ----------
    node : int or None
        Node m between pendulum and interface; None if the slider is rigid.
    pendulum : int
        The element that slides with low friction.
    rims : tuple of int
        The gap elements, four directions each.
    interface : int or None
        The flat slider of the interface.
    restoring : int or None
        The springs of ``restoring="across"``.
    materials, frictions : tuple of int
        Uniaxial materials and friction models.

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import macro_model, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> made = macro_model(bearing.as_dcfp(rims=False), 1, 2, load=150e3)
    >>> made.node, made.interface, made.rims
    (None, None, ())
    >>> ops.wipe()
    """

    node: int | None
    pendulum: int
    rims: tuple[int, ...]
    interface: int | None
    restoring: int | None
    materials: tuple[int, ...]
    frictions: tuple[int, ...]


def macro_model(
    bearing: LIRBearing,
    node_i: int,
    node_j: int,
    *,
    load: float,
    directions: int = 16,
    restoring: Restoring = "series",
    rise: bool = False,
    middle_mass: float | None = None,
    first_tag: int | None = None,
) -> MacroModel:
    """Build the macro-model of a bearing between two nodes of the current OpenSeesPy model.

    Parameters
    ----------
    bearing : LIRBearing
        The device.
    node_i, node_j : int
        Nodes of six degrees of freedom below and above, one over the other or coincident.
    load : float
        Axial load at rest [N]: stiffnesses before slip are those under it.
    directions : int
        Number of gap directions: 4, 8, 12 and so on. The rim is a polygon of so many sides about
        the circle; its corners are at ``1 / cos(pi / directions)`` of the radius.
    restoring : {"series", "across"}
        "series": a friction pendulum restores node m, before the interface. "across": a flat slider
        replaces it, and springs of stiffness ``load / L`` join node i to node j.
    rise : bool
        True if the friction pendulum lifts node m as it moves sideways (``-inclVertdisp``). Its
        tangent has no such term: Newton's method then needs many iterations, and often fails.
    middle_mass : float, optional
        Mass of node m [kg], at least 0. Default: 1 % of the mass of the axial load. The sliders'
        own mass is a hundredth or two of that, and with it Newton's method fails in most motions.
    first_tag : int, optional
        First of a range of tags that no node, element, material or friction model has. Default:
        beyond those of all nodes and elements, a million or more.

    Returns
    -------
    MacroModel
        The tags.

    Raises
    ------
    ValueError
        If the nodes do not suit, an option is out of bounds, or the interface is weaker than the
        surfaces.

    Notes
    -----
    Requirements of the arrangement:

    - A flat slider transfers the whole lateral force, while in the bearing the interface tilts with
      the slider and transfers the friction's share only. With ``mu_h`` the slider would slip at ``U
      = L (mu_h - m)``, m the friction over weight, before rim contact. So it gets the friction of
      the bearing's force limit, ``tan(theta + atan mu_h)``.
    - Both rims act on one displacement: a rim of stiffness k at ``d`` on radius R is a gap at
      ``d L / R`` of stiffness ``k (R / L)**2``. Gaps are elastic; dampers of rims are left out.
    - The rate of velocity-dependent friction belongs to the displacement of the whole bearing.
    - Node m rotates with node i. Its mass holds it if the bearing has lifted off.
    - The interface is as soft before slip as the surfaces if its own yield displacement is smaller:
      a small one makes Newton's method fail.

    Examples
    --------
    >>> from lir_element import LIRBearing
    >>> from lir_element.opensees import macro_model, opensees
    >>> ops = opensees()
    >>> ops.wipe()
    >>> ops.model("basic", "-ndm", 3, "-ndf", 6)
    >>> ops.node(1, 0.0, 0.0, 0.0)
    >>> ops.node(2, 0.0, 0.0, 0.0)
    >>> ops.fix(1, 1, 1, 1, 1, 1, 1)
    >>> bearing = LIRBearing(radius=0.75, slider_height=0.085, slider_radius=0.08, capacity=0.175,
    ...                      friction=0.066, interface_friction=0.126)
    >>> made = macro_model(bearing, 1, 2, load=150e3)
    >>> len(made.rims), made.interface is not None
    (4, True)
    >>> ops.wipe()
    """
    ops = opensees()
    _check_nodes(ops, node_i, node_j)
    weight = require_positive("load", load, "N")
    _check(bearing, directions, restoring)
    own = _MASS * weight / STANDARD_GRAVITY
    if middle_mass is not None:
        own = require_non_negative("middle_mass", middle_mass, "kg")
    tags = itertools.count(_first_tag(ops, first_tag))
    build = _Builder(ops, bearing, weight, tags, rise=rise)
    if math.isinf(bearing.force_limit(weight)):  # no rims, or a rigid slider: no slip
        middle, share = node_j, 1.0
    else:
        middle, share = next(tags), 2.0
        ops.node(middle, *ops.nodeCoord(node_i))
        ops.mass(middle, own, own, own, 0.0, 0.0, 0.0)
        ops.equalDOF(node_i, middle, 4, 5, 6)
    across = restoring == "across"
    axial = build.axial(share)
    surfaces = build.surface_friction()
    radius = None if across else bearing.effective_radius
    stiffness = build.surface_stiffness(across=across)
    pendulum = build.slider(node_i, middle, surfaces, stiffness, axial, radius)
    springs = build.springs(node_i, node_j) if across else None
    rims = build.rims(node_i, middle, directions)
    interface = None
    if middle != node_j:
        limit = bearing.force_limit(weight) / weight
        if across:  # the springs carry the restoring force past it
            limit -= bearing.lateral_capacity / bearing.effective_radius
        soft = max(bearing.interface_yield_displacement, bearing.yield_displacement)
        stiffness = limit * weight / soft
        interface = build.slider(middle, node_j, build.coulomb(limit), stiffness, axial)
    return MacroModel(
        middle if middle != node_j else None,
        pendulum,
        rims,
        interface,
        springs,
        tuple(build.materials),
        tuple(build.frictions),
    )


class _Builder:
    """Makes the parts one after the other, and keeps the tags of materials and friction models."""

    def __init__(
        self, ops: Any, bearing: LIRBearing, load: float, tags: Iterator[int], *, rise: bool
    ) -> None:
        self.ops, self.bearing, self.load, self.tags = ops, bearing, load, tags
        self.rise = ("-inclVertdisp",) if rise else ()
        self.materials: list[int] = []
        self.frictions: list[int] = []
        self.slack = self.material("Elastic", _SLACK * load * bearing.effective_radius)

    def material(self, kind: str, *values: float) -> int:
        """Make a uniaxial material."""
        tag = next(self.tags)
        self.ops.uniaxialMaterial(kind, tag, *values)
        self.materials.append(tag)
        return tag

    def friction(self, kind: str, *values: float) -> int:
        """Make a friction model."""
        tag = next(self.tags)
        self.ops.frictionModel(kind, tag, *values)
        self.frictions.append(tag)
        return tag

    def coulomb(self, coefficient: float) -> int:
        """Make a friction model of a constant coefficient."""
        return self.friction("Coulomb", coefficient)

    def axial(self, share: float) -> int:
        """Make the axial material, `share` of which are in series."""
        own = self.bearing.resolved()
        stiffness, damping = own["axial_stiffness"], own["axial_damping"]
        return self.material("Elastic", share * stiffness, share * damping)

    def surface_friction(self) -> int:
        """Make the friction model of both surfaces, force over load at speed of the bearing."""
        laws, radii = laws_of_opensees(self.bearing), self.bearing.radii
        length = self.bearing.effective_radius
        shares = [radius / length for radius in radii]  # of speed, and of force
        fast = self.bearing.effective_friction
        drops = [(law.f_max - law.f_min) * share for law, share in zip(laws, shares, strict=True)]
        if sum(drops) <= 0.0:
            return self.coulomb(fast)
        # if the surfaces' rates differ: the slope at rest
        parts = zip(laws, shares, drops, strict=True)
        slope = sum(drop * law.rate * share for law, share, drop in parts)
        return self.friction("VelDependent", fast - sum(drops), fast, slope / sum(drops))

    def surface_stiffness(self, *, across: bool) -> float:
        """Return the stiffness of both surfaces before they slip."""
        bearing, length = self.bearing, self.bearing.effective_radius
        pairs = zip(bearing.frictions, bearing.radii, strict=True)
        share = sum(law.f_max * r**2 for law, r in pairs) / length**2
        restoring = 0.0 if across else self.load / length
        return share * self.load / bearing.yield_displacement + restoring

    def slider(
        self,
        i: int,
        j: int,
        friction: int,
        stiffness: float,
        axial: int,
        radius: float | None = None,
    ) -> int:
        """Make a slider, flat or on a sphere of a radius."""
        tag = next(self.tags)
        options = (
            "-P",
            axial,
            "-T",
            self.slack,
            "-My",
            self.slack,
            "-Mz",
            self.slack,
            "-orient",
            *_UP,
            "-iter",
            _ITERATIONS,
            _TOLERANCE * self.load,
        )
        if radius is None:
            self.ops.element("flatSliderBearing", tag, i, j, friction, stiffness, *options)
        else:
            self.ops.element(
                "singleFPBearing", tag, i, j, friction, radius, stiffness, *options, *self.rise
            )
        return tag

    def springs(self, i: int, j: int) -> int:
        """Make the springs that restore the whole bearing, in x and y."""
        tag = next(self.tags)
        spring = self.material("Elastic", self.load / self.bearing.effective_radius)
        self.ops.element(
            "twoNodeLink", tag, i, j, "-mat", spring, spring, "-dir", 2, 3, "-orient", *_UP
        )
        return tag

    def rims(self, i: int, j: int, directions: int) -> tuple[int, ...]:
        """Make the gaps against node j's motion relative to node i."""
        bearing, length = self.bearing, self.bearing.effective_radius
        stiffness = bearing.resolved()["rim_stiffness"]
        gaps: dict[float, float] = {}
        for reach, radius in zip(bearing.rim_displacement, bearing.radii, strict=True):
            if math.isfinite(reach):
                place = round(reach * length / radius, 9)
                gaps[place] = gaps.get(place, 0.0) + stiffness * (radius / length) ** 2
        found = []
        for place, k in gaps.items():
            strength = _STRENGTH * self.load
            pair = [
                self.material("ElasticPPGap", k, sign * strength, sign * place)
                for sign in (-1.0, 1.0)
            ]
            for number in range(directions // _FEWEST):  # four gaps an element, crosswise
                angle = 2.0 * math.pi * number / directions
                x, y = math.cos(angle), math.sin(angle)
                tag = next(self.tags)
                self.ops.element(
                    "zeroLength",
                    tag,
                    i,
                    j,
                    "-mat",
                    *pair,
                    *pair,
                    "-dir",
                    1,
                    1,
                    2,
                    2,
                    "-orient",
                    x,
                    y,
                    0.0,
                    -y,
                    x,
                    0.0,
                )
                found.append(tag)
        return tuple(found)


def _check(bearing: LIRBearing, directions: object, restoring: str) -> None:
    """Refuse options and bearings that have no macro-model of this kind."""
    if not isinstance(directions, int) or directions < _FEWEST or directions % _FEWEST:
        msg = f"directions = {directions!r} must be a multiple of 4: use 8 or more for a round rim"
        raise ValueError(msg)
    require_choice("restoring", restoring, ("series", "across"))
    require_constant_friction(bearing, TO_OPENSEES)
    require_lasting_rims(bearing, TO_OPENSEES)
    require_no_backup(bearing, TO_OPENSEES)
    laws_of_opensees(bearing)
    if bearing.interface_friction <= bearing.effective_friction:
        msg = (
            f"interface_friction = {bearing.interface_friction:g} does not exceed the "
            f"friction of the surfaces, {bearing.effective_friction:g}: the interface slips "
            "before rim contact, which the macro-model does not support. Use "
            "bearing_element"
        )
        raise ValueError(msg)


def _check_nodes(ops: Any, node_i: int, node_j: int) -> None:
    """Refuse nodes that do not exist, lack six degrees of freedom, or are not aligned."""
    there = set(ops.getNodeTags())
    for name, node in (("node_i", node_i), ("node_j", node_j)):
        if node not in there:
            msg = (
                f"{name} = {node} is not a node of the model: create it first, with ndm 3 and ndf 6"
            )
            raise ValueError(msg)
        size = len(ops.nodeDisp(node))
        if size != 6:
            msg = f"{name} = {node} has {size} degrees of freedom: a bearing needs 6 (ndm 3, ndf 6)"
            raise ValueError(msg)
    low, high = ops.nodeCoord(node_i), ops.nodeCoord(node_j)
    if low[:2] != high[:2] or low[2] > high[2]:
        msg = (
            f"node_i at {tuple(low)} and node_j at {tuple(high)}: node j must be above node i, or "
            "at the same place: exchange the nodes, or move one"
        )
        raise ValueError(msg)


def _first_tag(ops: Any, given: object) -> int:
    """Return the first tag to take."""
    if given is None:
        return 1 + max(_FIRST - 1, *map(int, [*ops.getNodeTags(), *ops.getEleTags()]))
    if isinstance(given, bool) or not isinstance(given, int) or given < 1:
        msg = f"first_tag = {given!r} must be an integer of at least 1: choose a free tag"
        raise ValueError(msg)
    return given
