"""An instrument whose output follows what it sees in proportion, at all frequencies."""

from __future__ import annotations

from dataclasses import dataclass

from vibroimpact.dynamics.sensors.instruments.instrument import InstrumentInCase
from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section


@dataclass(frozen=True)
class Proportional(InstrumentInCase):
    """Instrument without poles, of what grows with the curvature of the plate.

    It puts out voltage if it has a sensitivity.
    """

    sensitivity: float | None = None

    @property
    def order(self) -> int:
        """Order of the derivative that it takes."""
        return 0

    @property
    def gain(self) -> float:
        """Output over what it sees: the sensitivity, or 1."""
        return 1.0 if self.sensitivity is None else self.sensitivity

    @property
    def sections(self) -> tuple[Section, ...]:
        """No poles."""
        return ()

    @property
    def steepness(self) -> float:
        """Power of the frequency by which a curvature grows in modes of the same deflection."""
        return 1.0
