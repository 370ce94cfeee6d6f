"""When the LIR-DCFP does better than plain bearings: campaigns of histories, and their pages."""
