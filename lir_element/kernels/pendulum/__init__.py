"""Kernels of the level 'pendulum': the bearing as a string between sphere centres."""
