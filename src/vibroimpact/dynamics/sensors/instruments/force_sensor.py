"""A force sensor between the plate and one of its supports."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.parameters import parameter
from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.instruments.proportional import Proportional


@dataclass(frozen=True)
class ForceSensor(Proportional):
    """A force sensor between the plate and the support at its position.

    It has neither mass nor compliance of its own.

    Parameters
    ----------
    sensitivity : float, optional
        Voltage over the force [V/N], > 0; without it the samples are the force.

    Examples
    --------
    >>> ForceSensor().quantity, ForceSensor(sensitivity=0.01).quantity
    ('force', 'voltage')
    """

    name = "force"
    noun = "a force sensor"
    properties = "sensitivity of a force sensor between the plate and the support at the position"
    measures = "force"
    subject = "support"

    sensitivity: float | None = parameter(
        "voltage over force; its output is then a voltage", "V/N", above=0, default=None
    )

    @property
    def quantity(self) -> Quantity:
        """What it puts out: the force of the support, or voltage if it has a sensitivity."""
        return "force" if self.sensitivity is None else "voltage"

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the forces along x, y and z."""
        return direction
