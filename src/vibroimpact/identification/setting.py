"""What the records change with the set-up: the plate and its sensors as they differ from
the case.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.place_responses import responses_at
from vibroimpact.identification.plate import Place, Plate, compliances_of, shapes_of
from vibroimpact.identification.setup import Setup

STEPS = np.array([1e-4, 1e-4, 1e-5, 1e-5, 1e-3, 1e-3])
"""Steps of derivatives in thickness, modulus [-], and of each sensor x, y [m],
sensitivity and resonance [-].
"""
OF_PLATE = 2
"""Number of those of the plate, which come first."""
_GAIN = 4
"""Which of them is the sensitivity, of which the records are linear."""


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
    """Return derivatives of the records of a force in the numbers of a set-up that are not certain,
    zero for others, (2 + 4 S, S, samples).

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
    sensors, deviations = len(names), plate.errors.deviations(len(names))
    gains, unit = 1.0 + Setup.of(numbers).gain[:, None], here.unit(names)

    def answers_of(there: Plate) -> Floats:
        """Return responses to an impulse in a set-up that differs little: shapes exactly,
        frequencies by derivatives.
        """
        touched = there.at(place)
        shapes, compliances = shapes_of(touched), compliances_of(touched, names)
        if any(
            one != other
            for one, other in zip(there.sensors(names), here.sensors(names), strict=True)
        ):
            return responses_at(
                there.problem, there.sensors(names), plate.window, shapes, compliances
            )
        both = shapes[:, None] * there.seen(names)
        higher = np.zeros(len(both))
        higher[-len(there.modes.frequencies) :] = np.log(
            there.modes.frequencies / here.modes.frequencies
        )
        found: Floats = (
            np.einsum("is,isp->sp", both, unit.values) + compliances[:, None] * unit.residual
        )
        if higher.any():
            found += np.einsum("is,isp->sp", higher[:, None] * both, here.unit_detuned(names))
        return found

    bare = signals(answers_of(here))
    found = np.zeros((len(deviations), *bare.shape))
    for number, step in enumerate(STEPS):
        which = numbers_of(number, sensors)
        if not deviations[which].any():
            continue
        if number == _GAIN:
            change = bare
        else:
            change = (
                gains
                * (signals(answers_of(plate.under(Setup.of(numbers + step * which), names))) - bare)
                / step
            )
        # a sensor of its own place, gain and resonance alone
        found[which] = change if number < OF_PLATE else np.eye(sensors)[:, :, None] * change
    return found


def numbers_of(number: int, sensors: int) -> Floats:
    """Return which of the numbers of a set-up are one of `STEPS`, (2 + 4 S,) of bool: one
    of the plate, or one of each sensor.
    """
    return np.asarray(
        np.repeat(
            np.arange(len(STEPS)) == number, [1] * OF_PLATE + [sensors] * (len(STEPS) - OF_PLATE)
        )
    )
