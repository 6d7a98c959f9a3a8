"""The frequency responses of the sensors of a case to a force at the place of its impact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.drop_system import bases_of_plate
from vibroimpact.identification.plate import compliances_of, shapes_of

_ORDERS = {"m/N": 0, "m/s/N": 1, "m/s2/N": 2}
"""Order of the derivative of the displacement that a response is of."""


def computed_responses(
    problem: Problem, sensors: Sequence[Sensor], units: Sequence[str], frequency: Floats
) -> Complex:
    r"""Return the frequency responses of sensors to a force upwards at the contact point.

    They have the shape (S, frequencies).

    .. math::

        H = G(i \omega) \left(\sum_r \frac{\varphi_r(x_s)\,\varphi_r(x_c)}
        {\omega_r^2 - \omega^2 + 2 i \zeta_r \omega_r \omega} + C\right)

    with rigid motions and modes of unit modal mass, the static compliance C of the modes left out,
    and the instrument G. Anti-alias filters are left out: force and motion pass through the same,
    and their ratio has none.

    Parameters
    ----------
    problem : Problem
        The problem.
    sensors : sequence of Sensor
        The sensors.
    units : sequence of str
        Unit of each response: a sensor without an instrument gives any motion.
    frequency : array, shape (frequencies,)
        Frequencies [Hz], above 0.
    """
    omega = 2.0 * np.pi * np.asarray(frequency)
    # rigid motions and modes of vibration alike
    bases = bases_of_plate(problem)
    natural = np.concatenate([basis.angular_frequencies for basis in bases])
    ratios = np.concatenate([basis.damping_ratios for basis in bases])
    stiffness = natural[:, None] ** 2
    damping = 2j * (ratios * natural)[:, None]
    resonances = 1.0 / (stiffness - omega**2 + damping * omega)
    contact_shapes = shapes_of(problem)
    compliances = compliances_of(problem, [sensor.name for sensor in sensors])
    responses = []
    for sensor, unit, compliance in zip(sensors, units, compliances, strict=True):
        components = np.concatenate([basis.points[sensor.name] for basis in bases])
        sensor_shapes = components @ np.asarray(sensor.components)
        # modes that are left out lie above the band, in which they deflect as springs
        receptance = (contact_shapes * sensor_shapes) @ resonances + compliance
        responses.append(_transfer(sensor, unit, omega) * receptance)
    return np.stack(responses)


def _transfer(sensor: Sensor, unit: str, omega: Floats) -> Complex:
    """Return what a sensor makes of the displacement or the strain that it sees."""
    if sensor.instrument is None:
        return np.asarray((1j * omega) ** _ORDERS.get(unit, sensor.order))
    gain = sensor.instrument.gain
    if sensor.amplifier:
        gain *= sensor.amplifier.gain
    transfer = np.full(len(omega), gain, dtype=complex)
    # resonators of unit gain at 0 Hz, one after the other
    for stiffness, damping in sensor.sections:
        transfer *= stiffness / (stiffness - omega**2 + 1j * damping * omega)
    return np.asarray(transfer * (1j * omega) ** sensor.order)
