"""Kernels of the level 'contact': the sliders as bodies, solved inside the element."""
