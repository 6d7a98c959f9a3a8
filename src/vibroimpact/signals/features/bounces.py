"""Packets and what they tell of bounces: their number, impulses, peaks, intervals, restitution."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.signals.block import Block
from vibroimpact.signals.feature import Family, Feature
from vibroimpact.signals.reasons import Reason


def _bounce_features(block: Block) -> Floats:
    packets = block.packets
    signals = len(block.value)
    count = np.bincount(packets.signal, minlength=signals)
    # onset and peak of the first three packets of each signal
    order = np.arange(len(packets.signal)) - np.repeat(np.cumsum(count) - count, count)
    early = order < 3
    onset = np.full((signals, 3), np.nan)
    onset[packets.signal[early], order[early]] = packets.onset[early]
    peak = np.full((signals, 3), np.nan)
    peak[packets.signal[early], order[early]] = packets.peak[early]
    interval = np.diff(onset, axis=1) / block.rate
    columns = (
        count,
        np.bincount(packets.signal, packets.impulses, signals),
        peak[:, 1] / peak[:, 0],
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
    _bounce_features,
)
