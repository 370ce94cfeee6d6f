"""Synthetic near-fault motions: a pulse normal to the fault, with a stochastic background.

The pulse is that of Mavroeidis and Papageorgiou (2003), the background that of a point source
(Boore 2003). They are combined as the former propose: the pulse's Fourier amplitudes are subtracted
from the background's, whose phases stay, and the pulse is added at the background's strongest time.
The pulse governs near its frequency, the background elsewhere.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from frames._errors import MotionError, MotionWarning
from frames.design.hazard.motion_set import MotionSet
from frames.design.hazard.stochastic_motion import (
    PEAK,
    PULSE_VELOCITY,
    NearFaultPulse,
    PointSource,
    pulse_period,
    stochastic_acceleration,
)
from frames.motion.ground_motion import GroundMotion
from lir_element.argument_checks import (
    require_between,
    require_choice,
    require_non_negative,
    require_positive,
    require_type,
)
from lir_element.fields import check_numbers, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from frames._types import FloatArray

QUIET = 2.0
"""Time without shaking before and after a motion [s]."""


@dataclass(frozen=True, kw_only=True)
class PulseScatter:
    """Scatter of the pulses of a set; defaults are assumptions unless a source is named.

    Parameters
    ----------
    velocity : float
        Median amplitude A [m/s]; by Mavroeidis and Papageorgiou (2003) about 1 m/s for any
        magnitude, within some 7 km of the rupture (to be confirmed against the paper).
    velocity_dispersion : float
        Standard deviation of its logarithm [-].
    period : float, optional
        Median period [s]; by default that of the magnitude, `pulse_period`.
    period_dispersion : float
        Standard deviation of its logarithm [-].
    gamma : (float, float)
        Range of the lengths of the envelope over the period [-], uniform; 1 to 3 covers nearly
        all records of the same source (to be confirmed).
    phase : (float, float)
        Range of phases [rad], uniform.

    Raises
    ------
    MotionError
        If a value is out of its bounds.

    Examples
    --------
    >>> from frames.design import synthetic_near_fault
    >>> pulses = PulseScatter(velocity=0.6, period=2.0, period_dispersion=0.0)
    >>> motions = synthetic_near_fault(1, magnitude=6.5, distance=5.0, seed=1, pulses=pulses)
    >>> motions.facts["near-fault 1"]["pulse"]
    True
    """

    velocity: float = field(default=PULSE_VELOCITY, metadata=number("m/s", "(0, inf)"))
    velocity_dispersion: float = field(default=0.3, metadata=number("-", "[0, inf)"))
    period: float | None = field(default=None, metadata=number("s", "(0, inf)"))
    period_dispersion: float = field(default=0.3, metadata=number("-", "[0, inf)"))
    gamma: tuple[float, float] = (1.1, 3.0)
    phase: tuple[float, float] = (0.0, 2.0 * math.pi)

    def __post_init__(self) -> None:
        """Check."""
        check_numbers(self, error=MotionError)
        for name, least in (("gamma", 1.0), ("phase", -math.inf)):
            given = getattr(self, name)
            if np.shape(given) != (2,) or not least < given[0] <= given[1] < math.inf:
                above = f" above {least:g}" if least > 0.0 else ""
                msg = f"{name} = {given!r}: give the least and the largest one, finite{above}"
                raise MotionError(msg)

    def pulse(self, magnitude: float, rng: np.random.Generator) -> NearFaultPulse:
        """Return one pulse for a magnitude; `rng` draws four numbers."""
        median = pulse_period(magnitude) if self.period is None else self.period
        size, long = rng.standard_normal(2)
        return NearFaultPulse(
            velocity=self.velocity * math.exp(self.velocity_dispersion * size),
            period=median * math.exp(self.period_dispersion * long),
            gamma=float(rng.uniform(*self.gamma)),
            phase=float(rng.uniform(*self.phase)),
        )


PHASES = {"symmetric": 0.0, "antisymmetric": 0.5 * math.pi}
"""Phases of pulses by the shape of their velocity about their middle [rad]."""


def pulse_motions(
    periods: Sequence[float],
    velocities: Sequence[float] = (1.0,),
    *,
    shapes: Sequence[str] = ("symmetric",),
    cycles: float = 2.0,
    dt: float = 0.01,
) -> MotionSet:
    """Return near-fault pulses along x, one of each shape, period and peak velocity.

    Parameters
    ----------
    periods : sequence of float
        Periods T_p [s].
    velocities : sequence of float
        Peak velocities of the ground [m/s].
    shapes : sequence of {"symmetric", "antisymmetric"}
        Velocity about the middle of the pulse.
    cycles : float
        Length of the envelope over the period [-], above 1.
    dt : float
        Time step [s].

    Returns
    -------
    MotionSet
        Motions "symmetric pulse of 3 s, 1 m/s" and so on, without a background. Facts: near_fault,
        pulse, and "pulse shape", "pulse period" [s], "pulse velocity" [m/s], its peak.

    Raises
    ------
    MotionError
        If an argument is out of its bounds.

    Notes
    -----
    Source: the closed form of Mavroeidis and Papageorgiou (2003), `NearFaultPulse`.

    Examples
    --------
    >>> list(pulse_motions([1.5, 3.0], [0.8]))
    ['symmetric pulse of 1.5 s, 0.8 m/s', 'symmetric pulse of 3 s, 0.8 m/s']
    """
    step = require_positive("dt", dt, "s", error=MotionError)
    motions, facts = {}, {}
    for shape, period, peak in product(shapes, periods, velocities):
        require_choice("shape", shape, tuple(PHASES), error=MotionError)
        one = NearFaultPulse(velocity=1.0, period=period, gamma=cycles, phase=PHASES[shape])
        fine = np.linspace(0.0, one.duration, 2001)
        whole = replace(one, velocity=peak / float(np.abs(one.velocities(fine)).max()))
        name = f"{shape} pulse of {period:.4g} s, {peak:g} m/s"
        times = step * np.arange(math.ceil(one.duration / step - 1e-9) + 1)
        with warnings.catch_warnings(action="ignore", category=MotionWarning):  # one that is left
            motions[name] = GroundMotion(x=whole.accelerations(times), dt=step, name=name)
        facts[name] = {
            "near_fault": True,
            "pulse": True,
            "pulse shape": shape,
            "pulse period": period,
            "pulse velocity": peak,
        }
    return MotionSet(motions, facts)


def with_pulse(background: FloatArray, pulse: FloatArray, dt: float) -> FloatArray:
    """Add a pulse to a background, so that the pulse governs at its own frequencies.

    Shapes: background, pulse (n,), result (n,).
    """
    size = 2 * len(background)  # the end does not run into the beginning
    spectra = np.fft.rfft([background, pulse], size)
    amplitude = np.abs(spectra[0])
    kept = np.maximum(amplitude - np.abs(spectra[1]), 0.0)
    share = np.divide(kept, amplitude, out=np.zeros_like(kept), where=amplitude > 0.0)
    rest = np.fft.irfft(share * spectra[0], size)[: len(background)]
    return np.asarray(pulse + rest * _taper(len(background), dt), dtype=np.float64)


def synthetic_near_fault(
    count: int,
    magnitude: float,
    distance: float,
    *,
    seed: int,
    source: PointSource | None = None,
    pulses: PulseScatter | None = None,
    vertical_ratio: float = 2.0 / 3.0,
    dt: float = 0.01,
) -> MotionSet:
    """Return synthetic near-fault motions: x fault-normal with a pulse, y fault-parallel, z up.

    Parameters
    ----------
    count : int
        Number of motions.
    magnitude : float
        Moment magnitude, 5 to below 8.5.
    distance : float
        Closest distance to the rupture [km], at most 20. It changes the background, but not the
        pulse: set `pulses` if you have better values.
    seed : int
        Seed of the random numbers: the same seed gives the same motions.
    source : PointSource, optional
        The background's source and site, in place of that of the magnitude and the distance with
        defaults; it must have the same two.
    pulses : PulseScatter, optional
        Scatter of the pulses between motions.
    vertical_ratio : float
        Vertical over horizontal background [-]; 0 leaves the vertical component out. Codes take
        2/3; records near the fault have more at short periods.
    dt : float
        Time step [s].

    Returns
    -------
    MotionSet
        Motions "near-fault 1",... with the ground at rest at the end, without residual displacement
        (fling is removed). Facts: magnitude, distance, near_fault, pulse, and "pulse period" [s],
        "pulse velocity" [m/s], "pulse gamma", "pulse phase" [rad].

    Raises
    ------
    MotionError
        If an argument is out of its bounds.
    TypeError
        If an argument is of another kind.

    Notes
    -----
    Sources: Mavroeidis and Papageorgiou (2003), Boore (2003). Components have no common phases.

    Examples
    --------
    >>> motions = synthetic_near_fault(2, 6.5, 5.0, seed=1)
    >>> list(motions), sorted(motions["near-fault 1"].peak)
    (['near-fault 1', 'near-fault 2'], ['x', 'y', 'z'])
    """
    require_type("count", count, int, "a whole number")
    require_positive("count", count, error=MotionError)
    require_type("seed", seed, int, "a whole number, so that the motions can be made again")
    ratio = require_non_negative("vertical_ratio", vertical_ratio, "-", error=MotionError)
    require_between(
        "distance",
        distance,
        0.0,
        20.0 + 1e-9,
        "km",
        error=MotionError,
        remedy="farther away a motion has no pulse of this kind",
    )
    from_here = PointSource(magnitude=magnitude, distance=distance)
    ground = from_here if source is None else source
    scatter = PulseScatter() if pulses is None else pulses
    require_type("source", ground, PointSource, "a PointSource")
    require_type("pulses", scatter, PulseScatter, "a PulseScatter")
    for name in ("magnitude", "distance"):
        require_choice(
            f"source.{name}", getattr(ground, name), (getattr(from_here, name),), error=MotionError
        )
    motions, facts = {}, {}
    for k, rng in enumerate(np.random.default_rng(seed).spawn(count), 1):
        pulse = scatter.pulse(magnitude, rng)
        name = f"near-fault {k}"
        motions[name] = _motion(name, pulse, ground, ratio, dt, rng)
        facts[name] = {
            "magnitude": magnitude,
            "distance": distance,
            "near_fault": True,
            "pulse": True,
            "pulse period": pulse.period,
            "pulse velocity": pulse.velocity,
            "pulse gamma": pulse.gamma,
            "pulse phase": pulse.phase,
        }
    return MotionSet(motions, facts)


def _motion(
    name: str,
    pulse: NearFaultPulse,
    source: PointSource,
    vertical_ratio: float,
    dt: float,
    rng: np.random.Generator,
) -> GroundMotion:
    step = require_positive("dt", dt, "s", error=MotionError)
    reach = 2.0 * source.duration
    strongest = PEAK * reach
    before = max(0.0, 0.5 * pulse.duration - strongest)  # a pulse that begins first
    steps = math.ceil((before + max(reach, strongest + pulse.duration) + QUIET) / step) + 1
    lead = math.ceil((before + QUIET) / step)
    parts = [stochastic_acceleration(source, step, steps, rng) for _ in range(3)]
    x, y, z = (np.concatenate([np.zeros(lead), part]) for part in parts)
    middle = lead * step + strongest
    placed = NearFaultPulse(
        velocity=pulse.velocity,
        period=pulse.period,
        gamma=pulse.gamma,
        phase=pulse.phase,
        time=middle,
    )
    times = step * np.arange(len(x))
    edge = _taper(len(x), step)
    components = {"x": with_pulse(x * edge, placed.accelerations(times), step), "y": y * edge}
    if vertical_ratio > 0.0:
        components["z"] = vertical_ratio * z * edge
    made = GroundMotion(dt=step, name=name, **components).corrected()
    return GroundMotion(x=made.x, y=made.y, z=made.z, dt=step, name=name)


def _taper(steps: int, dt: float) -> FloatArray:
    # Cosines over the quiet time at both ends.
    times = dt * np.arange(steps)
    inward = np.minimum(times, times[-1] - times) / QUIET
    return np.asarray(np.sin(0.5 * np.pi * np.minimum(inward, 1.0)) ** 2, dtype=np.float64)
