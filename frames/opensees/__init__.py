"""Superstructures taken over from a model that OpenSeesPy holds."""
