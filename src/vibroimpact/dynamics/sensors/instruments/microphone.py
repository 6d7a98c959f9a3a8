"""A microphone: the sound pressure that the plate radiates to a point, or its voltage."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.dynamics.air import AIR_DENSITY
from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.pole_pairs import Section


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
        return self.air_density * (1.0 if self.sensitivity is None else self.sensitivity)

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
