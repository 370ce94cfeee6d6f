"""The plain bearing as elements of OpenSees, for comparison and for reuse.

`builtin_commands` returns the commands for one of them, `builtin_element` runs these in the model
at hand; their common part is in `builtin_mapping`, the part of each in `builtin_writing`.

Sources: the OpenSees documentation and the public sources of these elements; for the triple bearing
as a series of three Fenz and Constantinou (2008), Earthq. Eng. Struct. Dyn. 37, 163, and Dao et al.
(2013), the same, 42, 1677.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from lir_element.argument_checks import require_choice
from lir_element.elevations import SAME_PLACE
from lir_element.opensees.compare.builtin_mapping import builtin_values
from lir_element.opensees.compare.builtin_writing import (
    BUILTIN_KINDS,
    BuiltinKind,
    Command,
    friction_law,
    materials,
    ptv,
    refuse,
    single,
    tfp,
    triple,
)
from lir_element.opensees.library import opensees

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing

_TAGS = 10  # kept free for each element: materials and friction models
_FIRST_TAG = 1_000_000


def builtin_commands(
    kind: BuiltinKind,
    tag: int,
    i: int,
    j: int,
    bearing: LIRBearing,
    axial_load: float | None = None,
    *,
    first_tag: int | None = None,
    lift: bool = False,
    apart: bool = True,
) -> tuple[Command, ...]:
    """Return the OpenSees commands that write a plain bearing as an element of OpenSees.

    Parameters
    ----------
    kind : {"singleFPBearing", "FPBearingPTV", "TripleFrictionPendulum", "TFP"}
        The element; see the notes.
    tag : int
        Tag of the element.
    i, j : int
        Tags of the node below and the node above; model of three dimensions, six degrees of
        freedom a node, z upwards.
    bearing : LIRBearing
        The device, its rigid slider: `bearing.as_dcfp()`, without rims
        ``bearing.as_dcfp(rims=False)``.
    axial_load : float, optional
        Load that stiffnesses refer to [N]; the bearing's design load if None. Strength and
        restoring force follow the load of the moment.
    first_tag : int, optional
        First of ten tags for the materials and friction models made; 1 000 000 + 10 times the
        element's tag if None.
    lift : bool
        True if a lateral displacement lifts the load ("singleFPBearing" only).
    apart : bool
        True if the nodes are apart along z; False if they coincide.

    Returns
    -------
    tuple of tuples
        The commands in order, each its name and then its arguments: ``getattr(ops, name)(*args)``.

    Raises
    ------
    ValueError
        If the element cannot represent the bearing; the message names value and remedy.

    Notes
    -----
    The values are those of `BuiltinValues`; s = U / L, m the strength over W. Force while sliding
    outwards; that of the bearing is ``W tan(asin s + atan m)``.

    - ``"singleFPBearing"``: ``W (m + s) / (1 - s (m + s))``. One sphere of radius L, friction
      `Coulomb` or `VelDependent`. The moment N U acts on node i alone, and of all tilts only that
      of node i's plate enters; the shear acts at half height. ``-orient`` is last, because after
      one vector it consumes the next word.
    - ``"FPBearingPTV"``: ``W (m + s / sqrt(1 - s^2))``, otherwise the same; pressure and
      temperature switched off. Its law for speed has ``f_min = f_max / 2`` built in, and uses the
      speed of the first iteration of a step.
    - ``"TripleFrictionPendulum"``: ``W (m + s)``. Three pendulums in series, here of one friction,
      whose lengths add up to L, so that all slide at once and the inner slider has no effect: in
      the element's numbering ``L2 + L3 = L``, ``L2 : L3 = R1 : R2``, ``L1 = 0.2 min(L2, L3)``. Its
      friction contains the elastic part: ``m + U_y / L``. Rim contact is at the bearing's capacity,
      with the element's own stiffness, ``3 W mu / U_y``. Constant friction. Moments N U half on
      each node; tilts do not enter. Use displacements of 10 mm a step at most. Larger ones have
      ended in a force thousands of times too large, without a message; so has uplift of 2 g, in
      kilometres (validation/measurements/opensees_hard_cases.py).
    - ``"TFP"``: both surfaces slide together. Friction locks the inner slider, so that different
      surfaces keep their own ``mu R / (R - h/2)``. Constant friction, no dashpot, no moments. It
      adds up increments of force without iteration. The step must be far below that of the others,
      and a change of the axial force alone changes nothing. Its rims end in NaN (openseespy 3.7.1)
      and are not offered. After the load it reads its yield displacement and then the stiffness K,
      contrary to other descriptions.

    Before sliding all have the stiffness of `BuiltinValues.initial_stiffness` under `axial_load`,
    whereas the bearing keeps its yield displacement at any load and speed. Torsion is resisted by
    the torque under `axial_load`, and by none in "TFP". Rayleigh damping does not act on
    "singleFPBearing" and "FPBearingPTV". It acts on the other two, with their stiffness before
    sliding: half the displacement in one case. It acts on existing elements, so call `rayleigh`
    before these are made, or apply it to the members by a region. Agreement of all:
    docs/validation/opensees_pendulum.md.

    Examples
    --------
    >>> from lir_element import CoulombFriction, LIRBearing
    >>> bearing = LIRBearing(radius=1.0, slider_height=0.1, slider_radius=0.1, capacity=math.inf,
    ...                      friction=CoulombFriction(0.057), interface_friction=math.inf,
    ...                      axial_stiffness=2e9, axial_damping=1e6, torsional_friction=False)
    >>> for command in builtin_commands("singleFPBearing", 1, 10, 20, bearing, 500e3, first_tag=1):
    ...     print(*(f"{a:.8g}" if isinstance(a, float) else a for a in command))
    uniaxialMaterial Elastic 1 2e+09 1000000
    uniaxialMaterial Elastic 2 0
    uniaxialMaterial Elastic 3 0
    frictionModel Coulomb 4 0.06
    element singleFPBearing 1 10 20 4 1.9 ... -P 1 -T 2 -My 3 -Mz 3 -shearDist 0.5 ...
    """
    require_choice("kind", kind, BUILTIN_KINDS)
    load = bearing.resolved()["design_load"] if axial_load is None else axial_load
    values = builtin_values(bearing, load)
    refuse(kind, bearing, values, lift=lift)
    start = _FIRST_TAG + _TAGS * tag if first_tag is None else first_tag
    head = (tag, i, j)
    if kind == "TFP":
        return (tfp(head, bearing, values, load),)
    made = materials(values, start)
    tags = (start, start + 1, start + 2, start + 2)
    if kind == "FPBearingPTV":
        return (*made, ptv(head, bearing, values, load, tags))
    if kind == "singleFPBearing":
        law = friction_law(start + 3, values.friction_min, values.friction_max, values.rate)
        return (*made, law, single(head, values, load, tags, lift=lift, apart=apart))
    return (*made, *triple(head, bearing, values, load, start))


def builtin_element(
    kind: BuiltinKind,
    tag: int,
    i: int,
    j: int,
    bearing: LIRBearing,
    axial_load: float | None = None,
    *,
    first_tag: int | None = None,
    lift: bool = False,
) -> tuple[Command, ...]:
    """Add a plain bearing to the current OpenSees model, as an element of OpenSees.

    Parameters
    ----------
    kind : {"singleFPBearing", "FPBearingPTV", "TripleFrictionPendulum", "TFP"}
        `builtin_commands` describes the elements and the mapping of the bearing.
    tag : int
        Tag of the element.
    i, j : int
        Tags of the node below and the node above, on one vertical, coincident or
        `bearing.height` apart.
    bearing : LIRBearing
        The device, its rigid slider.
    axial_load : float, optional
        Load that stiffnesses refer to [N]; the bearing's design load if None.
    first_tag : int, optional
        First of ten tags for materials and friction models.
    lift : bool
        True if a lateral displacement lifts the load ("singleFPBearing" only).

    Returns
    -------
    tuple of tuples
        The commands that were run.

    Raises
    ------
    ValueError
        If the element cannot represent the bearing, or nodes or tags do not fit.
    TypeError
        If a tag is no integer.
    ImportError
        If openseespy is not installed.

    Notes
    -----
    The model is of three dimensions, in m, N and s. `bearing_element` supports plane models and
    other units.

    Examples
    --------
    In the gallery: "Beside an element that OpenSees ships" (docs/gallery/opensees/b_builtin.py).
    """
    ops = opensees()
    for name, value in {"tag": tag, "i": i, "j": j}.items():
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
            msg = f"{name} = {value!r} must be an integer tag"
            raise TypeError(msg)
    tag, i, j = int(tag), int(i), int(j)  # OpenSees refuses integers of numpy
    apart = _check_nodes(ops, tag, i, j, bearing)
    commands = builtin_commands(
        kind, tag, i, j, bearing, axial_load, first_tag=first_tag, lift=lift, apart=apart
    )
    for name, *arguments in commands:
        try:
            getattr(ops, name)(*arguments)
        except ops.OpenSeesError as cause:
            msg = (
                f"OpenSees refused {name}{tuple(arguments)}: see its output above. If the tag "
                "exists, choose another first_tag"
            )
            raise ValueError(msg) from cause
    if tag not in ops.getEleTags():
        msg = f"OpenSees made no element {tag} of {commands[-1]}: see its output above"
        raise ValueError(msg)
    return commands


def _check_nodes(ops: Any, tag: int, i: int, j: int, bearing: LIRBearing) -> bool:
    # True if the nodes are apart; OpenSees itself would crash, or make an element without force.
    known = set(ops.getNodeTags() or ())
    for node in (i, j):
        if node not in known:
            msg = f"node {node} of element {tag} does not exist: make it by ops.node first"
            raise ValueError(msg)
        size, freedoms = len(ops.nodeCoord(node)), len(ops.nodeDisp(node))
        if (size, freedoms) != (3, 6):
            msg = (
                f"node {node} has {size} coordinates and {freedoms} degrees of freedom, the "
                'bearing needs 3 and 6: ops.model("basic", "-ndm", 3, "-ndf", 6); for a '
                "plane model use bearing_element"
            )
            raise ValueError(msg)
    if tag in (ops.getEleTags() or ()):
        msg = f"element tag {tag} is taken: choose another"
        raise ValueError(msg)
    below, above = ops.nodeCoord(i), ops.nodeCoord(j)
    rise = above[2] - below[2]
    aside = math.hypot(above[0] - below[0], above[1] - below[1])
    if aside > SAME_PLACE or min(abs(rise), abs(rise - bearing.height)) > SAME_PLACE:
        msg = (
            f"node {j} is {rise:g} m above node {i} and {aside:g} m beside it: use the same "
            f"x and y, and a rise of 0 or the bearing's height {bearing.height:g} m. For "
            "units other than m and N use bearing_element"
        )
        raise ValueError(msg)
    return bool(abs(rise) > SAME_PLACE)
