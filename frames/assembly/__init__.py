"""From the described model to matrices, checked."""
