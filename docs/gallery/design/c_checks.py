"""
Checks of a bearing
===================

Demand over capacity of the checks that geometry and friction alone decide, with lower and upper
bound friction.
"""

import matplotlib.pyplot as plt

from frames.demo import bearing_for
from frames.design import PropertyBounds, PropertyModificationFactors, device_checks

bounds = PropertyBounds(
    friction=PropertyModificationFactors(0.9, 1.2),
    interface=PropertyModificationFactors(0.9, 1.1),
)
checks = device_checks(bearing_for(1000e3), (600e3, 1400e3), slip=0.03, bounds=bounds)
judged = [check for check in checks if check.ratio is not None]
colours = ["C0" if check.passed else "C3" for check in judged]
plt.figure(figsize=(8, 3.2), layout="constrained")
plt.barh([check.statement for check in judged], [check.ratio for check in judged], color=colours)
plt.axvline(1.0, color="black")
plt.xlabel("demand / capacity [-]")

assert checks.governing.ratio == max(check.ratio for check in judged)
