"""Superstructures imported from a model that OpenSeesPy holds."""
