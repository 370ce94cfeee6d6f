"""Campaigns: models, motions, scales and parameters run in batches into one store on disk."""
