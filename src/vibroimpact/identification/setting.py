"""What the records change with the set-up: the plate and its sensors as they differ from a case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.place_responses import responses_at
from vibroimpact.identification.plate import Place, Plate, compliances_of, shapes_of
from vibroimpact.identification.setup import Setup

STEPS = np.array([1e-4, 1e-4, 1e-5, 1e-5, 1e-3, 1e-3])
"""Steps of derivatives in the numbers of a set-up.

Those of thickness, modulus [-], and of each sensor x, y [m], sensitivity and resonance [-].
"""
OF_PLATE = 2
"""Number of those of the plate, which come first."""
_GAIN = 4
"""Which of them is the sensitivity, in which the records are linear."""


@dataclass(frozen=True)
class Setting:
    """A set-up that was found, with its errors.

    Parameters
    ----------
    plate : Plate
        The plate as the case states it.
    numbers : array, shape (2 + 4 S,)
        How the set-up differs from it: the numbers of a `Setup`.
    errors : array, shape (2 + 4 S, u)
        Square root of their covariance.
    """

    plate: Plate
    numbers: Floats
    errors: Floats

    @property
    def found(self) -> Setup:
        """The set-up."""
        return Setup.of(self.numbers)

    @property
    def deviations(self) -> Floats:
        """Standard deviations of its numbers, (2 + 4 S,)."""
        return np.asarray(np.sqrt((self.errors**2).sum(axis=1)))


def setup_slopes(
    plate: Plate,
    here: Plate,
    numbers: Floats,
    names: Sequence[str],
    place: Place,
    signals: Callable[[Floats], Floats],
) -> Floats:
    """Return derivatives of the records of a force in the numbers of a set-up.

    They are (2 + 4 S, S, samples), and zero for numbers that are certain.

    Parameters
    ----------
    plate : Plate
        The plate as the case states it.
    here : Plate
        The plate in the set-up.
    numbers : array, shape (2 + 4 S,)
        The numbers of the set-up.
    names : sequence of str
        Names of the S sensors.
    place : tuple of two floats
        Where the force acts [m].
    signals : callable
        Takes the responses of the sensors to a unit impulse at the place, (S, points), and returns
        the records (S, samples).
    """
    sensors = len(names)
    deviations = plate.errors.deviations(sensors)
    gains = 1.0 + Setup.of(numbers).gain[:, None]
    here_signals = signals(_responses_near(here, here, names, place))
    slopes = np.zeros((len(deviations), *here_signals.shape))
    for number, step in enumerate(STEPS):
        which = numbers_of(number, sensors)
        if not deviations[which].any():
            continue
        if number == _GAIN:
            slope = here_signals
        else:
            other = plate.under(Setup.of(numbers + step * which), names)
            other_signals = signals(_responses_near(other, here, names, place))
            slope = gains * (other_signals - here_signals) / step
        if number < OF_PLATE:
            slopes[which] = slope
        else:  # a sensor of its own place, gain and resonance alone
            slopes[which] = np.eye(sensors)[:, :, None] * slope
    return slopes


def _responses_near(other: Plate, here: Plate, names: Sequence[str], place: Place) -> Floats:
    """Return responses to a unit impulse on a plate in a set-up that differs little from `here`.

    They are (S, points), by its shapes exactly, and by derivatives in the frequencies.
    """
    touched = other.at(place)
    shapes = shapes_of(touched)
    compliances = compliances_of(touched, names)
    sensors = other.sensors(names)
    if sensors != here.sensors(names):  # another resonance
        return responses_at(other.problem, sensors, other.window, shapes, compliances)
    amplitudes = shapes[:, None] * other.seen(names)
    unit = here.unit(names)
    responses: Floats = (
        np.einsum("is,isp->sp", amplitudes, unit.values) + compliances[:, None] * unit.residual
    )
    # rigid motions have no frequency
    detuning = np.zeros(len(amplitudes))
    frequencies = other.modes.frequencies
    detuning[-len(frequencies) :] = np.log(frequencies / here.modes.frequencies)
    if detuning.any():
        by_frequency = here.unit_detuned(names)
        responses += np.einsum("is,isp->sp", detuning[:, None] * amplitudes, by_frequency)
    return responses


def numbers_of(number: int, sensors: int) -> Floats:
    """Return which of the numbers of a set-up are one of `STEPS`, (2 + 4 S,) of bool.

    It is one of the plate, or one of each sensor.
    """
    repeats = [1] * OF_PLATE + [sensors] * (len(STEPS) - OF_PLATE)
    return np.asarray(np.repeat(np.arange(len(STEPS)) == number, repeats))
