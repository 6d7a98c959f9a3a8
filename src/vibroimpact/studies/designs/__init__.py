"""The study designs, one per file."""
