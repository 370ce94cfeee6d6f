"""Figures of fragility and risk."""

from frames.risk.fragility.plot_fragility import fragility_curves as fragility_curves
from frames.risk.fragility.plot_fragility import risk_deaggregation as risk_deaggregation
from frames.risk.fragility.plot_fragility import tornado_chart as tornado_chart
from frames.risk.fragility.plot_ida import ida_curves as ida_curves
from frames.risk.fragility.plot_ida import stripes as stripes
from lir_element import _lazy

__all__ = _lazy.listed(__file__)
