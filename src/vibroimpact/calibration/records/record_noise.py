"""Common to position and force records: noise estimate and labels of samples."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.arrays import Floats

ABOVE_NOISE = 6.0
"""Detection threshold in standard deviations of the noise."""


def record_noise(values: Floats) -> float:
    """Return the standard deviation of the white noise of a record that is mostly smooth.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 2001)
    >>> round(record_noise(np.sin(t) + np.random.default_rng(0).normal(scale=1.0, size=2001)), 1)
    1.0
    """
    # robust estimate from third differences: 0.6745 is the median of |N(0, 1)|, and 20 the sum of
    # squares of 1, 3, 3, 1
    third_differences = np.diff(values, 3)
    if not len(third_differences):
        return 0.0
    return float(np.median(np.abs(third_differences)) / 0.6745 / np.sqrt(20.0))


def sample_label(lines: Sequence[int] | None) -> Callable[[int], str]:
    """Return a function that names a sample by its line in the file, or by its number.

    It has its number if the lines are not known.
    """

    def label_of(index: int) -> str:
        if lines is None:
            return f"sample {index + 1}"
        return f"line {lines[index]}"

    return label_of
