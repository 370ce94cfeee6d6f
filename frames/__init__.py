"""Structures on seismic isolation bearings."""
