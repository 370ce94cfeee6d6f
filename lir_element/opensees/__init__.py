"""The bearing inside OpenSeesPy models."""

from lir_element.opensees.builtin import BUILTIN_KINDS as BUILTIN_KINDS
from lir_element.opensees.builtin import builtin_commands as builtin_commands
from lir_element.opensees.builtin import builtin_element as builtin_element
from lir_element.opensees.builtin_mapping import BuiltinValues as BuiltinValues
from lir_element.opensees.builtin_mapping import builtin_values as builtin_values
from lir_element.opensees.library import opensees as opensees
