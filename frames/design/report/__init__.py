"""Files of a run, and the report, one HTML page, which computes nothing."""
