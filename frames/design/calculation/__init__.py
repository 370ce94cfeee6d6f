"""Calculations and checks as values: the formula that is shown is the one that is evaluated."""
