"""Kernels of the level 'rigid_body': the sliders as bodies in time."""
