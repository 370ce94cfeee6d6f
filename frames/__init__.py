"""Structures on seismic isolation bearings: frames, ground motions, time history analysis."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from frames._errors import AuditWarning as AuditWarning
    from frames._errors import ModelError as ModelError
    from frames._errors import ModelWarning as ModelWarning
    from frames._errors import MotionError as MotionError
    from frames._errors import MotionWarning as MotionWarning
    from frames.batch.cases import BatchProgress as BatchProgress
    from frames.batch.time_histories import time_histories as time_histories
    from frames.io import Frame as Frame
    from frames.library.models import lumped_mass as lumped_mass
    from frames.library.models import moment_frame as moment_frame
    from frames.library.shear_buildings import shear_building as shear_building
    from frames.model.damping import ModalDamping as ModalDamping
    from frames.model.damping import RayleighDamping as RayleighDamping
    from frames.model.sections import Section as Section
    from frames.motion.ground_motion import GroundMotion as GroundMotion
    from frames.recording.recording import Recording as Recording
    from frames.recording.recovery import force_tables as force_tables
    from frames.recording.recovery import member_forces as member_forces
    from frames.recording.recovery import storey_forces as storey_forces
    from frames.recording.recovery import support_reactions as support_reactions
    from frames.results.assumption_checks import audit as audit
    from frames.results.assumption_checks import audit_report as audit_report
    from frames.results.envelopes import ductility as ductility
    from frames.results.envelopes import envelope as envelope
    from frames.results.envelopes import storey_ductility as storey_ductility
    from frames.results.envelopes import write_tables as write_tables
    from frames.results.findings import Finding as Finding
    from frames.results.floor_spectra import floor_spectrum as floor_spectrum
    from frames.results.measures import drift_by_line as drift_by_line
    from frames.results.measures import energy_error as energy_error
    from frames.results.measures import floor_acceleration as floor_acceleration
    from frames.results.measures import storey_drift as storey_drift
    from frames.results.measures import uplift_gap as uplift_gap
    from frames.results.peaks import peaks as peaks
    from frames.results.peaks import summary as summary
    from frames.results.storage import load as load
    from frames.results.storage import save as save
    from frames.solve.step_sensitivity import step_sensitivity as step_sensitivity
    from frames.solve.time_history import Analysis as Analysis
    from frames.solve.time_history import time_history as time_history
    from frames.statics.gravity import gravity as gravity
    from frames.statics.gravity_state import GravityState as GravityState
    from frames.statics.model_check import ModelCheck as ModelCheck
    from frames.statics.modes import Modes as Modes
    from frames.statics.modes import modes as modes
    from lir_element.errors import AnalysisInterrupted as AnalysisInterrupted

if not TYPE_CHECKING:  # noqa: RUF067  # a checker of types would take any name for one of these
    from lir_element._lazy import lazily

    __getattr__, __dir__, __all__ = lazily(__name__, __file__)
