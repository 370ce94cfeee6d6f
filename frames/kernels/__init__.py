"""Compiled kernels of the analysis: equilibrium, one step, the time loop."""
