"""Time history analysis: options, the run, its outcome, the level of each bearing."""
