"""Compiled kernels of the plug-in: what OpenSees calls, and what it calls of ours."""
