"""Derived results of a Dataset."""
