"""Figures of spectra and motions."""

from frames.design.hazard.plot_hazard import design_spectra as design_spectra
from frames.design.hazard.plot_hazard import motion_spectra as motion_spectra

__all__ = [
    "design_spectra",
    "motion_spectra",
]
