"""Bundles of arrays of a run at the level 'rigid_body', and of a bearing in the testing rig."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lir_element.bundles.contact_data import as_rows
from lir_element.layout import BODIES, SCRATCH, STATE, WORK, Field, dtype_of

if TYPE_CHECKING:
    from lir_element.bundles.contact_data import Contacts
    from lir_element.layout import Floats, Records, Words


DEFAULT_TOLERANCE = 1e-8
"""Error of a step over the effective radius."""

FIRST_STEP = 1e-4
"""Step that a run is started with [s]."""

RIGID_CLOCK_FIELDS = (
    Field("time", "s", "t", "time of the committed state"),
    Field("step", "s", "dt", "step to try next"),
    Field("part", "-", "", "explicit steps done towards the next output", (), "i8"),
)

RIGID_COUNT_FIELDS = (
    Field("steps", "-", "", "steps accepted", (), "i8"),
    Field("refused", "-", "", "steps refused", (), "i8"),
    Field("tries", "-", "", "steps tried", (), "i8"),
    Field("outputs", "-", "", "outputs written", (), "i8"),
)

RIGID_LEDGER_FIELDS = (
    Field("input", "J", "", "work of the ground motion"),
    Field("gravity", "J", "", "potential energy gained against the permanent loads"),
    Field("kinetic", "J", "", "kinetic energy of the top plate"),
    Field("numerical", "J", "", "what the scheme leaves unbalanced"),
)

RIGID_CLOCK = dtype_of(RIGID_CLOCK_FIELDS)
RIGID_COUNTS = dtype_of(RIGID_COUNT_FIELDS)
RIGID_LEDGER = dtype_of(RIGID_LEDGER_FIELDS)


class RigidSetup(NamedTuple):
    """Constants of the time integration."""

    alpha_m: float
    beta: float
    gamma: float
    error: float  # m, largest difference of a step and two half steps
    smallest: float  # s, step at which the run gives up
    largest: float  # s
    explicit: float  # s, step of the explicit mode; 0 for the implicit one


class RigidRun(NamedTuple):
    """One bearing with its top plate: constants, states, scratch; changed in place.

    Bodies and touches hold four states: committed, after a full step, after the first and the
    second of two half steps. `states` and `energy` hold three: committed, after each half step.
    """

    props: Records  # (1,)
    sliders: Records  # (1,)
    points: Records  # (m,)
    mass: Floats  # (3, 3)
    inertia: Floats  # (3, 3)
    free: Words  # (18,) 1 if the degree of freedom is free
    driven: bool
    bodies: Records  # (4,)
    touches: Records  # (4, m)
    states: Records  # (3,)
    bodies_words: Words
    touches_words: Words
    states_words: Words
    scratch: Records  # (1,)
    energy: Records  # (3,) RIGID_LEDGER
    energy_words: Words
    u: Floats  # (12,)
    ground: Floats  # (3,) at the end of a step
    ground_mean: Floats  # (3,) over the step
    drive: Floats  # (2,)
    clock: Records  # (1,) RIGID_CLOCK
    counts: Records  # (1,) RIGID_COUNTS


class RigidInput(NamedTuple):
    """Input of a run, and its output arrays."""

    motion: Floats  # (n, 3) ground acceleration
    motion_dt: float
    times: Floats  # (n_out,) output times, the first one that of the start
    drive: Floats  # (n_out, 2) imposed places of the top plate, linear between
    load: Floats  # (n_out, 6) load on the top plate, linear between
    words: Words  # (n_out, words of STATE)
    bodies: Words  # (n_out, words of BODIES)
    energy: Words  # (n_out, words of RIGID_LEDGER)


def bossak(spectral_radius: float) -> tuple[float, float, float]:
    """Return alpha_m, beta and gamma of Bossak's method for a spectral radius at infinity."""
    alpha = (spectral_radius - 1.0) / (spectral_radius + 1.0)
    return alpha, 0.25 * (1.0 - alpha) ** 2, 0.5 - alpha


def rigid_run(
    props: Records,
    contacts: Contacts,
    state: Records,
    mass: Floats,
    inertia: Floats,
    free: Words,
    *,
    driven: bool,
) -> RigidRun:
    """Return a run that starts from the equilibrium held by `contacts` and `state` (1,).

    Shapes: props (1,), state (1,), mass, inertia (3,), free (6,).
    """
    sliders = contacts.sliders
    masses, inertias = np.zeros((3, 3)), np.zeros((3, 3))
    masses[:2] = sliders["mass"][0][:, None]
    inertias[:2] = sliders["inertia"][0]
    masses[2], inertias[2] = mass, inertia
    bodies = np.repeat(contacts.bodies_old, 4)
    touches = np.repeat(contacts.touch_old, 4, axis=0)
    states = np.repeat(state, 3)
    energy = np.zeros(3, dtype=RIGID_LEDGER)
    node = state["displacement"][0, 6:]
    bodies["displacement"][:, 2] = node[:3]
    half = 0.5 * node[3:]
    bodies["turn"][:, 2] = np.concatenate([[1.0], half * np.sinc(np.linalg.norm(half) / np.pi)])
    bodies["turn"][:, 2] /= np.linalg.norm(bodies["turn"][0, 2])
    for name in ("velocity", "spin", "acceleration", "spin_rate"):
        bodies[name] = 0.0
    return RigidRun(
        props=props,
        sliders=sliders,
        points=contacts.points[0],
        mass=masses,
        inertia=inertias,
        free=np.concatenate([np.ones(12, np.int64), np.asarray(free, np.int64)]),
        driven=driven,
        bodies=bodies,
        touches=touches,
        states=states,
        bodies_words=as_rows(bodies),
        touches_words=as_rows(touches),
        states_words=as_rows(states),
        scratch=np.zeros(1, dtype=SCRATCH),
        energy=energy,
        energy_words=as_rows(energy),
        u=np.zeros(12),
        ground=np.zeros(3),
        ground_mean=np.zeros(3),
        drive=np.zeros(2),
        clock=np.zeros(1, dtype=RIGID_CLOCK),
        counts=np.zeros(1, dtype=RIGID_COUNTS),
    )


class RigidOutput(NamedTuple):
    """Records of a run (n_out,)."""

    states: Records
    bodies: Records
    energy: Records


def rigid_input(
    ground: tuple[Floats, float], times: Floats, drive: Floats, load: Floats
) -> tuple[RigidInput, RigidOutput]:
    """Return the input of a run, and the records for its output.

    Shapes: ground (n, 3), times (n_out,), drive (n_out, 2), load (n_out, 6).
    """
    count = len(times)
    out = RigidOutput(
        states=np.zeros(count, dtype=STATE),
        bodies=np.zeros(count, dtype=BODIES),
        energy=np.zeros(count, dtype=RIGID_LEDGER),
    )
    given = RigidInput(
        motion=np.ascontiguousarray(ground[0]),
        motion_dt=float(ground[1]),
        times=times,
        drive=drive,
        load=load,
        words=as_rows(out.states),
        bodies=as_rows(out.bodies),
        energy=as_rows(out.energy),
    )
    return given, out


def stable_step(sliders: Records, props: Records, load: float) -> float:
    """Return an explicit step at half the stability limit.

    Shapes: sliders, props (1,).
    """
    mass = float(sliders["mass"][0].min())
    across = sliders["radius"][0] ** 2 / sliders["inertia"][0, :, :2].min()
    stiffness = 2.0 * float(sliders["stiffness"][0])
    damping = 2.0 * float(sliders["damping"][0])
    friction = load * float((props["friction_max"] / props["yield_displacement"]).max())
    if not props["fused"][0]:
        pressed = load + float(props["interface_preload"][0])
        friction += pressed * float(props["interface_friction"][0] / props["interface_yield"][0])
    inverse = max(1.0 / mass, 0.5 * across)
    rate = damping * inverse + math.sqrt((stiffness + friction) * inverse)
    return float(1.0 / rate)


def rigid_setup(
    length: float,
    largest: float,
    *,
    tolerance: float = DEFAULT_TOLERANCE,
    spectral_radius: float = 0.0,
    explicit: float = 0.0,
) -> RigidSetup:
    """Return the constants of the time integration."""
    alpha, beta, gamma = bossak(spectral_radius)
    return RigidSetup(alpha, beta, gamma, tolerance * length, 1e-9, largest, explicit)


class RigRun(NamedTuple):
    """A bearing (records are arrays of one), its path, its progress, and its output."""

    props: Records  # (1,)
    old: Records
    new: Records
    old_words: Words  # (1, words): the same memory
    new_words: Words
    work: Records
    heat: Floats  # parts of the temperatures (`heat_parts`)
    path: Floats  # (n, 2) places of the top plate
    loads: Floats  # (n,) axial loads, linear between
    velocity: float
    increment: float  # m, largest
    u: Floats  # (12,)
    v: Floats
    tangent: Floats  # (12, 12)
    states: Records  # (n,) STATE at the points
    velocities: Floats  # (n, 2)
    bodies: Records  # (n,) BODIES, if the sliders are bodies
    states_words: Words  # (n, words): the same memory
    bodies_words: Words
    reached: Words  # (2,) points reached, increments since
    clock: Floats  # (2,) time of the last point, of the last trial


def rig_run(
    props: Records,
    start: Records,
    heat: Floats,
    path: Floats,
    loads: Floats,
    velocity: float,
    increment: float,
) -> RigRun:
    """Return a bearing at rest that is to follow a path.

    Shapes: props, start (1,), path (n, 2), loads (n,).
    """
    old, new = start.copy(), start.copy()
    states, bodies = np.zeros(len(path), dtype=STATE), np.zeros(len(path), dtype=BODIES)
    return RigRun(
        props,
        old,
        new,
        as_rows(old),
        as_rows(new),
        np.zeros(1, dtype=WORK),
        heat,
        path,
        loads,
        velocity,
        increment,
        np.zeros(12),
        np.zeros(12),
        np.zeros((12, 12)),
        states,
        np.zeros((len(path), 2)),
        bodies,
        as_rows(states),
        as_rows(bodies),
        np.zeros(2, dtype=np.int64),
        np.zeros(2),
    )
