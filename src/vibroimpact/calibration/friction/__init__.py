"""Calibration of the friction law: parameters that are fitted together to measured
oblique impacts.
"""
