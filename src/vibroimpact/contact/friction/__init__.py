"""Friction laws: the force along the plate from the normal force and the slip of the
contact point.
"""
