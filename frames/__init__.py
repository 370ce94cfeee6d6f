"""Structures on seismic isolation bearings: frames, ground motions, time history analysis."""

from frames._errors import AuditWarning as AuditWarning
from frames._errors import ModelError as ModelError
from frames._errors import ModelWarning as ModelWarning
from frames._errors import MotionError as MotionError
from frames._errors import MotionWarning as MotionWarning
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
from frames.analysis.transient import time_history as time_history
from frames.frame import Frame as Frame
from frames.hazard.motion_measures import motion_measures as motion_measures
from frames.hazard.motion_set import MotionSet as MotionSet
from frames.hazard.pair_spectra import pair_spectrum as pair_spectrum
from frames.hazard.scaling import Scaling as Scaling
from frames.hazard.spectrum import Spectrum as Spectrum
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
from lir_element.device.features import Features as Features
from lir_element.errors import AnalysisInterrupted as AnalysisInterrupted

__all__ = [
    "AnalysisInterrupted",
    "AuditWarning",
    "BatchProgress",
    "Bilinear",
    "BoucWen",
    "Features",
    "Finding",
    "Frame",
    "GravityState",
    "GroundMotion",
    "HertzStop",
    "ModalDamping",
    "ModelCheck",
    "ModelError",
    "ModelWarning",
    "Modes",
    "MotionError",
    "MotionSet",
    "MotionWarning",
    "Pinching",
    "PlasticHinge",
    "RayleighDamping",
    "Recording",
    "Scaling",
    "Section",
    "Spectrum",
    "Stop",
    "Tie",
    "ViscousDamper",
    "audit",
    "audit_report",
    "drift_by_line",
    "ductility",
    "energy_error",
    "envelope",
    "floor_acceleration",
    "floor_spectrum",
    "force_tables",
    "gravity",
    "isolator_combinations",
    "load",
    "lumped_mass",
    "member_forces",
    "modes",
    "moment_frame",
    "motion_measures",
    "pair_spectrum",
    "peaks",
    "save",
    "shear_building",
    "storey_drift",
    "storey_ductility",
    "storey_forces",
    "summary",
    "support_reactions",
    "time_histories",
    "time_history",
    "uplift_gap",
    "write_tables",
]
