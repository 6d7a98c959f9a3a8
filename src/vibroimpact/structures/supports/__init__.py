"""Supports of a plate, one kind per file."""
