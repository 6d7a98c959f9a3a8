"""Modal damping: models of the damping ratio of a mode, by its frequency or its number."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError


class Damping(Protocol):
    """Interface of a model of modal damping."""

    @property
    def description(self) -> str:
        """Short description for users."""

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio of each mode [-] from its frequency [Hz]."""


@dataclass(frozen=True)
class ConstantRatio:
    """The same damping ratio [-] for all modes.

    Examples
    --------
    >>> ConstantRatio(0.01).ratios(np.array([100.0, 200.0])).tolist()
    [0.01, 0.01]
    """

    ratio: float

    @property
    def description(self) -> str:
        """Short description for users."""
        if not self.ratio:
            return "none"
        return f"damping ratio {self.ratio:g} of every mode"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio of each mode."""
        return np.full(len(frequencies), self.ratio)


@dataclass(frozen=True)
class RatioTable:
    """Damping ratios tabulated over frequency and interpolated linearly.

    They are constant beyond the ends of the table.

    Parameters
    ----------
    frequencies : tuple of float
        [Hz], ascending.
    damping_ratios : tuple of float
        [-], one per frequency.
    """

    frequencies: tuple[float, ...]
    damping_ratios: tuple[float, ...]

    def __post_init__(self) -> None:
        frequencies = len(self.frequencies)
        ratios = len(self.damping_ratios)
        if frequencies != ratios or not frequencies:
            raise InputError(
                f"{frequencies} frequenc{'y' if frequencies == 1 else 'ies'} and {ratios} "
                f"ratio{'' if ratios == 1 else 's'} do not make a table; "
                "give one frequency or more, and one ratio for each"
            )
        if np.any(np.diff(self.frequencies) <= 0.0):
            raise InputError("the frequencies of the table must ascend", "frequencies")

    @property
    def description(self) -> str:
        """Short description for users."""
        if len(self.frequencies) == 1:
            return f"damping ratio {self.damping_ratios[0]:g} of every mode"
        return (
            f"a table of {len(self.frequencies)} ratios from {self.frequencies[0]:g} to "
            f"{self.frequencies[-1]:g} Hz"
        )

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the interpolated damping ratio of each mode."""
        return np.interp(frequencies, self.frequencies, self.damping_ratios)


@dataclass(frozen=True)
class RatioOfEach:
    """A damping ratio [-] for each mode, from the lowest; the last one holds for further modes."""

    damping_ratios: tuple[float, ...]

    @property
    def description(self) -> str:
        """Short description for users."""
        ratios = ", ".join(f"{ratio:g}" for ratio in self.damping_ratios[:4])
        if len(self.damping_ratios) > 4:
            ratios += ", ..."
        return (
            f"damping ratios of the modes one by one: {ratios}; "
            "the last holds for all further modes"
        )

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio of each mode, in their order."""
        last = len(self.damping_ratios) - 1
        return np.array(self.damping_ratios)[np.minimum(np.arange(len(frequencies)), last)]


@dataclass(frozen=True)
class Rayleigh:
    r"""Rayleigh damping :math:`C = a M + b K`.

    The damping ratio is :math:`\zeta = a / (2 \omega) + b \omega / 2` (Lord Rayleigh, Theory of
    Sound, 1877).

    Parameters
    ----------
    mass_coefficient, stiffness_coefficient : float
        a [1/s] and b [s], >= 0.
    """

    mass_coefficient: float
    stiffness_coefficient: float

    @property
    def description(self) -> str:
        """Short description for users."""
        return (
            f"Rayleigh damping, {self.mass_coefficient:g} 1/s times mass plus "
            f"{self.stiffness_coefficient:g} s times stiffness"
        )

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio of each mode."""
        angular = 2.0 * np.pi * np.asarray(frequencies)
        return np.asarray(
            0.5 * (self.mass_coefficient / angular + self.stiffness_coefficient * angular)
        )


@dataclass(frozen=True)
class LossFactor:
    """Loss factor [-], of the material or given: for light damping twice the damping ratio."""

    loss_factor: float

    @property
    def description(self) -> str:
        """Short description for users."""
        return (
            f"loss factor {self.loss_factor:g}, damping ratio {0.5 * self.loss_factor:g} of "
            "every mode"
        )

    def ratios(self, frequencies: Floats) -> Floats:
        """Return half the loss factor for each mode."""
        return np.full(len(frequencies), 0.5 * self.loss_factor)


@dataclass(frozen=True)
class AdamsDefault:
    """The default of Adams/Flex for flexible bodies.

    It is 1 % below 100 Hz, 10 % to 1 kHz, and critical above.

    Examples
    --------
    >>> AdamsDefault().ratios(np.array([50.0, 500.0, 12735.0])).tolist()
    [0.01, 0.1, 1.0]
    """

    @property
    def description(self) -> str:
        """Short description for users."""
        return "Adams' default for flexible bodies: 1 % below 100 Hz, 10 % to 1 kHz, critical above"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio of each mode."""
        above_100_hz = np.where(frequencies <= 1000.0, 0.1, 1.0)
        return np.where(frequencies < 100.0, 0.01, above_100_hz)
