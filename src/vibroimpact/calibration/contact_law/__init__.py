"""The calibration of a parameter of a contact law, and what is reported of it."""
