"""Meshes of bodies, and the stiffness and mass of their finite elements."""
