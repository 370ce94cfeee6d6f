"""The bearing inside OpenSeesPy models."""

from lir_element.opensees.library import opensees as opensees
