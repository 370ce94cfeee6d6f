"""Random ground motions: pulses, noise, spikes, steps and pauses in up to three components."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from frames import GroundMotion
from lir_element.units import STANDARD_GRAVITY
from validation.fuzzing.bearings import chosen, log_uniform

if TYPE_CHECKING:
    from frames._types import FloatArray

MOST_SAMPLES = 4000
DIRECTIONS = {"xyz": 0.45, "xy": 0.25, "x": 0.15, "xz": 0.08, "y": 0.04, "z": 0.03}
"""Shares of the components that a motion has."""


def random_motion(
    rng: np.random.Generator, period: float, *, shortest: float = 1e-3
) -> GroundMotion:
    """Draw a motion that suits a pendulum of this period."""
    duration = min(max(rng.uniform(0.8, 2.5) * period, 1.0), 8.0)
    step = log_uniform(rng, shortest, 0.03) if rng.random() < 0.6 else 0.005
    step = max(step, duration / MOST_SAMPLES)
    t: FloatArray = np.arange(max(int(duration / step), 20), dtype=np.float64) * step
    waves: dict[str, FloatArray] = {}
    for axis in chosen(rng, DIRECTIONS):
        if axis == "z":
            strength = STANDARD_GRAVITY * log_uniform(rng, 0.01, 1.6)
        else:
            strength = STANDARD_GRAVITY * log_uniform(rng, 0.02, 1.5 if rng.random() < 0.2 else 0.5)
        waves[axis] = random_wave(rng, t, strength, period if axis != "z" else 0.3 * period)
    return GroundMotion(**waves, dt=step, name="random")


def random_wave(rng: np.random.Generator, t: FloatArray, peak: float, period: float) -> FloatArray:
    """Return a mixture of one to three ingredients, with pauses in some, of this peak [m/s2]."""
    wave = np.zeros(len(t))
    kinds = [pulse, noise, spikes, steps, sweep]
    count = 1 + int(rng.integers(0, 3))
    for place in rng.choice(len(kinds), size=count, p=[0.4, 0.2, 0.15, 0.1, 0.15]):
        part = kinds[int(place)](rng, t, period)
        wave += rng.uniform(0.2, 1.0) * part / max(float(np.abs(part).max()), 1e-12)
    for _ in range(int(rng.integers(0, 3))):  # pauses, entered and left at once
        first = rng.uniform(0.0, t[-1])
        wave[(t >= first) & (t < first + rng.uniform(0.05, 0.3) * t[-1])] = 0.0
    if rng.random() < 0.5:
        wave *= np.minimum(t / (0.1 * t[-1]), 1.0)
    largest = float(np.abs(wave).max())
    return wave * (peak / largest) if largest > 0.0 else wave


def pulse(rng: np.random.Generator, t: FloatArray, period: float) -> FloatArray:
    """Return a sine of a few cycles under a bell."""
    own = period * log_uniform(rng, 0.1, 1.2)
    centre, width = rng.uniform(0.1, 0.7) * t[-1], own * rng.uniform(0.5, 2.0)
    bell: FloatArray = np.exp(-(((t - centre) / width) ** 2))
    return bell * np.sin(2.0 * math.pi * t / own + rng.uniform(0.0, 6.3))


def noise(rng: np.random.Generator, t: FloatArray, period: float) -> FloatArray:
    """Return noise, its high frequencies taken out in half of the cases."""
    raw = rng.normal(size=len(t))
    if rng.random() < 0.5:
        return np.asarray(raw)
    width = max(int(0.02 * period / (t[1] - t[0])), 1)
    return np.asarray(np.convolve(raw, np.ones(width) / width, mode="same"))


def spikes(rng: np.random.Generator, t: FloatArray, period: float) -> FloatArray:
    """Return up to four single samples."""
    wave = np.zeros(len(t))
    for _ in range(int(rng.integers(1, 5))):
        wave[int(rng.integers(0, len(t)))] = rng.uniform(-1.0, 1.0)
    return wave


def steps(rng: np.random.Generator, t: FloatArray, period: float) -> FloatArray:
    """Return a constant acceleration that begins, turns round and ends at once."""
    length = rng.uniform(0.05, 0.3) * period
    first = rng.uniform(0.0, max(t[-1] - 2.0 * length, 0.0))
    back = (t >= first + length) & (t < first + 2.0 * length)
    return np.where((t >= first) & (t < first + length), 1.0, 0.0) - np.where(back, 1.0, 0.0)


def sweep(rng: np.random.Generator, t: FloatArray, period: float) -> FloatArray:
    """Return a sine whose frequency rises or falls through the motion."""
    low, high = sorted(log_uniform(rng, 0.3, 12.0) / period for _ in range(2))
    if rng.random() < 0.5:
        low, high = high, low
    return np.asarray(np.sin(2.0 * math.pi * (low + 0.5 * (high - low) * t / t[-1]) * t))


def turned(motion: GroundMotion, angle: float) -> GroundMotion:
    """Return the motion turned about the vertical by `angle` [rad]."""
    x, y, z = motion.components.T
    c, s = math.cos(angle), math.sin(angle)
    if abs(round(angle / (0.5 * math.pi)) - angle / (0.5 * math.pi)) < 1e-12:
        c, s = float(round(c)), float(round(s))
    return GroundMotion(x=c * x - s * y, y=s * x + c * y, z=z, dt=motion.dt, name=motion.name)


def mirrored(motion: GroundMotion) -> GroundMotion:
    """Return the motion seen in a mirror: y turned round."""
    x, y, z = motion.components.T
    return GroundMotion(x=x, y=-y, z=z, dt=motion.dt, name=motion.name)
