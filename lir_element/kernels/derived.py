"""Formulas of results derived from a bearing's state, compiled."""

from __future__ import annotations

from lir_element import formulas
from lir_element._compile.jit import inlined_by_llvm

in_plan = inlined_by_llvm(formulas.in_plan)
in_space = inlined_by_llvm(formulas.in_space)
eccentricity = inlined_by_llvm(formulas.eccentricity)
resultant_offset = inlined_by_llvm(formulas.resultant_offset)
