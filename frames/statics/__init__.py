"""Analyses before a motion: gravity, natural modes, checks of the model."""
