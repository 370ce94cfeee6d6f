"""Many time histories at once: cases, runs, one Dataset."""
