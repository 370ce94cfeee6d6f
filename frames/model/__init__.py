"""The structure above the bearings, as the engineer describes it."""
