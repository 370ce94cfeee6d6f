"""What published studies say of the same questions, beside the numbers of this one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from validation.study.pairs import OURS, UNBREAKABLE
from validation.study.records_runs import COLLAPSE

if TYPE_CHECKING:
    from collections.abc import Mapping


def published(found: Mapping[str, Any]) -> str:
    """Return the comparison with what could be read of published work."""
    near, shares = _collapse(found)
    ours, plain = (100.0 * shares[name] for name in (OURS, UNBREAKABLE))
    worse = ours > plain
    return "\n".join(
        [
            "Only what could be read is named: abstracts, data and code, no figures.\n",
            "- **Kitayama and Constantinou (2018)**, Engineering Structures 164:243-258: isolated "
            "buildings of the minimum criteria of ASCE/SEI 7-10 and 7-16, on triple pendulums that "
            "stiffen and on double concave sliders without a restrainer, may have an unacceptable "
            "probability of collapse in the MCE_R; stronger frames (R_I = 1) with isolators of more "
            "displacement make it acceptable. Here, bearings filled by the maximum considered "
            f"earthquake collapse in {plain:.0f} % (rims that never break) and {ours:.0f} % "
            f"({OURS}) of the records at {near:g} m/s2"
            + (
                f": {'the LIR-DCFP' if worse else 'the DCFP'} is above the 10 % that ASCE/SEI 7 "
                "aims at. That capacity decides, and what happens at its end, agrees."
                if max(ours, plain) > 10.0 >= min(ours, plain)
                else ". That capacity decides, and what happens at its end, agrees."
            ),
            "- **Kitayama and Cilsalar (2022)**, Bulletin of Earthquake Engineering 20:1143-1168: of "
            "isolated buildings those with isolators of 1.5 times the least displacement capacity cost "
            "least a year; incremental analysis with the far-field set of FEMA P695 doubles the annual "
            "loss that records fitted to a conditional spectrum give. Losses of this page are of the "
            "far-field set scaled without a target, so they are likely too high, for all devices; "
            f"the line over SaRatio moves the collapse margin of the LIR-DCFP (equal sliders) by "
            f"{_moved(found, OURS):+.0f} % and that of the DCFP by {_moved(found, UNBREAKABLE):+.0f} % "
            "at the shape of a code's spectrum.",
            "- **Di Cesare et al.**, Frontiers in Built Environment, doi 10.3389/fbuil.2022.1083266: double "
            "concave sliders with flat rims go on carrying and dissipating when the slider leaves its "
            "plate. Here a failed bearing is collapse: for bearings that have somewhere to go, that is "
            "pessimistic, and more so for the device that fails more bearings.",
            "- **Auad, Castaldo and Almazan (2022)** on the reliability of LIR-DCFP and DCFP, the "
            "thesis of Auad (2022, Pontificia Universidad Catolica de Chile), and **Bao and Becker** "
            "(2018, 2019) on rims that fail: no text with numbers could be read, so nothing is compared.",
        ]
    )


def _collapse(found: Mapping[str, Any]) -> tuple[float, dict[str, float]]:
    # Shares that collapse in the stripe next to the maximum considered earthquake.
    stripes = found["stripes"][COLLAPSE.name]
    levels = [row[0] for row in stripes[OURS]]
    k = min(range(len(levels)), key=lambda n: abs(levels[n] - found["considered"]))
    return levels[k], {name: rows[k][1] / rows[k][2] for name, rows in stripes.items()}


def _moved(found: Mapping[str, Any], name: str) -> float:
    line = found["shape"]["lines"][name]
    return 100.0 * float(line["corrected"][0] / line["margin"][0] - 1.0)
