"""
Which intensities make the risk
===============================

A fragility curve and the hazard of the site give the mean annual frequency of exceedance, and what
intensities contribute.
"""

from frames.risk import HazardCurve, lognormal_fragility, mean_annual_frequency
from frames.risk.plots import risk_deaggregation

hazard = HazardCurve(
    [0.05, 0.2, 0.5, 1.0, 2.0, 5.0, 20.0],  # Sa(3 s) [m/s2]
    [0.3, 0.06, 0.015, 4e-3, 6e-4, 3e-5, 1e-7],  # 1/year
)
medians = {"plain DCFP": 2.30, "LIR-DCFP": 2.67}  # m/s2
risks = {
    name: mean_annual_frequency(lognormal_fragility(median, 0.3), hazard)
    for name, median in medians.items()
}

assert risks["LIR-DCFP"].rate < risks["plain DCFP"].rate

risk_deaggregation(risks, label="Sa(3 s)")
