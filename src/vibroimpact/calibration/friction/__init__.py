"""Calibration of parameters of the friction law, together, to measured oblique impacts."""
