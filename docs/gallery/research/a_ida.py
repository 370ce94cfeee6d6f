"""
Incremental dynamic analysis
============================

Storey drift of a stiff building over the intensity of four motions: it jumps where the rims are
met.
"""

from frames import shear_building
from frames.demo import bearing_for
from frames.design import synthetic_near_fault
from frames.risk import HuntFill, Intensity, LimitState, ida
from frames.risk.plots import ida_curves

bearing = bearing_for(1000e3)
building = shear_building(
    bearing.as_dcfp(), storey_mass=34e3, storey_stiffness=40e6, storeys=2, name="two storeys"
)
motions = synthetic_near_fault(4, magnitude=6.8, distance=6.0, seed=1)
intensity = Intensity(kind="Sa", period=3.0, measure="RotD50")  # 3 s: on the bearings
limit = LimitState.drift(0.004)
rules = HuntFill(first=1.0, growth=0.0, resolution=0.1, runs=7)  # Sa in m/s2
found = ida(building, motions, intensity=intensity, rules=rules, limit=limit)

assert found.capacities(limit)["capacity"].median() < 4.0  # m/s2

ida_curves(found, limit.quantity, limit=limit)
