r"""The highest frequency of modes that an impact needs, before any mode is computed.

Modes of unit mass have shapes :math:`\chi` at a point, of which
:math:`\sum \chi^2` a unit of angular frequency is :math:`2/\pi` of the real part of the mobility
there. In the middle of a thin plate this is the constant :math:`1/(4 \pi \sqrt{D \rho h})`
(L. Cremer, M. Heckl and B. A. T. Petersson, Structure-Borne Sound, Springer, 2005), and more at a
free edge, where the waves are reflected in phase. In a solid it grows with :math:`\omega^2`.

A contact of duration T and tangent stiffness k has a force like :math:`\sin^{3/2}(\pi t / T)`. What
the modes beyond :math:`\omega` change the force is their inertia, or, where no static solution
carries their compliance, all of that: as in `dynamics.truncation`, of the octave below
:math:`\omega`,

.. math::

    \varepsilon = k \sum \frac{\chi^2}{\omega^2} \left(\frac{\pi}{T \omega}\right)^2.

As it follows the second derivative of the force, the part of frequency f in the spectrum of the
force is off by :math:`\varepsilon\, (2 f T)^2`. The signal of a sensor is off by this, and lacks
what lies beyond the modes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.special import rgamma

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError

_STEPS_PER_DECADE = 10
"""Frequencies are of the series R10 of preferred numbers (ISO 3).

Drops that differ little then have the same modes, which are computed once.
"""
_LOWEST = 10.0  # Hz
_HIGHEST = 100e6  # Hz
_MARGIN = 4.0
"""By which the estimate of the force has to be below the accuracy.

In a plate that takes most of the energy the force has faster parts than that of rigid bodies, and
errors of 2.5 times the estimate were found (benchmarks/bench_auto_modes.py).
"""
_PULSE_ORDER = 2.5  # the force is a sine to this power less one
# frequencies times the duration of the contact for which the spectrum of the force is taken
_SPECTRUM = np.linspace(0.05, 60.0, 2400)


class Impulse(NamedTuple):
    """What of a contact decides which modes it excites.

    Attributes
    ----------
    duration : float
        Duration of the contact [s].
    stiffness : float
        Tangent stiffness of the contact at the largest force [N/m].
    """

    duration: float
    stiffness: float


class ModalDensity(NamedTuple):
    r"""The squares of modes of unit mass at the contact, a unit of angular frequency.

    Attributes
    ----------
    bending : float
        Of bending waves, which does not depend on the frequency [s/(rad kg)].
    volume : float
        Of waves in the volume, over the square of the angular frequency [s^3/(rad^3 kg)].
    """

    bending: float
    volume: float


class Band(NamedTuple):
    """What a sensor sees of a velocity.

    Attributes
    ----------
    power : float
        Power of the frequency by which it weights the velocity: 1 of an acceleration.
    highest : float
        Highest frequency that it passes [Hz]; infinite without a filter.
    """

    power: float
    highest: float


def enough_frequency(
    impulse: Impulse,
    density: ModalDensity,
    bands: Iterable[Band],
    accuracy: float,
    *,
    is_carried: bool = True,
) -> float:
    """Return the frequency up to which modes give an impact to an accuracy [Hz].

    Parameters
    ----------
    impulse : Impulse
        The contact.
    density : ModalDensity
        Modes of the body at the contact.
    bands : iterable of Band
        The sensors on the body.
    accuracy : float
        Relative error that is allowed, of the largest force, and of the signal of each sensor over
        its rms value.
    is_carried : bool, default True
        Whether a static solution carries the compliance of the modes left out.

    Returns
    -------
    float
        A number of the series R10.

    Raises
    ------
    InputError
        If the modes would have to reach beyond 100 MHz.

    Examples
    --------
    A steel ball of 20 mm falls from 0.5 m on aluminium of 6 mm, without and with an accelerometer
    that is sampled at 200 kHz:

    >>> impulse = Impulse(duration=73e-6, stiffness=1.01e8)
    >>> plate = ModalDensity(bending=1 / (4 * math.pi * math.sqrt(1420 * 16.2)), volume=0.0)
    >>> [
    ...     enough_frequency(impulse, plate, bands, 0.01)
    ...     for bands in ([], [Band(power=1.0, highest=112e3)])
    ... ]
    [79000.0, 130000.0]
    """
    for frequency in preferred_frequencies():
        if frequency * impulse.duration < 1.0:  # below it the estimate is not valid
            continue
        force_error = _force_error(impulse, density, frequency, is_carried)
        if _MARGIN * force_error > accuracy:
            continue
        errors = [_signal_error(band, impulse, frequency, force_error) for band in bands]
        if max(errors, default=0.0) <= accuracy:
            return frequency
    raise InputError(
        f"an accuracy of {100.0 * accuracy:g} % needs modes beyond {_HIGHEST / 1e6:g} MHz"
    )


def preferred_frequencies() -> list[float]:
    """Return the frequencies of which one is chosen [Hz], ascending.

    Examples
    --------
    >>> preferred_frequencies()[:11]
    [10.0, 13.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0, 63.0, 79.0, 100.0]
    """
    decades = math.log10(_HIGHEST / _LOWEST)
    exponents = np.arange(round(_STEPS_PER_DECADE * decades) + 1) / _STEPS_PER_DECADE
    return [float(f"{frequency:.2g}") for frequency in _LOWEST * 10.0**exponents]


def _force_error(
    impulse: Impulse, density: ModalDensity, frequency: float, is_carried: bool
) -> float:
    """Return the estimated error of the largest force by the modes beyond a frequency.

    It is that of the octave below it: the integrals of the density over omega^4, or over omega^2.
    """
    omega = 2.0 * math.pi * frequency
    if not is_carried:
        return impulse.stiffness * (density.bending / omega + 0.5 * density.volume * omega)
    inertia = density.bending * 7.0 / (3.0 * omega**3) + density.volume / omega
    return impulse.stiffness * inertia * (math.pi / impulse.duration) ** 2


def _signal_error(band: Band, impulse: Impulse, frequency: float, force_error: float) -> float:
    """Return the estimated error of a signal over its rms value, with modes up to a frequency."""
    times_duration = _SPECTRUM
    power = (_force_spectrum() * times_duration**band.power) ** 2
    power[times_duration > band.highest * impulse.duration] = 0.0
    has_modes = times_duration <= frequency * impulse.duration
    error = np.where(has_modes, np.minimum(force_error * (2.0 * times_duration) ** 2, 1.0), 1.0)
    total = power.sum()
    if total == 0.0:  # slower than any change of the force
        return 0.0
    return float(np.sqrt((error**2 * power).sum() / total))


@cache
def _force_spectrum() -> Floats:
    r"""Return the magnitude of the spectrum of the force, over that at zero, times a constant.

    That of :math:`\sin^{n - 1}` over half a period is the reciprocal of a beta function (Gradshteyn
    and Ryzhik, 3.631).
    """
    half_order = 0.5 * (_PULSE_ORDER + 1.0)
    spectrum = rgamma(half_order + _SPECTRUM) * rgamma(half_order - _SPECTRUM)
    return np.asarray(np.abs(spectrum))
