"""Gravity, modes, time histories."""
