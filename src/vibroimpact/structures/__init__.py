"""Structures: meshes, elasticity, supports, modes, reduction and damping; independent of
contact.
"""
