"""Compiled kernels: pure functions on records and arrays; what all levels share."""
