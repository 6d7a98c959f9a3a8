"""The modes left out of the next octave, as an estimate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.vibrating.oscillators import Oscillators


def next_octave(plate: Oscillators, shapes: Floats) -> tuple[Oscillators, Floats]:
    """Return a model of the modes left out of the next octave, and their shapes at S points, from
    those kept, (S, modes).

    They are modelled on the last octave kept, at twice the frequencies; twice as many are assumed,
    as for the bending of a plate.
    """
    last = np.flatnonzero(plate.angular_frequency > 0.5 * plate.angular_frequency.max())
    above = plate.pick(last)
    return replace(above, angular_frequency=2.0 * above.angular_frequency), 2.0 * shapes[:, last]
