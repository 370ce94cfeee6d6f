"""Figures of fragility and risk."""

from frames.risk.fragility.plot_fragility import fragility_curves as fragility_curves
from frames.risk.fragility.plot_fragility import risk_deaggregation as risk_deaggregation
from frames.risk.fragility.plot_fragility import tornado_chart as tornado_chart
from frames.risk.fragility.plot_ida import ida_curves as ida_curves
from frames.risk.fragility.plot_ida import stripes as stripes

__all__ = [
    "fragility_curves",
    "ida_curves",
    "risk_deaggregation",
    "stripes",
    "tornado_chart",
]
