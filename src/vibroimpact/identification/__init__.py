"""From records of sensors on a plate: the force, its place, and the sphere, with intervals.

Of the sphere it is the size and the speed.
"""
