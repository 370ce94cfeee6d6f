"""Record layouts, declared once: dtypes, response names, units and labels all come from here.

Three records belong to a bearing: `PROPS` (constants of its kernels), `STATE` (the committed state)
and `WORK` (scratch of one state determination; nothing in it survives). If the sliders are bodies
with contact points, `SLIDERS` and `POINT` have their constants, `BODIES` and `TOUCH` their state,
`SEARCH` committed data that speed up the next search for them, `SCRATCH` the rest.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt


class Field(NamedTuple):
    """One field of a record: its name, unit, symbol, meaning, shape and number type."""

    name: str
    unit: str
    symbol: str
    meaning: str
    shape: tuple[int, ...] = ()
    kind: str = "f8"


HEAT_PARTS = 14
"""Parts that decay at rates of their own, whose sum is the temperature of a contact."""

RIM_WAVES = 4
"""Waves around a plate in which the plastic deformation of its rim is kept: a mean, then cosines,
then sines."""

FRICTION_TABLE = 259
"""Entries of a surface's friction over speed: a reference speed, then share and slope at each knot
(129 of them)."""

PROPS_FIELDS = (
    Field("radius", "m", "R", "radius of the concave surface: bottom, top", (2,)),
    Field("lever", "m", "a", "distance from the node to the sphere's centre: bottom, top", (2,)),
    Field("length", "m", "L", "effective radius, the string's length"),
    Field("friction_max", "-", "f_max", "friction coefficient at high speed: bottom, top", (2,)),
    Field("friction_drop", "-", "f_max - f_min", "its drop at low speed: bottom, top", (2,)),
    Field("friction_rate", "s/m", "alpha", "rate parameter of Eq. (1): bottom, top", (2,)),
    Field(
        "friction_table",
        "m/s, -",
        "",
        "of another law: v_ref, then share of the drop left and slope at knots; zeros: Eq. (1)",
        (2, FRICTION_TABLE),
    ),
    Field("pressure_rate", "1/N", "", "share of friction lost per axial force; 0: none"),
    Field("softens", "-", "", "1 where friction follows the temperature", (), "i8"),
    Field("heats", "-", "", "1 where temperatures are computed", (), "i8"),
    Field("interface_friction", "-", "mu_h", "friction coefficient of the plane interface"),
    Field("fused", "-", "", "1 where the slider is rigid (a plain DCFP)", (), "i8"),
    Field("bouc_wen", "-", "", "1 for Bouc-Wen, 0 for elastic-plastic friction", (), "i8"),
    Field("exponent", "-", "eta", "exponent of the Bouc-Wen law"),
    Field("yield_displacement", "m", "u_y", "elastic sliding before slip: bottom, top", (2,)),
    Field("interface_yield", "m", "u_yh", "elastic sliding of the interface before slip"),
    Field("axial_stiffness", "N/m", "k_v", "stiffness of the contact along the slider's axis"),
    Field("axial_damping", "N s/m", "c_v", "damping of the contact along the slider's axis"),
    Field("axial_floor", "N", "N_min", "force below which all forces fade in proportion"),
    Field("rim_displacement", "m", "d_max", "sliding at which the rim is met: bottom, top", (2,)),
    Field("rim_stiffness", "N/m", "k_r", "radial stiffness of a rim"),
    Field("rim_damping", "N s/m", "c_r", "radial damping of a rim"),
    Field("rim_overrun", "m", "", "deformation of a rim at which it fails: the slider overruns it"),
    Field("rim_yield_force", "N", "P_y", "force at which a rim yields; infinite: it never does"),
    Field("rim_hardening", "N/m", "H", "force that a rim gains by plastic deformation"),
    Field("flange", "m", "", "way to slide on beyond a broken rim; 0: the bearing fails with it"),
    Field("slip_capacity", "m", "s_max", "interface slip that the sliders' overlap supports"),
    Field("uplift_capacity", "m", "", "opening at which the slider leaves the plates"),
    Field("goes_on", "-", "", "1 where an analysis goes on after the bearing's failure", (), "i8"),
    Field("backup_drop", "m", "", "way down to the stop that carries after it; infinite: none"),
    Field("backup_friction", "-", "", "friction coefficient of that stop"),
    Field("backup_stiffness", "N/m", "", "its vertical stiffness"),
    Field("backup_damping", "N s/m", "", "its vertical damping"),
    Field("torsion_lever", "m", "", "torque of friction about the axis over friction force"),
    Field("torsion_yield", "rad", "", "elastic twist before torsional slip"),
    Field("slider_radius", "m", "a", "radius of the inner slider in plan"),
    Field("bilateral", "-", "", "1 where uplift is left out: the contact pulls", (), "i8"),
    Field("fixed_load", "N", "W", "constant vertical load without vertical coupling; 0: coupled"),
    Field("pressure_load", "N", "", "axial force that the friction coefficients belong to"),
    Field("softening_scale", "-", "", "friction left by heat: scale (rest + exp(-rate T))"),
    Field("softening_rate", "1/K", "", "rate of that law"),
    Field("softening_rest", "-", "", "rest of that law"),
    Field("initial_temperature", "degC", "T_0", "temperature at the start"),
    Field("heat_rate", "1/s", "", "rates at which parts of a temperature decay", (HEAT_PARTS,)),
    Field("heat_gain", "K m2/J", "", "what heat that enters adds to them", (HEAT_PARTS,)),
    Field("heat_skin", "K m2/W", "", "what flux that enters adds at once"),
    Field("interface_preload", "N", "N_h", "load beside N that the interface rubs by"),
)

STATE_FIELDS = (
    Field("time", "s", "t", "time of this state"),
    Field("step", "s", "dt", "time step that led to this state, zero if static"),
    Field("displacement", "m, rad", "u", "displacements of node i, then of node j", (12,)),
    Field("force", "N, N m", "f", "resisting forces on node i, then on node j", (12,)),
    Field("axis", "-", "n", "slider axis, in axes that turn with the bottom plate", (3,)),
    Field("axis_top", "-", "n", "slider axis, in axes that turn with the top plate", (3,)),
    Field("centres", "m", "c", "from sphere centre to sphere centre, axes of node i", (3,)),
    Field("string", "m", "l", "length between the sphere centres along the slider's axis"),
    Field("closure", "m", "pen", "axial closure of the contact, zero when uplifted"),
    Field("axial_force", "N", "N", "axial force, compression positive"),
    Field("vertical_force", "N", "", "of the vertical spring where vertical coupling is left out"),
    Field("slip", "m", "s", "interface slip in the plane of the interface", (2,)),
    Field("slip_total", "m", "s", "interface slip in global axes, top slider on bottom", (3,)),
    Field("slider_displacement", "m", "d", "sliding on the bottom, top surface, global", (2, 3)),
    Field("sliding_increment", "m", "dw", "last step's sliding where the pressure is", (2, 2)),
    Field("slid", "m", "", "part of the last step's sliding past the old z: bottom, top", (2,)),
    Field("slip_increment", "m", "ds", "interface slip of the last step", (2,)),
    Field("hysteresis", "-", "z", "hysteretic variable of the surfaces: bottom, top", (2, 2)),
    Field("plain_hysteresis", "-", "", "the same of the axis' sliding alone", (2, 2)),
    Field("interface_hysteresis", "-", "z_h", "hysteretic variable of the interface", (2,)),
    Field("friction_force", "N", "F", "friction force, tangent plane: bottom, top", (2, 2)),
    Field("interface_force", "N", "F_h", "friction force of the interface, in its plane", (2,)),
    Field("friction_coefficient", "-", "mu", "friction coefficient: bottom, top", (2,)),
    Field("sliding_speed", "m/s", "v", "sliding speed: bottom, top", (2,)),
    Field("eccentricity", "m", "d", "radial sliding in the plane of the plate: bottom, top", (2,)),
    Field("offset", "m", "e", "of the pressure between sliders that are bodies from their axes"),
    Field("rim_closure", "m", "g", "elastic deformation of the rim: bottom, top", (2,)),
    Field("rim_force", "N", "P", "radial rim force: bottom, top", (2,)),
    Field("rim_flow", "m", "", "plastic deformation of the rim in the step: bottom, top", (2,)),
    Field("rim_bent", "m", "g_p", "plastic deformation where the rim presses: bottom, top", (2,)),
    Field("rim_plastic", "m", "", "the largest so far, infinite of a broken rim", (2,)),
    Field("rim_dent", "m", "", "the same all around, in waves", (2, 2 * RIM_WAVES + 1)),
    Field("twist", "rad", "psi", "relative rotation about the vertical axis"),
    Field("twist_hysteresis", "-", "z_t", "hysteretic variable of the torsional friction"),
    Field("torque", "N m", "T", "torsional friction moment"),
    Field("spin", "rad", "chi", "spin of both sliders about their axis since the start"),
    Field("spin_rate", "rad/s", "omega", "its rate in the last step"),
    Field("spin_couple", "m", "M / N", "couple of the rims that spins the sliders, over N"),
    Field("spin_arm", "m", "e", "centre of pressure about the axis: bottom, - top", (2, 2)),
    Field("axis_speed", "m/s", "v", "sliding speed of the slider's axis: bottom, top", (2,)),
    Field("work_friction", "J", "", "dissipated by low friction: bottom, top", (2,)),
    Field("work_interface", "J", "", "dissipated by the high-friction interface"),
    Field("work_elastic", "J", "", "stored in the elastic sliding before slip, all friction"),
    Field("work_owed", "J", "", "of friction that turns in a step: bottom, top, interface", (3,)),
    Field("work_step", "J", "", "what the last step changed of it"),
    Field("work_rim", "J", "", "work done on the rims: bottom, top", (2,)),
    Field("work_contact", "J", "", "work done on the axial contact"),
    Field("work_sliders", "J", "", "taken up by the sliders' own mass: motion, weight"),
    Field("travel", "m", "", "sliding path travelled since the start: bottom, top", (2,)),
    Field("interface_travel", "m", "", "path slipped in the interface since the start"),
    Field("largest_slip", "m", "", "largest interface slip since the start"),
    Field("temperature", "degC", "T", "bottom, top, interface; 0 where it is not computed", (3,)),
    Field(
        "failed",
        "-",
        "",
        "a RunStatus code once the backup carries, below 0 as the bearing fails",
        (),
        "i8",
    ),
    Field("failed_at", "s", "", "time of its failure"),
    Field("status", "-", "", "a RunStatus code", (), "i8"),
    Field("iterations", "-", "", "iterations of the last state determination", (), "i8"),
)

SPIN_BALANCE = 12
"""Place of the sum of the moments that spin the sliders in the result of `by_turn`."""

_W_VECTOR, _W_MATRIX, _W_PAIR = (3,), (3, 3), (2,)
WORK_FIELDS = (
    Field("q_i", "-", "Q_i", "rotation of the bottom plate", _W_MATRIX),
    Field("q_j", "-", "Q_j", "rotation of the top plate", _W_MATRIX),
    Field("spin_i", "-", "T_i", "spin per rate of the rotation vector, bottom", _W_MATRIX),
    Field("spin_j", "-", "T_j", "spin per rate of the rotation vector, top", _W_MATRIX),
    Field("a", "-", "Q_i^T Q_j", "rotation of the top plate seen from the bottom one", _W_MATRIX),
    Field("turned", "rad", "", "rotation vectors: bottom plate, top plate", (2, 3)),
    Field("c_global", "m", "c", "from sphere centre to sphere centre, global", _W_VECTOR),
    Field("c", "m", "c", "the same in axes of the bottom plate", _W_VECTOR),
    Field("n", "-", "n", "slider axis", _W_VECTOR),
    Field("t", "-", "t_1, t_2", "basis of the plane normal to it", (2, 3)),
    Field("lean", "-", "", "1 / (1 + n_3)"),
    Field("l", "m", "l", "string length"),
    Field("sigma", "m", "sigma", "interface slip in the basis t", _W_PAIR),
    Field("dt", "s", "", "time since the committed state, zero if static"),
    Field("share", "-", "", "time step over the sum of this one and the one before"),
    Field("law_stiffness", "-, 1/m", "", "of the friction laws: surfaces, interface", _W_PAIR),
    Field("static_speed", "m/s", "", "sliding speeds of a static trial", _W_PAIR),
    Field("height", "m", "c_3", "vertical part of c, where the string has its own"),
    Field("fixed_length", "m", "l", "the string's constant length under a fixed load; 0: elastic"),
    Field("vertical", "N", "", "force of the vertical spring beside a fixed load"),
    Field("stiff_vertical", "N/m", "", "its derivative"),
    Field("drag", "m", "", "moment of the surfaces' friction over axial force", _W_PAIR),
    Field("push", "N m", "", "moment of the rims", _W_PAIR),
    Field("n_true", "N", "N", "axial force"),
    Field("n_pos", "N", "", "axial force, not below zero"),
    Field("n_hat", "N", "", "axial force, not below its floor"),
    Field("stiff_n", "N/m", "", "derivative of the axial force"),
    Field("scale", "-", "", "n_pos / n_hat"),
    Field("closure", "m", "", "axial closure"),
    Field("kept", "-", "", "share of z that the change of the axial force leaves"),
    Field("kept_n", "1/N", "", "its derivative by the axial force"),
    Field("softer", "-", "", "elastic sliding over u_y, 2 / (1 + kept)"),
    Field("varies", "-", "", "1 where friction depends on pressure or temperature, else 0"),
    Field("warm", "-", "", "share of friction that the surfaces' temperatures leave", _W_PAIR),
    Field("pressed", "-", "", "the same of the pressure"),
    Field("pressed_n", "1/N", "", "its logarithm's derivative by the axial force, falling"),
    Field("kept_low", "-", "", "`kept` of the surfaces, whose friction may depend on pressure"),
    Field("kept_low_n", "1/N", "", "its derivative by the axial force"),
    Field("softer_low", "-", "", "`softer` of the surfaces"),
    Field("z_size", "-", "", "size of the old z: bottom, top, interface", _W_VECTOR),
    Field("per_yield", "1/m", "", "one over elastic sliding: bottom, top, interface", _W_VECTOR),
    Field("z", "-", "z", "hysteretic variable", (2, 2)),
    Field("mu", "-", "mu", "friction coefficient", _W_PAIR),
    Field("speed", "m/s", "v", "sliding speed", _W_PAIR),
    Field("first_speed", "m/s", "", "the same where the friction's decay was last taken", _W_PAIR),
    Field("first_decay", "-", "", "that decay: what the speed leaves of the drop", _W_PAIR),
    Field("dw", "m", "dw", "sliding increment", (2, 2)),
    Field("rubbed", "m", "", "the same where the pressure is: the sliders spin", (2, 2)),
    Field("slid", "m", "", "part of it past the old z", _W_PAIR),
    Field("old", "-", "", "old axis in the basis t, and along n", (2, 3)),
    Field("old_top", "-", "", "old axis as the top plate carries it", _W_VECTOR),
    Field("phi", "-", "", "friction force over axial force", (2, 2)),
    Field("h", "1/m", "", "its derivative by the sliding increment", (2, 2, 2)),
    Field("phi_n", "1/N", "", "its derivative by the axial force", (2, 2)),
    Field("z_s", "-", "z_h", "hysteretic variable of the interface", _W_PAIR),
    Field("f_s", "N", "F_h", "force of the interface", _W_PAIR),
    Field("phi_s", "-", "", "interface force over axial force", _W_PAIR),
    Field("h_s", "1/m", "", "its derivative by the slip", (2, 2)),
    Field("spin", "rad", "chi", "spin of the sliders in the step"),
    Field("spins", "-", "", "1 where the spin is an unknown of the trial, else 0"),
    Field("one_sided", "-", "", "how one-sided the rims press on the sliders, which rock"),
    Field("shift", "m", "e", "centres of pressure at the step's start: bottom, - top", (2, 2)),
    Field("left", "-", "", "share of the surfaces' friction that the spin leaves", _W_PAIR),
    Field("left_rate", "1/rad", "", "its derivative by the spin over itself", _W_PAIR),
    Field("arm", "m", "e", "centres of pressure: bottom, - top", (2, 2)),
    Field("plain", "-", "", "friction along the axis' sliding, over N", (2, 2)),
    Field("z_plain", "-", "z", "hysteretic variable of the axis' sliding alone", (2, 2)),
    Field("bends", "-, 1/m", "", "its direction once it slips, and its stiffness", (2, 3)),
    Field("couple", "m", "M / N", "couple of the rims that spins the sliders, over N"),
    Field("torque_spin", "m", "", "torque of the surfaces against the spin, over N"),
    Field("torque_rate", "m", "", "its derivative by the spin"),
    Field("spun", "", "", "what `by_turn` returns, for a unit of spin", (13,)),
    Field("spun_turn", "-", "", "turn of the axis for a unit of spin", _W_PAIR),
    Field("slip_step", "m", "", "sliding of the interface in the step", _W_PAIR),
    Field("phi_sn", "1/N", "", "its derivative by the axial force", _W_PAIR),
    Field("n_hor", "-", "", "size of the axis' horizontal part", _W_PAIR),
    Field("unit", "-", "", "its direction, in axes of the plate", (2, 2)),
    Field("r_top", "-", "", "direction of the top rim's contact", _W_VECTOR),
    Field("b_top", "-", "", "tangent of the top rim at the contact", _W_VECTOR),
    Field("rim", "N", "P", "rim force", _W_PAIR),
    Field("stiff_rim", "N/m", "", "its derivative", _W_PAIR),
    Field("rim_scale", "-", "", "share of the rim forces that counts, as `scale` for friction"),
    Field("rim_closure", "m", "g", "elastic rim deformation", _W_PAIR),
    Field("rim_bent", "m", "g_p", "plastic deformation of the rim before the step", _W_PAIR),
    Field("rim_slant", "m", "", "its derivative by the angle, where force follows it", _W_PAIR),
    Field("rim_flow", "m", "", "plastic deformation in the step", _W_PAIR),
    Field("residual", "N m", "", "equilibrium of the slider", _W_PAIR),
    Field("jacobian", "N m", "", "its derivative by a turn of the axis", (2, 2)),
    Field("g", "N", "g", "force on the top sphere's centre, axes of the bottom plate", _W_VECTOR),
    Field("tau", "N m", "tau", "moment about the top sphere's centre", _W_VECTOR),
    Field("k6", "N/m, N, N m", "", "derivative of g, tau, N by centre and spin, own axes", (7, 6)),
    Field("half", "N/m, N, N m", "", "the same with g and tau in global axes", (7, 6)),
    Field("d_rows", "", "", "derivative of g, tau, N by the nodes' displacements", (7, 12)),
    Field("tangent", "", "", "derivative of the nodes' forces by their displacements", (12, 12)),
    Field("axes", "-", "", "the slider's axes t_1, t_2, n seen globally, as columns", _W_MATRIX),
    Field("axes_force", "-", "", "the same for the force on the centre", _W_MATRIX),
    Field("axes_shift", "-", "", "the same for the shift of the centre", _W_MATRIX),
    Field("torque", "N m", "T", "torsional friction moment"),
    Field("torque_stiffness", "N m", "", "its derivative by the twist"),
    Field("torque_axial", "m", "", "its derivative by the axial force"),
    Field("turns", "", "", "what `by_turn` returns, for the two turns of the axis", (2, 13)),
    Field("rates", "", "", "the same in one direction", (13,)),
    Field("start", "-", "", "axis and basis at which a search begins", _W_MATRIX),
    Field("start_circle", "-", "", "unit radial direction and radius of its parallel", _W_VECTOR),
    Field("inverse", "1/(N m)", "", "inverse of the jacobian, by rows", (4,)),
    Field("still", "m, rad", "", "no shift of a centre, no spin", _W_VECTOR),
    Field("along", "rad", "", "spin of the top plate, axes of the bottom plate", _W_VECTOR),
    Field("moment", "N m", "", "of the surfaces on the slider, before its arm", _W_VECTOR),
    Field("centre_speed", "m/s", "", "of one sphere's centre to the other", _W_VECTOR),
)


SLIDER_FIELDS = (
    Field("mass", "kg", "m", "mass: bottom slider, top slider", (2,)),
    Field("inertia", "kg m2", "J", "rotational inertia about own axes: both sliders", (2, 3)),
    Field("place", "m", "", "reference places of node i, sliders' mass centres, node j", (4, 3)),
    Field("plane", "m", "", "interface from the mass centre: bottom slider, top slider", (2,)),
    Field("vertex", "m", "", "lowest, highest point of the slider from the mass centres", (2,)),
    Field("grip", "-", "", "friction coefficient of a point over its surface's (7.7)", (2,)),
    Field("stiffness", "N/m", "k", "normal stiffness of one interface"),
    Field("damping", "N s/m", "c", "normal damping of one interface"),
    Field("radius", "m", "a", "slider radius, lever that compares moments with forces"),
    Field("gravity", "m/s2", "g", "acceleration that gives the sliders their weight"),
)

POINT_FIELDS = (
    Field("pair", "-", "", "0 bottom surface (B), 1 interface (C), 2 top surface (A)", (), "i8"),
    Field("arm", "m", "", "contact point from its slider's mass centre, own axes", (3,)),
    Field("share", "-", "", "share of the interface's stiffness"),
    Field("disc", "m", "a", "radius of a disc that stands for all points of a face; 0: a point"),
)

BODY_FIELDS = (
    Field("step", "s", "dt", "time step that led to this state, zero if static"),
    Field("displacement", "m", "", "of the mass centres: both sliders, top plate", (3, 3)),
    Field("turn", "-", "", "rotation as quaternion (scalar first)", (3, 4)),
    Field("velocity", "m/s", "", "velocity of the mass centres", (3, 3)),
    Field("spin", "rad/s", "", "angular velocity, global axes", (3, 3)),
    Field("acceleration", "m/s2", "", "acceleration of the mass centres", (3, 3)),
    Field("spin_rate", "rad/s2", "", "angular acceleration, global axes", (3, 3)),
    Field("parts", "N, N m", "", "forces on node i, sliders, node j by origin", (7, 24)),
    Field("rim_gap", "m", "", "approach to the rim, negative when open: bottom, top", (2,)),
    Field("rim_closure", "m", "g", "elastic deformation of the rim: bottom, top", (2,)),
    Field("rim_force", "N", "P", "radial rim force: bottom, top", (2,)),
    Field("rim_flow", "m", "", "plastic deformation of the rim in the step: bottom, top", (2,)),
    Field("rim_bent", "m", "g_p", "plastic deformation where the rim presses: bottom, top", (2,)),
    Field("rim_dent", "m", "", "the same all around, in waves", (2, 2 * RIM_WAVES + 1)),
)

TOUCH_FIELDS = (
    Field("spot", "m", "", "place of the contact, axes of what carries it", (3,)),
    Field("hysteresis", "-", "z", "hysteretic variable of its friction", (2,)),
    Field("gap", "m", "", "penetration, negative when open"),
    Field("closure", "m", "pen", "penetration, zero when open"),
    Field("push", "N", "N", "normal force"),
    Field("friction", "-", "mu", "friction coefficient"),
    Field("slid", "m", "", "part of the last step's sliding past the old z"),
    Field("speed", "m/s", "v", "speed of sliding"),
    Field("increment", "m", "dw", "tangential sliding of the last step", (2,)),
    Field("memory", "-", "z", "hysteretic variable of a disc, its spin last", (3,)),
    Field("norm", "-", "", "norm of that (7.12)"),
    Field("axes", "-", "", "axes of a disc's face, axes of the carrier", (2, 3)),
    Field("centre", "m", "e", "centre of pressure of a disc, axes of its face", (2,)),
    Field("core", "m", "", "the same without damping", (2,)),
)

SEARCH_FIELDS = (
    Field(
        "follows",
        "-",
        "",
        "1 where a trial is one of a step of a time history, 2 where the last one found a state",
        (),
        "i8",
    ),
    Field("leads", "-", "", "last steps whose lead is known: none, one, two equal ones", (), "i8"),
    Field("lead", "m, rad", "", "where sliders rest beyond the start of their search", (2, 6)),
    Field("lead_before", "m, rad", "", "the same in the step before", (2, 6)),
    Field("renewed", "-", "", "1 where the trial has taken a new inverse", (), "i8"),
    Field("inverse_step", "s", "", "time step that the inverse belongs to, zero if there is none"),
    Field("inverse", "m/N", "", "inverse of Newton's matrix of both sliders, by columns", (12, 12)),
)

SCRATCH_FIELDS = (
    Field("share", "-", "", "time step over the sum of this one and the one before"),
    Field("step_before", "s", "", "the one before"),
    Field("soft_low", "m", "", "least way to slip in a search by softer friction: surfaces", (2,)),
    Field("soft_high", "m", "", "the same: interface"),
    Field("lost", "-", "", "share of friction that pressure and temperature take: surfaces", (2,)),
    Field("x", "m", "", "places of node i, sliders, node j", (4, 3)),
    Field("q", "-", "", "their rotations", (4, 3, 3)),
    Field("g", "N, N m", "", "forces and moments on them", (24,)),
    Field("k", "N/m", "", "derivative of g by displacement and spin", (24, 24)),
    Field("derived", "-", "", "1 where k belongs to g", (), "i8"),
    Field("d", "m", "", "contact point in axes of its carrier", (3,)),
    Field("normal", "N", "", "normal force of a contact, axes of its carrier", (3,)),
    Field("tangential", "N", "", "friction force of a contact, axes of its carrier", (3,)),
    Field("slope", "N/m", "", "derivative of both by the contact point", (3, 3)),
    Field("global_slope", "N/m", "", "the same in global axes", (3, 3)),
    Field("half", "", "", "spare", (3, 3)),
    Field("row", "N/m", "", "derivative of a contact's force by both bodies", (3, 12)),
    Field("arm", "m", "", "contact point from its body, from its carrier", (2, 3)),
    Field("force", "N", "", "force of a contact, global", (2, 3)),
    Field("tangent_1", "-", "t_1", "basis of the tangent plane", (3,)),
    Field("tangent_2", "-", "t_2", "the same", (3,)),
    Field("system", "", "", "matrix of Newton's method", (18, 18)),
    Field("right", "", "", "its right-hand side", (18, 1)),
    Field("residual", "N, N m", "", "unbalanced forces on the bodies", (18,)),
    Field("step", "m, rad", "", "last step of Newton's method", (18,)),
    Field("shift", "m", "", "displacement of the mass centres over the time step", (9,)),
    Field("try_shift", "m", "", "the same before a step of Newton's method", (9,)),
    Field("try_displacement", "m", "", "displacements before a step", (3, 3)),
    Field("try_turn", "-", "", "rotations before a step", (3, 4)),
    Field("spin_i", "-", "T_i", "spin per rate of the rotation vector, bottom", (3, 3)),
    Field("spin_j", "-", "T_j", "spin per rate of the rotation vector, top", (3, 3)),
    Field("start_displacement", "m", "", "displacements at the start of a search", (2, 3)),
    Field("start_turn", "-", "", "rotations there", (2, 4)),
    Field("axis", "-", "n", "axis that a slider is put at, normal of a cap", (3,)),
    Field("spare_matrix", "", "", "spare", (3, 3)),
    Field("spare_vector", "", "", "spare", (3,)),
    Field("load", "N, N m", "", "load on the top plate", (6,)),
    Field("moves", "m, rad", "", "displacement and turn of each body over the step", (24,)),
    Field("joint", "", "", "matrix of both sliders, right-hand side or inverse", (12, 24)),
    Field("order", "", "", "rows exchanged as it is inverted", (12,), "i8"),
    Field("follow", "", "", "motion of the sliders by the nodes' displacements", (12, 12)),
    Field("face", "-", "", "axes of a disc's face, axes of the carrier", (2, 3)),
    Field("tilt", "-", "g", "slope of its penetration along them", (2,)),
    Field("bed", "", "", "derivative of mean penetration, centre of pressure by both", (3, 3)),
    Field("bed_by", "", "", "derivative of penetration and slope by shift and turn", (3, 6)),
    Field("push_by", "", "", "derivative of load and centre of pressure by them", (3, 6)),
    Field("old_place", "-", "", "where the material there was, from the sphere's centre", (3,)),
    Field("way", "m", "", "sliding of a disc", (2,)),
    Field("spin_by", "", "", "derivative of the spin by normal and turn", (6,)),
    Field("home", "N/m", "", "force of a bond on its face's axes where they were", (2, 3)),
    Field("rub", "", "", "derivative of a disc's friction over mu N", (3, 4)),
    Field("rub_b", "-", "b", "trial value of its hysteretic variable", (3,)),
    Field("rub_g", "-", "", "half the gradient of its norm's square", (3,)),
    Field("rub_n", "1/N", "", "derivative of b by the axial force", (3,)),
    Field("rub_d", "m", "", "sliding (2), spin times radius", (3,)),
    Field("rub_h", "-", "", "half the second derivative of its norm's square", (3, 3)),
    Field("rub_hd", "-", "", "that times the sliding", (3,)),
    Field("rub_c", "-", "", "derivative of what the return map leaves of b", (4,)),
    Field("slid_by", "-", "", "derivative of the sliding past the old z", (3,)),
    Field("slip_by", "-", "", "derivative of the slip", (4,)),
    Field("couple", "N m", "", "couple of a pair, axes of its carrier", (3,)),
    Field("held", "", "", "of discs, rims: two arms, normal force, friction, couple", (5, 5, 3)),
    Field("momentum", "N m s", "", "sliders' angular momentum at the committed state", (2, 3)),
    Field("ground", "m/s2", "", "ground's acceleration at the end of the step", (3,)),
    Field("axes", "-", "", "axes of a face where they were, turned with the carrier", (2, 3)),
    Field("six", "", "", "derivative of force and couple by shift and turn", (6, 6)),
    Field("pair_row", "", "", "the same by one body", (6, 6)),
)


def dtype_of(fields: tuple[Field, ...]) -> np.dtype[Any]:
    """Return the aligned record dtype of a table of fields."""
    entries = [(f.name, f.kind, f.shape) for f in fields]
    return np.dtype((np.record, np.dtype(entries, align=True)))


PROPS = dtype_of(PROPS_FIELDS)
STATE = dtype_of(STATE_FIELDS)
WORK = dtype_of(WORK_FIELDS)
SLIDERS = dtype_of(SLIDER_FIELDS)
POINT = dtype_of(POINT_FIELDS)
BODIES = dtype_of(BODY_FIELDS)
TOUCH = dtype_of(TOUCH_FIELDS)
SEARCH = dtype_of(SEARCH_FIELDS)
SCRATCH = dtype_of(SCRATCH_FIELDS)

STATE_BY_NAME = {f.name: f for f in STATE_FIELDS}
PROPS_BY_NAME = {f.name: f for f in PROPS_FIELDS}

Records: TypeAlias = npt.NDArray[Any]
"""Array of records."""

Floats: TypeAlias = npt.NDArray[np.float64]
"""Array of float64; its users give the shape."""

Words: TypeAlias = npt.NDArray[np.int64]
"""Records seen as rows of 64-bit words."""

Props: TypeAlias = Any
"""One record of dtype PROPS, as kernels see it."""

State: TypeAlias = Any
"""One record of dtype STATE."""

Work: TypeAlias = Any
"""One record of dtype WORK."""

Sliders: TypeAlias = Any
"""One record of dtype SLIDERS."""

Bodies: TypeAlias = Any
"""One record of dtype BODIES."""

Search: TypeAlias = Any
"""One record of dtype SEARCH."""

Scratch: TypeAlias = Any
"""One record of dtype SCRATCH."""

Touch: TypeAlias = Any
"""One record of dtype TOUCH."""

Mapped: TypeAlias = tuple[
    float, float, float, float, float, float, float, float, float, float, float
]
"""Result of the return map of friction: see `kernels.slip.friction_map`."""
