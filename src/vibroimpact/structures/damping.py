"""Damping of modes: models that give each mode its damping ratio, and say what they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError


class Damping(Protocol):
    """Anything that gives modes their damping ratios."""

    @property
    def words(self) -> str:
        """What it is, in a few words for people."""

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the damping ratio [-] of each mode, given its frequency [Hz]."""


@dataclass(frozen=True)
class ConstantRatio:
    """One damping ratio [-] for all modes.

    Examples
    --------
    >>> ConstantRatio(0.01).ratios(np.array([100.0, 200.0])).tolist()
    [0.01, 0.01]
    """

    ratio: float

    @property
    def words(self) -> str:
        """What it is."""
        return f"damping ratio {self.ratio:g} of every mode" if self.ratio else "none"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the ratio for each."""
        return np.full(len(frequencies), self.ratio)


@dataclass(frozen=True)
class RatioTable:
    """Damping ratios at some frequencies, straight lines between them, and constant beyond.

    Parameters
    ----------
    frequencies : tuple of float
        [Hz], ascending.
    damping_ratios : tuple of float
        [-], one a frequency.
    """

    frequencies: tuple[float, ...]
    damping_ratios: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.frequencies) != len(self.damping_ratios) or not self.frequencies:
            raise InputError(
                f"{len(self.frequencies)} frequencies and {len(self.damping_ratios)} ratios do not make a table; give one ratio a frequency"
            )
        if np.any(np.diff(self.frequencies) <= 0.0):
            raise InputError("the frequencies of the table must ascend", "frequencies")

    @property
    def words(self) -> str:
        """What it is."""
        return f"a table of {len(self.frequencies)} ratios from {self.frequencies[0]:g} to {self.frequencies[-1]:g} Hz"

    def ratios(self, frequencies: Floats) -> Floats:
        """Interpolate."""
        return np.interp(frequencies, self.frequencies, self.damping_ratios)


@dataclass(frozen=True)
class RatioOfEach:
    """A damping ratio [-] for each mode, from the lowest; the last one goes on."""

    damping_ratios: tuple[float, ...]

    @property
    def words(self) -> str:
        """What it is."""
        shown = ", ".join(f"{ratio:g}" for ratio in self.damping_ratios[:4]) + (", ..." if len(self.damping_ratios) > 4 else "")
        return f"damping ratios of the modes one by one: {shown}; the last goes on"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return them in their order."""
        return np.array(self.damping_ratios)[np.minimum(np.arange(len(frequencies)), len(self.damping_ratios) - 1)]


@dataclass(frozen=True)
class Rayleigh:
    r"""Damping :math:`C = a M + b K`: ratio :math:`\zeta = a / (2 \omega) + b \omega / 2` (Lord Rayleigh, Theory of Sound, 1877).

    Parameters
    ----------
    mass_coefficient, stiffness_coefficient : float
        a [1/s] and b [s], >= 0.
    """

    mass_coefficient: float
    stiffness_coefficient: float

    @property
    def words(self) -> str:
        """What it is."""
        return f"Rayleigh's, {self.mass_coefficient:g} 1/s times mass and {self.stiffness_coefficient:g} s times stiffness"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the ratio at each frequency."""
        angular = 2.0 * np.pi * np.asarray(frequencies)
        return np.asarray(0.5 * (self.mass_coefficient / angular + self.stiffness_coefficient * angular))


@dataclass(frozen=True)
class LossFactor:
    """A loss factor of the material [-]: twice the damping ratio, for light damping."""

    loss_factor: float

    @property
    def words(self) -> str:
        """What it is."""
        return f"loss factor {self.loss_factor:g} of the material, damping ratio {0.5 * self.loss_factor:g}"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return half of it for each."""
        return np.full(len(frequencies), 0.5 * self.loss_factor)


@dataclass(frozen=True)
class AdamsDefault:
    """What Adams/Flex gives a flexible body unless told otherwise: 1 % below 100 Hz, 10 % to 1 kHz, critical above.

    Examples
    --------
    >>> AdamsDefault().ratios(np.array([50.0, 500.0, 12735.0])).tolist()
    [0.01, 0.1, 1.0]
    """

    @property
    def words(self) -> str:
        """What it is."""
        return "Adams' default for flexible bodies: 1 % below 100 Hz, 10 % to 1 kHz, critical above"

    def ratios(self, frequencies: Floats) -> Floats:
        """Return the ratio at each frequency."""
        return np.where(frequencies < 100.0, 0.01, np.where(frequencies <= 1000.0, 0.1, 1.0))
