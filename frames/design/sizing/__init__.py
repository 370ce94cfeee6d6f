"""Bearings proposed for a structure: sizes from loads, spectrum and limits."""
