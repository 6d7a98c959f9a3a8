"""A force sensor between the plate and one of its supports."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.pole_pairs import Section


@dataclass(frozen=True)
class ForceSensor:
    """A force sensor between the plate and a support, without mass and as stiff as the support is taken to be.

    Parameters
    ----------
    sensitivity : float, optional
        Voltage over the force [V/N], > 0; without it the samples are the force.

    Examples
    --------
    >>> ForceSensor().quantity, ForceSensor(sensitivity=0.01).quantity
    ('force', 'voltage')
    """

    sensitivity: float | None = None

    @property
    def quantity(self) -> Quantity:
        """What it puts out: the force of the support on the plate, or voltage if it has a sensitivity."""
        return "force" if self.sensitivity is None else "voltage"

    @property
    def order(self) -> int:
        """Order of the derivative of the force that it takes."""
        return 0

    @property
    def gain(self) -> float:
        """Output over force, [V/N] or 1."""
        return 1.0 if self.sensitivity is None else self.sensitivity

    @property
    def sections(self) -> tuple[Section, ...]:
        """No poles."""
        return ()

    @property
    def steepness(self) -> float:
        """Growth of the force of a mode of given deflection with its frequency, as that of a curvature."""
        return 1.0

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the forces along x, y and z."""
        return direction
