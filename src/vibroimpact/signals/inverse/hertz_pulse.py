r"""The force of an elastic Hertzian impact, and the sphere behind its impulse and duration.

A sphere of mass m that hits at the speed v and leaves with the restitution e gives the impulse
:math:`J = m v (1 + e)` in the time (Johnson, Contact Mechanics, 1985, eq. 11.24)

.. math:: T = 2.87\left(\frac{m^2}{E^{*2} R\,v}\right)^{1/5}

With the density and the modulus known, the two give R and v.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bodies.ball import ball_volume

_NODES = 48
_TIME = 2.868
"""Duration over (m^2 / (E*^2 R v))^(1/5)."""


def hertz_pulse(time: Floats) -> Floats:
    r"""Return the force of an elastic Hertzian impact of unit impulse and unit duration.

    With :math:`x = (\delta/\delta_{max})^{5/2}` the time since first touch is :math:`t/T = \frac12
    I_x(2/5, 1/2)` up to the deepest point (Johnson, Contact Mechanics, 1985, eq. 11.23), and the
    force is proportional to :math:`x^{3/5}`.

    Parameters
    ----------
    time : array
        Time since first touch over the duration [-].

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 2001)
    >>> (
    ...     round(float(np.trapezoid(hertz_pulse(t), t)), 6),
    ...     round(float(hertz_pulse(np.array([0.5]))[0]), 4),
    ... )
    (1.0, 1.8395)
    """
    from scipy.special import beta, betaincinv

    inside = (time > 0.0) & (time < 1.0)
    # the second half is the first one in reverse
    to_nearest_end = np.where(inside, 1.0 - np.abs(2.0 * time - 1.0), 0.0)
    x = betaincinv(0.4, 0.5, to_nearest_end)
    return np.asarray(np.where(inside, 0.5 * beta(0.4, 0.5) * x**0.6, 0.0))


def hertz_rise(part: Floats) -> tuple[Floats, Floats]:
    """Return the time at which a Hertzian force has risen to a part of its peak, and its slope.

    The contact is elastic, and the time is over its duration. The slope is the derivative of the
    time by the part.

    Parameters
    ----------
    part : array
        Force over the largest force, in (0, 1).

    Examples
    --------
    >>> time, _ = hertz_rise(np.array([0.5]))
    >>> top = hertz_pulse(np.array([0.5]))
    >>> round(float(time[0]), 4), round(float((hertz_pulse(time) / top)[0]), 6)
    (0.2253, 0.5)
    """
    from scipy.special import beta, betainc

    # as `hertz_pulse` has it
    x = part ** (5.0 / 3.0)
    time = 0.5 * betainc(0.4, 0.5, x)
    slope = 5.0 / 6.0 / beta(0.4, 0.5) / (np.cbrt(part) * np.sqrt(1.0 - x))
    return np.asarray(time), np.asarray(slope)


def hertz_impulses(duration: float) -> tuple[Floats, Floats]:
    r"""Return times since first touch [s] and impulses that stand for a Hertzian pulse.

    The sum of the impulses is one.

    Parameters
    ----------
    duration : float
        Duration of the contact [s].

    Examples
    --------
    >>> times, impulses = hertz_impulses(200e-6)
    >>> round(float(impulses.sum()), 12), round(1e6 * float(impulses @ times), 3)
    (1.0, 100.0)
    """
    times, impulses = _unit_impulses()
    return duration * times, impulses


@cache
def _unit_impulses() -> tuple[Floats, Floats]:
    """Return times and impulses of a pulse of unit duration."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    times = 0.5 * (1.0 + nodes)
    impulses = weights * hertz_pulse(times)
    return times, impulses / impulses.sum()


def sphere_of_pulse(
    impulse: float, duration: float, density: float, modulus: float, restitution: float
) -> tuple[float, float]:
    """Return the radius [m] and the speed [m/s] of the sphere behind a Hertzian pulse.

    Parameters
    ----------
    impulse : float
        Impulse of the force [N s].
    duration : float
        Duration of the contact [s].
    density : float
        Density of the sphere [kg/m^3].
    modulus : float
        Effective modulus E* of the contact [Pa].
    restitution : float
        Separation speed over approach speed [-].

    Examples
    --------
    >>> mass = 4.0 / 3.0 * np.pi * 0.02**3 * 2600.0
    >>> duration = 2.868 * (mass**2 / (20e9**2 * 0.02 * 3.0)) ** 0.2
    >>> [
    ...     round(float(value), 6)
    ...     for value in sphere_of_pulse(mass * 3.0 * 1.6, duration, 2600.0, 20e9, 0.6)
    ... ]
    [0.02, 3.0]
    """
    # of a sphere of unit radius; J = m v (1 + e) eliminates the speed from the duration
    unit_mass = ball_volume(1.0) * density
    eighth_power = (
        (duration / _TIME) ** 5 * modulus**2 * impulse / ((1.0 + restitution) * unit_mass**3)
    )
    radius = eighth_power**0.125
    speed = impulse / ((1.0 + restitution) * unit_mass * radius**3)
    return radius, speed
