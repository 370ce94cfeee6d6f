"""Motions of the ground."""
