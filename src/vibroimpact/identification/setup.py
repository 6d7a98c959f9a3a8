"""What a laboratory does not know exactly of a plate and its sensors.

Errors that are stated, and values that a fit finds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.errors import InputError
from vibroimpact.structures.modal_model import ModalBasis

MOUNTED_RESONANCES = "mounted resonances of accelerometers"
_MEANINGS = {
    "sensor_place": "positions of the sensors",
    "gain": "sensitivities of the sensors",
    "thickness": "thickness of the plate",
    "modulus": "modulus of the plate",
    "resonance": MOUNTED_RESONANCES,
}
_OPTIONS = {
    "sensor_place": "--sensor-error",
    "gain": "--gain-error",
    "thickness": "--thickness-error",
    "modulus": "--modulus-error",
    "resonance": "--resonance-error",
}
_LARGEST_OF_PLACE = 0.1
"""Largest standard deviation of the place of a sensor that is allowed [m]."""
_LARGEST_SHARE = 0.3
"""Largest relative standard deviation that is allowed [-]."""


def _largest(name: str) -> float:
    """Return the largest standard deviation that is allowed of one of `SetupErrors`."""
    return _LARGEST_OF_PLACE if name == "sensor_place" else _LARGEST_SHARE


@dataclass(frozen=True)
class SetupErrors:
    """Standard uncertainties of the plate and sensor properties that a case states.

    What is not given here is taken as certain.

    Parameters
    ----------
    sensor_place : float, default 0
        Of x and of y of each sensor [m], at most 0.1.
    gain : float, default 0
        Of the relative error of the sensitivity of each sensor [-], at most 0.3.
    thickness : float, default 0
        Of the relative error of the thickness of the plate [-], at most 0.3.
    modulus : float, default 0
        Of the relative error of Young's modulus of the plate [-], at most 0.3.
    resonance : float, default 0
        Of the relative error of the mounted resonance of each accelerometer that has one [-], at
        most 0.3.

    Raises
    ------
    InputError
        If one is negative or too large.

    Examples
    --------
    >>> SetupErrors(sensor_place=5e-3, gain=0.02).options
    '--sensor-error "5 mm" --gain-error 0.02'
    >>> SetupErrors(sensor_place=5e-3, gain=0.02).certain
    ('thickness of the plate', 'modulus of the plate', 'mounted resonances of accelerometers')
    """

    sensor_place: float = 0.0
    gain: float = 0.0
    thickness: float = 0.0
    modulus: float = 0.0
    resonance: float = 0.0

    def __post_init__(self) -> None:
        for name, meaning in _MEANINGS.items():
            deviation = getattr(self, name)
            largest = _largest(name)
            if 0.0 <= deviation <= largest:
                continue
            if name == "sensor_place":
                allowed = f"{largest:g} m (5 mm is 0.005)"
            else:
                allowed = f"{largest:g} (2 % is 0.02)"
            raise InputError(
                f"an error of {deviation:.10g} of the {meaning} is not allowed; it must be 0 to "
                f"{allowed}"
            )

    @property
    def options(self) -> str:
        """The options of the command that state them."""
        options = []
        for name, option in _OPTIONS.items():
            deviation = getattr(self, name)
            if not deviation:
                continue
            text = f"{deviation:g}"
            if name == "sensor_place":
                text = f'"{1e3 * deviation:g} mm"'
            options.append(f"{option} {text}")
        return " ".join(options)

    @property
    def certain(self) -> tuple[str, ...]:
        """What of the plate and its sensors is taken as certain."""
        return tuple(meaning for name, meaning in _MEANINGS.items() if not getattr(self, name))

    @cached_property
    def is_none(self) -> bool:
        """Whether all is taken as certain."""
        return len(self.certain) == len(_MEANINGS)

    def at_least(self, sizes: Mapping[str, float]) -> SetupErrors:
        """Return errors of which some are at least of given sizes, as far as that is allowed.

        Examples
        --------
        >>> SetupErrors(gain=0.02).at_least({"gain": 0.6, "thickness": 0.01}).options
        '--gain-error 0.3 --thickness-error 0.01'
        """
        raised = {
            name: min(max(getattr(self, name), size), _largest(name))
            for name, size in sizes.items()
        }
        return replace(self, **raised)

    def deviations(self, sensors: int) -> Floats:
        """Return the standard deviations of the numbers of a `Setup` of S sensors, (2 + 4 S,)."""
        of_sensor = (self.sensor_place, self.sensor_place, self.gain, self.resonance)
        return np.array([self.thickness, self.modulus, *np.repeat(of_sensor, sensors)])


@dataclass(frozen=True)
class Setup:
    """A plate and its sensors as they differ from the case.

    Parameters
    ----------
    thickness, modulus : float
        Relative differences [-].
    moved : array, shape (S, 2)
        Differences of x and y of the sensors [m].
    gain, resonance : array, shape (S,)
        Relative differences [-].
    """

    thickness: float
    modulus: float
    moved: Floats
    gain: Floats
    resonance: Floats

    @classmethod
    def of(cls, numbers: Floats) -> Setup:
        """Return a set-up from its numbers, (2 + 4 S,).

        They are thickness, modulus, then x, y, gain and resonance, each of all sensors.
        """
        x, y, gain, resonance = numbers[2:].reshape(4, -1)
        return cls(float(numbers[0]), float(numbers[1]), np.stack([x, y], axis=1), gain, resonance)


def stretched(problem: Problem, setup: Setup, exponents: Floats) -> Problem:
    r"""Return a problem whose plate has the thickness and the modulus of a set-up.

    With the thickness h, the modulus E and modes of unit modal mass, deflections are proportional
    to :math:`h^{-1/2}`, frequencies to :math:`E^{1/2} h^n` with the exponent n of each mode, static
    compliances to :math:`1/(E h^3)`; strains of a face to h times the deflections, forces of
    supports to :math:`E h^3` times these.
    """
    modes = problem.plate.modes
    assert modes is not None
    thickness = 1.0 + setup.thickness
    modulus = 1.0 + setup.modulus
    compliance = 1.0 / (modulus * thickness**3)
    deflection = thickness**-0.5
    # of what a sensor reads, over the deflection
    reading = dict.fromkeys(modes.points, 1.0)
    for sensor in problem.sensors:
        if sensor.subject == "strain":
            reading[sensor.name] = thickness
        elif sensor.subject == "support":
            reading[sensor.name] = 1.0 / compliance
    changed = replace(
        modes,
        frequencies=modes.frequencies * modulus**0.5 * thickness**exponents,
        contact=deflection * modes.contact,
        along=_scaled(modes.along, deflection),
        participation=modes.participation / deflection,
        points={name: deflection * reading[name] * shapes for name, shapes in modes.points.items()},
        residuals={
            name: compliance * reading[name] * residual
            for name, residual in modes.residuals.items()
        },
    )
    rigid = problem.plate.rigid
    if rigid is not None:
        rigid = _of_other_mass(rigid, deflection)
    plate = replace(problem.plate, modes=changed, rigid=rigid)
    quasi_static = replace(problem.quasi_static, linear=compliance * problem.quasi_static.linear)
    return problem.on_plate(plate, quasi_static)


def _scaled(shapes: Floats | None, factor: float) -> Floats | None:
    """Return mode shapes times a factor, if there are any."""
    return None if shapes is None else factor * shapes


def _of_other_mass(rigid: ModalBasis, deflection: float) -> ModalBasis:
    """Return rigid motions of unit modal mass of a body whose mass changes.

    The change is given by that of their deflections.
    """
    return replace(
        rigid,
        contact=deflection * rigid.contact,
        along=_scaled(rigid.along, deflection),
        turning=_scaled(rigid.turning, deflection),
        participation=rigid.participation / deflection,
        points={name: deflection * shapes for name, shapes in rigid.points.items()},
    )


def mounted_resonance(sensor: Sensor) -> float | None:
    """Return the mounted resonance of an accelerometer [Hz]; None of one without, and of others."""
    instrument = sensor.instrument
    if isinstance(instrument, Accelerometer):
        return instrument.resonance
    return None


def with_resonance(sensor: Sensor, difference: float) -> Sensor:
    """Return a sensor with another mounted resonance, by a relative difference.

    Sensors other than accelerometers with a resonance stay the same.
    """
    instrument = sensor.instrument
    if not isinstance(instrument, Accelerometer) or instrument.resonance is None:
        return sensor
    resonance = (1.0 + difference) * instrument.resonance
    return replace(sensor, instrument=replace(instrument, resonance=resonance))
