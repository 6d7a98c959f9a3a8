"""From records of sensors on a plate: the force, the place, and the size and speed of the
sphere, with intervals.
"""
