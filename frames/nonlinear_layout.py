"""How nonlinear parts lie in their arrays: laws by number, constants and states of each part."""

from __future__ import annotations

BILINEAR, BOUC_WEN, TIE, VISCOUS, MAXWELL, STOP, HERTZ, HINGES = range(8)
"""Laws by number; the last is a member with hinges."""

CONSTANTS = 50
"""Constants of a part, at most: those of two hinges."""

HINGE = 30
"""Where the constants of hinge i begin; those of hinge j follow after `STRIDE`."""

STRIDE = 10

STATE_SIZE = 10
"""Numbers of state of a part, at most."""

N_PLASTIC = 6
"""Plastic elongation, rotation about y and z of hinge i, then of hinge j: first in the state."""

WORK_DONE = 8
"""Where the state of a part has the work it has done; of hinge j it is the next one."""

SCRATCH = (18, 16)
"""Room that the solution of a hinged member needs."""

WIDEST = 5
"""Most deformations of one part."""

HINGED = -1.0
"""Marks a deformation of a hinged member among the elastic stiffnesses of parts."""
