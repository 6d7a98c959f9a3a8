"""Structures: meshes, elasticity, supports, modes, reduction and damping; they know nothing of contact."""
