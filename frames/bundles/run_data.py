"""Arrays that the time loop changes: the state of a run, its clock and counts, and its records."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, get_type_hints

import numpy as np

from frames.bundles.peak_data import ENERGY_TERMS
from lir_element.bundles.contact_data import Contacts, as_rows, heat_parts, initial_state
from lir_element.layout import BODIES, STATE, WORK, Field, dtype_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from frames._types import FloatArray
    from frames.bundles.model_data import ReducedModel

    Array = npt.NDArray[Any]

MOST_HALVINGS = 14
"""Largest number of halvings of a step: a step of 0.005 s down to 0.3 microseconds."""

_SECANTS = 8  # of Newton's method that are remembered with a tangent

CLOCK_FIELDS = (
    Field("time", "s", "t", "time of the committed state"),
    Field("dt", "s", "dt", "step that is being tried, zero for a static solution"),
    Field("done", "-", "", "base steps completed", (), "i8"),
    Field("ticks", "-", "", "smallest parts of the present base step that are done", (), "i8"),
    Field("halvings", "-", "", "how often the step is halved at present", (), "i8"),
    Field("good", "-", "", "good steps since that changed", (), "i8"),
    Field("dt_before", "s", "", "last step that was accepted, zero at the start"),
    Field("share", "-", "", "estimated error of the last step over what is allowed"),
    Field("reach", "m", "", "largest horizontal displacement of a bearing so far"),
    Field("error", "m", "", "estimated error of the last step tried, were all steps so"),
    Field("recent", "m", "", "mean of those of the accepted steps of late"),
    Field("worst", "m", "", "largest of these means"),
    Field("equal", "-", "", "accepted steps since one of another size", (), "i8"),
    Field("guessed", "-", "", "accepted steps since one without such a guess", (), "i8"),
    Field("secants", "-", "", "of Newton's method since the tangent was made", (), "i8"),
    Field("kept", "-", "", "1 + halvings of the step whose tangent is kept, 0: none", (), "i8"),
    Field("fall", "-", "", "of the residual in a step's first iteration with a kept tangent"),
    Field("elastic_start", "J", "", "strain energy of the structure under gravity"),
)

COUNT_FIELDS = (
    Field("steps", "-", "", "steps accepted", (), "i8"),
    Field("iterations", "-", "", "iterations of Newton's method", (), "i8"),
    Field("tangents", "-", "", "tangents made", (), "i8"),
    Field("shared_tangents", "-", "", "times that only their shared part was", (), "i8"),
    Field("halvings", "-", "", "steps halved by adaptive substepping", (), "i8"),
    Field("trials", "-", "", "state determinations of all bearings", (), "i8"),
    Field("bearing", "-", "", "bearing whose limit or state was the last to fail", (), "i8"),
    Field("code", "-", "", "status code of the last trial", (), "i8"),
    Field("cause", "-", "", "status code of the step that could not be halved", (), "i8"),
)

CLOCK = dtype_of(CLOCK_FIELDS)
COUNTS = dtype_of(COUNT_FIELDS)
LEDGER = dtype_of(tuple(Field(term, "J", "", "term of the energy") for term in ENERGY_TERMS))


class IntegrationState(NamedTuple):
    """The state of a run, committed (0) and trial (1), and scratch; changed in place."""

    b: Array  # (n_b,) committed displacement, velocity, acceleration
    v_b: Array
    a_b: Array
    mean_v_b: Array  # of the last step: a guess without the ringing in v_b
    mean_v_before: Array  # of the step before that
    e: Array
    v_e: Array
    a_e: Array
    old: Array  # (n_bearings,) records
    new: Array
    old_words: Array
    new_words: Array
    work: Array
    heat: Array  # (n_bearings or 0, 3, parts) of the temperatures (`heat_parts`)
    store_at_rest: Array  # (1,) in the elastic sliding of all friction under permanent loads
    push: Array  # (n_bearings, 3) force on node j before the committed state
    own: Array  # (n_bearings, 2) of these, horizontal and beside the bearings' forces: trial
    swing: Array  # (4,) squares of these accelerations and of their changes in the step, means
    moved: Array  # (n_bearings, 6) mean velocity of node j (up: to i), and its rate, last step
    carried: Array  # (n_bearings,) mass that the permanent axial force holds [kg]
    force_old: Array  # (n_b,) bearing forces, committed
    force: Array
    force_before: Array  # (2, n_b) and those of the two steps before
    balanced: Array  # (1,) 1: accelerations are recorded from equilibrium at the end of the step
    balance: Array  # (n_b, n_b) then: accelerations of b by forces, eta following
    tangent: Array  # (n_v, n_v) the last one, transposed and factorised: without the shared part
    order: Array  # (n_v,) of its rows
    across: Array  # (n_h, n_v) how the rest follows the n_h = n_b - n_v shared coordinates
    below: Array  # (n_h, n_v) tangent of their forces by the rest
    corner: Array  # (n_h, n_h) and by themselves, the rest following; transposed and factorised
    corner_order: Array
    sorted_b: Array  # (n_b,) scratch; this and the following are of size zero if nothing is shared
    linear_step: Array  # (n_b,) force of the linear structure by the step, by a trial,
    linear_trial: Array
    linear_change: Array  # of Newton's correction,
    linear_before: Array  # (2, n_b) and of the last two steps
    flows: Array  # (6, n_b) mass_b v_b, mass_b a_b, damping_b v_b, damping_b a_b, and scratch
    element_whole: Array  # (n_bearings, 12, 12) tangents that `tangent` was made of
    of_nodes: Array  # (4, 12) scratch
    weights: Array  # (n_b,) of the coordinates in products of corrections
    corrections: Array  # (m, n_b) of Newton's method since the tangent was renewed
    corrections_next: Array  # (m, n_b) that followed them in their step
    corrections_linear: Array  # (m, n_s) products of the linear structure's matrix and those
    corrections_size: Array  # (m,) squares of the former
    missed: Array  # (3, n_b) errors of the guesses of the last two steps; the last guess
    missed_linear: Array  # (3, n_s) products of the linear structure's matrix and these
    missed_friction: Array  # (n_bearings, 2, 2) mean of friction beyond that of a step's ends [N]
    reduced: Array  # (halvings, n_b, n_b) linear effective stiffness of each step size
    has_reduced: Array
    inverse_e: Array  # (halvings, n_e, n_e) with full damping: effective flexibility of modes
    follow_e: Array  # (halvings, n_e, n_b) and how they follow b
    lead_e: Array  # (halvings, n_b, n_e) its transpose
    held: Array  # (n_b,) stiffness_b b, committed
    flow_v: Array  # (n_e,) mass_eb v_b and mass_eb a_b, committed, and of the trial
    flow_a: Array
    flow_v_new: Array
    flow_a_new: Array
    b_new: Array
    v_b_new: Array
    a_b_new: Array
    e_new: Array
    v_e_new: Array
    a_e_new: Array
    rhs_b: Array
    rhs_e: Array
    residual: Array
    step: Array
    trial_b: Array
    h_b: Array
    h_e: Array
    g_b: Array
    g_e: Array
    element_k: Array  # (n_bearings, 12, 12)
    u: Array  # (12,)
    v: Array
    energy: Array  # (1,) LEDGER
    energy_row: Array  # (n_terms,) the same as numbers
    clock: Array  # (1,) CLOCK
    counts: Array  # (1,) COUNTS


class Ground(NamedTuple):
    """The ground motion that a run integrates."""

    acceleration: Array  # (n, 3) [m/s2]
    dt: float  # between samples [s]; linear between, zero after the last


CORRECTED = "corrected-newmark"
"""Integrator that adds the trapezoidal rule's error of a step to the velocities."""


class IntegratorSettings(NamedTuple):
    """Constants of the time integration."""

    dt: float
    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    force_tolerance: float
    max_iterations: int
    tangent_worth: float  # iterations that a kept tangent may take before a new one is cheaper
    shared_worth: float  # the same before its shared part alone; as above if none is shared
    energy_tolerance: float  # made or lost by contacts in a step, of the energy moved so far
    energy_floor: float  # J, below which that energy does not count
    error_tolerance: float  # of histories over the displacement reached; infinite: fixed step
    smallest_reach: float  # m, displacement that counts as reached from the start
    error_flexibility: float  # s2, displacement that a lasting error of force over mass makes
    error_time: float  # s, time in which vibrations get out of phase
    error_event: float  # s, step below which an error of force counts as an impulse
    least_halvings: int  # of a base step, for any estimate
    error_vertical: float  # share of the vertical error that counts while a bearing is pressed
    error_open: float  # the same while it is lifted off, or lands
    corrects: int  # 1: velocities get the trapezoidal rule's error of a step
    first: int  # base step that the first row of the output holds


AT_REST = IntegratorSettings(*(kind() for kind in get_type_hints(IntegratorSettings).values()))
"""Settings at rest."""

STILL = Ground(np.zeros((2, 3)), 1.0)
"""Ground that does not move."""


def run_arrays(model: ReducedModel) -> IntegrationState:
    """Return a run at rest, bearings undeformed and unloaded."""
    n_b, n_e, count = len(model.load_b), len(model.load_e), len(model.props)
    old, new = initial_state(model.props), initial_state(model.props)

    def b() -> Array:
        return np.zeros(n_b)

    def e() -> Array:
        return np.zeros(n_e)

    energy = np.zeros(1, dtype=LEDGER)
    sizes = MOST_HALVINGS + 1
    n_full = len(model.damping_ee)  # pages of the arrays below that no step touches take no memory

    return IntegrationState(
        b=b(),
        v_b=b(),
        a_b=b(),
        mean_v_b=b(),
        mean_v_before=b(),
        e=e(),
        v_e=e(),
        a_e=e(),
        old=old,
        new=new,
        old_words=as_rows(old),
        new_words=as_rows(new),
        work=np.zeros(count, dtype=WORK),
        heat=heat_parts(model.props),
        store_at_rest=np.zeros(1),
        push=np.zeros((count, 3)),
        moved=np.zeros((count, 6)),
        own=np.zeros((count, 2)),
        swing=np.zeros(4),
        carried=np.ones(count),
        force_old=b(),
        force=b(),
        force_before=np.zeros((2, n_b)),
        balanced=np.zeros(1, np.int64),
        balance=np.zeros((n_b, n_b)),
        **tangent_arrays(n_b, len(model.shared), count),
        reduced=np.zeros((sizes, n_b, n_b)),
        has_reduced=np.zeros(sizes, np.int64),
        inverse_e=np.zeros((sizes, n_full, n_full)),
        follow_e=np.zeros((sizes, n_full, n_b)),
        lead_e=np.zeros((sizes, n_b, n_full)),
        held=b(),
        flow_v=e(),
        flow_a=e(),
        flow_v_new=e(),
        flow_a_new=e(),
        b_new=b(),
        v_b_new=b(),
        a_b_new=b(),
        e_new=e(),
        v_e_new=e(),
        a_e_new=e(),
        rhs_b=b(),
        rhs_e=e(),
        residual=b(),
        step=b(),
        trial_b=b(),
        h_b=b(),
        h_e=e(),
        g_b=b(),
        g_e=e(),
        element_k=np.zeros((count, 12, 12)),
        u=np.zeros(12),
        v=np.zeros(12),
        energy=energy,
        energy_row=energy.view(np.float64),
        clock=np.zeros(1, dtype=CLOCK),
        counts=np.zeros(1, dtype=COUNTS),
    )


def tangent_arrays(n_b: int, n_h: int, bearings: int) -> dict[str, Any]:
    """Return the arrays of an IntegrationState that hold the tangent."""
    n_v = n_b - n_h
    n_s = n_b if n_h else 0

    def zeros(*shape: int) -> FloatArray:
        return np.zeros(shape)

    return {
        "tangent": zeros(n_v, n_v),
        "order": np.zeros(n_v, np.int64),
        "across": zeros(n_h, n_v),
        "below": zeros(n_h, n_v),
        "corner": zeros(n_h, n_h),
        "corner_order": np.zeros(n_h, np.int64),
        "sorted_b": zeros(n_s),
        "linear_step": zeros(n_s),
        "linear_trial": zeros(n_s),
        "linear_change": zeros(n_s),
        "linear_before": zeros(2, n_s),
        "flows": zeros(6, n_s),
        "element_whole": zeros(bearings if n_h else 0, 12, 12),
        "of_nodes": zeros(4, 12),
        "weights": np.ones(n_b),
        "corrections": zeros(_SECANTS, n_b),
        "corrections_next": zeros(_SECANTS, n_b),
        "corrections_linear": zeros(_SECANTS, n_s),
        "corrections_size": zeros(_SECANTS),
        "missed": zeros(3, n_b),
        "missed_linear": zeros(3, n_s),
        "missed_friction": zeros(bearings, 2, 2),
    }


class Output(NamedTuple):
    """Records of a run, one entry an output step."""

    time: Array
    b: Array
    v_b: Array
    a_b: Array
    e: Array
    a_e: Array
    words: Array  # (n_steps, n_bearings, words)
    bodies: Array  # (n_steps, bearings with contact points, words)
    energy: Array
    deformation: Array  # (n_steps, deformations) of nonlinear parts
    beyond: Array  # the forces on them besides the elastic ones
    part_state: Array  # (n_steps, parts, words)


def output_arrays(
    model: ReducedModel,
    contacts: Contacts | None,
    count: int,
    parts: tuple[int, int, int] = (0, 0, 0),
) -> tuple[Output, Array, Array]:
    """Return arrays for `count` output steps, the bearing states and the bodies as records."""
    n_deformations, n_parts, n_state = parts
    n_b, n_e, n_bearings = len(model.load_b), len(model.load_e), len(model.props)
    states = np.zeros((count, n_bearings), dtype=STATE)
    words = states.view(np.int64).reshape(count, n_bearings, -1)
    n_contact = 0 if contacts is None else len(contacts.sliders)
    bodies = np.zeros((count, n_contact), dtype=BODIES)
    n_words = BODIES.itemsize // 8
    arrays = Output(
        time=np.zeros(count),
        b=np.zeros((count, n_b)),
        v_b=np.zeros((count, n_b)),
        a_b=np.zeros((count, n_b)),
        e=np.zeros((count, n_e)),
        a_e=np.zeros((count, n_e)),
        words=words,
        bodies=bodies.view(np.int64).reshape(count, n_contact, n_words),
        energy=np.zeros((count, len(ENERGY_TERMS))),
        deformation=np.zeros((count, n_deformations)),
        beyond=np.zeros((count, n_deformations)),
        part_state=np.zeros((count, n_parts, n_state)),
    )
    return arrays, states, bodies
