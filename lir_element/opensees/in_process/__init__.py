"""The in-process coupling: compiled callbacks in the process of the model."""
