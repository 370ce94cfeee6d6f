"""Hysteretic models of links and plastic hinges: how forces follow deformations."""

from frames.model.laws import Bilinear as Bilinear
from frames.model.laws import BoucWen as BoucWen
from frames.model.laws import Gap as Gap
from frames.model.laws import HertzGap as HertzGap
from frames.model.laws import Pinching as Pinching
from frames.model.laws import PlasticHinge as PlasticHinge
from frames.model.laws import Tie as Tie
from frames.model.laws import ViscousDamper as ViscousDamper
from lir_element import _lazy

__all__ = _lazy.listed(__file__)
