"""The LIR-DCFP bearing and its element; see docs/conventions.md for axes and signs."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lir_element.device.bearing import LIRBearing as LIRBearing
    from lir_element.device.bearing_checks import DesignWarning as DesignWarning
    from lir_element.device.features import Features as Features
    from lir_element.device.friction import CoulombFriction as CoulombFriction
    from lir_element.device.friction import FrictionLaw as FrictionLaw
    from lir_element.device.friction import MeasuredFriction as MeasuredFriction
    from lir_element.device.friction import VelocityFriction as VelocityFriction
    from lir_element.device.heating import FrictionHeating as FrictionHeating
    from lir_element.device.heating import PressureDependence as PressureDependence
    from lir_element.device.ring_strength import ring_strength as ring_strength
    from lir_element.device.specification import BackupSupport as BackupSupport
    from lir_element.element import Element as Element
    from lir_element.errors import AnalysisError as AnalysisError
    from lir_element.errors import AnalysisInterrupted as AnalysisInterrupted
    from lir_element.errors import AnalysisWarning as AnalysisWarning
    from lir_element.errors import RunStatus as RunStatus
    from lir_element.library import write_bearing as write_bearing
    from lir_element.library import write_library as write_library
    from lir_element.rig.cyclic_test import cyclic_test as cyclic_test

if not TYPE_CHECKING:  # noqa: RUF067  # a checker of types would take any name for one of these
    from lir_element._lazy import lazily

    __getattr__, __dir__, __all__ = lazily(__name__, __file__)
