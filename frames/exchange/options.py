"""What may be chosen when a frame is made of a building of another program."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

from frames._errors import ModelError
from lir_element.argument_checks import require_choice, require_positive, require_type

if TYPE_CHECKING:
    from pathlib import Path

    from frames.exchange.tables import Decimal
    from frames.model.sections import Section
    from lir_element import LIRBearing

BaseRotations: TypeAlias = Literal["kept", "free", "fixed"]
"""Rotations of joints on bearings about horizontal axes."""

Bearings: TypeAlias = "LIRBearing | Mapping[str, LIRBearing] | None"
"""One device, devices by group, joint, link or link property, or supports as they are."""


@dataclass(frozen=True)
class Options:
    """Options of an import; `Frame.from_sap2000` and `Frame.from_etabs` say what they mean."""

    bearing: Bearings = None
    at: Sequence[str] | None = None
    loads: Mapping[str, float] | str | None = None
    mass: Mapping[str, float] | None = None
    mesh: float = 1.25
    base_rotations: BaseRotations = "kept"
    base_diaphragm: bool = True
    allow: Collection[str] = ()
    decimal: Decimal = "."
    sections: Mapping[str, Section] | None = None
    library: str | Path | Sequence[str | Path] = ()

    def __post_init__(self) -> None:
        """Check what can be checked without the file."""
        choices = ("kept", "free", "fixed")
        require_choice("base_rotations", self.base_rotations, choices, error=ModelError)
        require_positive("mesh [m]", self.mesh, remedy="give metres", error=ModelError)
        kinds = (Mapping, str, type(None))
        require_type(
            "loads", self.loads, kinds, "factors by load pattern, or the name of one combination"
        )
        require_type("mass", self.mass, (Mapping, type(None)), "shares by load pattern")
        if isinstance(self.at, str):
            message = f'at = "{self.at}" must be a list of names: write ["{self.at}"]'
            raise TypeError(message)
        if self.at is not None and (self.bearing is None or isinstance(self.bearing, Mapping)):
            message = (
                "at says where one bearing stands: give one LIRBearing, or a mapping without at"
            )
            raise ModelError(message)
