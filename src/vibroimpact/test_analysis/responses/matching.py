"""Which measured frequency response is which sensor's, and where its force acts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from vibroimpact.dynamics.sensors.instruments.microphone import Microphone
from vibroimpact.dynamics.sensors.sensor import Sensor
from vibroimpact.errors import InputError, did_you_mean, listed
from vibroimpact.quoting import quoted
from vibroimpact.signals.frequency_response import DegreeOfFreedom, FrequencyResponse

UP = 3
"""Direction of a force along the normal of the plate, upwards."""
_ALONG = 0.99
"""Component of a unit vector along an axis that it is along."""
_AXES = "xyz"


@dataclass(frozen=True)
class Matched:
    """Frequency responses of the sensors of a case to a force at the place of its impact.

    Parameters
    ----------
    sensors : tuple of Sensor
        The sensors.
    responses : tuple of FrequencyResponse
        The response of each.
    signs : tuple of float
        1 where the measured response is that of the sensor to a force upwards, -1 where force or
        direction are the other way round.
    reference : str
        The place that is that of the impact.
    reciprocal : bool
        Whether the hammer was at the sensors, and the motion was measured at the place of the
        impact.
    sense_known : bool
        Whether it is stated in which direction the force is positive; else it is taken as that of a
        hammer, downwards.
    left_out : int
        Number of responses to this force that no sensor of the case is named after.
    """

    sensors: tuple[Sensor, ...]
    responses: tuple[FrequencyResponse, ...]
    signs: tuple[float, ...]
    reference: str
    reciprocal: bool
    sense_known: bool
    left_out: int


def matched(
    sensors: Sequence[Sensor], responses: Sequence[FrequencyResponse], reference: str | None
) -> Matched:
    """Return the responses of sensors.

    Parameters
    ----------
    sensors : sequence of Sensor
        The sensors of the case.
    responses : sequence of FrequencyResponse
        The measured responses.
    reference : str, optional
        Name of the place of the case's impact in the file; by default the only one where a force
        acts, or where motion was measured.

    Raises
    ------
    InputError
        If there is no response, it is not clear which place is that of the impact, no sensor has a
        response or one has several, or a direction or a unit is another.
    """
    if not responses:
        raise InputError("there is no frequency response; give at least one")
    name, pairs, reciprocal = _of_impact(responses, reference)
    across = [(one, there) for one, here, there in pairs if abs(here.direction) in (0, UP)]
    if not across:
        raise InputError(
            f"the {'motions' if reciprocal else 'forces'} at {quoted(name)} are along the "
            "plate, and the case's force is normal to it; "
            "give responses with those along z"
        )
    chosen: dict[str, tuple[Sensor, FrequencyResponse, DegreeOfFreedom]] = {}
    for sensor in sensors:
        fitting = [(one, there) for one, there in across if sensor.name in there.names]
        along = [(one, there) for one, there in fitting if _axis_fits(sensor, there)]
        if fitting and not along:
            words = (
                f"the response {quoted(sensor.name)} is along "
                f"{_AXES[abs(fitting[0][1].direction) - 1]}, and the case's sensor along"
            )
            raise InputError(
                f"{words} {list(sensor.direction)}; write its direction as it was measured",
                "sensors.direction",
            )
        if len(along) > 1:
            motion, force = (name, sensor.name) if reciprocal else (sensor.name, name)
            words = (
                f"there are {len(along)} frequency responses of the motion at {quoted(motion)} "
                f"to a force at {quoted(force)}"
            )
            raise InputError(f"{words}; leave one of them in the file")
        if along:
            chosen[sensor.name] = (sensor, *along[0])
    if not chosen:
        named = listed(dict.fromkeys(there.name for _, there in across), sensors[0].name)
        what = (
            f"a force with a response at {quoted(name)}"
            if reciprocal
            else f"a response to the force at {quoted(name)}"
        )
        words = (
            f"no sensor of the case ({listed(one.name for one in sensors)}) is named after {what}"
        )
        remedy = (
            f'write the name of the sensor as the file has it, such as name = "{across[0][1].name}"'
        )
        raise InputError(f"{words}: {named}; {remedy}", "sensors.name")
    for sensor, one, _ in chosen.values():
        _check_unit(sensor, one)
    here = {id(one): here for one, here, _ in pairs}
    directions = [here[id(one)].direction for _, one, _ in chosen.values()]
    return Matched(
        tuple(sensor for sensor, _, _ in chosen.values()),
        tuple(one for _, one, _ in chosen.values()),
        tuple(
            (1.0 if here[id(one)].direction > 0 else -1.0) * _sense(sensor, there)
            for sensor, one, there in chosen.values()
        ),
        name,
        reciprocal,
        all(directions),
        len(across) - len(chosen),
    )


def _of_impact(
    responses: Sequence[FrequencyResponse], reference: str | None
) -> tuple[str, list[tuple[FrequencyResponse, DegreeOfFreedom, DegreeOfFreedom]], bool]:
    """Return the name of the place of the impact, the responses with that place and the other one,
    and whether they are reciprocal.

    Raises
    ------
    InputError
        If there is no such place, or there are several and none is named.
    """
    by_force, by_motion = [one.reference for one in responses], [one.response for one in responses]
    forces, motions = (
        list(dict.fromkeys(place.name for place in places)) for places in (by_force, by_motion)
    )
    if reference is None:
        if len(forces) > 1 and len(motions) > 1:
            raise InputError(
                f"the forces act at {listed(forces)}; name the one at drop.position of the "
                "case by --hammer (in Python reference)"
            )
        reciprocal = len(forces) > 1
        name = motions[0] if reciprocal else forces[0]
    else:
        at_force, at_motion = (
            sum(reference in place.names for place in places) for places in (by_force, by_motion)
        )
        if not at_force and not at_motion:
            acting = f"forces act at {listed(forces)}, motion was measured at {listed(motions)}"
            meant = did_you_mean(reference, [*motions, *forces])
            raise InputError(
                f"no force acts, and no motion was measured, at {quoted(reference)}; "
                f"{acting}.{meant}",
                "--hammer",
            )
        name, reciprocal = reference, at_motion > at_force
    ends = [
        (one, one.response, one.reference) if reciprocal else (one, one.reference, one.response)
        for one in responses
    ]
    return name, [(one, here, there) for one, here, there in ends if name in here.names], reciprocal


def _axis_fits(sensor: Sensor, there: DegreeOfFreedom) -> bool:
    return (
        there.direction == 0
        or sensor.sees_strain
        or abs(sensor.direction[abs(there.direction) - 1]) > _ALONG
    )


def _sense(sensor: Sensor, there: DegreeOfFreedom) -> float:
    """Return 1, or -1 where the response is measured against the direction of a sensor."""
    if there.direction == 0 or sensor.sees_strain:
        return 1.0
    return 1.0 if there.direction * sensor.direction[abs(there.direction) - 1] > 0.0 else -1.0


def unit_of(sensor: Sensor) -> str:
    """Return the unit of the frequency response of a sensor."""
    return "1/N" if sensor.sees_strain else f"{sensor.unit}/N"


def _check_unit(sensor: Sensor, response: FrequencyResponse) -> None:
    """Raise InputError if a response can't be that of a sensor: one without an instrument
    may be of any motion.
    """
    if isinstance(sensor.instrument, Microphone):
        raise InputError(
            f"{quoted(sensor.name)} is a microphone, which hears the whole plate; leave it out",
            "sensors",
        )
    motions = ("m/N", "m/s/N", "m/s2/N")
    any_motion = (
        sensor.instrument is None and response.unit in motions and unit_of(sensor) in motions
    )
    if response.unit not in ("", unit_of(sensor)) and not any_motion:
        words = (
            f"the response {quoted(sensor.name)} is in {response.unit}, and the sensor of that "
            f"name gives {unit_of(sensor)}"
        )
        raise InputError(
            f"{words}; give the case's sensor the quantity or the instrument that was used",
            "sensors",
        )
