"""The interface of instruments to the measuring chain, and the quantities that they measure."""

from __future__ import annotations

from typing import Literal, Protocol

from vibroimpact.dynamics.sensors.pole_pairs import Section

Quantity = Literal[
    "acceleration", "velocity", "displacement", "voltage", "strain", "pressure", "force"
]
UNITS: dict[Quantity, str] = {
    "acceleration": "m/s2",
    "velocity": "m/s",
    "displacement": "m",
    "voltage": "V",
    "strain": "m/m",
    "pressure": "Pa",
    "force": "N",
}
"""The SI unit of each quantity."""
MOTIONS: dict[Quantity, int] = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Order of the derivative of the displacement that each quantity of a point in motion is."""
Direction = tuple[float, float, float]


class Instrument(Protocol):
    r"""A transducer of the displacement or strain u that it sees.

    Its output is :math:`y = g\,s^n \prod_k \frac{k_k}{s^2 + d_k s + k_k}\,u`.
    """

    @property
    def quantity(self) -> Quantity:
        """What it puts out."""

    @property
    def order(self) -> int:
        """Order n of the derivative, from 0 to 3; 3 only with a pair of poles."""

    @property
    def gain(self) -> float:
        """The gain g, in the unit of its output over that of the derivative."""

    @property
    def sections(self) -> tuple[Section, ...]:
        """Its pairs of poles (k, d), each with a gain of one at frequency zero."""

    @property
    def steepness(self) -> float:
        """Power of the frequency by which u grows in modes of the same deflection.

        The effect of the modes left out is estimated with it.
        """

    def components(self, direction: Direction) -> Direction:
        """Return the weights in u of the three numbers that a mode has at the instrument.

        `direction`: of the instrument.
        """
