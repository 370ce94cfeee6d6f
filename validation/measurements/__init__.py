"""What measures, and makes no claim: speed, cost, robustness."""
