"""
6. A design
===========

From a spectrum to checked bearings: proposal by equivalent-linear analysis, scaled motions, time
histories at lower and upper bound friction, checks. On the command line ``lir new``, ``lir
design`` and ``lir run`` do the same from a file.
"""

# %%
# Structure and spectrum
# ----------------------
# The bearings that the frame has now are placeholders: their places count, and the loads on them.

import warnings

from frames import AuditWarning, moment_frame
from frames.demo import bearing_for
from frames.design import (
    DesignLimits,
    DesignTarget,
    PropertyBounds,
    PropertyModificationFactors,
    Spectrum,
    bounded_histories,
    design,
    history_checks,
    synthetic_near_fault,
)
from frames.design.plots import design_candidates, design_spectra, motion_spectra

frame = moment_frame(bays=(2, 1), storeys=2, bearing=bearing_for(800e3), floor_load=1000.0)
spectrum = Spectrum.asce7(s_ms=0.9, s_m1=0.5)
bounds = PropertyBounds(
    friction=PropertyModificationFactors(0.8, 1.3),
    interface=PropertyModificationFactors(0.9, 1.1),
)
design_spectra(spectrum)

# %%
# Bearings proposed
# -----------------
# Each radius and friction of the target is tried; of what keeps all checks, the one with the least
# base shear is taken.

target = DesignTarget(
    radii=(1.5, 2.0),
    frictions=(0.05, 0.06),
    rim_share=0.9,
    pressure=12e6,
    least_pressure=4e6,  # a light building: the liner is one for low pressure
    limits=DesignLimits(margin=1.6),
)
proposal = design(frame, spectrum, bounds=bounds, target=target)
print(proposal)

# %%
# What it was chosen from, by what limits each candidate.

design_candidates(proposal, target=target)

# %%
# Motions
# -------
# Synthetic motions stand here for records; a design takes recorded ones where there are some.

motions = synthetic_near_fault(7, magnitude=6.8, distance=15.0, seed=3)
scaled = motions.scaled_to(spectrum, rule="ASCE 7-22", periods=(2.0, 4.0))
motion_spectra(scaled, spectrum)

# %%
# Time histories at the bounds of friction
# ----------------------------------------
# The frame on the proposed bearings, seven motions at lower bound, nominal and upper bound
# friction. Each run checks its modelling assumptions; those that warn want a second look, at the
# level "contact".

isolated = proposal.isolated(frame)
with warnings.catch_warnings(action="ignore", category=AuditWarning):  # they are counted below
    runs = bounded_histories(isolated, scaled, bounds)
for bound, found in runs.items():
    peak = found["peak"].sel(quantity="bearing displacement")
    warned = int((found["doubts"] != "").sum())
    print(f"{bound}: mean displacement {1e3 * float(peak.mean()):.0f} mm, {warned} of 7 runs warn")

# %%
# Checks
# ------
# Means of the motions, as the code counts them; each check carries its calculation.

checks = history_checks(runs, isolated, "ASCE 7-22", bounds=bounds)
assert not checks.failed
checks
