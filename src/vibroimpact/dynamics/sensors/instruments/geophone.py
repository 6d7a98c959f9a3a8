r"""A geophone: a coil on a spring in the field of a magnet.

Its voltage follows the velocity of the case above the natural frequency. The voltage over that
velocity is

.. math:: \frac{V}{v} = \frac{S\,s^2}{s^2 + 2 \zeta \omega_0 s + \omega_0^2}

with the sensitivity S (E. Wielandt, Seismic sensors and their calibration, in: P. Bormann, ed., New
Manual of Seismological Observatory Practice, 2002, chapter 5). It is :math:`S / \omega_0^2` times
the third derivative of the displacement behind a pair of poles.
"""

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


@dataclass(frozen=True)
class Geophone(InstrumentInCase):
    """A moving-coil geophone, whose voltage follows the velocity above its natural frequency.

    It is on the plate, too light to change its motion.

    Parameters
    ----------
    natural_frequency : float
        Of the coil on its spring [Hz], > 0.
    sensitivity : float
        Voltage over the velocity of its case, far above the natural frequency [V s/m], > 0.
    damping_ratio : float, default 0.6
        Of the coil on its spring, with its shunt [-], > 0.
    low_pass : float, optional
        Corner of a Butterworth low-pass of order two behind it [Hz], > 0: of its circuit, or in
        place of its inductance.

    Examples
    --------
    >>> geophone = Geophone(natural_frequency=10.0, sensitivity=27.6)
    >>> geophone.quantity, round(geophone.gain * geophone.sections[0][0], 9)
    ('voltage', 27.6)
    """

    name = "geophone"
    noun = "a geophone"
    properties = "natural frequency, sensitivity, damping and low-pass of a geophone"
    measures = "voltage"
    subject = "motion"

    natural_frequency: float = parameter(
        "natural frequency of the coil on its spring", "Hz", above=0
    )
    sensitivity: float = parameter(
        "voltage over velocity, far above the natural frequency", "V s/m", above=0
    )
    damping_ratio: float = parameter(
        "damping ratio of the coil, with its shunt", above=0, default=0.6
    )
    low_pass: float | None = parameter(
        "corner frequency of a second-order low-pass after it", "Hz", above=0, default=None
    )

    @property
    def quantity(self) -> Quantity:
        """What it puts out."""
        return "voltage"

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it takes."""
        return 3

    @property
    def gain(self) -> float:
        """Voltage over the third derivative of the displacement [V s^3/m].

        It is that below the natural frequency.
        """
        return self.sensitivity / self.sections[0][0]

    @property
    def sections(self) -> tuple[Section, ...]:
        """The poles of the coil on its spring, then those of the low-pass if there is one."""
        omega = 2.0 * math.pi * self.natural_frequency
        coil = (omega**2, 2.0 * self.damping_ratio * omega)
        if self.low_pass is None:
            return (coil,)
        corner = 2.0 * math.pi * self.low_pass
        return coil, (corner**2, math.sqrt(2.0) * corner)

    @property
    def steepness(self) -> float:
        """It sees the deflection itself."""
        return 0.0

    def components(self, direction: Direction) -> Direction:
        """Return the weights of the displacements along x, y and z."""
        return direction
