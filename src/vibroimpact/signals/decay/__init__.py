"""Modal frequencies and damping ratios from the decay of records."""
