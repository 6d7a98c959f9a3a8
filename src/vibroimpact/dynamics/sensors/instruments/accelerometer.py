"""An accelerometer: a mass on a spring, with a range, noise and steps."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vibroimpact.contact.parameters import parameter
from vibroimpact.dynamics.sensors.instruments.instrument import (
    Direction,
    InstrumentInCase,
    Quantity,
)
from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section
from vibroimpact.units.display import STANDARD_GRAVITY


@dataclass(frozen=True)
class Accelerometer(InstrumentInCase):
    """An accelerometer with mounted resonance, measuring range, noise and resolution.

    Parameters
    ----------
    resonance : float, optional
        Its mounted resonance [Hz], > 0; without one it follows its base exactly.
    damping_ratio : float, default 0.02
        Of that resonance [-].
    range : float, optional
        Largest magnitude of its output [m/s^2], at which it is clipped before the anti-alias
        filter.
    noise : float, default 0
        Standard deviation of white noise in its samples [m/s^2]; the same in every run of one seed.
    resolution : float, optional
        Step of its readings [m/s^2].
    seed : int or tuple of int, default 0
        Of the noise; sensors of different names have noise of their own.
    sensitivity : float, optional
        Its voltage over the acceleration [V s^2/m]; without it the samples are the acceleration.

    Examples
    --------
    >>> Accelerometer(resonance=30e3).quantity, Accelerometer(sensitivity=0.01).quantity
    ('acceleration', 'voltage')
    """

    name = "accelerometer"
    noun = "an accelerometer"
    properties = "resonance, range, noise, resolution and sensitivity of an accelerometer"
    measures = "acceleration"
    subject = "motion"

    resonance: float | None = parameter("mounted resonance frequency", "Hz", above=0, default=None)
    damping_ratio: float = parameter("damping ratio of the resonance", above=0, default=0.02)
    range: float | None = parameter(
        "measuring range: largest magnitude of its output", "m/s^2", above=0, default=None
    )
    noise: float = parameter(
        "standard deviation of the noise in its samples", "m/s^2", at_least=0, default=0.0
    )
    resolution: float | None = parameter(
        "resolution: step of its output", "m/s^2", above=0, default=None
    )
    seed: int | tuple[int, ...] = parameter("of the noise", at_least=0, default=0)
    sensitivity: float | None = parameter(
        "voltage over acceleration; its output is then a voltage",
        "V s^2/m",
        above=0,
        default=None,
    )

    def stated_properties(self) -> list[str]:
        """Return its properties in words, with its range in standard gravity as well."""
        properties = []
        if self.resonance is not None:
            damping = f"with a damping ratio of {self.damping_ratio:g}"
            properties.append(f"resonance {self.resonance:g} Hz {damping}")
        if self.range is not None:
            in_gravity = f"{self.range / STANDARD_GRAVITY:.4g} times standard gravity"
            properties.append(f"range {self.range:g} m/s2, {in_gravity}")
        if self.noise:
            properties.append(f"noise {self.noise:g} m/s2")
        if self.resolution is not None:
            properties.append(f"resolution {self.resolution:g} m/s2")
        if self.sensitivity is not None:
            properties.append(f"sensitivity {self.sensitivity:g} V s2/m")
        return properties

    @property
    def quantity(self) -> Quantity:
        """What it puts out: acceleration, or voltage if it has a sensitivity."""
        return "acceleration" if self.sensitivity is None else "voltage"

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it takes."""
        return 2

    @property
    def gain(self) -> float:
        """Output over acceleration, [V s^2/m] or 1."""
        return 1.0 if self.sensitivity is None else self.sensitivity

    @property
    def sections(self) -> tuple[Section, ...]:
        """The poles of the mounted resonance, if it has one."""
        if self.resonance is None:
            return ()
        omega = 2.0 * math.pi * self.resonance
        return ((omega**2, 2.0 * self.damping_ratio * omega),)

    @property
    def steepness(self) -> float:
        """It sees the deflection itself."""
        return 0.0

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the displacements along x, y and z."""
        return direction
