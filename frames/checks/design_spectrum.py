"""What an equivalent-linear analysis asks of a response spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol


class DesignSpectrum(Protocol):
    """A response spectrum of a standard, such as `Spectrum`."""

    @property
    def code(self) -> str:
        """Its standard, as in "ASCE 7-22", "EN 1998-1" or "NCh2745"."""
        ...

    @property
    def parameters(self) -> Mapping[str, float]:
        """Its parameters by symbol: S_MS and S_M1 in g for ASCE 7."""
        ...

    def acceleration(self, period: float, damping: float = 0.05) -> float:
        """Return the spectral acceleration [m/s2] at a period [s] and damping ratio [-]."""
        ...

    def damping_factor(self, damping: float) -> float:
        """Return B [-], by which the standard divides the spectrum of 5 % damping."""
        ...
