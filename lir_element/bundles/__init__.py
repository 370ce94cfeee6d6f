"""Arrays that kernels take together."""
