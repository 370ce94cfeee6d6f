"""Checks of time histories."""
