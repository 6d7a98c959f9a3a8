"""Mesh files of other programs, read and written, and meshes of geometry."""
