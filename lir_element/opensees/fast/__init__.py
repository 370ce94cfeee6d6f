"""The fast route: compiled callbacks in the process of the model."""
