"""
Design spectra of three codes
=============================

Spectra of one site by ASCE 7-22, EN 1998 and NCh2745, at 5 % and at the damping of isolated
structures.
"""

from frames.design import Spectrum
from frames.design.plots import design_spectra

spectra = {
    "ASCE 7-22": Spectrum.asce7(s_ms=0.9, s_m1=0.5),
    "EN 1998": Spectrum.en1998(2.4, "C"),
    "NCh2745": Spectrum.nch2745("II", 1),
}

at_2_5 = [float(spectrum.acceleration([2.5])[0]) for spectrum in spectra.values()]
assert max(at_2_5) / min(at_2_5) < 2.0

design_spectra(spectra, dampings=(0.05, 0.2))
