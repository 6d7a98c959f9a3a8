"""The study designs, one file each."""
