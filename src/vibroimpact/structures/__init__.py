"""Structures: meshes, elasticity, supports, modes, reduction and damping, without contact."""
