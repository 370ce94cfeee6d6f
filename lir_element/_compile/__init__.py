"""Compiled kernels: their decorator, the cache on disk, linking, progress."""
