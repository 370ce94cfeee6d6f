"""Errors and warnings of structural models and of ground motions."""

from __future__ import annotations

from lir_element.errors import AnalysisWarning


class ModelError(ValueError):
    """A structural model, or a number of it, that cannot be used; the message names the culprit."""


class ModelWarning(UserWarning):
    """A structural model that can be used, with something that its user should know."""


class MotionError(ValueError):
    """A ground motion, a file or a spectrum that cannot be used; the message names the culprit."""


class MotionWarning(UserWarning):
    """A ground motion that can be used, with something that its user should know."""


class AuditWarning(AnalysisWarning):
    """A completed analysis in which something that was left out or is uncertain mattered."""
