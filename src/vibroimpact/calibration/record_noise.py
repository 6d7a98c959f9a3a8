"""What records of position and force share: their noise, and what a sample is called."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.arrays import Floats

ABOVE_NOISE = 6.0
"""Standard deviations that tell something from noise."""


def record_noise(values: Floats) -> float:
    """Return the standard deviation of white noise on a record that is smooth for most of the time.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 2001)
    >>> round(record_noise(np.sin(t) + np.random.default_rng(0).normal(scale=1.0, size=2001)), 1)
    1.0
    """
    third = np.diff(values, 3)
    return float(np.median(np.abs(third)) / 0.6745 / np.sqrt(20.0)) if len(third) else 0.0


def sample_label(lines: Sequence[int] | None) -> Callable[[int], str]:
    """Return what tells where a sample is: its line of a file, if that is known."""
    return (lambda index: f"sample {index + 1}") if lines is None else (lambda index: f"line {lines[index]}")
