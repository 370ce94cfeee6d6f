"""Checks of the bearing itself."""
