"""A strain gauge on a face of the plate, at a point and along a direction in it."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.pole_pairs import Section


@dataclass(frozen=True)
class StrainGauge:
    """A strain gauge, shorter than the waves that it reads and without mass and stiffness.

    Parameters
    ----------
    sensitivity : float, optional
        Voltage of its bridge over the strain [V], > 0; without it the samples are the strain.

    Examples
    --------
    >>> StrainGauge().quantity, StrainGauge().components((0.0, 1.0, 0.0))
    ('strain', (0.0, 1.0, 0.0))
    """

    sensitivity: float | None = None

    @property
    def quantity(self) -> Quantity:
        """What it puts out: strain, or voltage if it has a sensitivity."""
        return "strain" if self.sensitivity is None else "voltage"

    @property
    def order(self) -> int:
        """Order of the derivative of the strain that it takes."""
        return 0

    @property
    def gain(self) -> float:
        """Output over strain, [V] or 1."""
        return 1.0 if self.sensitivity is None else self.sensitivity

    @property
    def sections(self) -> tuple[Section, ...]:
        """No poles."""
        return ()

    @property
    def steepness(self) -> float:
        """Growth of the strain of a mode of given deflection with its frequency: that of a curvature."""
        return 1.0

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the strains along x and y and of the shear in the strain along a direction in the plane."""
        x, y, _ = direction
        return x * x, y * y, x * y
