"""Structures on seismic isolation bearings: frames, ground motions, time history analysis."""

from frames._errors import AuditWarning as AuditWarning
from frames._errors import CampaignError as CampaignError
from frames._errors import CheckError as CheckError
from frames._errors import FragilityError as FragilityError
from frames._errors import ModelError as ModelError
from frames._errors import ModelWarning as ModelWarning
from frames._errors import MotionError as MotionError
from frames._errors import MotionWarning as MotionWarning
from frames._errors import ProjectError as ProjectError
from frames.analysis.batch import time_histories as time_histories
from frames.analysis.cases import BatchProgress as BatchProgress
from frames.analysis.model_check import ModelCheck as ModelCheck
from frames.analysis.modes import Modes as Modes
from frames.analysis.modes import modes as modes
from frames.analysis.recording import Recording as Recording
from frames.analysis.recovery import force_tables as force_tables
from frames.analysis.recovery import member_forces as member_forces
from frames.analysis.recovery import storey_forces as storey_forces
from frames.analysis.recovery import support_reactions as support_reactions
from frames.analysis.static import GravityState as GravityState
from frames.analysis.static import gravity as gravity
from frames.analysis.step_sensitivity import step_sensitivity as step_sensitivity
from frames.analysis.transient import time_history as time_history
from frames.campaign.campaign import Campaign as Campaign
from frames.campaign.sampling import ParameterSample as ParameterSample
from frames.campaign.sampling import full_grid as full_grid
from frames.campaign.sampling import latin_hypercube as latin_hypercube
from frames.campaign.sampling import sobol_sample as sobol_sample
from frames.campaign.store import CampaignStatus as CampaignStatus
from frames.campaign.store import CampaignStore as CampaignStore
from frames.campaign.store import open_campaign as open_campaign
from frames.checks.acceptance import AcceptanceLimits as AcceptanceLimits
from frames.checks.acceptance import acceptance_checks as acceptance_checks
from frames.checks.analysis import equivalent_linear as equivalent_linear
from frames.checks.asce7 import ASCE7 as ASCE7
from frames.checks.bounds import PropertyBounds as PropertyBounds
from frames.checks.bounds import PropertyFactors as PropertyFactors
from frames.checks.bounds import bounded as bounded
from frames.checks.capacity import capacity_checks as capacity_checks
from frames.checks.capacity import engagement_checks as engagement_checks
from frames.checks.check import Check as Check
from frames.checks.check import Checks as Checks
from frames.checks.device import device_checks as device_checks
from frames.checks.en1998 import EN1998 as EN1998
from frames.checks.histories import bounded_histories as bounded_histories
from frames.checks.histories import history_checks as history_checks
from frames.checks.histories import history_demands as history_demands
from frames.checks.history_rules import HISTORY_RULES as HISTORY_RULES
from frames.checks.history_rules import HistoryRules as HistoryRules
from frames.checks.impacts import impact_demand as impact_demand
from frames.checks.impacts import repeated_motion as repeated_motion
from frames.checks.impacts import rim_engagement as rim_engagement
from frames.checks.impacts import slips_of_events as slips_of_events
from frames.checks.impacts import uplift_events as uplift_events
from frames.checks.isolation import IsolationSystem as IsolationSystem
from frames.checks.levels import ActionLevel as ActionLevel
from frames.checks.limits import DesignLimits as DesignLimits
from frames.checks.loops import LoopTest as LoopTest
from frames.checks.loops import loop_properties as loop_properties
from frames.checks.motions import motion_checks as motion_checks
from frames.checks.motions import period_range as period_range
from frames.checks.nch2745 import NCh2745 as NCh2745
from frames.checks.outcome import EquivalentLinear as EquivalentLinear
from frames.checks.overlap import overlap_area as overlap_area
from frames.checks.pendulum import FrictionPendulum as FrictionPendulum
from frames.checks.programme import ProgrammeDemands as ProgrammeDemands
from frames.checks.programme import programme_of_tests as programme_of_tests
from frames.checks.resultants import resultant_offsets as resultant_offsets
from frames.checks.single_run import event_checks as event_checks
from frames.checks.single_run import impact_checks as impact_checks
from frames.checks.superstructure import Superstructure as Superstructure
from frames.checks.trace import Trace as Trace
from frames.fragility.analyses import cloud_analysis as cloud_analysis
from frames.fragility.analyses import ida as ida
from frames.fragility.analyses import multiple_stripes as multiple_stripes
from frames.fragility.cloud_fit import fit_cloud as fit_cloud
from frames.fragility.comparison import Comparison as Comparison
from frames.fragility.comparison import compare_fragility as compare_fragility
from frames.fragility.curve import CollapseFragility as CollapseFragility
from frames.fragility.curve import Fragility as Fragility
from frames.fragility.curve import lognormal_fragility as lognormal_fragility
from frames.fragility.files import load_fragility as load_fragility
from frames.fragility.files import save_fragility as save_fragility
from frames.fragility.fitting import fit_capacities as fit_capacities
from frames.fragility.fitting import fit_stripes as fit_stripes
from frames.fragility.hazard_curve import HazardCurve as HazardCurve
from frames.fragility.hunt_fill import HuntFill as HuntFill
from frames.fragility.incremental import IDA as IDA
from frames.fragility.intensity import Intensity as Intensity
from frames.fragility.limit_state import LimitState as LimitState
from frames.fragility.of_runs import fragility_of as fragility_of
from frames.fragility.risk import Risk as Risk
from frames.fragility.risk import RiskWarning as RiskWarning
from frames.fragility.risk import collapse_margin_ratio as collapse_margin_ratio
from frames.fragility.risk import mean_annual_frequency as mean_annual_frequency
from frames.fragility.runs import IntensityRuns as IntensityRuns
from frames.fragility.sensitivity import SobolIndices as SobolIndices
from frames.fragility.sensitivity import Tornado as Tornado
from frames.fragility.sensitivity import sobol_indices as sobol_indices
from frames.fragility.sensitivity import tornado as tornado
from frames.frame import Frame as Frame
from frames.hazard.motion_measures import motion_measures as motion_measures
from frames.hazard.motion_set import MotionSet as MotionSet
from frames.hazard.near_fault_pulse import NearFaultPulse as NearFaultPulse
from frames.hazard.pair_spectra import pair_spectrum as pair_spectrum
from frames.hazard.scaling import Scaling as Scaling
from frames.hazard.spectrum import Spectrum as Spectrum
from frames.hazard.stochastic_motion import PointSource as PointSource
from frames.hazard.synthetic_motions import PulseScatter as PulseScatter
from frames.hazard.synthetic_motions import synthetic_near_fault as synthetic_near_fault
from frames.library.models import lumped_mass as lumped_mass
from frames.library.models import moment_frame as moment_frame
from frames.library.models import shear_building as shear_building
from frames.model.combining import isolator_combinations as isolator_combinations
from frames.model.damping import ModalDamping as ModalDamping
from frames.model.damping import RayleighDamping as RayleighDamping
from frames.model.laws import Bilinear as Bilinear
from frames.model.laws import BoucWen as BoucWen
from frames.model.laws import HertzStop as HertzStop
from frames.model.laws import Pinching as Pinching
from frames.model.laws import PlasticHinge as PlasticHinge
from frames.model.laws import Stop as Stop
from frames.model.laws import Tie as Tie
from frames.model.laws import ViscousDamper as ViscousDamper
from frames.model.sections import Section as Section
from frames.motion.ground_motion import GroundMotion as GroundMotion
from frames.results.auditing import Finding as Finding
from frames.results.auditing import audit as audit
from frames.results.auditing import audit_report as audit_report
from frames.results.ductility import ductility as ductility
from frames.results.ductility import storey_ductility as storey_ductility
from frames.results.envelopes import envelope as envelope
from frames.results.envelopes import write_tables as write_tables
from frames.results.measures import drift_by_line as drift_by_line
from frames.results.measures import energy_error as energy_error
from frames.results.measures import floor_acceleration as floor_acceleration
from frames.results.measures import floor_spectrum as floor_spectrum
from frames.results.measures import storey_drift as storey_drift
from frames.results.measures import uplift_gap as uplift_gap
from frames.results.peaks import peaks as peaks
from frames.results.peaks import summary as summary
from frames.results.storage import load as load
from frames.results.storage import save as save
from frames.sizing.proposal import Design as Design
from frames.sizing.proposal import design as design
from frames.sizing.target import DesignTarget as DesignTarget
from lir_element.device.features import Features as Features
from lir_element.errors import AnalysisInterrupted as AnalysisInterrupted

__all__ = [
    "ASCE7",
    "EN1998",
    "HISTORY_RULES",
    "IDA",
    "AcceptanceLimits",
    "ActionLevel",
    "AnalysisInterrupted",
    "AuditWarning",
    "BatchProgress",
    "Bilinear",
    "BoucWen",
    "Campaign",
    "CampaignError",
    "CampaignStatus",
    "CampaignStore",
    "Check",
    "CheckError",
    "Checks",
    "CollapseFragility",
    "Comparison",
    "Design",
    "DesignLimits",
    "DesignTarget",
    "EquivalentLinear",
    "Features",
    "Finding",
    "Fragility",
    "FragilityError",
    "Frame",
    "FrictionPendulum",
    "GravityState",
    "GroundMotion",
    "HazardCurve",
    "HertzStop",
    "HistoryRules",
    "HuntFill",
    "Intensity",
    "IntensityRuns",
    "IsolationSystem",
    "LimitState",
    "LoopTest",
    "ModalDamping",
    "ModelCheck",
    "ModelError",
    "ModelWarning",
    "Modes",
    "MotionError",
    "MotionSet",
    "MotionWarning",
    "NCh2745",
    "NearFaultPulse",
    "ParameterSample",
    "Pinching",
    "PlasticHinge",
    "PointSource",
    "ProgrammeDemands",
    "ProjectError",
    "PropertyBounds",
    "PropertyFactors",
    "PulseScatter",
    "RayleighDamping",
    "Recording",
    "Risk",
    "RiskWarning",
    "Scaling",
    "Section",
    "SobolIndices",
    "Spectrum",
    "Stop",
    "Superstructure",
    "Tie",
    "Tornado",
    "Trace",
    "ViscousDamper",
    "acceptance_checks",
    "audit",
    "audit_report",
    "bounded",
    "bounded_histories",
    "capacity_checks",
    "cloud_analysis",
    "collapse_margin_ratio",
    "compare_fragility",
    "design",
    "device_checks",
    "drift_by_line",
    "ductility",
    "energy_error",
    "engagement_checks",
    "envelope",
    "equivalent_linear",
    "event_checks",
    "fit_capacities",
    "fit_cloud",
    "fit_stripes",
    "floor_acceleration",
    "floor_spectrum",
    "force_tables",
    "fragility_of",
    "full_grid",
    "gravity",
    "history_checks",
    "history_demands",
    "ida",
    "impact_checks",
    "impact_demand",
    "isolator_combinations",
    "latin_hypercube",
    "load",
    "load_fragility",
    "lognormal_fragility",
    "loop_properties",
    "lumped_mass",
    "mean_annual_frequency",
    "member_forces",
    "modes",
    "moment_frame",
    "motion_checks",
    "motion_measures",
    "multiple_stripes",
    "open_campaign",
    "overlap_area",
    "pair_spectrum",
    "peaks",
    "period_range",
    "programme_of_tests",
    "repeated_motion",
    "resultant_offsets",
    "rim_engagement",
    "save",
    "save_fragility",
    "shear_building",
    "slips_of_events",
    "sobol_indices",
    "sobol_sample",
    "step_sensitivity",
    "storey_drift",
    "storey_ductility",
    "storey_forces",
    "summary",
    "support_reactions",
    "synthetic_near_fault",
    "time_histories",
    "time_history",
    "tornado",
    "uplift_events",
    "uplift_gap",
    "write_tables",
]
