"""What all frequencies of a case have in common: an error of its modulus, thickness or density."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.correlation.mode_pairs import ModePair

_FEWEST = 3
"""Least number of modes that have anything in common."""
_LEAST = 2e-3
"""Least relative difference of frequencies that is told."""
_ALIKE = 0.35
"""Largest distance from their median, relative to it, of differences that are alike: thick plates and coarse meshes make them
differ by some of it."""


@dataclass(frozen=True)
class CommonDifference:
    """The relative difference that the measured frequencies have from those of a case.

    Parameters
    ----------
    value, least, largest : float
        Their median, and the least and the largest of them.
    modes : int
        Number of modes.
    """

    value: float
    least: float
    largest: float
    modes: int

    @property
    def sentence(self) -> str:
        """What it says of the case, without a full stop."""
        way = "higher" if self.value > 0.0 else "lower"
        frequency, stiffness = 100.0 * abs(self.value), 100.0 * ((1.0 + self.value) ** 2 - 1.0)
        ends = sorted((100.0 * abs(self.least), 100.0 * abs(self.largest)))
        causes = f"Young's modulus over density differs by {stiffness:+.2g} %, or the thickness by about {100.0 * self.value:+.2g} %"
        differ = f"the frequencies of {self.modes} modes are all {frequency:.2g} % {way} than the case's ({ends[0]:.2g} to {ends[1]:.2g} %)"
        return f"{differ}: {causes}"


def common_difference(pairs: Sequence[ModePair]) -> CommonDifference | None:
    """Return the difference that all paired frequencies have from the case's; None if they have none in common."""
    both = [(pair.frequency, pair.measured.frequency) for pair in pairs if pair.number is not None and pair.measured is not None]
    told = [(measured.value / frequency - 1.0, measured.deviation / frequency) for frequency, measured in both]
    if len(told) < _FEWEST:
        return None
    differences, deviations = np.array(told).T
    middle = float(np.median(differences))
    alike = np.abs(differences - middle) <= np.maximum(_ALIKE * abs(middle), 3.0 * deviations)
    if abs(middle) < max(_LEAST, 3.0 * float(np.median(deviations))) or not alike.all():
        return None
    return CommonDifference(middle, float(differences.min()), float(differences.max()), len(told))
