"""Compiled kernels: pure functions on records and arrays; the common part of all levels."""
