"""Calibration: the parameter of a contact law, or a modal damping, that matches measured
or specified impacts.
"""
