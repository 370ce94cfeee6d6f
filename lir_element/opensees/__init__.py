"""The bearing inside OpenSeesPy models."""

from lir_element.opensees.library import opensees as opensees
from lir_element.opensees.macro_model import MacroModel as MacroModel
from lir_element.opensees.macro_model import macro_model as macro_model
