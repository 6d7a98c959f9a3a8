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

from vibroimpact.dynamics.sensors.instruments.instrument import Direction, Quantity
from vibroimpact.dynamics.sensors.pole_pairs import Section


@dataclass(frozen=True)
class Geophone:
    """A geophone on the plate, too light to change its motion.

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

    natural_frequency: float
    sensitivity: float
    damping_ratio: float = 0.6
    low_pass: float | None = None

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
