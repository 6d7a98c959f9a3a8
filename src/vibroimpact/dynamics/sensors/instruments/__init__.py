"""Instruments on the plate, one a file: what of the plate each sees, and the linear
system and the gain behind it.
"""
