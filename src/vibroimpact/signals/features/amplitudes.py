"""Amplitudes of a signal in time, and their ratios."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature

_TEXTBOOK = "Brandt 2011, Noise and Vibration Analysis, Wiley, ch. 4"
_FACTORS = "Lei, He, Zi & Hu 2007, Mech. Syst. Signal Process. 21:2280"


def _amplitudes(block: Block) -> Floats:
    value = block.value
    peak = block.peak
    highest = value.max(axis=1)
    lowest = value.min(axis=1)
    mean_square = block.square_sum / block.samples
    rms = np.sqrt(mean_square)
    mean_magnitude = block.magnitude.mean(axis=1)
    square_mean_root = np.sqrt(block.magnitude).mean(axis=1) ** 2
    # from the first sample, so that a constant has none at all
    centred = value - value[:, :1]
    variance = (centred**2).mean(axis=1) - centred.mean(axis=1) ** 2
    standard_deviation = np.sqrt(np.maximum(variance, 0.0))
    columns = (
        peak,
        highest - lowest,
        value.mean(axis=1),
        mean_magnitude,
        rms,
        standard_deviation,
        block.square_sum / block.rate,
        peak / rms,
        rms / mean_magnitude,
        peak / mean_magnitude,
        peak / square_mean_root,
    )
    return np.stack(columns, axis=1)


FAMILY = Family(
    (
        Feature(
            name="peak", meaning="largest magnitude", equation="max|x|", source=_TEXTBOOK, degree=1
        ),
        Feature(
            name="peak_to_peak",
            meaning="span of the samples",
            equation="max(x) - min(x)",
            source=_TEXTBOOK,
            degree=1,
            offset_free=True,
        ),
        Feature(name="mean", meaning="mean", equation="mean(x)", source=_TEXTBOOK, degree=1),
        Feature(
            name="mean_magnitude",
            meaning="mean of the magnitude",
            equation="mean|x|",
            source=_TEXTBOOK,
            degree=1,
        ),
        Feature(
            name="rms",
            meaning="root of the mean square",
            equation="sqrt(mean(x^2))",
            source=_TEXTBOOK,
            degree=1,
        ),
        Feature(
            name="standard_deviation",
            meaning="root of the mean square about the mean",
            equation="sqrt(mean((x - mean(x))^2))",
            source=_TEXTBOOK,
            degree=1,
            offset_free=True,
        ),
        Feature(
            name="energy",
            meaning="integral of the square over time",
            equation="sum(x^2) / rate",
            source=_TEXTBOOK,
            unit="s",
            degree=2,
        ),
        Feature(
            name="crest_factor",
            meaning="peak over rms",
            equation="max|x| / sqrt(mean(x^2))",
            source=_TEXTBOOK,
        ),
        Feature(
            name="shape_factor",
            meaning="rms over the mean magnitude",
            equation="sqrt(mean(x^2)) / mean|x|",
            source=_FACTORS,
        ),
        Feature(
            name="impulse_factor",
            meaning="peak over the mean magnitude",
            equation="max|x| / mean|x|",
            source=_FACTORS,
        ),
        Feature(
            name="clearance_factor",
            meaning="peak over the squared mean root of the magnitude",
            equation="max|x| / mean(sqrt|x|)^2",
            source=_FACTORS,
        ),
    ),
    _amplitudes,
)
