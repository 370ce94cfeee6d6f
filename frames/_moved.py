"""Public names of the version before: they still work, with a warning that names the new one."""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any

_UNTIL = "0.3"

_RENAMED = {
    "HertzStop": "HertzGap",
    "LoopTest": "PrototypeTest",
    "PropertyFactors": "PropertyModificationFactors",
    "Stop": "Gap",
    "bounded": "with_property_bounds",
    "programme_of_tests": "prototype_tests",
}
"""New names by old ones; what is not here kept its name."""

_HOMES = {
    "frames.design": (
        "acceptance_checks AcceptanceLimits ActionLevel ASCE7 bounded bounded_histories "
        "capacity_checks Check CheckError Checks Design DesignLimits DesignTarget "
        "device_checks EN1998 engagement_checks equivalent_linear EquivalentLinear "
        "event_checks FrictionPendulum history_checks history_demands HISTORY_RULES "
        "HistoryRules impact_checks impact_demand IsolationSystem isolator_combinations "
        "loop_properties LoopTest motion_checks motion_measures MotionSet NCh2745 "
        "NearFaultPulse overlap_area pair_spectrum period_range PointSource "
        "programme_of_tests ProgrammeDemands ProjectError PropertyBounds PropertyFactors "
        "PulseScatter repeated_motion resultant_offsets rim_engagement Scaling "
        "slips_of_events Spectrum Superstructure synthetic_near_fault Trace uplift_events"
    ),
    "frames.laws": ("Bilinear BoucWen HertzStop Pinching PlasticHinge Stop Tie ViscousDamper"),
    "frames.risk": (
        "Campaign CampaignError CampaignStatus CampaignStore cloud_analysis "
        "collapse_margin_ratio CollapseFragility compare_fragility Comparison fit_capacities "
        "fit_cloud fit_stripes Fragility fragility_of FragilityError full_grid HazardCurve "
        "HuntFill ida IDA Intensity IntensityRuns latin_hypercube LimitState load_fragility "
        "lognormal_fragility mean_annual_frequency multiple_stripes open_campaign "
        "ParameterSample Risk RiskWarning save_fragility sobol_indices sobol_sample "
        "SobolIndices Tornado tornado"
    ),
    "lir_element": ("Features"),
}
_PLOTS = {
    "frames.design.plots": "design_spectra motion_spectra",
    "frames.risk.plots": "fragility_curves ida_curves risk_deaggregation stripes tornado_chart",
}


def _table(homes: dict[str, str]) -> dict[str, str]:
    return {name: home for home, names in homes.items() for name in names.split()}


NAMES = {"frames": _table(_HOMES), "frames.plots": _table(_PLOTS)}
"""For each package that names moved out of: where each is now."""


def moved_name(package: str, name: str) -> Any:
    """Return what a name of the version before stands for, with a warning."""
    if (package, name) == ("frames", "design"):
        return import_module("frames.design")  # which can be called as the function it was
    home = NAMES[package].get(name)
    if home is None:
        msg = f"module {package!r} has no attribute {name!r}"
        raise AttributeError(msg)
    new = _RENAMED.get(name, name)
    warnings.warn(
        f"{package}.{name} is now {home}.{new}; the old name goes with version {_UNTIL}",
        DeprecationWarning,
        stacklevel=3,
    )
    return getattr(import_module(home), new)
