"""Up to which frequency a force excites a plate.

It is where its spectrum has fallen by 20 dB, since beyond are its zeros.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.test_analysis.simulated import ForceImpulses

_FALLEN = 0.1
"""Part of the force's spectrum at low frequencies below which it excites nothing."""

_FREQUENCIES = 2001
"""Number of frequencies at which a spectrum is computed."""

_ROOM = np.sqrt(2.0)
"""Least ratio of the ends of a band that is left: half an octave."""


def force_ends(force: ForceImpulses, highest: float) -> float | None:
    """Return the lowest frequency at which the spectrum of a force has fallen by 20 dB [Hz].

    None if there is none up to the highest frequency [Hz]. The powers of its pulses are added:
    zeros that two pulses have by their distance are narrow, and there are as many below as above.
    """
    frequency = np.linspace(0.0, highest, _FREQUENCIES)
    power = np.zeros(len(frequency))
    for begin, end in force.contacts:
        inside = (force.time >= begin) & (force.time <= end)
        power += _power(force.time[inside] - begin, force.impulse[inside], frequency)
    # at 0 Hz the spectrum of a pulse of one sign is largest: its impulse
    weak = frequency[power < _FALLEN**2 * power[0]]
    return float(weak[0]) if len(weak) else None


def _power(time: Floats, impulse: Floats, frequency: Floats) -> Floats:
    """Return the squared magnitude of the spectrum of impulses [N² s²], (frequencies,)."""
    phases = np.exp(-2j * np.pi * frequency[:, None] * time)
    return np.asarray(np.abs(phases @ impulse) ** 2)


def is_excited(band: tuple[float, float], ends: float | None) -> bool:
    """Return whether a force whose spectrum ends at a frequency leaves half an octave of a band."""
    return ends is None or ends >= _ROOM * band[0]


class Excited(NamedTuple):
    """The band of frequencies that is compared, and that in which modes are sought [Hz].

    `ends` is where the spectrum of the force has fallen by 20 dB [Hz], as of `force_ends`.
    """

    compared: tuple[float, float]
    sought: tuple[float, float]
    ends: float | None
