"""A microphone: the sound pressure that the plate radiates to a point, or its voltage."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.parameters import parameter
from vibroimpact.dynamics.fluids.air import AIR_DENSITY, SPEED_OF_SOUND
from vibroimpact.dynamics.sensors.instruments.instrument import (
    Direction,
    Instrument,
    InstrumentInCase,
    Quantity,
    Subject,
)
from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section

# m: the paths of sound to a closer point would take long to integrate, and no microphone is as
# small
_NEAREST = 1e-3


@dataclass(frozen=True)
class Microphone:
    """A microphone in front of a face of the plate, small compared with the wavelengths.

    Its place is part of the modes of the plate, as the paths of sound to it (`ModalBasis.sounds`).

    Parameters
    ----------
    sensitivity : float, optional
        Voltage over the sound pressure [V/Pa], > 0; without it the samples are the pressure.
    air_density : float, default 1.2
        Density of the air [kg/m^3], > 0.

    Examples
    --------
    >>> Microphone().quantity, Microphone(sensitivity=0.05).gain
    ('pressure', 0.06)
    """

    sensitivity: float | None = None
    air_density: float = AIR_DENSITY

    @property
    def subject(self) -> Subject:
        """It hears the plate."""
        return "sound"

    @property
    def quantity(self) -> Quantity:
        """What it puts out: sound pressure, or voltage if it has a sensitivity."""
        return "pressure" if self.sensitivity is None else "voltage"

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it takes."""
        return 2

    @property
    def gain(self) -> float:
        """Output over the integral of the acceleration over the face by its distance.

        It is in V s^2/m^2 or kg/m^3.
        """
        if self.sensitivity is None:
            return self.air_density
        return self.air_density * self.sensitivity

    @property
    def sections(self) -> tuple[Section, ...]:
        """No poles."""
        return ()

    @property
    def steepness(self) -> float:
        """It sees the deflection itself."""
        return 0.0

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the displacements along x, y and z."""
        return direction


@dataclass(frozen=True)
class MicrophoneInCase(InstrumentInCase):
    """A microphone in the air beyond a face of the plate.

    A case states its place as well, from which the paths of sound are computed.
    """

    name = "microphone"
    noun = "a microphone"
    properties = "distance and sensitivity of a microphone, and its air"
    measures = "pressure"
    subject = "sound"

    distance: float = parameter("distance from the plane of the face", "m", at_least=_NEAREST)
    sensitivity: float | None = parameter(
        "voltage over sound pressure; its output is then a voltage", "V/Pa", above=0, default=None
    )
    air_density: float | None = parameter(
        "density of the air; by default that of `drop.air`, or that at 20 C",
        "kg/m^3",
        above=0,
        default=None,
    )
    speed_of_sound: float = parameter(
        "speed of sound in the air; by default that at 20 C",
        "m/s",
        above=0,
        default=SPEED_OF_SOUND,
    )

    def instrument(self) -> Instrument:
        """Return the microphone, in air at 20 C unless another density is given."""
        return Microphone(self.sensitivity, self.air_density or AIR_DENSITY)
