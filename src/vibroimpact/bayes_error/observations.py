"""What may be measured of a fall, and with what uncertainty: the rows of a bound."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.bayes_error.falls import Falls
from vibroimpact.bayes_error.pulse_information import pulse_uncertainty
from vibroimpact.signals.inverse.hertz_pulse import hertz_pulse

_REFERENCE_BAND = 10e3
"""Band in which the noise is counted [Hz], whatever is heard."""

_LARGEST = 3.0  # standard deviation of a logarithm beyond which nothing is known


@dataclass(frozen=True)
class Channel:
    """A channel that measures the contact force: its band, noise and scatter.

    All values are assumptions, to be replaced by those of your sensor; the bound depends on them.

    Parameters
    ----------
    bandwidth : float, default 10e3
        Upper end of the band that it measures [Hz].
    signal_to_noise : float, default 40
        Peak of the force of the median fall over the rms of the noise in 10 kHz [dB].
    gain : float, default 0.02
        Relative standard deviation of its sensitivity.
    place : float, default 0.3
        Relative standard deviation of the amplitude if the position of the impact is not known. It
        is a choice: the amplitude of the shipped river plate varies by factors of 1.9 to 2.4
        between six positions.
    height, size, interval : float
        Relative standard deviations of the approach speed where the height is known (0.02), of the
        radius where the rock is seen (0.05), and of the time between bounces (0.002).

    Examples
    --------
    >>> import vibroimpact as vi
    >>> channel = vi.bayes_error.Channel(bandwidth=25e3, signal_to_noise=60.0)
    >>> channel.bandwidth, channel.gain, channel.place
    (25000.0, 0.02, 0.3)
    """

    bandwidth: float = 10e3
    signal_to_noise: float = 40.0
    gain: float = 0.02
    place: float = 0.3
    height: float = 0.02
    size: float = 0.05
    interval: float = 0.002


class Observation(NamedTuple):
    """A row of a bound: its name, what it means, and the quantities that are measured."""

    name: str
    meaning: str
    quantities: tuple[str, ...]


OBSERVATIONS = (
    Observation(
        "impulse",
        "the impulse of one impact alone, as from the amplitude of a slow sensor",
        ("impulse",),
    ),
    Observation(
        "contact time",
        "the duration of one contact alone, as from a normalised signal",
        ("duration",),
    ),
    Observation(
        "one impact",
        "impulse and contact time of one impact at a known position, as from two sensors",
        ("impulse", "duration"),
    ),
    Observation(
        "one impact, place unknown",
        "impulse and contact time of one impact, from one sensor at an unknown distance",
        ("far impulse", "duration"),
    ),
    Observation(
        "with the bounce",
        "impulse and contact time, and the time to the next impact",
        ("impulse", "duration", "interval"),
    ),
    Observation(
        "height known", "impulse and contact time, and the speed", ("impulse", "duration", "speed")
    ),
    Observation(
        "height known, with the bounce",
        "impulse and contact time, the speed and the time to the next impact",
        ("impulse", "duration", "speed", "interval"),
    ),
    Observation(
        "size seen",
        "impulse and contact time, and the radius, as from a camera",
        ("impulse", "duration", "radius"),
    ),
    Observation(
        "height, bounce and size",
        "impulse, contact time, speed, the time to the next impact and the radius",
        ("impulse", "duration", "speed", "interval", "radius"),
    ),
)
"""What may be measured, from little to much."""


def measurable(falls: Falls, channel: Channel) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Return the logarithms of the quantities of each fall, and the deviations of their noise.

    Parameters
    ----------
    falls : Falls
        The falls.
    channel : Channel
        What hears them.
    """
    # a pulse of unit impulse and duration is largest in its middle
    unit_peak = float(hertz_pulse(np.array([0.5]))[0])
    median_peak = float(np.median(falls.impulse / falls.duration)) * unit_peak
    noise_rms = median_peak / 10.0 ** (channel.signal_to_noise / 20.0)
    noise_density = noise_rms**2 / _REFERENCE_BAND
    impulse_deviation, duration_deviation = np.minimum(
        pulse_uncertainty(falls.impulse, falls.duration, channel.bandwidth, noise_density), _LARGEST
    )
    ones = np.ones(len(falls))
    values = {
        "impulse": falls.impulse,
        "far impulse": falls.impulse,
        "duration": falls.duration,
        "interval": falls.interval,
        "speed": falls.speed,
        "radius": falls.radius,
    }
    noise = {
        "impulse": np.hypot(impulse_deviation, channel.gain),
        "far impulse": np.sqrt(impulse_deviation**2 + channel.gain**2 + channel.place**2),
        "duration": duration_deviation,
        "interval": channel.interval * ones,
        "speed": channel.height * ones,
        "radius": channel.size * ones,
    }
    logarithms = {name: np.log(quantity) for name, quantity in values.items()}
    return logarithms, noise
