"""Supports: how a plate is held, one kind a file."""
