"""Zero-crossing rate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature


def _zero_crossing_rate(block: Block) -> Floats:
    positive = block.value >= 0.0
    crossings = np.count_nonzero(positive[:, 1:] != positive[:, :-1], axis=1)
    return np.asarray(crossings * block.rate / block.samples)[:, None]


FAMILY = Family(
    (
        Feature(
            name="zero_crossing_rate",
            meaning="changes of sign in a second; zero counts as positive",
            equation="sum((x[i] >= 0) != (x[i-1] >= 0)) rate / samples",
            source="Rice 1944, Bell Syst. Tech. J. 23:282, of noise; Kedem 1986, Proc. IEEE "
            "74:1477",
            unit="1/s",
        ),
    ),
    _zero_crossing_rate,
)
