r"""What sensors measure of the steady motion of a plate on supports that move.

Each harmonic motion of the supports moves a point of the plate by a phasor C (`shaken/steady.py`),
and for ever. It is the free motion of an undamped oscillator, :math:`q = \sin \omega t`, so that
derivative, resonance and filter are transfer functions at its poles (`pole_pairs`):
:math:`\mathrm{Im}\,C e^{i \omega t} = a q + b \dot q` with :math:`C = a + i \omega b`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.sensors.antialias import HALF_LENGTH
from vibroimpact.dynamics.sensors.filtered_chain import filter_gains
from vibroimpact.dynamics.sensors.instruments.pole_pairs import PolePairs, Section
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.sensors.sampled import blocks_of
from vibroimpact.dynamics.statement.plate_motion import PlateMotion
from vibroimpact.dynamics.statement.steady import steady_modes
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices


def steady_outputs(
    motion: PlateMotion,
    modes: ModalBasis | None,
    sensors: Sequence[Sensor],
    sections: Sequence[Section],
    rate: float,
    samples: range,
    converted: bool,
) -> Floats:
    """Return the outputs of sensors in the steady motion, (S, samples).

    The sensors have the same resonance and filter.

    Parameters
    ----------
    motion : PlateMotion
        Motion of the supports.
    modes : ModalBasis or None
        Modes of the plate.
    sensors : sequence of Sensor
        The sensors; they move with the plate, and read its motion in space.
    sections : sequence of pairs of floats
        The poles of the instruments.
    rate : float
        Samples per second [Hz].
    samples : range
        Numbers of the samples, from the start on; negative ones lie before it.
    converted : bool
        Whether the filter of a converter follows.
    """
    omega = motion.angular_frequency
    zeros = np.zeros_like(omega)
    # undamped oscillators that move as sines
    oscillators = Oscillators(omega, zeros, zeros)
    start = np.stack([zeros, omega])
    poles = PolePairs(omega**2, zeros)
    passed = poles.low_pass(sections)
    if converted:
        passed = poles.product(passed, filter_gains(oscillators, rate))
    elements = []
    for sensor in sensors:
        phasors = _phasors(motion, modes, sensor)
        moved = poles.product(
            np.stack([phasors.real, phasors.imag / omega]), poles.power(sensor.order)
        )
        elements.append(poles.product(moved, passed))
    outputs = np.stack(elements, axis=1)
    values = np.zeros((len(sensors), len(samples)))
    # the gains of the filter are for its output so many samples later
    lead = HALF_LENGTH if converted else 0
    first = samples.start - lead
    blocks_of(oscillators, outputs, rate).sample(values, start, first / rate)
    return values


def _phasors(motion: PlateMotion, modes: ModalBasis | None, sensor: Sensor) -> Complex:
    """Return the phasors of what a sensor measures (k,).

    It is its motion in space along its direction [m], or the strain [m/m].
    """
    direction = np.asarray(sensor.components)
    # the supports move the plate as a whole, which does not strain it
    along = 0.0
    if sensor.subject != "strain":
        along = float(direction @ motion.direction)
    supports = along * motion.phasors
    if modes is None:
        return supports
    shapes = modes.points[sensor.name] @ direction
    return np.asarray(supports + shapes @ steady_modes(motion, modes))
