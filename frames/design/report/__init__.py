"""What a run leaves: its files, and the report, one HTML page, which computes nothing."""
