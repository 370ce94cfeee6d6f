"""What stands on the bearings, as the engineer describes it."""
