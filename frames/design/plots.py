"""Figures of spectra and motions, and of the candidates of a proposal of bearings."""

from frames.design.hazard.plot_hazard import design_spectra as design_spectra
from frames.design.hazard.plot_hazard import motion_spectra as motion_spectra
from frames.design.sizing.plot_candidates import design_candidates as design_candidates
from frames.design.sizing.plot_candidates import tried_candidates as tried_candidates
from lir_element import _lazy

__all__ = _lazy.listed(__file__)
