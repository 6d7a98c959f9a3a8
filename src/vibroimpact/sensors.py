"""Instruments for the vibration of a plate, for forces of supports and sound, by their names.

>>> import vibroimpact as vi
>>> vi.sensors.Geophone.__name__
'Geophone'
"""

from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.electronics import Amplifier, Converter
from vibroimpact.dynamics.sensors.instruments.force_sensor import ForceSensor
from vibroimpact.dynamics.sensors.instruments.geophone import Geophone
from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.instruments.strain_gauge import StrainGauge
from vibroimpact.dynamics.sensors.recording import Signal

__all__ = [
    "Accelerometer",
    "Amplifier",
    "Converter",
    "ForceSensor",
    "Geophone",
    "Microphone",
    "Sensor",
    "Signal",
    "StrainGauge",
]
