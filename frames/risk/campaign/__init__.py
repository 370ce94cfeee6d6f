"""Campaigns: models, motions, scales and parameters run in batches into a results database."""
