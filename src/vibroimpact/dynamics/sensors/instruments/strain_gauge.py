"""A strain gauge on a face of the plate, at a point and along a direction in it."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.contact.parameters import parameter
from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.instruments.proportional import Proportional


@dataclass(frozen=True)
class StrainGauge(Proportional):
    """A strain gauge on a face of the plate, along a direction in it.

    It is short compared with the bending waves, and has neither mass nor stiffness.

    Parameters
    ----------
    sensitivity : float, optional
        Voltage of its bridge over the strain [V], > 0; without it the samples are the strain.

    Examples
    --------
    >>> StrainGauge().quantity, StrainGauge().components((0.0, 1.0, 0.0))
    ('strain', (0.0, 1.0, 0.0))
    """

    name = "strain-gauge"
    noun = "a strain gauge"
    properties = "sensitivity of a strain gauge"
    measures = "strain"
    subject = "strain"

    sensitivity: float | None = parameter(
        "voltage over strain; its output is then a voltage", "V", above=0, default=None
    )

    @property
    def quantity(self) -> Quantity:
        """What it puts out: strain, or voltage if it has a sensitivity."""
        return "strain" if self.sensitivity is None else "voltage"

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the strains along x and y and of the shear.

        They give the strain along a direction in the plane.
        """
        x, y, _ = direction
        return x * x, y * y, x * y
