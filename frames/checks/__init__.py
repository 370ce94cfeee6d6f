"""Design checks with their calculation, property bounds, equivalent-linear analysis by code."""
