"""Recorded part of a time history, and its Dataset."""
