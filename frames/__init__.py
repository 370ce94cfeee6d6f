"""Structures on seismic isolation bearings: frames, ground motions, time history analysis."""

from frames._validate import ModelError as ModelError
from frames._validate import ModelWarning as ModelWarning
from frames.auditing import Finding as Finding
from frames.auditing import audit as audit
from frames.auditing import audit_report as audit_report
from frames.damping import ModalDamping as ModalDamping
from frames.damping import RayleighDamping as RayleighDamping
from frames.ground_motion import GroundMotion as GroundMotion
from frames.library import lumped_mass as lumped_mass
from frames.library import moment_frame as moment_frame
from frames.library import shear_building as shear_building
from frames.model import Frame as Frame
from frames.results import energy_error as energy_error
from frames.results import floor_acceleration as floor_acceleration
from frames.results import load as load
from frames.results import save as save
from frames.results import storey_drift as storey_drift
from frames.sections import Section as Section
from frames.static import gravity as gravity
from frames.static import modes as modes
from frames.transient import time_history as time_history
from lir_element.features import Features as Features
