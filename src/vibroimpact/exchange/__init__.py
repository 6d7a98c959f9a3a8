"""Mesh files of other programs: read, written, and made from geometry."""
