"""Elastic bodies of a case: meshes, modes, and their coupling to the contact law."""
