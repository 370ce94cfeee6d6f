"""What an equivalent-linear analysis asks of a response spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol


class DesignSpectrum(Protocol):
    """A response spectrum of a standard."""

    @property
    def code(self) -> str:
        """Its standard: "asce7", "en1998" or "nch2745"."""
        ...

    @property
    def parameters(self) -> Mapping[str, float]:
        """Its parameters by symbol: S_MS and S_M1 in g for ASCE 7."""
        ...

    def acceleration(self, T: float, damping: float = 0.05) -> float:  # noqa: N803
        """Return the spectral acceleration [m/s2] at a period [s] and damping ratio [-]."""
        ...

    def damping_factor(self, damping: float) -> float:
        """Return the damping factor of the standard [-]: B that divides, or eta that multiplies."""
        ...
