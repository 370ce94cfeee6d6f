"""Fragility, risk and sensitivity from many time histories."""
