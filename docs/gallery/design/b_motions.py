"""
A set of motions scaled to a spectrum
=====================================

Seven synthetic near-fault motions, scaled so that their mean does not fall below the target over
the range of periods.
"""

from frames.design import Spectrum, synthetic_near_fault
from frames.design.plots import motion_spectra

target = Spectrum.asce7(s_ms=0.9, s_m1=0.5)
motions = synthetic_near_fault(7, magnitude=6.8, distance=6.0, seed=1)
scaled = motions.scaled_to(target, rule="ASCE 7-22", periods=(1.5, 4.0))

assert scaled.scaling.least_ratio > 0.89

motion_spectra(scaled, target)
