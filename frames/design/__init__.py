"""Design: spectra and sets of motions, codes, checks, sizing, tests of bearings."""

from frames.design._errors import CheckError as CheckError
from frames.design._errors import ProjectError as ProjectError
from frames.design.calculation.check import Check as Check
from frames.design.calculation.check import Checks as Checks
from frames.design.calculation.standing import Standing as Standing
from frames.design.calculation.trace import Trace as Trace
from frames.design.codes.analysis import equivalent_linear as equivalent_linear
from frames.design.codes.asce7 import ASCE7 as ASCE7
from frames.design.codes.bounds import PropertyBounds as PropertyBounds
from frames.design.codes.bounds import PropertyModificationFactors as PropertyModificationFactors
from frames.design.codes.bounds import with_property_bounds as with_property_bounds
from frames.design.codes.en1998 import EN1998 as EN1998
from frames.design.codes.history_rules import ActionLevel as ActionLevel
from frames.design.codes.history_rules import HistoryRules as HistoryRules
from frames.design.codes.history_rules import LoadRule as LoadRule
from frames.design.codes.isolation import IsolationSystem as IsolationSystem
from frames.design.codes.nch2745 import NCh2745 as NCh2745
from frames.design.codes.outcome import EquivalentLinear as EquivalentLinear
from frames.design.codes.pendulum import FrictionPendulum as FrictionPendulum
from frames.design.codes.prototype_programme import ProgrammeDemands as ProgrammeDemands
from frames.design.codes.registry import HISTORY_RULES as HISTORY_RULES
from frames.design.codes.registry import DesignCode as DesignCode
from frames.design.codes.registry import RimRule as RimRule
from frames.design.codes.registry import SpectrumKey as SpectrumKey
from frames.design.codes.registry import code_named as code_named
from frames.design.codes.registry import register_code as register_code
from frames.design.codes.superstructure import Superstructure as Superstructure
from frames.design.devices.bearing_numbers import overlap_area as overlap_area
from frames.design.devices.capacity import capacity_checks as capacity_checks
from frames.design.devices.capacity import engagement_checks as engagement_checks
from frames.design.devices.device import device_checks as device_checks
from frames.design.devices.limits import DesignLimits as DesignLimits
from frames.design.hazard.code_rules import DampingRule as DampingRule
from frames.design.hazard.code_rules import ScalingRule as ScalingRule
from frames.design.hazard.motion_measures import motion_measures as motion_measures
from frames.design.hazard.motion_measures import pair_spectrum as pair_spectrum
from frames.design.hazard.motion_set import MotionSet as MotionSet
from frames.design.hazard.scaling import Scaling as Scaling
from frames.design.hazard.spectrum import Spectrum as Spectrum
from frames.design.hazard.stochastic_motion import NearFaultPulse as NearFaultPulse
from frames.design.hazard.stochastic_motion import PointSource as PointSource
from frames.design.hazard.synthetic_motions import PulseScatter as PulseScatter
from frames.design.hazard.synthetic_motions import synthetic_near_fault as synthetic_near_fault
from frames.design.histories.histories import bounded_histories as bounded_histories
from frames.design.histories.histories import history_checks as history_checks
from frames.design.histories.histories import history_demands as history_demands
from frames.design.histories.impacts import impact_demand as impact_demand
from frames.design.histories.impacts import repeated_motion as repeated_motion
from frames.design.histories.impacts import rim_engagement as rim_engagement
from frames.design.histories.impacts import slips_of_events as slips_of_events
from frames.design.histories.impacts import uplift_events as uplift_events
from frames.design.histories.motions import motion_checks as motion_checks
from frames.design.histories.motions import period_range as period_range
from frames.design.histories.single_run import event_checks as event_checks
from frames.design.histories.single_run import impact_checks as impact_checks
from frames.design.histories.single_run import resultant_offsets as resultant_offsets
from frames.design.project.check_register import RunToCheck as RunToCheck
from frames.design.project.check_register import register_check as register_check
from frames.design.project.check_register import unregister_check as unregister_check
from frames.design.sizing.proposal import Design as Design
from frames.design.sizing.proposal import design as design
from frames.design.sizing.selection import NoCandidateError as NoCandidateError
from frames.design.sizing.target import DesignTarget as DesignTarget
from frames.design.testing.acceptance import AcceptanceLimits as AcceptanceLimits
from frames.design.testing.acceptance import acceptance_checks as acceptance_checks
from frames.design.testing.loops import PrototypeTest as PrototypeTest
from frames.design.testing.loops import loop_properties as loop_properties
from frames.design.testing.programme import prototype_tests as prototype_tests
from frames.model.load_combinations import isolator_combinations as isolator_combinations

__all__ = [
    "ASCE7",
    "EN1998",
    "HISTORY_RULES",
    "AcceptanceLimits",
    "ActionLevel",
    "Check",
    "CheckError",
    "Checks",
    "DampingRule",
    "Design",
    "DesignCode",
    "DesignLimits",
    "DesignTarget",
    "EquivalentLinear",
    "FrictionPendulum",
    "HistoryRules",
    "IsolationSystem",
    "LoadRule",
    "MotionSet",
    "NCh2745",
    "NearFaultPulse",
    "NoCandidateError",
    "PointSource",
    "ProgrammeDemands",
    "ProjectError",
    "PropertyBounds",
    "PropertyModificationFactors",
    "PrototypeTest",
    "PulseScatter",
    "RimRule",
    "RunToCheck",
    "Scaling",
    "ScalingRule",
    "Spectrum",
    "SpectrumKey",
    "Standing",
    "Superstructure",
    "Trace",
    "acceptance_checks",
    "bounded_histories",
    "capacity_checks",
    "code_named",
    "design",
    "device_checks",
    "engagement_checks",
    "equivalent_linear",
    "event_checks",
    "history_checks",
    "history_demands",
    "impact_checks",
    "impact_demand",
    "isolator_combinations",
    "loop_properties",
    "motion_checks",
    "motion_measures",
    "overlap_area",
    "pair_spectrum",
    "period_range",
    "prototype_tests",
    "register_check",
    "register_code",
    "repeated_motion",
    "resultant_offsets",
    "rim_engagement",
    "slips_of_events",
    "synthetic_near_fault",
    "unregister_check",
    "uplift_events",
    "with_property_bounds",
]
