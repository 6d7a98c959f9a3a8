"""The frequency responses of the sensors of a case to a force at the place of its impact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.dynamics.vibrating.vibrating_bodies import bases_of_plate
from vibroimpact.identification.plate import compliances_of, shapes_of

_ORDERS = {"m/N": 0, "m/s/N": 1, "m/s2/N": 2}
"""Order of the derivative of the displacement that a response is of."""


def computed_responses(
    problem: Problem, sensors: Sequence[Sensor], units: Sequence[str], frequency: Floats
) -> Complex:
    r"""Return the frequency responses of sensors to a force upwards at the contact point, (S,
    frequencies).

    .. math::

        H = G(i \omega) \left(\sum_r \frac{\varphi_r(x_s)\,\varphi_r(x_c)}{\omega_r^2 - \omega^2 + 2
        i \zeta_r \omega_r \omega}
        + C\right)

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
    bases = bases_of_plate(problem)
    natural, ratios = (
        np.concatenate(part)
        for part in zip(
            *((one.angular_frequencies, one.damping_ratios) for one in bases), strict=True
        )
    )
    resonances = 1.0 / (natural[:, None] ** 2 - omega**2 + 2j * (ratios * natural)[:, None] * omega)
    touched, left_out = (
        shapes_of(problem),
        compliances_of(problem, [sensor.name for sensor in sensors]),
    )
    found = []
    for sensor, unit, compliance in zip(sensors, units, left_out, strict=True):
        shapes = np.concatenate([basis.points[sensor.name] for basis in bases]) @ np.asarray(
            sensor.components
        )
        found.append(
            _transfer(sensor, unit, omega) * ((touched * shapes) @ resonances + compliance)
        )
    return np.stack(found)


def _transfer(sensor: Sensor, unit: str, omega: Floats) -> Complex:
    """Return what a sensor makes of the displacement or the strain that it sees."""
    if sensor.instrument is None:
        return np.asarray((1j * omega) ** _ORDERS.get(unit, sensor.order))
    passed = np.full(
        len(omega),
        sensor.instrument.gain * (sensor.amplifier.gain if sensor.amplifier else 1.0),
        dtype=complex,
    )
    for stiffness, damping in sensor.sections:
        passed *= stiffness / (stiffness - omega**2 + 1j * damping * omega)
    return np.asarray(passed * (1j * omega) ** sensor.order)
