"""Calibration of a parameter of a contact law, or a modal damping, to measured impacts.

The impacts may be specified by another law, too.
"""
