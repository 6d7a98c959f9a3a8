"""Packets and what they tell of bounces: number, impulses, ratio of peaks, time between,
restitution.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason


def _of(block: Block) -> Floats:
    signal, onset, peak, impulses = (
        block.packets.signal,
        block.packets.onset,
        block.packets.peak,
        block.packets.impulses,
    )
    count = len(block.value)
    number = np.bincount(signal, minlength=count)
    # onset and peak of the first three packets of each signal
    order = np.arange(len(signal)) - np.repeat(np.cumsum(number) - number, number)
    times, peaks = np.full((2, count, 3), np.nan)
    early = order < 3
    times[signal[early], order[early]], peaks[signal[early], order[early]] = (
        onset[early],
        peak[early],
    )
    interval = np.diff(times, axis=1) / block.rate
    columns = (
        number,
        np.bincount(signal, impulses, count),
        peaks[:, 1] / peaks[:, 0],
        interval[:, 0],
        interval[:, 1] / interval[:, 0],
    )
    return np.stack(columns, axis=1)


_PACKETS = (
    "Wyss et al. 2016, Water Resour. Res. 52:7744; Chen et al. 2022, Earth Surf. Dynam. 10:279"
)

FAMILY = Family(
    (
        Feature(
            name="packets",
            meaning="number of packets of the envelope above the threshold",
            equation="count of packets",
            source=_PACKETS,
        ),
        Feature(
            name="impulses",
            meaning="upward crossings of the threshold by the signal",
            equation="sum(x[i-1] < threshold <= x[i]), x = 0 before the first sample",
            source="Rickenmann & McArdell 2007, Earth Surf. Process. Landforms 32:1362",
        ),
        Feature(
            name="peak_ratio",
            meaning="peak of the second packet over that of the first",
            equation="max|x2| / max|x1|",
            source="of this program; where each packet holds one impact",
            lacking=Reason.ONE_PACKET,
        ),
        Feature(
            name="bounce_interval",
            meaning="from the onset of the first packet to that of the second",
            equation="t2 - t1",
            source="Bernstein 1977, Am. J. Phys. 45:41",
            unit="s",
            lacking=Reason.ONE_PACKET,
        ),
        Feature(
            name="bounce_restitution",
            meaning="restitution of a ball that bounces up and down: ratio of the times between "
            "its impacts",
            equation="(t3 - t2) / (t2 - t1)",
            source="Bernstein 1977, Am. J. Phys. 45:41",
            lacking=Reason.TWO_PACKETS,
        ),
    ),
    _of,
)
