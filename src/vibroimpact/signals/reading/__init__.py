"""Records from files of several formats."""
