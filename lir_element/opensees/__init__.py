"""The bearing inside OpenSeesPy models."""

from lir_element import _lazy
from lir_element.opensees.compare.builtin import builtin_commands as builtin_commands
from lir_element.opensees.compare.builtin import builtin_element as builtin_element
from lir_element.opensees.compare.builtin_mapping import BuiltinValues as BuiltinValues
from lir_element.opensees.compare.builtin_mapping import builtin_values as builtin_values
from lir_element.opensees.compare.builtin_writing import BUILTIN_KINDS as BUILTIN_KINDS
from lir_element.opensees.compare.macro_model import MacroModel as MacroModel
from lir_element.opensees.compare.macro_model import macro_model as macro_model
from lir_element.opensees.isolation import Isolation as Isolation
from lir_element.opensees.isolation import IsolationWarning as IsolationWarning
from lir_element.opensees.isolation import isolate as isolate
from lir_element.opensees.library import opensees as opensees
from lir_element.opensees.out_of_process.remote import RouteWarning as RouteWarning
from lir_element.opensees.out_of_process.remote import ServerError as ServerError
from lir_element.opensees.placement import PlacementWarning as PlacementWarning
from lir_element.opensees.plugin import bearing_element as bearing_element
from lir_element.opensees.plugin import bearing_response as bearing_response
from lir_element.opensees.plugin import bearing_tags as bearing_tags
from lir_element.opensees.recording import BearingRecording as BearingRecording
from lir_element.opensees.recording import record_bearings as record_bearings

__all__ = _lazy.listed(__file__)
