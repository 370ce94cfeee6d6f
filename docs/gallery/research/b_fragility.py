"""
Fragility of two devices
========================

Lognormal curves of capacities, with the confidence that seven records give.
"""

from frames.risk import fit_capacities
from frames.risk.plots import fragility_curves

records = [f"record {k}" for k in range(1, 8)]
curves = {  # Sa(3 s) at which the storey drift reaches its limit [m/s2]
    "plain DCFP": fit_capacities([1.9, 2.1, 2.6, 2.2, 1.7, 3.0, 2.4], records),
    "LIR-DCFP": fit_capacities([2.3, 2.4, 3.0, 2.6, 1.9, 3.5, 2.7], records),
}

assert curves["LIR-DCFP"].median > curves["plain DCFP"].median

fragility_curves(curves, label="Sa(3 s)")
