"""The seismic hazard a structure is designed for: spectra of codes, and sets of ground motions."""
